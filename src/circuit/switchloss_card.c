/* switchloss_card.c - .switchloss name eon|eoff|err v=(...) i=(...) e=(...)
 *
 * name is a switch or diode, or a model of such: then it is meant for all that have it and no card of
 * their own. Collected once all elements are known. */

#include "reader.h"
#include "result_cards.h"

#include <string.h>

static const char USAGE[] = ".switchloss name eon|eoff|err v=(0 400) i=(0 10 20) e=(0 0 0 0 1m 2m)";

/* A list in parentheses, or one number. */
static bool read_list(struct dalcs_reader *reader, enum dalcs_quantity quantity, const char *what,
                      double **list, int *n) {
    struct dalcs_builder *builder = reader->builder;
    double *value =
        dalcs_arena_alloc(&builder->circuit->arena, (size_t)reader->card->n, sizeof *value);
    if (value == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    const bool opened = dalcs_reader_take(reader, DALCS_TOKEN_OPEN);
    *list = value;
    *n = 0;
    do {
        const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
        if (!dalcs_reader_list_number(reader, quantity, what, &value[*n])) {
            return false;
        }
        if (!(value[*n] >= 0.0)) {
            dalcs_builder_error(builder, token, USAGE, "%s cannot be negative", what);
            return false;
        }
        if (quantity != DALCS_PLAIN && *n > 0 && !(value[*n] > value[*n - 1])) {
            dalcs_builder_error(builder, token, USAGE, "'%s' does not ascend: %g comes after %g",
                                token->text, value[*n], value[*n - 1]);
            return false;
        }
        (*n)++;
    } while (opened && !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE));
    return true;
}

static bool read_table(struct dalcs_reader *reader, struct dalcs_loss_table *table) {
    struct dalcs_builder *builder = reader->builder;
    double *list[3] = {NULL, NULL, NULL};
    int n[3] = {0, 0, 0};

    static const enum dalcs_quantity quantity[] = {DALCS_VOLTAGE, DALCS_CURRENT, DALCS_PLAIN};

    static const char *const what[] = {"a voltage", "a current", "an energy"};
    while (!dalcs_reader_at_end(reader)) {
        const struct dalcs_token *name = dalcs_reader_take_parameter(reader);
        const char *known = "vie";
        const char *found = name != NULL && name->text[0] != '\0' && name->text[1] == '\0'
                                ? strchr(known, name->text[0])
                                : NULL;
        if (found == NULL) {
            if (name != NULL) {
                dalcs_builder_error(builder, name, USAGE, "unknown parameter '%s'", name->text);
            } else {
                dalcs_reader_unexpected(reader);
            }
            return false;
        }
        const int k = (int)(found - known);
        if (n[k] > 0) {
            dalcs_builder_error(builder, name, USAGE, "'%s' is given twice", name->text);
            return false;
        }
        if (!read_list(reader, quantity[k], what[k], &list[k], &n[k])) {
            return false;
        }
    }
    if (n[0] == 0 || n[1] == 0 || n[2] == 0) {
        dalcs_reader_missing(reader, n[0] == 0 ? "v=" : n[1] == 0 ? "i=" : "e=");
        return false;
    }
    if (n[2] != n[0] * n[1]) {
        dalcs_builder_error(builder, reader->card->token, USAGE,
                            "%d voltages and %d currents need %d energies, not %d", n[0], n[1],
                            n[0] * n[1], n[2]);
        return false;
    }
    table->n_v = n[0];
    table->n_i = n[1];
    table->v = list[0];
    table->i = list[1];
    table->e = list[2];
    return true;
}

/* A switch or a diode, by itself; -1: it is neither, or a model's name. */
static int device_of(const struct dalcs_builder *builder, const char *name) {
    const int k = dalcs_names_find(&builder->elements.devices, name);
    return k >= 0 && k < builder->circuit->n_devices ? k : -1;
}

static bool has_model(const struct dalcs_circuit *c, const struct dalcs_device *d,
                      const char *name) {
    const char *own = d->kind == DALCS_DIODE    ? c->models.of_diode[d->model].name
                      : d->kind == DALCS_SWITCH ? c->models.of_switch[d->model].name
                                                : NULL;
    return own != NULL && strcmp(own, name) == 0;
}

/* Gives table k to the elements that are meant. */
static void give(struct dalcs_builder *builder, const struct dalcs_token *name, int k,
                 const char *word) {
    struct dalcs_circuit *c = builder->circuit;
    const int side = c->results.losses->table[k].is_off;
    const int own = device_of(builder, name->text);
    int n = 0;
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        const bool is_right = d->kind == DALCS_DIODE || (d->kind == DALCS_SWITCH && word[1] != 'r');
        if (!is_right || (own >= 0 ? i != own : !has_model(c, d, name->text))) {
            continue;
        }
        n++;
        int *at = &c->results.losses->device[i].table[side];
        if (*at < 0 || own >= 0) {
            *at = k;
        }
    }
    if (n == 0) {
        dalcs_builder_error(builder, name, USAGE,
                            own < 0 ? "'%s' is neither a switch or diode nor a model of one in use"
                                    : "'%s' has no energy of this kind",
                            name->text);
    }
}

static void read_card(struct dalcs_builder *builder, const struct dalcs_card *card, bool of_model) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct dalcs_losses_card *losses = builder->circuit->results.losses;
    const struct dalcs_token *name;
    const struct dalcs_token *kind;
    struct dalcs_loss_table table = {0};
    if (!dalcs_reader_name(&reader, "a switch, diode or model", &name)) {
        return;
    }
    if ((device_of(builder, name->text) < 0) != of_model) {
        return; /* in the other round */
    }
    if (!dalcs_reader_name(&reader, "eon, eoff or err", &kind)) {
        return;
    }
    table.is_off = strcmp(kind->text, "eon") != 0;
    if (table.is_off && strcmp(kind->text, "eoff") != 0 && strcmp(kind->text, "err") != 0) {
        dalcs_builder_error(builder, kind, USAGE, "'%s' is none of eon, eoff, err", kind->text);
        return;
    }
    table.where = dalcs_builder_keep_location(builder, card->token);
    if (!read_table(&reader, &table)) {
        builder->failed = true;
        return;
    }
    losses->table[losses->n_tables] = table;
    give(builder, name, losses->n_tables++, kind->text);
}

void dalcs_switchloss_collect(struct dalcs_builder *builder) {
    struct dalcs_losses_card *losses = builder->circuit->results.losses;
    losses->table = dalcs_arena_alloc(&builder->circuit->arena, builder->results.n_switchlosses,
                                      sizeof *losses->table);
    if (losses->table == NULL) {
        builder->out_of_memory = true;
        return;
    }
    /* Those of models first, so that an element's own comes over them. */
    for (int round = 0; round < 2; round++) {
        for (size_t k = 0; k < builder->deck->n_cards; k++) {
            if (strcmp(builder->deck->card[k].token->text, ".switchloss") == 0) {
                read_card(builder, &builder->deck->card[k], round == 0);
            }
        }
    }
}

void dalcs_switchloss_count(struct dalcs_builder *builder, const struct dalcs_card *card) {
    builder->results.switchloss =
        builder->results.switchloss == NULL ? card->token : builder->results.switchloss;
    builder->results.n_switchlosses++;
}

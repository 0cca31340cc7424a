/* sens_card.c - .sens: the values by which measurements of the steady state are differentiated. */

#include "analysis_cards.h"
#include "override.h"
#include "reader.h"

#include <string.h>

static const char SENS_USAGE[] =
    ".sens [item ...]; an item is an element, param name or model(parameter); without one: all R, "
    "L, C and all constant V and I";

/* Elements that are meant where none is named. */
static const char ALL[] = "rlcvi";

static bool is_constant(const struct dalcs_builder *builder, const struct dalcs_device *d) {
    return d->stimulus < 0 || builder->circuit->stimulus[d->stimulus].kind == DALCS_STIMULUS_DC;
}

/* The value that the netlist gives it, in item->start. */
static bool find_value(const struct dalcs_builder *builder, struct dalcs_sweep *item) {
    const enum dalcs_override_kind kind[] = {[DALCS_SWEEP_ELEMENT] = DALCS_OVERRIDE_ELEMENT,
                                             [DALCS_SWEEP_PARAMETER] = DALCS_OVERRIDE_PARAMETER,
                                             [DALCS_SWEEP_MODEL] = DALCS_OVERRIDE_MODEL};

    if (item->target == DALCS_SWEEP_TEMPERATURE) {
        return false;
    }
    const struct dalcs_override override = {
        .kind = kind[item->target], .name = item->name, .field = item->field};
    return dalcs_deck_value(builder->deck, &override, builder->netlist->dialect.name, &item->start);
}

/* As if all had been named that may be. A short is none: a little resistance makes another circuit of it. */
static void take_all(struct dalcs_builder *builder, struct dalcs_sensitivity_card *card) {
    struct dalcs_circuit *c = builder->circuit;
    card->item = dalcs_arena_alloc(&c->arena, (size_t)c->n_devices, sizeof *card->item);
    if (card->item == NULL) {
        builder->out_of_memory = true;
        return;
    }
    for (int k = 0; k < c->n_devices; k++) {
        const struct dalcs_device *d = &c->device[k];
        struct dalcs_sweep item = {.target = DALCS_SWEEP_ELEMENT,
                                   .name = d->name,
                                   .label = d->name,
                                   .device = k,
                                   .where = d->where};
        if (strchr(ALL, d->letter) != NULL && is_constant(builder, d) &&
            find_value(builder, &item) && item.start != 0.0) {
            card->item[card->n++] = item;
        }
    }
}

void dalcs_sensitivity_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_sensitivity_card *sens = &builder->circuit->analyses.sensitivity;
    struct dalcs_reader reader = dalcs_reader_start(builder, card, SENS_USAGE);
    if (!dalcs_analysis_is_first(builder, card, &builder->analyses.sens)) {
        return;
    }
    if (builder->analyses.pss == NULL && !builder->netlist->asks.steady) {
        dalcs_builder_warn(
            builder, card->token, "write .pss beside it",
            ".sens differentiates a periodic steady state, and there is no .pss: the "
            "card is left out");
        return;
    }
    sens->item = dalcs_arena_alloc(&builder->circuit->arena, (size_t)card->n, sizeof *sens->item);
    if (sens->item == NULL) {
        builder->out_of_memory = true;
        return;
    }
    while (!dalcs_reader_at_end(&reader)) {
        struct dalcs_sweep *item = &sens->item[sens->n];
        if (!dalcs_sweep_read_item(&reader, "vircleghf", item)) {
            return;
        }
        sens->n++;
    }
    sens->present = true;
}

static bool check_item(struct dalcs_builder *builder, const struct dalcs_sweep *item,
                       bool has_value) {
    const struct dalcs_device *d =
        item->device >= 0 ? &builder->circuit->device[item->device] : NULL;
    if (d != NULL && !is_constant(builder, d)) {
        dalcs_builder_error_at(builder, &item->where,
                               "put a parameter into it: PULSE(0 {high} ...), and .sens param high",
                               "'%s' is a function of time: it has no value to vary", item->label);
        return false;
    }
    if (!has_value || (d != NULL && d->letter == 'r' && item->start == 0.0)) {
        dalcs_builder_error_at(builder, &item->where,
                               d != NULL ? "0 ohm is a short, which has no value either"
                                         : "write it on the card of its model",
                               "'%s' has no value to vary", item->label);
        return false;
    }
    return true;
}

void dalcs_sensitivity_check(struct dalcs_builder *builder) {
    struct dalcs_sensitivity_card *card = &builder->circuit->analyses.sensitivity;
    card->present = card->present || builder->netlist->asks.sensitivities;
    if (card->present && builder->circuit->analyses.n_steps > 0) {
        dalcs_builder_error_at(builder, &builder->circuit->analyses.step[0].where,
                               "leave one of them out; .sens itself varies the values",
                               "sensitivities belong to one circuit, and .step makes several");
        card->present = false;
    }
    if (card->present && card->n == 0) {
        take_all(builder, card);
        return;
    }
    for (int k = 0; k < card->n && card->present; k++) {
        const bool has_value = find_value(builder, &card->item[k]);
        card->present = check_item(builder, &card->item[k], has_value);
        for (int i = 0; i < k && card->present; i++) {
            if (strcmp(card->item[i].label, card->item[k].label) == 0) {
                dalcs_builder_error_at(builder, &card->item[k].where, NULL,
                                       ".sens names '%s' twice", card->item[k].label);
                card->present = false;
            }
        }
    }
}

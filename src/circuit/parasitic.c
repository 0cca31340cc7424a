/* parasitic.c - the parasitic parts that a card of LTspice may have: Rser, Lser, Rpar, Cpar, RLshunt.
 *
 *     a --+-- Rser -- Lser (RLshunt across) -- element --+-- b
 *         +-- Rpar ---------------------------------------+
 *         +-- Cpar ---------------------------------------+
 *
 * Each becomes a device of its own, on nodes that no card can name, and costs nothing where it is not
 * given. With Rpar or Cpar the current of the element is that of its terminal a: a short there
 * measures it, and is an unknown only if it is read. */

#include "element_cards.h"
#include "reader.h"

#include <string.h>

enum { RSER, LSER, RPAR, CPAR, RLSHUNT, N_PARASITICS };

static const struct {
    const char *name;
    enum dalcs_device_kind kind;
    enum dalcs_quantity quantity;
} KINDS[N_PARASITICS] = {
    [RSER] = {"rser", DALCS_RESISTOR, DALCS_OHM},
    [LSER] = {"lser", DALCS_INDUCTOR, DALCS_HENRY},
    [RPAR] = {"rpar", DALCS_RESISTOR, DALCS_OHM},
    [CPAR] = {"cpar", DALCS_CAPACITOR, DALCS_FARAD},
    [RLSHUNT] = {"rlshunt", DALCS_RESISTOR, DALCS_OHM},
};

static int index_of(const char *name) {
    int k = 0;
    while (k < N_PARASITICS && strcmp(KINDS[k].name, name) != 0) {
        k++;
    }
    return k;
}

bool dalcs_parasitic_is_name(const char *name) {
    return index_of(name) < N_PARASITICS;
}

bool dalcs_parasitic_read(struct dalcs_reader *reader, const struct dalcs_token *name,
                          struct dalcs_parasitics *parasitics) {
    struct dalcs_builder *builder = reader->builder;
    const int k = index_of(name->text);
    if (parasitics->place[k] != NULL) {
        dalcs_builder_error(builder, name, NULL, "'%s' is given twice", name->text);
        return false;
    }
    parasitics->place[k] = name;
    double *value = &parasitics->value[k];
    const struct dalcs_token *next = dalcs_reader_peek(reader, 1);
    if (dalcs_reader_at_end(reader) || (next != NULL && next->kind == DALCS_TOKEN_EQUAL)) {
        dalcs_builder_warn(builder, name, NULL, "'%s=' has no value: there is none", name->text);
        *value = 0;
        return true;
    }
    if (!dalcs_reader_number(reader, KINDS[k].quantity, "a value", value)) {
        return false;
    }
    /* 0 is none, of what lies across too, as in LTspice: no short. */
    if (*value < 0) {
        dalcs_builder_error(builder, name, NULL, "'%s' cannot be negative", name->text);
        return false;
    }
    return true;
}

static void add(struct dalcs_builder *builder, const struct dalcs_token *element, int k,
                double value, int a, int b) {
    struct dalcs_device *device =
        dalcs_builder_add_inner_device(builder, KINDS[k].kind, KINDS[k].name, element);
    if (device != NULL) {
        device->node[0] = a;
        device->node[1] = b;
        device->value = value;
    }
}

void dalcs_parasitic_expand(struct dalcs_builder *builder, const struct dalcs_token *element,
                            struct dalcs_device *device,
                            const struct dalcs_parasitics *parasitics) {
    const double *value = parasitics->value;
    if (value[RLSHUNT] > 0 && value[LSER] == 0) {
        dalcs_builder_error(builder, parasitics->place[RLSHUNT], NULL,
                            "'rlshunt' lies across 'lser', which is not there");
        return;
    }
    const int terminal = device->node[0];
    int from = terminal;
    if (value[RPAR] > 0 || value[CPAR] > 0) {
        if (!dalcs_builder_add_terminal(builder, element, device)) {
            return;
        }
        from = device->node[0];
        for (int k = RPAR; k <= CPAR; k++) {
            if (value[k] > 0) {
                add(builder, element, k, value[k], from, device->node[1]);
            }
        }
    }
    for (int k = RSER; k <= LSER; k++) {
        if (value[k] == 0) {
            continue;
        }
        const int next =
            dalcs_builder_inner_node(builder, k == RSER ? "after_rser" : "inside", element);
        if (next < 0) {
            return;
        }
        add(builder, element, k, value[k], from, next);
        if (k == LSER && value[RLSHUNT] > 0) {
            add(builder, element, RLSHUNT, value[RLSHUNT], from, next);
        }
        from = next;
    }
    device->before_series = from != terminal ? terminal : 0;
    device->node[0] = from;
}

void dalcs_parasitic_multiply(struct dalcs_parasitics *parasitics, double m) {
    for (int k = 0; k < N_PARASITICS; k++) {
        parasitics->value[k] *= k == CPAR ? m : 1 / m;
    }
}

bool dalcs_parasitic_has_rser(const struct dalcs_parasitics *parasitics) {
    return parasitics->place[RSER] != NULL;
}

void dalcs_parasitic_add_rser(struct dalcs_builder *builder, const struct dalcs_token *element,
                              struct dalcs_device *device, double ohms) {
    const int inside = dalcs_builder_inner_node(builder, "inside", element);
    if (inside >= 0) {
        add(builder, element, RSER, ohms, device->node[0], inside);
        device->node[0] = inside;
    }
}

/* signals.c - what is recorded: signals are added, each once.
 *
 * The default is every node voltage and the currents of V, L, D, S, W, E, H and B with V=. Naming signals replaces it,
 * `all` adds it. */
#include "signals.h"
#include "result_cards.h"

#include <string.h>

/* A column of the .print that is being read. */
void dalcs_signals_add_column(struct dalcs_builder *builder, const char *name) {
    const char *before = builder->results.print_before;
    const bool is_function = before != NULL && strchr(before, '(') != NULL;
    const char *title =
        before == NULL ? name
                       : dalcs_arena_printf(&builder->circuit->arena, "%s%s%s", before,
                                            is_function ? name : name + 1, is_function ? ")" : "");
    if (title == NULL ||
        dalcs_grow(&builder->results.print_column, &builder->results.print_column_capacity,
                   builder->results.n_print_columns + 1,
                   sizeof *builder->results.print_column) != DALCS_OK) {
        builder->out_of_memory = true;
        return;
    }
    builder->results.print_column[builder->results.n_print_columns++] =
        (struct dalcs_print_column){name, title, builder->results.print_part};
    builder->results.print[builder->results.n_prints - 1].n++;
}

/* Adds a signal; `name` is in the circuit's arena or NULL when memory ran out. The defaults alone
 * hold nothing twice, and a million names are better not looked up. */
void dalcs_signals_add(struct dalcs_builder *builder, const char *name,
                       struct dalcs_signal signal) {
    const bool may_repeat = builder->signals.are_named;
    if (name != NULL && builder->results.is_print) {
        dalcs_signals_add_column(builder, name);
    }
    if (name != NULL && may_repeat && dalcs_names_find(&builder->signals.names, name) >= 0) {
        return;
    }
    signal.name = name;
    if (name == NULL ||
        (may_repeat && dalcs_names_add(&builder->signals.names, name, 0) != DALCS_OK) ||
        dalcs_grow(&builder->signals.signal, &builder->signals.capacity, builder->signals.n + 1,
                   sizeof *builder->signals.signal) != DALCS_OK) {
        builder->out_of_memory = true;
        return;
    }
    builder->signals.signal[builder->signals.n++] = signal;
}

static const char *node_text(const struct dalcs_builder *builder, int node) {
    return node == 0 ? "0" : builder->elements.node_name[node];
}

/* "v(out)" or "i(r1)"; a million of them by printf take as long as to read their netlist. */
static const char *signal_name(const struct dalcs_builder *builder, char letter,
                               const char *inside) {
    const size_t n = strlen(inside);
    char *name = dalcs_arena_text(&builder->circuit->arena, n + 3);
    if (name != NULL) {
        name[0] = letter;
        name[1] = '(';
        memcpy(name + 2, inside, n);
        name[2 + n] = ')';
    }
    return name;
}

void dalcs_signals_add_voltage(struct dalcs_builder *builder, int a, int b, bool is_pair) {
    const char *name = is_pair ? dalcs_arena_printf(&builder->circuit->arena, "v(%s,%s)",
                                                    node_text(builder, a), node_text(builder, b))
                               : signal_name(builder, 'v', node_text(builder, a));
    dalcs_signals_add(
        builder, name,
        (struct dalcs_signal){.kind = DALCS_SIGNAL_VOLTAGE, .node = {a, b}, .device = -1});
}

void dalcs_signals_add_current(struct dalcs_builder *builder, int device) {
    const struct dalcs_device *d = &builder->circuit->device[device];
    const bool is_bend = d->is_storage && dalcs_names_is_inner(d->name); /* of a coil */
    const int named = is_bend ? builder->elements.current_of[device] : device;
    const char *name = signal_name(builder, 'i', builder->circuit->device[named].name);
    dalcs_signals_add(builder, name,
                      (struct dalcs_signal){.kind = DALCS_SIGNAL_CURRENT,
                                            .device = builder->elements.current_of[device]});
}

/* By letter, not by kind: an inductor of 0 H is still an inductor to the one who wrote it. */
static bool has_default(const struct dalcs_device *d) {
    const bool is_default = (d->letter != 0 && strchr("vldsweh", d->letter) != NULL) ||
                            d->kind == DALCS_DIODE || d->kind == DALCS_SWITCH ||
                            (d->letter == 'b' && d->kind == DALCS_VCVS);
    return is_default && !dalcs_names_is_inner(d->name);
}

void dalcs_signals_add_voltages(struct dalcs_builder *builder) {
    for (int k = 1; k < builder->circuit->n_nodes; k++) {
        if (!dalcs_names_is_inner(builder->elements.node_name[k])) {
            dalcs_signals_add_voltage(builder, k, 0, false);
        }
    }
}

void dalcs_signals_add_default(struct dalcs_builder *builder) {
    const struct dalcs_circuit *circuit = builder->circuit;
    size_t need = builder->signals.n + (size_t)circuit->n_nodes - 1;
    for (int k = 0; k < circuit->n_devices; k++) {
        need += has_default(&circuit->device[k]);
    }
    if (dalcs_grow(&builder->signals.signal, &builder->signals.capacity, need,
                   sizeof *builder->signals.signal) != DALCS_OK) {
        builder->out_of_memory = true;
        return;
    }
    dalcs_signals_add_voltages(builder);
    for (int k = 0; k < circuit->n_devices; k++) {
        if (has_default(&circuit->device[k])) {
            dalcs_signals_add_current(builder, k);
        }
    }
}

/* ngspice's alli and LTspice's i(*): the current of each element. */
void dalcs_signals_add_currents(struct dalcs_builder *builder) {
    for (int k = 0; k < builder->circuit->n_devices; k++) {
        if (!dalcs_names_is_inner(builder->circuit->device[k].name)) {
            dalcs_signals_add_current(builder, k);
        }
    }
}

int dalcs_signals_measure(struct dalcs_builder *builder, struct dalcs_signal signal) {
    const char *key = signal.kind == DALCS_SIGNAL_CURRENT
                          ? dalcs_builder_hint(builder, "%d", signal.device)
                          : dalcs_builder_hint(builder, "%d %d", signal.node[0], signal.node[1]);
    const int next = (int)builder->signals.n_measured;
    int place;
    if (signal.name == NULL || key == NULL ||
        dalcs_names_find_or_add(&builder->signals.measured_keys, key, next, &place) != DALCS_OK ||
        dalcs_grow(&builder->signals.measured, &builder->signals.measured_capacity,
                   builder->signals.n_measured + 1,
                   sizeof *builder->signals.measured) != DALCS_OK) {
        builder->out_of_memory = true;
        return -1;
    }
    if (place == next) {
        builder->signals.measured[builder->signals.n_measured++] = signal;
    }
    return place;
}

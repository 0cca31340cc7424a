/* block_parts.c - sources, tables and limits of analog code models. */
#include "block_parts.h"
#include "element_cards.h"
#include "model_cards.h"

#include <math.h>

struct dalcs_device *dalcs_block_add(const struct dalcs_block_card *c, enum dalcs_device_kind kind,
                                     const char *what, int a, int b) {
    const struct dalcs_token *name = c->card->token;
    struct dalcs_device *device =
        what == NULL ? dalcs_builder_add_device(c->builder, kind, name)
                     : dalcs_builder_add_inner_device(c->builder, kind, what, name);
    if (device != NULL) {
        device->node[0] = a;
        device->node[1] = b;
    }
    return device;
}

void dalcs_block_add_stimulus(const struct dalcs_block_card *c, struct dalcs_device *device,
                              const struct dalcs_stimulus *stimulus) {
    struct dalcs_circuit *circuit = c->builder->circuit;
    device->stimulus = circuit->n_stimuli++;
    circuit->stimulus[device->stimulus] = *stimulus;
}

bool dalcs_block_add_constant(const struct dalcs_block_card *c, enum dalcs_device_kind kind,
                              const char *what, const int *node, double value) {
    struct dalcs_device *device = dalcs_block_add(c, kind, what, node[0], node[1]);
    if (device == NULL) {
        return false;
    }
    const struct dalcs_stimulus constant = {.kind = DALCS_STIMULUS_DC, .has_dc = true, .dc = value};
    dalcs_block_add_stimulus(c, device, &constant);
    return true;
}

/* LTspice's models of amplifiers write this for none. */
static const double no_limit = 1e30;

bool dalcs_block_is_level(double level) {
    return fabs(level) <= no_limit;
}

/* Its forward voltage is the level, or there is a source where that lies on the other side of 0. */
bool dalcs_block_add_clamp(const struct dalcs_block_card *c, const int *node,
                           const struct dalcs_block_clamp *clamp) {
    struct dalcs_circuit *circuit = c->builder->circuit;
    const char *what = clamp->is_upper ? "upper" : "lower";
    const bool is_behind = clamp->is_upper ? clamp->level < 0 : clamp->level > 0;
    if (!dalcs_block_is_level(clamp->level)) {
        return true;
    }
    const int end =
        is_behind ? dalcs_builder_inner_node(c->builder, what, c->card->token) : node[1];
    struct dalcs_device *d = dalcs_block_add(c, DALCS_DIODE, what, clamp->is_upper ? node[0] : end,
                                             clamp->is_upper ? end : node[0]);
    if (end < 0 || d == NULL) {
        return false;
    }
    d->model = circuit->models.n_diodes++;
    circuit->models.of_diode[d->model] =
        (struct dalcs_diode_model){.name = "clamp",
                                   .ron = clamp->ohms,
                                   .roff = (double)INFINITY,
                                   .vfwd = is_behind ? 0 : fabs(clamp->level),
                                   .vrev = (double)INFINITY};
    return !is_behind ||
           dalcs_block_add_constant(c, DALCS_VSOURCE, clamp->is_upper ? "at_upper" : "at_lower",
                                    (int[]){end, node[1]}, clamp->level);
}

bool dalcs_block_add_across(const struct dalcs_block_card *c, const int *node,
                            enum dalcs_device_kind kind, const struct dalcs_parameter *p) {
    if (p->place == NULL || p->value == 0) {
        return true;
    }
    struct dalcs_device *d = dalcs_block_add(c, kind, p->name, node[0], node[1]);
    if (d != NULL) {
        d->value = p->value;
    }
    return d != NULL;
}

void dalcs_block_control(struct dalcs_device *device, const struct dalcs_block_end *by,
                         double gain) {
    device->node[2] = by->node;
    device->node[3] = by->reference;
    device->value = gain;
}

bool dalcs_block_check(const struct dalcs_block_card *c, const char *const *names, size_t n,
                       int ports, const char *usage) {
    return dalcs_block_has_only(c, names, n) && dalcs_block_has_ports(c, ports, 0, usage) &&
           dalcs_block_has_nodes(c, usage);
}

struct dalcs_piecewise dalcs_block_make_table(const struct dalcs_block_card *c, int n) {
    struct dalcs_piecewise table = {.n = n};
    table.knot = dalcs_arena_alloc(&c->builder->scratch, (size_t)n, sizeof *table.knot);
    c->builder->out_of_memory = c->builder->out_of_memory || table.knot == NULL;
    return table;
}

void dalcs_block_set_knot(struct dalcs_piecewise *table, int k, double x, double y) {
    table->knot[k] = (struct dalcs_knot){x, y, y, y};
}

void dalcs_block_add_table(const struct dalcs_block_card *c, const struct dalcs_block_end *by,
                           const struct dalcs_piecewise *table) {
    const struct dalcs_block_end *out = &c->port[c->n_ports - 1].end[0];
    struct dalcs_device *e = dalcs_block_add(c, DALCS_VCVS, NULL, out->node, out->reference);
    if (e != NULL) {
        dalcs_block_control(e, by, 1);
        dalcs_behavioural_add_table(c->builder, e, table);
    }
}

bool dalcs_block_read_table(const struct dalcs_block_card *c, const char *x_name,
                            const char *y_name, struct dalcs_piecewise *table) {
    const struct dalcs_block_value *x = dalcs_block_find(c->block, x_name);
    const struct dalcs_block_value *y = dalcs_block_find(c->block, y_name);
    bool ascends = x != NULL && y != NULL && x->n == y->n && x->n >= 2;
    for (int k = 1; ascends && k < x->n; k++) {
        ascends = x->number[k] > x->number[k - 1];
    }
    if (!ascends) {
        dalcs_builder_error(c->builder, c->block->type, NULL,
                            "%s and %s have as many numbers, two at least, and those of %s ascend",
                            x_name, y_name, x_name);
        return false;
    }
    const int n = x->n;
    *table = dalcs_block_make_table(c, n);
    if (table->knot == NULL) {
        return false;
    }
    for (int k = 0; k < n; k++) {
        dalcs_block_set_knot(table, k, x->number[k], y->number[k]);
    }
    table->before = (y->number[1] - y->number[0]) / (x->number[1] - x->number[0]);
    table->after = (y->number[n - 1] - y->number[n - 2]) / (x->number[n - 1] - x->number[n - 2]);
    return true;
}

bool dalcs_block_read_limits(const struct dalcs_block_card *c, double *low, double *high) {
    *low = dalcs_block_number(c->block, "out_lower_limit", -(double)INFINITY);
    *high = dalcs_block_number(c->block, "out_upper_limit", (double)INFINITY);
    if (!(*low < *high)) {
        dalcs_builder_error(c->builder, c->block->type, NULL,
                            "out_lower_limit must be below out_upper_limit");
    }
    return *low < *high;
}

static const struct dalcs_token *name_of(struct dalcs_formula_writer *w, int node) {
    return dalcs_formula_name(w->builder, w->element,
                              node == 0 ? "0" : w->builder->elements.node_name[node]);
}

const struct dalcs_formula *dalcs_block_line(struct dalcs_formula_writer *w,
                                             const struct dalcs_block_end *input, double offset,
                                             double gain) {
    const struct dalcs_token *a = name_of(w, input->node);
    const struct dalcs_token *b = input->reference != 0 ? name_of(w, input->reference) : NULL;
    if (a == NULL || (b == NULL && input->reference != 0)) {
        return NULL;
    }
    const struct dalcs_formula *v = dalcs_formula_signal(w, DALCS_FORMULA_VOLTAGE, a, b);
    v = offset == 0 ? v : dalcs_formula_operation(w, DALCS_ADD, v, dalcs_formula_number(w, offset));
    return gain == 1 ? v
                     : dalcs_formula_operation(w, DALCS_MULTIPLY, dalcs_formula_number(w, gain), v);
}

void dalcs_block_put_out(const struct dalcs_block_card *c, struct dalcs_formula_writer *w,
                         const struct dalcs_formula *what, const struct dalcs_block_end *out) {
    const struct dalcs_token *formula = what != NULL ? dalcs_formula_token(w, what) : NULL;
    struct dalcs_device *device = dalcs_block_add(c, DALCS_VCVS, NULL, out->node, out->reference);
    if (device != NULL && formula != NULL) {
        dalcs_behavioural_add_formula(c->builder, device, formula);
    }
}

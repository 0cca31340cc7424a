/* wrapped_integral.c - idtmod(x, first, modulus, offset): an integral of x that begins at `first` and begins again where it
 * has reached the modulus, or 0 on its way down.
 *
 * Of a number it is a sawtooth over time. Of anything else a share of the modulus is kept between 0 and 1: it is reflected
 * at both ends instead of beginning again, so that no state jumps and each turn is an event, and `falls` says which way
 * round it is read: the wrapped share is `share`, or 1 - share while it falls. A change of the sign of x turns the way
 * round itself, and thereby the end that comes next. */
#include "behaviour.h"
#include "model_cards.h"

#include <math.h>

static bool read_number(struct dalcs_compiler *c, const struct dalcs_formula *f, int k,
                        double *value) {
    const struct dalcs_form *form = k < f->n ? dalcs_compile(c, f->argument[k]) : NULL;
    *value = form != NULL && dalcs_form_is_number(form) ? form->affine.constant : 0;
    if (form != NULL && !dalcs_form_is_number(form)) {
        dalcs_builder_error_at(c->builder, &f->argument[k]->where, NULL,
                               "%s of '%s' must be a number", k == 2 ? "the modulus" : "the offset",
                               f->function);
        c->failed = true;
    }
    return !c->failed;
}

/* v(node) is `gain` v(a,b). */
static bool add_gain(struct dalcs_compiler *c, const char *what, const int *node, double gain,
                     const int *of) {
    struct dalcs_device *e = dalcs_memory_add_device(c, DALCS_VCVS, what, node[0], node[1]);
    if (e != NULL) {
        e->node[2] = of[0];
        e->node[3] = of[1];
        e->value = gain;
    }
    return e != NULL;
}

/* The voltage of `from` at node `to` while v(a,b) is above the threshold, else 0. */
static bool add_gate(struct dalcs_compiler *c, const char *what, const int *node, const int *by,
                     const struct dalcs_switch_model *model) {
    struct dalcs_device *s = dalcs_memory_add_device(c, DALCS_SWITCH, what, node[0], node[1]);
    if (s == NULL) {
        return false;
    }
    s->node[2] = by[0];
    s->node[3] = by[1];
    s->model = dalcs_switch_add_model(c->builder, model);
    if (s->model < 0) {
        return false;
    }
    const char *load = dalcs_arena_printf(&c->builder->scratch, "%s_load", what);
    struct dalcs_device *r =
        load != NULL ? dalcs_memory_add_device(c, DALCS_RESISTOR, load, node[1], 0) : NULL;
    if (r != NULL) {
        r->value = 1;
    }
    return r != NULL;
}

/* A current of `rate` times v(by), into the share's capacitor, whose charge is its voltage times dalcs_charging. */
static bool add_charge(struct dalcs_compiler *c, const char *what, int share, int by, double rate) {
    struct dalcs_device *g = dalcs_memory_add_device(c, DALCS_VCCS, what, 0, share);
    if (g != NULL) {
        g->node[2] = by;
        g->value = dalcs_charging * rate;
    }
    return g != NULL;
}

static bool add_source(struct dalcs_compiler *c, const char *what, int node,
                       const struct dalcs_stimulus *stimulus) {
    struct dalcs_device *v = dalcs_memory_add_device(c, DALCS_VSOURCE, what, node, 0);
    if (v != NULL) {
        v->stimulus = dalcs_compiler_add_stimulus(c, stimulus);
    }
    return v != NULL && v->stimulus >= 0;
}

static bool add_constant(struct dalcs_compiler *c, const char *what, int node, double volts) {
    const struct dalcs_stimulus constant = {.kind = DALCS_STIMULUS_DC, .has_dc = true, .dc = volts};
    return add_source(c, what, node, &constant);
}

enum { SHARE, FIRST, HOLD, ONE, LIFT, MIRROR, TURNED, FALLS, BACK, OTHER, RAMP, N_NODES };

/* Which way round the share is read: it changes where the share arrives at an end. While x is below 0 the control is
 * 1 - share, so that the lower end is the one that turns it on. */
static bool add_direction(struct dalcs_compiler *c, const int *node, int x) {
    static const struct dalcs_switch_model negative = {.name = "negative",
                                                       .roff = (double)INFINITY};
    static const struct dalcs_switch_model turns = {
        .name = "turns", .roff = (double)INFINITY, .vt = 0.5, .vh = 0.5};
    return add_constant(c, "one", node[ONE], 1) &&
           add_gain(c, "lift", (int[]){node[LIFT], 0}, -1, (int[]){node[ONE], 0}) &&
           add_gain(c, "mirror", (int[]){node[MIRROR], node[LIFT]}, 2, (int[]){node[SHARE], 0}) &&
           add_gate(c, "turned", (int[]){node[MIRROR], node[TURNED]}, (int[]){0, x}, &negative) &&
           add_gate(c, "falls", (int[]){node[ONE], node[FALLS]}, (int[]){node[SHARE], node[TURNED]},
                    &turns);
}

/* The share, at `first` until t = 0: an operating point, and small signals around it, see it there. */
static bool add_share(struct dalcs_compiler *c, const int *node, double first) {
    static const struct dalcs_switch_model holds = {
        .name = "hold", .roff = (double)INFINITY, .vt = 0.5};
    struct dalcs_stimulus until_start = {.kind = DALCS_STIMULUS_PULSE};
    until_start.u.pulse.low = 1;
    until_start.u.pulse.width = until_start.u.pulse.period = (double)INFINITY;
    struct dalcs_device *store =
        dalcs_memory_add_device(c, DALCS_CAPACITOR, "share", node[SHARE], 0);
    if (store == NULL) {
        return false;
    }
    store->value = dalcs_charging;
    store->initial = first;
    store->has_initial = true;
    if (!add_constant(c, "first", node[FIRST], first) ||
        !add_source(c, "until_start", node[HOLD], &until_start)) {
        return false;
    }
    struct dalcs_device *s =
        dalcs_memory_add_device(c, DALCS_SWITCH, "hold", node[SHARE], node[FIRST]);
    if (s != NULL) {
        s->node[2] = node[HOLD];
        s->model = dalcs_switch_add_model(c->builder, &holds);
    }
    return s != NULL && s->model >= 0;
}

/* A node of the wrapped integral, less its offset; -1 after an error. */
static int add_wrapped(struct dalcs_compiler *c, const struct dalcs_formula *f, double modulus,
                       double first) {
    static const char *const names[N_NODES] = {"share",  "first", "hold", "one",   "lift", "mirror",
                                               "turned", "falls", "back", "other", "ramp"};
    static const struct dalcs_switch_model follows = {
        .name = "follows", .roff = (double)INFINITY, .vt = 0.5};
    int node[N_NODES];
    int source;
    const int x = dalcs_compiler_node_at(c, "integrand", f->argument[0], false, &source);
    for (int k = 0; k < N_NODES && !c->failed; k++) {
        node[k] = dalcs_compiler_new_node(c, names[k]);
        c->failed = c->failed || node[k] < 0;
    }
    if (x < 0 || c->failed) {
        return -1;
    }
    const bool ok =
        add_share(c, node, first - floor(first)) && add_direction(c, node, x) &&
        add_charge(c, "up", node[SHARE], x, 1 / modulus) &&
        add_gate(c, "back", (int[]){x, node[BACK]}, (int[]){node[FALLS], 0}, &follows) &&
        add_charge(c, "down", node[SHARE], node[BACK], -2 / modulus) &&
        add_gate(c, "other", (int[]){node[MIRROR], node[OTHER]}, (int[]){node[FALLS], 0},
                 &follows) &&
        add_gain(c, "ramp", (int[]){node[RAMP], 0}, modulus, (int[]){node[SHARE], node[OTHER]});
    return ok ? node[RAMP] : -1;
}

const struct dalcs_form *dalcs_wrapped_integral_form(struct dalcs_compiler *c,
                                                     const struct dalcs_formula *f, double first) {
    double modulus;
    double offset;
    const struct dalcs_form *x = dalcs_compile(c, f->argument[0]);
    if (x == NULL || !read_number(c, f, 2, &modulus) || !read_number(c, f, 3, &offset)) {
        return NULL;
    }
    if (!(modulus > 0)) {
        dalcs_builder_error_at(c->builder, &f->argument[2]->where, NULL,
                               "the modulus of 'idtmod' must be above 0");
        c->failed = true;
        return NULL;
    }
    if (dalcs_form_is_number(x)) {
        const struct dalcs_wave saw = {.shape = DALCS_SAWTOOTH,
                                       .frequency = x->affine.constant / modulus,
                                       .phase = first / modulus};
        return dalcs_carrier_ramp(c, &saw, modulus, offset);
    }
    int *node = &c->smooth_node[f->number_of];
    if (*node == 0) {
        const int made = add_wrapped(c, f, modulus, first / modulus);
        c->failed = c->failed || made < 0;
        *node = made > 0 ? made : 0;
    }
    struct dalcs_affine v = dalcs_affine_of(c, DALCS_QUANTITY_VOLTAGE, *node);
    v.constant = offset;
    return c->failed ? NULL : dalcs_form_affine(c, &v);
}

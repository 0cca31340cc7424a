/* delay.c - delay(x, t) in a formula, LTspice's: x as it was t earlier.
 *
 * A V source is the same one later, and a signal of two values is a buffer with a delay, as gates have it. What any other
 * one was is kept while a run goes on (later.h). The sources are made when all formulas are compiled. */
#include "behaviour.h"
#include "element_cards.h"
#include "formula_writer.h"
#include "later.h"
#include "logic_parts.h"

#include <math.h>
#include <string.h>

struct dalcs_delay {
    const struct dalcs_delay *before;
    const struct dalcs_token *name;
    int input, output; /* nodes */
    double low, high, seconds;
    bool is_later;  /* of what the input was */
    bool is_source; /* of this stimulus */
    struct dalcs_stimulus stimulus;
};

bool dalcs_delay_is(const struct dalcs_formula *f) {
    return f->kind == DALCS_FORMULA_CALL && dalcs_function_is_delay(f->function);
}

static int count(const struct dalcs_formula *f, bool *seen) {
    if (seen[f->number_of]) {
        return 0;
    }
    seen[f->number_of] = true;
    const bool is_factor = f->kind == DALCS_FORMULA_CALL && strcmp(f->function, "exp") == 0;
    int n = dalcs_delay_is(f) || is_factor ? 1 : 0; /* exp(-s*t) of a transfer function is one */
    for (int k = 0; k < f->n; k++) {
        n += count(f->argument[k], seen);
    }
    return n;
}

size_t dalcs_delay_count(struct dalcs_builder *builder, const struct dalcs_card *card) {
    size_t n = 0;
    for (int k = 1; k < card->n; k++) {
        const struct dalcs_formula *f =
            card->token[k].kind == DALCS_TOKEN_FORMULA ? card->token[k].formula : NULL;
        bool *seen =
            f != NULL ? dalcs_arena_alloc(&builder->scratch, (size_t)f->number_of + 1, sizeof *seen)
                      : NULL;
        builder->out_of_memory = builder->out_of_memory || (f != NULL && seen == NULL);
        n += seen != NULL ? (size_t)count(f, seen) : 0;
    }
    return n;
}

static const struct dalcs_form *refuse(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                       const char *hint, const char *message) {
    if (!c->failed && !c->is_silent) {
        dalcs_builder_error_at(c->builder, &f->where, hint, "%s", message);
    }
    c->failed = true;
    return NULL;
}

/* The source of a node against ground; NULL: it has none, or one that is not known before the run. */
static const struct dalcs_stimulus *source_of(struct dalcs_compiler *c, int node) {
    const struct dalcs_circuit *circuit = c->builder->circuit;
    for (int k = dalcs_drivers_first(c->builder, node); k >= 0;
         k = dalcs_drivers_next(c->builder, k)) {
        const struct dalcs_device *device = &circuit->device[k];
        if (device->kind == DALCS_VSOURCE && device->stimulus >= 0) {
            return &circuit->stimulus[device->stimulus];
        }
    }
    return NULL;
}

/* .dc sweeps it, or .ac needs a phase that no source has. */
static bool may_be_another(const struct dalcs_compiler *c, const struct dalcs_stimulus *s) {
    return c->builder->circuit->analyses.n_dc > 0 || c->builder->analyses.tf != NULL ||
           (c->builder->analyses.ac != NULL && (s->ac_real != 0 || s->ac_imaginary != 0));
}

/* The same later; before, its first value. False: its kind cannot be delayed. */
static bool shift(struct dalcs_compiler *c, struct dalcs_stimulus *s, double seconds) {
    double *t;
    switch (s->kind) {
    case DALCS_STIMULUS_DC:
        return true;
    case DALCS_STIMULUS_PULSE:
        s->u.pulse.delay += seconds;
        return s->u.pulse.delay >= seconds;
    case DALCS_STIMULUS_SIN:
        s->u.sine.delay += seconds;
        return s->u.sine.delay >= seconds;
    case DALCS_STIMULUS_EXP:
        s->u.exponential.rise_delay += seconds;
        s->u.exponential.fall_delay += seconds;
        return true;
    case DALCS_STIMULUS_PWL:
        t = dalcs_arena_alloc(&c->builder->circuit->arena, (size_t)s->u.pwl.n, sizeof *t);
        c->builder->out_of_memory = c->builder->out_of_memory || t == NULL;
        for (int k = 0; t != NULL && k < s->u.pwl.n; k++) {
            t[k] = s->u.pwl.t[k] + seconds;
        }
        s->u.pwl.t = t;
        s->u.pwl.repeat_from += s->u.pwl.repeats ? seconds : 0;
        return t != NULL;
    default:
        return false;
    }
}

/* A gate shows its levels in a source that is written while it runs. */
static bool find_gate_levels(const struct dalcs_circuit *circuit, const struct dalcs_stimulus *s,
                             struct dalcs_delay *delay) {
    bool found = false;
    for (int k = 0; k < circuit->control.n_gates && !found; k++) {
        const struct dalcs_logic_gate *g = &circuit->control.gate[k];
        for (int i = 0; i < 2 && g->kind != DALCS_GATE_SAMPLE && !found; i++) {
            found = g->output[i] >= 0 && &circuit->stimulus[g->output[i]] == s;
            delay->low = found ? g->low : delay->low;
            delay->high = found ? g->high : delay->high;
        }
    }
    return found;
}

/* The two values of a signal. */
static bool find_levels(struct dalcs_compiler *c, const struct dalcs_formula *x,
                        const struct dalcs_form *form, struct dalcs_delay *delay) {
    const struct dalcs_levels *levels = dalcs_levels_of(c, form);
    levels = levels != NULL ? levels : dalcs_levels_of(c, dalcs_commutation_steps(c, x, form));
    if (levels == NULL || levels->n != 1 || c->failed) {
        return false;
    }
    const double other = levels->base + levels->level[0].height;
    delay->low = fmin(levels->base, other);
    delay->high = fmax(levels->base, other);
    return delay->low < delay->high;
}

/* The delay whose output this node is. */
static const struct dalcs_delay *delay_at(const struct dalcs_builder *builder, int node) {
    const struct dalcs_delay *d = builder->formulas.delay;
    while (d != NULL && d->output != node) {
        d = d->before;
    }
    return d;
}

static bool read_delay(struct dalcs_compiler *c, const struct dalcs_formula *f,
                       struct dalcs_delay *delay) {
    const struct dalcs_form *seconds = dalcs_compile(c, f->argument[1]);
    if (seconds == NULL || !dalcs_form_is_number(seconds) || !(seconds->affine.constant >= 0)) {
        (void)refuse(c, f, "delay(v(a), 200n)", "a delay is a number of seconds, 0 or more");
        return false;
    }
    delay->seconds = seconds->affine.constant;
    return true;
}

/* What is behind x, by a source or a buffer; false: an error was reported. */
static bool find_way(struct dalcs_compiler *c, const struct dalcs_formula *f,
                     struct dalcs_delay *delay) {
    const struct dalcs_formula *x = f->argument[0];
    const struct dalcs_form *form = dalcs_compile(c, x);
    const bool is_node = form != NULL && form->n == 0 && form->affine.n == 1 &&
                         form->affine.constant == 0 && form->affine.term[0].coefficient == 1 &&
                         form->affine.term[0].kind == DALCS_QUANTITY_VOLTAGE;
    delay->input = is_node ? form->affine.term[0].index : -1;
    const struct dalcs_delay *other = is_node ? delay_at(c->builder, delay->input) : NULL;
    const bool has_other = other != NULL && !other->is_source && !other->is_later;
    const struct dalcs_stimulus *s = other != NULL && other->is_source ? &other->stimulus
                                     : is_node                         ? source_of(c, delay->input)
                                                                       : NULL;
    delay->low = has_other ? other->low : 0;
    delay->high = has_other ? other->high : 0;
    if (s != NULL && !s->is_written && !may_be_another(c, s)) {
        delay->stimulus = *s;
        delay->is_source = shift(c, &delay->stimulus, delay->seconds);
    }
    if (!delay->is_source && !has_other &&
        !(s != NULL && find_gate_levels(c->builder->circuit, s, delay)) &&
        (form == NULL || !find_levels(c, x, form, delay))) {
        delay->is_later = form != NULL && !c->failed;
    }
    int source;
    if (form != NULL && !delay->is_source && !is_node) {
        delay->input = dalcs_compiler_node_at(c, "undelayed", x, false, &source);
    }
    return !c->failed && (delay->is_source || delay->input >= 0);
}

const struct dalcs_form *dalcs_delay_form(struct dalcs_compiler *c, const struct dalcs_formula *f) {
    struct dalcs_builder *builder = c->builder;
    if (c->is_silent || c->smooth_node == NULL || c->failed) {
        c->failed = true;
        return NULL;
    }
    int *node = &c->smooth_node[f->number_of];
    if (*node == 0) {
        struct dalcs_delay *delay = dalcs_arena_alloc(&builder->scratch, 1, sizeof *delay);
        if (delay == NULL) {
            builder->out_of_memory = c->failed = true;
            return NULL;
        }
        *delay = (struct dalcs_delay){0};
        if (!read_delay(c, f, delay)) {
            return NULL;
        }
        if (delay->seconds == 0) {
            return dalcs_compile(c, f->argument[0]);
        }
        if (!find_way(c, f, delay)) {
            c->failed = true;
            return NULL;
        }
        delay->output = dalcs_compiler_new_node(c, "delayed");
        const char *name =
            dalcs_arena_printf(&builder->scratch, "delay%d(%s)", c->n_nodes, c->element->text);
        delay->name = name != NULL ? dalcs_formula_name(builder, c->element, name) : NULL;
        builder->out_of_memory = builder->out_of_memory || delay->name == NULL;
        c->failed = c->failed || builder->out_of_memory;
        delay->before = builder->formulas.delay;
        builder->formulas.delay = delay;
        *node = delay->output;
    }
    const struct dalcs_affine v = dalcs_affine_of(c, DALCS_QUANTITY_VOLTAGE, *node);
    return c->failed ? NULL : dalcs_form_affine(c, &v);
}

size_t dalcs_delay_pending(const struct dalcs_builder *builder) {
    size_t n = 0;
    for (const struct dalcs_delay *d = builder->formulas.delay; d != NULL; d = d->before) {
        n++;
    }
    return n;
}

/* ---- When all formulas are compiled ---------------------------------------------------------------------------- */

static void add_source(struct dalcs_builder *builder, const struct dalcs_delay *delay) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_device *v =
        dalcs_builder_add_inner_device(builder, DALCS_VSOURCE, "v", delay->name);
    if (v != NULL) {
        v->node[0] = delay->output;
        v->stimulus = circuit->n_stimuli++;
        circuit->stimulus[v->stimulus] = delay->stimulus;
    }
}

static void add_later(struct dalcs_builder *builder, const struct dalcs_delay *delay) {
    const struct dalcs_later later = {.name = delay->name,
                                      .what = "later",
                                      .input = delay->input,
                                      .output = {delay->output, 0},
                                      .seconds = delay->seconds};
    dalcs_later_add(builder, &later);
}

static void add_buffer(struct dalcs_builder *builder, const struct dalcs_delay *delay) {
    struct dalcs_logic_card *of = dalcs_logic_start(builder, delay->name, 1);
    if (of == NULL) {
        return;
    }
    struct dalcs_logic_gate *g = of->gate;
    g->kind = DALCS_GATE_BUFFER;
    g->low = delay->low;
    g->high = delay->high;
    g->delay[0] = g->delay[1] = delay->seconds;
    of->is_element = false;
    of->pin[0] = (struct dalcs_logic_pin){.is_wired = true, .node = delay->input};
    of->on = of->off = 0.5 * (delay->low + delay->high);
    of->node[0] = delay->output;
    dalcs_logic_add(builder, of);
}

void dalcs_delay_resolve(struct dalcs_builder *builder) {
    for (const struct dalcs_delay *d = builder->formulas.delay;
         d != NULL && !builder->out_of_memory; d = d->before) {
        if (!dalcs_builder_reserve_devices(builder, DALCS_GATE_DEVICES)) {
            return;
        }
        if (d->is_later) {
            add_later(builder, d);
        } else if (d->is_source) {
            add_source(builder, d);
        } else {
            add_buffer(builder, d);
        }
    }
}

/* decided.c - formulas of what sources alone decide become stimuli: their kinks and jumps are times that can be computed,
 * and need no complementarity pairs.
 *
 * Decided are the voltages along V sources from ground, and along sources whose formula is decided itself: so are dead
 * times behind comparisons behind carriers. Not along what is written while a run goes on, by a gate or from outside: its
 * times are not known before, and a formula has a copy of what stood there first. Not where .dc, .ac or a script may give
 * a source another value than its stimulus, which such a formula would not see; nor where the outputs of gates move with
 * small signals. */
#include "behaviour.h"

#include <stdlib.h>
#include <string.h>

/* ---- Potentials --------------------------------------------------------------------------------- */

static bool is_free(const struct dalcs_builder *builder) {
    return builder->analyses.dc != NULL || builder->analyses.ac != NULL ||
           builder->analyses.tf != NULL || builder->netlist->commands.n > 0 ||
           builder->netlist->asks.response || builder->circuit->control.is_whole;
}

/* Breadth first along V sources: end e of device i has the number 2 i + e, and 1. */
static void spread(struct dalcs_potentials *p, const struct dalcs_circuit *c, int *first, int *next,
                   int *queue) {
    for (int end = 0; end < 2 * c->n_devices; end++) {
        const struct dalcs_device *d = &c->device[end / 2];
        const bool has_course = d->kind == DALCS_VSOURCE && d->stimulus >= 0;
        if (has_course && !c->stimulus[d->stimulus].is_written) {
            next[end] = first[d->node[end % 2]];
            first[d->node[end % 2]] = end + 1;
        }
    }
    queue[0] = 0;
    for (int q = 0, n = 1; q < n; q++) {
        for (int end = first[queue[q]]; end > 0; end = next[end - 1]) {
            const int device = (end - 1) / 2;
            const int other = c->device[device].node[end % 2];
            if (other != 0 && p->device[other] == 0) {
                p->device[other] = device + 1;
                queue[n++] = other;
            }
        }
    }
}

void dalcs_potentials_find(struct dalcs_potentials *p, struct dalcs_builder *builder) {
    const struct dalcs_circuit *c = builder->circuit;
    const size_t n_nodes = (size_t)c->n_nodes;
    int *first = calloc(n_nodes, sizeof *first);
    int *next = calloc(2 * (size_t)c->n_devices + 1, sizeof *next);
    int *queue = calloc(n_nodes, sizeof *queue);
    p->device = calloc(n_nodes, sizeof *p->device);
    if (first == NULL || next == NULL || queue == NULL || p->device == NULL) {
        builder->out_of_memory = true;
    } else if (!is_free(builder)) {
        p->n = c->n_nodes;
        spread(p, c, first, next, queue);
    }
    free(first);
    free(next);
    free(queue);
}

void dalcs_potentials_finish(struct dalcs_potentials *p) {
    free(p->device);
    *p = (struct dalcs_potentials){0};
}

static bool is_known(const struct dalcs_potentials *p, int node) {
    return node == 0 || (node < p->n && p->device[node] > 0);
}

void dalcs_potentials_note(struct dalcs_potentials *p, const struct dalcs_circuit *circuit,
                           int device) {
    const struct dalcs_device *d = &circuit->device[device];
    for (int e = 0; e < 2 && dalcs_device_is_decided(d); e++) {
        if (d->node[e] < p->n && !is_known(p, d->node[e]) && is_known(p, d->node[1 - e])) {
            p->device[d->node[e]] = device + 1;
        }
    }
}

struct reach {
    const struct dalcs_potentials *potentials;
    bool has_pairs, found;
};

static void look_at(void *to, const struct dalcs_affine_term *term) {
    struct reach *r = to;
    r->found = r->found || (r->has_pairs && term->kind == DALCS_QUANTITY_STIMULUS) ||
               (term->kind == DALCS_QUANTITY_VOLTAGE && is_known(r->potentials, term->index));
}

bool dalcs_potentials_reach(const struct dalcs_potentials *p,
                            const struct dalcs_behaviour *behaviour) {
    struct reach r = {.potentials = p, .has_pairs = behaviour->n_pairs > 0};
    dalcs_behaviour_visit(behaviour, look_at, &r);
    return r.found;
}

/* ---- Stimuli ------------------------------------------------------------------------------------ */

static void add_stimulus(struct dalcs_compiler *c, struct dalcs_affine *sum, double factor,
                         int stimulus) {
    const struct dalcs_affine one = dalcs_affine_of(c, DALCS_QUANTITY_STIMULUS, stimulus);
    *sum = dalcs_affine_add(c, sum, factor, &one);
}

static bool add_potential(struct dalcs_compiler *c, struct dalcs_affine *sum, double factor,
                          int node) {
    const struct dalcs_circuit *circuit = c->builder->circuit;
    while (node != 0) {
        if (!is_known(c->potentials, node)) {
            return false;
        }
        const int device = c->potentials->device[node] - 1;
        const struct dalcs_device *d = &circuit->device[device];
        const bool upward = d->node[0] == node;
        const int stimulus =
            d->kind == DALCS_VSOURCE ? d->stimulus : d->behaviour->output.term[0].index;
        add_stimulus(c, sum, upward ? factor : -factor, stimulus);
        node = d->node[upward ? 1 : 0];
    }
    return true;
}

/* The same with nothing but stimuli in it. */
static bool to_stimuli(struct dalcs_compiler *c, const struct dalcs_affine *a,
                       struct dalcs_affine *sum) {
    bool is_decided = true;
    *sum = dalcs_affine_constant(a->constant);
    for (int k = 0; k < a->n && is_decided; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        is_decided = term->kind == DALCS_QUANTITY_TIME || term->kind == DALCS_QUANTITY_WAVE ||
                     term->kind == DALCS_QUANTITY_STIMULUS ||
                     (term->kind == DALCS_QUANTITY_VOLTAGE && is_known(c->potentials, term->index));
    }
    for (int k = 0; k < a->n && is_decided && !c->failed; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        struct dalcs_piecewise line;
        switch (term->kind) {
        case DALCS_QUANTITY_VOLTAGE:
            is_decided = add_potential(c, sum, term->coefficient, term->index);
            break;
        case DALCS_QUANTITY_WAVE:
            add_stimulus(c, sum, term->coefficient, dalcs_wave_stimulus(c, term->index));
            break;
        case DALCS_QUANTITY_TIME:
            is_decided = dalcs_piecewise_line(c->arena, 0, 1, &line);
            c->failed = c->failed || !is_decided;
            add_stimulus(c, sum, term->coefficient,
                         is_decided ? dalcs_time_stimulus(c, &line) : -1);
            break;
        default:
            add_stimulus(c, sum, term->coefficient, term->index);
            break;
        }
    }
    return is_decided && !c->failed;
}

static const struct dalcs_stimulus *stimulus_of(const struct dalcs_compiler *c, int index) {
    const struct dalcs_circuit *circuit = c->builder->circuit;
    return index < circuit->n_stimuli ? &circuit->stimulus[index]
                                      : &c->stimulus[index - circuit->n_stimuli];
}

/* What is nothing but a sum of others is none of its own in a sum. */
static bool is_sum(const struct dalcs_stimulus *s) {
    const struct dalcs_piecewise *f = &s->u.formula.function;
    return s->kind == DALCS_STIMULUS_FORMULA && f->n == 1 && f->before == 1 && f->after == 1 &&
           f->knot[0].at == 0 && f->knot[0].left == 0 && f->knot[0].value == 0 &&
           f->knot[0].right == 0;
}

static int count_parts(const struct dalcs_compiler *c, const struct dalcs_affine *a) {
    int n = 0;
    for (int k = 0; k < a->n; k++) {
        const struct dalcs_stimulus *s = stimulus_of(c, a->term[k].index);
        n += is_sum(s) ? s->u.formula.argument.n : 1;
    }
    return n;
}

/* A formula that reads another one twice, which reads another one twice ... is evaluated from the bottom each time:
 * with more stimuli than this in it pairs are cheaper. */
enum { MOST_STIMULI = 256 };

static int count_stimuli(const struct dalcs_stimulus *s) {
    int n = 1;
    for (int k = 0; s->kind == DALCS_STIMULUS_FORMULA && k < s->u.formula.argument.n; k++) {
        n += count_stimuli(s->u.formula.argument.part[k].of);
    }
    return n;
}

/* Copies: the arrays of stimuli still grow. false: out of memory, or too many oscillations or stimuli. */
static bool copy_parts(struct dalcs_compiler *c, const struct dalcs_affine *a,
                       struct dalcs_stimulus_sum *sum) {
    struct dalcs_arena *arena = &c->builder->circuit->arena;
    const size_t n = (size_t)count_parts(c, a);
    struct dalcs_stimulus_summand *part = dalcs_arena_alloc(arena, n, sizeof *part);
    struct dalcs_stimulus *of = dalcs_arena_alloc(arena, (size_t)a->n, sizeof *of);
    if (part == NULL || of == NULL) {
        c->builder->out_of_memory = c->failed = true;
        return false;
    }
    *sum = (struct dalcs_stimulus_sum){.constant = a->constant, .part = part};
    for (int k = 0; k < a->n; k++) {
        const double factor = a->term[k].coefficient;
        of[k] = *stimulus_of(c, a->term[k].index);
        const struct dalcs_stimulus_sum *inner = is_sum(&of[k]) ? &of[k].u.formula.argument : NULL;
        sum->constant += inner != NULL ? factor * inner->constant : 0;
        for (int i = 0; inner != NULL && i < inner->n; i++) {
            part[sum->n++] =
                (struct dalcs_stimulus_summand){factor * inner->part[i].factor, inner->part[i].of};
        }
        if (inner == NULL) {
            part[sum->n++] = (struct dalcs_stimulus_summand){factor, &of[k]};
        }
    }
    int n_terms = 0;
    int n_stimuli = 0;
    for (int k = 0; k < sum->n; k++) {
        n_terms += dalcs_stimulus_n_terms(part[k].of);
        n_stimuli += count_stimuli(part[k].of);
    }
    return n_terms <= DALCS_STIMULUS_MOST_TERMS && n_stimuli <= MOST_STIMULI;
}

static bool copy_function(struct dalcs_compiler *c, const struct dalcs_piecewise *f,
                          struct dalcs_piecewise *copy) {
    static const struct dalcs_knot ZERO = {0, 0, 0, 0};
    const size_t n = f != NULL ? (size_t)f->n : 1;
    struct dalcs_knot *knot = dalcs_arena_alloc(&c->builder->circuit->arena, n, sizeof *knot);
    if (knot == NULL) {
        c->builder->out_of_memory = c->failed = true;
        return false;
    }
    memcpy(knot, f != NULL ? f->knot : &ZERO, n * sizeof *knot);
    *copy = f != NULL ? *f : (struct dalcs_piecewise){.n = 1, .before = 1, .after = 1};
    copy->knot = knot;
    return true;
}

bool dalcs_decided(struct dalcs_compiler *c, const struct dalcs_affine *argument,
                   const struct dalcs_piecewise *f, struct dalcs_affine *stimulus) {
    struct dalcs_affine sum;
    if (argument->n == 0 || !to_stimuli(c, argument, &sum) || sum.n == 0) {
        return false;
    }
    if (f == NULL && sum.n == 1 && sum.constant == 0 && sum.term[0].coefficient == 1) {
        *stimulus = sum;
        return true;
    }
    struct dalcs_stimulus s = {.kind = DALCS_STIMULUS_FORMULA};
    if (!copy_parts(c, &sum, &s.u.formula.argument) ||
        !copy_function(c, f, &s.u.formula.function)) {
        return false;
    }
    *stimulus = dalcs_affine_of(c, DALCS_QUANTITY_STIMULUS, dalcs_compiler_add_stimulus(c, &s));
    return !c->failed;
}

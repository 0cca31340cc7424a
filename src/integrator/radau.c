/* radau.c - the parts of a run: set up, started, passed from segment to segment, evaluated. */
#include "radau.h"
#include "choice.h"
#include "cycle.h"
#include "dense_map.h"
#include "guards.h"
#include "periodic.h"
#include "present.h"
#include "quads.h"
#include "recurrence.h"
#include "restart.h"
#include "segment.h"
#include "step_length.h"
#include "transition.h"
#include "twins.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Errors are kept this much smaller than asked for: they add up over a run. */
static const double inner_part = 0.03;
static const double largest_inner = 3e-7;
static const double smallest_inner = 1e-12;

/* So much of them is lost among them, though rounding may be in currents that follow from voltages. */
static const double unseen_part = 1e-5;

/* A step that follows the fastest source, over the one that just would if nothing else were there:
 * measured, currents of capacitors are more demanding than the source. */
static const double paced_part = 0.65;

enum { FIRST_STEPS = 64 };

/* There is a power of 2 from a length up to twice that. */
static const double below_twice = 2.0 * (1.0 - 1e-9);

static double inner_tolerance_of(double tolerance) {
    return fmax(smallest_inner, fmin(largest_inner, inner_part * tolerance));
}

static bool has_memory_or_sides(const struct dalcs_system *s) {
    return s->n_x > 0 || s->n_pairs > 0;
}

/* Inputs that probes of this system read. */
static void list_used_inputs(struct dalcs_radau_part *part, const struct dalcs_network *n,
                             bool *used) {
    for (int i = 0; i < n->n_outputs; i++) {
        const struct dalcs_probe *probe[2] = {&n->output[i].plus, &n->output[i].minus};
        for (int side = 0; side < 2; side++) {
            if (probe[side]->system != part->index) {
                continue;
            }
            for (int k = 0; k < probe[side]->n_inputs; k++) {
                used[probe[side]->term[probe[side]->n_terms + k].index] = true;
            }
        }
    }
    const struct dalcs_system *s = part->component->system;
    for (int k = 1; k < s->n_inputs; k++) {
        if (used[k] &&
            part->component->circuit->stimulus[s->stimulus[k]].kind != DALCS_STIMULUS_DC) {
            part->used_input[part->n_used_inputs++] = k;
        }
    }
}

/* Bytes that a part keeps for the run, with something to spare: small ones are made of one piece. */
static size_t room_for_part(const struct dalcs_system *s) {
    enum { FOR_ALL = 8192, FOR_A_COLUMN = 640 };

    return FOR_ALL + FOR_A_COLUMN * (size_t)dalcs_system_n_columns(s);
}

static bool allocate_probe(struct dalcs_radau_part *part) {
    struct dalcs_lever_probe *p = &part->scales.probe;
    size_t n_levered = (size_t)part->stages.n_levered;
    p->rounding = dalcs_arena_alloc(&part->arena, n_levered, sizeof(double));
    p->drift = dalcs_arena_alloc(&part->arena, n_levered, sizeof(double));
    p->in = dalcs_arena_alloc(&part->arena, (size_t)part->stages.n_in, sizeof(double));
    return p->rounding != NULL && p->drift != NULL && p->in != NULL;
}

static enum dalcs_status allocate(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    size_t n_columns = (size_t)dalcs_system_n_columns(s);
    size_t n_guards = (size_t)(s->n_pairs + part->stages.n_watched);
    size_t n_out = (size_t)l->n_fixed + (size_t)part->stages.method->s * n_columns + 8;
    part->x = dalcs_arena_alloc(&part->arena, (size_t)dalcs_quads_of(s->n_x), sizeof(double));
    part->segment.in = dalcs_arena_alloc(&part->arena, (size_t)part->stages.n_in, sizeof(double));
    part->segment.out = dalcs_arena_alloc(&part->arena, n_out, sizeof(double));
    part->segment.in_before =
        dalcs_arena_alloc(&part->arena, (size_t)part->stages.n_in, sizeof(double));
    part->segment.out_before = dalcs_arena_alloc(&part->arena, n_out, sizeof(double));
    part->work.out_tried = dalcs_arena_alloc(&part->arena, n_out, sizeof(double));
    part->guards.armed = dalcs_arena_alloc(&part->arena, n_guards, sizeof(bool));
    part->guards.crossed = dalcs_arena_alloc(&part->arena, n_guards, sizeof(int));
    part->guards.tied = dalcs_arena_alloc(&part->arena, (size_t)s->n_pairs, sizeof(bool));
    part->work.u = dalcs_arena_alloc(&part->arena, (size_t)(s->n_x + s->n_inputs), sizeof(double));
    part->work.y1 =
        dalcs_arena_alloc(&part->arena, (size_t)dalcs_quads_of(l->stride), sizeof(double));
    part->work.y2 =
        dalcs_arena_alloc(&part->arena, (size_t)dalcs_quads_of(l->stride), sizeof(double));
    part->work.w1 = dalcs_arena_alloc(&part->arena, (size_t)s->n_pairs, sizeof(double));
    part->work.after = dalcs_arena_alloc(&part->arena, (size_t)s->n_x, sizeof(double));
    part->used_input = dalcs_arena_alloc(&part->arena, (size_t)s->n_inputs, sizeof(int));
    int most_levered = part->stages.n_levered > s->n_pairs ? part->stages.n_levered : s->n_pairs;
    part->scales.current_drift =
        dalcs_arena_alloc(&part->arena, (size_t)dalcs_dense_map_rows(most_levered), sizeof(double));
    part->scales.pair_parts = dalcs_arena_alloc(&part->arena, (size_t)s->n_pairs, sizeof(double));
    part->scales.current_parts =
        dalcs_arena_alloc(&part->arena, (size_t)part->stages.n_levered, sizeof(double));
    bool complete = part->x != NULL && part->segment.in != NULL && part->segment.out != NULL &&
                    part->segment.in_before != NULL && part->segment.out_before != NULL &&
                    part->work.out_tried != NULL && part->guards.armed != NULL &&
                    part->guards.crossed != NULL && part->guards.tied != NULL &&
                    part->work.u != NULL && part->work.y1 != NULL && part->work.y2 != NULL &&
                    part->work.w1 != NULL && part->work.after != NULL && part->used_input != NULL &&
                    part->scales.current_drift != NULL && part->scales.current_parts != NULL &&
                    part->scales.pair_parts != NULL;
    return complete && (dalcs_stages_have_maps(&part->stages) || allocate_probe(part))
               ? DALCS_OK
               : DALCS_E_NOMEM;
}

/* Where a circuit carries no current, rounding must not be taken for one: its voltages could drive a
 * current through the least of its conductances, and a millionth of that counts as nothing. */
static const double nothing = 1e-6;

static void find_cross_scales(const struct dalcs_conductances *g, double *cross) {
    cross[0] = g->most > 0.0 ? nothing / g->most : nothing;
    cross[1] = g->most > 0.0 ? nothing * g->least : nothing;
}

/* One of the rungs is a step that follows the fastest source, which sets the pace where nothing else
 * does. Few digits: sums of steps stay exact. */
static double fit_rung(double promising) {
    int exponent;
    double paced = paced_part * promising;
    return isinf(promising) ? 1.0 : floor(64.0 * frexp(paced, &exponent)) / 32.0;
}

static enum dalcs_status part_setup(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                    const struct dalcs_osnsp_options *osnsp) {
    struct dalcs_component *c = part->component;
    c->osnsp.is_passing = true;
    bool steps = has_memory_or_sides(c->system);
    part->kind = steps ? DALCS_PART_STEPPED : DALCS_PART_ALGEBRAIC;
    struct dalcs_conductances g = dalcs_conductances_find(c->system, r->options.stop);
    find_cross_scales(&g, part->scales.cross);
    part->scales.leak = 0.5 * DBL_EPSILON * g.joint;
    struct dalcs_choice choice = dalcs_choice_make(&r->options, c, &g, osnsp->dense_limit);
    part->tolerance = choice.tolerance;
    part->inner_tolerance = inner_tolerance_of(choice.tolerance);
    part->because = steps ? choice.because : "no state, no diode and no switch";
    DALCS_TRY(dalcs_excitation_setup(&part->excitation, c->circuit, c->system));
    DALCS_TRY(dalcs_commands_setup(&part->commands, c->circuit, c->system));
    DALCS_TRY(dalcs_stages_setup(&part->stages, c->system, &part->excitation,
                                 dalcs_collocation_of(r->options.family, choice.stages),
                                 choice.map_limit, osnsp->rcond_min,
                                 osnsp->cache_bytes / (size_t)r->n_parts));
    part->stages.block_of = c->osnsp.partition.block_of;
    part->stages.unseen = r->options.fixed_step > 0.0 ? 0.0 : unseen_part * part->inner_tolerance;
    DALCS_TRY(dalcs_arena_reserve(&part->arena, room_for_part(c->system)));
    DALCS_TRY(allocate(part));
    DALCS_TRY(dalcs_transition_setup(part));
    DALCS_TRY(dalcs_guards_setup(part));
    DALCS_TRY(dalcs_twins_setup(part));
    DALCS_TRY(dalcs_step_setup(part));
    bool *used = dalcs_arena_alloc(&part->arena, (size_t)c->system->n_inputs, sizeof(bool));
    if (used == NULL) {
        return DALCS_E_NOMEM;
    }
    list_used_inputs(part, r->base->network, used);
    part->length.longest = dalcs_length_longest(r, part);
    part->length.longest_needed = below_twice * dalcs_length_of_spans(part);
    double first = fmin(part->length.longest_needed,
                        fmin(part->length.longest, r->options.stop / FIRST_STEPS));
    double promising = dalcs_length_promising(part);
    part->length.rung = fit_rung(promising);
    part->length.level = -ilogb(fmin(first, promising) / part->length.rung);
    part->length.patience = 32;
    DALCS_TRY(dalcs_periodic_setup(r, part));
    if (dalcs_stages_have_maps(&part->stages)) {
        part->segment.rounding = 1.0; /* before there is a step, too */
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_radau_setup(struct dalcs_radau *r, struct dalcs_euler *base,
                                    const struct dalcs_radau_options *options,
                                    const struct dalcs_osnsp_options *osnsp) {
    *r = (struct dalcs_radau){.base = base, .options = *options, .n_parts = base->n_components};
    int exponent;
    (void)frexp(options->stop, &exponent);
    r->resolution = ldexp(1.0, exponent - 50);
    r->inner_tolerance = inner_tolerance_of(options->tolerance);
    r->besides[0] = 0.1 * options->vntol;
    r->besides[1] = 0.1 * options->abstol;
    r->part = dalcs_alloc((size_t)r->n_parts, sizeof(*r->part));
    enum dalcs_status status = r->part != NULL ? DALCS_OK : DALCS_E_NOMEM;
    for (int k = 0; k < r->n_parts && status == DALCS_OK; k++) {
        r->part[k].component = &base->component[k];
        r->part[k].index = k;
        status = part_setup(r, &r->part[k], osnsp);
    }
    status = status == DALCS_OK ? dalcs_cycle_setup(r) : status;
    if (status != DALCS_OK) {
        dalcs_radau_finish(r);
    }
    return status;
}

static void part_finish(struct dalcs_radau_part *part) {
    dalcs_transition_finish(part); /* first: it holds steps */
    dalcs_periodic_finish(part);
    dalcs_cycle_finish(part);
    if (part->stages.system != NULL) {
        dalcs_stages_finish(&part->stages);
    }
    dalcs_excitation_finish(&part->excitation);
    dalcs_commands_finish(&part->commands);
    dalcs_arena_finish(&part->arena);
}

void dalcs_radau_finish(struct dalcs_radau *r) {
    for (int k = 0; r->part != NULL && k < r->n_parts; k++) {
        part_finish(&r->part[k]);
    }
    free(r->part);
    *r = (struct dalcs_radau){0};
}

static void obey_commands(struct dalcs_radau_part *part) {
    for (int k = 0; k < part->commands.n; k++) {
        const struct dalcs_command *m = &part->commands.command[k];
        dalcs_osnsp_command(&part->component->osnsp, m->pair, m->is_on);
    }
}

/* Those of the operating point, where there was one: a hysteresis goes on from there. */
static void remember_switches(struct dalcs_radau_part *part) {
    for (int k = 0; k < part->commands.n; k++) {
        struct dalcs_command *m = &part->commands.command[k];
        m->is_on = dalcs_osnsp_is_on(&part->component->osnsp, m->pair);
    }
}

enum dalcs_status dalcs_radau_start(struct dalcs_radau *r, double *const *initial) {
    for (int k = 0; k < r->n_parts; k++) {
        struct dalcs_radau_part *part = &r->part[k];
        struct dalcs_component *c = part->component;
        const double *x = initial != NULL ? initial[k] : c->y;
        memcpy(part->x, x, (size_t)c->system->n_x * sizeof(double));
        dalcs_component_sample(c, 0.0, DALCS_RIGHT, c->u);
        if (r->base->observer != NULL) {
            r->base->observer->start(r->base->observer->user, k, x);
        }
        if (part->kind == DALCS_PART_ALGEBRAIC) {
            part->segment.t_end = INFINITY;
            continue;
        }
        remember_switches(part);
        dalcs_commands_start(&part->commands);
        obey_commands(part);
        part->guards.fresh = true;
        part->guards.seen = INFINITY;
        if (initial != NULL || dalcs_component_jumps_at_start(c)) {
            bool is_off; /* for the first segment to find */
            DALCS_TRY(dalcs_radau_restart(r, part, 0, false, &is_off));
        }
        DALCS_TRY(dalcs_segment_begin(r, part));
    }
    return dalcs_radau_tell_open(r);
}

double dalcs_radau_next_stop(const struct dalcs_radau *r, bool *happens) {
    double next = INFINITY;
    *happens = false;
    for (int k = 0; k < r->n_parts; k++) {
        const struct dalcs_radau_part *part = &r->part[k];
        bool event = part->segment.why != DALCS_END_OF_STEP;
        if (part->segment.t_end < next) {
            next = part->segment.t_end;
            *happens = event;
        } else if (part->segment.t_end == next) {
            *happens = *happens || event;
        }
    }
    return next;
}

/* Events closer upon each other than this part of the stop time are a flurry. */
static const double close = 0x1p-30;

/* Too many events in no time: an accumulation, or a mode that cannot be told. Or one upon the other without
 * end: rounding of what is 0 goes to and fro. Steps of implicit Euler leave either behind, with no event at
 * their ends. */
static void count_crowd(const struct dalcs_radau *r, struct dalcs_radau_part *part) {
    if (part->segment.t - part->memory.crowd_since > 1e4 * r->resolution) {
        part->memory.crowd_since = part->segment.t;
        part->memory.crowd = 0;
    }
    part->memory.flurry = part->segment.t - part->memory.last_event > close * r->options.stop
                              ? 0
                              : part->memory.flurry;
    if (part->guards.n_crossed > 0) {
        part->memory.crowd++;
        part->memory.flurry++;
        part->memory.last_event = part->segment.t;
    }
}

/* [n_columns] where the segment ends; inside the step by way of part->y1. */
static const double *end_of_segment(struct dalcs_radau_part *part) {
    dalcs_recurrence_complete(part);
    if (part->segment.end == 1.0) {
        return part->segment.out + part->stages.method->s * part->stages.layout.stride;
    }
    dalcs_step_values(part, part->segment.end, part->work.y1);
    return part->work.y1;
}

/* The last segment is kept while the next one is looked for: there may be none. */
static void set_aside(struct dalcs_radau_part *part) {
    double *in = part->segment.in;
    part->segment.in = part->segment.in_before;
    part->segment.in_before = in;
    dalcs_radau_swap_out(part, &part->segment.out_before);
    part->segment.end_before = part->segment.end;
    part->segment.late_before = part->segment.late;
    part->segment.late = NULL;
    part->segment.brief = NULL;
}

/* part->x is the state where the segment ends. */
static void go_to_end(struct dalcs_radau_part *part) {
    size_t state_bytes = (size_t)part->component->system->n_x * sizeof(double);
    const double *known = part->stages.plan == NULL ? dalcs_recurrence_end(part) : NULL;
    if (known != NULL) {
        memcpy(part->x, known, state_bytes);
    } else if (part->segment.end == 1.0 || part->stages.plan != NULL) {
        const double *end = end_of_segment(part);
        memcpy(part->x, end, state_bytes);
        dalcs_stages_stay_near(&part->stages, part->component->osnsp.mode, end);
    } else {
        dalcs_step_states(part, part->segment.end, part->x);
    }
}

/* The next segment of a part that may come back to where it was; repeats: it is known to. */
static enum dalcs_status repeat_or_begin(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                         bool commanded, bool repeats) {
    dalcs_periodic_look_ahead(part);
    if (!repeats && (part->guards.n_crossed > 0 || commanded)) {
        dalcs_periodic_event(r, part);
        repeats = dalcs_periodic_repeats(r, part);
    }
    if (repeats) {
        dalcs_periodic_take(r, part);
        return DALCS_OK;
    }
    set_aside(part);
    DALCS_TRY(dalcs_segment_begin(r, part));
    return dalcs_periodic_note(part);
}

static enum dalcs_status pass(struct dalcs_radau *r, struct dalcs_radau_part *part) {
    size_t state_bytes = (size_t)part->component->system->n_x * sizeof(double);
    part->segment.jumped = false;
    if (r->base->observer != NULL) {
        memcpy(part->work.after, part->x, state_bytes);
    }
    bool repeats = part->memory.periodic != NULL && dalcs_periodic_repeats(r, part);
    if (!repeats || r->base->observer != NULL) {
        go_to_end(part);
        if (dalcs_component_overgrows(part->component, part->x)) {
            r->base->failed_system = part->index;
            r->base->failed_time = part->segment.t_end;
            return DALCS_NOT_CONVERGED;
        }
    }
    part->guards.fresh =
        part->guards.fresh || part->segment.end != 1.0; /* the next step starts inside this one */
    if (r->base->observer != NULL) {
        r->base->observer->segment(r->base->observer->user, part, part->work.after);
    }
    part->segment.t = part->segment.t_end;
    if (part->guards.n_crossed > 0) {
        dalcs_twins_flip(part);
        part->guards.fresh = true;
        part->guards.flipped = true;
    }
    if (part->guards.n_crossed > 0 || part->segment.by_euler) {
        count_crowd(r, part);
    }
    if (part->excitation.next_edge <= part->segment.t + r->resolution) {
        dalcs_excitation_enter(&part->excitation, part->segment.t);
        part->guards.fresh = true;
    }
    bool commanded = part->commands.next <= part->segment.t + r->resolution &&
                     dalcs_commands_obey(&part->commands, part->segment.t);
    if (commanded) {
        obey_commands(part);
        part->guards.fresh = true;
        part->guards.flipped = true;
    }
    if (part->segment.t >= r->options.stop) {
        return DALCS_OK;
    }
    if (part->memory.periodic != NULL) {
        DALCS_TRY(repeat_or_begin(r, part, commanded, repeats));
    } else {
        set_aside(part);
        DALCS_TRY(dalcs_segment_begin(r, part));
    }
    return part->memory.cycle != NULL ? dalcs_cycle_note(r, part) : DALCS_OK;
}

enum dalcs_status dalcs_radau_pass(struct dalcs_radau *r, double t) {
    bool opens = false;
    for (int k = 0; k < r->n_parts; k++) {
        if (r->part[k].segment.t_end <= t && r->part[k].segment.t < r->options.stop) {
            DALCS_TRY(pass(r, &r->part[k]));
            opens = opens || r->part[k].segment.open;
        }
    }
    return opens ? dalcs_radau_tell_open(r) : DALCS_OK;
}

double dalcs_radau_bystander(const struct dalcs_radau_part *part, int bystander, double t,
                             enum dalcs_side side) {
    const struct dalcs_component *c = part->component;
    const struct dalcs_system *s = c->system;
    const double *gain = part->excitation.bystanders.gain + bystander * s->n_inputs;
    double sum = 0.0;
    for (int k = 0; k < s->n_inputs; k++) {
        if (gain[k] != 0.0) {
            const struct dalcs_stimulus *stimulus =
                k > 0 ? &c->circuit->stimulus[s->stimulus[k]] : NULL;
            sum += gain[k] * (k > 0 ? dalcs_stimulus_value(stimulus, t, side) : 1.0);
        }
    }
    return sum;
}

/* A part without memory has no solution at t: then it has had none, but for single times, since its
 * sources had an edge, for in between they are analytic. */
static void note_failure(const struct dalcs_radau *r, struct dalcs_radau_part *part, double t,
                         enum dalcs_side side) {
    struct dalcs_component *c = part->component;
    double since = 0.0;
    for (double next = 0.0; next < t || (next == t && side == DALCS_RIGHT);) {
        since = next;
        next = INFINITY;
        for (int i = 0; i < c->n_varying; i++) {
            const struct dalcs_stimulus *s =
                &c->circuit->stimulus[c->system->stimulus[c->varying[i]]];
            next = fmin(next, dalcs_stimulus_next_edge(s, since));
        }
    }
    c->failed_sigma = 0.0;
    c->failed_u = c->u;
    r->base->failed_system = part->index;
    r->base->failed_time = since;
}

static void evaluate_stepped(struct dalcs_radau_part *part, double t, enum dalcs_side side) {
    struct dalcs_component *c = part->component;
    const struct dalcs_system *s = c->system;
    const struct dalcs_bystanders *b = &part->excitation.bystanders;
    int n_equations = dalcs_system_n_equations(s);
    dalcs_recurrence_complete(part);
    dalcs_step_values(part, dalcs_radau_theta(part, t), part->work.y1);
    memcpy(c->y, part->work.y1, (size_t)dalcs_system_n_columns(s) * sizeof(double));
    for (int d = 0; d < s->n_pairs; d++) {
        c->y[n_equations + d] *= dalcs_osnsp_is_on(&c->osnsp, d) ? 1.0 : 0.0;
    }
    for (int i = 0; i < b->n; i++) {
        c->y[b->column[i]] = dalcs_radau_bystander(part, i, t, side);
    }
    for (int i = 0; i < part->n_used_inputs; i++) {
        int k = part->used_input[i];
        c->u[s->n_x + k] = dalcs_stimulus_value(&c->circuit->stimulus[s->stimulus[k]], t, side);
    }
}

void dalcs_radau_read(struct dalcs_radau *r, int part, double t, enum dalcs_side side) {
    evaluate_stepped(&r->part[part], t, side);
}

static void evaluate_all_stepped(struct dalcs_radau *r, double t, enum dalcs_side side) {
    for (int k = 0; k < r->n_parts; k++) {
        if (r->part[k].kind == DALCS_PART_STEPPED) {
            evaluate_stepped(&r->part[k], t, side);
        }
    }
}

enum dalcs_status dalcs_radau_solve(struct dalcs_radau *r, struct dalcs_radau_part *part, double t,
                                    enum dalcs_side side) {
    struct dalcs_component *c = part->component;
    const struct dalcs_system *s = c->system;
    if (c->n_varying == 0 && t > 0.0) {
        return DALCS_OK;
    }
    for (int i = 0; i < c->n_varying; i++) {
        int k = c->varying[i];
        c->u[k] = dalcs_stimulus_value(&c->circuit->stimulus[s->stimulus[k]], t, side);
    }
    r->base->t = t;
    enum dalcs_status status = dalcs_component_solve(c, 0.0, c->u, c->y);
    if (status > DALCS_OK) {
        note_failure(r, part, t, side);
    }
    DALCS_TRY(status);
    if (!dalcs_osnsp_is_open(&c->osnsp)) {
        return DALCS_OK;
    }
    evaluate_all_stepped(r, t, side); /* voltages between parts are told, too */
    return dalcs_euler_tell_open(r->base, part->index);
}

enum dalcs_status dalcs_radau_evaluate(struct dalcs_radau *r, double t, enum dalcs_side side) {
    evaluate_all_stepped(r, t, side);
    for (int k = 0; k < r->n_parts; k++) {
        if (r->part[k].kind == DALCS_PART_ALGEBRAIC) {
            DALCS_TRY(dalcs_radau_solve(r, &r->part[k], t, side));
        }
    }
    return DALCS_OK;
}

static void evaluate_end_of_last(struct dalcs_radau_part *part) {
    struct dalcs_component *c = part->component;
    dalcs_recurrence_complete_before(part);
    dalcs_radau_swap_out(part, &part->segment.out_before);
    dalcs_step_values(part, part->segment.end_before, part->work.y1);
    memcpy(c->y, part->work.y1, (size_t)dalcs_system_n_columns(c->system) * sizeof(double));
}

/* A component that found no next segment is where its last one ended. */
void dalcs_radau_break_off(struct dalcs_radau *r, double t) {
    for (int k = 0; k < r->n_parts; k++) {
        struct dalcs_radau_part *part = &r->part[k];
        if (part->kind != DALCS_PART_STEPPED) {
            continue;
        }
        if (part->segment.t_end > part->segment.t) {
            evaluate_stepped(part, t, DALCS_LEFT);
        } else if (part->segment.t > 0.0) {
            evaluate_end_of_last(part);
        }
    }
}

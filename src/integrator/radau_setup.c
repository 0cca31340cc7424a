/* radau_setup.c - the parts of a run: what they are, their room, how exact they are to be. */
#include "choice.h"
#include "cycle.h"
#include "delays.h"
#include "dense_map.h"
#include "guards.h"
#include "magnitudes.h"
#include "periodic.h"
#include "quads.h"
#include "radau.h"
#include "smooth_step.h"
#include "stage_store.h"
#include "step_length.h"
#include "transition.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Errors are kept this much smaller than asked for: they add up over a run. */
static const double inner_part = 0.03;

static const double smallest_inner = 1e-12;

/* A step that follows the fastest source, over the one that just would if nothing else were there:
 * measured, currents of capacitors are more demanding than the source. */
static const double paced_part = 0.65;

enum { FIRST_STEPS = 64 };

static double inner_tolerance_of(double tolerance) {
    return fmax(smallest_inner, fmin(dalcs_nothing, inner_part * tolerance));
}

static bool has_memory_or_sides(const struct dalcs_circuit *c, const struct dalcs_system *s) {
    return s->n_x > 0 || s->n_pairs > 0 || c->control.n_delayed > 0;
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
            part->used.input[part->used.n++] = k;
        }
    }
}

/* Bytes that a part keeps for the run, with something to spare: small ones are made of one piece. */
static size_t room_for_part(const struct dalcs_system *s) {
    enum { FOR_ALL = 8192, FOR_A_COLUMN = 640 };

    return FOR_ALL + FOR_A_COLUMN * (size_t)dalcs_system_n_columns(s);
}

static enum dalcs_status allocate(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    size_t n_guards = (size_t)(s->n_pairs + part->stages.n_watched);
    size_t n_out = dalcs_stages_room(&part->stages);
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
    part->work.before = dalcs_arena_alloc(&part->arena, (size_t)s->n_x, sizeof(double));
    part->work.size =
        dalcs_arena_alloc(&part->arena, (size_t)dalcs_system_n_columns(s), sizeof(double));
    const bool slides = dalcs_positions_may_slide(&part->component->positions);
    if (slides) {
        part->work.node_w = dalcs_arena_alloc(&part->arena, (size_t)l->n_nodes * (size_t)s->n_pairs,
                                              sizeof(double));
    }
    part->used.input = dalcs_arena_alloc(&part->arena, (size_t)s->n_inputs, sizeof(int));
    part->scales.current_drift = dalcs_arena_alloc(
        &part->arena, (size_t)dalcs_dense_map_rows(part->stages.n_levered), sizeof(double));
    part->scales.current_parts =
        dalcs_arena_alloc(&part->arena, (size_t)part->stages.n_levered, sizeof(double));
    bool complete = part->x != NULL && part->segment.in != NULL && part->segment.out != NULL &&
                    part->segment.in_before != NULL && part->segment.out_before != NULL &&
                    part->work.out_tried != NULL && part->guards.armed != NULL &&
                    part->guards.crossed != NULL && part->guards.tied != NULL &&
                    part->work.u != NULL && part->work.y1 != NULL && part->work.y2 != NULL &&
                    part->work.w1 != NULL && part->work.after != NULL &&
                    part->work.before != NULL && part->work.size != NULL &&
                    (!slides || part->work.node_w != NULL) && part->used.input != NULL &&
                    part->scales.current_drift != NULL && part->scales.current_parts != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

/* Where a circuit carries no current, rounding must not be taken for one: its voltages could drive a
 * current through the least of its conductances. */
static void find_cross_scales(const struct dalcs_conductances *g, double *cross) {
    cross[0] = g->most > 0.0 ? dalcs_nothing / g->most : dalcs_nothing;
    cross[1] = g->most > 0.0 ? dalcs_nothing * g->least : dalcs_nothing;
}

/* What equations add whatever the signals are, and what that could drive through the least of the conductances: where all
 * else is 0, their rounding is left. */
static void find_constants(const struct dalcs_osnsp *osnsp, const struct dalcs_conductances *g,
                           double *constant) {
    for (int k = 0; k < osnsp->lists.n_drives; k++) {
        const struct dalcs_drive *d = &osnsp->lists.drive[k];
        if (d->input == osnsp->system->n_x) {
            constant[d->is_current] = fmax(constant[d->is_current], d->coefficient);
        }
    }
    if (g->most > 0.0) {
        const double volt = constant[0];
        constant[0] = fmax(volt, constant[1] / g->most);
        constant[1] = fmax(constant[1], volt * g->least);
    }
}

/* One of the rungs is a step that follows the fastest source, which sets the pace where nothing else
 * does. Few digits: sums of steps stay exact. */
static double fit_rung(double promising) {
    int exponent;
    double paced = paced_part * promising;
    return isinf(promising) ? 1.0 : floor(64.0 * frexp(paced, &exponent)) / 32.0;
}

/* What gates do, what comes from outside, and what was before, is not known to recur. */
static bool is_known(const struct dalcs_circuit *c) {
    return c->control.n_gates == 0 && c->control.n_externals == 0 && c->control.n_delayed == 0;
}

/* Steps with smooth sources are no maps of their states. */
static bool may_recur(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    return is_known(r->base->circuit) && part->component->system->n_smooth == 0;
}

static enum dalcs_status part_setup(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                    const struct dalcs_osnsp_options *osnsp) {
    struct dalcs_component *c = part->component;
    c->osnsp.asks.is_passing = true;
    bool steps = has_memory_or_sides(c->circuit, c->system);
    part->kind = steps ? DALCS_PART_STEPPED : DALCS_PART_ALGEBRAIC;
    struct dalcs_conductances g = dalcs_conductances_find(c->system, r->options.stop);
    find_cross_scales(&g, part->scales.cross);
    find_constants(&c->osnsp, &g, part->scales.constant);
    part->scales.leak = 0.5 * DBL_EPSILON * g.joint;
    struct dalcs_choice choice = dalcs_choice_make(&r->options, c, &g, osnsp->dense_limit);
    part->tolerance = choice.tolerance;
    part->inner_tolerance = inner_tolerance_of(choice.tolerance);
    part->because = steps ? choice.because : "no state, no diode and no switch";
    const struct dalcs_collocation *method = dalcs_collocation_of(r->options.family, choice.stages);
    DALCS_TRY(dalcs_excitation_setup(&part->excitation, c->circuit, c->system, method));
    DALCS_TRY(dalcs_commands_setup(&part->commands, c->circuit, c->system));
    const struct dalcs_stage_limits limits = {choice.map_limit, osnsp->rcond_min,
                                              osnsp->cache_bytes / (size_t)r->n_parts};
    DALCS_TRY(dalcs_stages_setup(&part->stages, c->system, &part->excitation, method, &limits));
    part->stages.block_of = c->osnsp.partition.block_of;
    part->stages.unseen = r->options.fixed_step > 0.0 ? 0.0 : dalcs_nothing * part->inner_tolerance;
    if (r->options.store != NULL) {
        dalcs_stage_store_take(r->options.store, part->index, &part->stages);
    }
    DALCS_TRY(dalcs_arena_reserve(&part->arena, room_for_part(c->system)));
    DALCS_TRY(allocate(part));
    DALCS_TRY(dalcs_transition_setup(part));
    DALCS_TRY(dalcs_guards_setup(part));
    DALCS_TRY(dalcs_step_setup(part));
    bool *used = dalcs_arena_alloc(&part->arena, (size_t)c->system->n_inputs, sizeof(bool));
    if (used == NULL) {
        return DALCS_E_NOMEM;
    }
    list_used_inputs(part, r->base->network, used);
    part->length.longest = dalcs_length_longest(r, part);
    /* there is a power of 2 from a length up to twice that */
    part->length.longest_needed = 2.0 * (1.0 - dalcs_alike) * dalcs_length_of_spans(part);
    double first = fmin(part->length.longest_needed,
                        fmin(part->length.longest, r->options.stop / FIRST_STEPS));
    double promising = dalcs_length_promising(part);
    part->length.rung = fit_rung(promising);
    part->length.level = -ilogb(fmin(first, promising) / part->length.rung);
    part->length.patience = 32;
    DALCS_TRY(dalcs_smooth_step_setup(part));
    if (may_recur(r, part)) {
        DALCS_TRY(dalcs_periodic_setup(r, part));
    }
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
    dalcs_delays_setup(r, base->circuit);
    r->part = dalcs_alloc((size_t)r->n_parts, sizeof(*r->part));
    r->stepped = dalcs_alloc((size_t)r->n_parts, sizeof(*r->stepped));
    enum dalcs_status status = r->part != NULL && r->stepped != NULL ? DALCS_OK : DALCS_E_NOMEM;
    for (int k = 0; k < r->n_parts && status == DALCS_OK; k++) {
        r->part[k].component = &base->component[k];
        r->part[k].index = k;
        status = part_setup(r, &r->part[k], osnsp);
        if (r->part[k].kind == DALCS_PART_STEPPED) {
            r->stepped[r->n_stepped++] = k;
        }
    }
    const bool may_leap = is_known(base->circuit) && base->circuit->control.n_smooth == 0;
    status = status == DALCS_OK && may_leap ? dalcs_cycle_setup(r) : status;
    if (status != DALCS_OK) {
        dalcs_radau_finish(r);
    }
    return status;
}

static void part_finish(const struct dalcs_radau *r, struct dalcs_radau_part *part) {
    dalcs_transition_finish(part); /* first: it holds steps */
    dalcs_periodic_finish(part);
    dalcs_cycle_finish(part);
    if (part->stages.system != NULL && r->options.store != NULL) {
        dalcs_stage_store_put(r->options.store, part->index, &part->stages);
    } else if (part->stages.system != NULL) {
        dalcs_stages_finish(&part->stages);
    }
    dalcs_excitation_finish(&part->excitation);
    dalcs_commands_finish(&part->commands);
    dalcs_arena_finish(&part->arena);
}

void dalcs_radau_finish(struct dalcs_radau *r) {
    for (int k = 0; r->part != NULL && k < r->n_parts; k++) {
        part_finish(r, &r->part[k]);
    }
    free(r->part);
    free(r->stepped);
    *r = (struct dalcs_radau){0};
}

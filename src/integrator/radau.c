/* radau.c - the parts of a run: set up, started, passed from segment to segment, evaluated. */
#include "radau.h"
#include "cycle.h"
#include "guards.h"
#include "magnitudes.h"
#include "periodic.h"
#include "present.h"
#include "recurrence.h"
#include "restart.h"
#include "segment.h"
#include "step_error.h"

#include <math.h>
#include <string.h>

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

/* Times closer than the resolution are one: what sources do just behind the instant they do at it. A carrier that meets
 * its reference at t = 0 crosses it at 1e-21 s by rounding. Returns whether any has an edge; *jumps: whether its value jumps. */
static bool enter_edges(const struct dalcs_radau *r, struct dalcs_radau_part *part, bool *jumps) {
    struct dalcs_excitation *e = &part->excitation;
    bool any = false;
    *jumps = false;
    while (e->next_edge <= part->segment.t + r->resolution) {
        dalcs_excitation_enter(e, fmax(part->segment.t, e->next_edge));
        *jumps = *jumps || e->jumps;
        any = true;
    }
    return any;
}

bool dalcs_radau_commands_at_start(struct dalcs_radau *r) {
    bool moves = false;
    for (int k = 0; k < r->n_parts; k++) {
        struct dalcs_radau_part *part = &r->part[k];
        if (part->kind != DALCS_PART_ALGEBRAIC) {
            remember_switches(part);
            dalcs_commands_start(&part->commands);
            moves = dalcs_commands_obey(&part->commands, r->resolution) || moves;
        }
    }
    return moves;
}

enum dalcs_status dalcs_radau_start(struct dalcs_radau *r, double *const *initial) {
    for (int k = 0; k < r->n_parts; k++) {
        struct dalcs_radau_part *part = &r->part[k];
        struct dalcs_component *c = part->component;
        const double *x = initial != NULL ? initial[k] : c->y;
        memcpy(part->x, x, (size_t)c->system->n_x * sizeof(double));
        dalcs_component_sample(c, 0.0, DALCS_RIGHT, c->u);
        if (r->base->listener.observer != NULL) {
            r->base->listener.observer->start(r->base->listener.observer->user, k, x);
        }
        part->is_answered = false;
        part->answered_at = 0.0;
        if (part->kind == DALCS_PART_ALGEBRAIC) {
            part->segment.t_end = INFINITY;
            continue;
        }
        remember_switches(part);
        dalcs_commands_start(&part->commands);
        (void)dalcs_commands_obey(&part->commands, r->resolution);
        bool jumps; /* as a start does anyhow */
        (void)enter_edges(r, part, &jumps);
        obey_commands(part);
        part->guards.fresh = true;
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

/* Events at times that are alike, one upon the other: an accumulation, a mode that cannot be told, or rounding of what is 0 that goes to and fro.
 * Steps of implicit Euler leave them behind, with no event at their ends. */
static void count_flurry(const struct dalcs_radau *r, struct dalcs_radau_part *part) {
    part->memory.flurry = part->segment.t - part->memory.last_event > dalcs_alike * r->options.stop
                              ? 0
                              : part->memory.flurry;
    if (part->guards.n_crossed > 0) {
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

/* What begins where the segment ends: pieces of sources, and commands. goes_on: nothing else changes. Returns whether a
 * switch is commanded. */
static bool enter_changes(struct dalcs_radau *r, struct dalcs_radau_part *part, bool goes_on) {
    bool jumps;
    if (enter_edges(r, part, &jumps)) {
        part->guards.fresh = true;
        part->guards.bends = goes_on && !jumps;
        part->guards.leaps = jumps;
    }
    const bool commanded = part->commands.next <= part->segment.t + r->resolution &&
                           dalcs_commands_obey(&part->commands, part->segment.t + r->resolution);
    if (commanded) {
        obey_commands(part);
        part->guards.fresh = true;
        part->guards.flipped = true;
        part->guards.bends = false;
    }
    return commanded;
}

static enum dalcs_status pass(struct dalcs_radau *r, struct dalcs_radau_part *part) {
    size_t state_bytes = (size_t)part->component->system->n_x * sizeof(double);
    part->segment.jumped = false;
    if (r->base->listener.observer != NULL) {
        memcpy(part->work.after, part->x, state_bytes);
    }
    bool repeats = part->memory.periodic != NULL && dalcs_periodic_repeats(r, part);
    if (!repeats || r->base->listener.observer != NULL) {
        go_to_end(part);
        if (dalcs_component_overgrows(part->component, part->x)) {
            r->base->failure.system = part->index;
            r->base->failure.time = part->segment.t_end;
            return DALCS_NOT_CONVERGED;
        }
    }
    bool goes_on = !part->segment.by_euler && part->guards.n_crossed == 0;
    part->guards.bends = part->guards.leaps = false;
    part->guards.fresh =
        part->guards.fresh || part->segment.end != 1.0; /* the next step starts inside this one */
    if (r->base->listener.observer != NULL) {
        r->base->listener.observer->segment(r->base->listener.observer->user, part,
                                            part->work.after);
    }
    part->segment.t = part->segment.t_end;
    if (part->guards.n_crossed > 0) {
        dalcs_guards_flip(part);
        part->guards.fresh = true;
        part->guards.flipped = true;
    }
    if (part->guards.n_crossed > 0 || part->segment.by_euler) {
        count_flurry(r, part);
    }
    const bool commanded = enter_changes(r, part, goes_on);
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

bool dalcs_radau_is_disturbed(const struct dalcs_radau_part *part, const bool *changed) {
    const struct dalcs_component *c = part->component;
    bool is = false;
    for (int k = 1; k < c->system->n_inputs && !is; k++) {
        is = dalcs_stimulus_depends(c->circuit, c->system->stimulus[k], changed);
    }
    return is;
}

/* Its segment has begun at t, as if nothing had changed. */
static enum dalcs_status begin_again(struct dalcs_radau *r, struct dalcs_radau_part *part) {
    bool jumps;
    dalcs_excitation_enter(&part->excitation, part->segment.t);
    (void)enter_edges(r, part, &jumps);
    if (dalcs_commands_obey(&part->commands, part->segment.t + r->resolution)) {
        obey_commands(part);
        part->guards.flipped = true;
    }
    part->guards.fresh = true;
    part->guards.bends = part->guards.leaps = false;
    part->guards.n_crossed = 0;
    part->segment.late = NULL;
    part->segment.brief = NULL;
    return dalcs_segment_begin(r, part);
}

void dalcs_radau_cut(struct dalcs_radau_part *part, double t) {
    dalcs_recurrence_complete(part);
    part->segment.brief = NULL;
    part->segment.end = (t - part->segment.t) / part->segment.h;
    part->segment.t_end = t;
    part->segment.why = DALCS_END_AT_EDGE;
    part->guards.n_crossed = 0;
}

enum dalcs_status dalcs_radau_disturb(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                      double t, const bool *changed) {
    dalcs_component_disturb(part->component, t);
    if (part->kind == DALCS_PART_ALGEBRAIC) {
        return DALCS_OK;
    }
    dalcs_commands_disturb(&part->commands, t, changed);
    if (part->segment.t >= t) {
        return begin_again(r, part);
    }
    part->excitation.next_edge = t; /* so that it is entered */
    return pass(r, part);
}

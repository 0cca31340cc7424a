/* radau.c - the parts of a run, passed from segment to segment. */
#include "radau.h"

#include "cycle.h"
#include "delays.h"
#include "extremes.h"
#include "guards.h"
#include "magnitudes.h"
#include "periodic.h"
#include "present.h"
#include "radau_enter.h"
#include "recurrence.h"
#include "segment.h"
#include "step_error.h"

#include <math.h>
#include <string.h>

static void end_at(struct dalcs_radau_part *part, double t) {
    dalcs_recurrence_complete(part);
    part->segment.brief = NULL;
    dalcs_segment_renew(part);
    part->segment.end = (t - part->segment.t) / part->segment.h;
    part->segment.t_end = t;
}

/* Gates decide once at an instant, by all that happens there. Edges of two clocks that differ by rounding are one: a gate
 * of both would show for no time what it has between them, and a counter behind it would count that. */
static void gather_ends(struct dalcs_radau *r, double t) {
    for (int k = 0; k < r->n_stepped; k++) {
        struct dalcs_radau_part *part = &r->part[r->stepped[k]];
        const struct dalcs_part_segment *s = &part->segment;
        if (s->why != DALCS_END_OF_STEP && s->t < t && s->t_end > t &&
            s->t_end <= t + r->resolution) {
            end_at(part, t);
        }
    }
}

double dalcs_radau_next_stop(struct dalcs_radau *r, bool *happens) {
    double next = INFINITY;
    *happens = false;
    for (int k = 0; k < r->n_stepped; k++) {
        next = dalcs_smaller(next, r->part[r->stepped[k]].segment.t_end);
    }
    if (r->decider.decide != NULL) {
        gather_ends(r, next);
    }
    for (int k = 0; k < r->n_stepped; k++) {
        const struct dalcs_part_segment *s = &r->part[r->stepped[k]].segment;
        *happens = *happens || (s->t_end == next && s->why != DALCS_END_OF_STEP);
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

/* From one segment to the next. */
struct passage {
    bool repeats;   /* the part is known to come back to where it was */
    bool commanded; /* a switch is */
};

/* The next segment of a part that may come back to where it was. */
static enum dalcs_status repeat_or_begin(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                         const struct passage *passage) {
    bool repeats = passage->repeats;
    dalcs_periodic_look_ahead(part);
    if (!repeats && (part->guards.n_crossed > 0 || passage->commanded)) {
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
    if (dalcs_radau_enter_edges(r, part, &jumps)) {
        part->guards.fresh = true;
        part->guards.bends = goes_on && !jumps;
        part->guards.leaps = jumps;
    }
    const bool commanded = part->commands.next <= part->segment.t + r->resolution &&
                           dalcs_commands_obey(&part->commands, part->segment.t + r->resolution);
    if (commanded) {
        dalcs_radau_obey_commands(part);
        part->guards.fresh = true;
        part->guards.flipped = true;
        part->guards.bends = false;
    }
    return commanded;
}

/* Its segment ends. */
static enum dalcs_status leave(struct dalcs_radau *r, struct dalcs_radau_part *part,
                               struct passage *passage) {
    size_t state_bytes = (size_t)part->component->system->n_x * sizeof(double);
    part->segment.jumped = false;
    if (r->base->listener.observer != NULL) {
        memcpy(part->work.after, part->x, state_bytes);
    }
    const bool repeats = part->memory.periodic != NULL && dalcs_periodic_repeats(r, part);
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
    DALCS_TRY(dalcs_delays_note(r, part)); /* before sources are looked at where it ends */
    part->segment.anew = !goes_on;
    part->segment.t = part->segment.t_end;
    if (part->guards.n_crossed > 0) {
        dalcs_guards_flip(part);
        part->guards.fresh = true;
        part->guards.flipped = true;
    }
    if (part->guards.n_crossed > 0 || part->segment.by_euler) {
        count_flurry(r, part);
    }
    *passage = (struct passage){repeats, enter_changes(r, part, goes_on)};
    part->segment.anew =
        part->segment.anew || passage->commanded || part->guards.bends || part->guards.leaps;
    part->waits = part->segment.t < r->options.stop;
    return DALCS_OK;
}

/* The next one begins. */
static enum dalcs_status go_on(struct dalcs_radau *r, struct dalcs_radau_part *part,
                               const struct passage *passage) {
    if (!part->waits) {
        return DALCS_OK;
    }
    part->waits = false;
    if (part->memory.periodic != NULL) {
        DALCS_TRY(repeat_or_begin(r, part, passage));
    } else {
        set_aside(part);
        DALCS_TRY(dalcs_segment_begin(r, part));
    }
    return part->memory.cycle != NULL ? dalcs_cycle_note(r, part) : DALCS_OK;
}

static bool ends_by(const struct dalcs_radau *r, const struct dalcs_radau_part *part, double t) {
    return part->segment.t_end <= t && part->segment.t < r->options.stop;
}

/* With gates: what they command at t acts together with what sources command there. A part that begins between the two
 * might have both switches of a leg closed, or neither. Nothing is taken to repeat there (radau_setup.c). */
static enum dalcs_status pass_deciding(struct dalcs_radau *r, double t) {
    const struct passage plain = {false, false};
    struct passage passage;
    bool opens = false;
    for (int k = 0; k < r->n_stepped; k++) {
        struct dalcs_radau_part *part = &r->part[r->stepped[k]];
        if (ends_by(r, part, t)) {
            DALCS_TRY(leave(r, part, &passage));
        }
    }
    DALCS_TRY(t < r->options.stop ? dalcs_radau_decide(r, t)
                                  : DALCS_OK); /* at the end nothing begins */
    for (int k = 0; k < r->n_stepped; k++) {
        struct dalcs_radau_part *part = &r->part[r->stepped[k]];
        const bool waits = part->waits;
        DALCS_TRY(go_on(r, part, &plain));
        opens = opens || (waits && part->segment.open);
    }
    return opens ? dalcs_radau_tell_open(r) : DALCS_OK;
}

enum dalcs_status dalcs_radau_pass(struct dalcs_radau *r, double t) {
    bool opens = false;
    if (r->decider.decide != NULL) {
        return pass_deciding(r, t);
    }
    for (int k = 0; k < r->n_stepped; k++) {
        struct dalcs_radau_part *part = &r->part[r->stepped[k]];
        if (ends_by(r, part, t)) {
            struct passage passage;
            DALCS_TRY(leave(r, part, &passage));
            DALCS_TRY(go_on(r, part, &passage));
            opens = opens || part->segment.open;
        }
    }
    return opens ? dalcs_radau_tell_open(r) : DALCS_OK;
}

/* Sources and commands where its segment begins are others. */
static void enter_again(struct dalcs_radau *r, struct dalcs_radau_part *part) {
    bool jumps;
    dalcs_excitation_enter(&part->excitation, part->segment.t);
    (void)dalcs_radau_enter_edges(r, part, &jumps);
    if (dalcs_commands_obey(&part->commands, part->segment.t + r->resolution)) {
        dalcs_radau_obey_commands(part);
        part->guards.flipped = true;
    }
    part->guards.fresh = true;
    part->guards.bends = part->guards.leaps = false;
}

/* Its segment has begun at t, as if nothing had changed. */
static enum dalcs_status begin_again(struct dalcs_radau *r, struct dalcs_radau_part *part) {
    enter_again(r, part);
    part->guards.n_crossed = 0;
    part->segment.late = NULL;
    part->segment.brief = NULL;
    return dalcs_segment_begin(r, part);
}

void dalcs_radau_cut(struct dalcs_radau_part *part, double t) {
    end_at(part, t);
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
    if (part->waits) {
        enter_again(r, part);
        return DALCS_OK;
    }
    if (part->segment.t >= t) {
        return begin_again(r, part);
    }
    struct passage passage;
    part->excitation.next_edge = t; /* so that it is entered */
    DALCS_TRY(leave(r, part, &passage));
    return r->decider.is_asked ? DALCS_OK : go_on(r, part, &passage);
}

/* recurrence.c - the short way through a segment that has been met before.
 *
 * What segment.c asks of a step is asked here, too, by bounds that imply it: the error is small enough, no
 * state needs to be projected or has outgrown its scale, and every guard is so far above 0 that it
 * would be armed and clear of events. What is left out only raises scales and chooses the next length. */
#include "recurrence.h"

#include "clearance.h"
#include "current_error.h"
#include "extremes.h"
#include "magnitudes.h"
#include "present.h"
#include "step_length.h"
#include "transition.h"

#include <math.h>

/* A map for a span costs as much as looking for some thirty segments, and with it a period costs next to
 * nothing (cycle.h). In vain it is waited for twice as many the next time. */
enum { OFTEN = 4, MOST_PATIENCE = 64 };

static void wait_longer(struct dalcs_recurring *recurring) {
    recurring->patience =
        recurring->patience < MOST_PATIENCE ? 2 * recurring->patience : MOST_PATIENCE;
}

/* A step that failed once may always fail. */
static void let_go(struct dalcs_radau_part *part, struct dalcs_recurring *recurring) {
    dalcs_recurrence_complete_before(part);
    dalcs_transition_count(part, recurring, recurring->length);
    wait_longer(recurring);
}

/* It is time to try one at once. Where sources curve none is ever looked at, and there is no length to try. */
static bool is_due(const struct dalcs_recurring *recurring) {
    return recurring->brief == NULL && recurring->patience > 0 &&
           recurring->times >= recurring->patience;
}

/* As the first such span had it: its map may be there. */
static double first_span(const struct dalcs_radau_part *part, double span) {
    double known = dalcs_length_known_span(part, part->segment.t, part->segment.t + span);
    if (known > 0.0) {
        return known;
    }
    for (int k = 0; k < part->memory.n_transitions; k++) {
        const struct dalcs_recurring *other = &part->memory.transition[k].span;
        if (other->brief != NULL &&
            dalcs_length_is_same(other->length, part->segment.t, part->segment.t + span)) {
            return other->length;
        }
    }
    return span;
}

/* A step of length h in the present mode, if it has a map and can be judged by its states and guards alone; NULL: not
 * so. A part near the largest size of maps has factors in the modes in which most pairs conduct. */
static enum dalcs_status find_map(struct dalcs_radau_part *part, double h, bool with_nodes,
                                  struct dalcs_stage_brief **step) {
    struct dalcs_stage_entry *entry;
    enum dalcs_status status =
        dalcs_stages_get(&part->stages, part->component->osnsp.mode, h, &entry);
    DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    if (status == DALCS_OK && dalcs_stage_has_map(entry) && dalcs_stage_n_clashes(entry) == 0 &&
        dalcs_stage_residual(entry) <= dalcs_nothing) {
        return dalcs_stage_brief_create(&part->stages, entry, with_nodes, step);
    }
    return DALCS_OK;
}

/* Errors as in step_error.c, of the states, beside no more than their own scales. A state that stays within a multiple
 * of its scale needs no new one. */
void dalcs_recurrence_limits(const struct dalcs_radau_part *part,
                             const struct dalcs_stage_brief *step, int x, double *most_last,
                             double *most_drift) {
    bool states_free = dalcs_stage_frees_states(step->entry);
    double allowed = (states_free ? 1.0 : dalcs_slight) * part->inner_tolerance;
    double of_unit = part->scales.unit[part->component->system->column_is_current[x] ? 1 : 0];
    *most_last = dalcs_larger(dalcs_beyond * part->scales.column[x], of_unit);
    *most_drift = allowed * part->scales.column[x];
}

static bool is_accurate(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                        const struct dalcs_stage_brief *step, bool *outgrows) {
    const int n_x = part->component->system->n_x;
    bool accurate = true;
    *outgrows = false;
    for (int x = 0; x < n_x; x++) {
        double most_last;
        double most_drift;
        dalcs_recurrence_limits(part, step, x, &most_last, &most_drift);
        accurate = accurate && fabs(step->drift[x]) <= most_drift;
        *outgrows = *outgrows || fabs(step->last[x]) > most_last;
    }
    struct dalcs_lever_error e = {0};
    if (accurate) {
        dalcs_current_error(part, step->entry, part->scales.unit, r->besides, &e);
    }
    return accurate && e.of_currents <= 1.0 && e.of_voltages <= 1.0;
}

/* A step of length h from part->segment.t, by its brief map. */
static void apply(struct dalcs_radau_part *part, struct dalcs_stage_brief *step, double h) {
    part->segment.h = h;
    part->segment.rounding = 1.0; /* a map's */
    part->segment.entry = NULL;   /* which may be that of another mode */
    dalcs_segment_inputs(part);
    dalcs_stage_brief_apply(&part->stages, step, part->segment.in);
}

/* It is the present segment up to theta, in steps. */
static void take(struct dalcs_radau *r, struct dalcs_radau_part *part,
                 struct dalcs_stage_brief *step, double theta) {
    part->segment.late = step->entry;
    part->segment.brief = step;
    if (r->base->listener.observer != NULL) {
        dalcs_recurrence_complete(part);
    }
    part->stages.cache.cache_hits++;
    part->segment.open = false;
    dalcs_segment_accept(r, part, theta, dalcs_stage_residual(step->entry));
}

/* Over a span of the same length as before. */
static enum dalcs_status try_span(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                  struct dalcs_recurring *span, double limit, bool *holds) {
    if (is_due(span)) {
        span->times = 0;
        span->length = first_span(part, span->length);
        DALCS_TRY(find_map(part, span->length, false, &span->brief));
        if (span->brief == NULL) {
            wait_longer(span);
        }
    }
    struct dalcs_stage_brief *step = span->brief;
    if (step == NULL) {
        return DALCS_OK;
    }
    apply(part, step, span->length);
    bool outgrows;
    bool may_hold = is_accurate(r, part, step, &outgrows) && dalcs_guards_clear(part, step->guard);
    *holds = may_hold && !outgrows;
    if (*holds) {
        part->segment.t_end = limit;
        part->segment.why = DALCS_END_AT_EDGE;
        take(r, part, step, 1.0);
    } else if (!may_hold) {
        let_go(part, span);
    }
    return DALCS_OK;
}

static void note_span(struct dalcs_radau_part *part, struct dalcs_recurring *span) {
    if (dalcs_length_is_same(span->length, part->segment.t, part->segment.t_end)) {
        span->times++;
    } else {
        dalcs_transition_count(part, span, part->segment.t_end - part->segment.t);
        span->patience = OFTEN;
    }
}

/* By the step that was enough the last times, up to an event or the limit. */
static enum dalcs_status try_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                  struct dalcs_transition *known, double limit, bool *holds) {
    if (known->step_level != part->length.level) {
        return DALCS_OK;
    }
    if (is_due(&known->step)) {
        known->step.times = 0;
        DALCS_TRY(find_map(part, known->step.length, true, &known->step.brief));
    }
    struct dalcs_stage_brief *step = known->step.brief;
    if (step == NULL) {
        return DALCS_OK;
    }
    apply(part, step, known->step.length);
    double end = dalcs_smaller(1.0, (limit - part->segment.t) / part->segment.h);
    double theta = end;
    bool outgrows;
    bool may_hold =
        is_accurate(r, part, step, &outgrows) && dalcs_guards_plain(part, step->guard, end, &theta);
    double t_end = part->segment.t + theta * part->segment.h;
    bool happens = part->guards.n_crossed > 0;
    if (!happens && may_hold) {
        may_hold = t_end >= limit - r->resolution;
        t_end = limit;
    }
    /* What crosses near the stop time may be left to a longer run (guards.c). */
    *holds = may_hold && !outgrows && !(happens && limit >= r->options.stop);
    if (*holds) {
        part->segment.t_end = dalcs_smaller(t_end, limit);
        part->segment.why = happens ? DALCS_END_AT_EVENT : DALCS_END_AT_EDGE;
        if (!happens) {
            note_span(part, &known->span); /* which is stepped at once when it recurs */
        }
        dalcs_stage_brief_stop(&part->stages, step, theta);
        take(r, part, step, theta);
    } else if (!may_hold) {
        let_go(part, &known->step);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_recurrence_try(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       double limit, bool *holds) {
    struct dalcs_transition *known = dalcs_transition_known(part);
    int n_crossed = part->guards.n_crossed; /* which began the segment */
    *holds = false;
    if (dalcs_length_is_same(known->span.length, part->segment.t, limit)) {
        DALCS_TRY(try_span(r, part, &known->span, limit, holds));
    }
    if (!*holds) {
        DALCS_TRY(try_step(r, part, known, limit, holds));
    }
    if (!*holds) {
        part->guards.n_crossed = n_crossed;
    }
    return DALCS_OK;
}

static void note_step(struct dalcs_radau_part *part, struct dalcs_transition *known) {
    bool is_enough = part->segment.why != DALCS_END_OF_STEP && part->guards.n_crossed <= 1;
    if (is_enough && known->step.length == part->segment.h) {
        known->step.times++;
    } else {
        dalcs_transition_count(part, &known->step, is_enough ? part->segment.h : 0.0);
        known->step_level = part->length.level;
        known->step.patience = OFTEN;
    }
}

void dalcs_recurrence_note(struct dalcs_radau_part *part) {
    struct dalcs_transition *known = dalcs_transition_known(part);
    bool on_map = part->segment.rounding == 1.0;
    if (!on_map || part->excitation.is_curved) {
        return; /* factors for one span cost too much; what sources do between the nodes is not looked at */
    }
    if (part->segment.why == DALCS_END_AT_EDGE) {
        note_span(part, &known->span);
    }
    note_step(part, known);
}

void dalcs_recurrence_begin(struct dalcs_radau_part *part) {
    struct dalcs_stage_brief *step = dalcs_transition_known(part)->span.brief;
    dalcs_stage_brief_apply(&part->stages, step, part->segment.in);
    part->segment.late = step->entry;
    part->segment.brief = step;
    dalcs_segment_renew(part);
}

const double *dalcs_recurrence_end(const struct dalcs_radau_part *part) {
    return part->segment.brief != NULL ? part->segment.brief->last : NULL;
}

static void complete(const struct dalcs_radau_part *part, struct dalcs_stage_entry **late,
                     const double *in, double *out) {
    if (*late != NULL) {
        dalcs_stage_brief_expand(&part->stages, *late, in, out);
        *late = NULL;
    }
}

void dalcs_recurrence_complete(struct dalcs_radau_part *part) {
    complete(part, &part->segment.late, part->segment.in, part->segment.out);
}

void dalcs_recurrence_complete_before(struct dalcs_radau_part *part) {
    complete(part, &part->segment.late_before, part->segment.in_before, part->segment.out_before);
}

/* recurrence.c - the short way through a segment that has been met before.
 *
 * What segment.c asks of a step is asked here, too, by bounds that imply it: the error is small enough, no
 * state needs to be projected or has outgrown its scale, and every guard is so far above 0 that it
 * would be armed and clear of events. What is left out only raises scales and chooses the next length. */
#include "recurrence.h"

#include "current_error.h"
#include "guards.h"
#include "radau_internal.h"

#include <float.h>
#include <math.h>

/* A map for a span costs as much as looking for some thirty segments, and with it a period costs next to
 * nothing (cycle.h). In vain it is waited for twice as many the next time. */
enum { OFTEN = 4, MOST_PATIENCE = 64 };

/* States within this many times their scale need no new one. */
static const double most_growth = 2.0;

/* As far as rounded times can tell. The first of equal spans is kept: it comes earliest, when times have most
 * digits, and later ones, rounded up and down, are that one exactly. */
static bool is_same(const struct dalcs_transition *known, double from, double to) {
    return fabs(to - from - known->span) <= 4.0 * DBL_EPSILON * to;
}

static void wait_longer(struct dalcs_transition *known) {
    known->recurred = 0;
    known->patience = known->patience < MOST_PATIENCE ? 2 * known->patience : MOST_PATIENCE;
}

/* As the first span had it that was as long and has a map: it serves both. */
static double first_span(const struct dalcs_radau_part *part, double span) {
    for (int k = 0; k < DALCS_TRANSITIONS; k++) {
        const struct dalcs_transition *other = &part->transition[k];
        if (other->of_span != NULL && is_same(other, part->t, part->t + span)) {
            return other->span;
        }
    }
    return span;
}

/* The map of the span, if a step with it can be judged by its states and guards alone. */
static enum dalcs_status find_map(struct dalcs_radau_part *part, struct dalcs_transition *known) {
    struct dalcs_stage_entry *entry;
    known->recurred = 0;
    known->span = first_span(part, known->span);
    enum dalcs_status status =
        dalcs_stages_get(&part->stages, part->component->osnsp.mode, known->span, &entry);
    DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    if (status == DALCS_OK && dalcs_stage_n_clashes(entry) == 0 &&
        dalcs_stage_residual(entry) <= dalcs_largest_residual) {
        return dalcs_stage_brief_create(&part->stages, entry, &known->of_span);
    }
    wait_longer(known);
    return DALCS_OK;
}

/* Errors as in step_error.c, of the states, beside no more than their own scales. */
void dalcs_recurrence_limits(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                             const struct dalcs_stage_brief *step, int x, double *most_last,
                             double *most_drift) {
    bool states_free = dalcs_stage_frees_states(step->entry);
    double allowed = (states_free ? 1.0 : dalcs_worth_projecting) * r->inner_tolerance;
    *most_last = most_growth * part->scale[x];
    *most_drift = allowed * part->scale[x];
}

static bool is_accurate(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                        const struct dalcs_stage_brief *step, bool *outgrows) {
    bool accurate = true;
    *outgrows = false;
    for (int x = 0; x < part->component->system->n_x; x++) {
        double most_last;
        double most_drift;
        dalcs_recurrence_limits(r, part, step, x, &most_last, &most_drift);
        accurate = accurate && fabs(step->drift[x]) <= most_drift;
        *outgrows = *outgrows || fabs(step->last[x]) > most_last;
    }
    return accurate;
}

enum dalcs_status dalcs_recurrence_try(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       double limit, bool *holds) {
    struct dalcs_transition *known = dalcs_transition_known(part);
    *holds = false;
    if (!is_same(known, part->t, limit)) {
        return DALCS_OK;
    }
    if (known->of_span == NULL && known->recurred >= known->patience) {
        DALCS_TRY(find_map(part, known));
    }
    if (known->of_span == NULL) {
        return DALCS_OK;
    }
    part->h = known->span;
    part->rounding = 1.0; /* a map's */
    part->entry = NULL;   /* which may be that of another mode */
    dalcs_segment_inputs(part);
    struct dalcs_stage_brief *step = known->of_span;
    dalcs_stage_brief_apply(&part->stages, step, part->in);
    double of_unit;
    bool outgrows;
    bool may_hold = is_accurate(r, part, step, &outgrows) &&
                    dalcs_guards_clear(r, part, step->guard) &&
                    dalcs_current_error(r, part, step->entry, part->unit_scale,
                                        0.1 * r->options.abstol, &of_unit) <= 1.0;
    *holds = may_hold && !outgrows;
    if (!*holds) {
        dalcs_recurrence_complete_before(part);
    }
    if (!may_hold) { /* a step that failed once may always fail */
        dalcs_transition_begin_span(part, known, known->span);
        wait_longer(known);
    }
    if (!*holds) {
        return DALCS_OK;
    }
    part->late = step->entry;
    if (r->base->energy != NULL) {
        dalcs_recurrence_complete(part);
    }
    part->stages.cache_hits++;
    part->t_end = limit;
    part->why = DALCS_END_AT_EDGE;
    part->open = false;
    dalcs_segment_accept(r, part, 1.0, dalcs_stage_residual(step->entry));
    return DALCS_OK;
}

void dalcs_recurrence_note(struct dalcs_radau_part *part) {
    struct dalcs_transition *known = dalcs_transition_known(part);
    bool on_map = part->rounding == 1.0;
    if (!on_map || part->excitation.is_curved) {
        return; /* factors for one span are too dear; what sources do between the nodes is not looked at */
    }
    if (is_same(known, part->t, part->t_end)) {
        known->recurred++;
    } else {
        dalcs_transition_begin_span(part, known, part->t_end - part->t);
        known->patience = OFTEN;
    }
}

void dalcs_recurrence_begin(struct dalcs_radau_part *part) {
    struct dalcs_stage_brief *step = dalcs_transition_known(part)->of_span;
    dalcs_stage_brief_apply(&part->stages, step, part->in);
    part->late = step->entry;
}

const double *dalcs_recurrence_end(const struct dalcs_radau_part *part) {
    return part->late != NULL ? dalcs_transition_known(part)->of_span->last : NULL;
}

static void complete(const struct dalcs_radau_part *part, struct dalcs_stage_entry **late,
                     const double *in, double *out) {
    if (*late != NULL) {
        dalcs_stage_brief_expand(&part->stages, *late, in, out);
        *late = NULL;
    }
}

void dalcs_recurrence_complete(struct dalcs_radau_part *part) {
    complete(part, &part->late, part->in, part->out);
}

void dalcs_recurrence_complete_before(struct dalcs_radau_part *part) {
    complete(part, &part->late_before, part->in_before, part->out_before);
}

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

/* A map for a span costs as much as looking for some thirty segments; waiting for half of them to begin
 * with wastes little where more follow, and nothing where none do. */
enum { OFTEN = 16 };

/* States within this many times their scale need no new one. */
static const double most_growth = 2.0;

/* As far as rounded times can tell. The first of equal spans is kept: it comes earliest, when times have most
 * digits, and later ones, rounded up and down, are that one exactly. */
static bool is_same(const struct dalcs_transition *known, double from, double to) {
    return fabs(to - from - known->span) <= 4.0 * DBL_EPSILON * to;
}

/* The map of the span, if a step with it can be judged by its states and guards alone. */
static enum dalcs_status find_map(struct dalcs_radau_part *part, struct dalcs_transition *known) {
    struct dalcs_stage_entry *entry;
    known->recurred = 0; /* if it cannot, it takes as long again */
    enum dalcs_status status =
        dalcs_stages_get(&part->stages, part->component->osnsp.mode, known->span, &entry);
    DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    if (status == DALCS_OK && dalcs_stage_n_clashes(entry) == 0 &&
        dalcs_stage_residual(entry) <= dalcs_largest_residual) {
        DALCS_TRY(dalcs_stage_brief_create(&part->stages, entry, &known->of_span));
    }
    return DALCS_OK;
}

/* Errors as in step_error.c, of the states, beside no more than their own scales. */
static bool is_accurate(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                        const struct dalcs_stage_brief *step) {
    bool states_free = dalcs_stage_frees_states(step->entry);
    double allowed = (states_free ? 1.0 : dalcs_worth_projecting) * r->inner_tolerance;
    bool accurate = true;
    for (int x = 0; x < part->component->system->n_x && accurate; x++) {
        accurate = fabs(step->drift[x]) <= allowed * part->scale[x] &&
                   fabs(step->last[x]) <= most_growth * part->scale[x];
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
    if (known->of_span == NULL && known->recurred >= OFTEN) {
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
    *holds = is_accurate(r, part, step) && dalcs_guards_clear(r, part, step->guard) &&
             dalcs_current_error(r, part, step->entry, part->unit_scale, 0.1 * r->options.abstol,
                                 &of_unit) <= 1.0;
    if (!*holds) { /* a step that failed once may always fail */
        dalcs_recurrence_complete_before(part);
        dalcs_transition_begin_span(part, known, known->span);
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
    }
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

/* steady_anchor.c - .step goes from one steady state to the next.
 *
 * Steps that follow each other are near to each other, and so are their orbits. All steps of a stretch of fixed length
 * start their search on the orbit of its first one, the anchor; the anchor starts as any run does. So what a step gives
 * depends on its number alone: not on the steps that were run before it, nor on threads, shards or a run that goes on
 * with a table. A run that begins within a stretch looks for the anchor's orbit first.
 *
 * What is found from there counts only where the usual search could have found nothing else nearby: both orbits are
 * stable, and nothing is conserved. All else is looked for as if there were no anchor. */
#include "pipeline.h"
#include "steady_step.h"

#include <stdlib.h>
#include <string.h>

/* Where a step's search starts; SIZE_MAX: as any run does. */
static size_t anchor_of(const struct dalcs_run *r) {
    const struct dalcs_plot *step = r->step;
    return step != NULL && step->n_steps > 1 ? step->step - step->step % DALCS_STEPS_OF_AN_ANCHOR
                                             : SIZE_MAX;
}

static bool is_anchor(const struct dalcs_run *r) {
    return r->step != NULL && anchor_of(r) == r->step->step;
}

/* May an orbit stand for others nearby? The last pass is of it. */
static bool serves(struct dalcs_steady *st) {
    return st->kept.n == 0 && st->own.n == 0 && dalcs_steady_largest_multiplier(st) < 1.0;
}

void dalcs_steady_anchor_forget(struct dalcs_session *s) {
    free(s->steady.anchor.x);
    free(s->steady.anchor.closed);
    s->steady.anchor = (struct dalcs_steady_anchor){0};
}

void dalcs_steady_anchor_enter(struct dalcs_session *s, const struct dalcs_run_options *options) {
    struct dalcs_run_options all = *options;
    all.only_step = 0;
    if (memcmp(&all, &s->steady.anchor_options, sizeof all) != 0 || options->only_step == 0) {
        dalcs_steady_anchor_forget(s);
    }
    memcpy(&s->steady.anchor_options, &all, sizeof all);
}

enum dalcs_status dalcs_steady_anchor_keep(struct dalcs_steady *st, bool leaves) {
    struct dalcs_session *s = st->run->s;
    const struct dalcs_steady_layout *l = &st->layout;
    if (!is_anchor(st->run)) {
        return DALCS_OK;
    }
    dalcs_steady_anchor_forget(s);
    s->steady.anchor.is_known = true;
    s->steady.anchor.step = st->run->step->step;
    s->steady.anchor.leaves = leaves;
    s->steady.anchor.x = dalcs_alloc((size_t)l->n_x, sizeof(double));
    s->steady.anchor.closed = dalcs_alloc((size_t)l->n_pairs, sizeof(bool));
    if (s->steady.anchor.x == NULL || s->steady.anchor.closed == NULL) {
        return DALCS_E_NOMEM;
    }
    s->steady.anchor.n_x = l->n_x;
    s->steady.anchor.n_pairs = l->n_pairs;
    s->steady.anchor.period = st->period;
    s->steady.anchor.serves = serves(st);
    memcpy(s->steady.anchor.x, st->at.x, (size_t)l->n_x * sizeof(double));
    memcpy(s->steady.anchor.closed, st->at.closed, (size_t)l->n_pairs * sizeof(bool));
    return DALCS_OK;
}

static bool is_of(const struct dalcs_steady_anchor *anchor, const struct dalcs_run *r,
                  bool leaves) {
    return anchor->is_known && anchor->step == anchor_of(r) && anchor->leaves == leaves;
}

enum dalcs_status dalcs_steady_anchor_try(struct dalcs_steady *st, bool leaves, bool is_free,
                                          bool *found) {
    const struct dalcs_steady_anchor *a = &st->run->s->steady.anchor;
    const double period = st->period;
    struct dalcs_orbit_point best;
    *found = false;
    if (is_anchor(st->run) || !is_of(a, st->run, leaves) || !a->serves ||
        a->n_x != st->layout.n_x || a->n_pairs != st->layout.n_pairs) {
        return DALCS_OK;
    }
    if (!dalcs_steady_make_point(st, &best)) {
        return DALCS_E_NOMEM;
    }
    memcpy(st->at.x, a->x, (size_t)a->n_x * sizeof(double));
    memcpy(st->at.closed, a->closed, (size_t)a->n_pairs * sizeof(bool));
    st->has_point = true;
    st->own.is_free = is_free;
    st->period = is_free ? a->period : period;
    DALCS_TRY(dalcs_steady_burst(st, found));
    DALCS_TRY(*found ? dalcs_steady_refine(st, &best) : DALCS_OK);
    DALCS_TRY(*found ? dalcs_steady_next_step(st) : DALCS_OK);
    *found = *found && serves(st);
    st->has_point = *found;
    st->period = *found ? st->period : period;
    return DALCS_OK;
}

/* ---- A run that begins within a stretch ---------------------------------------------------------- */

static enum dalcs_status find_anchor(struct dalcs_session *s,
                                     const struct dalcs_run_options *options,
                                     const struct dalcs_sink *sink, enum dalcs_analysis analysis,
                                     size_t step) {
    struct dalcs_plot plot;
    s->steady.anchor.is_sought = true;
    enum dalcs_status status = dalcs_session_take_step(s, step, &plot);
    status = status == DALCS_OK ? dalcs_operating_currents(s, options, sink) : status;
    status =
        status == DALCS_OK ? dalcs_run_analyses(s, options, sink, &plot, &analysis, 1) : status;
    s->steady.anchor.is_sought = false;
    return status;
}

enum dalcs_status dalcs_steady_anchor_prepare(struct dalcs_session *s,
                                              const struct dalcs_run_options *options,
                                              const struct dalcs_sink *sink,
                                              enum dalcs_analysis analysis, size_t step) {
    const struct dalcs_circuit *c = &s->circuit;
    const bool leaves = analysis == DALCS_TRANSIENT;
    const size_t anchor = step - step % DALCS_STEPS_OF_AN_ANCHOR;
    const bool asks = (leaves && c->analyses.transient.starts_steady) ||
                      analysis == DALCS_PERIODIC ||
                      (analysis == DALCS_AC && (c->analyses.periodic.present || options->bode));
    if (!asks || s->steady.stroboscope != NULL || anchor == step ||
        (s->steady.anchor.is_known && s->steady.anchor.step == anchor &&
         s->steady.anchor.leaves == leaves)) {
        return DALCS_OK;
    }
    const struct dalcs_diag diag = s->diag; /* what the anchor says is not of this step */
    s->diag = (struct dalcs_diag){0};
    const enum dalcs_status status = find_anchor(s, options, sink, analysis, anchor);
    dalcs_diag_finish(&s->diag);
    s->diag = diag;
    if (status != DALCS_OK) {
        dalcs_steady_anchor_forget(s);
        s->steady.anchor.is_known = true; /* that there is none */
        s->steady.anchor.step = anchor;
        s->steady.anchor.leaves = leaves;
    }
    return status == DALCS_E_NOMEM || status == DALCS_E_CANCELLED ? status : DALCS_OK;
}

/* envelope.c - .env: from period to period, by leaps as long as their error allows.
 *
 * A leap starts behind two periods in a row, which give M, g and h, and ends with a period that says what F is there. The
 * difference to what was expected is its error; a leap whose error is too large is made again, half as long. Near to a
 * corner of a source, and wherever leaps do not pay, all periods are run. So the error is that of the leaps alone. */
#include "envelope.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Is that a period with rows? *next: the first such behind it. */
static bool is_written(const struct dalcs_envelope *e, long n, long *next) {
    const struct dalcs_envelope_card *card = &e->run->s->circuit.analyses.envelope;
    bool is = false;
    *next = e->n_all;
    for (int k = 0; k < card->n_at; k++) {
        const long of = (long)floor(card->at[k] / e->st.period * (1.0 + 1e-12));
        is = is || of == n;
        *next = of > n && of < *next ? of : *next;
    }
    return is;
}

static enum dalcs_status refuse_period(struct dalcs_envelope *e) {
    char text[64];
    snprintf(text, sizeof text, "%.9g", e->rows.offset);
    dalcs_diag_add(&e->run->s->diag, DALCS_ERROR, dalcs_envelope_place(e->run),
                   "look at it with .tran", "the period at t = %s s could not be run", text);
    return DALCS_NOT_CONVERGED;
}

/* Two periods in a row, or three to begin with, the first of which is written: what leaps are made of. *all: they are
 * there, none of them turns a corner, and st->at to st->then is the last one. */
static enum dalcs_status look_ahead(struct dalcs_envelope *e, long next, bool all_rows, bool *all) {
    struct dalcs_steady *st = &e->st;
    const long corner = dalcs_envelope_sources_next_corner(&e->sources, e->n);
    const int n_needed = e->n_G > 0 ? 2 : 3;
    *all = false;
    for (int k = 0; k < n_needed; k++) {
        bool fails = false;
        DALCS_TRY(k == 0 && e->has_pass ? DALCS_OK : dalcs_envelope_pass(e, e->n, &fails));
        if (fails) {
            return refuse_period(e);
        }
        DALCS_TRY(k == 0 ? dalcs_envelope_write(e, st->period, all_rows, &st->at) : DALCS_OK);
        if (e->n >= corner || !dalcs_envelope_returns(e)) {
            e->n_G = 0;
            dalcs_steady_take(st);
            e->n++;
            return DALCS_OK;
        }
        dalcs_envelope_note(e, k == 0);
        *all = k == n_needed - 1;
        if (*all) {
            return DALCS_OK;
        }
        dalcs_steady_take(st);
        e->n++;
        if (e->n >= next) {
            return DALCS_OK;
        }
    }
    return DALCS_OK;
}

static enum dalcs_status advance(struct dalcs_envelope *e) {
    long next;
    long by;
    bool all;
    const bool all_rows = is_written(e, e->n, &next);
    e->rows.offset = (double)e->n * e->st.period;
    DALCS_TRY(look_ahead(e, next, all_rows, &all));
    e->has_pass = false;
    if (!all) {
        return DALCS_OK;
    }
    const long corner = dalcs_envelope_sources_next_corner(&e->sources, e->n);
    DALCS_TRY(dalcs_envelope_try_leaps(e, e->n, (next < corner ? next : corner) - e->n, &by));
    e->n += by;
    e->has_pass = by > 0;
    return DALCS_OK;
}

/* ---- All of it ----------------------------------------------------------------------------------- */

static enum dalcs_status refuse(struct dalcs_run *r, const char *hint, const char *text) {
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, dalcs_envelope_place(r), hint, "%s", text);
    return DALCS_E_NETLIST;
}

static enum dalcs_status check(struct dalcs_run *r) {
    const struct dalcs_circuit *c = &r->s->circuit;
    const bool is_fixed = r->method != DALCS_METHOD_AUTO && r->options->step > 0.0;
    if (r->method == DALCS_METHOD_EULER || r->radau.fixed_step > 0.0 || is_fixed) {
        return refuse(r, "leave the method, or the step, to the program",
                      ".env needs steps whose error is controlled");
    }
    bool measures = c->results.n_fouriers > 0;
    measures = measures || (c->results.losses != NULL && c->results.losses->present &&
                            !c->analyses.periodic.present);
    for (int k = 0; k < c->results.n_measures; k++) {
        measures = measures || c->results.measure[k].analysis == DALCS_MEASURED_TRAN;
    }
    if (measures || r->options->n_at > 0) {
        return refuse(
            r, "read them from the rows, or run .tran",
            "measurements, losses and --at need all periods, and .env leaves most of them out");
    }
    return DALCS_OK;
}

static bool make_room(struct dalcs_envelope *e) {
    const struct dalcs_steady_layout *l = &e->st.layout;
    const size_t n_x = (size_t)l->n_x + 1;
    double **const vector[] = {&e->at.F,        &e->at.G,    &e->at.g,     &e->at.h,
                               &e->at.base,     &e->at.more, &e->at.turn,  &e->at.work,
                               &e->at.expected, &e->at.off,  &e->at.error, &e->at.scale};
    bool complete = true;
    for (size_t k = 0; k < sizeof vector / sizeof vector[0]; k++) {
        *vector[k] = dalcs_arena_alloc(&e->arena, n_x, sizeof(double));
        complete = complete && *vector[k] != NULL;
    }
    e->M = dalcs_arena_alloc(&e->arena, l->first_of_M[l->n_systems] + 1, sizeof(double));
    e->closed = dalcs_arena_alloc(&e->arena, (size_t)l->n_pairs + 1, sizeof(bool));
    e->leap = dalcs_arena_alloc(&e->arena, (size_t)l->n_systems + 1, sizeof(*e->leap));
    complete = complete && e->M != NULL && e->closed != NULL && e->leap != NULL;
    for (int k = 0; k < l->n_systems && complete; k++) {
        complete = dalcs_envelope_leap_setup(&e->leap[k], &e->arena, l->first[k + 1] - l->first[k]);
    }
    return complete;
}

/* Up to a multiple of the period behind all delays, with the sources as the netlist has them. */
static enum dalcs_status run_beginning(struct dalcs_envelope *e,
                                       const struct dalcs_steady_kept *kept) {
    struct dalcs_circuit *c = &e->run->s->circuit;
    const double period = e->st.period;
    const size_t bytes = (size_t)c->n_stimuli * sizeof(*c->stimulus);
    struct dalcs_stimulus *settled = dalcs_alloc((size_t)c->n_stimuli, sizeof(*settled));
    if (settled == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(settled, c->stimulus, bytes);
    memcpy(c->stimulus, kept->stimulus, bytes);
    e->n = (long)fmax(1.0, ceil(e->sources.delay / period));
    const double duration = fmin((double)e->n * period, e->rows.stop);
    const enum dalcs_status status = dalcs_envelope_write(e, duration, true, NULL);
    memcpy(c->stimulus, settled, bytes);
    free(settled);
    e->st.has_point = true;
    return status;
}

static enum dalcs_status walk(struct dalcs_envelope *e, const struct dalcs_steady_kept *kept) {
    struct dalcs_steady *st = &e->st;
    struct dalcs_report *report = &e->run->s->results.report;
    report->envelope.present = true;
    report->envelope.period = st->period;
    report->envelope.allowed = e->tolerance;
    e->level = 1;
    DALCS_TRY(run_beginning(e, kept));
    report->envelope.run += e->n;
    while (e->n < e->n_all) {
        DALCS_TRY(dalcs_run_progress(e->run, (double)e->n * st->period, e->rows.stop));
        DALCS_TRY(advance(e));
    }
    e->rows.offset = (double)e->n * st->period;
    if (e->rows.offset < e->rows.stop) {
        DALCS_TRY(dalcs_envelope_sources_take(&e->sources, e->n));
        DALCS_TRY(dalcs_envelope_write(e, e->rows.stop - e->rows.offset, true, &st->at));
    }
    report->envelope.periods = e->n_all + 1;
    report->stop = e->rows.stop;
    return e->rows.to->end(e->rows.to->user);
}

/* With gates the periods are those after which these are where they were; of a run from the start, which is forgotten. */
static enum dalcs_status take_repeats(struct dalcs_envelope *e) {
    int n;
    DALCS_TRY(dalcs_envelope_sources_take(&e->sources, 0));
    DALCS_TRY(dalcs_steady_find_repeats(&e->st, &n));
    dalcs_steady_note_repeats(&e->st, n);
    e->st.period *= n > 1 ? n : 1;
    e->sources.period = e->st.period;
    e->st.has_point = false;
    return DALCS_OK;
}

static enum dalcs_status run(struct dalcs_envelope *e, const struct dalcs_steady_kept *kept) {
    struct dalcs_run *r = e->run;
    const struct dalcs_circuit *c = &r->s->circuit;
    double period;
    bool is_free;
    DALCS_TRY(dalcs_envelope_sources_setup(&e->sources, r));
    DALCS_TRY(dalcs_steady_find_period(r, 0.0, true, &period, &is_free));
    if (is_free) {
        return refuse(r, "run .tran", "no source repeats: there are no periods to leave out");
    }
    e->sources.period = period;
    r->h = 1e-2 * period; /* no step depends on it */
    DALCS_TRY(dalcs_steady_setup(&e->st, r, period));
    DALCS_TRY(c->control.n_gates > 0 ? take_repeats(e) : DALCS_OK);
    e->rows.stop = c->analyses.transient.stop;
    e->tolerance =
        c->analyses.envelope.tolerance > 0.0 ? c->analyses.envelope.tolerance : r->tolerance;
    e->n_all = (long)fmax(0.0, ceil(e->rows.stop / e->st.period * (1.0 - 1e-12)) - 1.0);
    return make_room(e) ? walk(e, kept) : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_envelope_run(struct dalcs_run *r) {
    struct dalcs_envelope e = {.run = r};
    struct dalcs_steady_kept kept;
    dalcs_envelope_rows_setup(&e);
    DALCS_TRY(check(r));
    DALCS_TRY(dalcs_steady_keep(r, &kept));
    const enum dalcs_status status = run(&e, &kept);
    dalcs_steady_put_back(r, &kept, true);
    free(kept.stimulus);
    dalcs_envelope_sources_finish(&e.sources);
    dalcs_steady_finish(&e.st);
    dalcs_arena_finish(&e.arena);
    return status;
}

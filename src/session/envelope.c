/* envelope.c - .env: from period to period, by leaps as long as their error allows.
 *
 * A leap starts behind three periods in a row, which give M, g and h, and ends with a period that says what F is there. The
 * difference to what was expected is its error; a leap whose error is too large is made again, half as long. Near to a
 * corner of a source, and wherever leaps do not pay, all periods are run. So the error is that of the leaps alone. */
#include "envelope.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rows in a period that is written, where nobody asks for another distance. */
static const double rows_in_a_period = 100.0;

/* Of the error allowed, what one leap may have: those of several add up before they die away. */
static const double share = 0.1;

/* The error of a leap twice as long is eight times as large, for g is straight; to begin with twice that. */
static const double next_error = 16.0;

enum { MOST_LEVEL = 40 };

struct envelope {
    struct dalcs_run *run;
    struct dalcs_steady st;
    struct dalcs_envelope_sources sources;
    const struct dalcs_sink *to;
    struct dalcs_sink sink;
    bool has_begun;
    bool has_pass;       /* st->at to st->then is the period at n */
    double offset, stop; /* s */
    double tolerance;
    long n, n_all; /* periods: where st->at is; the last one, which is written */
    long n_G;  /* the second of the two periods that G is of; 0: it is not known since a corner */
    int level; /* the next leap is over 2^level periods */
    struct dalcs_envelope_leap *leap;                              /* [n_systems] */
    double *M;                                                     /* of the first of two periods */
    double *F, *G, *g, *h, *expected, *off, *error, *scale, *base; /* [n_x] */
    bool *closed;                                                  /* [n_pairs] at the base */
    struct dalcs_arena arena;
};

/* ---- Rows: those of one period after the other are one waveform ----------------------------------- */

static enum dalcs_status begin(void *user, const struct dalcs_plot *plot) {
    struct envelope *e = user;
    const bool is_first = !e->has_begun;
    e->has_begun = true;
    return is_first ? e->to->begin(e->to->user, plot) : DALCS_OK;
}

static enum dalcs_status row(void *user, double time, const double *value) {
    struct envelope *e = user;
    return e->to->row(e->to->user, e->offset + time, value);
}

static enum dalcs_status end(void *user) {
    (void)user;
    return DALCS_OK;
}

static enum dalcs_status progress(void *user, double time, double stop) {
    struct envelope *e = user;
    (void)stop;
    return e->to->progress(e->to->user, e->offset + time, e->stop);
}

/* The run of one period, or of what is left of the last one; with all its rows, or that at its beginning. */
static enum dalcs_status write_period(struct envelope *e, double duration, bool all,
                                      const struct dalcs_orbit_point *from) {
    static const double beginning[] = {0.0};
    struct dalcs_run *r = e->run;
    const struct dalcs_run_options *options = r->options;
    const struct dalcs_sink *sink = r->sink;
    struct dalcs_run_options own = *options;
    const struct dalcs_envelope_card *card = &r->s->circuit.envelope;
    const double period = e->st.period;
    own.at = all ? NULL : beginning;
    own.n_at = all ? 0 : 1;
    own.energy = own.record = false; /* of a period: that of all is not known */
    r->s->circuit.transient.stop = duration;
    r->s->circuit.transient.step = card->step > 0.0 ? card->step : period / rows_in_a_period;
    r->options = &own;
    r->sink = &e->sink;
    r->orbit = from;
    r->orbit_end = from == NULL ? &e->st.at : NULL;
    r->leaves_orbit = true;
    enum dalcs_status status = dalcs_transient_run_thinned(r);
    r->orbit = NULL;
    r->orbit_end = NULL;
    r->leaves_orbit = false;
    r->options = options;
    r->sink = sink;
    return status;
}

/* ---- Leaps --------------------------------------------------------------------------------------- */

/* Is that one whose rows are asked for? *next: the first such behind it. */
static bool is_written(const struct envelope *e, long n, long *next) {
    const struct dalcs_envelope_card *card = &e->run->s->circuit.envelope;
    bool is = false;
    *next = e->n_all;
    for (int k = 0; k < card->n_at; k++) {
        const long of = (long)floor(card->at[k] / e->st.period * (1.0 + 1e-12));
        is = is || of == n;
        *next = of > n && of < *next ? of : *next;
    }
    return is;
}

/* The map of period n from st->at. *fails: the run does, which is no error of a leap that went too far. */
static enum dalcs_status pass(struct envelope *e, long n, bool *fails) {
    struct dalcs_steady *st = &e->st;
    DALCS_TRY(dalcs_envelope_sources_take(&e->sources, n));
    const enum dalcs_status status = dalcs_steady_pass(st, 1, DALCS_STEADY_M);
    *fails = status > DALCS_OK;
    DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    for (int x = 0; x < st->layout.n_x && !*fails; x++) {
        e->scale[x] = fmax(e->scale[x], st->scale[x]);
    }
    e->run->s->report.envelope.run++;
    return DALCS_OK;
}

/* What G_j = F_{j+1} - M_j F_j is of the two last periods, st->at to st->then the second one, into e->G; and how it goes
 * on from what it was before: half of what M changes by is in it already. The longer ago that was, the less it has of
 * rounding. */
static void find_g(struct envelope *e) {
    const struct dalcs_steady *st = &e->st;
    const double apart = e->n_G > 0 ? (double)(e->n - e->n_G) : INFINITY;
    e->n_G = e->n;
    for (int k = 0; k < st->layout.n_systems; k++) {
        const int first = st->layout.first[k];
        const int n = st->layout.first[k + 1] - first;
        const double *M = e->M + st->layout.first_of_M[k];
        const double *now = st->M + st->layout.first_of_M[k];
        for (int x = 0; x < n; x++) {
            double G = st->then.x[first + x] - st->at.x[first + x];
            double bent = 0.0;
            for (int i = 0; i < n; i++) {
                G -= M[i * n + x] * e->F[first + i];
                bent +=
                    (now[i * n + x] - M[i * n + x]) * (st->then.x[first + i] - st->at.x[first + i]);
            }
            const double more = (G - e->G[first + x]) / apart;
            e->G[first + x] = G;
            e->g[first + x] = G + more;
            e->h[first + x] = bent + more;
        }
    }
}

static void keep_map(struct envelope *e) {
    const struct dalcs_steady *st = &e->st;
    memcpy(e->M, st->M, st->layout.first_of_M[st->layout.n_systems] * sizeof(double));
    for (int x = 0; x < st->layout.n_x; x++) {
        e->F[x] = st->then.x[x] - st->at.x[x];
    }
}

/* st->at = where 2^level periods lead to. */
static void leap(struct envelope *e) {
    struct dalcs_steady *st = &e->st;
    for (int k = 0; k < st->layout.n_systems; k++) {
        const int first = st->layout.first[k];
        dalcs_envelope_leap_make(&e->leap[k], e->M + st->layout.first_of_M[k], e->g + first,
                                 e->h + first, e->F + first, e->level);
        dalcs_envelope_leap_go(&e->leap[k], st->at.x + first, e->expected + first);
    }
    for (int x = 0; x < st->layout.n_x; x++) {
        st->at.x[x] += e->base[x];
    }
    memcpy(st->at.closed, e->closed, (size_t)st->layout.n_pairs * sizeof(bool));
}

/* Of the leap to st->at, over the scales. */
static double error_of(struct envelope *e) {
    const struct dalcs_steady *st = &e->st;
    double worst = 0.0;
    for (int x = 0; x < st->layout.n_x; x++) {
        e->off[x] = st->then.x[x] - st->at.x[x] - e->expected[x];
    }
    for (int k = 0; k < st->layout.n_systems; k++) {
        const int first = st->layout.first[k];
        dalcs_envelope_leap_error(&e->leap[k], e->off + first, e->error + first);
    }
    for (int x = 0; x < st->layout.n_x; x++) {
        const double off = fmax(fabs(e->error[x]), fabs(e->off[x]));
        worst = off > 0.0 ? fmax(worst, off / e->scale[x]) : worst;
    }
    return worst;
}

static bool switches_return(const struct dalcs_steady *st) {
    return memcmp(st->at.closed, st->then.closed, (size_t)st->layout.n_pairs * sizeof(bool)) == 0;
}

/* From the base, at period n, of which e->M and e->F are: over no more than `most` periods. *by: 0, none is made. */
static enum dalcs_status try_leaps(struct envelope *e, long n, long most, long *by) {
    struct dalcs_steady *st = &e->st;
    bool fails;
    *by = 0;
    memcpy(e->base, st->at.x, (size_t)st->layout.n_x * sizeof(double));
    memcpy(e->closed, st->at.closed, (size_t)st->layout.n_pairs * sizeof(bool));
    while (e->level > 0 && (1L << e->level) > most) {
        e->level--;
    }
    for (; e->level > 0; e->level--) {
        leap(e);
        DALCS_TRY(pass(e, n + (1L << e->level), &fails));
        const double error = fails || !switches_return(st) ? INFINITY : error_of(e);
        if (error <= share * e->tolerance) {
            struct dalcs_report *report = &e->run->s->report;
            report->envelope.leaps++;
            report->envelope.worst = fmax(report->envelope.worst, error);
            *by = 1L << e->level;
            e->level += next_error * error <= share * e->tolerance && e->level < MOST_LEVEL ? 1 : 0;
            return DALCS_OK;
        }
        e->run->s->report.envelope.rejected++;
    }
    e->level = 1; /* to be tried again behind the next two periods */
    memcpy(st->at.x, e->base, (size_t)st->layout.n_x * sizeof(double));
    memcpy(st->at.closed, e->closed, (size_t)st->layout.n_pairs * sizeof(bool));
    return DALCS_OK;
}

static enum dalcs_status refuse_period(struct envelope *e) {
    char text[64];
    snprintf(text, sizeof text, "%.9g", e->offset);
    dalcs_diag_add(&e->run->s->diag, DALCS_ERROR, &e->run->s->circuit.transient.where,
                   "look at it with .tran", "the period at t = %s s could not be run", text);
    return DALCS_NOT_CONVERGED;
}

/* Two periods in a row, or three to begin with, the first of which is written: what leaps are made of. *all: they are there, none of them turns
 * a corner, and st->at to st->then is the last one. */
static enum dalcs_status look_ahead(struct envelope *e, long next, bool all_rows, bool *all) {
    struct dalcs_steady *st = &e->st;
    const long corner = dalcs_envelope_sources_next_corner(&e->sources, e->n);
    const int n_needed = e->n_G > 0 ? 2 : 3;
    *all = false;
    for (int k = 0; k < n_needed; k++) {
        bool fails = false;
        DALCS_TRY(k == 0 && e->has_pass ? DALCS_OK : pass(e, e->n, &fails));
        if (fails) {
            return refuse_period(e);
        }
        DALCS_TRY(k == 0 ? write_period(e, st->period, all_rows, &st->at) : DALCS_OK);
        if (e->n >= corner || !switches_return(st)) {
            e->n_G = 0;
            dalcs_steady_take(st);
            e->n++;
            return DALCS_OK;
        }
        if (k > 0) {
            find_g(e);
        }
        keep_map(e);
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

static enum dalcs_status advance(struct envelope *e) {
    long next;
    long by;
    bool all;
    const bool all_rows = is_written(e, e->n, &next);
    e->offset = (double)e->n * e->st.period;
    DALCS_TRY(look_ahead(e, next, all_rows, &all));
    e->has_pass = false;
    if (!all) {
        return DALCS_OK;
    }
    const long corner = dalcs_envelope_sources_next_corner(&e->sources, e->n);
    DALCS_TRY(try_leaps(e, e->n, (next < corner ? next : corner) - e->n, &by));
    e->n += by;
    e->has_pass = by > 0;
    return DALCS_OK;
}

/* ---- All of it ----------------------------------------------------------------------------------- */

static enum dalcs_status refuse(struct dalcs_run *r, const char *hint, const char *text) {
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, &r->s->circuit.transient.where, hint, "%s", text);
    return DALCS_E_NETLIST;
}

static enum dalcs_status check(struct dalcs_run *r) {
    const struct dalcs_circuit *c = &r->s->circuit;
    const bool is_fixed = r->method != DALCS_METHOD_AUTO && r->options->step > 0.0;
    if (r->method == DALCS_METHOD_EULER || r->fixed_step > 0.0 || is_fixed) {
        return refuse(r, "leave the method, or the step, to the program",
                      ".env needs steps whose error is controlled");
    }
    bool measures = c->n_fouriers > 0 || (c->losses != NULL && c->losses->present);
    for (int k = 0; k < c->n_measures; k++) {
        measures = measures || c->measure[k].analysis == DALCS_MEASURED_TRAN;
    }
    if (measures || r->options->at != NULL) {
        return refuse(r, "read them from the rows, or run .tran",
                      "measurements, losses and --at are of all periods, of which .env "
                      "leaves most out");
    }
    return DALCS_OK;
}

static bool make_room(struct envelope *e) {
    const struct dalcs_steady_layout *l = &e->st.layout;
    const size_t n_x = (size_t)l->n_x + 1;
    double **const vector[] = {&e->G,   &e->h,     &e->F,     &e->g,   &e->expected,
                               &e->off, &e->error, &e->scale, &e->base};
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
static enum dalcs_status run_beginning(struct envelope *e, const struct dalcs_steady_kept *kept) {
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
    const double duration = fmin((double)e->n * period, e->stop);
    const enum dalcs_status status = write_period(e, duration, true, NULL);
    memcpy(c->stimulus, settled, bytes);
    free(settled);
    e->st.has_point = true;
    return status;
}

static enum dalcs_status walk(struct envelope *e, const struct dalcs_steady_kept *kept) {
    struct dalcs_steady *st = &e->st;
    struct dalcs_report *report = &e->run->s->report;
    report->envelope.present = true;
    report->envelope.period = st->period;
    report->envelope.allowed = e->tolerance;
    e->level = 1;
    DALCS_TRY(run_beginning(e, kept));
    report->envelope.run += e->n;
    while (e->n < e->n_all) {
        DALCS_TRY(dalcs_run_progress(e->run, (double)e->n * st->period, e->stop));
        DALCS_TRY(advance(e));
    }
    e->offset = (double)e->n * st->period;
    if (e->offset < e->stop) {
        DALCS_TRY(dalcs_envelope_sources_take(&e->sources, e->n));
        DALCS_TRY(write_period(e, e->stop - e->offset, true, &st->at));
    }
    report->envelope.periods = e->n_all + 1;
    report->stop = e->stop;
    return e->to->end(e->to->user);
}

static enum dalcs_status run(struct envelope *e, const struct dalcs_steady_kept *kept) {
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
    e->stop = c->transient.stop;
    e->tolerance = c->envelope.tolerance > 0.0 ? c->envelope.tolerance : r->tolerance;
    e->n_all = (long)fmax(0.0, ceil(e->stop / period * (1.0 - 1e-12)) - 1.0);
    r->h = period / rows_in_a_period;
    DALCS_TRY(dalcs_steady_setup(&e->st, r, period));
    return make_room(e) ? walk(e, kept) : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_envelope_run(struct dalcs_run *r) {
    struct envelope e = {.run = r, .to = r->sink};
    struct dalcs_steady_kept kept;
    e.sink = (struct dalcs_sink){
        .user = &e, .begin = begin, .row = row, .end = end, .progress = progress};
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

/* envelope_leaps.c - what leaps are made of, and how long they may be. */
#include "envelope.h"

#include <math.h>
#include <string.h>

/* The share of the allowed error for one leap: the errors of several add up before they die away. */
static const double share = 0.1;

/* What F is off by goes with the square of the length, and so x with the third power: twice the length is eight times
 * the error, or twice that while the leaps have yet to find theirs. */
static const double next_error = 16.0;

enum { MOST_LEVEL = 40 };

enum dalcs_status dalcs_envelope_pass(struct dalcs_envelope *e, long n, bool *fails) {
    struct dalcs_steady *st = &e->st;
    DALCS_TRY(dalcs_envelope_sources_take(&e->sources, n));
    const enum dalcs_status status = dalcs_steady_pass(st, 1, DALCS_STEADY_M);
    *fails = status > DALCS_OK;
    DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    for (int x = 0; x < st->layout.n_x && !*fails; x++) {
        e->at.scale[x] = fmax(e->at.scale[x], st->scale[x]);
    }
    e->run->s->results.report.envelope.run++;
    return DALCS_OK;
}

/* What G_j = F_{j+1} - M_j F_j is of the two last periods, st->at to st->then the second one, into e->at.G; and how it goes
 * on from what it was before: half of what M changes by is in it already. The longer ago that was, the less it has of
 * rounding. */
static void find_g(struct dalcs_envelope *e) {
    const struct dalcs_steady *st = &e->st;
    const double apart = e->n_G > 0 ? (double)(e->n - e->n_G) : INFINITY;
    const double between = 0.5 * (apart + (e->n_G > 0 ? e->apart : INFINITY));
    e->n_G = e->n;
    e->apart = apart;
    for (int k = 0; k < st->layout.n_systems; k++) {
        const int first = st->layout.first[k];
        const int n = st->layout.first[k + 1] - first;
        const double *M = e->M + st->layout.first_of_M[k];
        const double *now = st->pass.M + st->layout.first_of_M[k];
        for (int x = 0; x < n; x++) {
            double G = st->then.x[first + x] - st->at.x[first + x];
            double bent = 0.0;
            for (int i = 0; i < n; i++) {
                G -= M[i * n + x] * e->at.F[first + i];
                bent +=
                    (now[i * n + x] - M[i * n + x]) * (st->then.x[first + i] - st->at.x[first + i]);
            }
            const double more = (G - e->at.G[first + x]) / apart;
            e->at.G[first + x] = G;
            e->at.turn[first + x] = (more - e->at.more[first + x]) / between;
            e->at.more[first + x] = more;
            e->at.g[first + x] = G + more;
            e->at.h[first + x] = bent + more;
        }
    }
}

static void keep_map(struct dalcs_envelope *e) {
    const struct dalcs_steady *st = &e->st;
    memcpy(e->M, st->pass.M, st->layout.first_of_M[st->layout.n_systems] * sizeof(double));
    for (int x = 0; x < st->layout.n_x; x++) {
        e->at.F[x] = st->then.x[x] - st->at.x[x];
    }
}

/* st->at = where 2^level periods lead to. */
static void leap(struct dalcs_envelope *e) {
    struct dalcs_steady *st = &e->st;
    for (int k = 0; k < st->layout.n_systems; k++) {
        const int first = st->layout.first[k];
        dalcs_envelope_leap_make(&e->leap[k], e->M + st->layout.first_of_M[k], e->at.g + first,
                                 e->at.h + first, e->at.F + first, e->level);
        dalcs_envelope_leap_go(&e->leap[k], st->at.x + first, e->at.expected + first);
    }
    for (int x = 0; x < st->layout.n_x; x++) {
        st->at.x[x] += e->at.base[x];
    }
    memcpy(st->at.closed, e->closed, (size_t)st->layout.n_pairs * sizeof(bool));
}

/* What x is off by behind a leap at whose end F is off by off[n_x], over the scales. */
static double error_by(struct dalcs_envelope *e, const double *off) {
    const struct dalcs_steady *st = &e->st;
    double worst = 0.0;
    for (int k = 0; k < st->layout.n_systems; k++) {
        const int first = st->layout.first[k];
        dalcs_envelope_leap_error(&e->leap[k], off + first, e->at.error + first);
    }
    for (int x = 0; x < st->layout.n_x; x++) {
        const double of = fmax(fabs(e->at.error[x]), fabs(off[x]));
        worst = of > 0.0 ? fmax(worst, of / e->at.scale[x]) : worst;
    }
    return worst;
}

/* What the leap makes of a G that does not go on along a line: by `turn` j (j + apart) / 2 off in the j-th of its periods. At
 * the end of the leap what M has changed by may cancel it in F, and not in x. */
static double error_of_turn(struct dalcs_envelope *e) {
    const double n = ldexp(1.0, e->level) - 1.0;
    const double sum = 0.5 * n * (n + 1.0);
    const double squares = sum * (2.0 * n + 1.0) / 3.0;
    for (int x = 0; x < e->st.layout.n_x; x++) {
        e->at.work[x] =
            0.5 * e->at.turn[x] * (squares + (isfinite(e->apart) ? e->apart : 0.0) * sum);
    }
    return error_by(e, e->at.work);
}

/* Of the leap to st->at, over the scales. */
static double error_of(struct dalcs_envelope *e) {
    const struct dalcs_steady *st = &e->st;
    for (int x = 0; x < st->layout.n_x; x++) {
        e->at.off[x] = st->then.x[x] - st->at.x[x] - e->at.expected[x];
    }
    return fmax(error_by(e, e->at.off), error_of_turn(e));
}

bool dalcs_envelope_returns(const struct dalcs_envelope *e) {
    const struct dalcs_steady *st = &e->st;
    return memcmp(st->at.closed, st->then.closed, (size_t)st->layout.n_pairs * sizeof(bool)) == 0;
}

void dalcs_envelope_note(struct dalcs_envelope *e, bool is_first) {
    if (!is_first) {
        find_g(e);
    }
    keep_map(e);
}

enum dalcs_status dalcs_envelope_try_leaps(struct dalcs_envelope *e, long n, long most, long *by) {
    struct dalcs_steady *st = &e->st;
    bool fails;
    *by = 0;
    memcpy(e->at.base, st->at.x, (size_t)st->layout.n_x * sizeof(double));
    memcpy(e->closed, st->at.closed, (size_t)st->layout.n_pairs * sizeof(bool));
    while (e->level > 0 && (1L << e->level) > most) {
        e->level--;
    }
    for (; e->level > 0; e->level--) {
        leap(e);
        DALCS_TRY(dalcs_envelope_pass(e, n + (1L << e->level), &fails));
        const double error = fails || !dalcs_envelope_returns(e) ? INFINITY : error_of(e);
        if (error <= share * e->tolerance) {
            struct dalcs_report *report = &e->run->s->results.report;
            report->envelope.leaps++;
            report->envelope.worst = fmax(report->envelope.worst, error);
            *by = 1L << e->level;
            e->level += next_error * error <= share * e->tolerance && e->level < MOST_LEVEL ? 1 : 0;
            return DALCS_OK;
        }
        e->run->s->results.report.envelope.rejected++;
    }
    e->level = 1; /* to be tried again behind the next two periods */
    memcpy(st->at.x, e->at.base, (size_t)st->layout.n_x * sizeof(double));
    memcpy(st->at.closed, e->closed, (size_t)st->layout.n_pairs * sizeof(bool));
    return DALCS_OK;
}

/* steady_attractor.c - where a run comes to that stays on no orbit of one period.
 *
 * Its points at the ends of periods are kept. Newton's method is tried on so many periods n as take them nearest to where
 * they were, and what it finds counts by the same check as any other orbit. Where there is none, the run is on a torus or
 * in chaos: in chaos what two runs differ by grows without end, by M of one period after the other, as long as it is
 * small; on a torus it neither grows nor fades, and there is always an n that brings all points back nearly. */
#include "steady_step.h"

#include <math.h>
#include <string.h>

/* Points of a run. Half of them are compared with those n before. In a cascade of period doublings each orbit has 1/4.67 of
 * the range of the one before (Feigenbaum): those of more than 128 periods have 1/50000 of all. */
enum { KEPT = 256, MOST_PERIODS = KEPT / 2 };

/* Periods of the run before each look, but for those kept; the first suffices where differences fade by 0.9 each. */
static const long waits[] = {60, 240, 960};

/* What is beside an unstable orbit by 1e-2, of which a hundredth may grow, has to be large many times over. */
static const double grown = 1e6;

/* Behind each look a run has gone on for 2.5 times as long. What grows without end, at least as the square root of time,
 * as the voltage of a capacitor that is fed an even power, is larger by 1.58 then. What has an end has come there, but for
 * what chance makes of the largest of KEPT periods. The root of 1.58 lies between. */
static const double bounded = 1.26;

/* Nearer than this, over the scale, is the same point: what an orbit may be off by. */
static const double good = 1e-10;

/* As in steady_report.c. */
static const double near_one = 1e-9;

/* Steps of the run times unknowns. Each is 60 instructions where the run leaps over periods, 2500 where each step is new
 * (doc/steady.md, what it costs): 0.2 to 8 s. A longer search is a .tran of the user. With ten times as much all circuits of
 * tests/steady/attractors.py come to the same; with a tenth nothing is told of 3 in 51, and nothing false of any. */
static const double most_work = 1e7;

/* The growth of a difference is a mean of logarithms, of so many sums of so many periods; in one more before them it turns
 * to where it grows most. */
enum { SUMS = 16, PERIODS_OF_A_SUM = 64, PERIODS_OF_A_FREE_SUM = 8 };

/* It is not 0 where it is this many times its standard deviation. */
static const double certain = 4.0;

/* Differences grow as a power of time without chaos: as time itself where a frequency depends on an amplitude, as its square
 * where that amplitude grows, too. Chaos makes them grow by more in the second half of the sums. */
static const double largest_power = 2.0;

/* Of 129 points on a circle two are nearer than 2 pi/129 of its radius, 0.025 of its width (Dirichlet); where points are
 * not evenly spread it is more. */
static const double near_return = 0.2;

struct follow {
    struct dalcs_steady *st;
    double one;    /* s, a period */
    double before; /* steps at the beginning */
    double work_of_a_step;
    struct dalcs_orbit_point kept[KEPT];
    double *scale;   /* [n_x] of the periods that are kept */
    double *vector;  /* [2 n_x] work */
    double width;    /* of the kept points, over the scale */
    bool is_bounded; /* no state is much larger than when the run was looked at before */
    double nearest;  /* how near they come to those n before */
    int n;           /* periods that do */
};

static bool make_room(struct follow *f) {
    struct dalcs_steady *st = f->st;
    const size_t n_x = (size_t)st->layout.n_x;
    bool complete = true;
    for (int k = 0; k < KEPT && complete; k++) {
        complete = dalcs_steady_make_point(st, &f->kept[k]);
    }
    f->scale = dalcs_arena_alloc(&st->arena, n_x + 1, sizeof(double));
    f->vector = dalcs_arena_alloc(&st->arena, 2 * n_x + 1, sizeof(double));
    return complete && f->scale != NULL && f->vector != NULL;
}

static void begin(struct follow *f, struct dalcs_steady *st) {
    const struct dalcs_network *network = &st->run->s->network;
    *f = (struct follow){.is_bounded = true,
                         .st = st,
                         .one = st->period,
                         .before = (double)st->run->s->results.report.work.steps};
    for (int k = 0; k < network->n_systems; k++) {
        f->work_of_a_step += network->system[k].n_x + network->system[k].n_z;
    }
}

/* Is there enough left for so many periods more, of those that took `steps`? */
static bool may_go_on(const struct follow *f, double steps, double periods) {
    const double so_far = (double)f->st->run->s->results.report.work.steps - f->before;
    return (so_far + steps * periods) * f->work_of_a_step <= most_work;
}

/* ---- How near points come to those before -------------------------------------------------------- */

/* Of states alone: on a torus switches and bits are somewhere else after any number of periods. */
static double distance(const struct follow *f, const struct dalcs_orbit_point *a,
                       const struct dalcs_orbit_point *b) {
    double most = 0.0;
    for (int x = 0; x < f->st->layout.n_x; x++) {
        const double off = fabs(a->x[x] - b->x[x]);
        most = off > 0.0 ? fmax(most, off / f->scale[x]) : most;
    }
    return most;
}

/* The first n that takes the last points nearest to where they were. */
static void find_nearest(struct follow *f) {
    f->nearest = INFINITY;
    for (int n = 1; n <= MOST_PERIODS; n++) {
        double most = good;
        for (int i = KEPT - MOST_PERIODS; i < KEPT; i++) {
            most = fmax(most, distance(f, &f->kept[i], &f->kept[i - n]));
        }
        f->n = most < f->nearest ? n : f->n;
        f->nearest = fmin(most, f->nearest);
    }
}

static void find_width(struct follow *f) {
    f->width = 0.0;
    for (int x = 0; x < f->st->layout.n_x; x++) {
        double low = f->kept[0].x[x];
        double high = low;
        for (int i = 1; i < KEPT; i++) {
            low = fmin(low, f->kept[i].x[x]);
            high = fmax(high, f->kept[i].x[x]);
        }
        f->width = high > low ? fmax(f->width, (high - low) / f->scale[x]) : f->width;
    }
}

/* Does the run come back to where the first kept point is, from half of the width away or more? What drifts slowly is near
 * to where it was a period before, and goes on and on; what turns more slowly than the kept points last is not told from
 * that. */
static bool turns(const struct follow *f) {
    bool was_away = false;
    bool is_back = false;
    for (int i = 1; i < KEPT && !is_back; i++) {
        const double away = distance(f, &f->kept[i], &f->kept[0]);
        is_back = was_away && away <= near_return * f->width;
        was_away = was_away || away >= 0.5 * f->width;
    }
    return is_back;
}

/* ---- Orbits -------------------------------------------------------------------------------------- */

/* On from st->at by so many periods and those that are kept. */
static enum dalcs_status run_on(struct follow *f, long wait) {
    struct dalcs_steady *st = f->st;
    st->period = f->one;
    DALCS_TRY(dalcs_steady_pass(st, wait, DALCS_STEADY_PLAIN));
    dalcs_steady_take(st);
    memset(f->vector, 0, (size_t)st->layout.n_x * sizeof(double));
    for (int k = 0; k < KEPT; k++) {
        DALCS_TRY(dalcs_steady_pass(st, 1, DALCS_STEADY_PLAIN));
        dalcs_steady_take(st);
        dalcs_steady_copy_point(st, &f->kept[k], &st->at);
        for (int x = 0; x < st->layout.n_x; x++) {
            f->vector[x] = fmax(f->vector[x], st->scale[x]);
        }
    }
    f->is_bounded = true;
    for (int x = 0; x < st->layout.n_x; x++) {
        f->is_bounded = f->is_bounded && f->vector[x] <= bounded * f->scale[x];
        f->scale[x] = f->vector[x];
    }
    find_nearest(f);
    find_width(f);
    return DALCS_OK;
}

/* From where the run is: a stable orbit of f->n periods, or of a part of them; else the run is where it was. */
static enum dalcs_status try_orbit(struct follow *f, bool *found, int *n, double *largest) {
    struct dalcs_steady *st = f->st;
    *found = false;
    st->period = f->n * f->one;
    DALCS_TRY(dalcs_steady_burst(st, found));
    if (*found) {
        enum dalcs_status status = dalcs_steady_next_step(st); /* how far it is off */
        DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
        DALCS_TRY(dalcs_steady_find_repeat(st, f->one, f->n, n));
        st->period = *n * f->one;
        status = dalcs_steady_pass(st, 1, DALCS_STEADY_M);
        DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
        *largest = dalcs_steady_largest_multiplier(st);
        *found = status == DALCS_OK && *largest < 1.0 - near_one;
    }
    if (!*found) {
        st->period = f->one;
        dalcs_steady_copy_point(st, &st->at, &f->kept[KEPT - 1]);
    }
    return DALCS_OK;
}

/* ---- What a small difference becomes ------------------------------------------------------------- */

/* The logarithm of what M makes of a vector of length 1, which then is that, of length 1. */
static double multiply(struct follow *f) {
    const struct dalcs_steady *st = f->st;
    double *v = f->vector;
    double *w = f->vector + st->layout.n_x;
    double size = 0.0;
    for (int k = 0; k < st->layout.n_systems; k++) {
        const int first = st->layout.first[k];
        const int n = st->layout.first[k + 1] - first;
        const double *M = st->pass.M + st->layout.first_of_M[k];
        for (int x = 0; x < n; x++) {
            double sum = 0.0;
            for (int i = 0; i < n; i++) {
                sum += M[i * n + x] * v[first + i];
            }
            w[first + x] = sum;
            size = hypot(size, f->scale[first + x] > 0.0 ? sum / f->scale[first + x] : 0.0);
        }
    }
    for (int x = 0; x < st->layout.n_x; x++) {
        v[x] = size > 0.0 ? w[x] / size : v[x];
    }
    return log(size);
}

/* Of logarithms of what a small difference grows by. */
struct growth {
    double mean, deviation; /* for a period; the standard one */
    double second;          /* in the second half of the sums */
    bool known;             /* M was exact */
};

/* Over the run on from st->at, in sums of n periods. */
static enum dalcs_status find_growth(struct follow *f, int n, struct growth *g) {
    struct dalcs_steady *st = f->st;
    double square = 0.0;
    *g = (struct growth){.known = true};
    for (int x = 0; x < st->layout.n_x; x++) {
        f->vector[x] = f->scale[x] * (0.5 + fmod(0.6180339887498949 * (x + 1), 1.0));
    }
    for (int k = -1; k < SUMS; k++) {
        double sum = 0.0;
        for (int i = 0; i < n; i++) {
            DALCS_TRY(dalcs_steady_pass(st, 1, DALCS_STEADY_M));
            dalcs_steady_take(st);
            g->known = g->known && st->pass.is_exact;
            sum += multiply(f) / n;
        }
        g->mean += k >= 0 ? sum / SUMS : 0.0;
        g->second += k >= SUMS / 2 ? sum * n : 0.0;
        square += k >= 0 ? sum * sum / SUMS : 0.0;
    }
    g->deviation = sqrt(fmax(0.0, square - g->mean * g->mean) / (SUMS - 1));
    g->known = g->known && isfinite(g->mean);
    return DALCS_OK;
}

/* From the beginning of the first sum but one on, time grows from 1 to SUMS + 1 of them. */
static bool is_faster_than_powers(const struct growth *g) {
    return g->second > largest_power * log((SUMS + 1.0) / (SUMS / 2 + 1.0));
}

static enum dalcs_status tell_apart(struct follow *f, int n, struct dalcs_steady_attractor *a) {
    struct growth g;
    DALCS_TRY(find_growth(f, n, &g));
    const bool is_zero = fabs(g.mean) <= certain * g.deviation;
    if (g.known && !is_zero && is_faster_than_powers(&g)) {
        a->kind = DALCS_STEADY_CHAOS;
    } else if (g.known && is_zero && f->nearest <= near_return * f->width && turns(f)) {
        a->kind = DALCS_STEADY_TORUS;
    } else if (g.known && g.mean < 0.0 && !is_zero) {
        a->kind = DALCS_STEADY_SETTLING;
    }
    a->growth = exp(g.mean);
    return DALCS_OK;
}

/* ---- All of it ----------------------------------------------------------------------------------- */

/* Without a clock nothing says when to look at points. Whether differences grow is the same at any time, and the orbit
 * beside which they do so in each period takes fewer of them. */
static enum dalcs_status follow_free(struct follow *f, double wait, double steps,
                                     struct dalcs_steady_attractor *a) {
    struct dalcs_steady *st = f->st;
    const size_t n_x = (size_t)st->layout.n_x;
    if (!may_go_on(f, steps, wait + (SUMS + 1) * PERIODS_OF_A_FREE_SUM)) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_steady_pass(st, (long)wait, DALCS_STEADY_PLAIN));
    dalcs_steady_take(st);
    memcpy(f->scale, st->scale, n_x * sizeof(double));
    DALCS_TRY(tell_apart(f, PERIODS_OF_A_FREE_SUM, a));
    for (size_t x = 0; x < n_x; x++) {
        f->is_bounded = f->is_bounded && st->scale[x] <= bounded * f->scale[x];
    }
    const bool is_chaos = a->kind == DALCS_STEADY_CHAOS && f->is_bounded;
    a->kind = is_chaos ? DALCS_STEADY_CHAOS : DALCS_STEADY_UNKNOWN;
    return DALCS_OK;
}

static enum dalcs_status follow(struct follow *f, double growth, struct dalcs_steady_attractor *a) {
    struct dalcs_steady *st = f->st;
    const double leaving = growth > 1.0 ? ceil(log(grown) / log(growth)) : 0.0;
    double steps = (double)st->run->s->results.report.work.steps;
    bool found = false;
    DALCS_TRY(dalcs_steady_pass(st, 1, DALCS_STEADY_PLAIN));
    steps = (double)st->run->s->results.report.work.steps - steps;
    if (st->own.is_free) {
        return follow_free(f, fmax((double)waits[0], leaving), steps, a);
    }
    for (size_t k = 0; k < sizeof waits / sizeof waits[0]; k++) {
        const double wait = fmax((double)waits[k], leaving);
        if (!may_go_on(f, steps, wait + KEPT)) {
            return DALCS_OK;
        }
        DALCS_TRY(run_on(f, (long)wait));
        DALCS_TRY(try_orbit(f, &found, &a->n, &a->growth));
        if (found) {
            a->kind = DALCS_STEADY_ORBIT;
            return dalcs_steady_refine(st, &f->kept[0]);
        }
    }
    return f->is_bounded && may_go_on(f, steps, 2.0 * SUMS * PERIODS_OF_A_SUM)
               ? tell_apart(f, PERIODS_OF_A_SUM, a)
               : DALCS_OK;
}

enum dalcs_status dalcs_steady_find_attractor(struct dalcs_steady *st, double growth,
                                              struct dalcs_steady_attractor *a) {
    struct follow f;
    *a = (struct dalcs_steady_attractor){.kind = DALCS_STEADY_UNKNOWN};
    begin(&f, st);
    if (!make_room(&f)) {
        return DALCS_E_NOMEM;
    }
    const enum dalcs_status status = follow(&f, growth, a);
    if (a->kind != DALCS_STEADY_ORBIT) {
        st->period = f.one;
        a->n = 0;
    }
    return status < DALCS_OK ? status : DALCS_OK; /* a run that fails has not been followed */
}

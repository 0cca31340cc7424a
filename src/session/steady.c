/* steady.c - the search: bursts of Newton's method from points of a run, ever farther on.
 *
 * Newton's method is local: as events come and go with the states, pieces of the map follow each other. A
 * burst starts where a run has come to, so that the worst case is a run, of twice as many periods as it
 * takes; and a step that does not help is followed by a plain period, which takes the state back to where
 * the circuit can be. Where a burst ends nowhere, leaps of so many periods follow (steady_continuation.c), and a burst
 * from where they end. Where a controller is saturated, a quantity grows by as much each period and nothing
 * else happens: the search leaps along it, as far as the same events follow each other. */
#include "steady_step.h"

#include "magnitudes.h"

#include <math.h>
#include <string.h>

/* MOST_SHORTER: steps of a burst that are shorter than Newton's method has them. */
enum { MOST_SHORTER = 10, MOST_UNHELPFUL = 4, MOST_LEAPS = 24 };

/* A residual with which it is done. */
static const double converged = 1e-11;

/* Is the last pass an answer, and no further step better? `before`: the residual before it. */
static bool is_done(const struct dalcs_steady *st, double before) {
    bool is = st->pass.residual <= converged ||
              (st->pass.residual <= dalcs_steady_good && st->pass.residual >= before);
    return is && dalcs_steady_switches_return(st);
}

struct burst {
    long plain;             /* periods that are run besides where the next step does not help */
    int whole;              /* steps of Newton's method in a row */
    int shorter, unhelpful; /* steps */
    bool done;
    bool is_in_circle;

    struct start {          /* of a step; of those that were shortened */
        uint64_t signature; /* of the modes behind it */
        double residual, distance;
    } from, seen[MOST_SHORTER];
};

static bool is_alike(double a, double b) {
    return fabs(a - b) <= dalcs_nothing * fabs(b);
}

/* Steps go in a circle if an earlier one of the burst that did not help began in the same modes, as far from the orbit: what
 * has followed it follows again. */
static void look_for_circle(struct burst *b) {
    for (int k = 0; k < b->shorter; k++) {
        const struct start *before = &b->seen[k];
        b->is_in_circle = b->is_in_circle || (before->signature == b->from.signature &&
                                              is_alike(before->residual, b->from.residual) &&
                                              is_alike(before->distance, b->from.distance));
    }
    b->seen[b->shorter] = b->from;
}

/* Plain periods from the end of the last pass: the more, the more often steps have not helped. They lead to where the
 * circuit can be, and to modes that follow each other in the steady state. */
static enum dalcs_status go_on(struct dalcs_steady *st, struct burst *b) {
    dalcs_steady_take(st);
    if (b->plain > 0) {
        DALCS_TRY(dalcs_steady_pass(st, b->plain, DALCS_STEADY_PLAIN));
        dalcs_steady_take(st);
    }
    b->plain = 2 * b->plain + 1;
    return dalcs_steady_pass(st, 1, DALCS_STEADY_M);
}

/* Has the step helped behind which the last pass began, if that came to its end? Else a shorter one is tried. `before`: the
 * residual before it. A period that is looked for, too, is a part of the step that no leap has. */
static enum dalcs_status look_behind(struct dalcs_steady *st, double before, bool has_ended,
                                     struct burst *b, bool *helped) {
    *helped = false;
    if (st->own.is_free) {
        *helped = has_ended && st->pass.residual <= 0.5 * before;
        return has_ended ? DALCS_OK : DALCS_NOT_CONVERGED;
    }
    DALCS_TRY(has_ended ? dalcs_steady_find_helped(st, helped) : DALCS_OK);
    if (!*helped) {
        b->whole = 0;
        look_for_circle(b);
        b->shorter++;
        DALCS_TRY(b->is_in_circle ? DALCS_OK : dalcs_steady_shorten(st, helped));
        b->done = *helped && is_done(st, before);
    }
    return DALCS_OK;
}

/* One step, or a shorter one, and plain periods where neither did help. */
static enum dalcs_status try_step(struct dalcs_steady *st, struct burst *b) {
    const double before = st->pass.residual;
    bool helped = false;
    b->from = (struct start){st->pass.signature, before, st->distance};
    dalcs_steady_note_base(st);
    dalcs_steady_take_step(st);
    const enum dalcs_status status = dalcs_steady_pass(st, 1, DALCS_STEADY_M);
    DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    b->done = status == DALCS_OK && is_done(st, before);
    if (!b->done) {
        b->whole++;
        DALCS_TRY(look_behind(st, before, status == DALCS_OK, b, &helped));
    }
    if (!b->done && !helped && !b->is_in_circle) {
        b->unhelpful++;
        DALCS_TRY(go_on(st, b));
        b->done = is_done(st, INFINITY);
    }
    return DALCS_OK;
}

/* The last pass is the first one of it. */
static enum dalcs_status burst_on(struct dalcs_steady *st, bool *done) {
    struct burst b = {.done = is_done(st, 0.0)};
    bool is_stuck = false; /* where the run has come to: steps may lead to where no run does */
    st->n.bursts++;
    for (int k = 0; !b.done && b.whole < DALCS_STEADY_STEPS && b.shorter < MOST_SHORTER &&
                    b.unhelpful < MOST_UNHELPFUL && !b.is_in_circle;
         k++) {
        enum dalcs_status status = dalcs_steady_next_step(st);
        DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
        is_stuck = st->kept.is_stuck && k == 0;
        if (status != DALCS_OK || is_stuck) {
            break;
        }
        status = try_step(st, &b);
        DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
        if (status != DALCS_OK) {
            break;
        }
    }
    st->kept.is_stuck = is_stuck;
    *done = b.done;
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_burst(struct dalcs_steady *st, bool *done) {
    const enum dalcs_status status = dalcs_steady_pass(st, 1, DALCS_STEADY_M);
    DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    return status == DALCS_OK ? burst_on(st, done) : DALCS_OK;
}

/* By how much a conserved quantity grew in the last pass. */
static double growth_of(const struct dalcs_steady *st, const struct dalcs_steady_conserved *c) {
    const int first = st->layout.first[c->system];
    double sum = 0.0;
    for (int x = first; x < st->layout.first[c->system + 1]; x++) {
        sum += c->weight[x - first] * (st->then.x[x] - st->at.x[x]);
    }
    return sum;
}

/* Do the quantities that grow do so in the last pass as in that before the leap, but for what far away is rounding? What
 * else moves has no part in them. */
static bool goes_on(const struct dalcs_steady *st) {
    bool does = true;
    for (int k = 0; k < st->kept.n; k++) {
        const struct dalcs_steady_conserved *c = &st->kept.of[k];
        const double off = c->growth != 0.0 ? growth_of(st, c) - c->growth : 0.0;
        does = does && fabs(off) <= 0.5 * fabs(c->growth);
    }
    return does;
}

/* Along st->drift from where the last pass has come to, as far as the same modes follow each other and take it as far.
 * *endless: that is as far as it was tried. `from`: work. */
static enum dalcs_status leap(struct dalcs_steady *st, double *from, bool *endless) {
    const uint64_t signature = st->pass.signature;
    memcpy(from, st->then.x, (size_t)st->layout.n_x * sizeof(double));
    bool same = true;
    int k = 0;
    for (; k < MOST_LEAPS && same; k++) {
        dalcs_steady_go_by(st, from, st->kept.drift, ldexp(1.0, k));
        enum dalcs_status status = dalcs_steady_pass(st, 1, DALCS_STEADY_M);
        DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
        same = status == DALCS_OK && st->pass.signature == signature && goes_on(st);
    }
    *endless = same;
    st->n.leaps++;
    dalcs_steady_go_by(st, from, st->kept.drift, ldexp(1.0, k - (same ? 1 : 2)));
    return DALCS_OK;
}

/* How much of the last pass is not st->drift. */
static double rest(const struct dalcs_steady *st) {
    double most = 0.0;
    for (int x = 0; x < st->layout.n_x; x++) {
        const double off = fabs(st->then.x[x] - st->at.x[x] - st->kept.drift[x]);
        most = off > 0.0 ? fmax(most, off / st->scale[x]) : most;
    }
    return most;
}

/* Does what drifts at this point of a run do so for ever? It does if Newton's method, in the same modes, comes to where
 * nothing else moves: what still moves may lead to other modes. Runs come to that only if it is stable. st->drift is that
 * of there. */
static enum dalcs_status drifts(struct dalcs_steady *st, const struct dalcs_orbit_point *point,
                                bool *does) {
    uint64_t signature = 0;
    *does = false;
    dalcs_steady_copy_point(st, &st->at, point);
    for (int k = 0; k < DALCS_STEADY_STEPS; k++) {
        enum dalcs_status status = dalcs_steady_pass(st, 1, DALCS_STEADY_M);
        const bool same = k == 0 || st->pass.signature == signature;
        signature = st->pass.signature;
        status = status == DALCS_OK ? dalcs_steady_next_step(st) : status;
        DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
        if (status != DALCS_OK || !same || !st->kept.is_stuck) {
            return DALCS_OK;
        }
        if (rest(st) <= dalcs_steady_good) {
            *does = dalcs_steady_largest_multiplier(st) <= 1.0 + dalcs_alike;
            return DALCS_OK;
        }
        dalcs_steady_take_step(st);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_refine(struct dalcs_steady *st, struct dalcs_orbit_point *best) {
    for (int k = 0; k < DALCS_STEADY_STEPS; k++) {
        const double before = st->pass.residual;
        const double period = st->period;
        enum dalcs_status status = dalcs_steady_next_step(st);
        if (status != DALCS_OK || !(st->distance > dalcs_steady_good)) {
            return status < DALCS_OK ? status : DALCS_OK;
        }
        dalcs_steady_copy_point(st, best, &st->at);
        dalcs_steady_take_step(st);
        status = dalcs_steady_pass(st, 1, DALCS_STEADY_M);
        DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
        if (status != DALCS_OK || !(st->pass.residual <= 0.5 * before) ||
            !dalcs_steady_switches_return(st)) {
            dalcs_steady_copy_point(st, &st->at, best);
            st->period = period;
            return dalcs_steady_pass(st, 1, DALCS_STEADY_M);
        }
    }
    return DALCS_OK;
}

/* Where a leap leads no run need go. So growth without end, or no steady state, behind one counts for nothing: the search
 * goes back to where the first leap began, and goes on without any. */
struct search {
    struct dalcs_orbit_point run;    /* where it has come to */
    struct dalcs_orbit_point from;   /* work */
    struct dalcs_orbit_point before; /* the first leap */
    long wait, total, total_before;  /* periods: of the next run, so far, before the first leap */
    bool has_leapt, may_leap;
};

static bool make_points(struct dalcs_steady *st, struct search *s) {
    return dalcs_steady_make_point(st, &s->run) && dalcs_steady_make_point(st, &s->from) &&
           dalcs_steady_make_point(st, &s->before);
}

static void go_back(struct dalcs_steady *st, struct search *s) {
    dalcs_steady_copy_point(st, &st->at, &s->before);
    s->wait = s->total = s->total_before;
    s->may_leap = false;
}

/* From s->run, where a conserved quantity grows: a leap, or whether it grows for ever. */
static enum dalcs_status leave(struct dalcs_steady *st, struct search *s, bool *endless) {
    if (!dalcs_steady_has_drift(st)) {
        dalcs_steady_copy_point(st, &st->at, &s->run);
        return DALCS_OK;
    }
    DALCS_TRY(leap(st, s->from.x, endless));
    if (!*endless && s->may_leap) {
        if (!s->has_leapt) {
            dalcs_steady_copy_point(st, &s->before, &s->run);
            s->total_before = s->total;
        }
        s->has_leapt = true;
        s->wait = 1;
        return DALCS_OK;
    }
    DALCS_TRY(*endless ? drifts(st, &s->run, endless) : DALCS_OK);
    if (*endless && s->has_leapt && s->may_leap) {
        *endless = false;
        go_back(st, s);
    } else if (!*endless) {
        dalcs_steady_copy_point(st, &st->at, &s->run);
    }
    return DALCS_OK;
}

/* From s->run along the states of circuits that leak (steady_homotopy.c), and a burst from where they have led. */
static enum dalcs_status try_leaking(struct dalcs_steady *st, const struct search *s, bool *found) {
    bool is_near;
    dalcs_steady_copy_point(st, &st->at, &s->run);
    DALCS_TRY(dalcs_steady_follow(st, &is_near));
    return is_near ? burst_on(st, found) : DALCS_OK; /* the last pass is from there, with M */
}

/* A burst from s->run; where it ends nowhere, two ways to where another one may begin. */
static enum dalcs_status try_from_run(struct dalcs_steady *st, const struct search *s,
                                      bool *found) {
    bool is_near;
    st->kept.is_stuck = false;
    DALCS_TRY(dalcs_steady_burst(st, found));
    if (*found || st->kept.is_stuck) {
        return DALCS_OK;
    }
    dalcs_steady_copy_point(st, &st->at, &s->run);
    DALCS_TRY(dalcs_steady_continue(st, s->total, &is_near));
    DALCS_TRY(is_near ? burst_on(st, found) : DALCS_OK); /* the last pass is from there, with M */
    DALCS_TRY(*found ? DALCS_OK : try_leaking(st, s, found));
    st->kept.is_stuck = false; /* the run is not */
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_search(struct dalcs_steady *st, long most, bool *found,
                                      bool *endless) {
    struct search s = {.wait = 1, .may_leap = true};
    if (!make_points(st, &s)) {
        return DALCS_E_NOMEM;
    }
    *found = *endless = false;
    while (!*found && !*endless && !dalcs_steady_is_crowded(st, NULL) &&
           (s.total <= most || (s.has_leapt && s.may_leap))) {
        if (s.total > most) {
            go_back(st, &s);
        }
        DALCS_TRY(dalcs_steady_pass(st, s.wait, DALCS_STEADY_PLAIN));
        dalcs_steady_take(st);
        s.total += s.wait;
        dalcs_steady_copy_point(st, &s.run, &st->at);
        DALCS_TRY(try_from_run(st, &s, found));
        s.wait = s.total;
        if (!*found && st->kept.is_stuck) {
            DALCS_TRY(leave(st, &s, endless));
        } else if (!*found) {
            dalcs_steady_copy_point(st, &st->at, &s.run);
        }
    }
    if (!*found && !*endless) { /* what is told of the last period is of one of the run */
        enum dalcs_status status = dalcs_steady_pass(st, 1, DALCS_STEADY_PLAIN);
        return status < DALCS_OK ? status : DALCS_OK;
    }
    return *found ? dalcs_steady_refine(st, &s.run) : DALCS_OK;
}

/* steady_oscillation.c - circuits without a clock: what repeats, and how often.
 *
 * A run is watched for events that come again, in spans each twice as long as the one before, so that no time needs to be
 * known beforehand. The last event and the nearest one like it before are a guess of a period; Newton's method for state
 * and period (steady_free.c) starts in the longest time between events there, where nothing happens at the beginning or
 * the end. Where it fails the run goes on. A circuit that rests is nudged once: a symmetric one may rest where it cannot
 * stay. */
#include "steady_step.h"

#include "steady_watch.h"

#include <math.h>
#include <string.h>

/* s: the first span, if no period is given. */
static const double first_span = 1e-9;

enum {
    MOST_SPANS = 90,   /* from 1 ns to 1e18 s */
    MOST_EVENTS = 512, /* that are watched in a span */
    FEW_EVENTS = 24,   /* a span with less is followed by one of twice the length */
    MOST_BURSTS = 24,
    RESTS_FOR =
        20 /* spans without events or change: the last one is a million times longer than the first */
};

/* What moves less than this over a span, over its scale, does not move. */
static const double rests_within = 1e-10;

/* By this part of the scale a circuit that rests is nudged, and by so many V or A where that is 0. */
static const double nudge = 1e-3;

struct search {
    struct dalcs_steady *st;
    struct dalcs_steady_watch watch;
    struct dalcs_orbit_point run; /* where the run has come to */
    double *largest;              /* [n_x] of each state so far */
    double span;                  /* s, the next one */
    int spans;                    /* so many since the first one, or since it was nudged */
    int bursts, rests;
    bool nudged;
    bool rings; /* without an event */
};

static void note_largest(struct search *s) {
    const struct dalcs_steady *st = s->st;
    for (int x = 0; x < st->layout.n_x; x++) {
        s->largest[x] = fmax(s->largest[x], fmax(fabs(st->then.x[x]), st->scale[x]));
    }
}

static bool has_moved(const struct search *s) {
    const struct dalcs_steady *st = s->st;
    bool moved = false;
    for (int x = 0; x < st->layout.n_x; x++) {
        moved = moved || !(fabs(st->then.x[x] - st->at.x[x]) <= rests_within * s->largest[x]);
    }
    return moved;
}

/* Different states by different parts, so that no symmetry stays. */
static void nudge_states(struct search *s) {
    struct dalcs_steady *st = s->st;
    double part = 0.5;
    for (int x = 0; x < st->layout.n_x; x++) {
        part = fmod(part + 0.6180339887498949, 1.0);
        st->at.x[x] += nudge * (0.5 + part) * (s->largest[x] > 0.0 ? s->largest[x] : 1.0);
    }
    s->nudged = true;
    s->spans = s->rests = 0;
    s->span = first_span;
}

static void drop_what_died_away(struct search *s) {
    struct dalcs_steady *st = s->st;
    for (int x = 0; x < st->layout.n_x; x++) {
        st->at.x[x] = fabs(st->at.x[x]) > rests_within * s->largest[x] ? st->at.x[x] : 0.0;
    }
}

/* The middle of the longest time between two events of the watch from `from` to `to`. */
static double calmest(const struct dalcs_steady_watch *watch, int from, int to) {
    double longest = -1.0;
    double middle = 0.0;
    for (int k = from; k < to; k++) {
        const double length = watch->event[k + 1].t - watch->event[k].t;
        if (length > longest) {
            longest = length;
            middle = watch->event[k].t + 0.5 * length;
        }
    }
    return middle;
}

/* After how many events the later half of them are the same ones again, by their kinds; or 0. The first ones may be of
 * other kinds: where a run begins in a mode that is one of several. */
static int recurrence(const struct dalcs_steady_watch *watch) {
    for (int length = 1; length <= watch->n / 2; length++) {
        bool same = true;
        for (int k = watch->n / 2; k < watch->n && same; k++) {
            same = watch->event[k].kind == watch->event[k - length].kind &&
                   watch->event[k].part == watch->event[k - length].part;
        }
        if (same) {
            return length;
        }
    }
    return 0;
}

static bool is_near(const struct dalcs_steady *st, int x, double by) {
    const double within = fmax(rests_within, st->distance);
    return fabs(by) <= within * fmax(st->scale[x], fabs(st->at.x[x]));
}

/* Any time is a period of a state that stays, and Newton's method may come to one, as near as it comes to an orbit. What has
 * only rounding for a sign may have events there. */
static bool is_at_rest(const struct dalcs_steady *st, const struct dalcs_steady_watch *watch) {
    bool rests = st->layout.memory.n_numbers == 0;
    for (int x = 0; x < st->layout.n_x && rests; x++) {
        rests = is_near(st, x, st->pass.first[x] * st->period);
    }
    for (int k = 0; k < watch->n && rests; k++) {
        const struct dalcs_steady_event *e = &watch->event[k];
        const int first = st->layout.first[e->part];
        for (int x = first; x < st->layout.first[e->part + 1] && rests; x++) {
            rests = is_near(st, x, e->x[x - first] - st->at.x[x]);
        }
    }
    return rests;
}

/* How often the orbit's events repeat within what was taken for its period. They are those of the orbit, not of the guess:
 * a run that settles has events in another order here and there. By times, since an event at the very end is not seen.
 * 0: nothing moves. */
static enum dalcs_status count_turns(struct dalcs_steady *st, int *n) {
    struct dalcs_steady_watch watch;
    int from = 0;
    int to = 0;
    bool recurs = false;
    DALCS_TRY(dalcs_steady_watch_setup(&watch, st->layout.n_systems, MOST_EVENTS));
    const enum dalcs_status status =
        dalcs_steady_pass_watched(st, st->period, &watch, &recurs, &from, &to);
    const int length = recurrence(&watch);
    *n = status == DALCS_OK && is_at_rest(st, &watch) ? 0 : 1;
    if (status == DALCS_OK && *n > 0 && length > 0) {
        const double turn = watch.event[watch.n - 1].t - watch.event[watch.n - 1 - length].t;
        *n = turn > st->period / MOST_EVENTS ? (int)lround(st->period / turn) : 1;
    }
    dalcs_steady_watch_finish(&watch);
    return status;
}

/* Of an orbit that was found by a guess of n periods of it: the period that is its shortest one. */
static enum dalcs_status shorten(struct dalcs_steady *st, int n) {
    const double period = st->period;
    const double distance = st->distance;
    for (int parts = n; parts > 1; parts--) {
        if (n % parts != 0) {
            continue;
        }
        st->period = period / parts;
        enum dalcs_status status = dalcs_steady_pass(st, 1, DALCS_STEADY_M);
        DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
        if (status == DALCS_OK && dalcs_steady_comes_back(st, distance)) {
            return DALCS_OK;
        }
    }
    st->period = period;
    return n > 1 ? dalcs_steady_pass(st, 1, DALCS_STEADY_M) : DALCS_OK;
}

/* From the last span's events on. */
static enum dalcs_status try_period(struct search *s, int from, int to, bool *found, bool *rests) {
    struct dalcs_steady *st = s->st;
    int n = 1;
    st->period = s->watch.event[to].t - s->watch.event[from].t;
    const double middle = calmest(&s->watch, from, to);
    DALCS_TRY(dalcs_steady_pass_watched(st, middle, NULL, NULL, NULL, NULL));
    dalcs_steady_take(st);
    dalcs_steady_copy_point(st, &s->run, &st->at);
    s->bursts++;
    s->spans++;
    DALCS_TRY(dalcs_steady_burst(st, found));
    if (*found) {
        DALCS_TRY(dalcs_steady_refine(st, &s->run));
        DALCS_TRY(count_turns(st, &n));
        if (n == 0) {
            *rests = true;
            *found = false;
            drop_what_died_away(s);
            return DALCS_OK;
        }
        DALCS_TRY(shorten(st, n));
        return dalcs_steady_refine(st, &s->run);
    }
    s->span = fmax(s->span, 2.0 * middle);
    dalcs_steady_copy_point(st, &st->at, &s->run);
    return DALCS_OK;
}

static enum dalcs_status go_on(struct search *s, bool *found, bool *rests) {
    struct dalcs_steady *st = s->st;
    const int n_parts = st->layout.n_systems;
    int from = 0;
    int to = 0;
    bool recurs = false;
    DALCS_TRY(dalcs_steady_watch_setup(&s->watch, n_parts, MOST_EVENTS));
    DALCS_TRY(dalcs_steady_pass_watched(st, s->span, &s->watch, &recurs, &from, &to));
    note_largest(s);
    if (recurs && s->watch.n >= FEW_EVENTS) {
        return try_period(s, from, to, found, rests);
    }
    s->rings = s->watch.n == 0 && dalcs_steady_watch_is_full(&s->watch);
    const bool is_still = st->has_point && s->watch.n == 0 && !has_moved(s);
    s->rests = is_still ? s->rests + 1 : 0;
    dalcs_steady_take(st);
    s->span *= 2.0;
    s->spans++;
    if (s->rests >= RESTS_FOR && !s->nudged) {
        nudge_states(s);
    } else if (s->rests >= RESTS_FOR) {
        *rests = true;
        drop_what_died_away(s);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_oscillation(struct dalcs_steady *st, double guess, bool *found,
                                           bool *rests) {
    struct search s = {.st = st, .span = guess > 0.0 ? guess : first_span};
    enum dalcs_status status = DALCS_OK;
    *found = *rests = false;
    st->own.is_free = true;
    s.largest = dalcs_arena_alloc(&st->arena, (size_t)st->layout.n_x + 1, sizeof(double));
    if (s.largest == NULL || !dalcs_steady_make_point(st, &s.run)) {
        return DALCS_E_NOMEM;
    }
    if (st->layout.n_x == 0) {
        *rests = true;
        return DALCS_OK;
    }
    while (s.spans < MOST_SPANS && s.bursts < MOST_BURSTS && !*found && !*rests && !s.rings) {
        status = go_on(&s, found, rests);
        dalcs_steady_watch_finish(&s.watch);
        DALCS_TRY(status);
    }
    st->own.is_free_of_events = s.rings || s.bursts == 0;
    return DALCS_OK;
}

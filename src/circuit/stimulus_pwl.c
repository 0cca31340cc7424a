/* stimulus_pwl.c - PWL: straight lines between points, once or again and again. */
#include "stimulus_kinds.h"

#include <math.h>

static bool is_past(const struct dalcs_stimulus *s, int point, double limit, bool or_equal) {
    const double time = s->u.pwl.t[point];
    return time > limit || (or_equal && time == limit);
}

/* The first point with a time > limit, or with a time >= limit; n when there is none. What gates write grows at its end,
 * and is asked for there: the last jump, of two points, is looked at first. */
static int pwl_search(const struct dalcs_stimulus *s, double limit, bool or_equal) {
    int low = 0;
    int high = s->u.pwl.n;
    const int tail = high > 2 ? high - 3 : 0;
    while (high > tail && is_past(s, high - 1, limit, or_equal)) {
        high--;
    }
    if (high > tail) {
        return high;
    }
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (is_past(s, middle, limit, or_equal)) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

/* Where a time is in the first course of a PWL that repeats. */
struct place {
    double time;  /* repeat_from to the last point, once that is passed */
    double ahead; /* s, of the present course before t: a whole number of periods */
    bool is_seam; /* the last point and repeat_from at once */
};

static struct place find_place(const struct dalcs_stimulus *s, double t, double near) {
    const double from = s->u.pwl.repeat_from;
    const double last = s->u.pwl.t[s->u.pwl.n - 1];
    struct place place = {.time = t};
    if (!s->u.pwl.repeats || t < last - near) {
        return place;
    }
    const double period = last - from;
    double n = floor((t - from) / period);
    place.ahead = n * period;
    place.time = t - place.ahead;
    if (place.time >= last - near) {
        place.ahead = (n + 1) * period;
        place.time = from;
    }
    place.is_seam = fabs(place.time - from) <= near;
    return place;
}

static double pwl_value_once(const struct dalcs_stimulus *s, double t, double near,
                             enum dalcs_side side) {
    const double *time = s->u.pwl.t;
    const double *value = s->u.pwl.v;
    const int first = pwl_search(s, t - near, true);
    const int last = pwl_search(s, t + near, false);
    if (last > first) {
        return side == DALCS_LEFT ? value[first] : value[last - 1];
    }
    if (first == 0) {
        return value[0];
    }
    if (first == s->u.pwl.n) {
        return value[first - 1];
    }
    const double part = (t - time[first - 1]) / (time[first] - time[first - 1]);
    return value[first - 1] + (value[first] - value[first - 1]) * part;
}

double dalcs_pwl_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side) {
    const double near = dalcs_stimulus_tolerance(t, 0);
    const struct place place = find_place(s, t, near);
    const bool ends = place.is_seam && side == DALCS_LEFT;
    return pwl_value_once(s, ends ? s->u.pwl.t[s->u.pwl.n - 1] : place.time, near, side);
}

double dalcs_pwl_next_edge(const struct dalcs_stimulus *s, double t) {
    const double near = dalcs_stimulus_tolerance(t, 0);
    const struct place place = find_place(s, t, near);
    const int next = pwl_search(s, place.time + near, false);
    return next < s->u.pwl.n ? s->u.pwl.t[next] + place.ahead : (double)INFINITY;
}

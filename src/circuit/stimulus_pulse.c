/* stimulus_pulse.c - values, edges and jumps of PULSE.
 *
 * A PULSE is a row of edges, delay + n period + offset with n an integer, each followed by a
 * segment (rise, high, fall, low). Every question is answered from the few edges around t: edges at
 * the same time within rounding form a cluster, whose left limit is the end of the segment before it
 * and whose right limit is the start of the segment after it, both exact values of the card. */
#include "stimulus_kinds.h"

#include <math.h>

enum segment { BEFORE = -1, RISE = 0, HIGH = 1, FALL = 2, LOW = 3, AFTER = 4 };

/* An edge and the segment that follows it. */
struct edge {
    double time;
    enum segment segment;
};

/* Rounding may put a time in the period before its own, of which the one before and the next one
 * must be there. */
enum { PERIODS_AROUND = 4 };

/* The edges of the periods around a time, ascending, and the end of the last period. */
struct edges {
    struct edge item[4 * PERIODS_AROUND + 1];
    int n;
};

/* Puts the end of the last period in place of all edges from there on. */
static void end_edges(const struct dalcs_stimulus *s, struct edges *edges) {
    const double stop = s->u.pulse.delay + s->u.pulse.n_periods * s->u.pulse.period;
    const double near = dalcs_stimulus_tolerance(stop, s->u.pulse.delay);
    while (edges->n > 0 && edges->item[edges->n - 1].time >= stop - near) {
        edges->n--;
    }
    edges->item[edges->n++] = (struct edge){stop, AFTER};
}

static double period_start(const struct dalcs_stimulus *s, double n) {
    return n == 0 ? s->u.pulse.delay : s->u.pulse.delay + n * s->u.pulse.period;
}

/* Those around t, `near` of which is the same time: up to the first one behind it. */
static void collect_edges(const struct dalcs_stimulus *s, double t, double near,
                          struct edges *edges) {
    const double rise_end = s->u.pulse.rise;
    double fall_start = rise_end + s->u.pulse.width;
    double period = s->u.pulse.period;
    /* An offset equal to the period but for rounding is the next period's start, not an edge of its
     * own a hair away from it. */
    double end = isinf(period) ? (double)INFINITY : period * (1 - dalcs_rounded);
    if (rise_end == 0 && fall_start >= end && s->u.pulse.n_periods == 0) {
        /* High for ever: the restarts change nothing. */
        fall_start = period = end = (double)INFINITY;
    }
    const double offset[4] = {0, rise_end, fall_start, fall_start + s->u.pulse.fall};

    double first = isinf(period) ? 0 : floor((t - s->u.pulse.delay) / period) - 1;
    first = first < 0 ? 0 : first;
    const bool may_be_last = s->u.pulse.n_periods > 0 && first + 1 >= s->u.pulse.n_periods;
    if (isfinite(period) && !may_be_last && period_start(s, first + 1) < t - near) {
        first += 1; /* what is before it does not matter */
    }
    const int n_periods = isinf(period) ? 1 : PERIODS_AROUND;
    bool is_behind = false;
    edges->n = 0;
    for (int k = 0; k < n_periods && !is_behind; k++) {
        const double start = period_start(s, first + k);
        for (int j = 0; j < 4 && offset[j] < end && !is_behind; j++) {
            edges->item[edges->n++] = (struct edge){start + offset[j], (enum segment)j};
            is_behind = start + offset[j] > t + near;
        }
    }
    if (s->u.pulse.n_periods > 0 && first + n_periods >= s->u.pulse.n_periods) {
        end_edges(s, edges);
    }
}

/* The edges at t are item[first..last-1]; none when the two are equal, and then t lies in the
 * segment of item[first - 1]. */
static void find_cluster(const struct edges *edges, double t, double near, int *first, int *last) {
    int k = 0;
    while (k < edges->n && edges->item[k].time < t - near) {
        k++;
    }
    *first = k;
    while (k < edges->n && edges->item[k].time <= t + near) {
        k++;
    }
    *last = k;
}

static double segment_start(const struct dalcs_stimulus *s, enum segment segment) {
    return segment == HIGH || segment == FALL ? s->u.pulse.high : s->u.pulse.low;
}

static double segment_end(const struct dalcs_stimulus *s, enum segment segment) {
    return segment == RISE || segment == HIGH ? s->u.pulse.high : s->u.pulse.low;
}

static double within_segment(const struct dalcs_stimulus *s, enum segment segment, double since,
                             double near) {
    const double length = segment == RISE ? s->u.pulse.rise : s->u.pulse.fall;
    if ((segment != RISE && segment != FALL) || since >= length - near) {
        return segment_end(s, segment);
    }
    const double from = segment_start(s, segment);
    return from + (segment_end(s, segment) - from) * (since / length);
}

/* Just before edge k of them, or at t behind the last one before that where it is no edge. */
static double value_before(const struct dalcs_stimulus *s, const struct edges *edges, int k,
                           const double *t, double near) {
    if (k == 0) {
        return s->u.pulse.low;
    }
    const struct edge *before = &edges->item[k - 1];
    if (t == NULL && edges->item[k].segment == before->segment + 1) {
        return segment_end(s, before->segment);
    }
    /* Inside a segment, or at its end where the next period cuts it short. */
    const double end = t == NULL ? edges->item[k].time : *t;
    return within_segment(s, before->segment, end - before->time, near);
}

static double value_at(const struct dalcs_stimulus *s, const struct edges *edges,
                       const int cluster[2], double t, enum dalcs_side side) {
    const double near = dalcs_stimulus_tolerance(t, s->u.pulse.delay);
    const bool is_edge = cluster[1] > cluster[0];
    if (is_edge && side == DALCS_RIGHT) {
        return segment_start(s, edges->item[cluster[1] - 1].segment);
    }
    return value_before(s, edges, cluster[0], is_edge ? NULL : &t, near);
}

double dalcs_pulse_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side) {
    struct edges edges;
    int cluster[2];
    const double near = dalcs_stimulus_tolerance(t, s->u.pulse.delay);
    collect_edges(s, t, near, &edges);
    find_cluster(&edges, t, near, &cluster[0], &cluster[1]);
    return value_at(s, &edges, cluster, t, side);
}

double dalcs_pulse_line(const struct dalcs_stimulus *s, double t, double *level, double *last) {
    struct edges edges;
    int cluster[2];
    const double near = dalcs_stimulus_tolerance(t, s->u.pulse.delay);
    collect_edges(s, t, near, &edges);
    find_cluster(&edges, t, near, &cluster[0], &cluster[1]);
    *level = *last = value_at(s, &edges, cluster, t, DALCS_RIGHT);
    if (s->u.pulse.low == s->u.pulse.high || cluster[1] >= edges.n) {
        return INFINITY;
    }
    const double to = edges.item[cluster[1]].time;
    *last =
        value_before(s, &edges, cluster[1], NULL, dalcs_stimulus_tolerance(to, s->u.pulse.delay));
    return to;
}

double dalcs_pulse_next_edge(const struct dalcs_stimulus *s, double t) {
    if (s->u.pulse.low == s->u.pulse.high) {
        return INFINITY;
    }
    struct edges edges;
    int first;
    int last;
    const double near = dalcs_stimulus_tolerance(t, s->u.pulse.delay);
    collect_edges(s, t, near, &edges);
    find_cluster(&edges, t, near, &first, &last);
    return last < edges.n ? edges.item[last].time : INFINITY;
}

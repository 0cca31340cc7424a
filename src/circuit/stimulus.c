/* stimulus.c - values, edges and jumps of DC, SIN, PULSE, PWL and EXP sources, and of sums of tones.
 *
 * A PULSE is a row of edges, delay + n period + offset with n an integer, each followed by a
 * segment (rise, high, fall, low). Every question is answered from the few edges around t: edges at
 * the same time within rounding form a cluster, whose left limit is the end of the segment before it
 * and whose right limit is the start of the segment after it, both exact values of the card. */
#include "formula_stimulus.h"
#include "history.h"
#include "pi.h"
#include "rounding.h"

#include <float.h>
#include <math.h>

/* How far from an edge a time may be and still mean it. An edge is computed with three roundings and
 * a caller's time grid with about as many. */
static double tolerance(double t, double delay) {
    return dalcs_rounded * fmax(fabs(t), fabs(delay));
}

/* ---- SIN ----------------------------------------------------------------------------------- */

/* The nearest whole number: a sum with no bits left for a fraction, several times faster than a call
 * of floor. */
static double nearest_whole(double x) {
    return fabs(x) < 0x1p51 ? (x + 0x1.8p52) - 0x1.8p52 : x;
}

/* sin(2 pi x), exact at quarters: reducing x rather than 2 pi x makes the zeros of a mains voltage
 * zeros, which is where rectifiers are most degenerate. */
static double sin_of_cycles(double x) {
    double r = x - nearest_whole(x); /* -1/2 .. 1/2 */
    if (r > 0.25) {
        r = 0.5 - r;
    } else if (r < -0.25) {
        r = -0.5 - r;
    }
    return sin(2 * dalcs_pi * r);
}

/* Phase in cycles, less whole ones, at `since` after a start at `phase`. The product's rounding error,
 * which grows with the number of cycles, is put back. */
static double cycles_at(double frequency, double since, double phase) {
    const double cycles = frequency * since;
    const double lost = fma(frequency, since, -cycles);
    return (cycles - nearest_whole(cycles)) + (phase + lost);
}

static double cycles_of(const struct dalcs_stimulus *s, double since) {
    return cycles_at(s->u.sine.frequency, since, s->u.sine.phase / 360);
}

/* How long the cycles last, INFINITY when there is no end. */
static double sine_length(const struct dalcs_stimulus *s) {
    return s->u.sine.n_cycles > 0 ? s->u.sine.n_cycles / s->u.sine.frequency : (double)INFINITY;
}

static double sine_value(const struct dalcs_stimulus *s, double t) {
    const double since = fmin(t - s->u.sine.delay, sine_length(s));
    if (since <= 0) {
        return s->u.sine.offset + s->u.sine.amplitude * sin_of_cycles(s->u.sine.phase / 360);
    }
    double value = s->u.sine.amplitude * sin_of_cycles(cycles_of(s, since));
    if (s->u.sine.damping != 0) {
        value *= exp(-s->u.sine.damping * since);
    }
    return s->u.sine.offset + value;
}

/* ---- PULSE --------------------------------------------------------------------------------- */

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
    const double near = tolerance(stop, s->u.pulse.delay);
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

static double pulse_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side) {
    struct edges edges;
    int first;
    int last;
    const double near = tolerance(t, s->u.pulse.delay);
    collect_edges(s, t, near, &edges);
    find_cluster(&edges, t, near, &first, &last);
    if (last > first && side == DALCS_RIGHT) {
        return segment_start(s, edges.item[last - 1].segment);
    }
    if (first == 0) {
        return s->u.pulse.low;
    }
    const struct edge *before = &edges.item[first - 1];
    const bool follows = last > first && edges.item[first].segment == before->segment + 1;
    if (follows) {
        return segment_end(s, before->segment);
    }
    /* Inside a segment, or at its end where the next period cuts it short. */
    const double end = last > first ? edges.item[first].time : t;
    return within_segment(s, before->segment, end - before->time, near);
}

static double pulse_next_edge(const struct dalcs_stimulus *s, double t) {
    if (s->u.pulse.low == s->u.pulse.high) {
        return INFINITY;
    }
    struct edges edges;
    int first;
    int last;
    const double near = tolerance(t, s->u.pulse.delay);
    collect_edges(s, t, near, &edges);
    find_cluster(&edges, t, near, &first, &last);
    return last < edges.n ? edges.item[last].time : INFINITY;
}

/* ---- EXP ----------------------------------------------------------------------------------- */

/* 1 - exp(-(t - delay) / tau) after the delay, 0 before. */
static double approach(double t, double delay, double tau, enum dalcs_side side) {
    const double near = tolerance(t, 0);
    const bool is_jump = tau <= near;
    if (t < delay - near) {
        return 0;
    }
    if (t <= delay + near) {
        return is_jump && side == DALCS_RIGHT ? 1 : 0;
    }
    return is_jump ? 1 : -expm1(-(t - delay) / tau);
}

static double exponential_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side) {
    const double rise = approach(t, s->u.exponential.rise_delay, s->u.exponential.rise_tau, side);
    const double fall = approach(t, s->u.exponential.fall_delay, s->u.exponential.fall_tau, side);
    return s->u.exponential.low + (s->u.exponential.high - s->u.exponential.low) * (rise - fall);
}

/* ---- PWL ----------------------------------------------------------------------------------- */

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

static double pwl_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side) {
    const double near = tolerance(t, 0);
    const struct place place = find_place(s, t, near);
    const bool ends = place.is_seam && side == DALCS_LEFT;
    return pwl_value_once(s, ends ? s->u.pwl.t[s->u.pwl.n - 1] : place.time, near, side);
}

static double pwl_next_edge(const struct dalcs_stimulus *s, double t) {
    const double near = tolerance(t, 0);
    const struct place place = find_place(s, t, near);
    const int next = pwl_search(s, place.time + near, false);
    return next < s->u.pwl.n ? s->u.pwl.t[next] + place.ahead : (double)INFINITY;
}

/* ---- Tones --------------------------------------------------------------------------------- */

static bool tones_have_begun(const struct dalcs_stimulus *s, double t, enum dalcs_side side) {
    const double near = s->u.tones.delay > 0 ? tolerance(t, s->u.tones.delay) : 0;
    return s->u.tones.delay <= 0 || t > s->u.tones.delay + near ||
           (side == DALCS_RIGHT && t >= s->u.tones.delay - near);
}

static double tones_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side) {
    if (!tones_have_begun(s, t, side)) {
        return 0;
    }
    double sum = s->u.tones.offset;
    for (int k = 0; k < s->u.tones.n; k++) {
        const struct dalcs_tone *tone = &s->u.tones.tone[k];
        sum += tone->amplitude *
               sin_of_cycles(cycles_at(tone->frequency, t - s->u.tones.delay, tone->phase));
    }
    return sum;
}

/* ---- The interface ------------------------------------------------------------------------- */

double dalcs_stimulus_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side) {
    switch (s->kind) {
    case DALCS_STIMULUS_DC:
        return s->dc;
    case DALCS_STIMULUS_SIN:
        return sine_value(s, t);
    case DALCS_STIMULUS_PULSE:
        return pulse_value(s, t, side);
    case DALCS_STIMULUS_PWL:
        return pwl_value(s, t, side);
    case DALCS_STIMULUS_EXP:
        return exponential_value(s, t, side);
    case DALCS_STIMULUS_TONES:
        return tones_value(s, t, side);
    case DALCS_STIMULUS_DELAYED:
        return dalcs_history_value(s->u.history, t, side);
    case DALCS_STIMULUS_FORMULA:
        return dalcs_formula_stimulus_value(s, t, side);
    }
    return 0;
}

static double if_after(double edge, double t, double near) {
    return edge > t + near ? edge : INFINITY;
}

double dalcs_stimulus_next_edge(const struct dalcs_stimulus *s, double t) {
    switch (s->kind) {
    case DALCS_STIMULUS_DC:
        return INFINITY;
    case DALCS_STIMULUS_SIN:
        return fmin(if_after(s->u.sine.delay, t, tolerance(t, 0)),
                    if_after(s->u.sine.delay + sine_length(s), t, tolerance(t, 0)));
    case DALCS_STIMULUS_PULSE:
        return pulse_next_edge(s, t);
    case DALCS_STIMULUS_PWL:
        return pwl_next_edge(s, t);
    case DALCS_STIMULUS_EXP:
        return fmin(if_after(s->u.exponential.rise_delay, t, tolerance(t, 0)),
                    if_after(s->u.exponential.fall_delay, t, tolerance(t, 0)));
    case DALCS_STIMULUS_TONES:
        return if_after(s->u.tones.delay, t, tolerance(t, 0));
    case DALCS_STIMULUS_DELAYED:
        return dalcs_history_next_edge(s->u.history, t);
    case DALCS_STIMULUS_FORMULA:
        return dalcs_formula_stimulus_next_edge(s, t);
    }
    return INFINITY;
}

bool dalcs_stimulus_jumps_at(const struct dalcs_stimulus *s, double t) {
    if (s->kind == DALCS_STIMULUS_DELAYED) {
        return dalcs_history_jumps_at(s->u.history, t);
    }
    return dalcs_stimulus_value(s, t, DALCS_LEFT) != dalcs_stimulus_value(s, t, DALCS_RIGHT);
}

static void sine_term(const struct dalcs_stimulus *s, double since,
                      struct dalcs_stimulus_term *term) {
    const double cycles = cycles_of(s, since);
    double amplitude = s->u.sine.amplitude;
    amplitude *= s->u.sine.damping != 0 ? exp(-s->u.sine.damping * since) : 1;
    *term = (struct dalcs_stimulus_term){.decay = s->u.sine.damping,
                                         .omega = 2 * dalcs_pi * s->u.sine.frequency,
                                         .cosine = amplitude * sin_of_cycles(cycles),
                                         .sine = amplitude * sin_of_cycles(cycles + 0.25)};
}

static bool sine_is_over(const struct dalcs_stimulus *s, double t) {
    return t - s->u.sine.delay >= sine_length(s) - tolerance(t, 0);
}

static void sine_piece(const struct dalcs_stimulus *s, double t,
                       struct dalcs_stimulus_piece *piece) {
    if (piece->to == s->u.sine.delay || sine_is_over(s, t)) {
        piece->level = sine_value(s, t);
        *piece->term = (struct dalcs_stimulus_term){.decay = s->u.sine.damping,
                                                    .omega = 2 * dalcs_pi * s->u.sine.frequency};
        return;
    }
    piece->level = s->u.sine.offset;
    sine_term(s, t - s->u.sine.delay, piece->term);
}

static void exponential_piece(const struct dalcs_stimulus *s, double t,
                              struct dalcs_stimulus_piece *piece) {
    const double delay[2] = {s->u.exponential.rise_delay, s->u.exponential.fall_delay};
    const double tau[2] = {s->u.exponential.rise_tau, s->u.exponential.fall_tau};
    piece->level = s->u.exponential.low;
    for (int k = 0; k < 2; k++) {
        const double near = tolerance(t, 0);
        double height = s->u.exponential.high - s->u.exponential.low;
        height = k == 0 ? height : -height;
        const bool is_jump = tau[k] <= near;
        piece->term[k] = (struct dalcs_stimulus_term){.decay = is_jump ? 0 : 1 / tau[k]};
        if (t >= delay[k] - near) {
            piece->level += height;
            piece->term[k].cosine = is_jump ? 0 : -height * exp(-fmax(t - delay[k], 0) / tau[k]);
        }
    }
}

static void tones_piece(const struct dalcs_stimulus *s, double t,
                        struct dalcs_stimulus_piece *piece) {
    const bool have_begun = tones_have_begun(s, t, DALCS_RIGHT);
    piece->level = have_begun ? s->u.tones.offset : 0;
    for (int k = 0; k < s->u.tones.n; k++) {
        const struct dalcs_tone *tone = &s->u.tones.tone[k];
        const double amplitude = have_begun ? tone->amplitude : 0;
        const double cycles = cycles_at(tone->frequency, t - s->u.tones.delay, tone->phase);
        piece->term[k] = (struct dalcs_stimulus_term){
            .omega = 2 * dalcs_pi * tone->frequency,
            .cosine = amplitude * sin_of_cycles(cycles),
            .sine = amplitude * sin_of_cycles(cycles + 0.25),
        };
    }
}

int dalcs_stimulus_n_terms(const struct dalcs_stimulus *s) {
    switch (s->kind) {
    case DALCS_STIMULUS_SIN:
        return 1;
    case DALCS_STIMULUS_EXP:
        return 2;
    case DALCS_STIMULUS_TONES:
        return s->u.tones.n;
    case DALCS_STIMULUS_FORMULA:
        return dalcs_formula_stimulus_n_terms(s);
    case DALCS_STIMULUS_DC:
    case DALCS_STIMULUS_PULSE:
    case DALCS_STIMULUS_PWL:
    case DALCS_STIMULUS_DELAYED:
        return 0;
    }
    return 0;
}

void dalcs_stimulus_piece_at(const struct dalcs_stimulus *s, double t,
                             struct dalcs_stimulus_piece *piece) {
    *piece = (struct dalcs_stimulus_piece){.to = dalcs_stimulus_next_edge(s, t),
                                           .n_terms = dalcs_stimulus_n_terms(s),
                                           .term = piece->term};
    switch (s->kind) {
    case DALCS_STIMULUS_SIN:
        sine_piece(s, t, piece);
        return;
    case DALCS_STIMULUS_EXP:
        exponential_piece(s, t, piece);
        return;
    case DALCS_STIMULUS_TONES:
        tones_piece(s, t, piece);
        return;
    case DALCS_STIMULUS_FORMULA:
        dalcs_formula_stimulus_piece(s, t, piece);
        return;
    case DALCS_STIMULUS_DELAYED: /* a polynomial, of which this is where it begins */
        piece->level = dalcs_history_value(s->u.history, t, DALCS_RIGHT);
        return;
    case DALCS_STIMULUS_DC:
    case DALCS_STIMULUS_PULSE:
    case DALCS_STIMULUS_PWL:
        piece->level = dalcs_stimulus_value(s, t, DALCS_RIGHT);
        if (isfinite(piece->to)) {
            const double rise = dalcs_stimulus_value(s, piece->to, DALCS_LEFT) - piece->level;
            piece->slope = rise == 0 ? 0 : rise / (piece->to - t);
        }
        return;
    }
}

void dalcs_stimulus_course_at(const struct dalcs_stimulus *s, double t,
                              struct dalcs_stimulus_piece *piece) {
    if (s->kind != DALCS_STIMULUS_FORMULA) {
        dalcs_stimulus_piece_at(s, t, piece);
        return;
    }
    piece->n_terms = dalcs_stimulus_n_terms(s);
    dalcs_formula_stimulus_piece(s, t, piece);
}

void dalcs_stimulus_terms_at(const struct dalcs_stimulus *s, double t,
                             struct dalcs_stimulus_term *term) {
    if (s->kind == DALCS_STIMULUS_SIN && s->u.sine.n_cycles == 0) {
        sine_term(s, t - s->u.sine.delay, term);
        return;
    }
    struct dalcs_stimulus_piece piece = {.term = term};
    dalcs_stimulus_piece_at(s, t, &piece);
}

double dalcs_stimulus_operating_value(const struct dalcs_stimulus *s, bool transient_follows) {
    if (s->has_dc && !transient_follows) {
        return s->dc;
    }
    if (s->kind == DALCS_STIMULUS_FORMULA) {
        return dalcs_formula_stimulus_operating_value(s, transient_follows);
    }
    return dalcs_stimulus_value(s, 0, DALCS_LEFT);
}

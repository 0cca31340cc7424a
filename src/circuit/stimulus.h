/* stimulus.h - the functions of time that drive V and I sources.
 *
 * A stimulus is piecewise smooth. Edges (breakpoints of value or slope) are computed from integer
 * period counts, never accumulated; a PULSE with zero rise time is a true discontinuity, whose left
 * and right limits both exist.
 *
 * A time within a few roundings of an edge is that edge: everywhere here "at t" means closer than
 * 4 DBL_EPSILON max(|t|, |delay|). Edges closer together than that are one edge. */
#ifndef DALCS_STIMULUS_H
#define DALCS_STIMULUS_H

#include "piecewise.h"

struct dalcs_history;

enum dalcs_stimulus_kind {
    DALCS_STIMULUS_DC,
    DALCS_STIMULUS_SIN,
    DALCS_STIMULUS_PULSE,
    DALCS_STIMULUS_PWL,
    DALCS_STIMULUS_EXP,
    DALCS_STIMULUS_TONES,   /* AM and SFFM */
    DALCS_STIMULUS_DELAYED, /* what a signal was: history.h */
    DALCS_STIMULUS_FORMULA  /* of others: decided.h */
};

/* Which limit to take at a discontinuity. */
enum dalcs_side { DALCS_LEFT, DALCS_RIGHT };

/* amplitude sin(2 pi (frequency t + phase)); V or A, Hz, cycles. */
struct dalcs_tone {
    double amplitude, frequency, phase;
};

/* constant + sum of factors times stimuli. */
struct dalcs_stimulus_sum {
    double constant;
    int n;

    const struct dalcs_stimulus_summand {
        double factor;
        const struct dalcs_stimulus *of;
    } * part;
};

struct dalcs_stimulus {
    enum dalcs_stimulus_kind kind;
    double dc; /* the card's DC value; see has_dc */
    bool has_dc;
    double ac_real, ac_imaginary; /* of the card's AC magnitude and phase; V or A */
    bool is_ac_alone;             /* the card has nothing else */
    bool is_written;  /* while a run goes on, by a gate or from outside: it is not known before */
    bool is_external; /* the latter */

    union {
        /* offset + amplitude exp(-damping (t - delay)) sin(2 pi frequency (t - delay) + phase);
         * before the delay offset + amplitude sin(phase). After n_cycles (0: endless; need not be
         * whole) it stays where it is. */
        struct {
            double offset, amplitude, frequency, delay, damping,
                phase; /* V or A, Hz, s, 1/s, deg */
            double n_cycles;
        } sine;

        /* low until the delay; then in each period: rise, high for `width`, fall, low. A pulse
         * longer than its period is cut by the next one. Low again after n_periods (0: endless). */
        struct {
            double low, high, delay, rise, fall, width, period; /* V or A, s; width or period
                                                                   INFINITY: for ever, once */
            double n_periods;
        } pulse;

        /* low + (high - low) (r - f), r = 1 - exp(-(t - rise_delay) / rise_tau) after rise_delay,
         * f likewise after fall_delay (INFINITY: never); a tau of 0 is a jump */
        struct {
            double low, high, rise_delay, rise_tau, fall_delay, fall_tau;
        } exponential;

        /* straight lines; constant before the first and after the last point, or, repeating, what
         * is from repeat_from to the last point again and again */
        struct {
            int n; /* points, n >= 1; times ascending, equal times are a jump */
            const double *t;
            const double *v;
            bool repeats;
            double repeat_from; /* s, before the last point */
        } pwl;

        /* offset + sum of tones, t counted from the delay; 0 before a delay above 0 */
        struct {
            double offset, delay;
            int n; /* at most DALCS_STIMULUS_MOST_TERMS */
            const struct dalcs_tone *tone;
        } tones;

        const struct dalcs_history *history;

        /* function(argument); its edges are those of the argument and where that passes a knot. A jump of the function
         * has its `value` while the argument rests on it. */
        struct {
            struct dalcs_stimulus_sum argument;
            struct dalcs_piecewise function;
        } formula;
    } u;
};

/* Value at time t >= 0, as the left or right limit. At an edge returned by
 * dalcs_stimulus_next_edge the limits are exact: rounding of t never picks the wrong side. */
double dalcs_stimulus_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side);

/* The first edge strictly after t (beyond rounding, see above), INFINITY when there is none. An
 * edge is a jump of the value or of the slope. */
double dalcs_stimulus_next_edge(const struct dalcs_stimulus *s, double t);

/* The least and the largest value that it may have; false: it has none, or they are not known. */
bool dalcs_stimulus_bounds(const struct dalcs_stimulus *s, double *low, double *high);

/* Does the value itself jump at time t? */
bool dalcs_stimulus_jumps_at(const struct dalcs_stimulus *s, double t);

/* What a stimulus is from t (right limit) to its next edge, with tau the time since t:
 *     level + slope tau + sum of exp(-decay tau) (cosine cos(omega tau) + sine sin(omega tau)).
 * The number of terms, their decay and omega are the same at all times. */
struct dalcs_stimulus_piece {
    double to; /* s, the next edge or INFINITY */
    double level, slope;
    int n_terms;

    struct dalcs_stimulus_term {
        double decay, omega; /* 1/s */
        double cosine, sine;
    } * term; /* [dalcs_stimulus_n_terms], of the caller */
};

enum { DALCS_STIMULUS_MOST_TERMS = 255 };

int dalcs_stimulus_n_terms(const struct dalcs_stimulus *s);

/* Fills *piece, whose `term` the caller has set. */
void dalcs_stimulus_piece_at(const struct dalcs_stimulus *s, double t,
                             struct dalcs_stimulus_piece *piece);

/* The same of which the end is not asked: to find that of a formula's takes a search. */
void dalcs_stimulus_course_at(const struct dalcs_stimulus *s, double t,
                              struct dalcs_stimulus_piece *piece);

/* The terms alone of a piece that has no end, at a t in it. */
void dalcs_stimulus_terms_at(const struct dalcs_stimulus *s, double t,
                             struct dalcs_stimulus_term *term);

/* The value for the operating point, as ngspice chooses it: for a plain .op the card's DC value
 * when it has one; for the start of a transient, or without a DC value, the left limit at 0. */
double dalcs_stimulus_operating_value(const struct dalcs_stimulus *s, bool transient_follows);

#endif

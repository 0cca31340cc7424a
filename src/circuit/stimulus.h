/* stimulus.h - the functions of time that drive V and I sources.
 *
 * A stimulus is piecewise smooth. Edges (breakpoints of value or slope) are computed from integer
 * period counts, never accumulated; a PULSE with zero rise time is a true discontinuity, whose left
 * and right limits both exist. */
#ifndef DALCS_STIMULUS_H
#define DALCS_STIMULUS_H

#include "memory.h"

enum dalcs_stimulus_kind {
    DALCS_STIMULUS_DC,
    DALCS_STIMULUS_SIN,
    DALCS_STIMULUS_PULSE,
    DALCS_STIMULUS_PWL,
    DALCS_STIMULUS_EXP
};

/* Which limit to take at a discontinuity. */
enum dalcs_side { DALCS_LEFT, DALCS_RIGHT };

struct dalcs_stimulus {
    enum dalcs_stimulus_kind kind;
    double dc; /* value in .op when the source has an explicit DC value; see has_dc */
    bool has_dc;
    union {
        struct {
            double offset, amplitude, frequency, delay, damping, phase; /* V or A, Hz, s, 1/s, deg */
        } sine;
        struct {
            double low, high, delay, rise, fall, width, period; /* V or A, s; period INFINITY: once */
        } pulse;
        struct {
            double low, high, rise_delay, rise_tau, fall_delay, fall_tau;
        } exponential;
        struct {
            int n; /* points, n >= 1; times ascending, equal times are a jump */
            const double *t;
            const double *v;
        } pwl;
    } u;
};

/* Value at time t >= 0, as the left or right limit. At an edge returned by
 * dalcs_stimulus_next_edge the limits are exact: rounding of t never picks the wrong side. */
double dalcs_stimulus_value(const struct dalcs_stimulus *s, double t, enum dalcs_side side);

/* The first edge strictly after t (beyond rounding: > t + 4 ulp(t)), INFINITY when there is none.
 * An edge is a jump of the value or of the slope. */
double dalcs_stimulus_next_edge(const struct dalcs_stimulus *s, double t);

/* Does the value itself jump at the edge t? */
bool dalcs_stimulus_jumps_at(const struct dalcs_stimulus *s, double t);

/* The value for the operating point: the DC value when the card has one and no time function was
 * given for t = 0, else the right limit at t = 0 (as ngspice: the transient value at 0). */
double dalcs_stimulus_operating_value(const struct dalcs_stimulus *s, bool transient_follows);

#endif

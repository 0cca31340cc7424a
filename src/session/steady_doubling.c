/* steady_doubling.c - orbits of several periods of the sources, where a run does not stay on that of one.
 *
 * Such an orbit lies near no point that is known: a run is started beside the unstable one and leaves it, and bursts of
 * Newton's method on the map of n periods start where it has come to. What they find may be the old orbit again, or one
 * of a part of n periods: these repeat earlier, and are none. */
#include "steady_step.h"

#include <math.h>

/* Periods of the sources that a run takes before each burst, after those before. */
static const long waits[] = {60, 240, 960};

/* By such a part of the scale the run starts beside the orbit. */
static const double beside = 1e-2;

/* Two orbits that part where a multiplier passes -1 by d are sqrt(d) apart, which is far more than what st->at is off
 * by. */
enum dalcs_status dalcs_steady_find_repeat(struct dalcs_steady *st, double one, int n, int *first) {
    const double whole = st->period;
    const double distance = st->distance;
    enum dalcs_status status = DALCS_OK;
    *first = n;
    for (int k = 1; k < n && *first == n && status == DALCS_OK; k++) {
        if (n % k == 0) {
            st->period = k * one;
            status = dalcs_steady_pass(st, 1, DALCS_STEADY_M);
            *first = status == DALCS_OK && dalcs_steady_comes_back(st, distance) ? k : n;
            status = status < DALCS_OK ? status : DALCS_OK; /* a run that fails is none of it */
        }
    }
    st->period = whole;
    st->distance = distance;
    return status;
}

void dalcs_steady_step_aside(struct dalcs_steady *st) {
    double part = 0.5;
    for (int x = 0; x < st->layout.n_x; x++) {
        part = fmod(part + 0.6180339887498949, 1.0);
        st->at.x[x] += beside * (0.5 + part) * st->scale[x];
    }
}

/* Searches from st->at, which is beside the old orbit. */
static enum dalcs_status look_for(struct dalcs_steady *st, double one, int n, bool *found) {
    struct dalcs_orbit_point run;
    if (!dalcs_steady_make_point(st, &run)) {
        return DALCS_E_NOMEM;
    }
    *found = false;
    for (size_t k = 0; k < sizeof waits / sizeof waits[0] && !*found; k++) {
        int first = n;
        st->period = one;
        DALCS_TRY(dalcs_steady_pass(st, waits[k], DALCS_STEADY_PLAIN));
        dalcs_steady_take(st);
        dalcs_steady_copy_point(st, &run, &st->at);
        st->period = n * one;
        DALCS_TRY(dalcs_steady_burst(st, found));
        if (*found) {
            const enum dalcs_status status = dalcs_steady_next_step(st); /* how far it is off */
            DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
            DALCS_TRY(dalcs_steady_find_repeat(st, one, n, &first));
        }
        *found = *found && first == n;
        if (!*found) {
            dalcs_steady_copy_point(st, &st->at, &run);
        }
    }
    DALCS_TRY(*found ? dalcs_steady_pass(st, 1, DALCS_STEADY_M) : DALCS_OK);
    return *found ? dalcs_steady_refine(st, &run) : DALCS_OK;
}

enum dalcs_status dalcs_steady_go_back(struct dalcs_steady *st,
                                       const struct dalcs_orbit_point *orbit, double period) {
    dalcs_steady_copy_point(st, &st->at, orbit);
    st->period = period;
    return dalcs_steady_pass(st, 1, DALCS_STEADY_M);
}

enum dalcs_status dalcs_steady_replace(struct dalcs_steady *st, double one, int n) {
    const double whole = st->period;
    struct dalcs_orbit_point orbit;
    int first;
    bool found = false;
    if (!dalcs_steady_make_point(st, &orbit)) {
        return DALCS_E_NOMEM;
    }
    dalcs_steady_copy_point(st, &orbit, &st->at);
    DALCS_TRY(dalcs_steady_find_repeat(st, one, n, &first));
    DALCS_TRY(dalcs_steady_go_back(st, &orbit, whole));
    if (first == n || dalcs_steady_largest_multiplier(st) <= 1.0 + 1e-9) {
        return DALCS_OK;
    }
    dalcs_steady_step_aside(st);
    DALCS_TRY(look_for(st, one, n, &found));
    return found ? DALCS_OK : dalcs_steady_go_back(st, &orbit, whole);
}

enum dalcs_status dalcs_steady_look_for_double(struct dalcs_steady *st) {
    const double one = st->period;
    bool found;
    dalcs_steady_step_aside(st);
    enum dalcs_status status = look_for(st, one, 2, &found);
    status = status == DALCS_OK && found ? dalcs_steady_report_double(st, one) : status;
    return status > DALCS_OK ? DALCS_OK : status; /* a run that fails there is not this orbit's */
}

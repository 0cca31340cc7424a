/* sweep.h - values one after the other: of a source, an element, a parameter, a model's parameter, or
 * frequencies.
 *
 * They are counted, never accumulated: value k is made from k alone. */
#ifndef DALCS_SWEEP_H
#define DALCS_SWEEP_H

#include "diag.h"

enum dalcs_sweep_target {
    DALCS_SWEEP_ELEMENT,   /* the value of R, L, C, V, I or the gain of E, F, G, H */
    DALCS_SWEEP_PARAMETER, /* of .param */
    DALCS_SWEEP_MODEL,     /* a parameter of a .model */
    DALCS_SWEEP_RUN,       /* the number of the run, of .mc */
    DALCS_SWEEP_TEMPERATURE
};

enum dalcs_spacing { DALCS_LINEAR, DALCS_DECADES, DALCS_OCTAVES, DALCS_LISTED };

struct dalcs_sweep {
    enum dalcs_sweep_target target;
    const char *name;  /* "v1", "rload", a model's name */
    const char *field; /* the parameter of a model, else NULL */
    const char *label; /* what a person calls it: "v1", "rload", "dmod(vfwd)", "temp" */
    int device;        /* of an element, else -1 */
    enum dalcs_spacing spacing;
    double start, stop;
    double step;        /* linear: between two values; decades, octaves: values in each */
    const double *list; /* [n] listed */
    int n;              /* values, at least 1 */
    struct dalcs_location where;
};

enum { DALCS_SWEEP_MOST = 10000000 };

/* How many values from start to stop there are; 0 when step leads away from stop or is 0, negative
 * when there are more than DALCS_SWEEP_MOST. A last value that rounding puts behind stop counts. */
int dalcs_sweep_count(enum dalcs_spacing spacing, double start, double stop, double step);

/* Value k, 0 <= k < n. */
double dalcs_sweep_value(const struct dalcs_sweep *sweep, int k);

#endif

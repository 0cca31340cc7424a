/* orbit_record.h - the segments of a period as a run had them, to be read at any time of it. */
#ifndef DALCS_ORBIT_RECORD_H
#define DALCS_ORBIT_RECORD_H

#include "radau_state.h"

struct dalcs_orbit_segment {
    double from, to, h;          /* s */
    const double *out;           /* [n_nodes][stride] */
    const uint64_t *mode;        /* [n_words] */
    const double *bystanders[2]; /* at both ends; of outputs of gates they are over with the run */
};

struct dalcs_orbit_record {
    int n;
    size_t capacity;
    struct dalcs_orbit_segment *segment; /* [n] */
};

/* The present segment of the part. */
enum dalcs_status dalcs_orbit_record_take(struct dalcs_orbit_record *record,
                                          const struct dalcs_radau_part *part,
                                          struct dalcs_arena *arena) DALCS_MUST_CHECK;
void dalcs_orbit_record_finish(struct dalcs_orbit_record *record);

/* The segment that ends at t or that t is inside of, or with DALCS_RIGHT the one that begins there; -1: none. */
int dalcs_orbit_record_find(const struct dalcs_orbit_record *record, double t,
                            enum dalcs_side side);

/* weight[n_nodes] and rate[n_nodes] (1 over the step): a polynomial at theta, and its derivative. */
void dalcs_orbit_record_weights(const struct dalcs_collocation *method, double theta,
                                double *weight, double *rate);

#endif

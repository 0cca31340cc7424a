/* kept_stretches.h - all stretches of a run, for what can only be measured after it. */
#ifndef DALCS_KEPT_STRETCHES_H
#define DALCS_KEPT_STRETCHES_H

#include "stretch.h"

#include <stddef.h>

struct dalcs_kept_stretches {
    size_t n;
    size_t n_values; /* of each: its two ends, what it is, then what the signals are at the nodes */
    double *value;   /* [n n_values] heap */
    size_t capacity;
    bool out_of_memory; /* something is missing */
};

/* For stretches with the signals of this one; NULL when out of memory. */
struct dalcs_kept_stretches *dalcs_kept_stretches_create(const struct dalcs_stretch *like);
void dalcs_kept_stretches_destroy(struct dalcs_kept_stretches *kept);

/* Keeps the values of the stretch; of one without length its first coefficients. */
void dalcs_kept_stretches_add(struct dalcs_kept_stretches *kept,
                              const struct dalcs_stretch *stretch);

/* Keeps the impulses at the start of the next one. */
void dalcs_kept_stretches_add_impulses(struct dalcs_kept_stretches *kept,
                                       const struct dalcs_stretch *stretch, double at);

/* Makes the stretch the k-th of those that were kept; or, true, gives it the impulses that are the k-th. */
bool dalcs_kept_stretches_load(const struct dalcs_kept_stretches *kept, size_t k,
                               struct dalcs_stretch *stretch);

#endif

/* smooth_step_internal.h - the smooth sources of a part, for the files behind smooth_step.h. */
#ifndef DALCS_SMOOTH_STEP_INTERNAL_H
#define DALCS_SMOOTH_STEP_INTERNAL_H

#include "smooth_newton.h"
#include "smooth_step.h"

struct dalcs_smooth_step {
    struct dalcs_smooth_newton newton;
    int n_tangents;   /* of the one-step problem when the steps were factored */
    double slope_h;   /* s, of the step that newton.slope is of; 0: none */
    uint64_t *mode;   /* [n_words] and its mode */
    double *in, *out; /* a step with one value changed */
    double (*dx)[2];  /* [n] changes of arguments; what they are between nodes */
    bool may_have_poles;
    double (*last)[2]; /* [n_smooth] arguments at the end of the segment before */
    double (*most)[2]; /* [n_smooth] the largest of each so far */
};

/* The arguments x[n_smooth][2] of all sources at theta. */
void dalcs_smooth_step_arguments(const struct dalcs_radau_part *part, double theta, double (*x)[2]);

#endif

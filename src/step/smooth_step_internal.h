/* smooth_step_internal.h - the smooth sources of a part, for the files behind smooth_step.h. */
#ifndef DALCS_SMOOTH_STEP_INTERNAL_H
#define DALCS_SMOOTH_STEP_INTERNAL_H

#include "smooth_newton.h"
#include "smooth_step.h"

/* What the polynomials of the sources miss between the nodes, where sources read each other in a ring. */
struct dalcs_smooth_missed {
    double h;       /* s, of the step that the slope is of; 0: none */
    uint64_t *mode; /* [n_words] and its mode */
    double *slope;  /* [n_smooth][2][n_smooth] of arguments there, by what is missed */
    double *matrix; /* [n_smooth][n_smooth] work */
    double *change; /* [n_smooth] work */
    int *pivot;     /* [n_smooth] work */
};

struct dalcs_smooth_step {
    struct dalcs_smooth_newton newton;
    int n_tangents;   /* of the one-step problem when the steps were factored */
    double slope_h;   /* s, of the step that newton.slope is of; 0: none */
    uint64_t *mode;   /* [n_words] and its mode */
    double *drift;    /* [n][n_x] what a change of each value does to the drift of the states */
    double *rounding; /* [n_x] of that drift */
    double *in, *out; /* a step with one value changed */
    double (*dx)[2];  /* [n] changes of arguments; what they are between nodes */
    bool *moved;      /* [n_pairs] has a change of a value made something of lambda or w? */
    bool may_have_poles;
    double (*last)[2]; /* [n_smooth] arguments at the end of the segment before */
    double (*most)[2]; /* [n_smooth] the largest of each so far */
    struct dalcs_smooth_missed missed;
};

/* The value of a source at a node of the present step, or behind the last node what is missed, and its place in what goes
 * into a step. */
double *dalcs_smooth_step_value(const struct dalcs_radau_part *part, int source, int node);
int dalcs_smooth_step_place(const struct dalcs_radau_part *part, int source, int node);

enum dalcs_status dalcs_smooth_missed_setup(struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* Nothing is missed. */
void dalcs_smooth_missed_forget(struct dalcs_radau_part *part);

/* What is missed goes into the step, whose values are those of the functions. */
enum dalcs_status dalcs_smooth_missed_add(struct dalcs_radau_part *part,
                                          struct dalcs_stage_entry **entry) DALCS_MUST_CHECK;

/* The arguments x[n_smooth][2] of all sources at theta. */
void dalcs_smooth_step_arguments(const struct dalcs_radau_part *part, double theta, double (*x)[2]);

#endif

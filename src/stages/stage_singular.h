/* stage_singular.h - what a mode leaves open, and the choice of it.
 *
 * In a mode with currents in loops of diodes, or islands that float between blocking ones, some
 * equations follow from the others and some solutions are 0 on every right-hand side. For a passive
 * circuit the null spaces do not depend on the step: such a solution stores no energy, for y' (sigma P - A) y = 0,
 * so states have no part in it. Each equation that follows gives its row to an equation that makes
 * the choice of least norm (least_norm.h): orthogonal to one of these solutions. */
#ifndef DALCS_STAGE_SINGULAR_H
#define DALCS_STAGE_SINGULAR_H

#include "stage_plan.h"

struct dalcs_stage_singular {
    int n;
    bool within_blocks;         /* rows follow from others of their blocks, whatever they read */
    int *row;                   /* [n] of M, that follow from others */
    double *scale;              /* [n] of these, in the matrix that was balanced with them */
    struct dalcs_csr choice;    /* [n][n_rows] in their place, by columns of M */
    struct dalcs_csr of_column; /* [n_rows][n] the same, turned */
    struct dalcs_csr shore;     /* [n][n_pairs] of it, w of open diodes: these have sources */
};

struct dalcs_stage_entry;

/* g->n is 0 if the mode leaves nothing open. DALCS_SINGULAR: it does, in a way that no choice closes. */
enum dalcs_status dalcs_stage_singular_find(struct dalcs_stage_singular *g,
                                            const struct dalcs_stage_plan *plan,
                                            const struct dalcs_stage_entry *entry) DALCS_MUST_CHECK;

void dalcs_stage_singular_finish(struct dalcs_stage_singular *g);

size_t dalcs_stage_singular_bytes(const struct dalcs_stage_singular *g);

#endif

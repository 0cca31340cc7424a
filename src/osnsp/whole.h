/* whole.h - a mode solved on the equations as they stand, and what it leaves open chosen.
 *
 * With the states eliminated, the currents of strongly coupled coils are differences of voltages over
 * (1 - k) L / h: of a flyback that has run empty, 1e-5 A of amperes. With the states kept, KCL adds up
 * currents, and iterative refinement with residuals in extended precision does the rest.
 *
 * Equations that follow from others (null_space.h) give their place to a choice: of all answers of the mode
 * the one of least norm (least_norm.h), sum G (w - knee)^2 + lambda^2 / G with one conductance G for all pairs. Where resistances are given, each pair is the line w + R lambda = t instead. */
#ifndef DALCS_WHOLE_H
#define DALCS_WHOLE_H

#include "null_space.h"
#include "osnsp.h"
#include "redundant_rows.h"

struct dalcs_whole {
    const struct dalcs_osnsp *p;
    double sigma;
    const double *resistance; /* [n_pairs] ohm; NULL: the pairs are in a mode */
    int n;
    int *place; /* [n_columns] among the unknowns; -1: lambda of an open pair */
    struct dalcs_lu lu;
    int n_choices;
    int *redundant;   /* [n_choices] rows that choices stand in for */
    double *choice;   /* [n_choices][n_columns] coefficients of unknowns */
    double *choice_w; /* [n_choices][n_pairs] of w - knee, which are in `choice` as well */
    bool *moves;      /* [n_columns] is it other than 0 in something that is open? */
    double *residual; /* [n] work */
    struct dalcs_dependencies dependencies; /* of the rows */
    struct dalcs_arena arena;
};

/* Of p->mode at the present sigma, or of lines with these resistances. Valid as long as p is. DALCS_SINGULAR: more is
 * open than there may be iterations of the proximal method, each of which costs as much as a choice, a full row. On
 * failure there is nothing to finish. */
enum dalcs_status dalcs_whole_factor(struct dalcs_whole *whole, const struct dalcs_osnsp *p,
                                     const double *resistance) DALCS_MUST_CHECK;

/* What p->mode leaves open at the present sigma, and which rows follow from others; place[n_columns] becomes that of
 * struct dalcs_whole. On failure there is nothing to finish. */
enum dalcs_status dalcs_whole_null_space(const struct dalcs_osnsp *p, int *place,
                                         struct dalcs_null_space *space) DALCS_MUST_CHECK;

/* y[n_columns] for u; line[n_pairs] has t, NULL for a mode. */
void dalcs_whole_solve(const struct dalcs_whole *whole, const double *u, const double *line,
                       double *y);

/* The same from y on, which keeps what it has chosen: that of a mode where directions below were added to its answer. */
void dalcs_whole_refine(const struct dalcs_whole *whole, const double *u, double *y);

/* Where right-hand sides are rounded, equations that follow from each other contradict each other by that, and the one that is
 * left out misses it. Of two large voltages that cancel it is much of a third that is small: of three phases, one at its zero.
 * Those whose terms are the largest at y, an answer that was evaluated last, are left out from now on. *changed: there is
 * another answer to ask for. */
enum dalcs_status dalcs_whole_leave_largest(struct dalcs_whole *whole, const double *u,
                                            const double *y, bool *changed) DALCS_MUST_CHECK;

/* What choice k leaves open: the answers of the mode that differ from one in this choice alone, into y[n_columns]. */
void dalcs_whole_direction(const struct dalcs_whole *whole, int k, double *y);

size_t dalcs_whole_bytes(const struct dalcs_whole *whole);

void dalcs_whole_finish(struct dalcs_whole *whole);

#endif

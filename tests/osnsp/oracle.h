/* oracle.h - the answer to a one-step problem by trying every mode, with linear programming.
 *
 * In a mode the problem is a set of linear equations and signs: a linear program without objective,
 * written from the system's raw matrices and nothing else of the engine. Modes are tried as a tree,
 * and a branch whose relaxation (0 <= lambda, 0 <= w for the pairs still open) is empty is cut.
 *
 * For a passive circuit whether there is a solution does not depend on the values of R, L and C. By
 * Farkas' lemma there is none iff a direction (v, lambda >= 0) exists along which sources push, with
 * G v = 0: no resistance takes part. So a circuit of wild values is judged by its twin of values 1,
 * where double precision suffices. */
#ifndef DALCS_ORACLE_H
#define DALCS_ORACLE_H

#include "system.h"

#include <stdint.h>

struct oracle_answer {
    bool feasible;
    bool unique; /* every solution has the same y */
    int n_modes; /* modes that have a solution */
    double *y;   /* [n_columns] one solution; free() it */
};

/* The problem of system at sigma, u; closed[n_pairs] tells the switches, diodes are free. */
struct oracle_answer oracle_solve(const struct dalcs_system *system, double sigma, const double *u,
                                  const bool *closed);

/* Do KCL at all nodes and the equations, signs and sides of these elements alone, without a law of any other element,
 * contradict each other? */
bool oracle_contradicts(const struct dalcs_system *system, double sigma, const double *u,
                        const bool *closed, const char *const *element, int n_elements);

#endif

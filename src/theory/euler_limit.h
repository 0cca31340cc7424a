/* euler_limit.h - does implicit Euler converge as h -> 0: propositions 5.2, 5.6 and 5.9 of Brogliato 2022
 * with assumptions 12 and 13. */
#ifndef DALCS_EULER_LIMIT_H
#define DALCS_EULER_LIMIT_H

#include "brogliato.h"

/* The results of the other assumptions, at the step h where they depend on one. */
struct dalcs_limit_given {
    enum dalcs_answer uniform; /* A10 */
    bool contracts;            /* A11 */
    bool blocks, coupled;      /* A6, A7 */
    bool monotone;             /* lemma 4.5: G2 is */
    double strength;           /* least eigenvalue of -R2 At R2^-1; NAN: none */
    const bool *jumps; /* [n_inputs] sources that jump, hence are not Lipschitz; NULL: unknown */
};

enum dalcs_status dalcs_euler_limit_check(struct dalcs_findings *f, const struct dalcs_blocks *b,
                                          double h, const struct dalcs_limit_given *given,
                                          struct dalcs_brogliato *found) DALCS_MUST_CHECK;

#endif

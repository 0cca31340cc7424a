/* brogliato.h - the conditions of Brogliato, SIAM J. Control Optim. 60(4), 2022, on one DALCS. */
#ifndef DALCS_BROGLIATO_H
#define DALCS_BROGLIATO_H

#include "findings.h"

/* The results that the verdicts use. */
struct dalcs_brogliato {
    double h_defined; /* s, assumption 1: below it P_I - h A_I is regular; may be INFINITY */
    bool step_unique; /* corollary 4.6 item 3, or propositions 4.4, 4.8 item 3, for this h */
    enum dalcs_answer converges_52; /* proposition 5.2; depends: between jumps of a source */
    enum dalcs_answer converges_59;
    const char *jumping; /* such a source, or NULL */
};

/* Conditions 1 to 13 with the propositions that rest on them, for the step h in s. jumps[n_inputs]
 * are the sources that jump; NULL: not known. */
enum dalcs_status dalcs_brogliato_check(struct dalcs_findings *f, const struct dalcs_blocks *b,
                                        double h, const bool *jumps,
                                        struct dalcs_brogliato *found) DALCS_MUST_CHECK;

#endif

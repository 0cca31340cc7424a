/* lu_patterns.h - the analyses of the patterns that were factored last.
 *
 * What KLU finds out of a pattern alone takes as long as the factors. The modes that a search tries come back with other
 * step lengths, a few at a time. */
#ifndef DALCS_LU_PATTERNS_H
#define DALCS_LU_PATTERNS_H

#include "lu.h"

/* An answer of an ideal inverter tries some five modes, with and without weights: with 4 half of the patterns are there
 * again, with 8 two thirds, with 64 no more than that. */
enum { DALCS_LU_PATTERNS = 8 };

/* Between the variants of a circuit those of one whole run are kept, which are up to some thirty. */
enum { DALCS_LU_PATTERNS_OF_RUNS = 64 };

/* All 0: none. */
struct dalcs_lu_patterns {
    int n;
    int most; /* that are kept; 0: DALCS_LU_PATTERNS; of more also a bound on their entries */

    struct dalcs_lu_pattern {
        int n;
        bool keeps_diagonal;
        int *p; /* [n + 1], behind it i[p[n]] */
        klu_symbolic *symbolic;
    } * known; /* [most] the latest first; NULL: there was none yet */
};

/* dalcs_lu_factor() by an analysis that is there, or that is kept. */
enum dalcs_status dalcs_lu_factor_again(struct dalcs_lu *lu, struct dalcs_lu_patterns *patterns,
                                        klu_common *common, const struct dalcs_columns *a,
                                        double rcond_min) DALCS_MUST_CHECK;

void dalcs_lu_patterns_finish(struct dalcs_lu_patterns *patterns, klu_common *common);

#endif

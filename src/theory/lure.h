/* lure.h - the conditions of the papers on multivalued Lur'e systems and sweeping processes on the LCS, with
 * their misprints put right (doc/check.md lists them). */
#ifndef DALCS_LURE_H
#define DALCS_LURE_H

#include "cones.h"
#include "findings.h"
#include "modes.h"
#include "passivity.h"

struct dalcs_lure {
    bool D_is_zero, D_is_semidefinite, D_is_definite, D_is_P;
    bool is_coupled;       /* P B = C' */
    bool is_block_coupled; /* D = diag(D1, 0), D1 a P-matrix, P2 B2 = C2' */
    bool is_dissipative;   /* with `metric` */
    bool by_energy;        /* metric is the stored energy */
    struct dalcs_matrix metric;
    bool is_refuted;                /* no P > 0 at all makes it passive */
    struct dalcs_matrix refutation; /* the Z of storage.h */
    const char *open;               /* why neither, when neither */

    struct {
        double value; /* 1/s: differences of motions fall as exp(-value t) in the metric */
        struct dalcs_matrix metric;
        const char *open; /* what is known of other P where it is 0 */
    } rate;

    int lossless;         /* dimension of what never dissipates; -1: not known */
    double omega;         /* 1/s: 1/2 lambda_max(PA + A'P, P) */
    bool can_shift;       /* sources beside C x are C times something */
    int n_kernel;         /* dimension of what multipliers may change without a trace */
    bool *in_kernel;      /* [m] */
    bool value_is_unique; /* B lambda is, by proposition 3 (corrected) */
};

/* `cones` may be unsolved. What is kept is in f's arenas. */
enum dalcs_status dalcs_lure_check(struct dalcs_findings *f, const struct dalcs_lcs *lcs,
                                   const struct dalcs_cones *cones,
                                   struct dalcs_lure *found) DALCS_MUST_CHECK;

/* P as a witness over the names of the states, Z over states and multipliers; larger ones are left
 * out. */
enum dalcs_status dalcs_lure_refutation_witness(struct dalcs_findings *f,
                                                const struct dalcs_lcs *lcs,
                                                const struct dalcs_matrix *Z,
                                                bool of_verdict) DALCS_MUST_CHECK;
enum dalcs_status dalcs_lure_metric_witness(struct dalcs_findings *f, const struct dalcs_lcs *lcs,
                                            const struct dalcs_matrix *P,
                                            bool of_verdict) DALCS_MUST_CHECK;

#endif

/* audit_measures.h - .meas and .four, looked on by the auditor: what each stretch adds to them, and what is told of them. */
#ifndef DALCS_AUDIT_MEASURES_H
#define DALCS_AUDIT_MEASURES_H

#include "audit_run.h"
#include "measuring.h"

/* Zero-initialise. */
struct dalcs_audit_measures {
    struct dalcs_audit_run *run; /* NULL: no audit */
    struct dalcs_measuring_watch watch;

    struct audit_item {
        bool reads;      /* its signals can be read by the auditor */
        bool was_looked; /* at what a stretch added to it, at least once */
        bool looks;      /* at this one */
        double told[2];  /* s, of its instants, those that are known */
        int side[2];     /* of its levels where it was asked last: -1, 1, 0 unknown */
        int n_then[2];   /* counted when it was */
        int n_now[2];    /* counted in front of the stretch */
    } * item;            /* [n_measures] */

    struct dalcs_measured *before; /* [n_measures] in front of the stretch */

    struct audit_line {
        bool reads, was_looked, looks;
        int line; /* that is looked at */
        double cosine, sine;
    } * line; /* [n_fouriers] */

    long n_stretches;
    int drawn;                /* the measurement that is asked at one time in this stretch */
    double credit, threshold; /* instructions */
};

enum dalcs_status dalcs_audit_measures_start(struct dalcs_audit_measures *a,
                                             struct dalcs_audit_run *run,
                                             struct dalcs_measuring *m) DALCS_MUST_CHECK;
void dalcs_audit_measures_finish(struct dalcs_audit_measures *a);

/* What is told of measurement k, and of a .four. */
void dalcs_audit_measures_told(struct dalcs_audit_measures *a, const struct dalcs_measuring *m,
                               int k, const struct dalcs_measurement *told);
void dalcs_audit_fourier_told(struct dalcs_audit_measures *a, const struct dalcs_measuring *m,
                              int k, const struct dalcs_fourier *told);

#endif

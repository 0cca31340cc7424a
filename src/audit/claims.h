/* claims.h - are numbers that are made of a waveform those of this waveform? Integrals, values, slopes, times at which a
 * level is passed, each claimed by others and checked by the auditor at instants of its own.
 *
 * What is claimed is a function of signals over some time. The auditor reads the signals as it reads states; what two ways
 * to a value may differ by through rounding is the function's doubt. */
#ifndef DALCS_AUDIT_CLAIMS_H
#define DALCS_AUDIT_CLAIMS_H

#include "audit.h"

struct dalcs_audit_function {
    void *user;
    /* At t; *doubt, if that is not NULL: what rounding may make of it. NAN: it has no value. */
    double (*value)(void *user, double t, double *doubt);
};

/* Whose number is claimed, and what it is over. */
struct dalcs_audit_number {
    enum dalcs_audit_law law;
    int index;
    double scale; /* the largest value of the function that anybody has seen */
};

/* Signal `index` of the circuit's at t, as the limit from side; *doubt as above. Only of a
 * part that can be read at t. */
double dalcs_audit_signal(struct dalcs_audit *audit, int index, double t, enum dalcs_side side,
                          double *doubt);

/* What it is held to; 0: nobody knows. */
double dalcs_audit_signal_scale(const struct dalcs_audit *audit, int index);

/* What was asked for may be another value from now on. */
void dalcs_audit_forget_asked(struct dalcs_audit *audit);

/* A formula of measured signals, likewise. */
double dalcs_audit_formula(struct dalcs_audit *audit, const struct dalcs_signal_formula *formula,
                           double t, enum dalcs_side side, const double *result, double *doubt);

/* The part that a signal is read from; -1: none, as the current of a capacitor, which is a derivative. */
int dalcs_audit_part_of(const struct dalcs_audit *audit, int signal);

struct dalcs_audit_sum {
    double value, doubt; /* what it may be off by; INFINITY: by anything */
};

/* The integral of f^power between two times. */
struct dalcs_audit_sum dalcs_audit_integral(const struct dalcs_audit *audit,
                                            const struct dalcs_audit_function *f, int power,
                                            double from, double to);

/* What such an integral is claimed to be. */
struct dalcs_audit_claim {
    int power;
    double from, to;
    double value;
};

void dalcs_audit_claim_integral(struct dalcs_audit *audit, const struct dalcs_audit_number *number,
                                const struct dalcs_audit_claim *claim,
                                const struct dalcs_audit_sum *own);

/* The same of what has several functions: off over the scale of each. */
void dalcs_audit_claim_part(struct dalcs_audit *audit, const struct dalcs_audit_number *number,
                            const struct dalcs_audit_claim *claim,
                            const struct dalcs_audit_sum *own);

/* A finding over its scale. */
void dalcs_audit_add_to(struct dalcs_audit *audit, enum dalcs_audit_law law, int index,
                        double defect, double t);

/* Claimed: the value at t; the slope at t, between two times. */
void dalcs_audit_claim_value(struct dalcs_audit *audit, const struct dalcs_audit_number *number,
                             const struct dalcs_audit_function *f, double t, double claimed);
void dalcs_audit_claim_slope(struct dalcs_audit *audit, const struct dalcs_audit_number *number,
                             const struct dalcs_audit_function *f, double t, double from, double to,
                             double claimed);

/* Claimed: at t, between two times, f passes 0, way > 0 upwards, < 0 downwards, 0 either. */
void dalcs_audit_claim_crossing(struct dalcs_audit *audit, const struct dalcs_audit_number *number,
                                const struct dalcs_audit_function *f, double t, double from,
                                double to, int way);

/* So far off, in the unit of the number's scale. */
void dalcs_audit_off(struct dalcs_audit *audit, const struct dalcs_audit_number *number, double off,
                     double t);

#endif

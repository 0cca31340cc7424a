/* audit_measures_asked.h - a formula that the audit of measurements asks for values. Private to this folder. */
#ifndef DALCS_AUDIT_MEASURES_ASKED_H
#define DALCS_AUDIT_MEASURES_ASKED_H

#include "audit_measures.h"

/* Instructions, about, of a value of a formula from a state. */
#define AUDIT_STATE_WORK 2500.0

struct audit_asked {
    struct dalcs_audit_measures *a;
    const struct dalcs_measuring *m;
    const struct dalcs_signal_formula *formula;
    bool reads;   /* from states, else from the stretch */
    double scale; /* of the formula */
    /* times this, of .four: a cosine or a sine from `since` on */
    double omega, since;
    bool is_sine;
};

/* The value at a time, for sums; *doubt: how far it may be off. */
double audit_asked_value(void *user, double t, double *doubt);

/* Can the auditor read all signals of a formula while segments are there? */
bool audit_measures_reads_all(const struct dalcs_audit_run *run,
                              const struct dalcs_signal_formula *formula);

/* A formula as this stretch has it. */
struct audit_asked audit_measures_ask(struct dalcs_audit_measures *a,
                                      const struct dalcs_measuring *m,
                                      const struct dalcs_signal_formula *formula, bool reads,
                                      double scale);

/* Its number among the measurements. */
struct dalcs_audit_number audit_measures_number(int k, double scale);

/* The window of the card within the stretch; false: empty. */
bool audit_measures_find_window(const struct dalcs_measuring *m, const struct dalcs_measured *item,
                                double *from, double *to);

/* Is the measurement of the analysis that runs? */
bool audit_measures_is_of(const struct dalcs_measuring *m, const struct dalcs_measured *item);

/* Is all checked? */
bool audit_measures_is_full(const struct dalcs_audit_measures *a);

/* What this stretch has added to measurement k, or the extreme or value that it says it has. */
void audit_measures_check_item(struct dalcs_audit_measures *a, const struct dalcs_measuring *m,
                               int k);

/* The instants that it says it has found in this stretch. */
void audit_measures_check_instants(struct dalcs_audit_measures *a, const struct dalcs_measuring *m,
                                   int k);

/* At one time of the stretch: is a value beyond its extreme, or has a level been passed that was not counted? */
void audit_measures_ask_once(struct dalcs_audit_measures *a, const struct dalcs_measuring *m,
                             int k);

/* What this stretch has added to harmonic k of a .four. */
void audit_measures_check_line(struct dalcs_audit_measures *a, const struct dalcs_measuring *m,
                               int k);

#endif

/* check.h - what theory says of a circuit before it runs. Part of dalcs.h, which includes it. */
#ifndef LIBDALCS_CHECK_H
#define LIBDALCS_CHECK_H

#ifndef DALCS_H
#error "include dalcs.h"
#endif

/* What theory says of a circuit before it runs. Everything here is borrowed from the session and
 * lives until its next check. */
enum dalcs_answer {
    DALCS_NO,
    DALCS_YES,
    DALCS_CONDITIONAL, /* it depends on what the sentence says */
    DALCS_UNDECIDED,   /* no condition tried decides it */
    DALCS_NOT_CHECKED  /* too large, or a solver is missing: the sentence says which */
};

/* "no", "yes", "depends", "undecided", "not checked" */
const char *dalcs_answer_text(enum dalcs_answer answer);

/* Numbers that prove a claim, for whoever wants to compute it again. */
struct dalcs_evidence {
    const char *kind; /* "P", "X", "point", "multipliers", "mode", "eigenvector", "motion",
                         "minor", "kernel", "powers" */
    size_t n_entries;

    const struct dalcs_evidence_entry {
        const char *name; /* "v(c1)", "i(d1)", "d1", "sigma" */
        double re, im;
    } * entry;

    size_t n_rows, n_columns; /* of a matrix, else 0 */
    const char *const *row;   /* [n_rows] */
    const char *const *column;
    const double *value; /* [n_rows * n_columns] by rows */
};

/* One condition of a theorem. */
struct dalcs_condition {
    const char *id;     /* "A9" */
    const char *source; /* "Brogliato 2022, assumption 9" */
    const char *text;   /* the condition */
    enum dalcs_answer holds;
    const char *because; /* the numbers, or what was not checked; or NULL */
    size_t n_witnesses;
    const struct dalcs_evidence *witness;
};

/* The answer to a question of an engineer. */
struct dalcs_verdict {
    const char *question; /* "exists", "unique", "multipliers", "jumps", "step", "convergence",
                             "stable", "contracting", "periodic", "passive" */
    enum dalcs_answer answer;
    const char *sentence; /* without a full stop */
    const char *source;
    double value; /* a bound on the step in s, a rate in 1/s; NAN: none */
    size_t n_elements;
    const char *const *element; /* sources that jump, elements that give energy, diodes of a mode */
    size_t n_witnesses;
    const struct dalcs_evidence *witness;
};

/* A part of the circuit that shares only ground with the rest. */
struct dalcs_checked_part {
    size_t n_equal;      /* parts that are exactly like it, itself included */
    const char *element; /* one of its elements */
    int states, algebraic, diodes, switches;
    const char *summary; /* plain words, several sentences */
    size_t n_verdicts;
    const struct dalcs_verdict *verdict;
    size_t n_conditions;
    const struct dalcs_condition *condition;
};

struct dalcs_check {
    const char *netlist, *title;
    double step; /* s, of the conditions on one step */
    size_t n_parts;
    const struct dalcs_checked_part *part;
};

/* Checks the netlist that was read, without running it. step is the h of the conditions that speak of
 * one step, in s; 0: .options step, else the tmax or tstep of .tran, else 1e-6. */
enum dalcs_status dalcs_session_check(struct dalcs_session *session, double step,
                                      const struct dalcs_check **check) DALCS_MUST_CHECK;

#endif

/* table_audit.h - waveforms that anybody made against the laws of a netlist. Part of dalcs.h, which includes it. */
#ifndef LIBDALCS_TABLE_AUDIT_H
#define LIBDALCS_TABLE_AUDIT_H

#ifndef DALCS_H
#error "include dalcs.h"
#endif

/* Waveforms that anybody made, of a .tran: the time in s is column 0. One row at time 0 is an operating point.
 * Borrowed during a call. */
struct dalcs_wave_table {
    size_t n_columns, n_rows;
    const char *const
        *name; /* [n_columns] "time", "V(out)", "i(d1)", "v1#branch", "@r1[i]", "I(x1:D1)" */
    const double *
        value; /* [n_rows * n_columns] row after row, no time before the one above; NAN: not known */
    const double *relative,
        *absolute; /* [n_columns] by its digits x may be off by relative |x| + absolute */
};

struct dalcs_table_audit_options {
    double tolerance; /* over the largest value of a signal; 0: 1e-3, the reltol of SPICE */
    size_t run;       /* of .step: its number, from 0; the circuit has its values */
};

/* A law of an element or node, where it is broken most. */
struct dalcs_table_law {
    const char *law;        /* "KCL", "BRANCH", "CURRENT", "POSITION" */
    const char *where;      /* "out", "d1" */
    const char *unit;       /* of the next two: "V", "A", "C", "Wb", "J" */
    double defect, allowed; /* broken where the first is larger */
    double from, to;        /* s; the same where it is about one time */
    double since;           /* s, broken for the first time */
    double
        sees; /* of coils and capacitors: an element that is off by more than this part of its value
                    would have been noticed; INFINITY: nothing moved. Of others 0 */
    size_t n_checked, n_broken;
};

/* A law that could not be checked. */
struct dalcs_table_gap {
    const char *law, *where;
    const char *because; /* "v(a), i(d1) are not in the file" */
};

struct dalcs_table_audit {
    const char *netlist, *title;
    double tolerance, from, to; /* s */
    size_t n_rows, n_used;      /* signals of the circuit among the columns */
    size_t n_laws, n_broken;
    const struct dalcs_table_law *law; /* [n_laws] the worst over what is allowed first */
    size_t n_gaps;
    const struct dalcs_table_gap *gap;
    size_t n_foreign;
    const char *const *foreign; /* columns that are nothing of the circuit */
};

/* Which laws of the netlist's elements does the table break, and by how much (doc/audit.md)? Needs no run.
 * The answer lives until the session's next one. DALCS_E_OPTION: the table is not one of this circuit; a
 * message says why. */
enum dalcs_status
dalcs_session_audit_table(struct dalcs_session *session, const struct dalcs_wave_table *table,
                          const struct dalcs_table_audit_options *options,
                          const struct dalcs_table_audit **audit) DALCS_MUST_CHECK;

#endif

/* file_internal.h - what the files about tables of waveforms, src/audit/file_*.c, share.
 *
 * A table is no waveform: it may lack signals, has so many digits, and is silent between its rows. So every
 * quantity here is a number with an error, or not known. The error is what digits leave open; what a simulator
 * may be off by besides, the tolerance over the largest value, is added where a law is judged. Laws of one
 * time are asked at rows, where lines play no part; integrals are taken by trapezoids, whose own error is
 * estimated from how the slope changes (file_windows.c). */
#ifndef DALCS_FILE_INTERNAL_H
#define DALCS_FILE_INTERNAL_H

#include "audit.h"
#include "file_audit.h"

#include <math.h>

struct file_number {
    double value, error;
    bool known;
};

static inline struct file_number file_add(struct file_number a, double factor,
                                          struct file_number b) {
    return (struct file_number){a.value + factor * b.value, a.error + fabs(factor) * b.error,
                                a.known && b.known};
}

static inline struct file_number file_exactly(double value) {
    return (struct file_number){.value = value, .known = true};
}

enum { FILE_OPEN = 1, FILE_CLOSED = 2 }; /* positions that a switch may have */

/* All of the circuit at one row. */
struct file_row {
    size_t index;
    double t, t_error;      /* s */
    bool is_behind;         /* at the time of the row above */
    bool is_left, is_right; /* of two rows at one time */
    struct file_number *v;  /* [n_nodes] */
    struct file_number *u;  /* [n_devices] across each */
    struct file_number *i;  /* [n_devices] through each */
    bool *is_assumed;       /* [n_devices] its current is what its own law makes of u */
    unsigned char
        *position;  /* [n_devices] of switches: what they may be in, by control and history */
    bool *is_spent; /* [n_nodes] its KCL gave a current */
};

/* How a potential is found: v[node] = v[base] + sign * column. */
struct file_potential {
    int node, base;
    double sign;
    size_t column;
};

struct file_worst {
    double ratio, defect, allowed, from, to, since;
    double sees; /* of coils and capacitors */
    const char *unit;
    size_t n_checked, n_broken;
    int other, n_nodes; /* of KCL: another node of the set, and how many there are */
};

/* Sums since a law was begun to be followed; each window is a difference of two of them. */
enum { FILE_LEVELS = 26 };

struct file_window {
    size_t n;                /* intervals */
    unsigned long signature; /* of what is summed */

    struct file_window_sum {
        double residual, error, time, moved; /* the last: what was stored more */
        double end;                          /* error of what is stored there */
    } now, at[FILE_LEVELS];
};

/* The law of a set of nodes over a window: what its capacitors may be off by at the ends, and its currents on
 * the way. */
struct file_set_law {
    double ends, rate, end_error;
    unsigned long signature; /* of the nodes */
    bool has_charge;
};

/* Laws that a file can be asked for: those before what a run makes of its waveform. */
enum { FILE_LAWS = DALCS_AUDIT_ENERGY + 1 };

struct file_audit {
    const struct dalcs_circuit *circuit;
    const struct dalcs_wave_table *table;
    struct dalcs_file_promise promise;
    bool is_at_rest; /* an operating point: no charge and no flux changes */
    bool
        is_before; /* ... the one that a .tran begins at, where sources may have other values than DC */
    double ramp; /* s; a jump of a source may take so long in the file */

    struct {
        int *of;       /* [n_nodes] shorts taken together */
        int *fed_from; /* [n_nodes] likewise, V sources too: what differs by sources alone */
        int *first_branch, *branch; /* devices at each node, no shorts and loops */
    } nodes;

    struct file_columns {
        int n_potentials;
        struct file_potential *potential; /* in an order in which each base comes before */
        int *potential_of;                /* [n_nodes] or -1 */
        long *current;                    /* [n_devices] or -1 */
        int *
            given_by; /* [n_nodes] an E or formula that puts its voltage out where no column has it, or -1 */
        int n_given, *given; /* these */
        bool *is_used;       /* [n_columns] */
    } columns;

    struct file_scales {
        double *u, *i;         /* [n_devices] largest values */
        double *v;             /* [n_nodes] */
        double volts, amperes; /* the largest of all */
        double vouched[2];     /* V, A: what the other unit vouches for */
    } scale;

    struct file_coverage {
        bool *ever_known, *ever_seen; /* [n_devices] its current, at some row; and not by its law */
        bool *ever_given;             /* [n_nodes] its voltage, by a formula */
        bool *is_covered;             /* [n_nodes] its KCL was asked, or gave a current */
        bool *is_checked;             /* [n_nodes] of sets, now */
    } coverage;

    struct file_row row[4];

    struct file_formulas { /* work */
        double *value, *error;
        int most_pairs;
    } formulas;

    struct file_sets { /* of nodes, [n_nodes] each: work of file_kirchhoff.c */
        int *count, *stack, *cluster;
        bool *has_unspent;
        struct file_number *sum;
        double *largest;          /* A, of what is summed */
        struct file_set_law *law; /* work of file_storage.c */
    } sets;

    struct file_gates {     /* work of file_gates.c */
        unsigned char *bit; /* [n_gates] */
        int *source;        /* [n_stimuli] the V source that each drives; -1: none */
    } gates;

    struct file_charges {           /* over one interval, [n_devices] */
        struct file_number *charge; /* C */
        bool *is_taken;             /* by a capacitor whose current is not known then */
    } charges;

    struct file_worst *worst[FILE_LAWS];

    struct file_windows {
        struct file_window *of_device, *of_node; /* coils and capacitors; sets of nodes */
    } window;

    struct dalcs_arena arena;
};

/* ---- file_names.c ---- */

/* Finds columns of nodes and devices; DALCS_E_OPTION where no potential is found. */
enum dalcs_status file_find_columns(struct file_audit *a, struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* ---- file_tangents.c ---- */

/* Lines of exponential diodes where the table has their currents; a->circuit may be another one after it. */
enum dalcs_status file_take_tangents(struct file_audit *a) DALCS_MUST_CHECK;

/* ---- file_values.c ---- */

/* Is row k at the time of the row above it? Closer than a time of an edge is known (stimulus.h) is the same. */
static inline bool file_is_behind(const struct dalcs_wave_table *table, size_t k) {
    if (k == 0 || k >= table->n_rows) {
        return false;
    }
    const double now = table->value[k * table->n_columns];
    return now - table->value[(k - 1) * table->n_columns] <= 4.0 * 0x1p-52 * now;
}

/* What the table tells of row k, after `before`, the row above; NULL: the first. */
void file_evaluate(struct file_audit *a, size_t k, struct file_row *row,
                   const struct file_row *before);

/* One number of the table; the potential of a node at any row of it. */
struct file_number file_cell(const struct file_audit *a, size_t row, size_t column);
struct file_number file_potential_at(const struct file_audit *a, size_t row, int node);

/* What a source has at a row: all that it has as far as the time is known. */
/* Of an operating point, which file.c's columns have: is it that of the .tran? */
bool file_rests_before(const struct file_audit *a);

struct file_number file_stimulus(const struct file_audit *a, const struct file_row *row,
                                 int stimulus);

/* The current of a diode that blocks and of a switch that is open, by its line; not known where it conducts. */
struct file_number file_blocked(const struct file_audit *a, const struct file_row *row, int device);

/* What u and i of a device may be off by besides. */
double file_volts(const struct file_audit *a, int device);
double file_amperes(const struct file_audit *a, int device);

/* ---- file_formula.c ---- */

/* The output of a device with a behaviour. */
struct file_number file_formula(struct file_audit *a, const struct file_row *row, int device);

/* The same of any E or G, and for a node that no column has: what the tolerance makes of it is in its error. */
struct file_number file_output(struct file_audit *a, const struct file_row *row, int device);
struct file_number file_formula_given(struct file_audit *a, const struct file_row *row, int device);

/* Is the voltage of its first node this device's own output? */
static inline bool file_is_given(const struct file_audit *a, int device) {
    return a->columns.given_by[a->circuit->device[device].node[0]] == device;
}

/* Finds them, when the columns are known. */
void file_find_given(struct file_audit *a);

/* The voltages that they give at a row, as far as what they read is known. */
void file_take_given(struct file_audit *a, struct file_row *row);

/* ---- file_kirchhoff.c ---- */

/* Currents that KCL gives where only one at a node is not known. */
void file_peel(struct file_audit *a, struct file_row *row);
void file_check_nodes(struct file_audit *a, const struct file_row *row);

/* Sets of nodes that branches without a flow hang together, by their first node: a->sets.cluster. */
void file_cluster(struct file_audit *a, const struct file_number *flow);

/* What flows out of each set, and what its currents are held to: a->sets.sum, a->sets.largest. */
void file_sum_sets(struct file_audit *a, const struct file_number *flow);

/* How many nodes are in each set, one of them beside the first, and is there one whose law gave no current?
 * a->sets.count, a->sets.stack, a->sets.has_unspent; row may be NULL. */
void file_describe_sets(struct file_audit *a, const struct file_row *row);

/* Its nodes need not be told to be missing: those of sets with a->coverage.is_checked. */
void file_note_covered(struct file_audit *a);

/* A defect of a set that was described. */
void file_find_set(struct file_audit *a, int set, const char *unit, double defect, double allowed,
                   double from, double to);

/* ---- file_islands.c: parts that only sources feed, at rest ---- */
void file_check_islands(struct file_audit *a, const struct file_row *row);

/* ---- file_branches.c, file_switches.c ---- */

void file_check_branches(struct file_audit *a, const struct file_row *row);
void file_check_diode(struct file_audit *a, const struct file_row *row, int device);
void file_check_switch(struct file_audit *a, const struct file_row *row, int device);

/* Which positions it may have at a row, by control and history. */
unsigned char file_position(const struct file_audit *a, const struct file_row *row,
                            const struct file_row *before, int device);

/* ---- file_gates.c ---- */

/* At rest. */
void file_check_gates(struct file_audit *a, const struct file_row *row);

/* ---- file_windows.c ---- */

/* The integral from row[1] to row[2] of what x[k] is at row[k]; 0 and 3 may be NULL. */
struct file_number file_trapezoid(struct file_row *const row[4], const struct file_number x[4]);

struct file_window_law {
    enum dalcs_audit_law law;
    int index;
    const char *unit;
    double end_tolerance, rate_tolerance; /* C and A, or Wb and V */
};

/* Goes on by an interval; `end` is the error of what is stored at its end. */
void file_window_begin(struct file_window *w, double end);
void file_window_add(struct file_audit *a, struct file_window *w, const struct file_window_law *law,
                     struct file_number residual, double moved, double duration, double end,
                     double to);

/* ---- file_storage.c ---- */

/* The charge or flux of an element at a row, and the law that windows of it are held to. */
struct file_number file_stored(const struct file_audit *a, const struct file_row *row, int device);
struct file_window_law file_law_of(const struct file_audit *a, int device);

/* Charge and flux over an interval, from row[1] to row[2]; row[0] and row[3] may be NULL. */
void file_check_interval(struct file_audit *a, struct file_row *const row[4]);

/* ---- file_jumps.c ---- */

void file_check_jump(struct file_audit *a, const struct file_row *left,
                     const struct file_row *right);

/* The first row against initial conditions; before: room for a row. */
void file_check_start(struct file_audit *a, const struct file_row *first, struct file_row *before);

/* ---- file_report.c ---- */

enum dalcs_status file_report(struct file_audit *a, struct dalcs_arena *arena,
                              struct dalcs_table_audit *result) DALCS_MUST_CHECK;

/* ---- file_audit.c ---- */

/* A defect of a law: broken where it is more than what is allowed. Is it the worst so far? */
bool file_find(struct file_audit *a, enum dalcs_audit_law law, int index, const char *unit,
               double defect, double allowed, double from, double to);

#endif

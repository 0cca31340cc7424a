/* system.h - one DALCS: the semi-explicit differential-algebraic linear complementarity system
 *
 *     P_I x' = A_I  x + B_I  z + Bbar_I  lambda + E_I(t)
 *          0 = A_II x + B_II z + Bbar_II lambda + E_II(t)
 *          w = C_I  x + C_II z + D       lambda + F(t),     0 <= lambda _|_ w >= 0
 *
 * of Brogliato, SIAM J. Control Optim. 60(4), 2022, eq. (2.1). The engine has no other input; a netlist
 * is one way to make one.
 *
 * The columns are numbered x, then z, then lambda, and the blocks are kept side by side:
 *     A = [A_I B_I Bbar_I; A_II B_II Bbar_II],   C = [C_I C_II D],
 * so a row of the system is a row of one matrix. Sources are linear in the inputs s(t), of which
 * the first is the constant 1: (E_I; E_II) = E s(t), F = F s(t).
 *
 * A pair (lambda, w) is a complementarity (diode) or a commanded two-state element (ideal switch:
 * closed w = 0, open lambda = 0, no signs). The set of pairs with w = 0 is the mode. */
#ifndef DALCS_SYSTEM_H
#define DALCS_SYSTEM_H

#include "smooth.h"
#include "sparse.h"

#include <stdint.h>

enum dalcs_pair_kind { DALCS_PAIR_DIODE, DALCS_PAIR_SWITCH };

/* A labelled column or row. `element` is a name of the netlist: an element or, for voltages and
 * KCL, a node. */
struct dalcs_label {
    const char *element;

    enum dalcs_label_kind {
        DALCS_LABEL_STATE,    /* column: capacitor voltage or inductor current; row: its branch */
        DALCS_LABEL_NODE,     /* column: node voltage; row: KCL at the node */
        DALCS_LABEL_BRANCH,   /* column: branch current; row: branch equation */
        DALCS_LABEL_REFERENCE /* column: current into the reference of a floating island, must be
                                 zero; row: voltage of the reference node */
    } kind;
};

/* What an equation of this kind is: "KCL at" a node, "branch" of an element. */
const char *dalcs_label_equation(enum dalcs_label_kind kind);

struct dalcs_pair {
    enum dalcs_pair_kind kind;
    int valve; /* switches that have one: the pair of a diode in series whose current keeps them closed */
    const char *element; /* "d1", "s1" */
    bool is_breakdown;   /* the reverse branch of a diode with Vrev */
    bool is_formula;     /* a kink or a jump of a source: its lambda carries no charge */
    bool
        is_jump; /* the first of two of a jump, whose argument is lambda of the next one less w of this one */
    bool is_left_out[2];      /* while it is open, while it is closed: of a choice of least norm */
    bool initially_on;        /* switches */
    bool is_direct;           /* switches: use direct_control, known before the step is solved */
    bool has_valve;           /* switches */
    double turn_on, turn_off; /* switches: control thresholds vt + vh and vt - vh, V or A */
};

/* A switch with hysteresis. */
static inline bool dalcs_pair_remembers(const struct dalcs_pair *p) {
    return p->turn_off < p->turn_on;
}

/* A source whose voltage or current is a smooth function f of columns. It stands in the equations as an input, whose
 * value whoever solves them makes agree with what it reads, beside a line g x, for where such a source conducts the
 * equations are to know (smooth_newton.h). */
struct dalcs_smooth_input {
    int input, row; /* the one equation that the input is in */
    enum dalcs_smooth_kind kind;
    int n;
    int column[2];    /* of its arguments; -1: a number */
    double number[2]; /* that number */
    int row_of[2]; /* the equation that gives an argument which is not read elsewhere; -1: none */
    bool starts_on_line; /* no other equation fixes its argument */
    double start[2];     /* then its arguments where it begins, on that branch of its law */
    double *entry
        [2]; /* in A, of -g: the equations have g x, the input is the rest of the function. 0 but while a problem
                         is being solved. NULL: none */
    const char *element;
};

struct dalcs_system {
    int n_x, n_z, n_pairs, n_inputs;
    int n_smooth;
    struct dalcs_smooth_input *smooth; /* [n_smooth] NULL: none */
    bool
        *is_part; /* [n_columns] the value of a part of a formula, in no unit; NULL: no column is */
    struct dalcs_csr P;       /* [n_x][n_x], nonsingular */
    struct dalcs_csr A;       /* [n_x + n_z][n_columns], rows I then rows II */
    struct dalcs_csr E;       /* [n_x + n_z][n_inputs] */
    struct dalcs_csr C;       /* [n_pairs][n_columns] */
    struct dalcs_csr F;       /* [n_pairs][n_inputs] */
    struct dalcs_csr storage; /* [n_x][n_x] symmetric: the stored energy is 1/2 x' storage x */
    struct dalcs_csr
        control; /* [n_pairs][n_columns] controlling voltage or current of a switch; else
                                 empty */
    struct dalcs_csr direct_control; /* [n_pairs][n_inputs] the same as a sum of sources, where V
                                        sources alone fix it */

    struct dalcs_csr
        reads; /* [n_equations + n_pairs][n_columns] entries of A and C that are not 0 by which a
                               controlled source, a formula or a negative resistor reads a column;
                               what is left of the rows is of a passive circuit. Empty (p is NULL)
                               where that is not known, as of a system file. The values have no meaning */
    const char **reader; /* [entries of reads] the element */

    /* dual[row] is the column that a row is paired with, so that with rows in this order the matrix
     * of (sigma P - A, C) has a positive semidefinite symmetric part when the circuit is passive:
     * KCL with its node's voltage, a branch equation with its current. A permutation of the x and z
     * columns. */
    int *dual;               /* [n_x + n_z] */
    int *forest_root;        /* [n_x + n_z] of a node's voltage in a capacitor tree: the column of
                                the root's, whose row sums the KCL of the tree; else itself */
    bool *column_is_current; /* [n_columns] unit A, else V */
    bool *row_is_current;    /* [n_x + n_z] unit of the row's equation */
    struct dalcs_label *row; /* [n_x + n_z] */
    struct dalcs_label *column; /* [n_x + n_z] */
    struct dalcs_pair *pair;    /* [n_pairs] */
    int *stimulus;              /* [n_inputs] index in the circuit; -1 for the constant 1 */
    const char **input_element; /* [n_inputs] name of the source; NULL for the constant 1 */

    /* What rounding has left of A's sums of conductances: with it, KCL of what is cut off from ground adds up to 0.
     * Empty (p is NULL) where that is not known. */
    struct dalcs_csr A_rest;

    bool monotone; /* R, L, C, K, independent sources, diodes and switches only, all
                                   passive: the OSNSP is solvable iff feasible */
};

/* Is this pair's bit set in mode[(n_pairs + 63) / 64]? */
static inline bool dalcs_mode_has(const uint64_t *mode, int pair) {
    return (mode[pair / 64] >> (pair % 64) & 1) != 0;
}

/* The control below which a closed switch opens. What keeps one with a valve closed in its hysteresis is the
 * current of that. While the valve blocks, the switch is closed above the upper threshold alone. */
static inline double dalcs_switch_opens_at(const struct dalcs_system *s, const uint64_t *mode,
                                           int pair) {
    const struct dalcs_pair *p = &s->pair[pair];
    return p->has_valve && !dalcs_mode_has(mode, p->valve) ? p->turn_on : p->turn_off;
}

/* Is a switch that stood there closed at this control? Without hysteresis it is above its threshold alone, with it
 * between both as it was. mode: of its valve. slack: what the control may be off by. */
static inline bool dalcs_switch_closes(const struct dalcs_system *s, const uint64_t *mode, int pair,
                                       bool is_on, double control, double slack) {
    const struct dalcs_pair *p = &s->pair[pair];
    const double opens_at = dalcs_switch_opens_at(s, mode, pair) - slack;
    if (!is_on) {
        return control > p->turn_on + slack;
    }
    return dalcs_pair_remembers(p) ? !(control < opens_at) : control > opens_at;
}

static inline bool dalcs_mode_is(const uint64_t *mode, const uint64_t *other, int n_words) {
    uint64_t different = 0;
    for (int k = 0; k < n_words; k++) {
        different |= mode[k] ^ other[k];
    }
    return different == 0;
}

static inline int dalcs_system_n_equations(const struct dalcs_system *s) {
    return s->n_x + s->n_z;
}

static inline int dalcs_system_n_columns(const struct dalcs_system *s) {
    return s->n_x + s->n_z + s->n_pairs;
}

/* V: w of a diode, or of its breakdown, that has no voltage: how far its knee is from 0. */
static inline double dalcs_system_knee(const struct dalcs_system *s, int pair) {
    double knee = 0.0;
    bool has_knee = s->pair[pair].kind == DALCS_PAIR_DIODE && !s->pair[pair].is_formula;
    for (int k = s->F.p[pair]; k < s->F.p[pair + 1] && has_knee; k++) {
        knee += s->F.j[k] == 0 ? s->F.x[k] : 0.0;
    }
    return knee;
}

/* Does a current command switch `pair`, or a voltage? */
static inline bool dalcs_system_control_is_current(const struct dalcs_system *s, int pair) {
    int first = s->control.p[pair];
    return first < s->control.p[pair + 1] && s->column_is_current[s->control.j[first]];
}

void dalcs_system_finish(struct dalcs_system *system);

/* A_rest: sums of entries of A less what they were rounded to. `sums` grows by the latter. */
enum dalcs_status dalcs_system_find_rest(struct dalcs_system *system,
                                         struct dalcs_triplets *sums) DALCS_MUST_CHECK;

#endif

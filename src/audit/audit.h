/* audit.h - is a waveform one of this circuit? Asked of the devices as the netlist gave them.
 *
 * The auditor knows the circuit and a way to read voltages and currents at any time. It knows no equations
 * of the engine, no modes but the positions of switches, and chooses its own times. It checks
 *
 *     Kirchhoff's current law at each node, as charges between two times where capacitors hang on it,
 *     the law of each branch, of coils as fluxes between two times,
 *     each diode's line, signs and complementarity (Brogliato 2022, (2.1)),
 *     each switch's position against its control, hysteresis and initial position included,
 *     each source against its stimulus,
 *     charge and flux across each event: clusters of nodes that no impulse can leave keep their charge,
 *     loops of coils that no impulse of voltage is in keep their flux,
 *     and that over an interval what is stored is what was delivered (Tellegen).
 *
 * A defect is over the scale of what it is in: the largest value in the whole run of each voltage and current
 * that the law adds up. What rounding alone makes of these sums is no defect. */
#ifndef DALCS_AUDIT_H
#define DALCS_AUDIT_H

#include "circuit.h"

#include <stdint.h>

/* All of a part at one time. */
struct dalcs_audit_state {
    double t;
    enum dalcs_side side;
    double *v; /* [n_nodes] V, ground is 0 */
    double *i; /* [n_devices] A, of V, L, D, S and of E, H and B; of R where the reader tells it */
    double *lambda;  /* [n_lambdas] of formulas, in their own units */
    bool *is_closed; /* [n_devices] of switches */
    bool *
        is_mean; /* [n_devices] what a switch that slides takes along, and that: values are means of two positions */
};

/* A stretch as it is stored: value[k stride + c] is column c at node k of its step. */
struct dalcs_audit_polynomials {
    uint64_t key; /* the same: the same mode */
    int n_columns, n_nodes, stride;
    const double *node;  /* [n_nodes] in steps, from 0 to 1 */
    double step, end;    /* s; in steps, where the stretch ends */
    const double *value; /* NULL: they are not complete (dalcs_audit_reader) */
    int n_inputs;        /* where there are any */
    const double *input; /* they are the sum of columns times these; NULL: of nothing */
};

/* A linear function of such columns and of stimuli, while it is put together. */
struct dalcs_audit_row {
    double constant;
    double *column, *stimulus; /* [n_columns], [n_stimuli] factors, 0 where none is listed */
    int n_columns, n_stimuli;  /* that are listed */
    int *listed_column, *listed_stimulus;
    bool *has_column, *has_stimulus;
};

static inline void dalcs_audit_row_add_column(struct dalcs_audit_row *row, int column,
                                              double factor) {
    if (!row->has_column[column]) {
        row->has_column[column] = true;
        row->listed_column[row->n_columns++] = column;
    }
    row->column[column] += factor;
}

static inline void dalcs_audit_row_add_stimulus(struct dalcs_audit_row *row, int stimulus,
                                                double factor) {
    if (!row->has_stimulus[stimulus]) {
        row->has_stimulus[stimulus] = true;
        row->listed_stimulus[row->n_stimuli++] = stimulus;
    }
    row->stimulus[stimulus] += factor;
}

/* A stretch that has gone by, as others keep it. */
struct dalcs_audit_kept {
    double from, to; /* s */
    double *input;
};

/* How a waveform is read. */
struct dalcs_audit_reader {
    void *user;

    /* Sees to the values of the present stretch, where nobody has asked for them yet. NULL: nothing is stored. */
    void (*complete)(void *user, int part);
    /* [n_nodes stride] what input j is multiplied by; NULL: by 0. */
    const double *(*column)(void *user, int part, int j);
    /* Adds so many times the voltage of a node, the current of a device and a formula's lambda, as read() has them. Not
     * all columns are read in each mode: read_columns() tells which. */
    void (*add_voltage)(void *user, int part, int node, double factor, struct dalcs_audit_row *row);
    void (*add_current)(void *user, int part, int device, double factor,
                        struct dalcs_audit_row *row);
    void (*add_lambda)(void *user, int part, int lambda, double factor,
                       struct dalcs_audit_row *row);
    /* is_read[n_columns]: 1 where the present mode reads a column, 0 where another number is in its place. */
    void (*read_columns)(void *user, int part, double *is_read);
    /* Of a device, in the present stretch: does its k-th pair conduct? That of a switch is whether it is closed. */
    bool (*is_on)(void *user, int part, int device, int k);
    /* The state where the stretch before the present one ended, or so many s earlier. */
    void (*read_before)(void *user, int part, double earlier, struct dalcs_audit_state *state);
    /* Such a stretch takes the place of the present one, and what came before it of the one before; until go_back(). Both
     * are of the mode, the step, the end and the map of the one handed on last. */
    struct dalcs_audit_stretch *(*revisit)(void *user, int part,
                                           const struct dalcs_audit_kept *before,
                                           const struct dalcs_audit_kept *present);
    void (*go_back)(void *user, int part);
    /* Is the current of a resistor one of the state, and not what its voltages make of it? NULL: of none. */
    bool (*tells_current)(void *user, int device);
    /* The state of the part at state->t, as the limit from state->side. */
    void (*read)(void *user, int part, struct dalcs_audit_state *state);
    /* Raises v[n_nodes] and i[n_devices] to the largest magnitudes of the part so far. */
    void (*raise)(void *user, int part, double *v, double *i, double *lambda);
};

/* A stretch of the waveform of one part without an event inside. */
struct dalcs_audit_stretch {
    int part;
    double from, to;   /* s */
    double step;       /* s, of the method: rounding of stored charge is a current over it */
    int degree;        /* of its polynomials over such a step */
    double first_look; /* what the first look at it takes besides, in instructions, about */
    bool is_cut;       /* it went on, and nobody follows it */
    bool is_undecided; /* a coarse one: no position of some switch was found to suit its control */
    bool is_last; /* of the part: an interval is looked at for the scales that the run ends with */

    /* NULL: nothing that holds at all its times, steps of implicit Euler or means of two positions */
    const struct dalcs_audit_polynomials *stored;

    enum dalcs_audit_rule {
        DALCS_AUDIT_SMOOTH, /* a polynomial, right at all times to the tolerance */
        DALCS_AUDIT_COARSE  /* a step whose error nobody controls: its end can be looked at */
    } rule;
};

/* Which of the things that can be wrong. */
enum dalcs_audit_law {
    DALCS_AUDIT_KCL,      /* at a node */
    DALCS_AUDIT_BRANCH,   /* the law of a device, as a voltage or a flux */
    DALCS_AUDIT_CURRENT,  /* likewise, as a current */
    DALCS_AUDIT_POSITION, /* of a switch against its control */
    DALCS_AUDIT_ENERGY,   /* of a part */
    DALCS_AUDIT_PERIOD,   /* likewise: where a leap over periods leads to, against steps */
    DALCS_AUDIT_ROW,      /* of a signal: what was written of it, against the waveform */
    DALCS_AUDIT_MEASURE,  /* of a .meas: its number, against the waveform */
    DALCS_AUDIT_FOURIER,  /* of a .four, likewise */
    DALCS_AUDIT_LOSSES,   /* of a device: what .losses says of it, likewise */
    DALCS_AUDIT_EVENT,    /* of a device: when it is told to turn on or off */
    DALCS_AUDIT_JUMP,     /* of a device: what is told of a jump, against both sides of it */
    DALCS_AUDIT_N_LAWS
};

struct dalcs_audit_finding {
    double defect; /* over the scale; 0: none was found */
    double time;   /* s */
};

struct dalcs_audit; /* audit_internal.h */

struct dalcs_audit_options {
    enum dalcs_audit_mode mode;

    double share; /* of the work of the run that samples may cost */
    double vntol, abstol;
    bool is_start; /* the run begins as the netlist says, not where another one ended */

    enum dalcs_audit_origin {
        DALCS_AUDIT_FROM_ANYWHERE,
        DALCS_AUDIT_FROM_INITIAL, /* what IC= says, 0 where there is none */
        DALCS_AUDIT_FROM_REST     /* an operating point that no source leaves by a jump */
    } origin;

    double resolution;      /* s; times closer than this are one */
    const int *device_part; /* [n_devices] the part that a device is in, -1: none */
    int n_parts;
    const double *tolerance; /* [n_parts] largest defect that is none */
    double failure;          /* a larger one breaks the run, at least as much as all of these */
    const double *read_work; /* [n_parts] what reading a state costs, in instructions, about */
};

/* Borrows the circuit, and the arrays of the options during the call. */
enum dalcs_status dalcs_audit_create(struct dalcs_audit **audit,
                                     const struct dalcs_circuit *circuit,
                                     const struct dalcs_audit_options *options,
                                     const struct dalcs_audit_reader *reader) DALCS_MUST_CHECK;

void dalcs_audit_destroy(struct dalcs_audit *audit);

/* Of a part that oscillates for ever, a switch that opens what closes it, there is no operating point: it begins somewhere. */
void dalcs_audit_has_no_rest(struct dalcs_audit *audit, int part);

/* Stretches that are asked together, with the one before them: a pass over all their signs is an eighth of what one takes by
 * itself. */
enum { DALCS_AUDIT_BATCH = 32 };

/* What is gathered of a part. */
struct dalcs_audit_batch {
    bool
        is_on; /* and a stretch may be gathered that has the mode, the step, the end and the map of the one before */
    double last; /* s: where it ends by then */
    double work; /* of the run, instructions, about */
    int n, n_inputs;
    double from[DALCS_AUDIT_BATCH], to[DALCS_AUDIT_BATCH];
    double *input; /* [n_inputs][DALCS_AUDIT_BATCH], and room for two more numbers of each */
};

static inline void dalcs_audit_put(struct dalcs_audit_batch *batch, double from, double to,
                                   const double *input, double work) {
    const int k = batch->n++;
    batch->from[k] = from;
    batch->to[k] = to;
    batch->work += work;
    double *at = batch->input + k;
    for (int j = 0; j < batch->n_inputs; j++, at += DALCS_AUDIT_BATCH) {
        *at = input[j];
    }
}

struct dalcs_audit_batch *dalcs_audit_batch_of(const struct dalcs_audit *audit, int part);

/* Are values, where there are any, what the map makes of the input? Else it is not gathered. */
bool dalcs_audit_is_image(const struct dalcs_audit *audit, int part, const double *input,
                          const double *value);

/* A batch is full. */
void dalcs_audit_ask_batch(struct dalcs_audit *audit, int part);

/* What was gathered of a part is asked now: before anything else is of it. */
void dalcs_audit_settle(struct dalcs_audit *audit, int part);

/* A stretch is complete, which took so much work, in instructions, about: need nobody look at it more closely? Where
 * somebody must, and at the last one in any case, dalcs_audit_leave() follows. */
bool dalcs_audit_passes_over(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch,
                             double work);

/* It can be read, up to its end. */
void dalcs_audit_leave(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch);

/* The next stretch of the part has begun. Is its beginning to be looked at? Then dalcs_audit_enter() follows. */
bool dalcs_audit_begins(struct dalcs_audit *audit, int part);

/* The present stretch of the part does not begin where the one before ended: it was put off. */
void dalcs_audit_put_off(struct dalcs_audit *audit, int part);

/* The next one begins where that ended, or is the first one of all, and can be read there; `first_look` is not used. */
void dalcs_audit_enter(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch);

/* A part without memory at time t. */
void dalcs_audit_instant(struct dalcs_audit *audit, int part, double t, enum dalcs_side side,
                         double work);

/* A row: value[n] of the first signals at a time that can be read. */
void dalcs_audit_row(struct dalcs_audit *audit, double t, enum dalcs_side side, const double *value,
                     int n);

/* A finding of another one than the auditor, on its scale. */
void dalcs_audit_add(struct dalcs_audit *audit, enum dalcs_audit_law law, int index, double defect,
                     double time);

/* The same of what a device is in: its position. */
void dalcs_audit_add_position(struct dalcs_audit *audit, int device, double defect, double time);

/* Is something in a part at t where it changes over, or has a source an edge there? Then what reads the part may have been
 * anything for no time. begins: its present stretch begins at t. */
bool dalcs_audit_has_cause(struct dalcs_audit *audit, int part, double t, bool begins);

/* May so much more be looked at, in instructions, about? It is charged where it may. */
bool dalcs_audit_may(struct dalcs_audit *audit, double work);

/* 0 <= chance < 1, the same in each run. */
double dalcs_audit_chance(struct dalcs_audit *audit);

/* More that the run has done, in instructions, about: rows. */
void dalcs_audit_earn(struct dalcs_audit *audit, double work);

/* The worst defect over its part's tolerance, of those that break the run where there are any. */
struct dalcs_audit_summary {
    long instants;  /* at which laws were checked */
    long stretches; /* of all, and those that were looked into */
    long audited;
    long screened;  /* all laws of which were asked at once, at one instant */
    long positions; /* of switches that were compared with their controls */
    long unjudged;  /* the same where the waveform is coarse: they may be late by a step */
    bool stays;     /* a switch that stood against its control over steps is what is worst */
    double defect;  /* over the scale, of the law that is worst against what is allowed */
    double allowed; /* what it was held to */
    double time;    /* s */
    enum dalcs_audit_law law;
    int index;      /* node, device or part; -1: nothing was checked */
    bool is_broken; /* more than options.failure */
};

struct dalcs_audit_summary dalcs_audit_summarise(const struct dalcs_audit *audit);

/* What is worst at the ends of coarse stretches; index -1: nothing was found. Not in the others. */
struct dalcs_audit_summary dalcs_audit_summarise_coarse(const struct dalcs_audit *audit);

/* The worst defect of one law: of a node, device or part. */
struct dalcs_audit_finding dalcs_audit_finding_of(const struct dalcs_audit *audit,
                                                  enum dalcs_audit_law law, int index);

/* How many nodes, devices or parts a law is of. */
int dalcs_audit_n_of(const struct dalcs_audit *audit, enum dalcs_audit_law law);

/* "KCL at out", "d1", "i(s1)", "position of s1", "the energy balance"; into text[size]. */
void dalcs_audit_law_name(const struct dalcs_audit *audit, enum dalcs_audit_law law, int index,
                          char *text, size_t size);

#endif

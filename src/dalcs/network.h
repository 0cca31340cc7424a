/* network.h - a circuit as independent DALCSs with the probes that read them.
 *
 * Parts of a circuit that share only ground are separate systems with separate modes: 250 rectifiers
 * are 250 small problems, never one with 2^1000 modes. */
#ifndef DALCS_NETWORK_H
#define DALCS_NETWORK_H

#include "circuit.h"
#include "power.h"
#include "readout.h"
#include "system.h"

/* A linear function of one system's solution: sum of coefficient * column, plus inputs. */
struct dalcs_probe {
    int system; /* -1: identically zero */
    int n_terms, n_inputs;

    struct dalcs_probe_term {
        int index; /* column, or input */
        double coefficient;
    } * term; /* [n_terms + n_inputs], columns first */
};

/* A voltage between two systems is the difference of two probes. */
struct dalcs_output {
    const char *name;
    bool is_current;
    struct dalcs_probe plus, minus;
};

struct dalcs_network {
    int n_systems;
    struct dalcs_system *system;
    int n_outputs;
    struct dalcs_output *output; /* the circuit's signals, in its order */
    bool is_without_units;       /* of a system file that names none: its signals are numbers */
    int n_states;

    struct dalcs_state {
        const char *element; /* every capacitor and inductor of the circuit */
        bool is_current;
        struct dalcs_probe probe;
    } * state;

    struct dalcs_power *power;     /* [n_systems] what its devices give and take */
    struct dalcs_readout *readout; /* NULL: of a system file, or not asked for */
    double **initial;              /* [n_systems][n_x] x(0-) for uic: IC=, else .ic, else 0 */
    int n_nodes;                   /* without ground */
    struct dalcs_arena arena;

    /* Of a system file, which has no circuit to build them from; else NULL. Owned. */
    struct dalcs_network *held;    /* with the voltages of .ic held: the start of a .tran */
    struct dalcs_network *jump[2]; /* by enum dalcs_impulse_kind */
    bool *jumps_are_covered;       /* [n_systems] by these */
};

/* Options that choose what the network is for. */
struct dalcs_network_options {
    bool clamp_initial_conditions; /* hold .ic voltages: the operating point of a .tran */
    bool at_rest; /* nothing has changed for ever: what is delayed is what it is now */
    bool silent;  /* nothing that a person has not been told before */
    bool with_readout;
};

/* Builds *network; the circuit must outlive it (names are borrowed). User errors (inductance that is
 * not positive semidefinite) go to diag with DALCS_E_NETLIST; on failure *network is zeroed. */
enum dalcs_status dalcs_network_build(struct dalcs_network *network,
                                      const struct dalcs_circuit *circuit,
                                      const struct dalcs_network_options *options,
                                      struct dalcs_diag *diag) DALCS_MUST_CHECK;

void dalcs_network_finish(struct dalcs_network *network);

static inline double dalcs_probe_value(const struct dalcs_probe *probe, const double *y,
                                       const double *inputs) {
    double sum = 0.0;
    int k = 0;
    for (; k < probe->n_terms; k++) {
        sum += probe->term[k].coefficient * y[probe->term[k].index];
    }
    for (; k < probe->n_terms + probe->n_inputs; k++) {
        sum += probe->term[k].coefficient * inputs[probe->term[k].index];
    }
    return sum;
}

/* Does the probe read nothing but the first n columns? */
static inline bool dalcs_probe_is_known(const struct dalcs_probe *probe, int n) {
    bool is_known = probe->n_inputs == 0;
    for (int k = 0; k < probe->n_terms && is_known; k++) {
        is_known = probe->term[k].index < n;
    }
    return is_known;
}

#endif

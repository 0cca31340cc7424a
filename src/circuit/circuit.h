/* circuit.h - devices on nodes: what a netlist means, before any equation is written.
 *
 * Built once from a netlist, then const. Node 0 is ground. Names are lower case. Currents through a
 * two-terminal device flow from node[0] to node[1] inside it, as in SPICE. */
#ifndef DALCS_CIRCUIT_H
#define DALCS_CIRCUIT_H

#include "device.h"
#include "diag.h"
#include "logic.h"
#include "losses.h"
#include "measurement.h"
#include "stimulus.h"
#include "sweep.h"

#include <string.h>

/* .ic v(a[,b]) = value */
struct dalcs_initial_condition {
    int node[2]; /* second is 0 for v(a) */
    double value;
    struct dalcs_location where;
};

/* One signal that .save or .print names, or a default one. */
enum dalcs_signal_kind { DALCS_SIGNAL_VOLTAGE, DALCS_SIGNAL_CURRENT };

struct dalcs_signal {
    const char *name; /* "v(out)", "v(a,b)", "i(d1)" */
    enum dalcs_signal_kind kind;
    int device;  /* current: index of the device, else -1 */
    int node[2]; /* voltage: node[0] - node[1] */
};

/* The values of .tran; times in s. */
struct dalcs_transient {
    bool present;
    double step, stop, start, max_step; /* step 0: rows every stop/1000; max_step 0: not given */
    double first_step;                  /* Xyce's; else 0 */
    bool use_initial_conditions;        /* uic */
    bool starts_steady;                 /* uic=steady */
    struct dalcs_location where;
};

/* The values of .env; times in s. Beside it is a .tran of the same length. */
struct dalcs_envelope_card {
    bool present;
    double step;      /* of rows in periods that are written; 0: the period/100 */
    double tolerance; /* 0: that of the run */
    int n_at;
    double *at; /* [n_at] times whose periods are written */
};

/* The values of .ac around a periodic orbit. */
struct dalcs_orbit_ac_card {
    const char *loop; /* the V source in the loop whose gain is computed; NULL: none */
    bool is_loaded;   /* by a current as well: what the loop goes on to takes one */
    int sideband;     /* rows are of the components so many frequencies of the orbit higher */
};

/* The three values of .tf. */
enum { DALCS_TRANSFER_GAIN, DALCS_TRANSFER_OUTPUT, DALCS_TRANSFER_INPUT, DALCS_N_TRANSFER };

/* The values of .tf. */
struct dalcs_transfer_card {
    bool present;
    bool source_is_voltage;
    int source;        /* device */
    int output_device; /* the V source of i(vsource); -1: the output is a voltage */
    int node[2];       /* of the voltage */
    int probe;         /* stimulus of the current source between them; -1: there is none */
    int output, input; /* what is read there: measured signals */
    const char *name[DALCS_N_TRANSFER];
    struct dalcs_location where;
};

/* The items of .sens. */
struct dalcs_sensitivity_card {
    bool present;
    int n;
    struct dalcs_sweep *item; /* [n] whose start is the value that it has */
};

/* What .wcase varies. */
struct dalcs_worst_case_card {
    bool present;
    bool no_corners; /* not all of them, however few they are */
    bool no_dev, no_lot;
    struct dalcs_location where;
    int n;

    struct dalcs_tolerance_place {
        const char *name; /* "r1", "d1(vfwd)", "lot(rb)" */
        uint64_t key;     /* in an override of the corner */
    } * place;            /* [n] */
};

/* The values of .pss; times in s. */
struct dalcs_periodic_card {
    bool present;
    double period, step;         /* 0: it follows from the sources; rows every period/1000 */
    double n_periods;            /* of that, which is what is asked for; 0: one */
    bool oscillates;             /* no source has a period */
    bool use_initial_conditions; /* uic */
};

enum { DALCS_MOST_DC = 2 };

/* A source that puts out what a signal was (history.h). */
struct dalcs_delayed {
    const char *name;
    int signal;                    /* which measured one */
    double initial;                /* V, what it was until t = 0 with uic */
    struct dalcs_history *history; /* of the present run; the circuit's */
};

/* Of the devices, by number. */
struct dalcs_circuit_models {
    int n_diodes;
    struct dalcs_diode_model *of_diode;
    bool has_own_tangents; /* each exponential diode has a model that no other has */
    int n_switches;
    struct dalcs_switch_model *of_switch;
    int n_saturations;
    struct dalcs_saturation *saturation;
};

/* What is no branch of the network: functions of signals, gates, and what tells them. */
struct dalcs_circuit_control {
    int n_smooth;        /* sources of a smooth function */
    int smooth_stimulus; /* the constant 0, which stands for what they put out; -1: there are none */
    int n_gates;
    struct dalcs_logic_gate *gate;
    int n_delayed;
    struct dalcs_delayed *delayed;
    int n_comparators;
    int *comparator; /* [n_comparators] switches that nothing flows in: what gates read */
    int n_externals; /* sources that a program outside gives values (stimulus.h) */
    bool is_whole;   /* all of it is one system: gates carry small signals from part to part */
};

/* What is asked of the waveforms. */
struct dalcs_circuit_results {
    int n_signals; /* default: every node voltage, then currents of V, L, D, S, W, E, H */
    struct dalcs_signal *signal;
    int n_shown; /* the first of them, which rows have; the others are there to be measured */
    int n_named; /* the first of these, which results have: all without computed columns */
    int n_computed;
    struct dalcs_computed *computed; /* columns of results that rows have no signal for */
    int n_measured;
    int *measured; /* [n_measured] signals that formulas name, by their number there */
    int n_measures;
    struct dalcs_measure_card *measure; /* .meas, in their order */
    int n_fouriers;
    struct dalcs_fourier_card *fourier; /* .four, one for each signal */
    struct dalcs_losses_card *losses;   /* NULL: not asked for */
    int n_prints;
    struct dalcs_print_card *print; /* .print and .plot, in their order */
};

struct dalcs_circuit_analyses {
    struct dalcs_transient transient;
    struct dalcs_envelope_card envelope;
    struct dalcs_periodic_card periodic;
    bool operating_point; /* .op */
    int n_dc;             /* of .dc, the innermost first; 0: there is none */
    struct dalcs_sweep dc[DALCS_MOST_DC];
    struct dalcs_sweep ac; /* frequencies of .ac in Hz; n is 0 without one */
    struct dalcs_orbit_ac_card orbit_ac;
    struct dalcs_transfer_card transfer;
    struct dalcs_sensitivity_card sensitivity;
    struct dalcs_worst_case_card worst_case;
    int n_steps; /* of .step and .mc, the innermost first */
    struct dalcs_sweep *step;
};

/* Values that random functions had a part in. */
struct dalcs_circuit_random {
    int n_drawn;
    struct dalcs_drawn_value *drawn;
    bool is_random; /* these, or formulas with random values */
};

struct dalcs_circuit {
    const char *title;
    int n_nodes; /* ground included */
    const char **node_name;
    int n_devices;
    struct dalcs_device *device;
    int n_stimuli;
    struct dalcs_stimulus *stimulus;
    int n_couplings;
    struct dalcs_coupling *coupling;
    int n_initial_conditions;
    struct dalcs_initial_condition *initial_condition;
    struct dalcs_circuit_models models;
    struct dalcs_circuit_control control;
    struct dalcs_circuit_results results;
    struct dalcs_circuit_analyses analyses;
    struct dalcs_circuit_random random;

    struct dalcs_circuit_options {
        double reltol, abstol, vntol;          /* 0: not given; the last two in A, V */
        struct dalcs_location tolerance_where; /* of the first of these */
        const char *method;                    /* NULL: not given */
        struct dalcs_location method_where;
        double step;             /* 0: not given */
        double initial_interval; /* s, of rows, Xyce's; 0: not given */
        int stages;              /* of radau; 0: not given */
        double compress;         /* 0: not given */
        double fill;             /* 0: not given; INFINITY: none */
        bool lines;              /* curve=lines */
        bool ascii;              /* filetype=ascii */
        bool has_diode_current;  /* diodecurrent= */
        struct dalcs_location compress_where, fill_where;
    } options;
    struct dalcs_arena arena; /* owns everything above, source text of locations included */
};

struct dalcs_drawn_value {
    const char *name; /* "c", "x1.tol", "r1", "dmod(vfwd)" */
    double value;
};

/* A column that is computed from the signals of a row; `formula` names them as measured ones. */
struct dalcs_computed {
    const char *name; /* "{v(a)*i(r1)}", "w(d1)" */
    int at;           /* before which named signal it stands */
    struct dalcs_signal_formula formula;
};

struct dalcs_print_card {
    bool is_of[DALCS_MEASURED_AC + 1]; /* the analyses that it shows */
    int n;

    struct dalcs_print_column {
        const char *signal, *title; /* title: as on the card */
        enum dalcs_signal_part part;
    } * column; /* [n] */
};

struct dalcs_netlist;
struct dalcs_override;

/* Builds *circuit from the netlist. Every user error goes to diag; then the result is
 * DALCS_E_NETLIST and *circuit is zeroed: nothing to free. The circuit is self-contained: the
 * netlist may be finished afterwards. */
enum dalcs_status dalcs_circuit_build(struct dalcs_circuit *circuit,
                                      const struct dalcs_netlist *netlist,
                                      struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* The same with other values for what the overrides name (language/override.h). */
enum dalcs_status dalcs_circuit_build_with(struct dalcs_circuit *circuit,
                                           const struct dalcs_netlist *netlist,
                                           const struct dalcs_override *override,
                                           size_t n_overrides,
                                           struct dalcs_diag *diag) DALCS_MUST_CHECK;

void dalcs_circuit_finish(struct dalcs_circuit *circuit);

/* Does an analysis have waveforms of time? */
static inline bool dalcs_circuit_has_waves(const struct dalcs_circuit *circuit) {
    return circuit->analyses.transient.present || circuit->analyses.periodic.present;
}

/* Has an analysis answers that the audit reads? */
static inline bool dalcs_circuit_is_audited(const struct dalcs_circuit *circuit) {
    return dalcs_circuit_has_waves(circuit) || circuit->analyses.operating_point ||
           circuit->analyses.n_dc > 0 || circuit->analyses.ac.n > 0 ||
           circuit->analyses.transfer.present;
}

/* A resistor of 0 ohm: its two nodes are one, unless its current is a signal. */
static inline bool dalcs_device_is_short(const struct dalcs_device *device) {
    return device->kind == DALCS_RESISTOR && device->value == 0.0;
}

/* Is it the switch that commutate.c makes of a jump of a formula? */
static inline bool dalcs_element_is_commutator(const char *name) {
    static const char commutator[] = "commutator(";
    return strncmp(name, commutator, sizeof(commutator) - 1) == 0;
}

/* Ohms of a diode or a switch that blocks; INFINITY: it is a cut. */
static inline double dalcs_device_roff(const struct dalcs_circuit *c,
                                       const struct dalcs_device *device) {
    return device->kind == DALCS_DIODE ? c->models.of_diode[device->model].roff
                                       : c->models.of_switch[device->model].roff;
}

/* Ohms of one that conducts; 0: it is a wire. */
static inline double dalcs_device_ron(const struct dalcs_circuit *c,
                                      const struct dalcs_device *device) {
    return device->kind == DALCS_DIODE ? c->models.of_diode[device->model].ron
                                       : c->models.of_switch[device->model].ron;
}

/* A voltage that is one stimulus. */
static inline bool dalcs_device_is_decided(const struct dalcs_device *device) {
    const struct dalcs_behaviour *b = device->behaviour;
    return device->kind == DALCS_VSOURCE ||
           (device->kind == DALCS_VCVS && b != NULL && b->n_pairs == 0 && b->output.n == 1 &&
            b->output.constant == 0.0 && b->output.term[0].coefficient == 1.0 &&
            b->output.term[0].kind == DALCS_QUANTITY_STIMULUS);
}

/* The behaviour as its formula says, with pairs for what sources alone decide, too; NULL: it has none. */
static inline const struct dalcs_behaviour *dalcs_device_written(const struct dalcs_device *d) {
    const struct dalcs_behaviour *b = d->behaviour;
    return b != NULL && b->written != NULL ? b->written : b;
}

/* Calls visit(to, term) for each term of a behaviour. */
static inline void
dalcs_behaviour_visit(const struct dalcs_behaviour *behaviour,
                      void (*visit)(void *to, const struct dalcs_affine_term *term), void *to) {
    for (int k = -1; behaviour != NULL && k < behaviour->n_pairs; k++) {
        const struct dalcs_affine *a = k < 0 ? &behaviour->output : &behaviour->w[k];
        for (int i = 0; i < a->n; i++) {
            visit(to, &a->term[i]);
        }
    }
}

/* Is the k-th stimulus one of changed[n_stimuli], or a formula of such? k < 0, the constant, is not. */
bool dalcs_stimulus_depends(const struct dalcs_circuit *circuit, int k, const bool *changed);

static inline void dalcs_mark_wanted_term(void *wanted, const struct dalcs_affine_term *term) {
    if (term->kind == DALCS_QUANTITY_CURRENT) {
        ((bool *)wanted)[term->index] = true;
    }
}

/* wanted[n_devices], zeroed by the caller: the devices whose current a signal or a formula reads. */
static inline void dalcs_circuit_mark_wanted_currents(const struct dalcs_circuit *circuit,
                                                      bool *wanted) {
    for (int i = 0; i < circuit->n_devices; i++) {
        dalcs_behaviour_visit(circuit->device[i].behaviour, dalcs_mark_wanted_term, wanted);
    }
    for (int i = 0; i < circuit->results.n_signals; i++) {
        if (circuit->results.signal[i].kind == DALCS_SIGNAL_CURRENT) {
            wanted[circuit->results.signal[i].device] = true;
        }
    }
}

#endif

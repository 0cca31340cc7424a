/* builder.h - what the parsers of all device families share while a circuit is being built: names and
 * messages. Private to this folder and to equations/, whose
 * system files are made of the same cards. */
#ifndef DALCS_BUILDER_H
#define DALCS_BUILDER_H

#include "circuit.h"
#include "drivers.h"
#include "expand.h"
#include "formula.h"
#include "names.h"
#include "netlist.h"
#include "temperature.h"

enum dalcs_model_kind {
    DALCS_MODEL_DIODE,
    DALCS_MODEL_SWITCH,
    DALCS_MODEL_CURRENT_SWITCH,
    DALCS_MODEL_THYRISTOR,
    DALCS_MODEL_TRANSISTOR,
    DALCS_MODEL_BLOCK,   /* XSPICE's */
    DALCS_MODEL_PASSIVE, /* of R, L or C, whose card has the value */
    DALCS_MODEL_OTHER,   /* of a device that does not exist here */
    DALCS_MODEL_WRONG    /* had errors: a use of it is no second error */
};

/* The parameters of a diode's model besides its lines. */
struct dalcs_diode_card {
    double ilimit, revilimit;                /* A, INFINITY: none */
    bool is_berkeley;                        /* an exponential diode: the rest is its own */
    double saturation, emission, resistance; /* IS in A, N, RS in ohm */
    double breakdown, breakdown_current, back_emission; /* BV in V, IBV in A, NBV */
};

struct dalcs_model {
    enum dalcs_model_kind kind;
    int index;        /* in diode_model or switch_model */
    bool was_refused; /* an element names it, where another kind is wanted */
    const struct dalcs_token *name;
    const struct dalcs_token *type;
    const struct dalcs_card *card;
    struct dalcs_diode_card diode;
    const struct dalcs_thyristor *thyristor;
    const struct dalcs_block *block;
    struct dalcs_transistor *transistor;
    const struct dalcs_token *beyond;       /* of R, L or C: what would change values; else NULL */
    bool has_value;                         /* of R, L or C: that of a card without one, */
    double value;                           /* and PSpice's factor of one that has its own */
    struct dalcs_coefficients coefficients; /* of R, L or C */
};

enum dalcs_hidden {
    DALCS_HIDDEN_ELEMENTS = 1, /* and their nodes */
    DALCS_HIDDEN_MODELS = 2,
    DALCS_HIDDEN_ANALYSES = 4,
    DALCS_HIDDEN_ALL = 7
};

/* The conductance that capacitors of blocks with states are charged through, S: it is in no waveform, for their currents
 * are nobody's. Of volts it makes milliamperes, as circuits have. */
static const double dalcs_charging = 1e-3;

/* Nodes and elements by name. */
struct dalcs_builder_elements {
    struct dalcs_names nodes; /* name -> index; ground is not in it */
    const char **node_name;   /* [n_nodes], heap */
    size_t node_name_capacity;
    const struct dalcs_token **node_token; /* [n_nodes] where a node was named first, heap */
    size_t node_token_capacity;
    struct dalcs_names devices; /* name -> index, K cards follow from n_device_cards on */
    const struct dalcs_token **device_token; /* where they are, by the same index */
    const struct dalcs_token *
        *control_token;       /* [n_device_cards] the V source that an F, H or W names */
    int n_device_cards;       /* and the devices that parts of cards become */
    int *current_of;          /* [n_device_cards] the device whose current an element's is: mostly
                                 its own */
    double *default_rser;     /* [n_device_cards] ohms that LTspice adds to a coil, 0 where it adds
                                 none; NULL: the netlist is not told to be one of LTspice */
    int n_couplings_seen;     /* K cards so far, right or wrong */
    struct dalcs_names pairs; /* "3 7": coils 3 and 7 are coupled, by the place of the card */
    size_t device_capacity;   /* of circuit->device and what goes by its index */
};

/* Models by name. */
struct dalcs_builder_models {
    struct dalcs_names names; /* name -> index of model */
    struct dalcs_model *model;
    int n, capacity;
    size_t switch_capacity; /* of circuit->models.of_switch */
    int ideal_diode;        /* the model of diodes without one, -1 before the first */
    bool bipolar_is_switch; /* .options bjt=switch */
    struct dalcs_transistor_use *last_transistor; /* NULL: there is none */
    double diode_current; /* A, where an exponential diode and its tangent touch */
};

/* What waits until all elements are known. Of lists the last entry, each points to the one before. */
struct dalcs_builder_formulas {
    struct dalcs_formula_source *source; /* heap: those whose formula is compiled then */
    size_t n, capacity;                  /* in the order of their devices */
    struct dalcs_drivers drivers;
    const struct dalcs_delay *delay;           /* delay() in formulas */
    const struct dalcs_later_list *later;      /* delayed sources */
    const struct dalcs_storage *storage;       /* coils and capacitors that are no lines */
    const struct dalcs_oscillator *oscillator; /* code models that wait for their control */
};

/* Gates and comparators. */
struct dalcs_builder_logic {
    size_t gate_capacity, comparator_capacity;
    struct dalcs_names comparators; /* "3 0" and thresholds -> place among the circuit's */
    bool *read_by_gates;            /* [n_nodes_of_gates] nodes whose bit another gate reads */
    size_t n_nodes_of_gates;
    const struct dalcs_logic_card *gate_card; /* the last of all, each points to the one before */
    const struct dalcs_output *output;        /* of LTspice's A devices without Rout=, likewise */
};

/* The first card of each analysis, NULL before; initial conditions. */
struct dalcs_builder_analyses {
    const struct dalcs_token *pss, *tran, *op, *dc, *ac, *sens, *tf;
    const struct dalcs_token *startup;       /* LTspice's word on .tran */
    const struct dalcs_token *initial_state; /* the first IC= or .ic i(...) */
    struct dalcs_names initial_pairs;        /* "0 4": index of the condition on nodes 0 and 4 */
    struct dalcs_initial_condition *initial_condition; /* heap */
    size_t n_initial_conditions, initial_condition_capacity;
};

/* What is recorded. */
struct dalcs_builder_signals {
    bool are_named;              /* a .save or .print was seen */
    bool saves_currents;         /* .options savecurrents was */
    struct dalcs_names names;    /* name -> index of signal */
    struct dalcs_signal *signal; /* heap */
    size_t n, capacity;
    struct dalcs_computed *computed; /* heap */
    size_t n_computed, computed_capacity;
    struct dalcs_signal *measured; /* heap: what formulas name */
    size_t n_measured, measured_capacity;
    struct dalcs_names measured_keys; /* "7" or "0 4": place in measured of the current of device 7,
                                           the voltage of node 0 against 4 */
};

/* What is made of that: .meas, .print, .four, .losses. */
struct dalcs_builder_results {
    struct dalcs_names measure_names;   /* name -> place in measure */
    struct dalcs_measure_card *measure; /* heap */
    size_t n_measures, measure_capacity;
    struct dalcs_print_card
        *print; /* heap; columns are in print_column, one card's after the other's */
    size_t n_prints, print_capacity;
    struct dalcs_print_column *print_column; /* heap */
    size_t n_print_columns, print_column_capacity;
    bool is_print;            /* the signals that are being read are those of the last card */
    const char *print_before; /* of the title of the next one */
    enum dalcs_signal_part print_part;
    struct dalcs_fourier_card *fourier; /* heap */
    size_t n_fouriers, fourier_capacity;
    size_t n_switchlosses;
    const struct dalcs_token *switchloss; /* the first .switchloss, NULL before */
};

/* What has had its note. */
struct dalcs_builder_noted {
    bool power;      /* p(r1) has been passed over */
    bool caret, log; /* in a formula */
};

/* What keep_location copied last, to copy it once: a line, a file's name and how it was included, calls and their copy. */
struct dalcs_builder_kept {
    const struct dalcs_source_line *line;
    const char *text;
    const struct dalcs_source *source;
    const char *file;
    const struct dalcs_origin *included, *origin, *instance;
};

struct dalcs_builder {
    struct dalcs_circuit *circuit;
    const struct dalcs_netlist *netlist;
    const struct dalcs_deck *deck; /* its cards, flat */
    struct dalcs_diag *diag;
    struct dalcs_arena scratch; /* hints and the like: freed with the builder */
    bool failed;                /* an error was reported */
    bool out_of_memory;
    unsigned hidden; /* what refused cards may have defined (enum dalcs_hidden): when
                        such a thing is missing, that is no further error */
    struct dalcs_builder_elements elements;
    struct dalcs_builder_models models;
    struct dalcs_builder_formulas formulas;
    struct dalcs_builder_logic logic;
    struct dalcs_builder_analyses analyses;
    struct dalcs_builder_signals signals;
    struct dalcs_builder_results results;
    struct dalcs_builder_noted noted;
    struct dalcs_builder_kept kept;
    struct dalcs_temperatures temperatures;
};

/* ---- builder.c ----------------------------------------------------------------------------- */

/* Reports an error or a warning or note at a token. The hint may be NULL. */
void dalcs_builder_error(struct dalcs_builder *builder, const struct dalcs_token *token,
                         const char *hint, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void dalcs_builder_error_at(struct dalcs_builder *builder, const struct dalcs_location *where,
                            const char *hint, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void dalcs_builder_warn_at(struct dalcs_builder *builder, const struct dalcs_location *where,
                           const char *hint, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void dalcs_builder_warn(struct dalcs_builder *builder, const struct dalcs_token *token,
                        const char *hint, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void dalcs_builder_note(struct dalcs_builder *builder, const struct dalcs_token *token,
                        const char *hint, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* A hint made by printf, or NULL. */
const char *dalcs_builder_hint(struct dalcs_builder *builder, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* "did you mean 'out'?", or "the nodes are: a, b" when there are few, or NULL. */
const char *dalcs_builder_suggest(struct dalcs_builder *builder, const struct dalcs_names *names,
                                  const char *name, const char *plural);

/* "did you mean 'ron'?", or `otherwise`. */
const char *dalcs_builder_suggest_of(struct dalcs_builder *builder, const char *const *candidate,
                                     size_t n, const char *name, const char *otherwise);

/* Is name one of list[0..n-1]? */
bool dalcs_builder_is_one_of(const char *name, const char *const *list, size_t n);

/* A word that people or libraries put on a part, of no effect in any simulator: mfg, tol, ipk, ... */
bool dalcs_builder_is_label(const char *name);

/* "bridge.cir:3:1", in scratch; never NULL. */
const char *dalcs_builder_place(struct dalcs_builder *builder, const struct dalcs_token *token);

/* A location that is valid as long as the circuit. */
struct dalcs_location dalcs_builder_keep_location(struct dalcs_builder *builder,
                                                  const struct dalcs_token *token);

/* The index of a node, made when new; -1 when out of memory. */
int dalcs_builder_node(struct dalcs_builder *builder, const struct dalcs_token *token);

/* The same of a name that may be of none, without an error: -1. */
int dalcs_builder_look_up_node(struct dalcs_builder *builder, const char *name);
int dalcs_builder_look_up_device(struct dalcs_builder *builder, const char *name);

/* The index of a node that an element names; else an error, and -1. */
int dalcs_builder_find_node(struct dalcs_builder *builder, const struct dalcs_token *token);

/* The same of a card that other simulators take without the node: a warning that ends with `lost`, "it
 * is left out", and -1. */
int dalcs_builder_find_node_or_warn(struct dalcs_builder *builder, const struct dalcs_token *token,
                                    const char *lost);

/* The index of a device; else an error, and -1. */
int dalcs_builder_find_device(struct dalcs_builder *builder, const struct dalcs_token *token);

/* Adds the device that a card names; a second use of the name is an error. NULL when out of
 * memory. */
struct dalcs_device *dalcs_builder_add_device(struct dalcs_builder *builder,
                                              enum dalcs_device_kind kind,
                                              const struct dalcs_token *name);

/* A device that is part of what a card means, such as "rser(c1)": no card can name it. NULL when out
 * of memory. dalcs_card_table_classify counts the room for it. */
struct dalcs_device *dalcs_builder_add_inner_device(struct dalcs_builder *builder,
                                                    enum dalcs_device_kind kind, const char *what,
                                                    const struct dalcs_token *element);

/* A node that no card can name, such as "inside(c1)"; -1 when out of memory. */
int dalcs_builder_inner_node(struct dalcs_builder *builder, const char *what,
                             const struct dalcs_token *element);

/* Room for n more devices, in pieces that double: a netlist of many products has many parts. The array moves. */
bool dalcs_builder_reserve_devices(struct dalcs_builder *builder, size_t n);

/* Puts a short "terminal(c1)" before node[0] of a device, which becomes an inner one: the current of the element
 * is that of the short, which has an unknown only where it is read. False when out of memory. */
bool dalcs_builder_add_terminal(struct dalcs_builder *builder, const struct dalcs_token *element,
                                struct dalcs_device *device);

/* The first letter of an element's name in its own subcircuit, lower case. */
char dalcs_builder_letter(const struct dalcs_token *name);

/* Registers an element's name under `value` or reports its first use. */
void dalcs_builder_add_name(struct dalcs_builder *builder, const struct dalcs_token *name,
                            int value);

/* "a resistor", by kind */
const char *dalcs_builder_kind_text(enum dalcs_device_kind kind);

/* Remembers that memory is out where it is; returns `ok`. */
bool dalcs_builder_note_memory(struct dalcs_builder *builder, bool ok);

#endif

/* builder.h - what the parsers of all device families share while a circuit is being built: names,
 * messages, and a reader that walks over one card. Private to this folder and to equations/, whose
 * system files are made of the same cards. */
#ifndef DALCS_BUILDER_H
#define DALCS_BUILDER_H

#include "circuit.h"
#include "drivers.h"
#include "expand.h"
#include "formula.h"
#include "names.h"
#include "netlist.h"

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
    const struct dalcs_token *beyond; /* of R, L or C: what would change values; else NULL */
    bool has_value;                   /* of R, L or C: that of a card without one, */
    double value;                     /* and PSpice's factor of one that has its own */
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

struct dalcs_builder {
    struct dalcs_circuit *circuit;
    const struct dalcs_netlist *netlist;
    const struct dalcs_deck *deck; /* its cards, flat */
    struct dalcs_diag *diag;
    struct dalcs_arena scratch; /* hints and the like: freed with the builder */
    bool failed;                /* an error was reported */
    unsigned hidden;            /* what refused cards may have defined (enum dalcs_hidden): when
                                   such a thing is missing, that is no further error */
    bool out_of_memory;

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
    int ideal_diode;          /* the model of diodes without one, -1 before the first */
    bool bipolar_is_switch;   /* .options bjt=switch */
    struct dalcs_transistor_use *transistor; /* the last one, NULL: there is none */
    double diode_current; /* A, where an exponential diode and its tangent touch */

    struct dalcs_formula_source *formula; /* heap: the sources whose formula is compiled when all
                                             elements are known */
    size_t n_formulas, formula_capacity;  /* in the order of their devices */
    struct dalcs_drivers drivers;
    size_t device_capacity,
        switch_model_capacity; /* of circuit->device and what goes by its index */

    struct dalcs_names models; /* name -> index of model */
    struct dalcs_model *model;
    int n_models, model_capacity;
    size_t gate_capacity, comparator_capacity;
    struct dalcs_names comparators; /* "3 0" and thresholds -> place among the circuit's */
    bool *read_by_gates;            /* [n_nodes_of_gates] nodes whose bit another gate reads */
    size_t n_nodes_of_gates;
    const struct dalcs_logic_card *gate_card; /* the last of all, each points to the one before */
    const struct dalcs_oscillator
        *oscillator;                      /* likewise: code models that wait for their control */
    const struct dalcs_delay *delay;      /* likewise: delay() in formulas */
    const struct dalcs_later_list *later; /* likewise: delayed sources */
    const struct dalcs_storage *storage;  /* likewise: coils and capacitors that are no lines */

    const struct dalcs_token *pss;  /* so with .pss */
    const struct dalcs_token *tran; /* the first .tran and .op, NULL before */
    const struct dalcs_token *op;
    const struct dalcs_token *startup; /* LTspice's word on .tran, or NULL */
    const struct dalcs_token *dc, *ac; /* the same of these */
    const struct dalcs_token *sens;
    const struct dalcs_token *initial_state; /* the first IC= or .ic i(...), NULL before */

    struct dalcs_names initial_pairs; /* "0 4": index of the condition on nodes 0 and 4 */
    bool names_signals;               /* a .save or .print was seen */
    bool saves_currents;              /* .options savecurrents was */
    struct dalcs_names signals;       /* name -> index of signal */
    struct dalcs_signal *signal;      /* heap */
    size_t n_signals;
    size_t signal_capacity;
    struct dalcs_initial_condition *initial_condition; /* heap */
    size_t n_initial_conditions;
    size_t initial_condition_capacity;

    struct dalcs_computed *computed; /* heap */
    size_t n_computed, computed_capacity;
    struct dalcs_signal *measured; /* heap: what formulas name */
    size_t n_measured;
    size_t measured_capacity;
    struct dalcs_names measured_keys; /* "7" or "0 4": place in measured of the current of device 7,
                                           the voltage of node 0 against 4 */
    struct dalcs_names measure_names; /* name -> place in measure */
    struct dalcs_measure_card *measure; /* heap */
    size_t n_measures;
    size_t measure_capacity;
    struct dalcs_print_card
        *print; /* heap; columns are in print_column, one card's after the other's */
    size_t n_prints, print_capacity;
    struct dalcs_print_column *print_column; /* heap */
    size_t n_print_columns, print_column_capacity;
    bool is_print;            /* the signals that are being read are those of the last card */
    const char *print_before; /* of the title of the next one */
    enum dalcs_signal_part print_part;
    bool noted_power;                   /* p(r1) has been passed over */
    struct dalcs_fourier_card *fourier; /* heap */
    size_t n_fouriers;
    size_t fourier_capacity;
    size_t n_switchlosses;
    const struct dalcs_token *switchloss; /* the first .switchloss, NULL before */
    bool noted_caret, noted_log;          /* in a formula */

    const struct dalcs_source_line *kept_line; /* the last line copied by keep_location */
    const char *kept_text;
    const struct dalcs_source *kept_source; /* the last file whose name was, */
    const char *kept_file;
    const struct dalcs_origin *kept_included; /* and how it was included */
    const struct dalcs_origin *kept_origin;   /* the last calls copied, */
    const struct dalcs_origin *kept_instance; /* and their copy */
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

/* ---- reader.c: walks over the tokens of one card --------------------------------------------- */

struct dalcs_reader {
    struct dalcs_builder *builder;
    const struct dalcs_card *card;
    int at;            /* the next token */
    const char *usage; /* "R1 a b value": the hint when the card's shape is wrong */
};

/* What a number stands for: decides which suffixes are probably meant otherwise. */
enum dalcs_quantity {
    DALCS_PLAIN,
    DALCS_OHM,
    DALCS_FARAD,
    DALCS_HENRY,
    DALCS_VOLTAGE,
    DALCS_CURRENT,
    DALCS_SECOND,
    DALCS_HERTZ
};

/* Starts after the card's first token. */
struct dalcs_reader dalcs_reader_start(struct dalcs_builder *builder, const struct dalcs_card *card,
                                       const char *usage);

/* The token `ahead` places from here, or NULL. */
const struct dalcs_token *dalcs_reader_peek(const struct dalcs_reader *reader, int ahead);

/* The last token read. */
const struct dalcs_token *dalcs_reader_previous(const struct dalcs_reader *reader);

bool dalcs_reader_at_end(const struct dalcs_reader *reader);

/* Takes the next token when it is this word or of this kind. */
bool dalcs_reader_take_word(struct dalcs_reader *reader, const char *word);
bool dalcs_reader_take(struct dalcs_reader *reader, enum dalcs_token_kind kind);

/* Takes `name =` and returns the name; NULL, nothing taken, when no parameter comes next. */
const struct dalcs_token *dalcs_reader_take_parameter(struct dalcs_reader *reader);

/* Does a token look like a number (it starts as one, or was an expression)? */
bool dalcs_reader_is_number(const struct dalcs_token *token);

/* The functions below report what is wrong and return false.
 *
 * A number; `what` ("a resistance") is for the message when it is missing. A list's numbers may have
 * commas between them; elsewhere 1,5 is an error. */
bool dalcs_reader_number(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                         const char *what, double *value);
bool dalcs_reader_list_number(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                              const char *what, double *value);

/* A number, or inf. */
bool dalcs_reader_number_or_infinity(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                                     const char *what, double *value);

/* The value of a parameter that means nothing: one token of any kind. */
bool dalcs_reader_skip_value(struct dalcs_reader *reader);

/* A name (any word). */
bool dalcs_reader_name(struct dalcs_reader *reader, const char *what,
                       const struct dalcs_token **name);

/* n nodes, made when new; parentheses around them are ignored. */
bool dalcs_reader_nodes(struct dalcs_reader *reader, int n, int *node /* [n] out */);

/* Nothing may follow. */
bool dalcs_reader_end(struct dalcs_reader *reader);

/* Reports that something is missing after the last token read. */
void dalcs_reader_missing(struct dalcs_reader *reader, const char *what);

/* Reports the next token as not understood. */
void dalcs_reader_unexpected(struct dalcs_reader *reader);
/* The hint for a unit that a blank parts from the number before it, as in "100 uF"; else `otherwise`. */
const char *dalcs_reader_unit_hint(const struct dalcs_reader *reader,
                                   const struct dalcs_token *token, const char *otherwise);

/* ---- One file per family; each takes a whole card -------------------------------------------- */

/* What limits a current, current_limit.c: A, INFINITY: nothing. */
struct dalcs_current_limits {
    double forward, reverse; /* from node[0] to node[1] inside the device, and back */
};

int dalcs_diode_ideal_model(struct dalcs_builder *builder);

bool dalcs_current_limit_is_name(const char *name);
/* The value behind the parameter; false when an error was reported. */
bool dalcs_current_limit_read(struct dalcs_reader *reader, const struct dalcs_token *name,
                              struct dalcs_current_limits *limits);
/* Puts them behind node[1] of the device, which becomes an inner one: two devices and a stimulus for each. */
void dalcs_current_limit_expand(struct dalcs_builder *builder, const struct dalcs_token *name,
                                struct dalcs_device *device,
                                const struct dalcs_current_limits *limits);
/* Makes a current source that takes at most its current and never delivers: an ideal diode in series with it and
 * one across both, two devices. Its current is then that of the first. */
void dalcs_current_limit_make_load(struct dalcs_builder *builder, const struct dalcs_token *name,
                                   struct dalcs_device *device);
/* The largest number of devices of a card. */
int dalcs_current_limit_count(const struct dalcs_card *card);

/* Rser, Lser, Rpar, Cpar, RLshunt of a card; zero-initialise. */
struct dalcs_parasitics {
    double value[5];
    const struct dalcs_token *place[5];
};

/* m= of the subcircuit calls around a card: parallel.c. 1: none */
double dalcs_parallel_of(const struct dalcs_card *card);
/* So many sources of a current in parallel. */
void dalcs_parallel_scale(struct dalcs_builder *builder, struct dalcs_stimulus *stimulus, double m);
/* Reports an element that cannot be multiplied; false where it can, or need not. */
bool dalcs_parallel_is_refused(struct dalcs_builder *builder, const struct dalcs_card *card);

/* The model D where no card has it, as LTspice writes it for a diode without a part: as without parameters. */
bool dalcs_diode_take_default(struct dalcs_builder *builder, const struct dalcs_token *name,
                              struct dalcs_diode_card *card, struct dalcs_diode_model *model);

bool dalcs_parasitic_is_name(const char *name);
/* The value, after `name =`; false when an error was reported. */
bool dalcs_parasitic_read(struct dalcs_reader *reader, const struct dalcs_token *name,
                          struct dalcs_parasitics *parasitics);
/* Those of m elements in parallel. */
void dalcs_parasitic_multiply(struct dalcs_parasitics *parasitics, double m);
/* Puts them around a device whose nodes are those of its card. */
void dalcs_parasitic_expand(struct dalcs_builder *builder, const struct dalcs_token *element,
                            struct dalcs_device *device, const struct dalcs_parasitics *parasitics);
bool dalcs_parasitic_has_rser(const struct dalcs_parasitics *parasitics);
/* Puts a resistor in series with a device that has its other parasitics. */
void dalcs_parasitic_add_rser(struct dalcs_builder *builder, const struct dalcs_token *element,
                              struct dalcs_device *device, double ohms);
/* Coils that have no Rser and that no K card names get LTspice's, where the netlist is told to be one of
 * LTspice. */
void dalcs_passive_add_default_rser(struct dalcs_builder *builder);
/* A resistor whose value is a formula of voltages and currents: V=i(itself)*formula. */
bool dalcs_behavioural_is_resistance(const struct dalcs_card *card);
void dalcs_behavioural_parse_resistance(struct dalcs_builder *builder,
                                        const struct dalcs_card *card);
void dalcs_passive_parse(struct dalcs_builder *builder, const struct dalcs_card *card,
                         enum dalcs_device_kind kind);
void dalcs_coupling_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* Coils that a K card names, at least 2. */
int dalcs_coupling_count_coils(const struct dalcs_card *card);
void dalcs_source_parse(struct dalcs_builder *builder, const struct dalcs_card *card,
                        enum dalcs_device_kind kind);
/* Checks that need .tran: a missing frequency, periods too short to resolve. */
void dalcs_source_check(struct dalcs_builder *builder);
void dalcs_stimulus_check(struct dalcs_builder *builder, const struct dalcs_token *name,
                          struct dalcs_stimulus *stimulus);
/* PULSE, SIN, ...: the function whose name is the next token, into *stimulus; false when an error
 * was reported. */
bool dalcs_waveform_card_is_name(const char *word);
bool dalcs_waveform_card_parse(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                               struct dalcs_stimulus *stimulus);
/* The same for what follows the word PWL. */
bool dalcs_pwl_card_parse(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                          struct dalcs_stimulus *stimulus);
/* AM and SFFM from the values of their cards, [5] and [7]; false when an error was reported. */
bool dalcs_modulation_set_am(struct dalcs_builder *builder, const double *value,
                             struct dalcs_stimulus *s);
bool dalcs_modulation_set_fm(struct dalcs_builder *builder, const struct dalcs_token *place,
                             const double *value, struct dalcs_stimulus *s);
/* LAPLACE, which comes next: of the controlling nodes, or of a formula that follows. */
void dalcs_transfer_parse(struct dalcs_reader *reader, struct dalcs_device *device,
                          bool has_control);
/* The same behind a B's formula, m alike in parallel. */
void dalcs_transfer_parse_behind(struct dalcs_reader *reader, struct dalcs_device *device,
                                 const struct dalcs_token *formula, double m);
void dalcs_controlled_parse(struct dalcs_builder *builder, const struct dalcs_card *card,
                            enum dalcs_device_kind kind);
/* LTspice's VARISTOR and MODULATE; false: another function. */
/* LTspice's OTA. */
void dalcs_transconductor_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_phase_detector_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* delay() in the formulas of a card: how many, and their sources when all formulas are compiled. */
size_t dalcs_delay_count(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_delay_resolve(struct dalcs_builder *builder);

bool dalcs_analog_function_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* After the word POLY, on a device that has its own nodes. */
void dalcs_poly_parse(struct dalcs_reader *reader, struct dalcs_device *device);
/* Room for the devices that a card's POLY becomes; one of them may be a source. */
size_t dalcs_poly_count(const struct dalcs_card *card);
/* Finds the V sources of all F, H and W, when all devices are known. */
void dalcs_controlled_resolve(struct dalcs_builder *builder);
/* B, and what follows the first two nodes of E and G: VALUE, TABLE. */
void dalcs_behavioural_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* The node whose voltage is the formula that comes next; -1 when an error was reported. */
int dalcs_behavioural_parse_control(struct dalcs_reader *reader, const struct dalcs_token *element);
/* The node whose voltage is a formula, of a source what(name). -1: out of memory. */
int dalcs_behavioural_add_readout(struct dalcs_builder *builder, const struct dalcs_token *formula,
                                  const char *what, const struct dalcs_token *name);
/* The output of a device with controlling nodes: a function of their voltage. */
void dalcs_behavioural_add_table(struct dalcs_builder *builder, const struct dalcs_device *device,
                                 const struct dalcs_piecewise *table);
/* The output of a device: a formula. */
void dalcs_behavioural_add_formula(struct dalcs_builder *builder, const struct dalcs_device *device,
                                   const struct dalcs_token *formula);
bool dalcs_behavioural_is_form(const struct dalcs_token *token);
void dalcs_behavioural_parse_form(struct dalcs_reader *reader, struct dalcs_device *device);
/* I with TBL, LTspice's: a current that is a table of the voltage across it. */
bool dalcs_behavioural_has_own_table(const struct dalcs_card *card);
void dalcs_behavioural_parse_own_table(struct dalcs_builder *builder,
                                       const struct dalcs_card *card);
/* Compiles all formulas, when all elements are known. */
void dalcs_behavioural_resolve(struct dalcs_builder *builder);
void dalcs_diode_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* An A card: a diode when its model is a sidiode. */
void dalcs_diode_parse_block(struct dalcs_builder *builder, const struct dalcs_card *card);
/* type: d or sidiode */
bool dalcs_diode_parse_model(struct dalcs_reader *reader, const struct dalcs_token *type,
                             struct dalcs_diode_card *card, struct dalcs_diode_model *model);
/* So many exponential diodes in series: one with as many times the voltage. */
void dalcs_diode_cells(struct dalcs_diode_card *card, double cells);
/* The lines of an exponential diode: its tangent at a current, for `area` of them in parallel. */
void dalcs_diode_model_map(const struct dalcs_diode_card *card, double current, double area,
                           struct dalcs_diode_model *model);
/* The same of a part that the table of diodes knows by this name, with a warning; false: it does not. */
bool dalcs_diode_take_part(struct dalcs_builder *builder, const struct dalcs_token *name,
                           struct dalcs_diode_card *card, struct dalcs_diode_model *model);
/* Thyristors, GTOs and triacs: an A card whose model is one. */
bool dalcs_thyristor_is(const struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_thyristor_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* NULL when an error was reported; the line that it conducts on into *valve. */
struct dalcs_thyristor *dalcs_thyristor_parse_model(struct dalcs_reader *reader,
                                                    const struct dalcs_token *type,
                                                    struct dalcs_diode_model *valve);
/* M, Z and Q elements. */
void dalcs_transistor_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* type: nmos, pmos, vdmos, nigbt, npn or pnp; NULL when an error was reported */
struct dalcs_transistor *dalcs_transistor_parse_model(struct dalcs_reader *reader,
                                                      const struct dalcs_token *name,
                                                      const struct dalcs_token *type);
/* Their resistances, when all elements are known; refuses those that are no switches. */
void dalcs_transistor_resolve(struct dalcs_builder *builder);
/* LTspice's gates and flip-flops, logic.c. */
void dalcs_logic_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* What their inputs read, when all outputs are known. */
void dalcs_logic_resolve(struct dalcs_builder *builder);
void dalcs_switch_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* type: sw, csw, vswitch or iswitch */
/* Its number; -1 when out of memory. */
int dalcs_switch_add_model(struct dalcs_builder *builder, const struct dalcs_switch_model *model);
bool dalcs_switch_parse_model(struct dalcs_reader *reader, const struct dalcs_token *type,
                              struct dalcs_switch_model *model);
void dalcs_model_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* Warnings about models that nothing here can use, when all elements are known. */
void dalcs_model_check(struct dalcs_builder *builder);

/* One parameter=value that a model may have. */
struct dalcs_parameter {
    const char *name;
    enum dalcs_quantity quantity;
    bool may_be_infinite;
    double value;                    /* its default, then what the card says */
    const struct dalcs_token *place; /* NULL: not on the card */
};

/* Reads all parameter=value of a model card. A name that is not among parameter[0..n-1] goes to
 * `unknown`, which may report it; it is called until it has reported one. */
bool dalcs_model_read_parameters(struct dalcs_reader *reader, struct dalcs_parameter *parameter,
                                 int n,
                                 bool (*unknown)(struct dalcs_reader *reader,
                                                 const struct dalcs_token *name));

/* The index (in diode_model or switch_model) of a model of this kind; else an error, and -1. */
int dalcs_model_find(struct dalcs_builder *builder, const struct dalcs_token *name,
                     enum dalcs_model_kind kind);
/* The same of a switch whose control is a formula, of a voltage or of a current. */
int dalcs_model_find_switch(struct dalcs_builder *builder, const struct dalcs_token *name);
/* Takes the name of a model of R, L or C (letter), if one follows: *taken is it, else it stays. False after an error. */
bool dalcs_model_take_passive(struct dalcs_reader *reader, char letter,
                              const struct dalcs_model **taken);
void dalcs_analysis_parse_env(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_analysis_parse_pss(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_analysis_parse_tran(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_analysis_parse_op(struct dalcs_builder *builder, const struct dalcs_card *card);
/* A second card of an analysis is an error. */
bool dalcs_analysis_is_first(struct dalcs_builder *builder, const struct dalcs_card *card,
                             const struct dalcs_token **first);
/* .dc, .ac and .step, when elements and models are known; then what they need of the whole. */
void dalcs_sweep_parse_dc(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_sweep_parse_ac(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_sweep_parse_step(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_sweep_check(struct dalcs_builder *builder);

/* Behind those before it; false after a message, or out of memory. */
bool dalcs_sweep_add_step(struct dalcs_builder *builder, const struct dalcs_card *card,
                          const struct dalcs_sweep *sweep);

void dalcs_monte_carlo_parse(struct dalcs_builder *builder, const struct dalcs_card *card);

/* The number behind seed=, which who expands the netlist has read: says what is wrong with it. */
bool dalcs_monte_carlo_read_seed(struct dalcs_reader *reader);

/* What was drawn, into the circuit. */
enum dalcs_status dalcs_monte_carlo_collect(struct dalcs_builder *builder) DALCS_MUST_CHECK;

/* worst_case_card.c: .wcase, the tolerances that it varies, and checks of the rest of the netlist. */
void dalcs_worst_case_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
enum dalcs_status dalcs_worst_case_collect(struct dalcs_builder *builder) DALCS_MUST_CHECK;
void dalcs_worst_case_check(struct dalcs_builder *builder);

/* An element whose first letter is among `letters`, param name or model(field). False after a message. */
bool dalcs_sweep_read_item(struct dalcs_reader *reader, const char *letters,
                           struct dalcs_sweep *sweep);

/* .sens; and which values it is of, once all cards are read. */
void dalcs_sensitivity_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_sensitivity_check(struct dalcs_builder *builder);
void dalcs_options_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* v(node) at the start of a .tran, as by .ic. */
void dalcs_initial_hold(struct dalcs_builder *builder, const struct dalcs_token *place, int node,
                        double value);
void dalcs_initial_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* .nodeset: the same form, without an effect */
void dalcs_initial_parse_nodeset(struct dalcs_builder *builder, const struct dalcs_card *card);
/* Leaves out the initial voltages that sources contradict, with a warning. When all elements and .ic cards are read. */
void dalcs_initial_leave_held(struct dalcs_builder *builder);
/* A note about initial conditions that do not count without uic. */
void dalcs_initial_check(struct dalcs_builder *builder);
/* .save, .print, .plot and .probe */
void dalcs_signals_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_signals_add_default(struct dalcs_builder *builder);

/* The current of each element. */
void dalcs_signals_add_currents(struct dalcs_builder *builder);
/* The place of a signal that a formula names among builder->measured; -1 when out of memory. */
int dalcs_signals_measure(struct dalcs_builder *builder, struct dalcs_signal signal);

/* What a formula may hold. */
struct dalcs_signal_formula_rules {
    const char *variable;              /* "time", or what is swept */
    const char *no_signals;            /* why it may have none, for the message; NULL: it may */
    const struct dalcs_names *results; /* earlier measurements that it may use, or NULL */
};

/* Compiles token[0..n-1]; false when an error was reported. */
bool dalcs_signal_formula_compile(struct dalcs_builder *builder, const struct dalcs_token *token,
                                  int n, const struct dalcs_signal_formula_rules *rules,
                                  struct dalcs_signal_formula *formula);
/* left - right */
bool dalcs_signal_formula_difference(struct dalcs_builder *builder,
                                     const struct dalcs_signal_formula *left,
                                     const struct dalcs_signal_formula *right,
                                     struct dalcs_signal_formula *difference);
/* A formula as a column of results; false: it has no steps as measurements have them, or an error was reported. */
bool dalcs_computed_compile(struct dalcs_builder *builder, const struct dalcs_formula *f,
                            struct dalcs_signal_formula *formula);
/* Voltage times current of a device with two terminals; false: out of memory. */
bool dalcs_computed_power(struct dalcs_builder *builder, int device,
                          struct dalcs_signal_formula *formula);
/* Is its power determined by one voltage and one current? */
bool dalcs_signal_formula_has_power(const struct dalcs_builder *builder, int device);
void dalcs_measure_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_losses_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_switchloss_count(struct dalcs_builder *builder, const struct dalcs_card *card);
/* Reads .losses, or the command line's, once all devices are known. */
void dalcs_losses_collect(struct dalcs_builder *builder);
void dalcs_switchloss_collect(struct dalcs_builder *builder);
void dalcs_fourier_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* What formulas name: a signal that is recorded anyway, or one more behind those. */
enum dalcs_status dalcs_measured_collect(struct dalcs_builder *builder) DALCS_MUST_CHECK;
/* Warnings about the whole network. */
void dalcs_topology_check(struct dalcs_builder *builder);

/* Makes resistors of the controlled sources that are resistors; after all checks. */
void dalcs_own_resistance_replace(struct dalcs_builder *builder);

#endif

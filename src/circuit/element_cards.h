/* element_cards.h - the cards of elements, one file per family; each takes a whole card.
 * Private to this folder and to equations/, whose system files are made of the same cards. */
#ifndef DALCS_ELEMENT_CARDS_H
#define DALCS_ELEMENT_CARDS_H

#include "reader.h"

/* ---- R, L and C, their parasitics and couplings ---- */

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
/* Makes resistors of the controlled sources that are resistors; after all checks. */
void dalcs_own_resistance_replace(struct dalcs_builder *builder);

/* ---- V and I, their functions, what limits them ---- */

/* What limits a current, current_limit.c: A, INFINITY: nothing. */
struct dalcs_current_limits {
    double forward, reverse; /* from node[0] to node[1] inside the device, and back */
};

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

/* ---- E, F, G, H and B ---- */

/* LAPLACE, which comes next: of the controlling nodes, or of a formula that follows. */
void dalcs_transfer_parse(struct dalcs_reader *reader, struct dalcs_device *device,
                          bool has_control);
/* The same behind a B's formula, m alike in parallel. */
void dalcs_transfer_parse_behind(struct dalcs_reader *reader, struct dalcs_device *device,
                                 const struct dalcs_token *formula, double m);
void dalcs_controlled_parse(struct dalcs_builder *builder, const struct dalcs_card *card,
                            enum dalcs_device_kind kind);
/* delay() in the formulas of a card: how many, and their sources when all formulas are compiled. */
size_t dalcs_delay_count(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_delay_resolve(struct dalcs_builder *builder);
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

/* ---- Diodes, switches, thyristors, transistors ---- */

void dalcs_diode_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* An A card: a diode when its model is a sidiode. */
void dalcs_diode_parse_block(struct dalcs_builder *builder, const struct dalcs_card *card);
/* Thyristors, GTOs and triacs: an A card whose model is one. */
bool dalcs_thyristor_is(const struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_thyristor_parse(struct dalcs_builder *builder, const struct dalcs_card *card);

/* M, Z and Q elements. */
void dalcs_transistor_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* Their resistances, when all elements are known; refuses those that are no switches. */
void dalcs_transistor_resolve(struct dalcs_builder *builder);
void dalcs_switch_parse(struct dalcs_builder *builder, const struct dalcs_card *card);

/* ---- Blocks and gates ---- */

/* LTspice's OTA. */
void dalcs_transconductor_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* LTspice's PHASEDET. */
void dalcs_phase_detector_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* LTspice's VARISTOR and MODULATE; false: another function. */
bool dalcs_analog_function_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* LTspice's gates and flip-flops, logic.c. */
void dalcs_logic_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* What their inputs read, when all outputs are known. */
void dalcs_logic_resolve(struct dalcs_builder *builder);

/* ---- The whole network ---- */

/* Warnings about the whole network. */
void dalcs_topology_check(struct dalcs_builder *builder);
/* Warnings about controls that move and never switch anything. */
void dalcs_threshold_check(struct dalcs_builder *builder);

#endif

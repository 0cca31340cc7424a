/* analysis_cards.h - the cards of analyses, sweeps, options and initial conditions.
 * Private to this folder and to equations/, whose system files are made of the same cards. */
#ifndef DALCS_ANALYSIS_CARDS_H
#define DALCS_ANALYSIS_CARDS_H

#include "reader.h"

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
/* .tf, when elements are known; room for its source is the card table's. */
void dalcs_transfer_card_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_options_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* v(node) at the start of a .tran, as by .ic. */
void dalcs_initial_hold(struct dalcs_builder *builder, const struct dalcs_token *place,
                        const int *node, double value);
void dalcs_initial_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
/* .nodeset: the same form, without an effect */
void dalcs_initial_parse_nodeset(struct dalcs_builder *builder, const struct dalcs_card *card);
/* Leaves out the initial voltages that sources contradict, with a warning. When all elements and .ic cards are read. */
void dalcs_initial_leave_held(struct dalcs_builder *builder);
/* A note about initial conditions that do not count without uic. */
void dalcs_initial_check(struct dalcs_builder *builder);

#endif

/* result_cards.h - the cards of what is recorded, measured and summed up.
 * Private to this folder and to equations/, whose system files are made of the same cards. */
#ifndef DALCS_RESULT_CARDS_H
#define DALCS_RESULT_CARDS_H

#include "reader.h"

/* .save, .print, .plot and .probe */
void dalcs_signals_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
void dalcs_signals_add_default(struct dalcs_builder *builder);
/* The current of each element. */
void dalcs_signals_add_currents(struct dalcs_builder *builder);
/* The place of a signal that a formula names among builder->signals.measured; -1 when out of memory. */
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

#endif

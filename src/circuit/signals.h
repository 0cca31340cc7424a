/* signals.h - what the cards that name signals share. */
#ifndef DALCS_SIGNALS_H
#define DALCS_SIGNALS_H

#include "reader.h"

#define DALCS_SIGNALS_USAGE "signals are: v(node) v(a,b) i(element) all"

/* A column of the .print that is being read. */
void dalcs_signals_add_column(struct dalcs_builder *builder, const char *name);

/* Adds a signal; `name` is in the circuit's arena or NULL when memory ran out. */
void dalcs_signals_add(struct dalcs_builder *builder, const char *name, struct dalcs_signal signal);
void dalcs_signals_add_voltage(struct dalcs_builder *builder, int a, int b, bool is_pair);
void dalcs_signals_add_voltages(struct dalcs_builder *builder);
void dalcs_signals_add_current(struct dalcs_builder *builder, int device);

/* w(r1) or p(r1), of an element that has one; those of all elements that have one: ngspice's allp, PSpice's w(alias(*)). */
void dalcs_signals_add_power(struct dalcs_builder *builder, char letter, int device);
void dalcs_signals_add_powers(struct dalcs_builder *builder, char letter);
/* Said once: which powers are not recorded. */
void dalcs_signals_note_power(struct dalcs_builder *builder, const struct dalcs_token *token,
                              const char *argument);

/* What stands next: false, and nothing was read, if it has another form. */
bool dalcs_signals_is_formula(const struct dalcs_reader *reader);
bool dalcs_signals_read_formula(struct dalcs_reader *reader);
bool dalcs_signals_read_all_of(struct dalcs_reader *reader);
bool dalcs_signals_read_power(struct dalcs_reader *reader);

/* The next signal of a card; false when an error was reported. */
bool dalcs_signals_read(struct dalcs_reader *reader);

/* .probe, .probe64, .probe/csdf */
bool dalcs_signals_is_probe(const struct dalcs_card *card);

#endif

/* measure_reading.h - the parts of a .meas card. Private to this folder. */
#ifndef DALCS_MEASURE_READING_H
#define DALCS_MEASURE_READING_H

#include "reader.h"
#include "result_cards.h"

/* A .meas card being read. */
struct dalcs_measure_reading {
    struct dalcs_builder *builder;
    const struct dalcs_card *card;
    struct dalcs_reader reader;
    struct dalcs_measure_card *measure;
    struct dalcs_signal_formula_rules rules;
};

/* The end of the formula that starts at token k: a keyword, or, if asked for, an equal sign. */
int dalcs_measure_formula_end(const struct dalcs_card *card, int k, bool at_equal);

/* A formula of signals up to token `end`; false after a message. */
bool dalcs_measure_read_formula(struct dalcs_measure_reading *r, bool at_equal, const char *what,
                                const struct dalcs_signal_formula_rules *rules,
                                struct dalcs_signal_formula *formula);

/* A value that is known before the run. */
bool dalcs_measure_read_constant(struct dalcs_measure_reading *r, const char *what, double *value);

/* A time that is known before the run, or else computed from earlier measurements. */
bool dalcs_measure_read_time(struct dalcs_measure_reading *r, double *time,
                             struct dalcs_signal_formula *later);

/* Takes a keyword and its equal sign, if this one comes next. */
bool dalcs_measure_take(struct dalcs_measure_reading *r, const char *word);

/* v(out)=2.5, v(a)=v(b), or v(out) VAL=2.5, and which of the crossings. */
bool dalcs_measure_read_condition(struct dalcs_measure_reading *r,
                                  struct dalcs_measure_instant *instant);

/* AT=time, or a condition. */
bool dalcs_measure_read_instant(struct dalcs_measure_reading *r,
                                struct dalcs_measure_instant *instant);

/* A card with a mistake costs its own result alone, as in LTspice and ngspice: the errors behind the mark become
 * warnings, and the measurement is reported as one that failed. */
void dalcs_measure_give_up(struct dalcs_measure_reading *r, const struct dalcs_diag_mark *mark);

#endif

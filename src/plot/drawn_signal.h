/* drawn_signal.h - what is drawn: a signal of the file or an expression of several, v(out)*i(r1).
 *
 *   sum     = product {("+" | "-") product}
 *   product = factor {("*" | "/") factor}
 *   factor  = ["-" | "+"] (number | "(" sum ")" | function "(" sum ")" | name)
 *
 * Functions are abs, sqrt and db, 20 log10 |x|. A name is one of the file, in any case; v(a,b) may be
 * worked out of v(a) and v(b), and i(d1) is also @d1[id] and v1#branch of ngspice. */
#ifndef DALCS_DRAWN_SIGNAL_H
#define DALCS_DRAWN_SIGNAL_H

#include "waveforms.h"

struct dalcs_signal {
    const char *text; /* as it was typed, without blanks; in the arena */
    struct dalcs_dimension dimension;
    const struct dalcs_signal_node *root;
};

/* DALCS_E_OPTION comes with a message that names the nearest signal. */
enum dalcs_status dalcs_signal_parse(struct dalcs_signal *signal,
                                     const struct dalcs_waveforms *waveforms, const char *text,
                                     struct dalcs_arena *arena,
                                     struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* Column `column` as it is. */
enum dalcs_status dalcs_signal_of_column(struct dalcs_signal *signal,
                                         const struct dalcs_waveforms *waveforms, size_t column,
                                         struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* row is [n_columns] of the table that the signal was parsed for. */
double dalcs_signal_value(const struct dalcs_signal *signal, const double *row);

/* The column of a name, or -1. */
long dalcs_signal_find_column(const struct dalcs_waveforms *waveforms, const char *name);

#endif

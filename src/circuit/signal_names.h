/* signal_names.h - where a signal's name begins in the text of a formula: v(a), im(v(a)), @r1[i]. */
#ifndef DALCS_SIGNAL_NAMES_H
#define DALCS_SIGNAL_NAMES_H

#include "measurement.h"

bool dalcs_signal_is_name_byte(char c);

/* "v(", "im(", ...: the bytes before the parenthesis, 0 when no signal starts at t. */
int dalcs_signal_prefix(const char *t, enum dalcs_signal_part *part);

/* @r1[i] or @d1[id] at t: how long it is; 0: something else. */
int dalcs_signal_device_current(const char *t);

/* mag(v(out)) and the like of .ac: the bytes before the signal, 0 when no such function starts at t. */
int dalcs_signal_part_function(const char *t, enum dalcs_signal_part *part);

#endif

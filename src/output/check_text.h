/* check_text.h - what theory says of a netlist, for a person. */
#ifndef DALCS_CHECK_TEXT_H
#define DALCS_CHECK_TEXT_H

#include "dalcs.h"

#include <stdio.h>

/* The summary in plain words, then the verdicts with their sources; with `all` every condition and
 * every witness too. Errors stay in the stream. */
void dalcs_check_write_text(FILE *stream, const struct dalcs_check *check, bool all);

#endif

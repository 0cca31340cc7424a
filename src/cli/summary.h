/* summary.h - what a person reads after a run. */
#ifndef DALCS_SUMMARY_H
#define DALCS_SUMMARY_H

#include "measure.h"

#include <stdio.h>

/* What is rounding, over the largest value of its kind. */
#define DALCS_SUMMARY_INVISIBLE 1e-12

/* Title, size, work, certificate; three or four lines. */
void dalcs_summary_write_run(FILE *out, const struct dalcs_report *report);

/* Where .ac keeps diodes and switches; nothing without .ac. */
void dalcs_summary_write_sides(FILE *out, const struct dalcs_report *report);

/* A table, of the first 24 signals or of all; nothing when there were no rows. */
void dalcs_summary_write_signals(FILE *out, const struct dalcs_measure *measure,
                                 const struct dalcs_report *report, bool all);

/* Likewise, of rows with no averages: where they end. */
void dalcs_summary_write_ends(FILE *out, const struct dalcs_measure *measure, bool all);

/* The first few jumps, a sentence each. */
void dalcs_summary_write_jumps(FILE *out, const struct dalcs_report *report);

/* Where the energy came from and went, entries of 0 left out; nothing without a ledger. */
void dalcs_summary_write_energy(FILE *out, const struct dalcs_report *report);

#endif

/* motion.h - motions of the whole circuit as witnesses, and who gives the energy for them. */
#ifndef DALCS_MOTION_H
#define DALCS_MOTION_H

#include "findings.h"
#include "modes.h"
#include "passivity.h"
#include "power.h"

/* All columns of the system, pairs (re, im), in `giving`. */
enum dalcs_status dalcs_motion_columns(const struct dalcs_lcs *lcs,
                                       const struct dalcs_giving *giving, double **y,
                                       struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* Adds to the verdict added last the motion y exp(s t): "mode" (diodes that are on, s), "eigenvector" or
 * "motion" (the columns), and, when power is not NULL, "powers": what each element gives, most first;
 * the elements that give are the verdict's. is_on[m] may be NULL. */
enum dalcs_status dalcs_motion_witness(struct dalcs_findings *f, const struct dalcs_blocks *b,
                                       const double *s, const bool *is_on, const double *y,
                                       const struct dalcs_power *power) DALCS_MUST_CHECK;

/* "d1 and d2 on", "all diodes off", "all diodes on" */
const char *dalcs_mode_text(const struct dalcs_blocks *b, const bool *is_on,
                            struct dalcs_arena *arena);

#endif

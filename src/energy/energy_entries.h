/* energy_entries.h - what is entered in the ledger of energies. Private to this folder. */
#ifndef DALCS_ENERGY_ENTRIES_H
#define DALCS_ENERGY_ENTRIES_H

#include "energy.h"

/* Adds joules to an account and to the turnover. */
void dalcs_energy_enter(struct dalcs_energy *energy, enum dalcs_power_account account,
                        double joule);

/* The energy exchanged by capacitors and coils, and its rounding: a segment that
 * is cut is a small part of a step, whose other end may be far away. Returns 1/2 |after - x|^2 by the
 * diagonal of the storage. */
double dalcs_energy_enter_swing(struct dalcs_energy *energy, const struct dalcs_energy_part *part,
                                const double *x, const double *after, const double *far);

/* One step of implicit Euler: see observer.h. */
void dalcs_energy_step(void *energy, int k, const double *x, const double *y, const double *inputs,
                       double h);

/* Adds the powers of a part in an answer, over h (s), to accounts and turnover. */
void dalcs_energy_add_powers(const struct dalcs_energy_part *part, const double *y,
                             const double *inputs, double h, double *account, double *turnover);

/* An answer counts for what its columns are at most. */
void dalcs_energy_raise_columns(const struct dalcs_energy_part *part, const double *y);

/* What a part of radau tries by implicit Euler: see observer.h. Nothing is entered before the segment is passed through. */
void dalcs_energy_try(void *energy, int k);
void dalcs_energy_try_step(void *energy, int k, const double *x, const double *y,
                           const struct dalcs_observed_sides *sides, const double *inputs);

/* Enters it. */
void dalcs_energy_enter_tried(struct dalcs_energy *energy, const struct dalcs_radau_part *part,
                              const double *start);

/* The present segment of a part of radau, likewise. */
void dalcs_energy_segment(void *energy, const struct dalcs_radau_part *part, const double *start);

/* Enters, from 0 to stop, the powers of the part whose columns the sources decide: the terms from
 * n_stepped on. */
enum dalcs_status dalcs_energy_enter_decided(struct dalcs_energy *energy,
                                             const struct dalcs_energy_part *part,
                                             struct dalcs_component *c,
                                             const struct dalcs_bystanders *b,
                                             double stop) DALCS_MUST_CHECK;

/* The same of a part of smooth functions, which has neither states nor pairs. */
enum dalcs_status dalcs_energy_enter_bent(struct dalcs_energy *energy,
                                          const struct dalcs_energy_part *part,
                                          struct dalcs_component *c, double stop) DALCS_MUST_CHECK;

/* Sets every call of the observer but `user`. */
void dalcs_energy_observe(struct dalcs_observer *observer);

#endif

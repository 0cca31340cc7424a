/* decided_energy.h - the part of the ledger that needs no steps. Private to energy.c. */
#ifndef DALCS_DECIDED_ENERGY_H
#define DALCS_DECIDED_ENERGY_H

#include "energy.h"

/* Adds joules to an account and to the turnover. */
void dalcs_energy_enter(struct dalcs_energy *energy, enum dalcs_power_account account,
                        double joule);

/* Enters, from 0 to stop, the powers of the part whose columns the sources decide: the terms from
 * n_stepped on. */
enum dalcs_status dalcs_energy_enter_decided(struct dalcs_energy *energy,
                                             const struct dalcs_energy_part *part,
                                             struct dalcs_component *c,
                                             const struct dalcs_bystanders *b,
                                             double stop) DALCS_MUST_CHECK;

#endif

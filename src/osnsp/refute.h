/* refute.h - is it certain that a problem has no answer? Asked after a refusal, of the system's own blocks. */
#ifndef DALCS_REFUTE_H
#define DALCS_REFUTE_H

#include "osnsp.h"

/* At sigma and u, where p has just found no answer and p->witness says why. *is_certain: a contradiction was found that
 * the system's own blocks confirm, for each position of the switches that the circuit itself moves and, where the
 * circuit is not passive, for all sides of all diodes. What runs away like the derivative of an impulse is confirmed by
 * steps of many lengths; p solves again then, and p->witness may change. */
enum dalcs_status dalcs_osnsp_refute(struct dalcs_osnsp *p, double sigma, const double *u,
                                     bool *is_certain) DALCS_MUST_CHECK;

/* The same, of nothing but the ray that p->witness has and the equations without signs. */
enum dalcs_status dalcs_refute_at_once(struct dalcs_osnsp *p, double sigma, const double *u,
                                       bool *is_certain) DALCS_MUST_CHECK;

#endif

/* in_order.h - a problem solved block by block, in the order in which its parts act on each other (partition.h).
 *
 * A block sees what earlier ones have found as inputs. Each that is monotone is decided by a theorem (Cottle, Pang
 * and Stone 1992, thm 3.1.2), so what only reads changes nothing of what it reads. The whole answer is
 * certified on the whole system, as any other. */
#ifndef DALCS_IN_ORDER_H
#define DALCS_IN_ORDER_H

#include "osnsp_internal.h"
#include "partition.h"

/* Makes the systems of the blocks. DALCS_NOT_CONVERGED: the system has none that can be solved one after the
 * other. */
enum dalcs_status dalcs_in_order_build(struct dalcs_osnsp *p) DALCS_MUST_CHECK;

/* As dalcs_osnsp_solve(), from the sides in p->mode. DALCS_INFEASIBLE: the first block without an answer has
 * left its witness in p->witness. */
enum dalcs_status dalcs_in_order_solve(struct dalcs_osnsp *p, double sigma, const double *u,
                                       double *y) DALCS_MUST_CHECK;

void dalcs_in_order_finish(struct dalcs_osnsp *p);

#endif

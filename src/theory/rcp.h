/* rcp.h - conditions of Heemels, Schumacher and Weiland 1999 on M(s) = D + C (s I - A)^-1 B. */
#ifndef DALCS_RCP_H
#define DALCS_RCP_H

#include "findings.h"
#include "modes.h"

/* Adds the conditions on M: definite at 1/h, for every s where A = 0, a P-matrix for large s, and which
 * impulses a start may cause. modes may be unchecked. *is_monotone: every step is, and B u is unique. */
enum dalcs_status dalcs_rcp_check(struct dalcs_findings *f, const struct dalcs_lcs *lcs,
                                  const struct dalcs_modes *modes, double h, bool is_passive,
                                  bool *is_monotone) DALCS_MUST_CHECK;

#endif

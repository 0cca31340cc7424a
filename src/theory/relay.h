/* relay.h - pairs that are a relay or another law with two ends, -lambda in the normal cone of [0, H], as
 * the theorems on relay systems take them: one multiplier in a box instead of two pairs.
 *
 * A box is two pairs, 0 <= u _|_ w + c v >= 0 and 0 <= v _|_ H - c u >= 0, or, with w and u
 * exchanged where w depends on u, two pairs whose y have a constant sum. M(s) of such pairs is never a P-matrix ((43) of
 * Heemels, Schumacher and Weiland 1999); the G(s) from u to w of the boxes and of the other pairs decides. */
#ifndef DALCS_RELAY_H
#define DALCS_RELAY_H

#include "findings.h"
#include "modes.h"

struct dalcs_relays {
    int n;           /* boxes found */
    bool is_all;     /* there is no other pair */
    bool is_P;       /* G(s) is a P-matrix for all large s */
    bool is_coupled; /* P B = C' and D + D' >= 0 of G */
};

/* Adds the conditions on G where there is a box; modes may be unchecked. */
enum dalcs_status dalcs_relay_check(struct dalcs_findings *f, const struct dalcs_lcs *lcs,
                                    const struct dalcs_modes *modes,
                                    struct dalcs_relays *found) DALCS_MUST_CHECK;

#endif

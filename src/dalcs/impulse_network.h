/* impulse_network.h - the elements of a circuit that matter in a jump.
 *
 * A jump is the limit of a vanishing step (Heemels, Schumacher and Weiland 1999, thm 4.1): impulses
 * of current move charge between capacitors, impulses of voltage move flux between coils. A resistor
 * with an impulse of either kind would dissipate without bound, so that in a passive circuit the two
 * are separate problems, each without time:
 *
 *   charge   capacitors, V sources, ideal diodes, closed ideal switches and ideal transformers; the
 *            rest lets no charge pass in no time. The voltages after the jump are the nearest, in the energy of the
 *            capacitors, that some mode allows; lambda is the charge through a diode.
 *   flux     coils, I sources, diodes without a leak and open ideal switches; the rest joins its
 *            nodes, for no flux builds up across it. The currents after the jump are the nearest
 *            that some mode allows; w is the flux across a diode.
 *
 * That the voltages and the currents so found go together is Minty's theorem on monotone networks
 * (G. J. Minty, Proc. R. Soc. A 257, 1960). Each problem is an OSNSP at sigma = 1. */
#ifndef DALCS_IMPULSE_NETWORK_H
#define DALCS_IMPULSE_NETWORK_H

#include "network.h"

enum dalcs_impulse_kind { DALCS_IMPULSE_CHARGE, DALCS_IMPULSE_FLUX, DALCS_N_IMPULSES };

struct dalcs_impulse_network {
    struct dalcs_circuit circuit; /* its signals: i and v of V sources, or v and i of I sources */
    struct dalcs_network network;
};

/* Builds *impulse of `circuit`, which must outlive it: devices keep their names, but the reverse branch
 * of a diode is a diode of its own with the name that dalcs_breakdown_name gives it. On failure
 * *impulse is zeroed. */
enum dalcs_status dalcs_impulse_network_build(struct dalcs_impulse_network *impulse,
                                              const struct dalcs_circuit *circuit,
                                              enum dalcs_impulse_kind kind) DALCS_MUST_CHECK;

void dalcs_impulse_network_finish(struct dalcs_impulse_network *impulse);

/* is_transformer[n_devices], zeroed by the caller: coils that perfect couplings, |k| = 1, join with
 * others, directly or through their partners. */
void dalcs_mark_transformers(const struct dalcs_circuit *circuit, bool *is_transformer);

/* "d1 breakdown", in the arena; NULL without memory. */
const char *dalcs_breakdown_name(struct dalcs_arena *arena, const char *diode);

#endif

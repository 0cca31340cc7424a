/* losses_jump.c - who gives and who takes the energy of a jump.
 *
 * Charges obey Kirchhoff's current law and fluxes his voltage law, so those of sources follow from those
 * of the rest. A source gives its charge at the voltage just after, as in the ledger (energy.h); a diode
 * takes its threshold times its charge. What the states lose besides is taken by the switches and diodes
 * that carry the impulses: where no source jumps it is the sum over them of charge times half the
 * voltage that collapses (Tellegen's theorem at the mean of both sides), and they share it like that. */
#include "losses_sum.h"

#include <math.h>
#include <string.h>

/* The energies of sources: charges at the voltage, fluxes at the current just after. */
static void give_charges(const struct dalcs_losses_sum *sum) {
    const struct dalcs_circuit *c = sum->circuit;
    const double *charge = sum->impulses->charge;
    for (int k = 0; k < c->n_devices; k++) {
        if (dalcs_holds_voltage(&c->device[k]) && !isnan(charge[k])) {
            sum->device[k].jump += charge[k] * sum->device[k].now[0];
        }
    }
}

static void give_fluxes(const struct dalcs_losses_sum *sum) {
    const struct dalcs_circuit *c = sum->circuit;
    for (int k = 0; k < c->n_devices; k++) {
        const struct dalcs_device *d = &c->device[k];
        const double flux = sum->impulses->node[d->node[0]] - sum->impulses->node[d->node[1]];
        if (dalcs_holds_current(d) && !isnan(flux)) {
            sum->device[k].jump += flux * sum->device[k].now[1];
        }
    }
}

/* What collapses times what passes; without a collapse what passes alone. */
static double weight_of(const struct dalcs_losses_sum *sum, const struct dalcs_loss_impulse *i,
                        bool by_collapse) {
    const struct dalcs_loss *d = &sum->device[i->device];
    double volt = by_collapse ? fabs(d->now[0] - d->last[0]) : 1.0;
    double ampere = by_collapse ? fabs(d->now[1] - d->last[1]) : 1.0;
    return fabs(i->charge) * volt + fabs(i->flux) * ampere;
}

static void share_loss(struct dalcs_losses_sum *sum, const struct dalcs_loss_jump *jump) {
    double total = 0.0;
    bool by_collapse = true;
    for (int round = 0; round < 2 && !(total > 0.0); round++) {
        by_collapse = round == 0;
        total = 0.0;
        for (int k = 0; k < jump->n; k++) {
            total += weight_of(sum, &jump->impulse[k], by_collapse);
        }
    }
    if (!(total > 0.0)) {
        sum->loops += jump->energy_lost;
        return;
    }
    for (int k = 0; k < jump->n; k++) {
        double part = weight_of(sum, &jump->impulse[k], by_collapse) / total;
        sum->device[jump->impulse[k].device].jump += part * jump->energy_lost;
    }
}

void dalcs_losses_sum_take_jumps(struct dalcs_losses_sum *sum) {
    bool in_steps = false;
    for (int j = 0; j < sum->n_jumps; j++) {
        const struct dalcs_loss_jump *jump = &sum->jump[j];
        share_loss(sum, jump);
        in_steps = in_steps || jump->is_in_steps;
        for (int k = 0; k < jump->n && !jump->is_in_steps; k++) {
            sum->device[jump->impulse[k].device].jump += jump->impulse[k].in_thresholds;
        }
    }
    if (in_steps || sum->impulses == NULL) {
        return;
    }
    give_charges(sum);
    give_fluxes(sum);
}

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

/* Does an impulse of voltage come to an end of it? */
static bool is_struck(const struct dalcs_losses_sum *sum, int k) {
    const int *node = sum->circuit->device[k].node;
    return sum->impulses->node[node[0]] != 0.0 || sum->impulses->node[node[1]] != 0.0;
}

/* What a source passes while its voltage or its current goes from one side to the other is at the mean of both: an impulse
 * that it puts out of what it reads, and what passes one whose own quantity is of what the jump moves. Where other sources say
 * what that is, their jump comes first. */
static bool follows(const struct dalcs_losses_sum *sum, int k, bool is_flux) {
    const struct dalcs_device *d = &sum->circuit->device[k];
    const bool holds = is_flux ? dalcs_holds_current(d) : dalcs_holds_voltage(d);
    if (d->behaviour != NULL) {
        return !holds;
    }
    if (is_flux) {
        return !holds || (d->kind == DALCS_CCCS && is_struck(sum, d->control));
    }
    return (d->kind == DALCS_VCVS || !holds) && !dalcs_impulses_is_held(sum->impulses, k);
}

/* The energies of sources: charges at the voltage, fluxes at the current just after, or at the mean. Returns what that takes
 * from the losses. */
static double give(const struct dalcs_losses_sum *sum) {
    const struct dalcs_circuit *c = sum->circuit;
    double less = 0.0;
    for (int k = 0; k < c->n_devices; k++) {
        const struct dalcs_device *device = &c->device[k];
        struct dalcs_loss *d = &sum->device[k];
        const bool holds = dalcs_holds_voltage(device) || dalcs_holds_current(device);
        const double passed[2] = {sum->impulses->charge[k],
                                  sum->impulses->node[device->node[0]] -
                                      sum->impulses->node[device->node[1]]};
        for (int i = 0; i < 2 && holds; i++) {
            const double driven = isnan(passed[i]) || !follows(sum, k, i == 1)
                                      ? 0.0
                                      : 0.5 * passed[i] * (d->now[i] - d->last[i]);
            d->jump += isnan(passed[i]) ? 0.0 : passed[i] * d->now[i] - driven;
            less -= driven;
        }
    }
    return less;
}

/* What collapses times what passes; without a collapse what passes alone. */
static double weight_of(const struct dalcs_losses_sum *sum, const struct dalcs_loss_impulse *i,
                        bool by_collapse) {
    const struct dalcs_loss *d = &sum->device[i->device];
    double volt = by_collapse ? fabs(d->now[0] - d->last[0]) : 1.0;
    double ampere = by_collapse ? fabs(d->now[1] - d->last[1]) : 1.0;
    return fabs(i->charge) * volt + fabs(i->flux) * ampere;
}

static void share_loss(struct dalcs_losses_sum *sum, const struct dalcs_loss_jump *jump,
                       double lost) {
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
        sum->loops += lost;
        return;
    }
    for (int k = 0; k < jump->n; k++) {
        double part = weight_of(sum, &jump->impulse[k], by_collapse) / total;
        sum->device[jump->impulse[k].device].jump += part * lost;
    }
}

void dalcs_losses_sum_take_jumps(struct dalcs_losses_sum *sum) {
    const bool in_steps = sum->jump[0].is_in_steps;
    double less = in_steps || sum->impulses == NULL ? 0.0 : give(sum);
    int largest = 0;
    for (int j = 1; j < sum->n_jumps; j++) {
        largest = sum->jump[j].energy_lost > sum->jump[largest].energy_lost ? j : largest;
    }
    for (int j = 0; j < sum->n_jumps; j++) {
        const struct dalcs_loss_jump *jump = &sum->jump[j];
        share_loss(sum, jump, jump->energy_lost - (j == largest ? less : 0.0));
        for (int k = 0; k < jump->n && !in_steps; k++) {
            sum->device[jump->impulse[k].device].jump += jump->impulse[k].in_thresholds;
        }
    }
}

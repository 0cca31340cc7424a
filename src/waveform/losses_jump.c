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

/* Does it hold its voltage, so that any charge may pass? */
static bool holds_voltage(const struct dalcs_device *d) {
    return d->kind == DALCS_VSOURCE || d->kind == DALCS_VCVS || d->kind == DALCS_CCVS ||
           dalcs_device_is_short(d);
}

static bool holds_current(const struct dalcs_device *d) {
    return d->kind == DALCS_ISOURCE || d->kind == DALCS_VCCS || d->kind == DALCS_CCCS;
}

/* impulse[], the charges, so far of switches and diodes: those of capacitors, and by KCL those of what
 * holds a voltage, again and again where one of them alone is left at a node. Their graph is a forest, apart
 * from wires in loops, whose charges have no effect. */
static void solve_charges(const struct dalcs_losses_sum *sum) {
    const struct dalcs_circuit *c = sum->circuit;
    bool moves = true;
    memset(sum->node, 0, (size_t)c->n_nodes * sizeof(double));
    memset(sum->n_open, 0, (size_t)c->n_nodes * sizeof(int));
    for (int k = 0; k < c->n_devices; k++) {
        const struct dalcs_device *d = &c->device[k];
        if (holds_voltage(d)) {
            sum->impulse[k] = NAN; /* not known yet */
            sum->n_open[d->node[0]]++;
            sum->n_open[d->node[1]]++;
            continue;
        }
        if (d->kind == DALCS_CAPACITOR) {
            sum->impulse[k] = d->value * (sum->device[k].now[0] - sum->device[k].last[0]);
        }
        sum->node[d->node[0]] += sum->impulse[k];
        sum->node[d->node[1]] -= sum->impulse[k];
    }
    while (moves) {
        moves = false;
        for (int k = 0; k < c->n_devices; k++) {
            const int *node = c->device[k].node;
            for (int side = 0; side < 2 && isnan(sum->impulse[k]); side++) {
                if (sum->n_open[node[side]] != 1) {
                    continue;
                }
                double q = (side == 0 ? -1.0 : 1.0) * sum->node[node[side]];
                sum->impulse[k] = q;
                sum->node[node[0]] += q;
                sum->node[node[1]] -= q;
                sum->n_open[node[0]]--;
                sum->n_open[node[1]]--;
                moves = true;
            }
        }
    }
}

static double coil_flux(const struct dalcs_losses_sum *sum, int k) {
    const struct dalcs_circuit *c = sum->circuit;
    double flux = c->device[k].value * (sum->device[k].now[1] - sum->device[k].last[1]);
    for (int j = 0; j < c->n_couplings; j++) {
        const struct dalcs_coupling *m = &c->coupling[j];
        if (m->inductor[0] == k || m->inductor[1] == k) {
            int other = m->inductor[m->inductor[0] == k ? 1 : 0];
            flux += m->k * sqrt(c->device[k].value * c->device[other].value) *
                    (sum->device[other].now[1] - sum->device[other].last[1]);
        }
    }
    return flux;
}

/* impulse[], the fluxes, so far of switches and diodes: those of coils; and node[], the impulse of voltage
 * at each node against ground, NAN where it is not determined. */
static void solve_fluxes(const struct dalcs_losses_sum *sum) {
    const struct dalcs_circuit *c = sum->circuit;
    bool moves = true;
    for (int n = 0; n < c->n_nodes; n++) {
        sum->node[n] = n == 0 ? 0.0 : NAN;
    }
    for (int k = 0; k < c->n_devices; k++) {
        sum->impulse[k] = c->device[k].kind == DALCS_INDUCTOR ? coil_flux(sum, k) : sum->impulse[k];
    }
    while (moves) {
        moves = false;
        for (int k = 0; k < c->n_devices; k++) {
            const struct dalcs_device *d = &c->device[k];
            double *at[2] = {&sum->node[d->node[0]], &sum->node[d->node[1]]};
            if (holds_current(d) || isnan(*at[0]) == isnan(*at[1])) {
                continue;
            }
            if (isnan(*at[0])) {
                *at[0] = *at[1] + sum->impulse[k];
            } else {
                *at[1] = *at[0] - sum->impulse[k];
            }
            moves = true;
        }
    }
}

/* The energies of sources: charges at the voltage, fluxes at the current just after. */
static void give_charges(const struct dalcs_losses_sum *sum) {
    const struct dalcs_circuit *c = sum->circuit;
    for (int k = 0; k < c->n_devices; k++) {
        if (holds_voltage(&c->device[k]) && !isnan(sum->impulse[k])) {
            sum->device[k].jump += sum->impulse[k] * sum->device[k].now[0];
        }
    }
}

static void give_fluxes(const struct dalcs_losses_sum *sum) {
    const struct dalcs_circuit *c = sum->circuit;
    for (int k = 0; k < c->n_devices; k++) {
        const struct dalcs_device *d = &c->device[k];
        double flux = sum->node[d->node[0]] - sum->node[d->node[1]];
        if (holds_current(d) && !isnan(flux)) {
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

/* impulse[], of switches and diodes alone. */
static void gather(const struct dalcs_losses_sum *sum, bool fluxes) {
    memset(sum->impulse, 0, (size_t)sum->circuit->n_devices * sizeof(double));
    for (int j = 0; j < sum->n_jumps; j++) {
        for (int k = 0; k < sum->jump[j].n; k++) {
            const struct dalcs_loss_impulse *i = &sum->jump[j].impulse[k];
            sum->impulse[i->device] += fluxes ? i->flux : i->charge;
        }
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
    if (in_steps) {
        return;
    }
    gather(sum, false);
    solve_charges(sum);
    give_charges(sum);
    gather(sum, true);
    solve_fluxes(sum);
    give_fluxes(sum);
}

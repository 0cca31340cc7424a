/* energy_tried.c - segments of radau by implicit Euler: kept when they are made, entered when they are passed through.
 *
 * Where gates decide, a segment that was made begins anew or is cut. Up to a node, what its steps move is known as states are,
 * by extrapolation; in between it is the polynomial through the nodes, as of states (slide_try.c). */
#include "energy_entries.h"

#include <math.h>
#include <string.h>

void dalcs_energy_try(void *user, int k) {
    struct dalcs_energy *energy = user;
    memset(energy->part[k].tried, 0, sizeof(energy->part[k].tried));
}

void dalcs_energy_try_step(void *user, int k, const double *x, const double *y,
                           const struct dalcs_observed_sides *sides, const double *inputs) {
    struct dalcs_energy *energy = user;
    struct dalcs_energy_part *part = &energy->part[k];
    struct dalcs_energy_share *share = &part->tried[sides->node];
    double taken =
        dalcs_euler_stored_energy(part->system, y) - dalcs_euler_stored_energy(part->system, x);
    for (int side = 0; side < sides->n; side++) {
        const double *at = sides->y[side];
        dalcs_energy_raise_columns(part, at);
        dalcs_energy_add_powers(part, at, inputs, sides->weight[side] * sides->times * sides->h,
                                share->account, &share->turnover);
        taken += sides->weight[side] * (dalcs_euler_jump_energy(part->system, x, at) +
                                        dalcs_euler_jump_energy(part->system, y, at));
    }
    share->taken += sides->times * taken;
}

static void add_share(struct dalcs_energy_share *sum, const struct dalcs_energy_share *share,
                      double weight) {
    for (int i = 0; i < DALCS_N_POWER_ACCOUNTS; i++) {
        sum->account[i] += weight * share->account[i];
    }
    sum->taken += weight * share->taken;
    sum->turnover += fabs(weight) * share->turnover;
}

/* What is moved up to a node counts in the polynomials of this node and all behind it. */
static void find_share(const struct dalcs_energy_part *ledger, const struct dalcs_radau_part *part,
                       struct dalcs_energy_share *sum) {
    double weight[DALCS_MAX_NODES];
    double behind = 0.0;
    dalcs_collocation_weights(part->stages.method, part->segment.end, weight);
    *sum = (struct dalcs_energy_share){0};
    for (int node = part->stages.method->s; node > 0; node--) {
        behind += weight[node];
        add_share(sum, &ledger->tried[node], behind);
    }
    add_share(sum, &ledger->tried[0], part->segment.end);
}

void dalcs_energy_enter_tried(struct dalcs_energy *energy, const struct dalcs_radau_part *part,
                              const double *start) {
    const struct dalcs_energy_part *ledger = &energy->part[part->index];
    struct dalcs_energy_share sum;
    find_share(ledger, part, &sum);
    for (int i = 0; i < DALCS_N_POWER_ACCOUNTS; i++) {
        energy->sum.account[i] += sum.account[i];
    }
    const double method = sum.taken - (dalcs_euler_stored_energy(ledger->system, part->x) -
                                       dalcs_euler_stored_energy(ledger->system, start));
    energy->sum.method += method;
    energy->sum.turnover += sum.turnover + fabs(method);
    dalcs_energy_enter_swing(energy, ledger, start, part->x, part->x);
}

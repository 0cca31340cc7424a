/* jump_report.c - a jump of a component: what it is, what it costs, and how it is told. */
#include "euler.h"

#include "magnitudes.h"

#include <math.h>
#include <string.h>

double dalcs_euler_jump_energy(const struct dalcs_system *s, const double *before,
                               const double *after) {
    double energy = 0.0;
    for (int i = 0; i < s->n_x; i++) {
        for (int k = s->storage.p[i]; k < s->storage.p[i + 1]; k++) {
            int j = s->storage.j[k];
            energy += 0.5 * s->storage.x[k] * (after[i] - before[i]) * (after[j] - before[j]);
        }
    }
    return energy;
}

double dalcs_euler_stored_energy(const struct dalcs_system *s, const double *x) {
    double energy = 0.0;
    for (int i = 0; i < s->n_x; i++) {
        energy += 0.5 * x[i] * dalcs_csr_row_dot(&s->storage, i, x);
    }
    return energy;
}

double dalcs_euler_jump_in_thresholds(const struct dalcs_power *power, const double *charge) {
    double energy = 0.0;
    for (int i = 0; power != NULL && i < power->n; i++) {
        const struct dalcs_power_term *term = &power->term[i];
        if (term->pair >= 0 && term->factor == DALCS_POWER_CONSTANT) {
            energy += term->coefficient * charge[term->pair];
        }
    }
    return energy;
}

/* What a jump cost, J: stored, lost, and in the thresholds that charge has passed. Other pairs have constants, too: the limit of
 * a channel's current, the threshold of what only reads. Nothing is lost in these. */
static double cost_of(const struct dalcs_system *s, const struct dalcs_power *power,
                      const double *before, const struct dalcs_jump_answer *jump) {
    return dalcs_euler_stored_energy(s, jump->after) - dalcs_euler_stored_energy(s, before) +
           dalcs_euler_jump_energy(s, before, jump->after) +
           dalcs_euler_jump_in_thresholds(power, jump->charge);
}

enum dalcs_status dalcs_euler_find_jump(struct dalcs_euler *e, int k, const double *u) {
    const struct dalcs_osnsp *p = &e->component[k].osnsp;
    const struct dalcs_system *s = p->system;
    /* what micro-steps have seen, where nothing else is known */
    memcpy(e->jump.after, e->after, (size_t)s->n_x * sizeof(double));
    memcpy(e->jump.charge, e->charge, (size_t)s->n_pairs * sizeof(double));
    memcpy(e->jump.flux, e->flux, (size_t)s->n_pairs * sizeof(double));
    DALCS_TRY(dalcs_jumps_build(&e->jumps, e->circuit, e->network, &p->options));
    return dalcs_jumps_solve(&e->jumps, k, p->mode, u, u + s->n_x, &e->jump);
}

/* e->telling.from and e->telling.to: the states before and after a jump, without what is rounding. Impulses of charge come with
 * voltages that jump, those of flux with currents. */
static bool tell_states(struct dalcs_euler *e, const struct dalcs_system *s, const double *before) {
    bool jumps[2] = {false, false};
    for (int x = 0; x < s->n_x; x++) {
        bool is_told = fabs(e->jump.after[x] - before[x]) > e->telling.noise[x];
        e->telling.from[x] = before[x];
        e->telling.to[x] = is_told ? e->jump.after[x] : before[x];
        jumps[s->column_is_current[x]] = jumps[s->column_is_current[x]] || is_told;
    }
    if (!jumps[0]) {
        memset(e->jump.charge, 0, (size_t)s->n_pairs * sizeof(double));
    }
    if (!jumps[1]) {
        memset(e->jump.flux, 0, (size_t)s->n_pairs * sizeof(double));
    }
    return jumps[0] || jumps[1];
}

/* And the other columns of the equations, as far as they follow from two micro-steps. */
static void tell_columns(struct dalcs_euler *e, const struct dalcs_system *s, const double *from,
                         const double *to) {
    for (int c = s->n_x; c < dalcs_system_n_equations(s); c++) {
        double size = fmax(fabs(from[c]), fabs(to[c]));
        e->telling.from[c] = from[c];
        e->telling.to[c] = fabs(to[c] - from[c]) <= dalcs_nothing * size  ? from[c]
                           : fabs(to[c]) <= dalcs_nothing * fabs(from[c]) ? 0.0
                                                                          : to[c];
    }
}

enum dalcs_status dalcs_euler_report_jump(struct dalcs_euler *e, int k, double time,
                                          const double *before, const double *from,
                                          const double *to) {
    const struct dalcs_system *s = e->component[k].system;
    if (!e->jump.is_known) { /* of the states that are taken, which micro-steps have seen since */
        const struct dalcs_power *power = e->network->power;
        e->jump.source_work = cost_of(s, power != NULL ? &power[k] : NULL, before, &e->jump);
    }
    struct dalcs_euler_jump jump = {
        .time = time,
        .system = k,
        .mode = e->component[k].osnsp.mode,
        .before = before,
        .after = e->jump.after,
        .n_known = s->n_x,
        .charge = e->jump.charge,
        .flux = e->jump.flux,
        .energy_lost = dalcs_euler_jump_energy(s, before, e->jump.after),
        .source_work = e->jump.source_work,
    };
    if (e->listener.observer != NULL) {
        e->listener.observer->jump(e->listener.observer->user, &jump);
    }
    if (e->listener.on_jump == NULL || !tell_states(e, s, before)) {
        return DALCS_OK;
    }
    if (from != NULL && to != NULL) {
        tell_columns(e, s, from, to);
        jump.n_known = dalcs_system_n_equations(s);
    }
    jump.before = e->telling.from;
    jump.after = e->telling.to;
    jump.energy_lost = dalcs_euler_jump_energy(s, before, e->telling.to);
    return e->listener.on_jump(e->listener.jump_user, &jump);
}

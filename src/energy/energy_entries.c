/* energy_entries.c - steps, jumps and moves of the engine, entered in the ledger of energies. */
#include "energy_entries.h"
#include "extremes.h"
#include "rounding.h"

#include <math.h>

void dalcs_energy_enter(struct dalcs_energy *energy, enum dalcs_power_account account,
                        double joule) {
    energy->sum.account[account] += joule;
    energy->sum.turnover += fabs(joule);
}

double dalcs_energy_enter_swing(struct dalcs_energy *energy, const struct dalcs_energy_part *part,
                                const double *x, const double *after, const double *far) {
    double turnover = 0.0;
    double size = 0.0;
    double distance = 0.0;
    for (int i = 0; i < part->system->n_x; i++) {
        double near = dalcs_larger(fabs(x[i]), fabs(after[i]));
        double step = after[i] - x[i];
        turnover += part->half[i] * fabs(step * (after[i] + x[i]));
        size += part->half[i] * near * dalcs_larger(near, fabs(far[i]));
        distance += part->half[i] * step * step;
    }
    energy->sum.turnover += turnover;
    energy->sum.rounding += dalcs_answer_rounded * size;
    return distance;
}

static void start(void *user, int k, const double *x) {
    struct dalcs_energy *energy = user;
    energy->part[k].stored_at_start = dalcs_euler_stored_energy(energy->part[k].system, x);
}

static double difference(const double *y, const int *column) {
    return (column[0] >= 0 ? y[column[0]] : 0.0) - (column[1] >= 0 ? y[column[1]] : 0.0);
}

static double power_of(const struct dalcs_power_term *term, const double *y, const double *inputs) {
    double first = term->coefficient * difference(y, term->first);
    switch (term->factor) {
    case DALCS_POWER_CONSTANT:
        return first;
    case DALCS_POWER_SQUARE:
        return first * difference(y, term->first);
    case DALCS_POWER_PRODUCT:
        return first * difference(y, term->second);
    case DALCS_POWER_INPUT:
        return first * inputs[term->input];
    }
    return 0.0;
}

void dalcs_energy_add_powers(const struct dalcs_energy_part *part, const double *y,
                             const double *inputs, double h, double *account, double *turnover) {
    for (int i = 0; i < part->n_stepped; i++) {
        const double joule = h * power_of(&part->term[i], y, inputs);
        account[part->term[i].account] += joule;
        *turnover += fabs(joule);
    }
}

void dalcs_energy_raise_columns(const struct dalcs_energy_part *part, const double *y) {
    for (int k = 0; k < dalcs_system_n_columns(part->system); k++) {
        part->column[k] = dalcs_larger(part->column[k], fabs(y[k]));
    }
}

static void enter_loss(struct dalcs_energy *energy, struct dalcs_energy_part *part, double loss) {
    double jumps = fmin(part->lost, loss);
    part->lost = 0.0;
    energy->sum.jumps += jumps;
    energy->sum.method += loss - jumps;
    energy->sum.turnover += loss;
}

void dalcs_energy_step(void *user, int k, const double *x, const double *y, const double *inputs,
                       double h) {
    struct dalcs_energy *energy = user;
    struct dalcs_energy_part *part = &energy->part[k];
    dalcs_energy_add_powers(part, y, inputs, h, energy->sum.account, &energy->sum.turnover);
    dalcs_energy_raise_columns(part, y);
    double loss = dalcs_energy_enter_swing(energy, part, x, y, y);
    if (part->is_coupled) {
        loss = dalcs_euler_jump_energy(part->system, x, y);
    }
    enter_loss(energy, part, loss);
}

/* Scales of certificates say what equations add up, as roff times a current, and not what columns are. */
static void scale(void *user, int k, const struct dalcs_certificate *certificate) {
    (void)user;
    (void)k;
    (void)certificate;
}

static void move(void *user, int k, const double *x, const double *after) {
    struct dalcs_energy *energy = user;
    const struct dalcs_system *s = energy->part[k].system;
    double change = dalcs_euler_stored_energy(s, after) - dalcs_euler_stored_energy(s, x);
    energy->sum.method -= change;
    energy->sum.missed += fabs(change);
    energy->sum.turnover += fabs(change);
}

static void jump(void *user, const struct dalcs_euler_jump *told) {
    struct dalcs_energy *energy = user;
    struct dalcs_energy_part *part = &energy->part[told->system];
    if (energy->is_euler) { /* the step that crosses the jump has the rest */
        part->lost += told->energy_lost;
        return;
    }
    double in_thresholds = 0.0;
    for (int i = 0; i < part->n_stepped; i++) {
        const struct dalcs_power_term *term = &part->term[i];
        if (term->pair >= 0 && term->factor == DALCS_POWER_CONSTANT) {
            in_thresholds += term->coefficient * told->charge[term->pair];
        }
    }
    dalcs_energy_enter(energy, DALCS_POWER_DIODES, in_thresholds);
    dalcs_energy_enter(energy, DALCS_POWER_SOURCES, told->source_work);
    energy->sum.jumps += told->energy_lost;
    energy->sum.turnover += told->energy_lost;
    dalcs_energy_enter_swing(energy, part, told->before, told->after, told->after);
}

void dalcs_energy_observe(struct dalcs_observer *observer) {
    *observer = (struct dalcs_observer){.start = start,
                                        .scale = scale,
                                        .step = dalcs_energy_step,
                                        .jump = jump,
                                        .move = move,
                                        .segment = dalcs_energy_segment,
                                        .try_by_euler = dalcs_energy_try,
                                        .step_by_euler = dalcs_energy_try_step};
}

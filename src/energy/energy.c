/* energy.c - the ledger from its opening to its balance. */
#include "energy.h"

#include "energy_entries.h"
#include "extremes.h"
#include "micro_steps.h"
#include "rounding.h"
#include "step_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A balance of more than this part of what was moved is no rounding; it is 1e-10 at most. */
static const double most_off = 1e-7;

/* The error of radau is some 0.01 of its inner tolerance, over the energy that was moved: a waveform is wrong where
 * it is so much. */
static const double most_missed = 1e5;

/* ---- Setting up ---------------------------------------------------------------------------- */

static bool touches(const struct dalcs_power_term *term, int column) {
    return term->first[0] == column || term->first[1] == column || term->second[0] == column ||
           term->second[1] == column;
}

/* Do sources alone decide the power? A term's columns are all bystanders or none is, for bystanders are
 * blocks with both the voltages and the currents of their sources. */
static bool is_decided(const struct dalcs_radau_part *radau, const struct dalcs_power_term *term) {
    if (radau == NULL || radau->kind == DALCS_PART_ALGEBRAIC) {
        return radau != NULL;
    }
    const struct dalcs_bystanders *b = &radau->excitation.bystanders;
    bool found = false;
    for (int i = 0; i < b->n && !found; i++) {
        found = touches(term, b->column[i]);
    }
    return found;
}

static enum dalcs_status part_setup(struct dalcs_energy_part *part,
                                    const struct dalcs_system *system,
                                    const struct dalcs_power *power,
                                    const struct dalcs_radau_part *radau) {
    part->system = system;
    part->term = dalcs_alloc((size_t)power->n, sizeof(*part->term));
    part->half = dalcs_alloc((size_t)system->n_x, sizeof(double));
    part->defect = dalcs_alloc((size_t)system->n_x, sizeof(double));
    part->column = dalcs_alloc((size_t)dalcs_system_n_columns(system), sizeof(double));
    if (part->term == NULL || part->half == NULL || part->defect == NULL || part->column == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int x = 0; x < system->n_x; x++) {
        for (int k = system->storage.p[x]; k < system->storage.p[x + 1]; k++) {
            bool is_own = system->storage.j[k] == x;
            part->half[x] += is_own ? 0.5 * system->storage.x[k] : 0.0;
            part->is_coupled = part->is_coupled || !is_own;
        }
    }
    for (int decided = 0; decided < 2; decided++) {
        for (int i = 0; i < power->n; i++) {
            if (is_decided(radau, &power->term[i]) == (decided == 1)) {
                part->term[part->n_terms++] = power->term[i];
            }
        }
        part->n_stepped = decided == 0 ? part->n_terms : part->n_stepped;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_energy_setup(struct dalcs_energy *energy, struct dalcs_euler *e,
                                     const struct dalcs_radau *radau) {
    *energy = (struct dalcs_energy){.is_euler = radau == NULL, .n_parts = e->n_components};
    dalcs_energy_observe(&energy->observer);
    energy->observer.user = energy;
    energy->part = dalcs_alloc((size_t)e->n_components, sizeof(*energy->part));
    enum dalcs_status status = energy->part == NULL ? DALCS_E_NOMEM : DALCS_OK;
    for (int k = 0; k < e->n_components && status == DALCS_OK; k++) {
        status = part_setup(&energy->part[k], e->component[k].system, &e->network->power[k],
                            radau != NULL ? &radau->part[k] : NULL);
    }
    if (status == DALCS_OK) {
        e->listener.observer = &energy->observer;
    } else {
        dalcs_energy_finish(energy);
    }
    return status;
}

void dalcs_energy_finish(struct dalcs_energy *energy) {
    for (int k = 0; energy->part != NULL && k < energy->n_parts; k++) {
        free(energy->part[k].term);
        free(energy->part[k].half);
        free(energy->part[k].defect);
        free(energy->part[k].column);
    }
    free(energy->part);
    *energy = (struct dalcs_energy){0};
}

/* ---- The end ------------------------------------------------------------------------------- */

/* What the row of a block adds up in size, where the largest of each unit are these. */
static double size_of_row(const struct dalcs_system *s, const struct dalcs_csr *block, int row,
                          const double *largest) {
    double size = 0.0;
    for (int k = block->p[row]; k < block->p[row + 1]; k++) {
        size += fabs(block->x[k]) * largest[s->column_is_current[block->j[k]] ? 1 : 0];
    }
    return size;
}

/* The balance of a certified answer is the sum of what each equation is off by, times the column that the equation is paired
 * with: KCL times its node's voltage, the law of a branch times its current (Tellegen). An equation is off by a part of what it
 * adds up. So an open switch counts with its own leak, v^2 / roff, and not with roff times the square of what others carry.
 * column: the largest magnitudes of all. The powers over the run add up. */
static double power_of_rounding(const struct dalcs_system *s, double stop, const double *largest,
                                const double *column) {
    double power = 0.0;
    for (int r = 0; r < s->A.n_rows; r++) {
        double size = size_of_row(s, &s->A, r, largest);
        if (r < s->n_x) {
            size += size_of_row(s, &s->P, r, largest) / stop;
        }
        power += size * column[s->dual[r]];
    }
    return power;
}

/* The largest of each unit. */
static void raise_units(const struct dalcs_energy_part *part, double *largest) {
    for (int k = 0; k < dalcs_system_n_columns(part->system); k++) {
        double *unit = &largest[part->system->column_is_current[k] ? 1 : 0];
        *unit = dalcs_larger(*unit, part->column[k]);
    }
}

/* What has been largest in segments of radau counts, too. */
static void raise_columns(const struct dalcs_energy_part *part,
                          const struct dalcs_radau_part *radau) {
    for (int k = 0; k < dalcs_system_n_columns(part->system); k++) {
        part->column[k] = dalcs_larger(part->column[k], radau->scales.column[k]);
    }
}

static enum dalcs_status close_radau(struct dalcs_energy *energy, struct dalcs_radau_part *radau,
                                     double stop, double *largest) {
    struct dalcs_energy_part *part = &energy->part[radau->index];
    if (radau->kind == DALCS_PART_STEPPED) {
        memcpy(radau->work.after, radau->x, (size_t)part->system->n_x * sizeof(double));
        dalcs_step_states(radau, radau->segment.end, radau->x);
        dalcs_energy_segment(energy, radau, radau->work.after);
        energy->sum.stored_change +=
            dalcs_euler_stored_energy(part->system, radau->x) - part->stored_at_start;
        largest[0] = dalcs_larger(radau->scales.unit[0], part->largest[0]);
        largest[1] = dalcs_larger(radau->scales.unit[1], part->largest[1]);
        /* an answer near 0 has the absolute error of the quantities that thresholds and sources drive */
        dalcs_excitation_inputs(&radau->excitation, stop, 0.0, radau->work.u + part->system->n_x);
        dalcs_micro_raise_to_drives(radau, largest);
        raise_columns(part, radau);
    }
    return dalcs_energy_enter_decided(energy, part, radau->component, &radau->excitation.bystanders,
                                      stop);
}

static void close_euler(struct dalcs_energy *energy, int k, const struct dalcs_component *c,
                        double stop, double *largest) {
    const struct dalcs_energy_part *part = &energy->part[k];
    if (c->is_static) { /* it took no steps */
        dalcs_energy_step(energy, k, c->y, c->y, c->u + c->system->n_x, stop);
    }
    energy->sum.stored_change +=
        dalcs_euler_stored_energy(part->system, c->u) - part->stored_at_start;
    largest[0] = part->largest[0];
    largest[1] = part->largest[1];
}

enum dalcs_status dalcs_energy_close(struct dalcs_energy *energy, struct dalcs_euler *e,
                                     struct dalcs_radau *radau) {
    double stop = radau != NULL ? radau->options.stop : e->grid.stop;
    for (int k = 0; k < energy->n_parts; k++) {
        const struct dalcs_energy_part *part = &energy->part[k];
        double largest[2] = {0.0, 0.0}; /* V, A */
        if (radau != NULL) {
            DALCS_TRY(close_radau(energy, &radau->part[k], stop, largest));
        } else {
            close_euler(energy, k, &e->component[k], stop, largest);
        }
        raise_units(part, largest);
        energy->sum.rounding += dalcs_answer_rounded * stop *
                                power_of_rounding(part->system, stop, largest, part->column);
    }
    energy->sum.stored_change += energy->sum.account[DALCS_POWER_STORED];
    return DALCS_OK;
}

double dalcs_energy_balance(const struct dalcs_energy *energy) {
    return energy->sum.account[DALCS_POWER_SOURCES] - energy->sum.account[DALCS_POWER_RESISTORS] -
           energy->sum.account[DALCS_POWER_DIODES] - energy->sum.jumps - energy->sum.stored_change -
           energy->sum.method;
}

double dalcs_energy_unexplained(const struct dalcs_energy *energy,
                                const struct dalcs_radau *radau) {
    double balance = dalcs_energy_balance(energy);
    if (fabs(balance) > most_off * energy->sum.turnover + energy->sum.rounding) {
        return balance;
    }
    if (radau == NULL || radau->options.fixed_step > 0.0) { /* no error is controlled */
        return 0.0;
    }
    double allowed =
        most_missed * radau->inner_tolerance * energy->sum.turnover + energy->sum.rounding;
    return energy->sum.missed > allowed ? energy->sum.missed : 0.0;
}

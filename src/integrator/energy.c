/* energy.c - the powers of all devices over steps, segments and jumps. */
#include "energy.h"

#include "decided_energy.h"
#include "extremes.h"
#include "stage_rule.h"
#include "step_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Residuals that answers may have, over the scales of the certificate. */
static const double residual_part = 1e-12;

/* A balance of more than this part of what was moved is no rounding; it is 1e-10 at most. */
static const double most_off = 1e-7;

/* What radau misses is some 0.01 of its inner tolerance, over what was moved: a waveform is wrong where
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
    if (part->term == NULL || part->half == NULL || part->defect == NULL) {
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

enum dalcs_status dalcs_energy_setup(struct dalcs_energy *energy, const struct dalcs_euler *e,
                                     const struct dalcs_radau *radau) {
    *energy = (struct dalcs_energy){.is_euler = radau == NULL, .n_parts = e->n_components};
    energy->part = dalcs_alloc((size_t)e->n_components, sizeof(*energy->part));
    enum dalcs_status status = energy->part == NULL ? DALCS_E_NOMEM : DALCS_OK;
    for (int k = 0; k < e->n_components && status == DALCS_OK; k++) {
        status = part_setup(&energy->part[k], e->component[k].system, &e->network->power[k],
                            radau != NULL ? &radau->part[k] : NULL);
    }
    if (status != DALCS_OK) {
        dalcs_energy_finish(energy);
    }
    return status;
}

void dalcs_energy_finish(struct dalcs_energy *energy) {
    for (int k = 0; energy->part != NULL && k < energy->n_parts; k++) {
        free(energy->part[k].term);
        free(energy->part[k].half);
        free(energy->part[k].defect);
    }
    free(energy->part);
    *energy = (struct dalcs_energy){0};
}

/* ---- Entries ------------------------------------------------------------------------------- */

void dalcs_energy_enter(struct dalcs_energy *energy, enum dalcs_power_account account,
                        double joule) {
    energy->account[account] += joule;
    energy->turnover += fabs(joule);
}

/* What goes back and forth in capacitors and coils, and how much rounding it may leave: a segment that
 * is cut is a small part of a step, whose other end may be far away. Returns 1/2 |after - x|^2 by the
 * diagonal of the storage. */
static double enter_swing(struct dalcs_energy *energy, const struct dalcs_energy_part *part,
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
    energy->turnover += turnover;
    energy->rounding += residual_part * size;
    return distance;
}

void dalcs_energy_start(struct dalcs_energy *energy, int k, const double *x) {
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

static void enter_powers(struct dalcs_energy *energy, const struct dalcs_energy_part *part,
                         const double *y, const double *inputs, double h) {
    for (int i = 0; i < part->n_stepped; i++) {
        dalcs_energy_enter(energy, part->term[i].account, h * power_of(&part->term[i], y, inputs));
    }
}

static void enter_loss(struct dalcs_energy *energy, struct dalcs_energy_part *part, double loss) {
    double jumps = fmin(part->lost, loss);
    part->lost = 0.0;
    energy->jumps += jumps;
    energy->method += loss - jumps;
    energy->turnover += loss;
}

void dalcs_energy_step(struct dalcs_energy *energy, int k, const double *x, const double *y,
                       const double *inputs, double h) {
    struct dalcs_energy_part *part = &energy->part[k];
    enter_powers(energy, part, y, inputs, h);
    double loss = enter_swing(energy, part, x, y, y);
    if (part->is_coupled) {
        loss = dalcs_euler_jump_energy(part->system, x, y);
    }
    enter_loss(energy, part, loss);
}

double dalcs_energy_sliding_step(struct dalcs_energy *energy, int k, const double *x,
                                 const double *y, const struct dalcs_energy_sides *sides,
                                 const double *inputs, double times_h) {
    struct dalcs_energy_part *part = &energy->part[k];
    double taken =
        dalcs_euler_stored_energy(part->system, y) - dalcs_euler_stored_energy(part->system, x);
    for (int side = 0; side < 2; side++) {
        const double *at = sides->y[side];
        enter_powers(energy, part, at, inputs, sides->weight[side] * times_h);
        taken += sides->weight[side] * (dalcs_euler_jump_energy(part->system, x, at) +
                                        dalcs_euler_jump_energy(part->system, y, at));
    }
    return taken;
}

void dalcs_energy_slide(struct dalcs_energy *energy, int k, const double *x, const double *y,
                        double taken) {
    struct dalcs_energy_part *part = &energy->part[k];
    double stored =
        dalcs_euler_stored_energy(part->system, y) - dalcs_euler_stored_energy(part->system, x);
    enter_swing(energy, part, x, y, y);
    energy->method += taken - stored;
    energy->turnover += fabs(taken - stored);
}

void dalcs_energy_scale(struct dalcs_energy *energy, int k,
                        const struct dalcs_certificate *certificate) {
    double *largest = energy->part[k].largest;
    largest[0] = dalcs_larger(largest[0], certificate->volt);
    largest[1] = dalcs_larger(largest[1], certificate->ampere);
}

void dalcs_energy_move(struct dalcs_energy *energy, const struct dalcs_radau_part *part,
                       const double *after) {
    const struct dalcs_system *s = part->component->system;
    double change = dalcs_euler_stored_energy(s, after) - dalcs_euler_stored_energy(s, part->x);
    energy->method -= change;
    energy->missed += fabs(change);
    energy->turnover += fabs(change);
}

void dalcs_energy_jump(struct dalcs_energy *energy, const struct dalcs_euler_jump *jump) {
    struct dalcs_energy_part *part = &energy->part[jump->system];
    if (energy->is_euler) { /* the step that crosses the jump has the rest */
        part->lost += jump->energy_lost;
        return;
    }
    double in_thresholds = 0.0;
    for (int i = 0; i < part->n_stepped; i++) {
        const struct dalcs_power_term *term = &part->term[i];
        if (term->pair >= 0 && term->factor == DALCS_POWER_CONSTANT) {
            in_thresholds += term->coefficient * jump->charge[term->pair];
        }
    }
    dalcs_energy_enter(energy, DALCS_POWER_DIODES, in_thresholds);
    dalcs_energy_enter(energy, DALCS_POWER_SOURCES, jump->source_work);
    energy->jumps += jump->energy_lost;
    energy->turnover += jump->energy_lost;
    enter_swing(energy, part, jump->before, jump->after, jump->after);
}

/* ---- A segment ----------------------------------------------------------------------------- */

/* value[s] of a difference of columns at the stages. */
static void fetch(const struct dalcs_radau_part *part, const int *column, double *value) {
    int s = part->stages.method->s;
    int stride = part->stages.layout.stride;
    const double *y = part->segment.out + stride;
    if (column[0] >= 0 && column[1] >= 0) {
        for (int i = 0; i < s; i++) {
            value[i] = y[i * stride + column[0]] - y[i * stride + column[1]];
        }
        return;
    }
    int one = column[0] >= 0 ? column[0] : column[1];
    if (one < 0) {
        memset(value, 0, (size_t)s * sizeof(double));
        return;
    }
    double sign = column[0] >= 0 ? 1.0 : -1.0;
    y += one;
    for (int i = 0; i < s; i++, y += stride) {
        value[i] = sign * *y;
    }
}

static bool varies(const struct dalcs_excitation *e, int input) {
    bool found = false;
    for (int f = 0; f < e->n_functions && !found; f++) {
        found = e->function[f].input == input;
    }
    return found;
}

/* value[s] of an input, from the coefficients that the step was made with. */
static void fetch_input(const struct dalcs_radau_part *part, int input, double *value) {
    const struct dalcs_excitation *e = &part->excitation;
    const double *coefficient = part->segment.in + part->component->system->n_x + 1;
    for (int i = 0; i < part->stages.method->s; i++) {
        value[i] = e->constant[input];
        for (int f = 0; f < e->n_functions; f++) {
            if (e->function[f].input == input) {
                value[i] +=
                    coefficient[f] * dalcs_excitation_function_at(&e->function[f], part->segment.h,
                                                                  part->stages.method->node[i + 1]);
            }
        }
    }
}

/* A source drives this much, whatever power that is: a voltage through a current, or the other way round. */
static void note_drive(struct dalcs_energy_part *ledger, const struct dalcs_power_term *term,
                       const double *value, int n) {
    int column = term->first[0] >= 0 ? term->first[0] : term->first[1];
    double *largest =
        &ledger->largest[column >= 0 && ledger->system->column_is_current[column] ? 0 : 1];
    for (int i = 0; i < n; i++) {
        *largest = dalcs_larger(*largest, fabs(value[i]));
    }
}

static double integral_of(struct dalcs_energy_part *ledger, const struct dalcs_radau_part *part,
                          const struct dalcs_stage_rule *rule,
                          const struct dalcs_power_term *term) {
    double first[DALCS_MAX_STAGES];
    double second[DALCS_MAX_STAGES];
    fetch(part, term->first, first);
    switch (term->factor) {
    case DALCS_POWER_CONSTANT:
        return term->coefficient * dalcs_stage_rule_integral(rule, first);
    case DALCS_POWER_SQUARE:
        return term->coefficient * dalcs_stage_rule_product(rule, first, first);
    case DALCS_POWER_PRODUCT:
        fetch(part, term->second, second);
        return term->coefficient * dalcs_stage_rule_product(rule, first, second);
    case DALCS_POWER_INPUT:
        if (!varies(&part->excitation, term->input)) {
            note_drive(ledger, term, &part->excitation.constant[term->input], 1);
            return term->coefficient * part->excitation.constant[term->input] *
                   dalcs_stage_rule_integral(rule, first);
        }
        fetch_input(part, term->input, second);
        note_drive(ledger, term, second, part->stages.method->s);
        return term->coefficient * dalcs_stage_rule_product(rule, first, second);
    }
    return 0.0;
}

static double loss_of(const struct dalcs_energy_part *ledger, const struct dalcs_radau_part *part,
                      const struct dalcs_stage_rule *rule, const double *state) {
    const struct dalcs_collocation *m = part->stages.method;
    const struct dalcs_system *s = ledger->system;
    int stride = part->stages.layout.stride;
    double square = 0.0;
    double along_start = 0.0;
    double along[DALCS_MAX_STAGES] = {0.0};
    const double *y = part->segment.out + stride;
    for (int x = 0; x < s->n_x; x++) {
        double start = 0.0;
        const double *at = y + x;
#pragma GCC unroll 8
        for (int i = 0; i < m->s; i++, at += stride) {
            start += m->back[i] * *at;
        }
        ledger->defect[x] = state[x] - start;
    }
    for (int x = 0; x < s->n_x; x++) {
        double loaded = dalcs_csr_row_dot(&s->storage, x, ledger->defect);
        square += loaded * ledger->defect[x];
        along_start += loaded * (state[x] - ledger->defect[x]);
        const double *at = y + x;
#pragma GCC unroll 8
        for (int i = 0; i < m->s; i++, at += stride) {
            along[i] += loaded * *at;
        }
    }
    return dalcs_stage_rule_loss(rule, square, along, along_start);
}

void dalcs_energy_segment(struct dalcs_energy *energy, const struct dalcs_radau_part *part,
                          const double *start) {
    struct dalcs_energy_part *ledger = &energy->part[part->index];
    struct dalcs_stage_rule rule;
    if (part->segment.by_euler) {
        return; /* entered when it was made */
    }
    dalcs_stage_rule_set(&rule, part->stages.method, part->segment.end);
    for (int i = 0; i < ledger->n_stepped; i++) {
        const struct dalcs_power_term *term = &ledger->term[i];
        if (term->pair < 0 || dalcs_osnsp_is_on(&part->component->osnsp, term->pair)) {
            dalcs_energy_enter(energy, term->account,
                               part->segment.h * integral_of(ledger, part, &rule, term));
        }
    }
    double loss = loss_of(ledger, part, &rule, start);
    energy->method += loss;
    energy->missed += fabs(loss);
    energy->turnover += fabs(loss);
    enter_swing(energy, ledger, start, part->x,
                part->segment.out + part->stages.method->s * part->stages.layout.stride);
}

/* ---- The end ------------------------------------------------------------------------------- */

/* The largest conductance in the equations of a block that are currents, and the largest resistance in
 * those that are voltages. */
static void raise_entries(const struct dalcs_system *s, const struct dalcs_csr *block,
                          double seconds, double *conductance, double *resistance) {
    for (int r = 0; r < block->n_rows; r++) {
        double *most = s->row_is_current[r] ? conductance : resistance;
        for (int k = block->p[r]; k < block->p[r + 1]; k++) {
            if (s->column_is_current[block->j[k]] != s->row_is_current[r]) {
                *most = dalcs_larger(*most, fabs(block->x[k]) / seconds);
            }
        }
    }
}

/* Currents and voltages of any answer may be off by a part of what the largest drive through the
 * largest conductance and resistance; where a circuit has hardly any voltage, by a part of what its
 * currents make at the largest conductance, and vice versa. Their powers over the run add up. */
static double power_of_rounding(const struct dalcs_system *s, double stop, const double *largest) {
    double g = 0.0;
    double r = 0.0;
    raise_entries(s, &s->A, 1.0, &g, &r);
    raise_entries(s, &s->P, stop, &g, &r);
    double power = g * largest[0] * largest[0] + r * largest[1] * largest[1];
    double v = g > 0.0 ? dalcs_larger(largest[0], largest[1] / g) : largest[0];
    double i = r > 0.0 ? dalcs_larger(largest[1], largest[0] / r) : largest[1];
    return dalcs_system_n_columns(s) * (power + v * i);
}

static enum dalcs_status close_radau(struct dalcs_energy *energy, struct dalcs_radau_part *radau,
                                     double stop, double *largest) {
    struct dalcs_energy_part *part = &energy->part[radau->index];
    if (radau->kind == DALCS_PART_STEPPED) {
        memcpy(radau->work.after, radau->x, (size_t)part->system->n_x * sizeof(double));
        dalcs_step_states(radau, radau->segment.end, radau->x);
        dalcs_energy_segment(energy, radau, radau->work.after);
        energy->stored_change +=
            dalcs_euler_stored_energy(part->system, radau->x) - part->stored_at_start;
        largest[0] = dalcs_larger(radau->scales.unit[0], part->largest[0]);
        largest[1] = dalcs_larger(radau->scales.unit[1], part->largest[1]);
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
    energy->stored_change += dalcs_euler_stored_energy(part->system, c->u) - part->stored_at_start;
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
        energy->rounding += residual_part * stop * power_of_rounding(part->system, stop, largest);
    }
    return DALCS_OK;
}

double dalcs_energy_balance(const struct dalcs_energy *energy) {
    return energy->account[DALCS_POWER_SOURCES] - energy->account[DALCS_POWER_RESISTORS] -
           energy->account[DALCS_POWER_DIODES] - energy->jumps - energy->stored_change -
           energy->method;
}

double dalcs_energy_unexplained(const struct dalcs_energy *energy,
                                const struct dalcs_radau *radau) {
    double balance = dalcs_energy_balance(energy);
    if (fabs(balance) > most_off * energy->turnover + energy->rounding) {
        return balance;
    }
    if (radau == NULL || radau->options.fixed_step > 0.0) { /* no error is controlled */
        return 0.0;
    }
    double allowed = most_missed * radau->inner_tolerance * energy->turnover + energy->rounding;
    return energy->missed > allowed ? energy->missed : 0.0;
}

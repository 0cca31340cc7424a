/* energy_segment.c - the powers of all devices over a segment, from the polynomials through its stages. */
#include "energy_entries.h"
#include "extremes.h"
#include "stage_rule.h"

#include <math.h>
#include <string.h>

/* value[n_stages] of a difference of columns at the stages. */
static void fetch(const struct dalcs_radau_part *part, const int *column, double *value) {
    int n = part->stages.method->n_stages;
    int stride = part->stages.layout.stride;
    const double *y = part->segment.out + stride;
    if (column[0] >= 0 && column[1] >= 0) {
        for (int i = 0; i < n; i++) {
            value[i] = y[i * stride + column[0]] - y[i * stride + column[1]];
        }
        return;
    }
    int one = column[0] >= 0 ? column[0] : column[1];
    if (one < 0) {
        memset(value, 0, (size_t)n * sizeof(double));
        return;
    }
    double sign = column[0] >= 0 ? 1.0 : -1.0;
    y += one;
    for (int i = 0; i < n; i++, y += stride) {
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

/* value[n_stages] of an input, from the coefficients that the step was made with. */
static void fetch_input(const struct dalcs_radau_part *part, int input, double *value) {
    const struct dalcs_excitation *e = &part->excitation;
    const double *coefficient = part->segment.in + part->component->system->n_x + 1;
    for (int i = 0; i < part->stages.method->n_stages; i++) {
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
        note_drive(ledger, term, second, part->stages.method->n_stages);
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
        for (int i = 0; i < m->n_stages; i++, at += stride) {
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
        for (int i = 0; i < m->n_stages; i++, at += stride) {
            along[i] += loaded * *at;
        }
    }
    return dalcs_stage_rule_loss(rule, square, along, along_start);
}

void dalcs_energy_segment(void *user, const struct dalcs_radau_part *part, const double *start) {
    struct dalcs_energy *energy = user;
    struct dalcs_energy_part *ledger = &energy->part[part->index];
    struct dalcs_stage_rule rule;
    if (part->segment.by_euler) {
        dalcs_energy_enter_tried(energy, part, start);
        return;
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
    energy->sum.method += loss;
    energy->sum.missed += fabs(loss);
    energy->sum.turnover += fabs(loss);
    dalcs_energy_enter_swing(energy, ledger, start, part->x,
                             part->segment.out +
                                 part->stages.method->s * part->stages.layout.stride);
}

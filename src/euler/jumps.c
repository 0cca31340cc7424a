/* jumps.c - the two networks of a jump, and the way between their unknowns and the circuit's. */
#include "jumps_internal.h"

#include "magnitudes.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

static void command(struct dalcs_jump_part *part, const uint64_t *mode) {
    for (int d = 0; d < part->osnsp.system->n_pairs; d++) {
        dalcs_osnsp_command(&part->osnsp, d, dalcs_mode_has(mode, part->pair[d]));
    }
}

/* Or a magnetising current of a transformer, which takes no part in moving charge? */
static bool is_its_own(const struct dalcs_jump_part *part, int x) {
    return part->osnsp.system->column_is_current[x] == (part->kind == DALCS_IMPULSE_FLUX);
}

static double value_of(const struct dalcs_jump_part *part, const struct dalcs_output *out) {
    const double *inputs = part->u + part->osnsp.system->n_x;
    double plus = out->plus.system < 0 ? 0.0 : dalcs_probe_value(&out->plus, part->y, inputs);
    double minus = out->minus.system < 0 ? 0.0 : dalcs_probe_value(&out->minus, part->y, inputs);
    return plus - minus;
}

/* Work of the sources against their impulses: a V source delivers -v i, an I source as well. */
static double source_work(const struct dalcs_jump_part *part) {
    double work = 0.0;
    for (int i = 0; i < part->n_sources; i++) {
        work -= value_of(part, part->source[i].driven) * value_of(part, part->source[i].impulse);
    }
    return work;
}

static void read_answer(const struct dalcs_jump_part *part, struct dalcs_jump_answer *answer) {
    const struct dalcs_system *s = part->osnsp.system;
    const double *lambda = part->y + dalcs_system_n_equations(s);
    double largest = 0.0;
    for (int x = 0; x < s->n_x; x++) {
        if (is_its_own(part, x)) {
            largest = fmax(largest, fmax(fabs(part->u[x]), fabs(part->y[x])));
        }
    }
    for (int x = 0; x < s->n_x; x++) {
        /* what is rounding of the largest has not jumped, or is 0 */
        bool moves = fabs(part->y[x] - part->u[x]) > dalcs_sum_rounded * largest;
        /* what reads the voltage of a coil that is cut off reads what is left of its current over no time */
        if (is_its_own(part, x) && (moves || answer->is_first)) {
            answer->after[part->state[x]] =
                fabs(part->y[x]) > dalcs_sum_rounded * largest ? part->y[x] : 0.0;
            answer->moves = answer->moves || moves;
        }
    }
    double *impulse = part->kind == DALCS_IMPULSE_CHARGE ? answer->charge : answer->flux;
    for (int d = 0; d < s->n_pairs; d++) {
        impulse[part->pair[d]] = part->kind == DALCS_IMPULSE_CHARGE ? lambda[d] : part->osnsp.w[d];
    }
    answer->source_work += source_work(part);
}

static enum dalcs_status solve_part(struct dalcs_jump_part *part, const uint64_t *mode,
                                    const double *x, const double *inputs) {
    const struct dalcs_system *of = part->osnsp.system;
    for (int i = 0; i < of->n_x; i++) {
        part->u[i] = is_its_own(part, i) ? x[part->state[i]] : 0.0;
    }
    for (int i = 0; i < of->n_inputs; i++) {
        part->u[of->n_x + i] = inputs[part->input[i]];
    }
    command(part, mode);
    return dalcs_osnsp_solve(&part->osnsp, 1.0, part->u, part->y);
}

enum dalcs_status dalcs_jumps_solve(const struct dalcs_jumps *j, int k, const uint64_t *mode,
                                    const double *x, const double *inputs,
                                    struct dalcs_jump_answer *answer) {
    const struct dalcs_system *s = &j->of->system[k];
    const bool *is_driven = j->is_driven[k];
    answer->is_covered = j->is_covered[k];
    answer->is_known = answer->is_covered;
    answer->is_first = is_driven != NULL;
    answer->moves = false;
    answer->source_work = 0.0;
    if (!answer->is_known && !answer->is_first) {
        return DALCS_OK;
    }
    enum dalcs_status status = DALCS_OK;
    for (int p = j->first_part[k]; p >= 0 && status == DALCS_OK; p = j->part[p].next) {
        status = j->part[p].is_driven ? DALCS_OK : solve_part(&j->part[p], mode, x, inputs);
    }
    if (status != DALCS_OK) {
        answer->is_known = answer->is_first = false;
        return status < DALCS_OK ? status : DALCS_OK;
    }
    for (int i = 0; i < s->n_x; i++) {
        answer->after[i] = answer->is_known || !is_driven[i] ? x[i] : answer->after[i];
    }
    if (answer->is_known) {
        memset(answer->charge, 0, (size_t)s->n_pairs * sizeof(double));
        memset(answer->flux, 0, (size_t)s->n_pairs * sizeof(double));
    }
    for (int p = j->first_part[k]; p >= 0; p = j->part[p].next) {
        if (!j->part[p].is_driven) {
            read_answer(&j->part[p], answer);
        }
    }
    return DALCS_OK;
}

/* A micro-step's limit and the jump are the same but for a small part of it: else the micro-step has also seen a transient
 * that is faster than itself. */
bool dalcs_jumps_agree(const struct dalcs_system *s, const double *x, const double *limit,
                       const double *last, const double *after) {
    double largest[2] = {0.0, 0.0};
    for (int i = 0; i < s->n_x; i++) {
        double *most = &largest[s->column_is_current[i]];
        *most = fmax(*most, fmax(fabs(limit[i] - x[i]), fabs(after[i] - x[i])));
    }
    bool agree = true;
    for (int i = 0; i < s->n_x && agree; i++) {
        agree = fabs(after[i] - limit[i]) <=
                dalcs_small * largest[s->column_is_current[i]] + fabs(limit[i] - last[i]);
    }
    return agree;
}

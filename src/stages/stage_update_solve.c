/* stage_update_solve.c - solutions of a mode that is an update of another: stage_update.c has the equations. */
#include "stage_update.h"

#include <string.h>

/* Row i of V times lu[system].work. */
static double row_times_work(const struct dalcs_stage_factors *f, int i, int system, int part) {
    const struct dalcs_stage_update *u = f->update;
    const struct dalcs_stage_change *c = u->change[i];
    const int *position = f->order[system].position;
    const double *work = f->lu[system].work + part;
    int stride = system > 0 ? 2 : 1;
    if (i >= u->n_closed) {
        return work[c->lambda_at[system] * stride];
    }
    double sum = 0.0;
    for (int k = 0; k < c->n_terms; k++) {
        sum += c->value[k] * work[position[c->unknown[k]] * stride];
    }
    return sum;
}

/* t into the slots of what closes, and nothing is asked of what opens. */
static void load(const struct dalcs_stage_plan *plan, const struct dalcs_stage_factors *f,
                 int system, int share) {
    const struct dalcs_stage_update *u = f->update;
    int stride = system > 0 ? 2 : 1;
    double *work = f->lu[system].work;
    for (int i = u->n_closed; i < u->n_changes; i++) {
        memset(work + u->change[i]->row_at[system] * stride, 0, (size_t)stride * sizeof(double));
    }
    for (int i = 0; i < u->n_closed; i++) {
        int row = f->n - f->n_pairs + u->change[i]->pair;
        double *t = work + (f->lu[system].n + i) * stride;
        for (int part = 0; part < stride; part++) {
            double sum = part == 0 ? plan->work.rhs[row] : 0.0;
            for (int k = plan->waves.wave_begin[row]; k < plan->waves.wave_begin[row + 1]; k++) {
                sum += plan->waves.wave_x[k] *
                       plan->work.share[plan->waves.wave_of[k] * DALCS_N_SHARES + share + part];
            }
            t[part] = u->change[i]->row_scale * sum;
        }
    }
}

static void solve_real(const struct dalcs_stage_factors *f) {
    const struct dalcs_stage_update *u = f->update;
    const struct dalcs_lu *lu = &f->lu[0];
    double missed[DALCS_STAGE_MOST_CHANGES];
    dalcs_lu_solve_ordered(lu);
    for (int i = 0; i < u->n_changes; i++) {
        missed[i] = row_times_work(f, i, 0, 0) - (i < u->n_closed ? lu->work[lu->n + i] : 0.0);
    }
    for (int i = 0; i < u->n_changes; i++) {
        const long double *inverse = u->inverse[0] + i * u->n_changes;
        long double nu = 0.0L;
        for (int j = 0; j < u->n_changes; j++) {
            nu += inverse[j] * missed[j];
        }
        dalcs_stage_response_subtract(&u->change[i]->response[0], (double)nu, lu->work);
        if (i < u->n_closed) {
            lu->work[lu->n + i] = (double)nu;
        }
    }
}

static void solve_complex(const struct dalcs_stage_factors *f, int system) {
    const struct dalcs_stage_update *u = f->update;
    const struct dalcs_lu *lu = &f->lu[system];
    int k = u->n_changes;
    double missed[2 * DALCS_STAGE_MOST_CHANGES];
    dalcs_lu_solve_ordered_complex(lu);
    for (int i = 0; i < 2 * k; i++) {
        double t = i < 2 * u->n_closed ? lu->work[2 * lu->n + i] : 0.0;
        missed[i] = row_times_work(f, i / 2, system, i % 2) - t;
    }
    for (int i = 0; i < k; i++) {
        const long double *re = u->inverse[system] + i * k;
        const long double *im = re + k * k;
        long double nu[2] = {0.0L};
        for (int j = 0; j < k; j++) {
            nu[0] += re[j] * missed[2 * j] - im[j] * missed[2 * j + 1];
            nu[1] += re[j] * missed[2 * j + 1] + im[j] * missed[2 * j];
        }
        dalcs_stage_response_subtract_complex(&u->change[i]->response[system], (double)nu[0],
                                              (double)nu[1], lu->work);
        for (int part = 0; i < u->n_closed && part < 2; part++) {
            lu->work[2 * (lu->n + i) + part] = (double)nu[part];
        }
    }
}

void dalcs_stage_update_solve(const struct dalcs_stage_plan *plan,
                              const struct dalcs_stage_factors *f, int system, int share) {
    load(plan, f, system, share);
    if (system == 0) {
        solve_real(f);
    } else {
        solve_complex(f, system);
    }
}

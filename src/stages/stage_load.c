/* stage_load.c - right-hand sides of a step on sparse factors, and the systems that they are solved by. */
#include "stage_load.h"

#include "stage_update.h"

#include <string.h>

void dalcs_stage_find_shares(const struct dalcs_stages *stages, const struct dalcs_stage_factors *f,
                             const double *coefficient) {
    const struct dalcs_excitation *e = stages->excitation;
    double *share = stages->plan->work.share;
    for (int w = 0; w < e->n_waves; w++, share += DALCS_N_SHARES) {
        for (int k = 0; k < DALCS_N_SHARES; k++) {
            share[k] = 0.0;
        }
        for (int i = e->wave[w].first; i < e->wave[w].first + e->wave[w].n_functions; i++) {
            const double *of_one = f->function_share + i * DALCS_N_SHARES;
            for (int k = 0; k < DALCS_N_SHARES; k++) {
                share[k] += coefficient[i] * of_one[k];
            }
        }
    }
}

static void find_drive_of_row(const struct dalcs_stage_plan *plan, const struct dalcs_csr *drive,
                              int r, const double *y, double factor) {
    plan->work.rhs[r] = factor * plan->constant[r] + dalcs_csr_row_dot(drive, r, y);
}

void dalcs_stage_find_drive(const struct dalcs_stage_plan *plan,
                            const struct dalcs_stage_factors *f, const struct dalcs_csr *drive,
                            const double *y, double factor) {
    int n_equations = f->n - f->n_pairs;
    for (int r = 0; r < n_equations; r++) {
        find_drive_of_row(plan, drive, r, y, factor);
    }
    for (int k = 0; k < f->n_pairs; k++) {
        find_drive_of_row(plan, drive, n_equations + f->pair[k], y, factor);
    }
    const struct dalcs_stage_update *u = f->update;
    for (int k = u != NULL ? u->n_closed : 0; u != NULL && k < u->n_changes; k++) { /* to a slack */
        find_drive_of_row(plan, drive, n_equations + u->change[k]->pair, y, factor);
    }
    for (int k = 0; k < f->singular.n; k++) {
        const struct dalcs_csr *shore = &f->singular.shore;
        double sum = -dalcs_csr_row_dot(&f->singular.choice, k, y);
        for (int e = shore->p[k]; e < shore->p[k + 1]; e++) {
            int pair = shore->j[e];
            double knee = dalcs_system_knee(plan->stages->system, pair);
            sum += factor * shore->x[e] * (plan->constant[n_equations + pair] + knee);
        }
        plan->work.rhs[plan->n_rows + k] = sum;
    }
}

void dalcs_stage_find_start(const struct dalcs_stage_plan *plan,
                            const struct dalcs_stage_factors *f, const double *x) {
    int n_x = plan->stages->system->n_x;
    int n_equations = f->n - f->n_pairs;
    memcpy(plan->work.from, x, (size_t)n_x * sizeof(double));
    memcpy(plan->work.from + n_x, plan->work.near + n_x,
           (size_t)(n_equations - n_x) * sizeof(double));
    memset(plan->work.from + n_equations, 0, (size_t)(plan->n_rows - n_equations) * sizeof(double));
    for (int k = 0; k < f->n_pairs; k++) {
        plan->work.from[n_equations + f->pair[k]] = plan->work.near[n_equations + f->pair[k]];
    }
}

/* Adds the waves in the reverse voltages of choice k. */
static void load_choice(const struct dalcs_stage_plan *plan, const struct dalcs_stage_factors *f,
                        int system, int share, int k) {
    const struct dalcs_stage_order *o = &f->order[system];
    const struct dalcs_csr *shore = &f->singular.shore;
    int at = o->choice_at[k];
    int stride = system > 0 ? 2 : 1;
    for (int e = shore->p[k]; e < shore->p[k + 1]; e++) {
        int row = f->n - f->n_pairs + shore->j[e];
        for (int i = plan->waves.wave_begin[row]; i < plan->waves.wave_begin[row + 1]; i++) {
            const double *of_wave =
                plan->work.share + plan->waves.wave_of[i] * DALCS_N_SHARES + share;
            for (int part = 0; part < stride; part++) {
                f->lu[system].work[at * stride + part] +=
                    o->scale[at] * shore->x[e] * plan->waves.wave_x[i] * of_wave[part];
            }
        }
    }
}

/* lu[system].work = the balanced right-hand side in its order, plan->work.rhs and a
 * share of the waves. */
static void load(const struct dalcs_stage_plan *plan, const struct dalcs_stage_factors *f,
                 int system, int share) {
    const struct dalcs_stage_order *o = &f->order[system];
    double *restrict work = f->lu[system].work;
    int stride = system > 0 ? 2 : 1;
    if (stride == 1) {
        for (int i = 0; i < o->n; i++) {
            work[i] = o->scale[i] * plan->work.rhs[o->row_of[i]];
        }
    } else {
        for (int i = 0; i < o->n; i++) {
            work[2 * i] = o->scale[i] * plan->work.rhs[o->row_of[i]];
            work[2 * i + 1] = 0.0;
        }
    }
    for (int k = 0; k < plan->waves.n_waves; k++) {
        int at = o->wave_at[k];
        const double *of_wave = plan->work.share + plan->waves.wave_of[k] * DALCS_N_SHARES + share;
        for (int part = 0; at >= 0 && part < stride; part++) {
            work[at * stride + part] += o->scale[at] * plan->waves.wave_x[k] * of_wave[part];
        }
    }
    for (int k = 0; k < f->singular.n; k++) {
        load_choice(plan, f, system, share, k);
    }
}

void dalcs_stage_solve_loaded(const struct dalcs_stage_plan *plan,
                              const struct dalcs_stage_factors *f, int system, int share) {
    load(plan, f, system, share);
    if (f->update != NULL) {
        dalcs_stage_update_solve(plan, f, system, share);
    } else if (system == 0) {
        dalcs_lu_solve_ordered(&f->lu[0]);
    } else {
        dalcs_lu_solve_ordered_complex(&f->lu[system]);
    }
}

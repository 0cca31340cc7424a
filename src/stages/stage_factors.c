/* stage_factors.c - a step of a large system in one mode, on sparse factors.
 *
 * The same answer as stage_map.c, solved anew for every step: one system for the real eigenvalue,
 * one for each conjugate pair, and on the real one again what the error estimates need. The scales
 * of the balancing and the orders of the factors are folded into loading and unloading them. */
#include "stage_factors.h"

#include "dense_map.h"
#include "stage_update.h"

#include <math.h>
#include <string.h>

/* Shares of the waves in this step. */
static void find_shares(const struct dalcs_stages *stages, const struct dalcs_stage_factors *f,
                        const double *coefficient) {
    const struct dalcs_excitation *e = stages->excitation;
    double *share = stages->plan->share;
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
    plan->rhs[r] = factor * plan->constant[r] + dalcs_csr_row_dot(drive, r, y);
}

/* plan->rhs = drive y + factor * constant, of the rows that are present. */
static void find_drive(const struct dalcs_stage_plan *plan, const struct dalcs_stage_factors *f,
                       const struct dalcs_csr *drive, const double *y, double factor) {
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
        plan->rhs[plan->n_rows + k] = sum;
    }
}

/* plan->from = the state and, of the rest, where the circuit was last: unknowns are increments over it. */
static void find_start(const struct dalcs_stage_plan *plan, const struct dalcs_stage_factors *f,
                       const double *x) {
    int n_x = plan->stages->system->n_x;
    int n_equations = f->n - f->n_pairs;
    memcpy(plan->from, x, (size_t)n_x * sizeof(double));
    memcpy(plan->from + n_x, plan->near + n_x, (size_t)(n_equations - n_x) * sizeof(double));
    memset(plan->from + n_equations, 0, (size_t)(plan->n_rows - n_equations) * sizeof(double));
    for (int k = 0; k < f->n_pairs; k++) {
        plan->from[n_equations + f->pair[k]] = plan->near[n_equations + f->pair[k]];
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
        for (int i = plan->wave_begin[row]; i < plan->wave_begin[row + 1]; i++) {
            const double *of_wave = plan->share + plan->wave_of[i] * DALCS_N_SHARES + share;
            for (int part = 0; part < stride; part++) {
                f->lu[system].work[at * stride + part] +=
                    o->scale[at] * shore->x[e] * plan->wave_x[i] * of_wave[part];
            }
        }
    }
}

/* lu[system].work = the balanced right-hand side in its order, plan->rhs and a
 * share of the waves. */
static void load(const struct dalcs_stage_plan *plan, const struct dalcs_stage_factors *f,
                 int system, int share) {
    const struct dalcs_stage_order *o = &f->order[system];
    double *restrict work = f->lu[system].work;
    int stride = system > 0 ? 2 : 1;
    if (stride == 1) {
        for (int i = 0; i < o->n; i++) {
            work[i] = o->scale[i] * plan->rhs[o->row_of[i]];
        }
    } else {
        for (int i = 0; i < o->n; i++) {
            work[2 * i] = o->scale[i] * plan->rhs[o->row_of[i]];
            work[2 * i + 1] = 0.0;
        }
    }
    for (int k = 0; k < plan->n_waves; k++) {
        int at = o->wave_at[k];
        const double *of_wave = plan->share + plan->wave_of[k] * DALCS_N_SHARES + share;
        for (int part = 0; at >= 0 && part < stride; part++) {
            work[at * stride + part] += o->scale[at] * plan->wave_x[k] * of_wave[part];
        }
    }
    for (int k = 0; k < f->singular.n; k++) {
        load_choice(plan, f, system, share, k);
    }
}

/* Of plan->rhs and a share of the waves: the unknowns of a system, balanced, to lu.work. */
static void solve(const struct dalcs_stage_plan *plan, const struct dalcs_stage_factors *f,
                  int system, int share) {
    load(plan, f, system, share);
    if (f->update != NULL) {
        dalcs_stage_update_solve(plan, f, system, share);
    } else if (system == 0) {
        dalcs_lu_solve_ordered(&f->lu[0]);
    } else {
        dalcs_lu_solve_ordered_complex(&f->lu[system]);
    }
}

/* Some unknowns of all systems: a dense map from the weights of a node to their values there. */
struct piece {
    _Alignas(64) double part[DALCS_SOLUTION_PARTS * DALCS_STAGE_PIECE];
    double y[DALCS_STAGE_PIECE];
    int n_rows;
};

/* Positions of unknowns from `first` on, which are all equations' or all pairs'. */
static const int *positions(const struct dalcs_stage_factors *f, int system, int first) {
    const struct dalcs_stage_order *o = &f->order[system];
    int n_equations = f->n - f->n_pairs;
    return first < n_equations ? o->position + first : o->of_pair + (first - n_equations);
}

/* count unknowns of all systems, from `first` on, unscaled. */
static void unload(const struct dalcs_stage_factors *f, int first, int count, struct piece *piece) {
    int n_equations = f->n - f->n_pairs;
    const double *scale =
        first < n_equations ? f->column_scale + first : f->pair_scale + (first - n_equations);
    const int *position = positions(f, 0, first);
    const double *work = f->lu[0].work;
    double *part = piece->part;
    piece->n_rows = dalcs_dense_map_rows(count);
    for (int k = 0; k < count; k++) {
        part[k] = scale[k] * work[position[k]];
    }
    for (int q = 1; q < f->n_systems; q++) {
        position = positions(f, q, first);
        work = f->lu[q].work;
        double *re = part + (2 * q - 1) * piece->n_rows;
        double *im = re + piece->n_rows;
        for (int k = 0; k < count; k++) {
            re[k] = scale[k] * work[2 * position[k]];
            im[k] = scale[k] * work[2 * position[k] + 1];
        }
    }
}

enum kind { STATES, WITHOUT_MEMORY, PAIRS };

/* Puts count unknowns of one kind at one node into y. */
static void put_piece(const struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry,
                      const struct piece *piece, enum kind kind, int first, int count, int node,
                      double *y) {
    const struct dalcs_stage_factors *f = entry->factors;
    const double *from = plan->from;
    int n_equations = f->n - f->n_pairs;
    if (kind == STATES && node == 0) {
        for (int k = 0; k < count; k++) {
            y[first + k] = from[first + k];
            plan->missed[first + k] = -piece->y[k];
        }
    } else if (kind != PAIRS) {
        for (int k = 0; k < count; k++) {
            y[first + k] = from[first + k] + piece->y[k];
        }
    } else {
        for (int k = 0; k < count; k++) {
            int at = n_equations + f->pair[first + k - n_equations];
            y[at] = from[at] + piece->y[k];
        }
    }
}

/* Unknowns from `begin` up to `end`, of one kind, at all nodes. */
static void put_kind(const struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry,
                     int begin, int end, enum kind kind, struct piece *piece, double *out) {
    const struct dalcs_stage_layout *l = &plan->stages->layout;
    for (int first = begin; first < end; first += DALCS_STAGE_PIECE) {
        int count = end - first;
        count = count < DALCS_STAGE_PIECE ? count : DALCS_STAGE_PIECE;
        unload(entry->factors, first, count, piece);
        for (int node = 0; node <= plan->stages->method->n_stages; node++) {
            dalcs_dense_map_apply(piece->n_rows, plan->n_parts, piece->part, plan->to[node],
                                  piece->y);
            put_piece(plan, entry, piece, kind, first, count, node, out + node * l->stride);
        }
    }
}

/* Columns at all nodes; the start still without its defect. plan->missed = what the states miss
 * there. */
static void put_columns(const struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry,
                        double *out) {
    const struct dalcs_stage_factors *f = entry->factors;
    int n_x = plan->stages->system->n_x;
    int n_equations = f->n - f->n_pairs;
    struct piece piece;
    memset(&piece, 0, sizeof(piece));
    put_kind(plan, entry, 0, n_x, STATES, &piece, out);
    put_kind(plan, entry, n_x, n_equations, WITHOUT_MEMORY, &piece, out);
    put_kind(plan, entry, n_equations, f->n, PAIRS, &piece, out);
}

static double find_w(const struct dalcs_stage_plan *plan, int pair, double constant, int share,
                     const double *columns) {
    const struct dalcs_system *s = plan->stages->system;
    int row = dalcs_system_n_equations(s) + pair;
    double w = dalcs_csr_row_dot(&s->C, pair, columns) - constant * plan->constant[row];
    for (int k = plan->wave_begin[row]; k < plan->wave_begin[row + 1]; k++) {
        w -= plan->wave_x[k] * plan->share[plan->wave_of[k] * DALCS_N_SHARES + share];
    }
    return w;
}

/* Puts w of the open diodes in the place of their lambda, which is 0 so far, and the watched
 * voltages, if asked for, behind the columns. */
static void put_other_sides(const struct dalcs_stage_plan *plan,
                            const struct dalcs_stage_entry *entry, double constant, int share,
                            bool with_watched, double *columns) {
    const struct dalcs_stages *stages = plan->stages;
    const struct dalcs_system *s = stages->system;
    int n_equations = dalcs_system_n_equations(s);
    double *lambda = columns + n_equations;
    for (int d = 0; d < s->n_pairs; d++) {
        plan->guard[d] = dalcs_stage_is_on(entry, d) || s->pair[d].kind != DALCS_PAIR_DIODE
                             ? lambda[d]
                             : find_w(plan, d, constant, share, columns);
    }
    for (int i = 0; with_watched && i < stages->n_watched; i++) {
        int d = stages->watched[i];
        columns[dalcs_system_n_columns(s) + i] = dalcs_csr_row_dot(&s->control, d, columns);
    }
    memcpy(lambda, plan->guard, (size_t)s->n_pairs * sizeof(double));
}

/* How far the equations disagree at each stage: what is missed by those that should follow from the
 * others. */
static void put_clashes(const struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                        const double *in, double *out) {
    const struct dalcs_stage_singular *g = &entry->factors->singular;
    const struct dalcs_stage_layout *l = &stages->layout;
    double *clash = out + l->n_fixed;
    for (int k = 0; k < g->n; k++) {
        for (int node = 1; node < l->n_nodes; node++) {
            double terms;
            *clash++ =
                g->scale[k] * dalcs_stage_factors_miss_of_row(stages, entry, g->row[k], node, in,
                                                              out + node * l->stride, &terms);
        }
    }
}

/* columns = factor times the real system's states. */
static void put_states(const struct dalcs_stage_plan *plan, const struct dalcs_stage_factors *f,
                       double factor, double *columns) {
    for (int x = 0; x < plan->stages->system->n_x; x++) {
        columns[x] = factor * f->column_scale[x] * f->lu[0].work[f->order[0].position[x]];
    }
}

/* columns += the real system's unknowns from `begin` up to `end`. */
static void add_unknowns(const struct dalcs_stage_factors *f, int begin, int end, double *columns) {
    for (int u = begin; u < end; u++) {
        columns[u] += f->column_scale[u] * f->lu[0].work[f->order[0].position[u]];
    }
}

/* The same with those that have no memory and with lambda. */
static void add_real(const struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry,
                     double *columns) {
    const struct dalcs_stage_factors *f = entry->factors;
    const double *work = f->lu[0].work;
    int n_equations = f->n - f->n_pairs;
    add_unknowns(f, plan->stages->system->n_x, n_equations, columns);
    for (int k = 0; k < f->n_pairs; k++) {
        columns[n_equations + f->pair[k]] += f->pair_scale[k] * work[f->order[0].of_pair[k]];
    }
}

enum dalcs_status dalcs_stage_factors_apply(struct dalcs_stages *stages,
                                            const struct dalcs_stage_entry *entry, const double *in,
                                            double *out) {
    const struct dalcs_stage_plan *plan = stages->plan;
    const struct dalcs_stage_factors *f = entry->factors;
    const struct dalcs_stage_layout *l = &stages->layout;
    int n_x = stages->system->n_x;
    int n_columns = dalcs_system_n_columns(stages->system);
    memset(out, 0, (size_t)l->n_fixed * sizeof(double));
    find_shares(stages, f, in + n_x + 1);
    find_start(plan, f, in);
    find_drive(plan, f, &plan->drive, plan->from, in[n_x]);
    for (int q = 0; q < f->n_systems; q++) {
        solve(plan, f, q, q == 0 ? DALCS_SHARE_REAL : DALCS_SHARE_PAIR + 2 * (q - 1));
    }
    put_columns(plan, entry, out);
    put_clashes(stages, entry, in, out);
    find_drive(plan, f, &plan->drive_of_states, plan->missed, 0.0);
    solve(plan, f, 0, DALCS_SHARE_DRIFT);
    put_states(plan, f, 1.0, out + l->drift);
    add_real(plan, entry, out);
    if (n_x > 0) {
        /* What was added goes with states that are off by the drift: take that back as well. */
        put_states(plan, f, -1.0, plan->missed);
        find_drive(plan, f, &plan->drive_of_states, plan->missed, 0.0);
        solve(plan, f, 0, DALCS_SHARE_NONE);
        add_real(plan, entry, out);
        put_states(plan, f, -1.0, plan->missed); /* what the filter leaves of it */
    }
    for (int node = 0; node <= stages->method->n_stages; node++) {
        put_other_sides(plan, entry, in[n_x], node, true, out + node * l->stride);
    }
    if (stages->excitation->is_curved) {
        memset(plan->rhs, 0, (size_t)(n_columns + f->singular.n) * sizeof(double));
        solve(plan, f, 0, DALCS_SHARE_RIPPLE_RATE);
        add_unknowns(f, 0, n_x, out + l->ripple);
        add_real(plan, entry, out + l->ripple);
        put_other_sides(plan, entry, 0.0, DALCS_SHARE_RIPPLE, false, out + l->ripple);
    }
    return DALCS_OK;
}

void dalcs_stage_factors_currents(const struct dalcs_stages *stages,
                                  const struct dalcs_stage_entry *entry, double *drift) {
    const struct dalcs_stage_plan *plan = stages->plan;
    const struct dalcs_stage_factors *f = entry->factors;
    find_drive(plan, f, &plan->drive_of_states, plan->missed, 0.0);
    solve(plan, f, 0, DALCS_SHARE_NONE);
    memset(plan->missed, 0, (size_t)plan->n_rows * sizeof(double));
    add_unknowns(f, stages->system->n_x, f->n - f->n_pairs, plan->missed);
    for (int k = 0; k < stages->n_levered; k++) {
        drift[k] = plan->missed[stages->levered[k]];
    }
    memset(plan->missed, 0, (size_t)plan->n_rows * sizeof(double));
}

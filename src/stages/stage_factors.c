/* stage_factors.c - a step of a large system in one mode, on sparse factors.
 *
 * The same answer as stage_map.c, solved anew for every step: one system for the real eigenvalue,
 * one for each conjugate pair, and on the real one again what the error estimates need. The scales
 * of the balancing and the orders of the factors are folded into loading and unloading them. */
#include "stage_factors.h"

#include "dense_map.h"
#include "extremes.h"
#include "stage_load.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum kind { STATES, WITHOUT_MEMORY, PAIRS };

/* Some unknowns of all systems, of one kind: a dense map from the weights of a node to their values there. */
struct piece {
    _Alignas(64) double part[DALCS_SOLUTION_PARTS * DALCS_STAGE_PIECE];
    double y[DALCS_STAGE_PIECE];
    int n_rows;
    enum kind kind;
    int first, count;
};

/* Positions of unknowns from `first` on, which are all equations' or all pairs'. */
static const int *positions(const struct dalcs_stage_factors *f, int system, int first) {
    const struct dalcs_stage_order *o = &f->order[system];
    int n_equations = f->n - f->n_pairs;
    return first < n_equations ? o->position + first : o->of_pair + (first - n_equations);
}

/* Unscaled. */
static void unload(const struct dalcs_stage_factors *f, struct piece *piece) {
    const int first = piece->first;
    const int count = piece->count;
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

/* Puts those at one node into y. */
static void put_piece(const struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry,
                      const struct piece *piece, int node, double *y) {
    const enum kind kind = piece->kind;
    const int first = piece->first;
    const int count = piece->count;
    const struct dalcs_stage_factors *f = entry->factors;
    const double *from = plan->work.from;
    int n_equations = f->n - f->n_pairs;
    if (kind == STATES && node == 0) {
        for (int k = 0; k < count; k++) {
            y[first + k] = from[first + k];
            plan->work.missed[first + k] = -piece->y[k];
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

/* Unknowns from `begin` up to `end`, of the piece's kind, at all nodes. */
static void put_kind(const struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry,
                     int begin, int end, struct piece *piece, double *out) {
    const struct dalcs_stage_layout *l = &plan->stages->layout;
    for (int first = begin; first < end; first += DALCS_STAGE_PIECE) {
        int count = end - first;
        piece->first = first;
        piece->count = count < DALCS_STAGE_PIECE ? count : DALCS_STAGE_PIECE;
        unload(entry->factors, piece);
        for (int node = 0; node <= plan->stages->method->n_stages; node++) {
            dalcs_dense_map_apply(piece->n_rows, plan->n_parts, piece->part, plan->to[node],
                                  piece->y);
            put_piece(plan, entry, piece, node, out + node * l->stride);
        }
    }
}

/* Columns at all nodes; the start still without its defect. plan->work.missed = what the states miss
 * there. */
static void put_columns(const struct dalcs_stage_plan *plan, const struct dalcs_stage_entry *entry,
                        double *out) {
    const struct dalcs_stage_factors *f = entry->factors;
    int n_x = plan->stages->system->n_x;
    int n_equations = f->n - f->n_pairs;
    struct piece piece;
    memset(&piece, 0, sizeof(piece));
    piece.kind = STATES;
    put_kind(plan, entry, 0, n_x, &piece, out);
    piece.kind = WITHOUT_MEMORY;
    put_kind(plan, entry, n_x, n_equations, &piece, out);
    piece.kind = PAIRS;
    put_kind(plan, entry, n_equations, f->n, &piece, out);
}

static double find_w(const struct dalcs_stage_plan *plan, int pair, double constant, int share,
                     const double *columns) {
    const struct dalcs_system *s = plan->stages->system;
    int row = dalcs_system_n_equations(s) + pair;
    double w = dalcs_csr_row_dot(&s->C, pair, columns) - constant * plan->constant[row];
    for (int k = plan->waves.wave_begin[row]; k < plan->waves.wave_begin[row + 1]; k++) {
        w -= plan->waves.wave_x[k] *
             plan->work.share[plan->waves.wave_of[k] * DALCS_N_SHARES + share];
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
        plan->work.guard[d] = dalcs_stage_is_on(entry, d) || s->pair[d].kind != DALCS_PAIR_DIODE
                                  ? lambda[d]
                                  : find_w(plan, d, constant, share, columns);
    }
    for (int i = 0; with_watched && i < stages->n_watched; i++) {
        int d = stages->watched[i];
        columns[dalcs_system_n_columns(s) + i] = dalcs_csr_row_dot(&s->control, d, columns);
    }
    memcpy(lambda, plan->work.guard, (size_t)s->n_pairs * sizeof(double));
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
            struct dalcs_row_miss miss = dalcs_stage_factors_miss_of_row(
                stages, entry, g->row[k], node, in, out + node * l->stride);
            *clash++ = g->scale[k] * miss.missed;
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

/* What no solution is put into: pairs without a current, and what ripple is added to. The columns of equations are most of
 * `out`, and all of them are put. */
static void clear_rest(const struct dalcs_stages *stages, double *out) {
    const struct dalcs_stage_layout *l = &stages->layout;
    int n_equations = dalcs_system_n_equations(stages->system);
    for (int node = 0; node <= stages->method->n_stages; node++) {
        memset(out + node * l->stride + n_equations, 0,
               (size_t)(l->stride - n_equations) * sizeof(double));
    }
    memset(out + l->ripple, 0, (size_t)(l->n_fixed - l->ripple) * sizeof(double));
}

enum dalcs_status dalcs_stage_factors_apply(struct dalcs_stages *stages,
                                            const struct dalcs_stage_entry *entry, const double *in,
                                            double *out) {
    const struct dalcs_stage_plan *plan = stages->plan;
    const struct dalcs_stage_factors *f = entry->factors;
    const struct dalcs_stage_layout *l = &stages->layout;
    int n_x = stages->system->n_x;
    int n_columns = dalcs_system_n_columns(stages->system);
    clear_rest(stages, out);
    dalcs_stage_find_shares(stages, f, in + n_x + 1);
    dalcs_stage_find_start(plan, f, in);
    dalcs_stage_find_drive(plan, f, &plan->drive, plan->work.from, in[n_x]);
    for (int q = 0; q < f->n_systems; q++) {
        dalcs_stage_solve_loaded(plan, f, q,
                                 q == 0 ? DALCS_SHARE_REAL : DALCS_SHARE_PAIR + 2 * (q - 1));
    }
    put_columns(plan, entry, out);
    put_clashes(stages, entry, in, out);
    dalcs_stage_find_drive(plan, f, &plan->drive_of_states, plan->work.missed, 0.0);
    dalcs_stage_solve_loaded(plan, f, 0, DALCS_SHARE_DRIFT);
    put_states(plan, f, 1.0, out + l->drift);
    add_real(plan, entry, out);
    if (n_x > 0) {
        /* The correction belongs to states that are off by the drift: undo that as well. */
        put_states(plan, f, -1.0, plan->work.missed);
        dalcs_stage_find_drive(plan, f, &plan->drive_of_states, plan->work.missed, 0.0);
        dalcs_stage_solve_loaded(plan, f, 0, DALCS_SHARE_NONE);
        add_real(plan, entry, out);
        put_states(plan, f, -1.0, plan->work.missed); /* what the filter leaves of it */
    }
    for (int node = 0; node <= stages->method->n_stages; node++) {
        put_other_sides(plan, entry, in[n_x], node, true, out + node * l->stride);
    }
    if (stages->excitation->is_curved) {
        memset(plan->work.rhs, 0, (size_t)(n_columns + f->singular.n) * sizeof(double));
        dalcs_stage_solve_loaded(plan, f, 0, DALCS_SHARE_RIPPLE_RATE);
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
    dalcs_stage_find_drive(plan, f, &plan->drive_of_states, plan->work.missed, 0.0);
    dalcs_stage_solve_loaded(plan, f, 0, DALCS_SHARE_NONE);
    memset(plan->work.missed, 0, (size_t)plan->n_rows * sizeof(double));
    add_unknowns(f, stages->system->n_x, f->n - f->n_pairs, plan->work.missed);
    for (int k = 0; k < stages->n_levered; k++) {
        drift[k] = plan->work.missed[stages->levered[k]];
    }
    memset(plan->work.missed, 0, (size_t)plan->n_rows * sizeof(double));
}

/* The largest state in the balance of the real system. */
static double largest_missed(const struct dalcs_stage_plan *plan,
                             const struct dalcs_stage_factors *f) {
    double largest = 0.0;
    for (int x = 0; x < plan->stages->system->n_x; x++) {
        largest = dalcs_larger(largest, fabs(plan->work.missed[x]) / f->column_scale[x]);
    }
    return largest;
}

/* Puts the other sides of open diodes and the watched voltages where a change of the columns moves them. */
static void move_other_sides(const struct dalcs_stages *stages,
                             const struct dalcs_stage_entry *entry, const double *change,
                             double *columns) {
    const struct dalcs_system *s = stages->system;
    const int n_equations = dalcs_system_n_equations(s);
    for (int d = 0; d < s->n_pairs; d++) {
        if (!dalcs_stage_is_on(entry, d) && s->pair[d].kind == DALCS_PAIR_DIODE) {
            columns[n_equations + d] += dalcs_csr_row_dot(&s->C, d, change);
        }
    }
    for (int i = 0; i < stages->n_watched; i++) {
        columns[dalcs_system_n_columns(s) + i] +=
            dalcs_csr_row_dot(&s->control, stages->watched[i], change);
    }
}

/* The states that the rest at the start goes with are off by the drift. With H for what implicit Euler takes away from a
 * state, a solution of the real system adds what belongs to (1 - H) of that and leaves H of it. The first such solution
 * is in the answer; the others are the rest of 1 + H + H^2 + ..., as long as that gains a digit of doubles each time. */
void dalcs_stage_factors_settle(const struct dalcs_stages *stages,
                                const struct dalcs_stage_entry *entry, double *out) {
    const struct dalcs_stage_plan *plan = stages->plan;
    const struct dalcs_stage_factors *f = entry->factors;
    const int n_columns = dalcs_system_n_columns(stages->system);
    double *change = plan->work.from;
    memset(change, 0, (size_t)n_columns * sizeof(double));
    for (int x = 0; x < stages->system->n_x; x++) {
        plan->work.missed[x] = -out[stages->layout.drift + x];
    }
    double before = INFINITY;
    double now = largest_missed(plan, f);
    for (int round = 0; round < DBL_MANT_DIG && now > 0.0 && 2.0 * now <= before; round++) {
        dalcs_stage_find_drive(plan, f, &plan->drive_of_states, plan->work.missed, 0.0);
        dalcs_stage_solve_loaded(plan, f, 0, DALCS_SHARE_NONE);
        put_states(plan, f, -1.0, plan->work.missed);
        before = now;
        now = largest_missed(plan, f);
        if (round > 0 && 2.0 * now <= before) {
            add_real(plan, entry, change);
        }
    }
    memset(plan->work.missed, 0, (size_t)plan->n_rows * sizeof(double));
    for (int c = 0; c < n_columns; c++) {
        out[c] += change[c];
    }
    move_other_sides(stages, entry, change, out);
}

/* stage_map.c - a step of a small system in one mode as one dense matrix: its columns are combinations
 * of the few solutions that the workshop has for unit states and unit inputs. */
#include "dense_map.h"
#include "stage_workshop.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a null vector does to a diode, beside its largest entry, is rounding up to this: currents around a
 * loop of sources are nothing to diodes. */
static const double null_rounding = 1e-10;

/* The other side of pair d: lambda where it is closed, w where it is open, from unknowns and from the
 * share of the source column (wave < 0: none) at this node. */
static double other_side(const struct dalcs_stage_workshop *b, int d, const double *y,
                         int rhs_column, double share) {
    const struct dalcs_system *s = b->system;
    double w = 0.0;
    for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
        int c = b->place[s->C.j[k]];
        w += c >= 0 ? s->C.x[k] * y[c] : 0.0;
    }
    for (int k = s->F.p[d]; k < s->F.p[d + 1]; k++) {
        int wave = b->wave_column[s->F.j[k]];
        if (wave == rhs_column && wave >= 0) {
            w += s->F.x[k] * share;
        } else if (wave < 0 && rhs_column == b->n_x) {
            w += s->F.x[k] * share * b->stages->excitation->constant[s->F.j[k]];
        }
    }
    return w;
}

static void find_guards(const struct dalcs_stage_workshop *b, const double *y, int rhs_column,
                        double share) {
    int n_equations = dalcs_system_n_equations(b->system);
    for (int d = 0; d < b->system->n_pairs; d++) {
        b->guard[d] = 0.0;
        if (!dalcs_stage_is_on(b->entry, d) && b->system->pair[d].kind == DALCS_PAIR_DIODE) {
            b->guard[d] = other_side(b, d, y, rhs_column, share);
        }
    }
    for (int k = 0; k < b->entry->n_on; k++) {
        b->guard[b->entry->on[k]] = y[n_equations + k];
    }
}

/* choice = - pseudoinverse of the guards of the null vectors: adding choice * guards of them makes the
 * diodes' lambda and w as small as possible. Diodes only: a switch's current is a wire's. */
static enum dalcs_status prepare_choice(struct dalcs_stage_workshop *b) {
    int n_pairs = b->system->n_pairs;
    int rows = n_pairs > b->nullity ? n_pairs : b->nullity;
    if (b->nullity == 0 || n_pairs == 0) {
        return DALCS_OK;
    }
    double *guards = dalcs_stage_workshop_reals(&b->arena, n_pairs * b->nullity);
    double *identity = dalcs_stage_workshop_reals(&b->arena, rows * n_pairs);
    double *singular = dalcs_stage_workshop_reals(&b->arena, b->nullity + n_pairs);
    b->choice = dalcs_stage_workshop_reals(&b->arena, b->nullity * n_pairs);
    if (guards == NULL || identity == NULL || singular == NULL || b->choice == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < b->nullity; k++) {
        double largest = 0.0;
        for (int i = 0; i < b->n; i++) {
            b->right[k * b->n + i] *= b->column_scale[i];
            largest = fmax(largest, fabs(b->right[k * b->n + i]));
        }
        for (int i = 0; i < b->n; i++) {
            b->right[k * b->n + i] /= largest;
        }
        find_guards(b, b->right + k * b->n, -1, 0.0);
        for (int d = 0; d < n_pairs; d++) {
            guards[k * n_pairs + d] = fabs(b->guard[d]) > null_rounding ? b->guard[d] : 0.0;
        }
    }
    for (int d = 0; d < n_pairs; d++) {
        identity[d * rows + d] = 1.0;
    }
    lapack_int rank;
    if (LAPACKE_dgelss(LAPACK_COL_MAJOR, n_pairs, b->nullity, n_pairs, guards, n_pairs, identity,
                       rows, singular, 1e-10, &rank) != 0) {
        return DALCS_E_NOMEM;
    }
    for (int d = 0; d < n_pairs; d++) {
        for (int k = 0; k < b->nullity; k++) {
            b->choice[k * n_pairs + d] = -identity[d * rows + k];
        }
    }
    return DALCS_OK;
}

static void choose(const struct dalcs_stage_workshop *b, double *y, int rhs_column, double share) {
    find_guards(b, y, rhs_column, share);
    for (int k = 0; k < b->nullity && b->choice != NULL; k++) {
        double amount = 0.0;
        for (int d = 0; d < b->system->n_pairs; d++) {
            amount += b->choice[k * b->system->n_pairs + d] * b->guard[d];
        }
        for (int i = 0; i < b->n; i++) {
            y[i] += amount * b->right[k * b->n + i];
        }
    }
    if (b->nullity > 0) {
        find_guards(b, y, rhs_column, share);
    }
}

/* Unknowns y to the columns of the system, b->guard in the place of lambda. */
static void put_columns(const struct dalcs_stage_workshop *b, const double *y, double *out) {
    int n_equations = dalcs_system_n_equations(b->system);
    memcpy(out, y, (size_t)n_equations * sizeof(double));
    memcpy(out + n_equations, b->guard, (size_t)b->system->n_pairs * sizeof(double));
}

/* A watched voltage from columns and the share of a source. */
static double watched_voltage(const struct dalcs_stage_workshop *b, int d, const double *columns,
                              int rhs_column, double share) {
    const struct dalcs_system *s = b->system;
    int n_equations = dalcs_system_n_equations(s);
    double v = 0.0;
    if (!s->pair[d].is_direct) {
        for (int k = s->control.p[d]; k < s->control.p[d + 1]; k++) {
            int c = s->control.j[k];
            bool open = c >= n_equations && !dalcs_stage_is_on(b->entry, c - n_equations);
            v += open ? 0.0 : s->control.x[k] * columns[c];
        }
        return v;
    }
    for (int k = s->direct_control.p[d]; k < s->direct_control.p[d + 1]; k++) {
        int wave = b->wave_column[s->direct_control.j[k]];
        if (wave >= 0 && wave == rhs_column) {
            v += s->direct_control.x[k] * share;
        } else if (wave < 0 && rhs_column == b->n_x) {
            v += s->direct_control.x[k] * b->stages->excitation->constant[s->direct_control.j[k]];
        }
    }
    return v;
}

/* What the stages take of each part of a solution: factor[s][parts]. */
static void find_factors(const struct dalcs_stage_workshop *b, const double *share,
                         long double factor[][DALCS_SOLUTION_PARTS]) {
    const struct dalcs_collocation *m = b->stages->method;
    long double weight = 0.0L;
    for (int q = 0; q < m->s; q++) {
        weight += m->exact_from[q] * share[q + 1];
    }
    for (int i = 0; i < m->s; i++) {
        factor[i][0] = m->exact_to[i] * weight;
    }
    for (int p = 0; p < m->n_pairs; p++) {
        long double re = 0.0L;
        long double im = 0.0L;
        for (int q = 0; q < m->s; q++) {
            re += creall(m->exact_from_pair[p][q]) * share[q + 1];
            im += cimagl(m->exact_from_pair[p][q]) * share[q + 1];
        }
        for (int i = 0; i < m->s; i++) {
            long double to_re = 2.0L * creall(m->exact_to_pair[i][p]);
            long double to_im = 2.0L * cimagl(m->exact_to_pair[i][p]);
            factor[i][1 + 2 * p] = to_re * re - to_im * im;
            factor[i][2 + 2 * p] = -(to_re * im + to_im * re);
        }
    }
}

/* Those of what is the same at all stages, as states and constants are: each coordinate sees the
 * constant 1 as 1. */
static void find_constant_factors(const struct dalcs_stage_workshop *b,
                                  long double factor[][DALCS_SOLUTION_PARTS]) {
    const struct dalcs_collocation *m = b->stages->method;
    for (int i = 0; i < m->s; i++) {
        factor[i][0] = m->exact_to[i];
        for (int p = 0; p < m->n_pairs; p++) {
            factor[i][1 + 2 * p] = 2.0L * creall(m->exact_to_pair[i][p]);
            factor[i][2 + 2 * p] = -2.0L * cimagl(m->exact_to_pair[i][p]);
        }
    }
}

/* Unknown r at the stages from its increments in balanced units, into b->node and b->start. */
static void put_stages(struct dalcs_stage_workshop *b, int r, const long double *increment,
                       bool is_column) {
    const struct dalcs_collocation *m = b->stages->method;
    long double scale = b->column_scale[r];
    long double unit = is_column ? 1.0L : 0.0L;
    long double start = 0.0L;
    for (int i = 0; i < m->s; i++) {
        long double y = increment[i] * scale + unit;
        start += m->exact_back[i] * y;
        b->node[(i + 1) * b->n + r] = (double)y;
    }
    b->start[r] = start;
}

/* The stages, and how far the polynomial through them alone misses the start, into b->node, b->start
 * and, before the filter, b->defect. */
static void fill_stages(struct dalcs_stage_workshop *b, int column, int rhs_column,
                        const double *share) {
    const struct dalcs_collocation *m = b->stages->method;
    bool is_state = column < b->n_x;
    long double factor[DALCS_MAX_STAGES][DALCS_SOLUTION_PARTS] = {{0.0L}};
    if (column <= b->n_x) {
        find_constant_factors(b, factor);
    } else {
        find_factors(b, share, factor);
    }
    const long double *part = b->part + rhs_column * b->n_kept * DALCS_SOLUTION_PARTS;
    long double *stage = b->stage;
    for (int r = 0; r < b->n_kept; r++, part += DALCS_SOLUTION_PARTS, stage += DALCS_MAX_STAGES) {
        for (int i = 0; i < m->s; i++) {
            long double sum = factor[i][0] * part[0];
            for (int k = 1; k < DALCS_SOLUTION_PARTS; k++) {
                sum += factor[i][k] * part[k];
            }
            stage[i] = sum;
        }
        put_stages(b, b->kept[r], stage, is_state && b->kept[r] == column);
    }
    for (int f = 0; f < b->n_followers; f++) {
        long double increment[DALCS_MAX_STAGES];
        long double drive = dalcs_stage_workshop_drive(b, f, rhs_column);
        for (int i = 0; i < m->s; i++) {
            increment[i] = is_state ? drive : drive * share[i + 1];
        }
        for (int k = b->follows_p[f]; k < b->follows_p[f + 1]; k++) {
            stage = b->stage + b->follows_j[k] * DALCS_MAX_STAGES;
            for (int i = 0; i < m->s; i++) {
                increment[i] -= b->follows_x[k] * stage[i];
            }
        }
        put_stages(b, b->follower[f], increment, false);
    }
}

/* What the filter makes of a state that is off by `missed`. */
static void add_defect(const struct dalcs_stage_workshop *b, int x, long double missed) {
    const long double *real = b->real + x * b->n;
    for (int r = 0; r < b->n && missed != 0.0L; r++) {
        b->defect[r] += real[r] * missed;
    }
}

/* The start, and the defect of the states there after the filter, into b->node and b->drift. */
static void fill_start(struct dalcs_stage_workshop *b, int column, int rhs_column,
                       const double *share) {
    const struct dalcs_collocation *m = b->stages->method;
    int n = b->n;
    bool is_state = column < b->n_x;
    const long double *real = b->real + rhs_column * n;
    long double source_drift = share[0];
    for (int i = 1; i <= m->s; i++) {
        source_drift -= m->exact_back[i - 1] * share[i];
    }
    for (int r = 0; r < n; r++) {
        b->defect[r] = is_state ? 0.0L : real[r] * source_drift;
    }
    for (int x = 0; x < b->n_x; x++) {
        long double given = x == column ? 1.0L : 0.0L;
        add_defect(b, x, given - b->start[x]);
        b->start[x] = given;
    }
    for (int r = 0; r < n; r++) {
        b->defect[r] *= b->column_scale[r];
        b->drift[r] = (double)b->defect[r];
        b->start[r] += r < b->n_x ? 0.0L : b->defect[r];
    }
    /* What was added goes with states that are off by the defect: take that back as well. */
    for (int x = 0; x < b->n_x; x++) {
        const long double *of_state = b->real + x * n;
        for (int r = b->n_x; r < n; r++) {
            b->start[r] -= of_state[r] * b->column_scale[r] * b->defect[x];
        }
    }
    for (int r = 0; r < n; r++) {
        b->node[r] = (double)b->start[r];
    }
}

/* One column of the map: the answer to in[column] = 1. share[s + 1] are the values of the source
 * there, `missed` is what they miss of it in between; for a state all are 0. */
static void fill_column(struct dalcs_stage_workshop *b, int column, int rhs_column,
                        const double *share, double missed, double *out) {
    const struct dalcs_collocation *m = b->stages->method;
    const struct dalcs_stage_layout *l = &b->stages->layout;
    const struct dalcs_system *s = b->system;
    int n = b->n;
    bool is_state = column < b->n_x;
    fill_stages(b, column, rhs_column, share);
    fill_start(b, column, rhs_column, share);
    for (int k = 0; k <= m->s; k++) {
        double *columns = out + k * l->stride;
        choose(b, b->node + k * n, rhs_column, is_state ? 0.0 : share[k]);
        put_columns(b, b->node + k * n, columns);
        for (int i = 0; i < b->stages->n_watched; i++) {
            columns[dalcs_system_n_columns(s) + i] = watched_voltage(
                b, b->stages->watched[i], columns, rhs_column, is_state ? 0.0 : share[k]);
        }
    }
    memcpy(out + l->drift, b->drift, (size_t)b->n_x * sizeof(double));
    if (b->stages->excitation->is_curved && !is_state) {
        const long double *real = b->real + rhs_column * n;
        for (int r = 0; r < n; r++) {
            b->drift[r] = (double)real[r] * b->column_scale[r] * missed * m->test_factor;
        }
        find_guards(b, b->drift, rhs_column, missed);
        put_columns(b, b->drift, out + l->ripple);
    }
    for (int k = 0; k < b->nullity; k++) {
        double clash = 0.0;
        for (int i = s->n_x; i < n && !is_state; i++) {
            clash += b->left[k * n + i] * b->rhs[rhs_column * n + i];
        }
        for (int i = 1; i <= m->s; i++) {
            out[l->n_fixed + k * m->s + i - 1] = clash * share[i];
        }
    }
}

/* How well the rounded answer at the last stage satisfies the equations without derivatives, in
 * balanced units. In a singular mode sources may disagree, which is for the clashes to tell. */
static void check_column(struct dalcs_stage_workshop *b, int column, int rhs_column, double share) {
    const double *y = b->node + b->stages->method->s * b->n;
    bool is_state = column < b->n_x;
    if (b->nullity > 0 && !is_state) {
        return;
    }
    /* what a state of 1 is in balanced units: where it stays as it is all else is rounding of that */
    double largest = is_state ? 1.0 / b->column_scale[column] : 0.0;
    for (int r = b->n_x; r < b->n; r++) {
        double drive = b->rhs[rhs_column * b->n + r];
        b->residual[r] = -drive * (is_state ? 1.0 : share);
        drive = fabs(drive); /* a sine may be near 0 just there */
        largest = drive > largest ? drive : largest;
    }
    for (int c = 0; c < b->n; c++) {
        double increment = y[c] - (is_state && c == column ? 1.0 : 0.0);
        double balanced = increment / b->column_scale[c];
        const double *base = b->base + c * b->n;
        for (int r = b->n_x; r < b->n && balanced != 0.0; r++) {
            double term = base[r] * balanced;
            b->residual[r] += term;
            term = fabs(term);
            largest = term > largest ? term : largest;
        }
    }
    double worst = 0.0;
    for (int r = b->n_x; r < b->n; r++) {
        worst = fmax(worst, fabs(b->residual[r]));
    }
    b->entry->residual = fmax(b->entry->residual, largest > 0.0 ? worst / largest : 0.0);
}

static void fill_map(struct dalcs_stage_workshop *b) {
    const struct dalcs_excitation *e = b->stages->excitation;
    const struct dalcs_collocation *m = b->stages->method;
    double share[DALCS_MAX_NODES] = {0.0};
    double *out = b->entry->map;
    for (int x = 0; x < b->n_x; x++, out += b->entry->rows) {
        fill_column(b, x, x, share, 0.0, out);
        check_column(b, x, x, 0.0);
    }
    for (int k = 0; k <= m->s; k++) {
        share[k] = 1.0;
    }
    fill_column(b, b->n_x, b->n_x, share, 0.0, out);
    check_column(b, b->n_x, b->n_x, 1.0);
    out += b->entry->rows;
    for (int f = 0; f < e->n_functions; f++, out += b->entry->rows) {
        const struct dalcs_excitation_function *function = &e->function[f];
        for (int k = 0; k <= m->s; k++) {
            share[k] = dalcs_excitation_function_at(function, b->entry->h, m->node[k]);
        }
        int rhs_column = b->wave_column[function->input];
        fill_column(b, b->n_x + 1 + f, rhs_column, share,
                    dalcs_excitation_missed(function, m, b->entry->h, share), out);
        check_column(b, b->n_x + 1 + f, rhs_column, share[m->s]);
    }
}

enum dalcs_status dalcs_stage_map_build(struct dalcs_stages *stages,
                                        struct dalcs_stage_entry *entry) {
    if (stages->workshop == NULL) {
        DALCS_TRY(dalcs_stage_workshop_create(&stages->workshop, stages));
    }
    struct dalcs_stage_workshop *b = stages->workshop;
    DALCS_TRY(dalcs_stage_workshop_solve(b, entry));
    DALCS_TRY(prepare_choice(b));
    entry->n_clashes = b->nullity * stages->method->s;
    entry->rows = dalcs_dense_map_rows(stages->layout.n_fixed + entry->n_clashes);
    entry->map = dalcs_dense_map_alloc(entry->rows, stages->n_in);
    if (entry->map == NULL) {
        return DALCS_E_NOMEM;
    }
    entry->bytes += (size_t)entry->rows * (size_t)stages->n_in * sizeof(double);
    fill_map(b);
    return DALCS_OK;
}

void dalcs_stage_map_apply(const struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                           const double *in, double *out) {
    dalcs_dense_map_apply(entry->rows, stages->n_in, entry->map, in, out);
}

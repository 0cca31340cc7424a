/* stage_map.c - a step of a small system in one mode as one dense matrix: its columns are combinations
 * of the few solutions that the workshop has for unit states and unit inputs. */
#include "dense_map.h"
#include "extremes.h"
#include "stage_workshop.h"
#include "wide_vectors.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a null vector does to a diode, beside its largest entry, is rounding up to this: currents around a
 * loop of sources are nothing to diodes. */
static const double null_rounding = 1e-10;

/* Adds factor times a row of lanes. */
static inline void add_lanes(double *to, double factor, const double *from) {
    for (int i = 0; i < DALCS_LANES; i += DALCS_QUAD) {
        dalcs_quad sum;
        dalcs_quad term;
        dalcs_quad_load(&sum, to + i);
        dalcs_quad_load(&term, from + i);
        sum += factor * term;
        dalcs_quad_store(to + i, &sum);
    }
}

/* The other side of the pairs, b->guard: lambda where closed, w where open, from the unknowns in b->lanes
 * and from the share of the source column (rhs_column < 0: none) in the lanes. */
DALCS_TWICE(void, find_guards,
            (const struct dalcs_stage_workshop *b, int rhs_column, const double *share),
            (b, rhs_column, share)) {
    const struct dalcs_system *s = b->system;
    const double *constant = b->stages->excitation->constant;
    memset(b->guard, 0, (size_t)(s->n_pairs * DALCS_LANES) * sizeof(double));
    for (int d = 0; d < s->n_pairs; d++) {
        if (dalcs_stage_is_on(b->entry, d) || s->pair[d].kind != DALCS_PAIR_DIODE) {
            continue;
        }
        double *w = b->guard + d * DALCS_LANES;
        for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
            int c = b->place[s->C.j[k]];
            if (c >= 0) {
                add_lanes(w, s->C.x[k], b->lanes + c * DALCS_LANES);
            }
        }
        for (int k = s->F.p[d]; k < s->F.p[d + 1]; k++) {
            int wave = b->wave_column[s->F.j[k]];
            if (wave >= 0 && wave == rhs_column) {
                add_lanes(w, s->F.x[k], share);
            } else if (wave < 0 && rhs_column == b->n_x) {
                add_lanes(w, s->F.x[k] * constant[s->F.j[k]], share);
            }
        }
    }
    const double *lambda = b->lanes + dalcs_system_n_equations(s) * DALCS_LANES;
    for (int k = 0; k < b->entry->n_on; k++) {
        memcpy(b->guard + b->entry->on[k] * DALCS_LANES, lambda + k * DALCS_LANES,
               DALCS_LANES * sizeof(double));
    }
}

/* The guards of the null vectors, each over its largest entry, which become unscaled. */
static void find_null_guards(struct dalcs_stage_workshop *b, double *guards) {
    int n_pairs = b->system->n_pairs;
    const double no_share[DALCS_LANES] = {0.0};
    memset(b->lanes, 0, (size_t)(b->n * DALCS_LANES) * sizeof(double));
    for (int k = 0; k < b->nullity; k++) {
        double largest = 0.0;
        for (int i = 0; i < b->n; i++) {
            b->right[k * b->n + i] *= b->column_scale[i];
            largest = fmax(largest, fabs(b->right[k * b->n + i]));
        }
        for (int i = 0; i < b->n; i++) {
            b->right[k * b->n + i] /= largest;
        }
        for (int i = 0; i < b->n; i++) {
            b->lanes[i * DALCS_LANES] = b->right[k * b->n + i];
        }
        find_guards(b, -1, no_share);
        for (int d = 0; d < n_pairs; d++) {
            double guard = b->guard[d * DALCS_LANES];
            guards[k * n_pairs + d] = fabs(guard) > null_rounding ? guard : 0.0;
        }
    }
}

/* Of a single vector: over its square. */
static void choose_along(int n, const double *guards, double *choice) {
    double square = 0.0;
    for (int d = 0; d < n; d++) {
        square += guards[d] * guards[d];
    }
    for (int d = 0; d < n; d++) {
        choice[d] = square > 0.0 ? -guards[d] / square : 0.0;
    }
}

/* Of several, which `guards` is not afterwards. */
static enum dalcs_status choose_among(struct dalcs_stage_workshop *b, double *guards) {
    int n_pairs = b->system->n_pairs;
    int rows = n_pairs > b->nullity ? n_pairs : b->nullity;
    double *identity = dalcs_stage_workshop_reals(&b->arena, rows * n_pairs);
    double *singular = dalcs_stage_workshop_reals(&b->arena, b->nullity + n_pairs);
    if (identity == NULL || singular == NULL) {
        return DALCS_E_NOMEM;
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

/* choice = - pseudoinverse of the guards of the null vectors: adding choice * guards of them makes the
 * diodes' lambda and w as small as possible. Diodes only: a switch's current is a wire's. */
static enum dalcs_status prepare_choice(struct dalcs_stage_workshop *b) {
    int n_pairs = b->system->n_pairs;
    if (b->nullity == 0 || n_pairs == 0 || b->choice != NULL) {
        return DALCS_OK;
    }
    double *guards = dalcs_stage_workshop_reals(&b->arena, n_pairs * b->nullity);
    b->choice = dalcs_stage_workshop_reals(&b->arena, b->nullity * n_pairs);
    if (guards == NULL || b->choice == NULL) {
        return DALCS_E_NOMEM;
    }
    find_null_guards(b, guards);
    if (b->nullity ==
        1) { /* as in most circuits that have any, where LAPACK takes longer than a map */
        choose_along(n_pairs, guards, b->choice);
        return DALCS_OK;
    }
    return choose_among(b, guards);
}

/* Adds what is to be added of the null vectors at the nodes. */
static void choose(const struct dalcs_stage_workshop *b) {
    int n_pairs = b->system->n_pairs;
    for (int k = 0; k < b->nullity && b->choice != NULL; k++) {
        double amount[DALCS_LANES] = {0.0};
        for (int d = 0; d < n_pairs; d++) {
            add_lanes(amount, b->choice[k * n_pairs + d], b->guard + d * DALCS_LANES);
        }
        amount[DALCS_RIPPLE_LANE] = 0.0;
        for (int i = 0; i < b->n; i++) {
            add_lanes(b->lanes + i * DALCS_LANES, b->right[k * b->n + i], amount);
        }
    }
}

/* Unknowns in a lane to the columns of the system, guards in the place of lambda. */
static void put_columns(const struct dalcs_stage_workshop *b, int lane, double *out) {
    int n_equations = dalcs_system_n_equations(b->system);
#pragma GCC unroll 4
    for (int c = 0; c < n_equations; c++) {
        out[c] = b->lanes[c * DALCS_LANES + lane];
    }
    for (int d = 0; d < b->system->n_pairs; d++) {
        out[n_equations + d] = b->guard[d * DALCS_LANES + lane];
    }
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

/* Adds up what a stage takes of the parts of a solution; n is known to the compiler where it matters. */
static inline __attribute__((always_inline)) long double combine(int n, const long double *factor,
                                                                 const long double *part) {
    long double sum = factor[0] * part[0];
#pragma GCC unroll 9
    for (int k = 1; k < n; k++) {
        sum += factor[k] * part[k];
    }
    return sum;
}

/* The stages of what is kept, into b->stage as increments and into b->lanes, and what they alone say of the
 * start, likewise. */
static inline __attribute__((always_inline)) void
fill_kept(struct dalcs_stage_workshop *b, int n_parts, int column, int rhs_column,
          const long double (*factor)[DALCS_SOLUTION_PARTS]) {
    const struct dalcs_collocation *m = b->stages->method;
    const long double *part = b->part + rhs_column * b->n_kept * DALCS_SOLUTION_PARTS;
    long double *stage = b->stage;
    for (int r = 0; r < b->n_kept; r++, part += DALCS_SOLUTION_PARTS, stage += DALCS_MAX_STAGES) {
        long double scale = b->column_scale[b->kept[r]];
        long double unit = column < b->n_x && b->kept[r] == column ? 1.0L : 0.0L;
        long double start = 0.0L;
        double *lane = b->lanes + b->kept[r] * DALCS_LANES;
        for (int i = 0; i < m->s; i++) {
            stage[i] = combine(n_parts, factor[i], part);
            start += m->exact_back[i] * stage[i];
            lane[i + 1] = (double)(stage[i] * scale + unit);
        }
        b->kept_start[r] = start;
        b->start[b->kept[r]] = start * scale + unit;
    }
}

/* The stages of a follower of n unknowns, unscaled. */
static inline __attribute__((always_inline)) void
fill_follower(const struct dalcs_stage_workshop *b, int n, const long double *x, const int *of,
              long double drive, const double *share, long double scale, double *lane) {
    for (int i = 0; i < b->stages->method->s; i++) {
        long double sum = drive * share[i];
        for (int k = 0; k < n; k++) {
            sum -= x[k] * b->stage[of[k] * DALCS_MAX_STAGES + i];
        }
        lane[i] = (double)(sum * scale);
    }
}

static void fill_followers(struct dalcs_stage_workshop *b, int rhs_column, const double *share) {
    const struct dalcs_collocation *m = b->stages->method;
    long double start_share = 0.0L;
    for (int i = 0; i < m->s; i++) {
        start_share += m->exact_back[i] * share[i];
    }
    for (int f = 0; f < b->n_followers; f++) {
        int n = b->follows_p[f + 1] - b->follows_p[f];
        const long double *x = b->follows_x + b->follows_p[f];
        const int *of = b->follows_j + b->follows_p[f];
        long double scale = b->column_scale[b->follower[f]];
        long double drive = dalcs_stage_workshop_drive(b, f, rhs_column);
        double *lane = b->lanes + b->follower[f] * DALCS_LANES + 1;
        long double start = drive * start_share;
        for (int k = 0; k < n; k++) {
            start -= x[k] * b->kept_start[of[k]];
        }
        b->start[b->follower[f]] = start * scale;
        if (n == 1) {
            fill_follower(b, 1, x, of, drive, share, scale, lane);
        } else if (n == 2) {
            fill_follower(b, 2, x, of, drive, share, scale, lane);
        } else {
            fill_follower(b, n, x, of, drive, share, scale, lane);
        }
    }
}

/* The stages, into b->lanes, and, before the filter, where the polynomial through them alone starts, into
 * b->start. */
static void fill_stages(struct dalcs_stage_workshop *b, int column, int rhs_column,
                        const double *share, const dalcs_stage_factors_of_parts factor) {
    static const double constant[DALCS_MAX_STAGES] = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
    if (b->stages->method->s == 7) {
        fill_kept(b, 7, column, rhs_column, factor);
    } else {
        fill_kept(b, DALCS_SOLUTION_PARTS, column, rhs_column, factor);
    }
    fill_followers(b, rhs_column, column < b->n_x ? constant : share + 1);
}

/* The start and what sources do between the nodes into b->lanes, and the defect at the start after the
 * filter into b->defect. */
static void fill_start(struct dalcs_stage_workshop *b, int column, int rhs_column,
                       const double *share) {
    const struct dalcs_collocation *m = b->stages->method;
    int n = b->n;
    int n_x = b->n_x;
    const long double *real = b->real + rhs_column * n;
    long double source_drift = share[0];
    for (int i = 1; i <= m->s; i++) {
        source_drift -= m->exact_back[i - 1] * share[i];
    }
    source_drift = column < n_x ? 0.0L : source_drift;
    for (int x = 0; x < n_x; x++) {
        b->missed[x] = (x == column ? 1.0L : 0.0L) - b->start[x];
    }
    for (int r = 0; r < n; r++) {
        double *lane = b->lanes + r * DALCS_LANES;
        long double defect = real[r] * source_drift;
        for (int x = 0; x < n_x; x++) {
            defect += b->real[x * n + r] * b->missed[x];
        }
        defect *= b->column_scale[r];
        if (r < n_x) {
            lane[0] = r == column ? 1.0 : 0.0;
            b->defect[r] = defect;
        } else {
            lane[0] = (double)(b->start[r] + defect);
        }
        /* What is added to the others goes with states that are off by their defects: less that. */
        for (int x = 0; x < n_x && r == n_x - 1; x++) {
            b->missed[x] -= b->defect[x];
        }
        lane[DALCS_RIPPLE_LANE] =
            (double)real[r] * b->column_scale[r] * share[DALCS_RIPPLE_LANE] * m->test_factor;
    }
}

/* What implicit Euler makes of unknown r from the states v[n_x]. */
static long double filtered(const struct dalcs_stage_workshop *b, const long double *v, int r) {
    long double sum = 0.0L;
    for (int x = 0; x < b->n_x; x++) {
        sum += b->real[x * b->n + r] * v[x];
    }
    return sum * b->column_scale[r];
}

/* What goes with the defects that last: what dies away at once, or what equations without memory forbid,
 * is no error of currents. */
static void fill_currents(struct dalcs_stage_workshop *b, double *out) {
    const struct dalcs_stages *stages = b->stages;
    for (int x = 0; x < b->n_x && stages->n_levered > 0; x++) {
        b->lasting[x] = filtered(b, b->defect, x);
    }
    for (int k = 0; k < b->entry->current_rows; k++) {
        out[k] = k < stages->n_levered ? (double)filtered(b, b->lasting, stages->levered[k]) : 0.0;
    }
}

/* One column of the map, with its clashes: the answer to in[column] = 1. In the lanes of share are the
 * values of the source at the nodes and what they miss of it in between; for a state all are 0. */
static void fill_column(struct dalcs_stage_workshop *b, int column, int rhs_column,
                        const double *share, const dalcs_stage_factors_of_parts factor, double *out,
                        double *currents) {
    const struct dalcs_collocation *m = b->stages->method;
    const struct dalcs_stage_layout *l = &b->stages->layout;
    const struct dalcs_system *s = b->system;
    bool is_state = column < b->n_x;
    fill_stages(b, column, rhs_column, share, factor);
    fill_start(b, column, rhs_column, share);
    find_guards(b, rhs_column, share);
    if (b->nullity > 0) {
        choose(b);
        find_guards(b, rhs_column, share);
    }
    for (int k = 0; k <= m->s; k++) {
        double *columns = out + k * l->stride;
        put_columns(b, k, columns);
        for (int i = 0; i < b->stages->n_watched; i++) {
            columns[dalcs_system_n_columns(s) + i] =
                watched_voltage(b, b->stages->watched[i], columns, rhs_column, share[k]);
        }
    }
    for (int x = 0; x < b->n_x; x++) {
        out[l->drift + x] = (double)b->defect[x];
    }
    fill_currents(b, currents);
    if (b->stages->excitation->is_curved) {
        put_columns(b, DALCS_RIPPLE_LANE, out + l->ripple);
    }
    for (int k = 0; k < b->nullity; k++) {
        double clash = 0.0;
        for (int i = s->n_x; i < b->n && !is_state; i++) {
            clash += b->left[k * b->n + i] * b->rhs[rhs_column * b->n + i];
        }
        for (int i = 1; i <= m->s; i++) {
            out[l->n_fixed + k * m->s + i - 1] = clash * share[i];
        }
    }
    for (int i = l->n_fixed + b->entry->n_clashes; i < b->entry->rows; i++) {
        out[i] = 0.0;
    }
}

/* residual += value * column of n entries, with room for whole quads behind both. Returns the largest
 * term, at least `largest`. */
DALCS_TWICE(double, add_terms,
            (int n, const double *column, double value, double *residual, double largest),
            (n, column, value, residual, largest)) {
    dalcs_quad most = {largest};
    for (int r = 0; r < n; r += DALCS_QUAD) {
        dalcs_quad term;
        dalcs_quad sum;
        dalcs_quad_load(&term, column + r);
        dalcs_quad_load(&sum, residual + r);
        term *= value;
        dalcs_quad_keep(&term, n - r);
        sum += term;
        dalcs_quad_store(residual + r, &sum);
        dalcs_quad_unsign(&term);
        dalcs_quad_raise(&most, &term);
    }
    return dalcs_quad_largest(&most);
}

/* How well the rounded answer at the last stage satisfies the equations without derivatives, in
 * balanced units. In a singular mode sources may disagree, which is for the clashes to tell. */
static void check_column(struct dalcs_stage_workshop *b, int column, int rhs_column, double share) {
    int last = b->stages->method->s;
    int n_z = b->n - b->n_x;
    bool is_state = column < b->n_x;
    if (b->nullity > 0 && !is_state) {
        return;
    }
    /* what a state of 1 is in balanced units: where it stays as it is all else is rounding of that */
    double largest = is_state ? 1.0 / b->column_scale[column] : 0.0;
    for (int r = 0; r < n_z; r++) {
        double drive = b->rhs[rhs_column * b->n + b->n_x + r];
        b->residual[r] = -drive * (is_state ? 1.0 : share);
        largest = dalcs_larger(largest, fabs(drive)); /* a sine may be near 0 just there */
    }
    for (int c = 0; c < b->n; c++) {
        double increment = b->lanes[c * DALCS_LANES + last] - (is_state && c == column ? 1.0 : 0.0);
        if (increment != 0.0) {
            largest = add_terms(n_z, b->base + c * b->n + b->n_x, increment / b->column_scale[c],
                                b->residual, largest);
        }
    }
    double worst = 0.0;
    for (int r = 0; r < n_z; r++) {
        worst = dalcs_larger(worst, fabs(b->residual[r]));
    }
    b->entry->residual = dalcs_larger(b->entry->residual, largest > 0.0 ? worst / largest : 0.0);
}

static int n_columns(const struct dalcs_stage_workshop *b) {
    return b->has_constants ? b->stages->n_in : b->stages->n_in - 1;
}

static void fill_map(struct dalcs_stage_workshop *b, const struct dalcs_stage_function *function) {
    const struct dalcs_excitation *e = b->stages->excitation;
    const struct dalcs_collocation *m = b->stages->method;
    double share[DALCS_LANES] = {0.0};
    double *out = b->entry->map;
    double *currents = b->entry->current_map;
    int rows = b->entry->rows;
    int current_rows = b->entry->current_rows;
    memset(b->lanes, 0, (size_t)(b->n * DALCS_LANES) * sizeof(double));
    for (int x = 0; x < b->n_x; x++, out += rows, currents += current_rows) {
        fill_column(b, x, x, share, *b->functions.constant_factor, out, currents);
        check_column(b, x, x, 0.0);
    }
    if (b->has_constants) {
        for (int k = 0; k <= m->s; k++) {
            share[k] = 1.0;
        }
        fill_column(b, b->n_x, b->n_x, share, *b->functions.constant_factor, out, currents);
        check_column(b, b->n_x, b->n_x, 1.0);
        out += rows;
        currents += current_rows;
    }
    for (int f = 0; f < e->n_functions; f++, out += rows, currents += current_rows) {
        const double *of = function[f].share;
        int rhs_column = b->wave_column[e->function[f].input];
        fill_column(b, b->n_x + 1 + f, rhs_column, of, function[f].factor, out, currents);
        check_column(b, b->n_x + 1 + f, rhs_column, of[m->s]);
    }
}

enum dalcs_status dalcs_stage_map_build(struct dalcs_stages *stages,
                                        struct dalcs_stage_entry *entry) {
    if (stages->workshop == NULL) {
        DALCS_TRY(dalcs_stage_workshop_create(&stages->workshop, stages));
    }
    struct dalcs_stage_workshop *b = stages->workshop;
    const struct dalcs_stage_function *function =
        dalcs_stage_functions_get(&b->functions, stages, entry->h);
    if (function == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_stage_workshop_solve(b, entry));
    DALCS_TRY(prepare_choice(b));
    entry->n_clashes = b->nullity * stages->method->s;
    entry->rows = dalcs_dense_map_rows(stages->layout.n_fixed + entry->n_clashes);
    entry->current_rows = dalcs_dense_map_rows(stages->n_levered);
    entry->map = dalcs_dense_map_alloc(entry->rows + entry->current_rows, n_columns(b));
    if (entry->map == NULL) {
        return DALCS_E_NOMEM;
    }
    entry->current_map = entry->map + entry->rows * n_columns(b);
    entry->bytes +=
        (size_t)(entry->rows + entry->current_rows) * (size_t)n_columns(b) * sizeof(double);
    fill_map(b, function);
    return DALCS_OK;
}

int dalcs_stage_map_columns(const struct dalcs_stages *stages) {
    return n_columns(stages->workshop);
}

const double *dalcs_stage_map_input(const struct dalcs_stages *stages, const double *in) {
    const struct dalcs_stage_workshop *b = stages->workshop;
    if (b->has_constants) {
        return in;
    }
    for (int k = 0; k < b->n_x; k++) {
        b->in[k] = in[k];
    }
    for (int k = b->n_x + 1; k < stages->n_in; k++) {
        b->in[k - 1] = in[k];
    }
    return b->in;
}

void dalcs_stage_map_apply(const struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                           const double *in, double *out) {
    dalcs_dense_map_apply(entry->rows, n_columns(stages->workshop), entry->map,
                          dalcs_stage_map_input(stages, in), out);
}

void dalcs_stage_map_currents(const struct dalcs_stages *stages,
                              const struct dalcs_stage_entry *entry, const double *in,
                              double *drift) {
    dalcs_dense_map_apply(entry->current_rows, n_columns(stages->workshop), entry->current_map,
                          dalcs_stage_map_input(stages, in), drift);
}

bool dalcs_stage_has_map(const struct dalcs_stage_entry *entry) {
    return entry->map != NULL;
}

/* Of a row of a map. */
static double spread(const struct dalcs_stages *stages, const double *element, int rows,
                     const double *in, const double *scale) {
    const struct dalcs_stage_workshop *b = stages->workshop;
    double sum = 0.0;
    for (int k = 0; k < stages->n_in; k++) {
        if (k == b->n_x && !b->has_constants) {
            continue;
        }
        double size = fabs(in[k]);
        sum += fabs(*element) * (k < b->n_x ? dalcs_larger(scale[k], size) : size);
        element += rows;
    }
    return sum;
}

double dalcs_stage_spread(const struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                          int row, const double *in, const double *scale) {
    return spread(stages, entry->map + row, entry->rows, in, scale);
}

double dalcs_stage_spread_of_current(const struct dalcs_stages *stages,
                                     const struct dalcs_stage_entry *entry, int k, const double *in,
                                     const double *scale) {
    return spread(stages, entry->current_map + k, entry->current_rows, in, scale);
}

/* stage_column.c - one column of a map: a combination of the solutions that the workshop has. */
#include "stage_column.h"

#include "extremes.h"
#include "wide_vectors.h"

#include <math.h>
#include <string.h>

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

/* The other side of the pairs, b->column.guard: lambda where closed, w where open, from the unknowns in b->column.lanes
 * and from the share of the source column (rhs_column < 0: none) in the lanes. */
DALCS_TWICE(void, find_guards,
            (const struct dalcs_stage_workshop *b, int rhs_column, const double *share),
            (b, rhs_column, share)) {
    const struct dalcs_system *s = b->system;
    const double *constant = b->stages->excitation->constant;
    for (int d = 0; d < s->n_pairs; d++) {
        if (dalcs_stage_is_on(b->entry, d)) {
            continue;
        }
        double *w = b->column.guard + d * DALCS_LANES;
        for (int i = 0; i < DALCS_LANES; i++) {
            w[i] = 0.0;
        }
        if (s->pair[d].kind != DALCS_PAIR_DIODE) {
            continue;
        }
        for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
            int c = b->place[s->C.j[k]];
            if (c >= 0) {
                add_lanes(w, s->C.x[k], b->column.lanes + c * DALCS_LANES);
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
    const double *lambda = b->column.lanes + dalcs_system_n_equations(s) * DALCS_LANES;
    for (int k = 0; k < b->entry->n_on; k++) {
        memcpy(b->column.guard + b->entry->on[k] * DALCS_LANES, lambda + k * DALCS_LANES,
               DALCS_LANES * sizeof(double));
    }
}

/* Unknowns in a lane to the columns of the system, guards in the place of lambda. */
static void put_columns(const struct dalcs_stage_workshop *b, int lane, double *out) {
    int n_equations = dalcs_system_n_equations(b->system);
#pragma GCC unroll 4
    for (int c = 0; c < n_equations; c++) {
        out[c] = b->column.lanes[c * DALCS_LANES + lane];
    }
    for (int d = 0; d < b->system->n_pairs; d++) {
        out[n_equations + d] = b->column.guard[d * DALCS_LANES + lane];
    }
}

/* A watched voltage from columns. */
static double watched_voltage(const struct dalcs_stage_workshop *b, int d, const double *columns) {
    const struct dalcs_system *s = b->system;
    int n_equations = dalcs_system_n_equations(s);
    double v = 0.0;
    for (int k = s->control.p[d]; k < s->control.p[d + 1]; k++) {
        int c = s->control.j[k];
        bool open = c >= n_equations && !dalcs_stage_is_on(b->entry, c - n_equations);
        v += open ? 0.0 : s->control.x[k] * columns[c];
    }
    return v;
}

/* The stages of an unknown from its row, unscaled increments over unit, into b->column.lanes, and, before the filter, where
 * the polynomial through them alone starts, into b->column.start. */
static void put_stages(const struct dalcs_stage_workshop *b, int unknown,
                       const struct dalcs_extended_row *row, double unit) {
    int s = b->stages->method->s;
    int n_stages = b->stages->method->n_stages;
    double scale = b->eq.column_scale[unknown];
    dalcs_extended_round(n_stages, row, scale, unit, b->column.lanes + unknown * DALCS_LANES + 1);
    b->column.start[unknown] = dalcs_extended_scaled(row->high[s], row->low[s], scale);
}

/* Likewise of an unknown that is 0. */
static void put_nothing(const struct dalcs_stage_workshop *b, int unknown) {
    memset(b->column.lanes + unknown * DALCS_LANES + 1, 0,
           (size_t)b->stages->method->n_stages * sizeof(double));
    b->column.start[unknown] = (struct dalcs_extended){0.0, 0.0};
}

/* The stages of what is kept, as increments, and then of the followers. */
static void fill_stages(struct dalcs_stage_workshop *b, int column, int rhs_column,
                        const struct dalcs_stage_drive *drive) {
    const struct dalcs_collocation *m = b->stages->method;
    int n_parts = 1 + 2 * m->n_pairs;
    const struct dalcs_extended *part =
        b->solved.part + rhs_column * b->kept.n_kept * DALCS_SOLUTION_PARTS;
    for (int r = 0; r < b->kept.n_kept; r++, part += DALCS_SOLUTION_PARTS) {
        bool is_unit = column < b->n_x && b->kept.kept[r] == column;
        dalcs_extended_combine(m->s + 1, n_parts, part, drive->of_part, NULL, &b->column.stage[r]);
        put_stages(b, b->kept.kept[r], &b->column.stage[r], is_unit ? 1.0 : 0.0);
    }
    b->column.stage[b->kept.n_kept] = *drive->stages;
    for (int f = 0; f < b->kept.n_followers; f++) {
        int from = b->kept.follows_p[f];
        int to = b->kept.follows_p[f + 1];
        struct dalcs_extended_row row;
        long double own = dalcs_stage_workshop_drive(b, f, rhs_column);
        b->kept.follows_x[to - 1] = dalcs_extended_of(own);
        to -= own == 0.0L ? 1 : 0; /* most are driven by no source, and half by nothing at all */
        if (from == to || !dalcs_workshop_reaches(b, rhs_column, b->kept.follower[f])) {
            put_nothing(b, b->kept.follower[f]);
            continue;
        }
        dalcs_extended_combine(m->s + 1, to - from, b->kept.follows_x + from, b->column.stage,
                               b->kept.follows_j + from, &row);
        put_stages(b, b->kept.follower[f], &row, 0.0);
    }
}

/* What implicit Euler makes of unknowns [from, to) from what is missed in the first n rows of b->column.of_missed, into
 * b->column.filtered, over their scales. */
static void filter(const struct dalcs_stage_workshop *b, int n, const struct dalcs_extended *missed,
                   int from, int to) {
    from -= from % DALCS_QUAD;
    dalcs_extended_combine_long(b->solved.room, to - from, n, missed, b->solved.real + from,
                                b->column.of_missed, b->column.filtered + from);
}

static struct dalcs_extended filtered(const struct dalcs_stage_workshop *b, int r) {
    return dalcs_extended_scaled(b->column.filtered[r],
                                 b->column.filtered[b->solved.room + (size_t)r],
                                 b->eq.column_scale[r]);
}

/* The start and what sources do between the nodes into b->column.lanes, and the defect at the start after the
 * filter into b->column.defect. */
static void fill_start(struct dalcs_stage_workshop *b, int column, int rhs_column,
                       const double *share) {
    const struct dalcs_collocation *m = b->stages->method;
    int n = b->n;
    int n_x = b->n_x;
    int n_missed = column < n_x ? n_x : n_x + 1; /* a source has its own */
    long double source_drift = share[0];
    for (int i = 1; i <= m->n_stages; i++) {
        source_drift -= m->exact.back[i - 1] * share[i];
    }
    b->column.missed[n_x] = dalcs_extended_of(source_drift);
    b->column.of_missed[n_x] = rhs_column;
    for (int x = 0; x < n_x; x++) {
        b->column.missed[x] =
            (struct dalcs_extended){-b->column.start[x].high, -b->column.start[x].low};
    }
    filter(b, n_missed, b->column.missed, 0, n_x);
    /* What is added to the others goes with states that are off by their defects: less that. */
    for (int x = 0; x < n_x; x++) {
        b->column.lanes[x * DALCS_LANES] = x == column ? 1.0 : 0.0;
        b->column.defect[x] = filtered(b, x);
        b->column.missed[x] = dalcs_extended_plus(
            b->column.missed[x],
            (struct dalcs_extended){-b->column.defect[x].high, -b->column.defect[x].low});
    }
    filter(b, n_missed, b->column.missed, n_x, n);
    for (int r = n_x; r < n; r++) {
        b->column.lanes[r * DALCS_LANES] =
            dalcs_extended_plus(b->column.start[r], filtered(b, r)).high;
    }
    const double *real = b->solved.real + 2 * b->solved.room * (size_t)rhs_column;
    double ripple = share[DALCS_RIPPLE_LANE] * m->worst.factor;
    for (int r = 0; r < n; r++) {
        b->column.lanes[r * DALCS_LANES + DALCS_RIPPLE_LANE] =
            real[r] * b->eq.column_scale[r] * ripple;
    }
}

/* What goes with the defects that last: what dies away at once, or what equations without memory forbid,
 * is no error of currents. */
static void fill_currents(struct dalcs_stage_workshop *b, double *out) {
    const struct dalcs_stages *stages = b->stages;
    if (stages->n_levered > 0) {
        filter(b, b->n_x, b->column.defect, 0, b->n_x);
        for (int x = 0; x < b->n_x; x++) {
            b->column.lasting[x] = filtered(b, x);
        }
        filter(b, b->n_x, b->column.lasting, b->n_x, b->n - b->entry->n_on);
    }
    for (int k = 0; k < b->entry->maps.current_rows; k++) {
        out[k] = k < stages->n_levered ? filtered(b, stages->levered[k]).high : 0.0;
    }
}

/* What null vector k of the rows says of sources, whose share is of each stage: they disagree by so much. */
static void put_clash_of_sources(const struct dalcs_stage_workshop *b, int k, int rhs_column,
                                 const double *share, double *out) {
    double clash = 0.0;
    for (int i = b->n_x; i < b->n; i++) {
        clash += b->open.left[k * b->n + i] * b->eq.rhs[rhs_column * b->n + i];
    }
    for (int i = 0; i < b->stages->method->s; i++) {
        out[i] = clash * share[i + 1];
    }
}

/* What a row that is given up for a choice misses at each stage. */
static void put_clash_of_row(const struct dalcs_stage_workshop *b, int row, int column,
                             int rhs_column, const double *share, double *out) {
    const bool is_state = column < b->n_x;
    const double scale = b->eq.row_scale[row];
    for (int i = 0; i < b->stages->method->s; i++) {
        const double *of_stage = b->column.lanes + i + 1;
        double sum = b->eq.plain_rhs[rhs_column * b->n + row] * (is_state ? 1.0 : share[i + 1]);
        for (int c = 0; c < b->n; c++) {
            const double start = is_state && c == column ? 1.0 : 0.0;
            sum -= b->eq.plain_base[c * b->n + row] * (of_stage[c * DALCS_LANES] - start);
        }
        out[i] = scale * sum;
    }
}

void dalcs_stage_column_fill(struct dalcs_stage_workshop *b, int column, int rhs_column,
                             const struct dalcs_stage_drive *drive, struct dalcs_map_column *to) {
    double *out = to->out;
    const double *share = drive->share;
    const struct dalcs_collocation *m = b->stages->method;
    const struct dalcs_stage_layout *l = &b->stages->layout;
    const struct dalcs_system *s = b->system;
    bool is_state = column < b->n_x;
    fill_stages(b, column, rhs_column, drive);
    fill_start(b, column, rhs_column, share);
    find_guards(b, rhs_column, share);
    for (int k = 0; k <= m->n_stages; k++) {
        double *columns = out + k * l->stride;
        put_columns(b, k, columns);
        for (int i = 0; i < b->stages->n_watched; i++) {
            columns[dalcs_system_n_columns(s) + i] =
                watched_voltage(b, b->stages->watched[i], columns);
        }
    }
    for (int x = 0; x < b->n_x; x++) {
        out[l->drift + x] = b->column.defect[x].high;
    }
    fill_currents(b, to->currents);
    if (b->stages->excitation->is_curved) {
        put_columns(b, DALCS_RIPPLE_LANE, out + l->ripple);
    }
    for (int k = 0; k < b->open.nullity; k++) {
        double *clash = out + l->n_fixed + k * m->s;
        if (b->open.given_up != NULL) {
            put_clash_of_row(b, b->open.given_up[k], column, rhs_column, share, clash);
        } else if (!is_state) {
            put_clash_of_sources(b, k, rhs_column, share, clash);
        } else {
            memset(clash, 0, (size_t)m->s * sizeof(*clash));
        }
    }
    for (int i = l->n_fixed + b->entry->n_clashes; i < b->entry->rows; i++) {
        out[i] = 0.0;
    }
    to->out += b->entry->rows;
    to->currents += b->entry->maps.current_rows;
}

/* b->column.residual += value * what column c has in the equations without derivatives. Returns the largest term, at
 * least `largest`. */
static double add_terms(const struct dalcs_stage_workshop *b, int c, double value, double largest) {
    for (int k = b->eq.nonzero_p[c]; k < b->eq.nonzero_p[c + 1]; k++) {
        int r = b->eq.nonzero_i[k] - b->n_x;
        if (r >= 0) {
            double term = b->eq.base[k] * value;
            b->column.residual[r] += term;
            largest = dalcs_larger(fabs(term), largest);
        }
    }
    return largest;
}

void dalcs_stage_column_check(struct dalcs_stage_workshop *b, int column, int rhs_column,
                              double share) {
    int last = b->stages->method->s;
    int n_z = b->n - b->n_x;
    bool is_state = column < b->n_x;
    if (b->open.nullity > 0 && !is_state) {
        return;
    }
    /* what a state of 1 is in balanced units: where it stays as it is all else is rounding of that */
    double largest = is_state ? 1.0 / b->eq.column_scale[column] : 0.0;
    for (int r = 0; r < n_z; r++) {
        double drive = b->eq.rhs[rhs_column * b->n + b->n_x + r];
        b->column.residual[r] = -drive * (is_state ? 1.0 : share);
        largest = dalcs_larger(largest, fabs(drive)); /* a sine may be near 0 just there */
    }
    /* likewise, what a source would drive a state to that the mode holds at 0 */
    for (int x = 0; x < b->n_x && !is_state; x++) {
        largest = dalcs_larger(largest, fabs(b->eq.rhs[rhs_column * b->n + x]));
    }
    for (int c = 0; c < b->n; c++) {
        double increment =
            b->column.lanes[c * DALCS_LANES + last] - (is_state && c == column ? 1.0 : 0.0);
        if (increment != 0.0) {
            largest = add_terms(b, c, increment / b->eq.column_scale[c], largest);
        }
    }
    for (int k = 0; k < b->open.nullity && b->open.given_up != NULL; k++) {
        b->column.residual[b->open.given_up[k] - b->n_x] =
            0.0; /* a clash, of all columns together */
    }
    double worst = 0.0;
    for (int r = 0; r < n_z; r++) {
        worst = dalcs_larger(worst, fabs(b->column.residual[r]));
    }
    b->entry->residual = dalcs_larger(b->entry->residual, largest > 0.0 ? worst / largest : 0.0);
}

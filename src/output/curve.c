/* curve.c - keeps first, lowest, highest and last point of every pixel column: drawn with lines
 * that is the same picture as all points, at 4000 points at most. */
#include "curve.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>

#define SWING 0.2 /* of the range so far: smaller ripple is no turn */

void dalcs_turns_add(struct dalcs_turns *turns, double value, double swing) {
    double back = turns->rising ? turns->extreme - value : value - turns->extreme;
    if (back > swing) {
        turns->n++;
        turns->rising = !turns->rising;
    }
    if (back > swing || back < 0.0) {
        turns->extreme = value;
    }
}

enum dalcs_status dalcs_curve_init(struct dalcs_curve *curve, double start, double stop) {
    *curve = (struct dalcs_curve){.start = start,
                                  .stop = stop,
                                  .lowest = INFINITY,
                                  .highest = -INFINITY,
                                  .time = NAN,
                                  .value = NAN};
    curve->column = dalcs_alloc(DALCS_CURVE_COLUMNS, sizeof *curve->column);
    curve->integral_at = dalcs_alloc(DALCS_CURVE_PLACES + 1, sizeof *curve->integral_at);
    return curve->column && curve->integral_at ? DALCS_OK : DALCS_E_NOMEM;
}

int dalcs_curve_find_column(const struct dalcs_curve *curve, double time) {
    double part = curve->logarithmic ? log(time / curve->start) / log(curve->stop / curve->start)
                                     : (time - curve->start) / (curve->stop - curve->start);
    double position = part * DALCS_CURVE_COLUMNS;
    return position > 0.0 ? (int)fmin(position, DALCS_CURVE_COLUMNS - 1) : 0;
}

/* The straight line to the next point. */
static void integrate(struct dalcs_curve *curve, double time, double value) {
    const double step = (curve->stop - curve->start) / DALCS_CURVE_PLACES;
    const double span = time - curve->time;
    const bool is_joined = isfinite(curve->value) && isfinite(value) && span > 0.0;
    for (; curve->n_integrals <= DALCS_CURVE_PLACES; curve->n_integrals++) {
        const double part = curve->start + curve->n_integrals * step - curve->time;
        if (!(part <= span)) { /* of the first point: span is not a number */
            break;
        }
        double more = 0.0;
        if (is_joined) {
            const double there = curve->value + (value - curve->value) * part / span;
            more = 0.5 * (curve->value + there) * fmax(part, 0.0);
        }
        curve->integral_at[curve->n_integrals] = curve->integral + more;
    }
    curve->integral += is_joined ? 0.5 * (curve->value + value) * span : 0.0;
    curve->time = time;
    curve->value = value;
}

void dalcs_curve_add(struct dalcs_curve *curve, double time, double value) {
    const bool follows_gap = curve->n_rows > 0 && !isfinite(curve->value);
    struct dalcs_curve_point point = {.row = curve->n_rows++, .time = time, .value = value};
    integrate(curve, time, value);
    if (!isfinite(value)) {
        return;
    }
    struct dalcs_curve_column *column = &curve->column[dalcs_curve_find_column(curve, time)];
    if (!column->used) {
        *column = (struct dalcs_curve_column){true, follows_gap, point, point, point, point};
    }
    if (value < column->lowest.value) {
        column->lowest = point;
    }
    if (value > column->highest.value) {
        column->highest = point;
    }
    column->last = point;
    curve->lowest = fmin(curve->lowest, value);
    curve->highest = fmax(curve->highest, value);
    /* A swing before the signal moved may have been rounding. */
    double range = curve->highest - curve->lowest;
    if (range > 2.0 * curve->turns_range) {
        curve->turns.n = 0;
        curve->turns_range = range;
    }
    dalcs_turns_add(&curve->turns, value, SWING * range);
}

void dalcs_curve_widen_range(const struct dalcs_curve *curve, const bool *skip, double *low,
                             double *high) {
    for (int i = 0; i < DALCS_CURVE_COLUMNS; i++) {
        if (curve->column[i].used && !skip[i]) {
            *low = fmin(*low, curve->column[i].lowest.value);
            *high = fmax(*high, curve->column[i].highest.value);
        }
    }
}

double dalcs_curve_overlap(const struct dalcs_curve *a, const struct dalcs_curve *b,
                           double tolerance) {
    int n = 0, joined = -1; /* the column that straight lines on each other may come from */
    bool was_away = false;
    for (int i = 0; i < DALCS_CURVE_COLUMNS; i++) {
        const struct dalcs_curve_column *p = &a->column[i], *q = &b->column[i];
        if (!p->used && !q->used) {
            continue;
        }
        bool away = fmax(p->highest.value, -p->lowest.value) > tolerance;
        bool same = fabs(p->first.value - q->first.value) <= tolerance &&
                    fabs(p->lowest.value - q->lowest.value) <= tolerance &&
                    fabs(p->highest.value - q->highest.value) <= tolerance &&
                    fabs(p->last.value - q->last.value) <= tolerance;
        bool both = p->used && q->used;
        bool arrives = both && joined >= 0 && fabs(p->first.value - q->first.value) <= tolerance;
        n += arrives && (away || was_away) ? i - joined - 1 : 0;
        n += both && away && same ? 1 : 0;
        joined = both && fabs(p->last.value - q->last.value) <= tolerance ? i : -1;
        was_away = away;
    }
    return (double)n / DALCS_CURVE_COLUMNS;
}

int dalcs_curve_column_points(const struct dalcs_curve_column *column,
                              struct dalcs_curve_point point[4]) {
    if (!column->used) {
        return 0;
    }
    bool low_first = column->lowest.row < column->highest.row;
    const struct dalcs_curve_point ordered[4] = {
        column->first,
        low_first ? column->lowest : column->highest,
        low_first ? column->highest : column->lowest,
        column->last,
    };
    int n = 0;
    for (int i = 0; i < 4; i++) {
        if (n == 0 || ordered[i].row > point[n - 1].row) {
            point[n++] = ordered[i];
        }
    }
    return n;
}

void dalcs_curve_finish(struct dalcs_curve *curve) {
    free(curve->column);
    free(curve->integral_at);
    *curve = (struct dalcs_curve){0};
}

/* curve.c - keeps first, lowest, highest and last point of every pixel column: drawn with lines
 * that is the same picture as all points, at 4000 points at most. */
#include "curve.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>

enum dalcs_status dalcs_curve_init(struct dalcs_curve *curve, double start, double stop) {
    *curve = (struct dalcs_curve){
        .start = start, .stop = stop, .lowest = INFINITY, .highest = -INFINITY};
    curve->column = dalcs_alloc(DALCS_CURVE_COLUMNS, sizeof *curve->column);
    return curve->column ? DALCS_OK : DALCS_E_NOMEM;
}

void dalcs_curve_add(struct dalcs_curve *curve, double time, double value) {
    struct dalcs_curve_point point = {.row = curve->n_rows++, .time = time, .value = value};
    if (!isfinite(value)) {
        return;
    }
    double position = (time - curve->start) / (curve->stop - curve->start) * DALCS_CURVE_COLUMNS;
    int index = position > 0.0 ? (int)fmin(position, DALCS_CURVE_COLUMNS - 1) : 0;
    struct dalcs_curve_column *column = &curve->column[index];
    if (!column->used) {
        *column = (struct dalcs_curve_column){true, point, point, point, point};
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
    *curve = (struct dalcs_curve){0};
}

/* band.c - see band.h.
 *
 * The mean is one over a window of about a period, and then over such windows: what a window that is longer by a part
 * d leaves of a swing is d of it, and after the second mean d squared. Windows at the ends lie within the curve. */
#include "band.h"

#include <math.h>

/* The integral from the beginning to a time. */
static double integral_to(const struct dalcs_curve *curve, double time) {
    const double place = (time - curve->start) / (curve->stop - curve->start) * DALCS_CURVE_PLACES;
    const int before = (int)fmin(fmax(place, 0.0), DALCS_CURVE_PLACES - 1);
    const int n = curve->n_integrals;
    const double start = before < n ? curve->integral_at[before] : curve->integral;
    const double end = before + 1 < n ? curve->integral_at[before + 1] : curve->integral;
    return start + (place - before) * (end - start);
}

/* A window of this width around a time, moved to lie between the ends; its beginning. */
static double window_at(const struct dalcs_curve *curve, double time, double width) {
    return fmin(fmax(time - 0.5 * width, curve->start), curve->stop - width);
}

static double mean_at(const struct dalcs_curve *curve, double time, double width) {
    const double from = window_at(curve, time, width);
    return (integral_to(curve, from + width) - integral_to(curve, from)) / width;
}

/* false: nothing is drawn there. */
static bool find_range(const struct dalcs_curve *curve, double from, double to,
                       struct dalcs_band_point *point) {
    const int last = dalcs_curve_find_column(curve, to);
    point->low = INFINITY;
    point->high = -INFINITY;
    for (int k = dalcs_curve_find_column(curve, from); k <= last; k++) {
        if (curve->column[k].used) {
            point->low = fmin(point->low, curve->column[k].lowest.value);
            point->high = fmax(point->high, curve->column[k].highest.value);
        }
    }
    return point->low <= point->high;
}

/* The means of windows around all places. */
static void find_means(const struct dalcs_curve *curve, double width, double *mean) {
    const double step = (curve->stop - curve->start) / DALCS_CURVE_PLACES;
    for (int k = 0; k < DALCS_CURVE_PLACES; k++) {
        mean[k] = mean_at(curve, curve->start + (k + 0.5) * step, width);
    }
}

/* The mean of those within half a window of a place, as many on both sides. */
static double mean_of(const double *mean, int place, int half) {
    const int room =
        place < DALCS_CURVE_PLACES - 1 - place ? place : DALCS_CURVE_PLACES - 1 - place;
    const int n = half < room ? half : room;
    double sum = 0.0;
    for (int k = place - n; k <= place + n; k++) {
        sum += mean[k];
    }
    return sum / (2 * n + 1);
}

int dalcs_band_find(const struct dalcs_curve *curve, double period,
                    struct dalcs_band_point point[DALCS_CURVE_COLUMNS]) {
    enum { OF_COLUMN = DALCS_CURVE_PLACES / DALCS_CURVE_COLUMNS };

    const double column = (curve->stop - curve->start) / DALCS_CURVE_COLUMNS;
    const double width = fmax(period, column);
    const int half = (int)(0.5 * width / column * OF_COLUMN);
    double mean[DALCS_CURVE_PLACES];
    find_means(curve, width, mean);
    int n = 0;
    for (int k = 0; k < DALCS_CURVE_COLUMNS; k++) {
        struct dalcs_band_point *p = &point[n];
        p->time = curve->start + (k + 0.5) * column;
        p->mean = mean_of(mean, k * OF_COLUMN + OF_COLUMN / 2, half);
        const double from = window_at(curve, p->time, width);
        n += find_range(curve, from, from + width, p) ? 1 : 0;
    }
    return n;
}

/* file_windows.c - integrals by trapezoids, and sums of them over windows of 1, 2, 4, ... intervals.
 *
 * What is stored at the two ends of a window may be off by the tolerance, however short it is: so a short one
 * sees a spoilt number, and a long one an element of another value. The error of a trapezoid is estimated by
 * how the slope changes at the two ends of its interval: h^2/2 times the larger change is what a jump makes of
 * it that lies anywhere between two rows, with a straight line on either side of it that goes on beyond them;
 * four times what a kink makes at most; and six times h^3/12 |x''|, the one of a smooth curve at equal distances. */
#include "file_internal.h"

static double slope(const struct file_row *from, const struct file_row *to, double x0, double x1) {
    return (x1 - x0) / (to->t - from->t);
}

struct file_number file_trapezoid(struct file_row *const row[4], const struct file_number x[4]) {
    const double h = row[2]->t - row[1]->t;
    const double middle = slope(row[1], row[2], x[1].value, x[2].value);
    const bool has_left = row[0] != NULL && x[0].known && !row[1]->is_behind;
    const bool has_right = row[3] != NULL && x[3].known && !row[3]->is_behind;
    double bend[2] = {0.0, 0.0};
    if (has_left) {
        bend[0] = fabs(middle - slope(row[0], row[1], x[0].value, x[1].value));
    }
    if (has_right) {
        bend[1] = fabs(middle - slope(row[2], row[3], x[2].value, x[3].value));
    }
    bend[0] = has_left ? bend[0] : bend[1];
    bend[1] = has_right ? bend[1] : bend[0];
    const double error = has_left || has_right
                             ? 0.5 * h * h * fmax(bend[0], bend[1])
                             : 0.5 * h * fabs(x[2].value - x[1].value); /* any monotone curve */
    const double digits =
        0.5 * h * (x[1].error + x[2].error) +
        (row[1]->t_error + row[2]->t_error) * fmax(fabs(x[1].value), fabs(x[2].value));
    return (struct file_number){0.5 * h * (x[1].value + x[2].value), error + digits,
                                x[1].known && x[2].known};
}

void file_window_begin(struct file_window *w, double end) {
    *w = (struct file_window){.signature = w->signature, .now.end = end};
    for (int k = 0; k < FILE_LEVELS; k++) {
        w->at[k] = w->now;
    }
}

static void judge(struct file_audit *a, const struct file_window *w,
                  const struct file_window_law *law, const struct file_window_sum *from,
                  double to) {
    const double duration = w->now.time - from->time;
    const double allowed = w->now.error - from->error + from->end + w->now.end +
                           2.0 * law->end_tolerance + law->rate_tolerance * duration;
    const double defect = fabs(w->now.residual - from->residual);
    if (law->law == DALCS_AUDIT_KCL) {
        file_find_set(a, law->index, law->unit, defect, allowed, to - duration, to);
        return;
    }
    struct file_worst *worst = &a->worst[law->law][law->index];
    const double sees = allowed / fabs(w->now.moved - from->moved);
    worst->sees = worst->sees > 0.0 ? fmin(worst->sees, sees) : sees;
    file_find(a, law->law, law->index, law->unit, defect, allowed, to - duration, to);
}

void file_window_add(struct file_audit *a, struct file_window *w, const struct file_window_law *law,
                     struct file_number residual, double moved, double duration, double end,
                     double to) {
    w->n++;
    w->now.moved += moved;
    w->now.residual += residual.value;
    w->now.error += residual.error;
    w->now.time += duration;
    w->now.end = end;
    for (int k = 0; k < FILE_LEVELS && (w->n & (((size_t)1 << k) - 1)) == 0; k++) {
        judge(a, w, law, &w->at[k], to);
        w->at[k] = w->now;
    }
}

/* thinning.c - swinging door: which slopes from the last kept row still pass by all rows since.
 *
 * A line that ends on the newest row may replace the rows between if its slope is one of these. Each
 * row narrows them by its own door, value +- bound * scale; the scale only grows, so a row is held to
 * what was the scale when it came. (E. H. Bristol, Swinging door trending, ISA 1990.) */
#include "thinning.h"

#include "memory.h"
#include "rounding.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static enum dalcs_status hand_on(struct dalcs_thinning *t, double time, const double *value) {
    enum dalcs_status status = t->to->row(t->to->user, time, value);
    t->refused = status != DALCS_OK;
    return status;
}

/* A row was handed on: lines start from it, in any direction. */
static void start_from(struct dalcs_thinning *t, double time, const double *value) {
    t->has_kept = true;
    t->has_held = false;
    t->kept_time = time;
    memcpy(t->kept, value, t->n_signals * sizeof(*value));
    for (size_t i = 0; i < t->n_signals; i++) {
        t->low[i] = -INFINITY;
        t->high[i] = INFINITY;
    }
}

/* Does the line from the kept row to this one pass all doors between? */
static bool passes(const struct dalcs_thinning *t, double time, const double *value) {
    for (size_t i = 0; i < t->n_signals; i++) {
        double slope = (value[i] - t->kept[i]) / (time - t->kept_time);
        if (!(slope >= t->low[i] && slope <= t->high[i])) {
            return false;
        }
    }
    return true;
}

static void hold(struct dalcs_thinning *t, double time, const double *value) {
    double span = time - t->kept_time;
    t->has_held = true;
    t->held_time = time;
    memcpy(t->held, value, t->n_signals * sizeof(*value));
    for (size_t i = 0; i < t->n_signals; i++) {
        double door = fmax(t->bound - dalcs_rounded, 0.0) * t->scale[i];
        t->low[i] = fmax(t->low[i], (value[i] - door - t->kept[i]) / span);
        t->high[i] = fmin(t->high[i], (value[i] + door - t->kept[i]) / span);
    }
}

enum dalcs_status dalcs_thinning_flush(struct dalcs_thinning *t) {
    if (!t->has_held || t->refused) {
        return DALCS_OK;
    }
    DALCS_TRY(hand_on(t, t->held_time, t->held));
    start_from(t, t->held_time, t->held);
    return DALCS_OK;
}

static enum dalcs_status take_begin(void *user, const struct dalcs_plot *plot) {
    struct dalcs_thinning *t = user;
    return t->to->begin(t->to->user, plot);
}

static enum dalcs_status take_row(void *user, double time, const double *value) {
    struct dalcs_thinning *t = user;
    for (size_t i = 0; i < t->n_signals; i++) {
        t->scale[i] = fmax(t->scale[i], fabs(value[i]));
    }
    double newest = t->has_held ? t->held_time : t->kept_time;
    if (!t->has_kept || time <= newest) { /* the first row, or the far side of a discontinuity */
        DALCS_TRY(dalcs_thinning_flush(t));
        DALCS_TRY(hand_on(t, time, value));
        start_from(t, time, value);
        return DALCS_OK;
    }
    if (!passes(t, time, value)) {
        DALCS_TRY(dalcs_thinning_flush(t));
    }
    hold(t, time, value);
    return DALCS_OK;
}

static enum dalcs_status take_end(void *user) {
    struct dalcs_thinning *t = user;
    DALCS_TRY(dalcs_thinning_flush(t));
    return t->to->end(t->to->user);
}

static enum dalcs_status take_progress(void *user, double time, double stop) {
    struct dalcs_thinning *t = user;
    return t->to->progress(t->to->user, time, stop);
}

enum dalcs_status dalcs_thinning_setup(struct dalcs_thinning *t, const struct dalcs_sink *to,
                                       size_t n_signals, double bound) {
    *t = (struct dalcs_thinning){
        .sink = {.user = t,
                 .begin = take_begin,
                 .row = take_row,
                 .end = take_end,
                 .progress = take_progress},
        .to = to,
        .bound = bound,
        .n_signals = n_signals,
    };
    double **const array[] = {&t->kept, &t->held, &t->low, &t->high, &t->scale};
    for (size_t k = 0; k < sizeof(array) / sizeof(*array); k++) {
        *array[k] = dalcs_alloc(n_signals, sizeof(double));
        if (*array[k] == NULL) {
            dalcs_thinning_finish(t);
            return DALCS_E_NOMEM;
        }
    }
    return DALCS_OK;
}

void dalcs_thinning_finish(struct dalcs_thinning *t) {
    free(t->kept);
    free(t->held);
    free(t->low);
    free(t->high);
    free(t->scale);
    *t = (struct dalcs_thinning){0};
}

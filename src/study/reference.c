/* reference.c - the best answer there is, and how good it is. */
#include "reference.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SMALL_SIGNAL 1e-2 /* of the largest of its unit: the least scale */
#define NEAR_BREAK   1e-5 /* of the run: what counts as next to a break */
#define NEAR_GAP     0.05 /* of the median time between breaks: no more than that */
#define JUMP_STEPS   2.0  /* of the netlist: what counts as next to a jump */
#define WIDER        1e-9 /* tolerance of the second answer where its own is too tight */
#define GOLDEN       0.382 /* part of the grid's spacing that it starts with: no multiple of any period */

enum { N_SPREAD = 2000, MAX_ALIGNED = 4000 };

static int compare_numbers(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static struct dalcs_run_options tight(const struct dalcs_reference *r, bool second) {
    struct dalcs_run_options options = dalcs_run_options_default();
    options.method = "radau";
    options.stages = second ? r->second_stages : r->stages;
    options.tolerance = second ? r->second_tolerance : r->tolerance;
    options.record = true;
    options.at = r->times.at;
    options.n_at = r->times.n;
    return options;
}

static enum dalcs_status keep_jumps(struct dalcs_reference *r) {
    const struct dalcs_report *report = dalcs_session_report(r->session);
    r->jumps.time = dalcs_alloc(report->n_jumps, sizeof *r->jumps.time);
    if (!r->jumps.time) {
        return DALCS_E_NOMEM;
    }
    r->jumps.n = report->n_jumps;
    for (size_t i = 0; i < r->jumps.n; i++) {
        r->jumps.time[i] = report->jump[i].time;
    }
    qsort(r->jumps.time, r->jumps.n, sizeof *r->jumps.time, compare_numbers);
    return DALCS_OK;
}

enum dalcs_status dalcs_reference_begin(struct dalcs_reference *r, struct dalcs_session *session,
                                        const volatile sig_atomic_t *interrupted) {
    const struct dalcs_request request = dalcs_session_request(session);
    *r = (struct dalcs_reference){.session = session,
                                  .interrupted = interrupted,
                                  .start = request.start,
                                  .stop = request.stop,
                                  .stages = 7,
                                  .second_stages = 5,
                                  .tolerance = 1e-11,
                                  .second_tolerance = 1e-10};
    r->jumps.window = JUMP_STEPS * (request.max_step > 0.0 ? request.max_step : request.step);
    const struct dalcs_run_options options = tight(r, false);
    enum dalcs_status status =
        dalcs_breaks_find(session, &options, interrupted, &r->breaks.time, &r->breaks.n);
    return status == DALCS_OK ? keep_jumps(r) : status;
}

double dalcs_reference_median_gap(const struct dalcs_reference *r) {
    double median = r->stop - r->start;
    double *gap = r->breaks.n > 1 ? dalcs_alloc(r->breaks.n - 1, sizeof *gap) : NULL;
    if (gap) {
        for (size_t i = 0; i + 1 < r->breaks.n; i++) {
            gap[i] = r->breaks.time[i + 1] - r->breaks.time[i];
        }
        qsort(gap, r->breaks.n - 1, sizeof *gap, compare_numbers);
        median = gap[(r->breaks.n - 1) / 2];
    }
    free(gap);
    return median;
}

/* list[n] ascends. */
static bool is_near_any(const double *list, size_t n, double time, double window) {
    size_t low = 0, high = n; /* the first one not before time - window */
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (list[middle] < time - window) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < n && list[low] <= time + window;
}

static bool is_near_break(const struct dalcs_reference *r, double time, double window) {
    return time <= r->start + window || time >= r->stop - window ||
           is_near_any(r->breaks.time, r->breaks.n, time, window) ||
           is_near_any(r->jumps.time, r->jumps.n, time, fmax(window, r->jumps.window));
}

static enum dalcs_status make_room(struct dalcs_reference *r, size_t n) {
    r->times.at = dalcs_alloc(n, sizeof *r->times.at);
    r->times.is_measured = dalcs_alloc(n, sizeof *r->times.is_measured);
    return r->times.at && r->times.is_measured ? DALCS_OK : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_reference_spread(struct dalcs_reference *r, double view, size_t n_view) {
    enum dalcs_status status = make_room(r, N_SPREAD + n_view);
    if (status != DALCS_OK) {
        return status;
    }
    double spacing = (r->stop - r->start) / N_SPREAD;
    r->times.window =
        fmin(NEAR_BREAK * (r->stop - r->start), NEAR_GAP * dalcs_reference_median_gap(r));
    size_t k = 0, v = 0;
    while (k < N_SPREAD || v < n_view) {
        double measured = k < N_SPREAD ? r->start + ((double)k + GOLDEN) * spacing : INFINITY;
        double drawn =
            v < n_view ? view + (r->stop - view) * (double)v / (double)(n_view - 1) : INFINITY;
        bool takes_measured = measured <= drawn;
        r->times.at[r->times.n] = fmin(measured, drawn);
        r->times.is_measured[r->times.n] =
            takes_measured && !is_near_break(r, measured, r->times.window);
        r->times.n_measured += r->times.is_measured[r->times.n++] ? 1 : 0;
        k += takes_measured ? 1 : 0;
        v += drawn <= measured ? 1 : 0;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_reference_align(struct dalcs_reference *r, double step, double window) {
    double last = floor(r->stop / step * (1.0 + 1e-12));
    double stride = fmax(1.0, ceil(last / MAX_ALIGNED));
    enum dalcs_status status = make_room(r, MAX_ALIGNED + 1);
    if (status != DALCS_OK) {
        return status;
    }
    r->times.window = window;
    for (double k = stride; k <= last; k += stride) {
        double time = fmin(k * step, r->stop);
        if (time > r->start && !is_near_break(r, time, window)) {
            r->times.is_measured[r->times.n] = true;
            r->times.at[r->times.n++] = time;
        }
    }
    r->times.n_measured = r->times.n;
    return DALCS_OK;
}

static void find_scales(struct dalcs_reference *r) {
    const struct dalcs_plot *plot = r->samples.plot;
    double largest[2] = {0.0, 0.0}; /* by unit */
    for (size_t i = 0; i < r->times.n; i++) {
        for (size_t s = 0; s < r->n_signals; s++) {
            double size = fabs(r->samples.value[i * r->n_signals + s]);
            r->scale[s] = fmax(r->scale[s], size);
            largest[plot->unit[s]] = fmax(largest[plot->unit[s]], size);
        }
    }
    for (size_t s = 0; s < r->n_signals; s++) {
        double least = SMALL_SIGNAL * largest[plot->unit[s]];
        r->scale[s] = fmax(r->scale[s], least > 0.0 ? least : 1.0);
    }
}

static void find_open(struct dalcs_reference *r) {
    const struct dalcs_report *report = dalcs_session_report(r->session);
    for (size_t s = 0; s < r->n_signals; s++) {
        for (size_t i = 0; i < report->n_nonunique; i++) {
            r->is_open[s] =
                r->is_open[s] || strcmp(report->nonunique[i].signal, r->samples.plot->name[s]) == 0;
        }
    }
}

static void compare_answers(struct dalcs_reference *r, const double *second) {
    for (size_t i = 0; i < r->times.n; i++) {
        for (size_t s = 0; s < r->n_signals && r->times.is_measured[i]; s++) {
            size_t k = i * r->n_signals + s;
            double doubt = fabs(r->samples.value[k] - second[k]) / r->scale[s];
            r->doubt[s] = fmax(r->doubt[s], r->is_open[s] ? 0.0 : doubt);
        }
    }
    for (size_t s = 0; s < r->n_signals; s++) {
        r->most_doubt = r->doubt[s] > r->doubt[r->most_doubt] ? s : r->most_doubt;
    }
}

/* Five stages cannot hold 1e-10 at every event. Where they take Euler's steps instead, their answer is
 * worse than that of a wider tolerance. */
static enum dalcs_status solve_again(struct dalcs_reference *r, struct dalcs_samples *second) {
    struct dalcs_run_options options = tight(r, true);
    enum dalcs_status status = dalcs_samples_run(second, r->session, &options, r->interrupted);
    if (status == DALCS_OK && dalcs_session_report(r->session)->work.euler_steps > 0) {
        dalcs_samples_finish(second);
        r->second_tolerance = WIDER;
        options = tight(r, true);
        status = dalcs_samples_run(second, r->session, &options, r->interrupted);
    }
    return status;
}

enum dalcs_status dalcs_reference_solve(struct dalcs_reference *r) {
    struct dalcs_run_options options = tight(r, false);
    enum dalcs_status status = dalcs_samples_run(&r->samples, r->session, &options, r->interrupted);
    if (status != DALCS_OK) {
        return status;
    }
    r->n_signals = r->samples.plot->n_signals;
    r->scale = dalcs_alloc(r->n_signals, sizeof *r->scale);
    r->is_open = dalcs_alloc(r->n_signals, sizeof *r->is_open);
    r->doubt = dalcs_alloc(r->n_signals, sizeof *r->doubt);
    if (!r->scale || !r->is_open || !r->doubt) {
        return DALCS_E_NOMEM;
    }
    find_scales(r);
    find_open(r);
    struct dalcs_samples second;
    status = solve_again(r, &second);
    if (status == DALCS_OK) {
        compare_answers(r, second.value);
        dalcs_samples_finish(&second);
    }
    return status;
}

void dalcs_reference_finish(struct dalcs_reference *r) {
    free(r->breaks.time);
    free(r->jumps.time);
    free(r->times.at);
    free(r->times.is_measured);
    free(r->scale);
    free(r->is_open);
    free(r->doubt);
    dalcs_samples_finish(&r->samples);
    *r = (struct dalcs_reference){0};
}

/* samples.c - sinks that keep rows, count them, or look for two of one time. */
#include "samples.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WORTH_REPEATING 0.3 /* s; longer runs are timed once */

struct receiver {
    const volatile sig_atomic_t *interrupted;
    const struct dalcs_plot *plot; /* NULL while .op is received */
    struct dalcs_samples *samples; /* the next three may be NULL */
    FILE *file;
    double *time; /* of breaks */
    size_t n, capacity;
    bool finds_breaks;
    double before;
};

static enum dalcs_status check_interrupt(const struct receiver *r) {
    return *r->interrupted ? DALCS_E_CANCELLED : DALCS_OK;
}

static enum dalcs_status begin(void *user, const struct dalcs_plot *plot) {
    struct receiver *r = user;
    r->plot = plot->analysis == DALCS_TRANSIENT ? plot : NULL;
    if (r->plot && r->samples) {
        r->samples->plot = plot;
        r->samples->value =
            dalcs_alloc(r->samples->n_times * plot->n_signals, sizeof *r->samples->value);
        return r->samples->value ? DALCS_OK : DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

static enum dalcs_status keep_break(struct receiver *r, double time) {
    if (time == r->before && (r->n == 0 || r->time[r->n - 1] != time)) {
        enum dalcs_status status = dalcs_grow(&r->time, &r->capacity, r->n + 1, sizeof *r->time);
        if (status != DALCS_OK) {
            return status;
        }
        r->time[r->n++] = time;
    }
    r->before = time;
    return DALCS_OK;
}

static enum dalcs_status row(void *user, double time, const double *value) {
    struct receiver *r = user;
    if (!r->plot) {
        return DALCS_OK;
    }
    size_t n = r->plot->n_signals;
    if (r->samples && r->samples->n_rows < r->samples->n_times) {
        memcpy(r->samples->value + n * r->samples->n_rows++, value, n * sizeof *value);
    }
    if (r->file) {
        fwrite(&time, sizeof time, 1, r->file);
        fwrite(value, sizeof *value, n, r->file);
        r->n++;
    }
    enum dalcs_status status = r->finds_breaks ? keep_break(r, time) : DALCS_OK;
    return status == DALCS_OK ? check_interrupt(r) : status;
}

static enum dalcs_status progress(void *user, double time, double stop) {
    (void)time;
    (void)stop;
    return check_interrupt(user);
}

static enum dalcs_status run(struct receiver *r, struct dalcs_session *session,
                             const struct dalcs_run_options *options) {
    const struct dalcs_sink sink = {.user = r, .begin = begin, .row = row, .progress = progress};
    return dalcs_session_run(session, options, &sink);
}

enum dalcs_status dalcs_samples_run(struct dalcs_samples *samples, struct dalcs_session *session,
                                    const struct dalcs_run_options *options,
                                    const volatile sig_atomic_t *interrupted) {
    *samples = (struct dalcs_samples){.n_times = options->n_at};
    struct receiver r = {.interrupted = interrupted, .samples = samples};
    enum dalcs_status status = run(&r, session, options);
    if (status != DALCS_OK) {
        dalcs_samples_finish(samples);
    }
    return status;
}

void dalcs_samples_finish(struct dalcs_samples *samples) {
    free(samples->value);
    *samples = (struct dalcs_samples){0};
}

enum dalcs_status dalcs_cost_measure(struct dalcs_cost *cost, struct dalcs_session *session,
                                     const struct dalcs_run_options *options,
                                     const volatile sig_atomic_t *interrupted) {
    *cost = (struct dalcs_cost){.cpu_s = INFINITY};
    enum dalcs_status status = DALCS_OK;
    for (int i = 0; i < 3 && status == DALCS_OK && (i == 0 || cost->cpu_s < WORTH_REPEATING); i++) {
        struct receiver r = {.interrupted = interrupted, .file = tmpfile()};
        if (!r.file) {
            return DALCS_E_IO;
        }
        status = run(&r, session, options);
        fclose(r.file);
        if (status == DALCS_OK) {
            const struct dalcs_report *report = dalcs_session_report(session);
            cost->cpu_s = fmin(cost->cpu_s, report->work.cpu_s);
            cost->points = r.n;
            cost->steps = report->work.steps;
            cost->factorizations = report->work.factorizations;
        }
    }
    return status;
}

enum dalcs_status dalcs_breaks_find(struct dalcs_session *session,
                                    const struct dalcs_run_options *options,
                                    const volatile sig_atomic_t *interrupted, double **time,
                                    size_t *n) {
    struct receiver r = {.interrupted = interrupted, .finds_breaks = true, .before = NAN};
    enum dalcs_status status = run(&r, session, options);
    if (status != DALCS_OK) {
        free(r.time);
        return status;
    }
    *time = r.time;
    *n = r.n;
    return DALCS_OK;
}

/* convergence.c - every step with every method, against the reference. */
#include "convergence.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>

#define STEPS_AWAY  3.0  /* of the largest step: how far from a break errors are measured */
#define GAP_AWAY    0.25 /* of the median time between breaks, if that is less */
#define KNOWN_BADLY 3.0  /* times the doubt of the reference: an error that says nothing */
#define ROUNDING    1e-13

static void find_worst(const struct dalcs_reference *r, const struct dalcs_deviation *deviation,
                       struct dalcs_convergence_row *row) {
    row->rms = deviation->worst_rms;
    row->largest = deviation->worst_largest;
    for (size_t s = 0; s < r->n_signals; s++) {
        if (!r->is_open[s] && deviation->largest[s] > deviation->largest[row->worst]) {
            row->worst = s;
        }
    }
}

static enum dalcs_status measure(struct dalcs_convergence *c, struct dalcs_convergence_row *row) {
    struct dalcs_run_options options = dalcs_run_options_default();
    options.method = row->stepping.method;
    options.stages = row->stepping.stages;
    options.step = row->step;
    options.at = c->reference.times.at;
    options.n_at = c->reference.times.n;
    struct dalcs_samples samples;
    enum dalcs_status status = dalcs_samples_run(&samples, c->session, &options, c->interrupted);
    if (status > 0) { /* such a step is not possible: the others go on */
        row->failed = true;
        return DALCS_OK;
    }
    if (status != DALCS_OK) {
        return status;
    }
    const struct dalcs_report *report = dalcs_session_report(c->session);
    row->steps = report->work.steps;
    row->cpu_s = report->work.cpu_s;
    struct dalcs_deviation deviation;
    status = dalcs_deviation_measure(&deviation, &c->reference, samples.value);
    if (status == DALCS_OK) {
        find_worst(&c->reference, &deviation, row);
        dalcs_deviation_finish(&deviation);
    }
    dalcs_samples_finish(&samples);
    return status;
}

/* An order means something as long as both errors are well above what is known of the reference. */
static double order_of(const struct dalcs_reference *r, const struct dalcs_convergence_row *before,
                       const struct dalcs_convergence_row *row) {
    double least = fmax(ROUNDING, KNOWN_BADLY * r->doubt[r->most_doubt]);
    if (before->failed || row->failed || !(row->largest > least) || !(before->largest > least)) {
        return NAN;
    }
    return log(before->largest / row->largest) / log(before->step / row->step);
}

static enum dalcs_status make_reference(struct dalcs_convergence *c, double largest_step) {
    struct dalcs_reference *r = &c->reference;
    enum dalcs_status status = dalcs_reference_begin(r, c->session, c->interrupted);
    if (status == DALCS_OK) {
        double gap = dalcs_reference_median_gap(r);
        status =
            dalcs_reference_align(r, largest_step, fmin(STEPS_AWAY * largest_step, GAP_AWAY * gap));
    }
    if (status == DALCS_OK && r->times.n == 0) {
        status = DALCS_E_OPTION;
    }
    return status == DALCS_OK ? dalcs_reference_solve(r) : status;
}

enum dalcs_status dalcs_convergence_make(struct dalcs_convergence *c, const double *step,
                                         size_t n_steps, const struct dalcs_stepping *stepping,
                                         size_t n_steppings) {
    c->row = dalcs_alloc(n_steps * n_steppings, sizeof *c->row);
    if (!c->row) {
        return DALCS_E_NOMEM;
    }
    enum dalcs_status status = make_reference(c, step[0]);
    for (size_t i = 0; i < n_steppings; i++) {
        for (size_t k = 0; k < n_steps && status == DALCS_OK; k++) {
            struct dalcs_convergence_row *row = &c->row[c->n_rows++];
            *row = (struct dalcs_convergence_row){.stepping = stepping[i], .step = step[k]};
            status = measure(c, row);
            row->order = k > 0 ? order_of(&c->reference, row - 1, row) : NAN;
        }
    }
    return status;
}

size_t dalcs_convergence_group(const struct dalcs_convergence *c, size_t first) {
    size_t n = 0;
    while (first + n < c->n_rows &&
           (n == 0 || c->row[first + n].step < c->row[first + n - 1].step)) {
        n++;
    }
    return n;
}

static int compare_numbers(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double dalcs_convergence_order(const struct dalcs_convergence *c, size_t first) {
    enum { MOST = 64 };

    double order[MOST] = {0};
    size_t n = 0, n_rows = dalcs_convergence_group(c, first);
    for (size_t k = 0; k < n_rows && n < MOST; k++) {
        if (!isnan(c->row[first + k].order)) {
            order[n++] = c->row[first + k].order;
        }
    }
    qsort(order, n, sizeof *order, compare_numbers);
    return n > 0 ? 0.5 * (order[(n - 1) / 2] + order[n / 2]) : NAN;
}

void dalcs_stepping_write(FILE *stream, const struct dalcs_stepping *stepping) {
    fputs(stepping->method, stream);
    if (stepping->stages > 0) {
        fprintf(stream, ", %d stage%s", stepping->stages, stepping->stages == 1 ? "" : "s");
    }
}

void dalcs_convergence_finish(struct dalcs_convergence *c) {
    free(c->row);
    dalcs_reference_finish(&c->reference);
    *c = (struct dalcs_convergence){0};
}

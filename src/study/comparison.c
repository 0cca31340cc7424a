/* comparison.c - the reference, dalcs's rows, ngspice's trials. */
#include "comparison.h"

#include "memory.h"
#include "quantity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Where there are more breaks than the first number, drawings show the time of the last few. */
enum { MAX_BREAKS_SEEN = 60, BREAKS_AT_END = 24, N_VIEW = 900 };

#define MAX_STEPS    4e6   /* of one run of euler */
#define LEAST_LIMIT  2.0   /* s of CPU time, of a run of ngspice when no limit was asked for */
#define LIMIT_FACTOR 100.0 /* times what dalcs takes, if that is more */

static const double tolerance[] = {1e-3, 1e-4, 1e-5, 1e-7, 1e-8};
static const double finer[] = {0.25, 1.0 / 16.0};

enum {
    N_TOLERANCES = sizeof tolerance / sizeof tolerance[0],
    N_FINER = sizeof finer / sizeof finer[0]
};

static struct dalcs_run_options options_of(const struct dalcs_comparison_row *row) {
    struct dalcs_run_options options = dalcs_run_options_default();
    options.method = row->method;
    options.tolerance = row->tolerance;
    options.step = row->step;
    return options;
}

/* A method that cannot do this circuit, or this accuracy, is no reason to stop. */
static enum dalcs_status settle(struct dalcs_comparison_row *row, enum dalcs_status status) {
    if (status > 0) {
        row->failed = true;
        return DALCS_OK;
    }
    return status;
}

/* Fills in what a row's run chose by itself. */
static void read_choices(struct dalcs_comparison_row *row, const struct dalcs_report *report) {
    if (strcmp(row->method, "euler") == 0) {
        row->step = report->step;
    } else {
        row->tolerance = report->tolerance;
    }
}

static enum dalcs_status measure_row(struct dalcs_comparison *c, struct dalcs_comparison_row *row) {
    struct dalcs_run_options options = options_of(row);
    enum dalcs_status status = dalcs_cost_measure(&row->cost, c->session, &options, c->interrupted);
    if (status == DALCS_OK) {
        read_choices(row, dalcs_session_report(c->session));
        options.at = c->reference.times.at;
        options.n_at = c->reference.times.n;
        struct dalcs_samples samples;
        status = dalcs_samples_run(&samples, c->session, &options, c->interrupted);
        if (status == DALCS_OK) {
            status = dalcs_deviation_measure(&row->deviation, &c->reference, samples.value);
        }
        if (status == DALCS_OK && row == c->row) {
            c->value = samples.value;
            samples.value = NULL;
        }
        dalcs_samples_finish(&samples);
    }
    return settle(row, status);
}

static enum dalcs_status add_row(struct dalcs_comparison *c, const char *method, double tol,
                                 double step) {
    if (c->n_rows == DALCS_MAX_ROWS) {
        return DALCS_OK;
    }
    struct dalcs_comparison_row *row = &c->row[c->n_rows++];
    *row = (struct dalcs_comparison_row){.method = method, .tolerance = tol, .step = step};
    return measure_row(c, row);
}

/* As it comes; then by tolerance, or with smaller steps. */
static enum dalcs_status add_method(struct dalcs_comparison *c, const char *method) {
    int first = c->n_rows;
    enum dalcs_status status = add_row(c, method, 0.0, 0.0);
    const struct dalcs_comparison_row plain = c->row[first];
    if (strcmp(method, "euler") == 0) {
        for (int i = 0; i < N_FINER && status == DALCS_OK && !plain.failed; i++) {
            if (c->reference.stop / (finer[i] * plain.step) <= MAX_STEPS) {
                status = add_row(c, method, 0.0, finer[i] * plain.step);
            }
        }
        return status;
    }
    for (int i = 0; i < N_TOLERANCES && status == DALCS_OK; i++) {
        if (tolerance[i] != plain.tolerance) {
            status = add_row(c, method, tolerance[i], 0.0);
        }
    }
    return status;
}

static enum dalcs_status make_reference(struct dalcs_comparison *c) {
    struct dalcs_reference *r = &c->reference;
    enum dalcs_status status = dalcs_reference_begin(r, c->session, c->interrupted);
    if (status != DALCS_OK) {
        return status;
    }
    c->view =
        r->breaks.n > MAX_BREAKS_SEEN ? r->breaks.time[r->breaks.n - BREAKS_AT_END] : r->start;
    status = dalcs_reference_spread(r, c->view, N_VIEW);
    return status == DALCS_OK ? dalcs_reference_solve(r) : status;
}

enum dalcs_status dalcs_comparison_make(struct dalcs_comparison *c, const char *const *method,
                                        int n_methods) {
    enum dalcs_status status = make_reference(c);
    for (int i = 0; i < n_methods && status == DALCS_OK; i++) {
        status = add_method(c, method[i]);
    }
    if (status == DALCS_OK && c->row[0].failed) {
        status = DALCS_NOT_CONVERGED; /* nothing to compare */
    }
    if (status != DALCS_OK) {
        return status;
    }
    const struct dalcs_request request = dalcs_session_request(c->session);
    const struct dalcs_report *report = dalcs_session_report(c->session);
    if (c->ngspice.limit == 0.0) {
        c->ngspice.limit = fmax(LEAST_LIMIT, LIMIT_FACTOR * c->row[0].cost.cpu_s);
    }
    c->search.ngspice = &c->ngspice;
    c->search.reference = &c->reference;
    c->search.step = request.max_step > 0.0 ? request.max_step : request.step;
    c->search.step = c->search.step > 0.0 ? c->search.step : request.stop / 1000.0;
    c->search.edge = fmin(1e-9, 1e-6 * request.stop);
    c->search.has_diodes = report->size.lambda > 0;
    c->search.has_switches = report->size.switches > 0;
    return dalcs_ngspice_search_run(&c->search);
}

int dalcs_comparison_fastest(const struct dalcs_comparison *c, double level) {
    int fastest = -1;
    for (int k = 0; k < c->n_rows; k++) {
        if (!c->row[k].failed && c->row[k].deviation.worst_rms <= level &&
            (fastest < 0 || c->row[k].cost.cpu_s < c->row[fastest].cost.cpu_s)) {
            fastest = k;
        }
    }
    return fastest;
}

void dalcs_comparison_row_write(FILE *stream, const struct dalcs_comparison_row *row) {
    char text[DALCS_QUANTITY_SIZE];
    if (row->step > 0.0) {
        fprintf(stream, "%s, step %s", row->method, dalcs_quantity_write(text, row->step, "s", 4));
    } else {
        fprintf(stream, "%s, tolerance %g", row->method, row->tolerance);
    }
}

void dalcs_comparison_finish(struct dalcs_comparison *c) {
    for (int k = 0; k < c->n_rows; k++) {
        dalcs_deviation_finish(&c->row[k].deviation);
    }
    free(c->value);
    dalcs_ngspice_search_finish(&c->search);
    dalcs_ngspice_close(&c->ngspice);
    dalcs_reference_finish(&c->reference);
    *c = (struct dalcs_comparison){0};
}

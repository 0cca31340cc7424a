/* measurements_json.c - what .meas and .four found. */
#include "measurements_json.h"

#include <math.h>

static void write_step(struct dalcs_json *json, const char *step) {
    if (step != NULL) {
        dalcs_json_string(json, "step", step);
    }
}

static void write_measurements(struct dalcs_json *json, const struct dalcs_report *report) {
    dalcs_json_open(json, "measurements", '[', false);
    for (size_t i = 0; i < report->n_measurements; i++) {
        const struct dalcs_measurement *m = &report->measurement[i];
        dalcs_json_open(json, NULL, '{', true);
        dalcs_json_string(json, "name", m->name);
        write_step(json, m->step);
        if (m->found) {
            dalcs_json_number(json, "value", m->value);
        } else {
            dalcs_json_string(json, "value", NULL);
            dalcs_json_string(json, "failure", m->failure);
        }
        for (int k = 0; k < m->n_details; k++) {
            dalcs_json_number(json, m->detail[k].name, m->detail[k].value);
        }
        dalcs_json_close(json, '}');
    }
    dalcs_json_close(json, ']');
}

static void write_fourier(struct dalcs_json *json, const struct dalcs_report *report) {
    if (report->n_fourier == 0) {
        return;
    }
    dalcs_json_open(json, "fourier", '[', false);
    for (size_t i = 0; i < report->n_fourier; i++) {
        const struct dalcs_fourier *f = &report->fourier[i];
        dalcs_json_open(json, NULL, '{', false);
        dalcs_json_string(json, "signal", f->signal);
        write_step(json, f->step);
        dalcs_json_number(json, "frequency", f->frequency);
        dalcs_json_number(json, "from", f->from);
        dalcs_json_number(json, "to", f->to);
        if (isfinite(f->thd)) {
            dalcs_json_number(json, "thd", f->thd);
        } else {
            dalcs_json_string(json, "thd", NULL);
        }
        dalcs_json_open(json, "magnitude", '[', true);
        for (size_t k = 0; k < f->n_harmonics; k++) {
            dalcs_json_number(json, NULL, f->magnitude[k]);
        }
        dalcs_json_close(json, ']');
        dalcs_json_open(json, "phase", '[', true);
        for (size_t k = 0; k < f->n_harmonics; k++) {
            dalcs_json_number(json, NULL, f->phase[k]);
        }
        dalcs_json_close(json, ']');
        dalcs_json_close(json, '}');
    }
    dalcs_json_close(json, ']');
}

void dalcs_measurements_json_write(struct dalcs_json *json, const struct dalcs_report *report) {
    write_measurements(json, report);
    write_fourier(json, report);
}

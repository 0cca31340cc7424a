/* measurements.c - ngspice's layout, with 10 digits. */
#include "measurements.h"

#include <math.h>
#include <string.h>

static void write_measurement(FILE *out, const struct dalcs_measurement *m) {
    if (!m->found) {
        fprintf(out, "%-20s=  failed\n", m->name);
        return;
    }
    fprintf(out, "%-20s=  %.9e", m->name, m->value);
    for (int k = 0; k < m->n_details; k++) {
        fprintf(out, " %s=  %.9e", m->detail[k].name, m->detail[k].value);
    }
    fputc('\n', out);
}

static void write_fourier(FILE *out, const struct dalcs_fourier *f) {
    const bool has_fundamental = isfinite(f->thd);
    fprintf(out, "\nFourier analysis for %s:\n", f->signal);
    fprintf(out, "  No. Harmonics: %zu, THD: ", f->n_harmonics);
    if (has_fundamental) {
        fprintf(out, "%.10g %%", 100.0 * f->thd);
    } else {
        fputs("none, no fundamental", out);
    }
    fprintf(out, ", from= %.9e to= %.9e\n\n", f->from, f->to);
    fprintf(out, "%-8s %-16s %-16s %-16s %-16s %s\n", "Harmonic", "Frequency", "Magnitude", "Phase",
            "Norm. Mag", "Norm. Phase");
    fprintf(out, "%-8s %-16s %-16s %-16s %-16s %s\n", "--------", "---------", "---------", "-----",
            "---------", "-----------");
    for (size_t k = 0; k < f->n_harmonics; k++) {
        const bool is_normal = k > 0 && has_fundamental;
        fprintf(out, " %-7zu %-16.10g %-16.10g %-16.10g %-16.10g %.10g\n", k,
                (double)k * f->frequency, f->magnitude[k], f->phase[k],
                is_normal ? f->magnitude[k] / f->magnitude[1] : 0.0,
                is_normal ? f->phase[k] - f->phase[1] : 0.0);
    }
}

/* A line before the first of each step. */
static const char *write_step(FILE *out, const char *step, const char *last) {
    if (step != NULL && (last == NULL || strcmp(step, last) != 0)) {
        fprintf(out, "step %s\n", step);
    }
    return step;
}

void dalcs_measurements_write(FILE *out, const struct dalcs_report *report) {
    const char *step = NULL;
    if (report->n_measurements > 0) {
        fputc('\n', out);
    }
    for (size_t k = 0; k < report->n_measurements; k++) {
        step = write_step(out, report->measurement[k].step, step);
        write_measurement(out, &report->measurement[k]);
    }
    step = NULL;
    for (size_t k = 0; k < report->n_fourier; k++) {
        step = write_step(out, report->fourier[k].step, step);
        write_fourier(out, &report->fourier[k]);
    }
}

/* sensitivity_report.c - what a report of a steady state has measured, one after the other. */
#include "sensitivity.h"

#include <math.h>
#include <string.h>

/* A harmonic below this part of the largest has no phase here: errors of 1e-12 of the largest would be 1e-4 of its
 * derivative. */
static const double has_phase = 1e-5;

enum { PER_SIGNAL = 2, PER_HARMONIC = 2 };

/* The constant is an average, which the signals have. */
static size_t results_of(const struct dalcs_fourier *f) {
    return 1 + PER_HARMONIC * (f->n_harmonics > 0 ? f->n_harmonics - 1 : 0);
}

size_t dalcs_sensitivity_count(const struct dalcs_report *report) {
    size_t n = report->steady.self_oscillating ? 1 : 0;
    n += PER_SIGNAL * report->steady.n_signals + report->n_measurements;
    for (size_t k = 0; k < report->n_fourier; k++) {
        n += results_of(&report->fourier[k]);
    }
    return n;
}

static struct dalcs_sensitivity_result of_fourier(const struct dalcs_fourier *f, size_t k) {
    if (k == 0) {
        return (struct dalcs_sensitivity_result){
            .name = f->signal, .kind = "thd", .value = isfinite(f->thd) ? f->thd : (double)NAN};
    }
    const size_t harmonic = 1 + (k - 1) / PER_HARMONIC;
    const bool is_phase = (k - 1) % PER_HARMONIC == 1;
    double largest = 0.0;
    for (size_t i = 0; i < f->n_harmonics; i++) {
        largest = fmax(largest, fabs(f->magnitude[i]));
    }
    const double phase =
        f->magnitude[harmonic] > has_phase * largest ? f->phase[harmonic] : (double)NAN;
    return (struct dalcs_sensitivity_result){.name = f->signal,
                                             .kind = is_phase ? "phase" : "magnitude",
                                             .harmonic = (int)harmonic,
                                             .value = is_phase ? phase : f->magnitude[harmonic]};
}

double dalcs_sensitivity_scale(const struct dalcs_sensitivity_result *all, size_t n, size_t k) {
    static const double degrees = 57.3;
    const struct dalcs_sensitivity_result *of = &all[k];
    double largest = 0.0;
    double own = 0.0;
    for (size_t i = 0; i < n; i++) {
        if (strcmp(all[i].name, of->name) == 0 && strcmp(all[i].kind, "magnitude") == 0) {
            largest = fmax(largest, all[i].value);
            own = all[i].harmonic == of->harmonic ? all[i].value : own;
        }
    }
    return strcmp(of->kind, "average") == 0     ? all[k + 1].value
           : strcmp(of->kind, "magnitude") == 0 ? largest
           : strcmp(of->kind, "phase") == 0     ? degrees * largest / own
                                                : fabs(of->value);
}

struct dalcs_sensitivity_result dalcs_sensitivity_get(const struct dalcs_report *report, size_t k) {
    if (report->steady.self_oscillating && k-- == 0) {
        return (struct dalcs_sensitivity_result){
            .name = "period", .kind = "period", .value = report->steady.period};
    }
    if (k < report->n_measurements) {
        const struct dalcs_measurement *m = &report->measurement[k];
        return (struct dalcs_sensitivity_result){
            .name = m->name, .kind = "measurement", .value = m->found ? m->value : (double)NAN};
    }
    k -= report->n_measurements;
    if (k < PER_SIGNAL * report->steady.n_signals) {
        const struct dalcs_steady_signal *s = &report->steady.signal[k / PER_SIGNAL];
        const bool is_rms = k % PER_SIGNAL == 1;
        return (struct dalcs_sensitivity_result){.name = s->name,
                                                 .kind = is_rms ? "rms" : "average",
                                                 .value = is_rms ? s->rms : s->average};
    }
    k -= PER_SIGNAL * report->steady.n_signals;
    const struct dalcs_fourier *f = report->fourier;
    for (; k >= results_of(f); f++) {
        k -= results_of(f);
    }
    return of_fourier(f, k);
}

/* measure.c - measures a piecewise linear waveform through the rows, exactly: between a and b over
 * dt the integral is dt (a + b) / 2 and that of the square dt (a^2 + a b + b^2) / 3. */
#include "measure.h"

#include "memory.h"

#include <math.h>
#include <stdlib.h>

/* Over the rms. Straight lines through the thousand rows of a period miss a sine by up to (2 pi/1000)^2/8, 5e-6 of
 * its amplitude, so a fifth of that is no average. The average of a pulse over its rms is the square root of its duty
 * cycle, so pulses keep theirs down to a duty cycle of 1e-12. */
#define CANCELLED_AVERAGE 1e-6

enum dalcs_status dalcs_measure_begin(struct dalcs_measure *measure,
                                      const struct dalcs_plot *plot) {
    dalcs_measure_finish(measure);
    measure->plot = plot;
    measure->signal = dalcs_alloc(plot->n_signals, sizeof *measure->signal);
    return measure->signal ? DALCS_OK : DALCS_E_NOMEM;
}

void dalcs_measure_row(struct dalcs_measure *measure, double time, const double *value) {
    struct dalcs_measure_signal *signal = measure->signal;
    bool first = measure->n_rows++ == 0;
    double dt = first ? 0.0 : time - measure->last_time;
    if (first) {
        measure->first_time = time;
    }
    measure->last_time = time;
    const bool is_complex = measure->plot->is_complex;
    for (size_t i = 0; i < measure->plot->n_signals; i++) {
        double v = is_complex ? hypot(value[2 * i], value[2 * i + 1]) : value[i];
        double before = signal[i].final;
        signal[i].final = v;
        if (first) {
            signal[i].min = signal[i].max = v;
            continue;
        }
        signal[i].min = v < signal[i].min ? v : signal[i].min;
        signal[i].max = v > signal[i].max ? v : signal[i].max;
        signal[i].integral += dt * (before + v) / 2.0;
        signal[i].square_integral += dt * (before * before + before * v + v * v) / 3.0;
    }
}

double dalcs_measure_average(const struct dalcs_measure *measure, size_t signal) {
    double duration = measure->last_time - measure->first_time;
    const struct dalcs_measure_signal *s = &measure->signal[signal];
    return duration > 0.0 ? s->integral / duration : s->final;
}

double dalcs_measure_shown_average(const struct dalcs_measure *measure, size_t signal) {
    const double average = dalcs_measure_average(measure, signal);
    return fabs(average) > CANCELLED_AVERAGE * dalcs_measure_rms(measure, signal) ? average : 0.0;
}

double dalcs_measure_rms(const struct dalcs_measure *measure, size_t signal) {
    double duration = measure->last_time - measure->first_time;
    const struct dalcs_measure_signal *s = &measure->signal[signal];
    return duration > 0.0 ? sqrt(s->square_integral / duration) : fabs(s->final);
}

void dalcs_measure_finish(struct dalcs_measure *measure) {
    free(measure->signal);
    *measure = (struct dalcs_measure){0};
}

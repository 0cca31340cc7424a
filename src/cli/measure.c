/* measure.c - measures a piecewise linear waveform through the rows, exactly: between a and b over
 * dt the integral is dt (a + b) / 2 and that of the square dt (a^2 + a b + b^2) / 3. */
#include "measure.h"

#include "memory.h"
#include "wide_vectors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Over the rms. Straight lines through the thousand rows of a period miss a sine by up to (2 pi/1000)^2/8, 5e-6 of
 * its amplitude, so a fifth of that is no average. The average of a pulse over its rms is the square root of its duty
 * cycle, so pulses keep theirs down to a duty cycle of 1e-12. */
#define CANCELLED_AVERAGE 1e-6

static size_t n_fours(const struct dalcs_plot *plot) {
    return (plot->n_signals + DALCS_QUAD - 1) / DALCS_QUAD;
}

enum dalcs_status dalcs_measure_begin(struct dalcs_measure *measure,
                                      const struct dalcs_plot *plot) {
    dalcs_measure_finish(measure);
    measure->plot = plot;
    measure->four = dalcs_alloc(n_fours(plot), sizeof *measure->four);
    measure->row = dalcs_alloc(n_fours(plot) * DALCS_QUAD, sizeof *measure->row);
    return measure->four != NULL && measure->row != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* The first row. */
static void begin(struct dalcs_measure_four *four, size_t n, const double *row) {
    for (size_t k = 0; k < n; k++) {
        const size_t bytes = DALCS_QUAD * sizeof *row;
        memcpy(four[k].min, row + k * DALCS_QUAD, bytes);
        memcpy(four[k].max, row + k * DALCS_QUAD, bytes);
        memcpy(four[k].final, row + k * DALCS_QUAD, bytes);
    }
}

/* One more, dt later: the same operations for each of the four. */
DALCS_TWICE(void, add, (struct dalcs_measure_four * four, size_t n, double dt, const double *row),
            (four, n, dt, row)) {
    for (size_t k = 0; k < n; k++) {
        dalcs_quad v;
        dalcs_quad before;
        dalcs_quad min;
        dalcs_quad max;
        dalcs_quad integral;
        dalcs_quad square;
        dalcs_quad_load(&v, row + k * DALCS_QUAD);
        dalcs_quad_load(&before, four[k].final);
        dalcs_quad_load(&min, four[k].min);
        dalcs_quad_load(&max, four[k].max);
        dalcs_quad_load(&integral, four[k].integral);
        dalcs_quad_load(&square, four[k].square_integral);
        dalcs_quad_lower(&min, &v);
        dalcs_quad_raise(&max, &v);
        integral += dt * (before + v) / 2.0;
        square += dt * (before * before + before * v + v * v) / 3.0;
        dalcs_quad_store(four[k].min, &min);
        dalcs_quad_store(four[k].max, &max);
        dalcs_quad_store(four[k].final, &v);
        dalcs_quad_store(four[k].integral, &integral);
        dalcs_quad_store(four[k].square_integral, &square);
    }
}

void dalcs_measure_row(struct dalcs_measure *measure, double time, const double *value) {
    const struct dalcs_plot *plot = measure->plot;
    const bool first = measure->n_rows++ == 0;
    const double dt = first ? 0.0 : time - measure->last_time;
    measure->first_time = first ? time : measure->first_time;
    measure->last_time = time;
    for (size_t i = 0; i < plot->n_signals && plot->is_complex; i++) {
        measure->row[i] = hypot(value[2 * i], value[2 * i + 1]);
    }
    if (!plot->is_complex) {
        memcpy(measure->row, value, plot->n_signals * sizeof *value);
    }
    if (first) {
        begin(measure->four, n_fours(plot), measure->row);
    } else {
        add(measure->four, n_fours(plot), dt, measure->row);
    }
}

struct dalcs_measure_signal dalcs_measure_of(const struct dalcs_measure *measure, size_t signal) {
    const struct dalcs_measure_four *four = &measure->four[signal / DALCS_QUAD];
    const size_t i = signal % DALCS_QUAD;
    return (struct dalcs_measure_signal){four->min[i], four->max[i], four->final[i],
                                         four->integral[i], four->square_integral[i]};
}

double dalcs_measure_average(const struct dalcs_measure *measure, size_t signal) {
    double duration = measure->last_time - measure->first_time;
    const struct dalcs_measure_signal s = dalcs_measure_of(measure, signal);
    return duration > 0.0 ? s.integral / duration : s.final;
}

double dalcs_measure_shown_average(const struct dalcs_measure *measure, size_t signal) {
    const double average = dalcs_measure_average(measure, signal);
    return fabs(average) > CANCELLED_AVERAGE * dalcs_measure_rms(measure, signal) ? average : 0.0;
}

double dalcs_measure_rms(const struct dalcs_measure *measure, size_t signal) {
    double duration = measure->last_time - measure->first_time;
    const struct dalcs_measure_signal s = dalcs_measure_of(measure, signal);
    return duration > 0.0 ? sqrt(s.square_integral / duration) : fabs(s.final);
}

void dalcs_measure_finish(struct dalcs_measure *measure) {
    free(measure->four);
    free(measure->row);
    *measure = (struct dalcs_measure){0};
}

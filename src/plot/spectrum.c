/* spectrum.c - Fourier integrals of straight lines, from row to row.
 *
 * With s the slope of a line from (t0, v0) to (t1, v1) and e(t) = exp(-i w t) its part of the integral is
 *
 *     (i / w) (v1 e(t1) - v0 e(t0)) + (s / w^2) (e(t1) - e(t0)).
 *
 * No row is moved to a grid, so edges of nanoseconds are where they are: an FFT would see them elsewhere. */
#include "spectrum.h"
#include "pi.h"

#include "memory.h"
#include "quantity.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_LINES = 20000, ROWS_OF_A_NEEDLE = 3 };

struct work {
    size_t n, n_lines; /* signals; frequencies besides 0 */
    double start, length;
    bool is_begun;
    double at;
    double *value; /* [n] of the row before */
    double *mean;  /* [n] integrals */
    double complex *turn,
        *last_turn;      /* [n_lines + 1] e of each frequency at this row and the one before */
    double complex *sum; /* [n * n_lines] integrals */
};

static void turn_to(struct work *w, double at) {
    const double part = (at - w->start) / w->length;
    const double complex one = cos(dalcs_two_pi * part) - I * sin(dalcs_two_pi * part);
    w->turn[0] = 1.0;
    for (size_t k = 1; k <= w->n_lines; k++) {
        w->turn[k] = w->turn[k - 1] * one;
    }
}

static void add_line(struct work *w, size_t signal, double span, double before, double after) {
    const double slope = (after - before) / span;
    const double omega = dalcs_two_pi / w->length;
    double complex *sum = w->sum + signal * w->n_lines;
    w->mean[signal] += 0.5 * span * (before + after);
    for (size_t k = 1; k <= w->n_lines; k++) {
        const double o = omega * (double)k;
        sum[k - 1] += I / o * (after * w->turn[k] - before * w->last_turn[k]) +
                      slope / (o * o) * (w->turn[k] - w->last_turn[k]);
    }
}

static enum dalcs_status add_row(void *user, double at, const double *value) {
    struct work *w = user;
    const double span = at - w->at;
    if (!w->is_begun || span > 0.0) {
        double complex *kept = w->last_turn;
        w->last_turn = w->turn;
        w->turn = kept;
        turn_to(w, at);
    }
    for (size_t i = 0; i < w->n; i++) {
        if (w->is_begun && span > 0.0) {
            add_line(w, i, span, w->value[i], value[i]);
        }
        w->value[i] = value[i];
    }
    w->is_begun = true;
    w->at = at;
    return DALCS_OK;
}

/* ---- The table ------------------------------------------------------------------------------- */

static void put_row(struct dalcs_waveforms *spectrum, double frequency) {
    double *row = spectrum->value + spectrum->n_rows * spectrum->n_columns;
    memset(row, 0, spectrum->n_columns * sizeof *row);
    row[0] = frequency;
    spectrum->n_rows++;
}

static void put_needles(struct dalcs_waveforms *spectrum, const struct work *w) {
    static const double half_width = 0.02; /* of the distance of two */
    for (size_t k = 0; k <= w->n_lines; k++) {
        const double middle = (double)k / w->length;
        if (k > 0) {
            put_row(spectrum, middle - half_width / w->length);
        }
        put_row(spectrum, middle);
        double *row = spectrum->value + (spectrum->n_rows - 1) * spectrum->n_columns;
        for (size_t i = 0; i < w->n; i++) {
            row[i + 1] = k == 0 ? fabs(w->mean[i]) / w->length
                                : 2.0 * cabs(w->sum[i * w->n_lines + k - 1]) / w->length;
        }
        put_row(spectrum, middle + half_width / w->length);
    }
}

static enum dalcs_status make_table(struct dalcs_waveforms *spectrum,
                                    const struct dalcs_selection *selection, const struct work *w) {
    *spectrum = (struct dalcs_waveforms){
        .title = selection->waveforms->title, .plot_name = "Spectrum", .n_plots = 1, .plot = 1};
    DALCS_TRY(dalcs_waveforms_set_columns(spectrum, w->n + 1));
    spectrum->name[0] = "frequency";
    spectrum->dimension[0] = (struct dalcs_dimension){.second = -1};
    for (size_t i = 0; i < w->n; i++) {
        const char *name = selection->name[i];
        spectrum->name[i + 1] = dalcs_arena_copy(&spectrum->arena, name, strlen(name));
        if (spectrum->name[i + 1] == NULL) {
            return DALCS_E_NOMEM;
        }
        spectrum->dimension[i + 1] = selection->signal[i].dimension;
    }
    spectrum->value = dalcs_alloc((w->n_lines + 1) * ROWS_OF_A_NEEDLE * spectrum->n_columns,
                                  sizeof *spectrum->value);
    if (spectrum->value == NULL) {
        return DALCS_E_NOMEM;
    }
    put_needles(spectrum, w);
    return DALCS_OK;
}

static enum dalcs_status count_lines(const struct dalcs_selection *selection, double highest,
                                     size_t *n, struct dalcs_diag *diag) {
    char text[DALCS_QUANTITY_SIZE];
    const double length = selection->stop - selection->start;
    const double count = floor(highest * length * (1.0 + 1e-9));
    if (selection->waveforms->dimension[0].second != 1) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "a spectrum is one of waveforms over time");
        return DALCS_E_OPTION;
    }
    if (!(count >= 1.0)) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, "write a higher frequency, or take a longer range",
                       "the lowest frequency of this range is %s",
                       dalcs_quantity_write(text, 1.0 / length, "Hz", 4));
        return DALCS_E_OPTION;
    }
    if (count > MOST_LINES) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, "take a shorter range with --from and --to",
                       "these are more than %d frequencies, %s apart", (int)MOST_LINES,
                       dalcs_quantity_write(text, 1.0 / length, "Hz", 4));
        return DALCS_E_OPTION;
    }
    *n = (size_t)count;
    return DALCS_OK;
}

enum dalcs_status dalcs_spectrum_make(struct dalcs_waveforms *spectrum,
                                      const struct dalcs_selection *selection, double highest,
                                      struct dalcs_diag *diag) {
    struct work w = {
        .n = selection->n, .start = selection->start, .length = selection->stop - selection->start};
    DALCS_TRY(count_lines(selection, highest, &w.n_lines, diag));
    w.value = dalcs_alloc(w.n, sizeof *w.value);
    w.mean = dalcs_alloc(w.n, sizeof *w.mean);
    w.turn = dalcs_alloc(w.n_lines + 1, sizeof *w.turn);
    w.last_turn = dalcs_alloc(w.n_lines + 1, sizeof *w.last_turn);
    w.sum = dalcs_alloc(w.n * w.n_lines, sizeof *w.sum);
    const bool complete =
        w.value != NULL && w.mean != NULL && w.turn != NULL && w.last_turn != NULL && w.sum != NULL;
    enum dalcs_status status =
        complete ? dalcs_selection_each_row(selection, add_row, &w) : DALCS_E_NOMEM;
    if (status == DALCS_OK) {
        status = make_table(spectrum, selection, &w);
        if (status != DALCS_OK) {
            dalcs_waveforms_finish(spectrum);
        }
    }
    free(w.value);
    free(w.mean);
    free(w.turn);
    free(w.last_turn);
    free(w.sum);
    return status;
}

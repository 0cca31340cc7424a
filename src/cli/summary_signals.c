/* summary_signals.c - a table of signals: least, most, mean, final. */
#include "summary.h"

#include "figure.h"
#include "quantity.h"

#include <math.h>
#include <string.h>

/* Of waveforms what no part of a circuit is held to, over the largest value of a signal (doc/methods.md, "What the
 * tolerance means"). */
#define INVISIBLE_IN_WAVEFORMS 1e-9

enum { MAX_SIGNALS = 24, DIGITS = 4 };

static const char *unit_name(enum dalcs_unit unit) {
    static const char *const name[] = {
        [DALCS_VOLT] = "V",        [DALCS_AMPERE] = "A",     [DALCS_UNIT_SECOND] = "s",
        [DALCS_UNIT_HERTZ] = "Hz", [DALCS_UNIT_OHM] = "ohm", [DALCS_UNIT_NONE] = ""};
    return name[unit];
}

static bool has_averages(const struct dalcs_plot *plot) {
    return plot->analysis == DALCS_TRANSIENT || plot->analysis == DALCS_PERIODIC;
}

static double largest_of(const struct dalcs_measure *measure, size_t i) {
    const struct dalcs_measure_signal signal = dalcs_measure_of(measure, i);
    return fmax(fabs(signal.min), fabs(signal.max));
}

static void write_value(FILE *out, const struct dalcs_measure *measure, size_t i, double value) {
    char text[DALCS_QUANTITY_SIZE];
    const enum dalcs_unit of = measure->plot->unit[i];
    const char *unit = unit_name(of);
    if (has_averages(measure->plot) && (of == DALCS_VOLT || of == DALCS_AMPERE) &&
        largest_of(measure, i) < DALCS_FIGURE_NOTHING) {
        value = 0.0;
    }
    fprintf(out, " %11s", dalcs_quantity_write_column(text, value, unit, DIGITS));
}

/* A value of signal i; what is round-off beside its largest one is shown as 0. */
static void write_cell(FILE *out, const struct dalcs_measure *measure, size_t i, double value) {
    const double invisible =
        has_averages(measure->plot) ? INVISIBLE_IN_WAVEFORMS : DALCS_SUMMARY_INVISIBLE;
    const double largest = largest_of(measure, i);
    const bool is_rounding = isfinite(value) && fabs(value) <= invisible * largest;
    write_value(out, measure, i, is_rounding && isfinite(largest) ? 0.0 : value);
}

static void write_head(FILE *out, const struct dalcs_plot *plot, int width, bool ends) {
    static const char *const head[] = {
        [DALCS_OPERATING_POINT] = "         op",
        [DALCS_TRANSIENT] = "        min         max     average         rms       final",
        [DALCS_PERIODIC] = "        min         max     average         rms       final",
        [DALCS_DC_SWEEP] = "        min         max       final",
        [DALCS_AC] = "      |min|       |max|     |final|",
        [DALCS_TRANSFER] = "         tf"};
    if (plot->analysis == DALCS_DC_SWEEP || plot->analysis == DALCS_AC) {
        fprintf(out, "\n  %s over %s", plot->analysis == DALCS_AC ? ".ac" : ".dc", plot->scale);
    }
    if (plot->analysis == DALCS_PERIODIC) {
        fputs("\n  one period", out);
    }
    fprintf(out, "\n  %-*s %s\n", width, "signal", ends ? "      final" : head[plot->analysis]);
}

/* The signal in the report of an orbit, whose means are exact and count impulses; NULL: there is none. */
static const struct dalcs_steady_signal *find_exact(const struct dalcs_measure *measure, size_t i,
                                                    const struct dalcs_report *report) {
    const struct dalcs_plot *plot = measure->plot;
    for (size_t k = 0; plot->analysis == DALCS_PERIODIC && k < report->steady.n_signals; k++) {
        if (strcmp(report->steady.signal[k].name, plot->name[i]) == 0) {
            return &report->steady.signal[k];
        }
    }
    return NULL;
}

static void write_means(FILE *out, const struct dalcs_measure *measure, size_t i,
                        const struct dalcs_report *report) {
    const struct dalcs_steady_signal *exact = find_exact(measure, i, report);
    if (exact == NULL || !isnan(exact->rms)) {
        write_value(out, measure, i, dalcs_measure_shown_average(measure, i));
        write_value(out, measure, i, dalcs_measure_rms(measure, i));
        return;
    }
    char text[DALCS_QUANTITY_SIZE];
    const char *unit = unit_name(measure->plot->unit[i]);
    const bool is_rounding =
        fabs(exact->average) <= INVISIBLE_IN_WAVEFORMS * largest_of(measure, i);
    const double average = is_rounding ? 0.0 : exact->average;
    fprintf(out, " %11s    none    ",
            isnan(average) ? "none    " : dalcs_quantity_write_column(text, average, unit, DIGITS));
}

/* Rows have no impulses. */
static void write_remark(FILE *out, const struct dalcs_measure *measure,
                         const struct dalcs_report *report) {
    size_t n = 0;
    for (size_t k = 0; k < report->n_jumps; k++) {
        n += report->jump[k].n_impulses;
    }
    if (measure->plot->analysis == DALCS_TRANSIENT && n > 0) {
        fputs("  averages and rms values of rows are without impulses, .losses and .meas count "
              "them\n",
              out);
    }
}

static void write_cells(FILE *out, const struct dalcs_measure *measure, size_t i,
                        const struct dalcs_report *report, bool ends) {
    const struct dalcs_measure_signal signal = dalcs_measure_of(measure, i);
    if (!dalcs_analysis_is_point(measure->plot->analysis) && !ends) {
        write_cell(out, measure, i, signal.min);
        write_cell(out, measure, i, signal.max);
    }
    if (has_averages(measure->plot) && !ends) {
        write_means(out, measure, i, report);
    }
    write_cell(out, measure, i, signal.final);
}

void dalcs_summary_write_sides(FILE *out, const struct dalcs_report *report) {
    if (report->n_sides == 0) {
        return;
    }
    fputs("  frozen    ", out);
    for (size_t i = 0; i < report->n_sides && i < MAX_SIGNALS; i++) {
        fprintf(out, "%s%s %s%s", i > 0 ? ", " : "", report->side[i].element,
                report->side[i].on ? "on" : "off",
                report->side[i].degenerate ? " (or the other way)" : "");
    }
    fputs(report->n_sides > MAX_SIGNALS ? ", ...\n" : "\n", out);
}

static void write_signals(FILE *out, const struct dalcs_measure *measure,
                          const struct dalcs_report *report, bool all, bool ends) {
    const struct dalcs_plot *plot = measure->plot;
    if (!plot || measure->n_rows == 0 || plot->n_signals == 0) {
        return;
    }
    size_t n = all || plot->n_signals <= MAX_SIGNALS ? plot->n_signals : MAX_SIGNALS;
    int width = 9;
    for (size_t i = 0; i < n; i++) {
        int length = (int)strlen(plot->name[i]);
        width = length > width ? length : width;
    }
    write_head(out, plot, width, ends);
    for (size_t i = 0; i < n; i++) {
        fprintf(out, "  %-*s", width, plot->name[i]);
        write_cells(out, measure, i, report, ends);
        fputc('\n', out);
    }
    if (n < plot->n_signals) {
        fprintf(out, "  ... and %zu more: --all-signals\n", plot->n_signals - n);
    }
    if (!ends) {
        write_remark(out, measure, report);
    }
}

void dalcs_summary_write_signals(FILE *out, const struct dalcs_measure *measure,
                                 const struct dalcs_report *report, bool all) {
    write_signals(out, measure, report, all, false);
}

void dalcs_summary_write_ends(FILE *out, const struct dalcs_measure *measure, bool all) {
    write_signals(out, measure, NULL, all, true);
}

/* step_lines.c - the steps of .step as a table. */
#include "step_lines.h"

#include "memory.h"
#include "quantity.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_LINES = 200, DIGITS = 4, LEAST_WIDTH = 11 };

static size_t least(size_t a, size_t b) {
    return a < b ? a : b;
}

enum dalcs_status dalcs_step_lines_add(struct dalcs_step_lines *lines,
                                       const struct dalcs_measure *measure) {
    const struct dalcs_plot *plot = measure->plot;
    if (plot->n_steps <= 1) {
        return DALCS_OK;
    }
    enum dalcs_status status =
        dalcs_grow(&lines->line, &lines->capacity, lines->n + 1, sizeof *lines->line);
    if (status != DALCS_OK) {
        return status;
    }
    struct dalcs_step_line *line = &lines->line[lines->n++];
    line->analysis = plot->analysis;
    line->step = plot->step;
    lines->plot[plot->analysis] = plot;
    for (size_t i = 0; i < least(plot->n_parameters, DALCS_STEP_PARAMETERS); i++) {
        line->parameter[i] = plot->parameter_value[i];
    }
    for (size_t i = 0; i < least(plot->n_signals, DALCS_STEP_SIGNALS); i++) {
        const bool is_wave = plot->analysis == DALCS_TRANSIENT || plot->analysis == DALCS_PERIODIC;
        line->value[i] = is_wave                      ? dalcs_measure_shown_average(measure, i)
                         : plot->analysis == DALCS_AC ? dalcs_measure_of(measure, i).max
                                                      : dalcs_measure_of(measure, i).final;
    }
    return DALCS_OK;
}

static int width_of(const char *name) {
    const int length = (int)strlen(name);
    return length > LEAST_WIDTH ? length : LEAST_WIDTH;
}

static void write_line(FILE *out, const struct dalcs_plot *plot,
                       const struct dalcs_step_line *line) {
    char text[DALCS_QUANTITY_SIZE];
    fputc(' ', out);
    for (size_t i = 0; i < least(plot->n_parameters, DALCS_STEP_PARAMETERS); i++) {
        fprintf(out, " %*.6g", width_of(plot->parameter[i]), line->parameter[i]);
    }
    for (size_t i = 0; i < least(plot->n_signals, DALCS_STEP_SIGNALS); i++) {
        const char *unit = plot->unit[i] == DALCS_AMPERE     ? "A"
                           : plot->unit[i] == DALCS_VOLT     ? "V"
                           : plot->unit[i] == DALCS_UNIT_OHM ? "ohm"
                                                             : "";
        fprintf(out, " %*s", width_of(plot->name[i]),
                dalcs_quantity_write_column(text, line->value[i], unit, DIGITS));
    }
    fputc('\n', out);
}

static const struct dalcs_failed_step *find_failed(const struct dalcs_report *report, size_t step) {
    const struct dalcs_failed_step *found = NULL;
    for (size_t k = 0; k < report->n_failed_steps && found == NULL; k++) {
        found = report->failed_step[k].step == step ? &report->failed_step[k] : NULL;
    }
    return found;
}

static const struct dalcs_step_line *find_line(const struct dalcs_step_lines *lines,
                                               enum dalcs_analysis analysis, size_t step) {
    const struct dalcs_step_line *found = NULL;
    for (size_t k = 0; k < lines->n && found == NULL; k++) {
        const struct dalcs_step_line *line = &lines->line[k];
        found = line->analysis == analysis && line->step == step ? line : NULL;
    }
    return found;
}

void dalcs_step_lines_write(FILE *out, const struct dalcs_step_lines *lines,
                            const struct dalcs_report *report, enum dalcs_analysis analysis) {
    static const char *const what[] = {
        [DALCS_OPERATING_POINT] = "operating point", [DALCS_TRANSIENT] = "average over .tran",
        [DALCS_PERIODIC] = "average over a period",  [DALCS_DC_SWEEP] = "last value of .dc",
        [DALCS_AC] = "largest magnitude of .ac",     [DALCS_TRANSFER] = ".tf"};
    const struct dalcs_plot *plot = lines->plot[analysis];
    size_t n_written = 0;
    if (!plot) {
        return;
    }
    fprintf(out, "\n  %zu steps: %s\n ", plot->n_steps, what[analysis]);
    for (size_t i = 0; i < least(plot->n_parameters, DALCS_STEP_PARAMETERS); i++) {
        fprintf(out, " %*s", width_of(plot->parameter[i]), plot->parameter[i]);
    }
    for (size_t i = 0; i < least(plot->n_signals, DALCS_STEP_SIGNALS); i++) {
        fprintf(out, " %*s", width_of(plot->name[i]), plot->name[i]);
    }
    fputc('\n', out);
    for (size_t k = 0; k < plot->n_steps && n_written < MOST_LINES; k++) {
        const struct dalcs_step_line *line = find_line(lines, analysis, k);
        const struct dalcs_failed_step *failed = find_failed(report, k);
        if (failed != NULL) {
            fprintf(out, "  %s: failed, %s\n", failed->values, failed->because);
        } else if (line != NULL) {
            write_line(out, plot, line);
        }
        n_written += failed != NULL || line != NULL ? 1 : 0;
    }
    if (n_written == MOST_LINES && plot->n_steps > MOST_LINES) {
        fprintf(out, "  ... and %zu more\n", plot->n_steps - MOST_LINES);
    }
}

void dalcs_step_lines_finish(struct dalcs_step_lines *lines) {
    free(lines->line);
    *lines = (struct dalcs_step_lines){0};
}

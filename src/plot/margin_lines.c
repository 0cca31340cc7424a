/* margin_lines.c - levels of 0 dB and -180 deg, and a line with its margin at each crossing. */
#include "margin_lines.h"

#include "quantity.h"

#include <string.h>

enum { GAIN, PHASE, DIGITS = 4 };

static void add(struct dalcs_margin_lines *lines, struct dalcs_figure_line line) {
    if (lines->n < DALCS_MOST_MARGIN_LINES) {
        lines->line[lines->n++] = line;
    }
}

enum dalcs_status dalcs_margin_lines_begin(struct dalcs_margin_lines *lines, const char *loop) {
    lines->loop = dalcs_arena_copy(&lines->arena, loop, strlen(loop));
    add(lines, (struct dalcs_figure_line){.panel = GAIN, .is_level = true, .at = 0.0});
    add(lines, (struct dalcs_figure_line){.panel = PHASE, .is_level = true, .at = -180.0});
    return lines->loop ? DALCS_OK : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_margin_lines_add(struct dalcs_margin_lines *lines, bool of_phase,
                                         double frequency, double margin) {
    char at[DALCS_QUANTITY_SIZE];
    dalcs_quantity_write(at, frequency, "Hz", DIGITS);
    const char *text = dalcs_arena_printf(&lines->arena, "%.3g %s at %s", margin,
                                          of_phase ? "\302\260" : "dB", at);
    add(lines, (struct dalcs_figure_line){
                   .panel = of_phase ? PHASE : GAIN, .at = frequency, .text = text});
    return text ? DALCS_OK : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_margin_lines_add_report(struct dalcs_margin_lines *lines,
                                                const struct dalcs_report *report) {
    if (!report->response.loop) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_margin_lines_begin(lines, report->response.loop));
    for (size_t k = 0; k < report->response.n_crossovers; k++) {
        const struct dalcs_margin *m = &report->response.crossover[k];
        DALCS_TRY(dalcs_margin_lines_add(lines, true, m->frequency, m->margin));
    }
    for (size_t k = 0; k < report->response.n_reversals; k++) {
        const struct dalcs_margin *m = &report->response.reversal[k];
        DALCS_TRY(dalcs_margin_lines_add(lines, false, m->frequency, m->margin));
    }
    return DALCS_OK;
}

void dalcs_margin_lines_finish(struct dalcs_margin_lines *lines) {
    dalcs_arena_finish(&lines->arena);
    *lines = (struct dalcs_margin_lines){0};
}

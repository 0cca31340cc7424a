/* outputs.c - hands each row to all outputs; ends their files well or as partial ones. */
#include "outputs.h"

#include "memory.h"
#include "report.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static enum dalcs_status init_tables(struct dalcs_outputs *outputs,
                                     const struct dalcs_arguments *arguments, bool ascii,
                                     enum dalcs_analysis main) {
    outputs->table = dalcs_alloc(arguments->files.n_outputs, sizeof *outputs->table);
    if (!outputs->table) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < arguments->files.n_outputs; i++) {
        struct dalcs_table *table = &outputs->table[outputs->n_tables++];
        const char *path = arguments->files.output[i];
        const struct dalcs_table_format *format =
            arguments->batch.is_asked ? &dalcs_raw_format : dalcs_table_find_format(path);
        if (format == &dalcs_raw_format && (arguments->files.ascii || ascii)) {
            format = &dalcs_raw_ascii_format;
        }
        enum dalcs_status status = dalcs_table_init_as(table, path, format, main);
        table->splits_steps = arguments->files.split_steps;
        if (status != DALCS_OK) {
            return status;
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_outputs_init(struct dalcs_outputs *outputs,
                                     const struct dalcs_arguments *arguments, bool ascii,
                                     enum dalcs_analysis main, double start, double stop) {
    *outputs = (struct dalcs_outputs){.report_path = arguments->files.report,
                                      .has_summary = !arguments->quiet,
                                      .is_audited = arguments->audit != DALCS_AUDIT_OFF,
                                      .audit.is_full = arguments->audit == DALCS_AUDIT_FULL};
    enum dalcs_status status = init_tables(outputs, arguments, ascii, main);
    if (status != DALCS_OK) {
        dalcs_outputs_finish(outputs);
        return status;
    }
    if (arguments->files.plot && main == DALCS_TRANSIENT && stop > start &&
        !arguments->envelope.is_asked) {
        outputs->figure = dalcs_alloc(1, sizeof *outputs->figure);
        if (!outputs->figure) {
            dalcs_outputs_finish(outputs);
            return DALCS_E_NOMEM;
        }
        dalcs_figure_init(outputs->figure, arguments->files.plot, start, stop);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_outputs_begin(struct dalcs_outputs *outputs,
                                      const struct dalcs_plot *plot) {
    outputs->analysis = plot->analysis;
    for (size_t i = 0; i < outputs->n_tables; i++) {
        enum dalcs_status status = dalcs_table_begin(&outputs->table[i], plot);
        if (status != DALCS_OK) {
            return status;
        }
    }
    if (outputs->figure && plot->analysis == DALCS_TRANSIENT && !outputs->drawn) {
        enum dalcs_status status = dalcs_figure_begin(outputs->figure, plot);
        outputs->drawn = plot;
        if (status != DALCS_OK) {
            return status;
        }
    }
    if (outputs->report_path && !outputs->report.stream) {
        enum dalcs_status status = dalcs_atomic_file_open(&outputs->report, outputs->report_path);
        if (status != DALCS_OK) {
            return status;
        }
    }
    outputs->n_plots++;
    if (outputs->is_audited) {
        DALCS_TRY(dalcs_table_audit_begin(&outputs->audit, plot));
    }
    return dalcs_measure_begin(&outputs->measure[plot->analysis], plot);
}

enum dalcs_status dalcs_outputs_rows(struct dalcs_outputs *outputs, size_t n, const double *time,
                                     const double *value) {
    struct dalcs_measure *measure = &outputs->measure[outputs->analysis];
    const size_t n_values = (measure->plot->is_complex ? 2 : 1) * measure->plot->n_signals;
    const bool is_drawn = outputs->drawn && outputs->drawn == measure->plot;
    outputs->n_rows += n;
    const bool is_due = outputs->is_audited && dalcs_table_audit_is_due(&outputs->audit, n);
    const bool is_audited = is_due && outputs->has_summary;
    if (is_audited) {
        dalcs_table_audit_before(&outputs->audit, measure);
    }
    for (size_t k = 0; k < n && outputs->has_summary; k++) {
        dalcs_measure_row(measure, time[k], value + k * n_values);
    }
    if (is_due) {
        dalcs_table_audit_after(&outputs->audit, is_audited ? measure : NULL, n, time, value);
    }
    for (size_t k = 0; k < n && is_drawn; k++) {
        dalcs_figure_row(outputs->figure, time[k], value + k * n_values);
    }
    for (size_t i = 0; i < outputs->n_tables; i++) {
        DALCS_TRY(dalcs_table_rows(&outputs->table[i], n, time, value));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_outputs_end(struct dalcs_outputs *outputs) {
    const enum dalcs_status lines =
        dalcs_step_lines_add(&outputs->steps, &outputs->measure[outputs->analysis]);
    if (lines != DALCS_OK) {
        return lines;
    }
    for (size_t i = 0; i < outputs->n_tables; i++) {
        enum dalcs_status status = dalcs_table_end(&outputs->table[i]);
        if (status != DALCS_OK) {
            return status;
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_outputs_audit(const struct dalcs_outputs *outputs,
                                      const struct dalcs_cli *cli) {
    return outputs->is_audited && outputs->has_summary
               ? dalcs_table_audit_summary(&outputs->audit, &outputs->measure[outputs->analysis],
                                           cli)
               : DALCS_OK;
}

/* One line about one file; returns `status` or what was wrong before the run stopped. */
static enum dalcs_status tell(const struct dalcs_cli *cli, FILE *out, const char *path, int error,
                              enum dalcs_status status, bool complete, const char *left_at) {
    if (error != 0) {
        dalcs_cli_error(cli, "cannot write '%s': %s", path, strerror(error));
        status = DALCS_E_IO;
    }
    if (left_at && strcmp(path, "-") != 0) {
        fprintf(cli->err, "dalcs: what was computed is in '%s'", left_at);
        fprintf(cli->err, access(path, F_OK) == 0 ? "; '%s' is of an earlier run\n" : "\n", path);
    } else if (complete && status == DALCS_OK && out) {
        fprintf(out, "  wrote     %s\n", path);
    }
    return status;
}

static enum dalcs_status close_table(struct dalcs_table *table, const struct dalcs_cli *cli,
                                     FILE *out, bool complete) {
    char *left_at = NULL;
    bool written = table->file.stream != NULL;
    complete =
        complete && dalcs_table_end(table) == DALCS_OK && dalcs_table_flush(table) == DALCS_OK;
    enum dalcs_status status =
        complete ? dalcs_table_commit(table) : dalcs_table_keep(table, &left_at);
    status = tell(cli, out, table->path, table->file.error, status, complete && written, left_at);
    free(left_at);
    return status;
}

static enum dalcs_status close_figure(struct dalcs_figure *figure, const struct dalcs_cli *cli,
                                      FILE *out, const struct dalcs_report *report, bool complete) {
    char *left_at = NULL;
    bool written = figure->file.stream != NULL;
    enum dalcs_status status = figure->file.error != 0
                                   ? DALCS_E_IO
                                   : dalcs_figure_draw(figure, report, complete ? NULL : &left_at);
    if (figure->message[0]) {
        dalcs_cli_error(cli, "cannot draw '%s': %s", figure->path, figure->message);
        return DALCS_E_IO;
    }
    status = tell(cli, out, figure->path, figure->file.error, status, complete && written, left_at);
    free(left_at);
    return status;
}

/* A failed run has a report as well: that is where one looks for the reason. */
static enum dalcs_status close_report(struct dalcs_outputs *outputs, const struct dalcs_cli *cli,
                                      FILE *out, const struct dalcs_report *report,
                                      enum dalcs_status run) {
    struct dalcs_atomic_file *file = &outputs->report;
    enum dalcs_status status = DALCS_OK;
    if (!report) {
        dalcs_atomic_file_discard(file);
    } else if (file->error == 0) {
        if (!file->stream) {
            status = dalcs_atomic_file_open(file, outputs->report_path);
        }
        if (status == DALCS_OK) {
            dalcs_report_write(file->stream, report, run);
            status = dalcs_atomic_file_commit(file);
        }
    }
    return tell(cli, out, outputs->report_path, file->error, status, report != NULL, NULL);
}

enum dalcs_status dalcs_outputs_close(struct dalcs_outputs *outputs, const struct dalcs_cli *cli,
                                      FILE *out, const struct dalcs_report *report,
                                      enum dalcs_status run, bool complete) {
    enum dalcs_status worst = DALCS_OK;
    for (size_t i = 0; i < outputs->n_tables; i++) {
        if (outputs->table[i].n_left_out > 0) {
            fprintf(cli->err,
                    "dalcs: warning: '%s' has room for one result: %zu more left out; a .raw file "
                    "holds all\n",
                    outputs->table[i].path, outputs->table[i].n_left_out);
        }
        const struct dalcs_table_format *format = outputs->table[i].format;
        enum dalcs_status status = close_table(&outputs->table[i], cli, out, complete);
        if (status == DALCS_OK && complete && outputs->is_audited && outputs->n_plots == 1) {
            status = dalcs_table_audit_file(&outputs->audit, format, outputs->table[i].path, cli);
        }
        worst = status != DALCS_OK ? status : worst;
    }
    if (outputs->figure) {
        enum dalcs_status status = close_figure(outputs->figure, cli, out, report, complete);
        worst = status != DALCS_OK ? status : worst;
    }
    if (outputs->report_path) {
        enum dalcs_status status = close_report(outputs, cli, out, report, run);
        worst = status != DALCS_OK ? status : worst;
    }
    return worst;
}

void dalcs_outputs_finish(struct dalcs_outputs *outputs) {
    for (size_t i = 0; i < outputs->n_tables; i++) {
        dalcs_table_finish(&outputs->table[i]);
    }
    free(outputs->table);
    if (outputs->figure) {
        dalcs_figure_finish(outputs->figure);
    }
    free(outputs->figure);
    dalcs_atomic_file_discard(&outputs->report);
    for (size_t i = 0; i < DALCS_N_ANALYSES; i++) {
        dalcs_measure_finish(&outputs->measure[i]);
    }
    dalcs_step_lines_finish(&outputs->steps);
    dalcs_table_audit_finish(&outputs->audit);
    *outputs = (struct dalcs_outputs){0};
}

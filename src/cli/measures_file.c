/* measures_file.c - of the list that a report has, all steps of an analysis before the next, to rows. */
#include "measures_file.h"

#include "csv_cells.h"
#include "memory.h"
#include "settings.h"
#include "worst_case_lines.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static enum dalcs_status tell_failure(const struct dalcs_measures_file *m,
                                      const struct dalcs_cli *cli) {
    dalcs_cli_error(cli, "cannot write '%s': %s", m->path, strerror(m->file.error));
    return DALCS_E_IO;
}

enum dalcs_status dalcs_measures_file_open(struct dalcs_measures_file *m,
                                           const struct dalcs_cli *cli, const char *path) {
    *m = (struct dalcs_measures_file){.path = path, .n_steps = 1};
    if (path == NULL || dalcs_atomic_file_open(&m->file, path) == DALCS_OK) {
        return DALCS_OK;
    }
    return tell_failure(m, cli);
}

/* What steps are, also those that cannot be built; of these nothing is drawn. */
static void start_values(struct dalcs_measures_file *m, const struct dalcs_session *session) {
    const size_t n_values = m->n_parameters + m->n_drawn;
    for (size_t step = 0; m->value != NULL && step < m->n_steps; step++) {
        double *value = m->value + step * n_values;
        for (size_t k = 0; k < m->n_parameters; k++) {
            (void)dalcs_session_step_parameter(session, step, k, &value[k]);
        }
        for (size_t k = m->n_parameters; k < n_values; k++) {
            value[k] = NAN;
        }
    }
}

enum dalcs_status dalcs_measures_file_plot(struct dalcs_measures_file *m,
                                           const struct dalcs_session *session,
                                           const struct dalcs_plot *plot) {
    double drawn;
    if (m->path == NULL || plot->n_parameters == 0) {
        return DALCS_OK;
    }
    if (m->value == NULL) {
        m->n_steps = plot->n_steps;
        m->n_parameters = plot->n_parameters;
        while (dalcs_session_drawn(session, m->n_drawn, &drawn) != NULL) {
            m->n_drawn++;
        }
        const size_t n = m->n_parameters + m->n_drawn;
        m->name = dalcs_alloc(n, sizeof *m->name);
        m->value = dalcs_alloc(plot->n_steps * n, sizeof *m->value);
        start_values(m, session);
    }
    if (m->value == NULL || m->name == NULL) {
        return DALCS_E_NOMEM;
    }
    double *value = m->value + plot->step * (m->n_parameters + m->n_drawn);
    for (size_t k = 0; k < m->n_parameters; k++) {
        m->name[k] = plot->parameter[k];
        value[k] = plot->parameter_value[k];
    }
    for (size_t k = 0; k < m->n_drawn; k++) {
        m->name[m->n_parameters + k] = dalcs_session_drawn(session, k, &value[m->n_parameters + k]);
    }
    return DALCS_OK;
}

/* ---- Writing --------------------------------------------------------------------------------- */

/* Counts the measurements from `at` on that belong to one step of one analysis and share its text. */
static size_t block_at(const struct dalcs_report *report, size_t at) {
    size_t n = 1;
    while (at + n < report->n_measurements &&
           report->measurement[at + n].step == report->measurement[at].step) {
        n++;
    }
    return n;
}

/* Why a step failed; "" where it went well. */
static const char *error_of(const struct dalcs_report *report, size_t step) {
    const char *error = "";
    for (size_t k = 0; k < report->n_failed_steps; k++) {
        error = report->failed_step[k].step == step ? report->failed_step[k].because : error;
    }
    return error;
}

/* The last column of a table with several rows. */
static void end_row(struct dalcs_csv_cells *c, const struct dalcs_measures_file *m,
                    const char *error) {
    if (m->n_parameters > 0) {
        dalcs_csv_text(c, error, strlen(error));
    }
    dalcs_csv_end(c);
}

static void write_names(struct dalcs_csv_cells *c, const struct dalcs_arguments *arguments) {
    for (size_t k = 0; k < arguments->n_set; k++) {
        size_t length;
        dalcs_settings_value(arguments->set[k], &length);
        dalcs_csv_text(c, arguments->set[k], length);
    }
}

static void write_settings(struct dalcs_csv_cells *c, const struct dalcs_arguments *arguments) {
    for (size_t k = 0; k < arguments->n_set; k++) {
        size_t length;
        dalcs_csv_number(c, dalcs_settings_value(arguments->set[k], &length));
    }
}

static void write_header(struct dalcs_csv_cells *c, const struct dalcs_measures_file *m,
                         const struct dalcs_arguments *arguments,
                         const struct dalcs_report *report) {
    write_names(c, arguments);
    for (size_t k = 0; k < m->n_parameters + m->n_drawn; k++) {
        dalcs_csv_text(c, m->name[k], strlen(m->name[k]));
    }
    for (size_t at = 0; at < report->n_measurements;) {
        const size_t n = block_at(report, at);
        for (size_t k = at; k < at + n; k++) {
            dalcs_csv_text(c, report->measurement[k].name, strlen(report->measurement[k].name));
        }
        at += n * m->n_steps;
    }
    end_row(c, m, "error");
}

static void write_step(struct dalcs_csv_cells *c, const struct dalcs_measures_file *m,
                       const struct dalcs_arguments *arguments, const struct dalcs_report *report,
                       size_t step) {
    write_settings(c, arguments);
    const size_t n_values = m->n_parameters + m->n_drawn;
    for (size_t k = 0; k < n_values; k++) {
        dalcs_csv_number(c, m->value[step * n_values + k]);
    }
    for (size_t at = 0; at < report->n_measurements;) {
        const size_t n = block_at(report, at);
        for (size_t k = at + step * n; k < at + (step + 1) * n && k < report->n_measurements; k++) {
            const struct dalcs_measurement *found = &report->measurement[k];
            dalcs_csv_number(c, found->found ? found->value : NAN);
        }
        at += n * m->n_steps;
    }
    end_row(c, m, error_of(report, step));
}

/* Of .wcase a row each run. */
static void write_worst_case(struct dalcs_csv_cells *c, const struct dalcs_arguments *arguments,
                             const struct dalcs_report *report) {
    write_names(c, arguments);
    dalcs_worst_case_write_header(c, report);
    dalcs_csv_end(c);
    for (size_t run = 0; run < report->worst_case.n_runs; run++) {
        write_settings(c, arguments);
        dalcs_worst_case_write_row(c, report, run);
        dalcs_csv_end(c);
    }
}

static void write_steps(struct dalcs_csv_cells *c, const struct dalcs_measures_file *m,
                        const struct dalcs_arguments *arguments,
                        const struct dalcs_report *report) {
    write_header(c, m, arguments, report);
    for (size_t step = 0; step < m->n_steps; step++) {
        write_step(c, m, arguments, report, step);
    }
}

enum dalcs_status dalcs_measures_file_close(struct dalcs_measures_file *m,
                                            const struct dalcs_cli *cli,
                                            const struct dalcs_arguments *arguments,
                                            const struct dalcs_report *report, bool is_whole) {
    enum dalcs_status status = DALCS_OK;
    if (m->path != NULL && is_whole && report != NULL) {
        struct dalcs_decimal decimal;
        struct dalcs_csv_cells c = {.out = m->file.stream, .decimal = &decimal};
        dalcs_decimal_init(&decimal);
        if (report->worst_case.present) {
            write_worst_case(&c, arguments, report);
        } else {
            write_steps(&c, m, arguments, report);
        }
        if (dalcs_atomic_file_commit(&m->file) != DALCS_OK) {
            status = tell_failure(m, cli);
        } else if (!arguments->quiet) {
            fprintf(cli->out, "  wrote     %s\n", m->path);
        }
    }
    dalcs_atomic_file_discard(&m->file);
    free(m->name);
    free(m->value);
    m->name = NULL;
    m->value = NULL;
    return status;
}

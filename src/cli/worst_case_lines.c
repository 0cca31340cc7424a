/* worst_case_lines.c - what .wcase says, in a table for people and in rows. */
#include "worst_case_lines.h"

#include <math.h>
#include <string.h>

enum { NAME = 18, NUMBER = 12 };

/* Of a tolerance in a run. */
static double value_of(const struct dalcs_report *report, size_t run, size_t p) {
    const struct dalcs_worst_case_parameter *parameter = &report->worst_case.parameter[p];
    const signed char place = report->worst_case.run[run].place[p];
    return place < 0 ? parameter->low : place > 0 ? parameter->high : parameter->nominal;
}

static void write_cell(FILE *out, double value) {
    if (isnan(value)) {
        fprintf(out, " %*s", NUMBER, "-");
    } else {
        fprintf(out, " %*.6g", NUMBER, value);
    }
}

static void write_result(FILE *out, const struct dalcs_report *report, size_t k) {
    const struct dalcs_worst_case_result *result = &report->worst_case.result[k];
    const struct dalcs_worst_case_run *run = report->worst_case.run;
    const size_t shown[] = {result->smallest, 0, result->largest};
    fprintf(out, "  %-*s", NAME, result->name);
    for (size_t i = 0; i < sizeof shown / sizeof shown[0]; i++) {
        write_cell(out, run[shown[i]].value[k]);
    }
    fputc('\n', out);
    for (size_t p = 0; p < report->worst_case.n_parameters; p++) {
        fprintf(out, "    %-*s", NAME - 2, report->worst_case.parameter[p].name);
        for (size_t i = 0; i < sizeof shown / sizeof shown[0]; i++) {
            write_cell(out, value_of(report, shown[i], p));
        }
        write_cell(out, result->at_low[p]);
        write_cell(out, result->at_high[p]);
        fputc('\n', out);
    }
}

void dalcs_worst_case_lines_write(FILE *out, const struct dalcs_report *report) {
    const size_t n = report->worst_case.n_parameters;
    if (!report->worst_case.present) {
        return;
    }
    fprintf(out, "\n  worst cases of %zu tolerance%s, by %zu runs%s\n", n, n == 1 ? "" : "s",
            report->worst_case.n_runs, report->worst_case.has_corners ? " with all corners" : "");
    fprintf(out, "  %-*s %*s %*s %*s %*s %*s\n", NAME, "", NUMBER, "smallest", NUMBER, "nominal",
            NUMBER, "largest", NUMBER, "low alone", NUMBER, "high alone");
    for (size_t k = 0; k < report->worst_case.n_results; k++) {
        write_result(out, report, k);
    }
}

void dalcs_worst_case_write_header(struct dalcs_csv_cells *cells,
                                   const struct dalcs_report *report) {
    for (size_t p = 0; p < report->worst_case.n_parameters; p++) {
        const char *name = report->worst_case.parameter[p].name;
        dalcs_csv_text(cells, name, strlen(name));
    }
    for (size_t k = 0; k < report->worst_case.n_results; k++) {
        const char *name = report->worst_case.result[k].name;
        dalcs_csv_text(cells, name, strlen(name));
    }
    dalcs_csv_text(cells, "error", strlen("error"));
}

void dalcs_worst_case_write_row(struct dalcs_csv_cells *cells, const struct dalcs_report *report,
                                size_t run) {
    const char *error = report->worst_case.run[run].error;
    for (size_t p = 0; p < report->worst_case.n_parameters; p++) {
        dalcs_csv_number(cells, value_of(report, run, p));
    }
    for (size_t k = 0; k < report->worst_case.n_results; k++) {
        dalcs_csv_number(cells, report->worst_case.run[run].value[k]);
    }
    dalcs_csv_text(cells, error != NULL ? error : "", error != NULL ? strlen(error) : 0);
}

enum dalcs_status dalcs_worst_case_tell_failed(const struct dalcs_cli *cli,
                                               const struct dalcs_report *report) {
    for (size_t run = 0; report->worst_case.present && run < report->worst_case.n_runs; run++) {
        if (report->worst_case.run[run].error == NULL) {
            continue;
        }
        dalcs_cli_error(cli, "%zu of %zu runs of .wcase failed, the first where",
                        report->worst_case.n_failed, report->worst_case.n_runs);
        for (size_t p = 0; p < report->worst_case.n_parameters; p++) {
            fprintf(cli->err, "  %s = %.9g\n", report->worst_case.parameter[p].name,
                    value_of(report, run, p));
        }
        fprintf(cli->err, "  %s\n", report->worst_case.run[run].error);
        return DALCS_NOT_CONVERGED;
    }
    return DALCS_OK;
}

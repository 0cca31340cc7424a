/* sensitivity_lines.c - what .sens says, in a table. */
#include "sensitivity_lines.h"

#include <math.h>
#include <string.h>

/* Values beside each other; more of them follow below. */
enum { BESIDE = 5, NAME = 16, NUMBER = 12 };

/* Below this part of the largest it is rounding. */
static const double nothing = 1e-9;

static bool has_measurements(const struct dalcs_report *report) {
    for (size_t k = 0; k < report->sensitivity.n_results; k++) {
        if (strcmp(report->sensitivity.result[k].kind, "measurement") == 0) {
            return true;
        }
    }
    return false;
}

/* Where something is measured, that; else averages. The report has all. */
static bool is_shown(const struct dalcs_sensitivity_result *r, bool measured) {
    const char *const kind[] = {"period", "thd", measured ? "measurement" : "average"};
    bool is = false;
    for (size_t k = 0; k < sizeof kind / sizeof kind[0]; k++) {
        is = is || strcmp(r->kind, kind[k]) == 0;
    }
    return is && isfinite(r->value);
}

static void write_cell(FILE *out, const struct dalcs_sensitivity_result *r,
                       const struct dalcs_sensitivity_parameter *p, double derivative) {
    char text[32];
    const double relative = derivative * p->value / r->value;
    if (!isfinite(relative) || p->value == 0.0) {
        snprintf(text, sizeof text, "-");
    } else {
        snprintf(text, sizeof text, "%.6g", fabs(relative) < nothing ? 0.0 : relative);
    }
    fprintf(out, " %*s", NUMBER, text);
}

static void write_rows(FILE *out, const struct dalcs_report *report, size_t from, size_t to) {
    const bool measured = has_measurements(report);
    fprintf(out, "  %-*s %*s", NAME, "result", NUMBER, "value");
    for (size_t p = from; p < to; p++) {
        fprintf(out, " %*s", NUMBER, report->sensitivity.parameter[p].name);
    }
    fputc('\n', out);
    for (size_t k = 0; k < report->sensitivity.n_results; k++) {
        const struct dalcs_sensitivity_result *r = &report->sensitivity.result[k];
        if (!is_shown(r, measured)) {
            continue;
        }
        const bool is_thd = strcmp(r->kind, "thd") == 0;
        char name[64];
        snprintf(name, sizeof name, "%s%s%s", is_thd ? "thd(" : "", r->name, is_thd ? ")" : "");
        fprintf(out, "  %-*s %*.6g", NAME, name, NUMBER, r->value);
        for (size_t p = from; p < to; p++) {
            write_cell(out, r, &report->sensitivity.parameter[p], r->derivative[p]);
        }
        fputc('\n', out);
    }
}

void dalcs_sensitivity_lines_write(FILE *out, const struct dalcs_report *report) {
    const size_t n = report->sensitivity.n_parameters;
    if (!report->sensitivity.present) {
        return;
    }
    fprintf(out, "\n  sensitivities: per cent by one per cent of a value\n");
    for (size_t from = 0; from < n; from += BESIDE) {
        write_rows(out, report, from, from + BESIDE < n ? from + BESIDE : n);
    }
}

/* worst_case_json.c - .wcase, for the report. */
#include "worst_case_json.h"

#include <math.h>

/* NaN of a run that failed becomes null. */
static void write_value(struct dalcs_json *json, const char *key, double value) {
    if (isnan(value)) {
        dalcs_json_string(json, key, NULL);
    } else {
        dalcs_json_number(json, key, value);
    }
}

static void write_places(struct dalcs_json *json, const char *key,
                         const struct dalcs_report *report, size_t run) {
    dalcs_json_open(json, key, '{', true);
    for (size_t p = 0; p < report->worst_case.n_parameters; p++) {
        dalcs_json_integer(json, report->worst_case.parameter[p].name,
                           report->worst_case.run[run].place[p]);
    }
    dalcs_json_close(json, '}');
}

static void write_result(struct dalcs_json *json, const struct dalcs_report *report, size_t k) {
    const struct dalcs_worst_case_result *result = &report->worst_case.result[k];
    const struct dalcs_worst_case_run *run = report->worst_case.run;
    dalcs_json_open(json, NULL, '{', false);
    dalcs_json_string(json, "name", result->name);
    write_value(json, "smallest", run[result->smallest].value[k]);
    write_value(json, "nominal", run[0].value[k]);
    write_value(json, "largest", run[result->largest].value[k]);
    write_places(json, "at_smallest", report, result->smallest);
    write_places(json, "at_largest", report, result->largest);
    dalcs_json_open(json, "alone", '{', false);
    for (size_t p = 0; p < report->worst_case.n_parameters; p++) {
        dalcs_json_open(json, report->worst_case.parameter[p].name, '[', true);
        write_value(json, NULL, result->at_low[p]);
        write_value(json, NULL, result->at_high[p]);
        dalcs_json_close(json, ']');
    }
    dalcs_json_close(json, '}');
    dalcs_json_close(json, '}');
}

void dalcs_worst_case_json_write(struct dalcs_json *json, const struct dalcs_report *report) {
    if (!report->worst_case.present) {
        return;
    }
    dalcs_json_open(json, "worst_case", '{', false);
    dalcs_json_boolean(json, "corners", report->worst_case.has_corners);
    dalcs_json_integer(json, "runs", (long)report->worst_case.n_runs);
    dalcs_json_integer(json, "failed", (long)report->worst_case.n_failed);
    dalcs_json_open(json, "parameters", '{', false);
    for (size_t p = 0; p < report->worst_case.n_parameters; p++) {
        const struct dalcs_worst_case_parameter *parameter = &report->worst_case.parameter[p];
        dalcs_json_open(json, parameter->name, '[', true);
        dalcs_json_number(json, NULL, parameter->low);
        dalcs_json_number(json, NULL, parameter->nominal);
        dalcs_json_number(json, NULL, parameter->high);
        dalcs_json_close(json, ']');
    }
    dalcs_json_close(json, '}');
    dalcs_json_open(json, "results", '[', false);
    for (size_t k = 0; k < report->worst_case.n_results; k++) {
        write_result(json, report, k);
    }
    dalcs_json_close(json, ']');
    dalcs_json_close(json, '}');
}

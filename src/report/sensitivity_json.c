/* sensitivity_json.c - .sens, for the report. */
#include "sensitivity_json.h"

#include <math.h>

static void write_result(struct dalcs_json *json, const struct dalcs_report *report,
                         const struct dalcs_sensitivity_result *result) {
    dalcs_json_open(json, NULL, '{', false);
    dalcs_json_string(json, "name", result->name);
    dalcs_json_string(json, "kind", result->kind);
    if (result->harmonic > 0) {
        dalcs_json_integer(json, "harmonic", result->harmonic);
    }
    dalcs_json_number(json, "value", result->value);
    dalcs_json_open(json, "derivatives", '{', false);
    for (size_t p = 0; p < report->sensitivity.n_parameters; p++) {
        if (isfinite(result->derivative[p])) {
            dalcs_json_number(json, report->sensitivity.parameter[p].name, result->derivative[p]);
        }
    }
    dalcs_json_close(json, '}');
    dalcs_json_close(json, '}');
}

void dalcs_sensitivity_json_write(struct dalcs_json *json, const struct dalcs_report *report) {
    if (!report->sensitivity.present) {
        return;
    }
    dalcs_json_open(json, "sensitivity", '{', false);
    dalcs_json_open(json, "parameters", '{', false);
    for (size_t p = 0; p < report->sensitivity.n_parameters; p++) {
        dalcs_json_number(json, report->sensitivity.parameter[p].name,
                          report->sensitivity.parameter[p].value);
    }
    dalcs_json_close(json, '}');
    dalcs_json_open(json, "results", '[', false);
    for (size_t k = 0; k < report->sensitivity.n_results; k++) {
        if (isfinite(report->sensitivity.result[k].value)) {
            write_result(json, report, &report->sensitivity.result[k]);
        }
    }
    dalcs_json_close(json, ']');
    dalcs_json_close(json, '}');
}

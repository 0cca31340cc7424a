/* failed_steps_json.c - the steps of .step that failed, for the report. */
#include "failed_steps_json.h"

void dalcs_failed_steps_json_write(struct dalcs_json *json, const struct dalcs_report *report) {
    if (report->n_failed_steps == 0) {
        return;
    }
    dalcs_json_open(json, "failed_steps", '[', false);
    for (size_t k = 0; k < report->n_failed_steps; k++) {
        const struct dalcs_failed_step *step = &report->failed_step[k];
        dalcs_json_open(json, NULL, '{', false);
        dalcs_json_integer(json, "number", (long)step->step + 1);
        dalcs_json_string(json, "step", step->values);
        dalcs_json_string(json, "status", dalcs_status_text(step->status));
        dalcs_json_string(json, "because", step->because);
        dalcs_json_close(json, '}');
    }
    dalcs_json_close(json, ']');
}

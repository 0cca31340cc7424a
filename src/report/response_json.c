/* response_json.c - the response around an orbit, for the report. */
#include "response_json.h"

static void write_margins(struct dalcs_json *json, const char *key, bool of_phase, size_t n,
                          const struct dalcs_margin *margin) {
    dalcs_json_open(json, key, '[', false);
    for (size_t i = 0; i < n; i++) {
        dalcs_json_open(json, NULL, '{', true);
        dalcs_json_number(json, "frequency", margin[i].frequency);
        dalcs_json_number(json, of_phase ? "phase_margin" : "gain_margin", margin[i].margin);
        dalcs_json_close(json, '}');
    }
    dalcs_json_close(json, ']');
}

void dalcs_response_json_write(struct dalcs_json *json, const struct dalcs_report *report) {
    if (!report->response.present) {
        return;
    }
    dalcs_json_open(json, "response", '{', false);
    dalcs_json_number(json, "period", report->response.period);
    dalcs_json_integer(json, "sideband", report->response.sideband);
    dalcs_json_boolean(json, "exact", report->response.exact);
    dalcs_json_number(json, "tail", report->response.tail);
    if (report->response.loop != NULL) {
        dalcs_json_string(json, "loop", report->response.loop);
        dalcs_json_string(json, "injection", report->response.loop_is_loaded ? "both" : "voltage");
        write_margins(json, "crossovers", true, report->response.n_crossovers,
                      report->response.crossover);
        write_margins(json, "reversals", false, report->response.n_reversals,
                      report->response.reversal);
    }
    dalcs_json_close(json, '}');
}

/* losses_json.c - the same as an entry of the report. */
#include "losses_json.h"

static void write_element(struct dalcs_json *json, const struct dalcs_element_losses *e) {
    dalcs_json_open(json, NULL, '{', true);
    dalcs_json_string(json, "element", e->element);
    dalcs_json_string(json, "kind", e->kind);
    dalcs_json_finite(json, "v_average", e->v_average);
    dalcs_json_finite(json, "v_rms", e->v_rms);
    dalcs_json_finite(json, "i_average", e->i_average);
    dalcs_json_finite(json, "i_rms", e->i_rms);
    dalcs_json_number(json, "power", e->power);
    dalcs_json_number(json, "jumps", e->jumps);
    dalcs_json_number(json, "stored_change", e->stored_change);
    dalcs_json_number(json, "switching", e->switching);
    dalcs_json_number(json, "turned_on", (double)e->n_on);
    dalcs_json_number(json, "turned_off", (double)e->n_off);
    dalcs_json_number(json, "clamped", (double)e->n_clamped);
    if (e->frequency > 0.0) {
        dalcs_json_number(json, "frequency", e->frequency);
        dalcs_json_finite(json, "power_factor", e->power_factor);
        dalcs_json_finite(json, "displacement", e->displacement);
        dalcs_json_finite(json, "thd", e->thd);
    }
    dalcs_json_close(json, '}');
}

void dalcs_losses_json_write(struct dalcs_json *json, const struct dalcs_losses *l) {
    dalcs_json_open(json, NULL, '{', false);
    if (l->step != NULL) {
        dalcs_json_string(json, "step", l->step);
    }
    dalcs_json_string(json, "analysis", l->of_orbit ? "pss" : "tran");
    dalcs_json_number(json, "from", l->from);
    dalcs_json_number(json, "to", l->to);
    dalcs_json_number(json, "sources", l->sources);
    dalcs_json_number(json, "resistors", l->resistors);
    dalcs_json_number(json, "windings", l->windings);
    dalcs_json_number(json, "diodes", l->diodes);
    dalcs_json_number(json, "switches", l->switches);
    dalcs_json_number(json, "jumps", l->jumps);
    dalcs_json_number(json, "stored_change", l->stored_change);
    dalcs_json_number(json, "balance", l->balance);
    dalcs_json_number(json, "switching", l->switching);
    dalcs_json_number(json, "input", l->input);
    dalcs_json_string(json, "inputs", l->inputs);
    dalcs_json_number(json, "output", l->output);
    dalcs_json_string(json, "outputs", l->outputs);
    dalcs_json_finite(json, "efficiency", l->efficiency);
    dalcs_json_open(json, "elements", '[', false);
    for (size_t k = 0; k < l->n_elements; k++) {
        write_element(json, &l->element[k]);
    }
    dalcs_json_close(json, ']');
    dalcs_json_close(json, '}');
}

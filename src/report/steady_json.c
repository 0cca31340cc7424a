/* steady_json.c - states, and the periodic steady state of a report as JSON. */
#include "steady_json.h"

void dalcs_states_json_write(struct dalcs_json *json, const char *key,
                             const struct dalcs_report *report, const double *value) {
    dalcs_json_open(json, key, '{', false);
    for (size_t i = 0; value && i < report->n_states; i++) {
        dalcs_json_number(json, report->state_name[i], value[i]);
    }
    dalcs_json_close(json, '}');
}

static void write_multipliers(struct dalcs_json *json, const struct dalcs_floquet *m, size_t n) {
    dalcs_json_open(json, "multipliers", '[', false);
    for (size_t i = 0; i < n; i++) {
        dalcs_json_open(json, NULL, '{', true);
        dalcs_json_number(json, "re", m[i].re);
        dalcs_json_number(json, "im", m[i].im);
        dalcs_json_string(json, "state", m[i].state);
        dalcs_json_close(json, '}');
    }
    dalcs_json_close(json, ']');
}

/* What the search found beside the orbit. */
static void write_beside_orbit(struct dalcs_json *json, const struct dalcs_report *report) {
    if (report->steady.doubled.period > 0.0) {
        dalcs_json_open(json, "doubled", '{', false);
        dalcs_json_number(json, "period", report->steady.doubled.period);
        dalcs_json_boolean(json, "stable", report->steady.doubled.stable);
        write_multipliers(json, report->steady.doubled.multiplier,
                          report->steady.doubled.n_multipliers);
        dalcs_json_close(json, '}');
    }
    if (report->steady.attractor.kind != NULL) {
        dalcs_json_open(json, "attractor", '{', false);
        dalcs_json_string(json, "kind", report->steady.attractor.kind);
        if (report->steady.attractor.periods > 0) {
            dalcs_json_integer(json, "periods", report->steady.attractor.periods);
            dalcs_json_number(json, "period", report->steady.attractor.period);
        }
        dalcs_json_number(json, "growth", report->steady.attractor.growth);
        dalcs_json_close(json, '}');
    }
}

void dalcs_steady_json_write(struct dalcs_json *json, const struct dalcs_report *report) {
    if (!report->steady.present) {
        return;
    }
    dalcs_json_open(json, "steady", '{', false);
    dalcs_json_number(json, "period", report->steady.period);
    dalcs_json_integer(json, "newton", report->steady.newton);
    dalcs_json_integer(json, "bursts", report->steady.bursts);
    dalcs_json_integer(json, "leaps", report->steady.leaps);
    dalcs_json_integer(json, "periods", report->steady.periods);
    dalcs_json_number(json, "residual", report->steady.residual);
    dalcs_json_number(json, "distance", report->steady.distance);
    dalcs_json_number(json, "defect", report->steady.defect);
    dalcs_json_boolean(json, "exact", report->steady.exact);
    dalcs_json_boolean(json, "stable", report->steady.stable);
    dalcs_json_string(json, "verdict", report->steady.verdict);
    if (report->steady.self_oscillating) {
        dalcs_json_boolean(json, "self_oscillating", true);
        dalcs_json_number(json, "flow", report->steady.flow);
    }
    write_multipliers(json, report->steady.multiplier, report->steady.n_multipliers);
    write_beside_orbit(json, report);
    dalcs_json_open(json, "conserved", '[', false);
    for (size_t i = 0; i < report->steady.n_conserved; i++) {
        dalcs_json_string(json, NULL, report->steady.conserved[i]);
    }
    dalcs_json_close(json, ']');
    dalcs_states_json_write(json, "states", report, report->steady.state);
    dalcs_json_open(json, "signals", '{', false);
    for (size_t i = 0; i < report->steady.n_signals; i++) {
        const struct dalcs_steady_signal *signal = &report->steady.signal[i];
        dalcs_json_open(json, signal->name, '{', true);
        dalcs_json_finite(json, "average", signal->average);
        dalcs_json_finite(json, "rms", signal->rms);
        dalcs_json_close(json, '}');
    }
    dalcs_json_close(json, '}');
    dalcs_json_close(json, '}');
}

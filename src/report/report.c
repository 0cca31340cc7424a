/* report.c - struct dalcs_report as JSON. The keys are an interface: see doc/output.md before
 * changing one. SI units throughout. */
#include "report.h"
#include "response_json.h"
#include "sensitivity_json.h"
#include "worst_case_json.h"

#include "failed_steps_json.h"
#include "json.h"
#include "losses_json.h"
#include "measurements_json.h"
#include "method_text.h"

#include <math.h>

/* For each component; what was asked for where there was no .tran. */
static void write_method(struct dalcs_json *json, const struct dalcs_report *report) {
    dalcs_json_open(json, "method", '{', false);
    for (int i = 0; i < report->size.components; i++) {
        char component[32], text[DALCS_METHOD_TEXT_SIZE];
        snprintf(component, sizeof component, "component %d", i + 1);
        dalcs_json_string(json, component,
                          (size_t)i < report->n_components
                              ? dalcs_method_text(text, &report->component[i])
                              : report->method);
    }
    dalcs_json_close(json, '}');
}

static void write_size(struct dalcs_json *json, const struct dalcs_report *report) {
    dalcs_json_open(json, "size", '{', true);
    dalcs_json_integer(json, "nodes", report->size.nodes);
    dalcs_json_integer(json, "x", report->size.x);
    dalcs_json_integer(json, "z", report->size.z);
    dalcs_json_integer(json, "lambda", report->size.lambda);
    dalcs_json_integer(json, "switches", report->size.switches);
    dalcs_json_integer(json, "components", report->size.components);
    dalcs_json_close(json, '}');
}

static void write_work(struct dalcs_json *json, const struct dalcs_report *report) {
    dalcs_json_open(json, "work", '{', false);
    dalcs_json_integer(json, "steps", report->work.steps);
    dalcs_json_integer(json, "rejected", report->work.rejected);
    dalcs_json_integer(json, "restarts", report->work.restarts);
    dalcs_json_integer(json, "euler_steps", report->work.euler_steps);
    dalcs_json_integer(json, "periodic_steps", report->work.periodic_steps);
    dalcs_json_integer(json, "leapt_steps", report->work.leapt_steps);
    dalcs_json_integer(json, "osnsp", report->work.osnsp);
    dalcs_json_integer(json, "pivots", report->work.pivots);
    dalcs_json_integer(json, "factorizations", report->work.factorizations);
    dalcs_json_integer(json, "cache_hits", report->work.cache_hits);
    dalcs_json_integer(json, "singular", report->work.singular);
    dalcs_json_number(json, "cpu_s", report->work.cpu_s);
    dalcs_json_number(json, "wall_s", report->work.wall_s);
    dalcs_json_close(json, '}');
}

static void write_certificate(struct dalcs_json *json, const struct dalcs_report *report) {
    dalcs_json_open(json, "certificate", '{', true);
    dalcs_json_number(json, "worst", report->certificate.worst);
    dalcs_json_number(json, "time", report->certificate.time);
    dalcs_json_string(json, "where", report->certificate.where);
    dalcs_json_number(json, "wrong_sign", report->certificate.wrong_sign);
    dalcs_json_close(json, '}');
}

/* The worst defect of every law that was checked. */
static void write_audit(struct dalcs_json *json, const struct dalcs_report *report) {
    if (report->audit.mode == NULL) {
        return;
    }
    dalcs_json_open(json, "audit", '{', false);
    dalcs_json_string(json, "mode", report->audit.mode);
    dalcs_json_integer(json, "instants", report->audit.instants);
    dalcs_json_integer(json, "frequencies", report->frequencies);
    dalcs_json_integer(json, "segments", report->audit.segments);
    dalcs_json_integer(json, "audited", report->audit.audited);
    dalcs_json_integer(json, "screened", report->audit.screened);
    dalcs_json_integer(json, "positions", report->audit.positions);
    dalcs_json_integer(json, "unjudged", report->unjudged);
    dalcs_json_number(json, "worst", report->audit.worst);
    dalcs_json_number(json, "allowed", report->audit.allowed);
    dalcs_json_number(json, "time", report->audit.time);
    dalcs_json_string(json, "where", report->audit.where);
    dalcs_json_open(json, "laws", '[', false);
    for (size_t i = 0; i < report->audit.n_laws; i++) {
        const struct dalcs_audited *law = &report->audit.law[i];
        dalcs_json_open(json, NULL, '{', true);
        dalcs_json_string(json, "law", law->law);
        dalcs_json_number(json, "defect", law->defect);
        dalcs_json_number(json, "time", law->time);
        dalcs_json_close(json, '}');
    }
    dalcs_json_close(json, ']');
    dalcs_json_close(json, '}');
}

static void write_states(struct dalcs_json *json, const char *key,
                         const struct dalcs_report *report, const double *value) {
    dalcs_json_open(json, key, '{', false);
    for (size_t i = 0; value && i < report->n_states; i++) {
        dalcs_json_number(json, report->state_name[i], value[i]);
    }
    dalcs_json_close(json, '}');
}

static void write_events(struct dalcs_json *json, const struct dalcs_report *report) {
    dalcs_json_open(json, "events", '[', false);
    for (size_t i = 0; i < report->n_events; i++) {
        const struct dalcs_event *event = &report->event[i];
        dalcs_json_open(json, NULL, '{', true);
        dalcs_json_number(json, "time", event->time);
        dalcs_json_string(json, "element", event->element);
        dalcs_json_string(json, "state", event->on ? "on" : "off");
        dalcs_json_close(json, '}');
    }
    dalcs_json_close(json, ']');
    if (report->n_events_dropped > 0) {
        dalcs_json_integer(json, "events_dropped", (long)report->n_events_dropped);
    }
}

static void write_jump(struct dalcs_json *json, const struct dalcs_jump *jump) {
    dalcs_json_open(json, NULL, '{', false);
    dalcs_json_number(json, "time", jump->time);
    dalcs_json_open(json, "states", '{', false);
    for (size_t i = 0; i < jump->n_states; i++) {
        dalcs_json_open(json, jump->state[i].element, '{', true);
        dalcs_json_number(json, "before", jump->state[i].before);
        dalcs_json_number(json, "after", jump->state[i].after);
        dalcs_json_close(json, '}');
    }
    dalcs_json_close(json, '}');
    dalcs_json_open(json, "impulses", '{', false);
    for (size_t i = 0; i < jump->n_impulses; i++) {
        const struct dalcs_impulse *impulse = &jump->impulse[i];
        dalcs_json_open(json, impulse->element, '{', true);
        dalcs_json_number(json, impulse->is_flux ? "flux" : "charge", impulse->value);
        dalcs_json_close(json, '}');
    }
    dalcs_json_close(json, '}');
    dalcs_json_number(json, "energy_lost", jump->energy_lost);
    dalcs_json_number(json, "source_work", jump->source_work);
    dalcs_json_close(json, '}');
}

static void write_jumps(struct dalcs_json *json, const struct dalcs_report *report) {
    dalcs_json_open(json, "jumps", '[', false);
    for (size_t i = 0; i < report->n_jumps; i++) {
        write_jump(json, &report->jump[i]);
    }
    dalcs_json_close(json, ']');
    if (report->n_jumps_dropped > 0) {
        dalcs_json_integer(json, "jumps_dropped", (long)report->n_jumps_dropped);
    }
}

/* JSON has no infinity: "inf" and "-inf" stand for it. */
static void write_bound(struct dalcs_json *json, const char *key, double value) {
    if (isinf(value)) {
        dalcs_json_string(json, key, value > 0.0 ? "inf" : "-inf");
    } else {
        dalcs_json_number(json, key, value);
    }
}

static void write_nonunique(struct dalcs_json *json, const struct dalcs_report *report) {
    dalcs_json_open(json, "nonunique", '[', false);
    for (size_t i = 0; i < report->n_nonunique; i++) {
        const struct dalcs_nonunique *n = &report->nonunique[i];
        dalcs_json_open(json, NULL, '{', false);
        dalcs_json_string(json, "signal", n->signal);
        write_bound(json, "lower", n->lower);
        write_bound(json, "upper", n->upper);
        dalcs_json_number(json, "value", n->value);
        dalcs_json_number(json, "time", n->time);
        dalcs_json_string(json, "because", n->because);
        dalcs_json_close(json, '}');
    }
    dalcs_json_close(json, ']');
}

static void write_energy(struct dalcs_json *json, const struct dalcs_report *report) {
    if (!report->energy.present) {
        return;
    }
    dalcs_json_open(json, "energy", '{', false);
    dalcs_json_number(json, "sources", report->energy.sources);
    dalcs_json_number(json, "resistors", report->energy.resistors);
    dalcs_json_number(json, "diodes", report->energy.diodes);
    dalcs_json_number(json, "jumps", report->energy.jumps);
    dalcs_json_number(json, "stored_change", report->energy.stored_change);
    dalcs_json_number(json, "method", report->energy.method);
    dalcs_json_number(json, "balance", report->energy.balance);
    dalcs_json_close(json, '}');
}

/* "states": just before the edges at the beginning of the period. */
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

static void write_steady(struct dalcs_json *json, const struct dalcs_report *report) {
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
    write_states(json, "states", report, report->steady.state);
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

static void write_transfer(struct dalcs_json *json, const struct dalcs_report *report) {
    if (!report->transfer.present) {
        return;
    }
    dalcs_json_open(json, "transfer", '{', false);
    for (size_t k = 0; k < sizeof report->transfer.name / sizeof report->transfer.name[0]; k++) {
        dalcs_json_number(json, report->transfer.name[k], report->transfer.value[k]);
    }
    dalcs_json_close(json, '}');
}

static void write_infeasible(struct dalcs_json *json, const struct dalcs_report *report) {
    if (!report->infeasible.present) {
        return;
    }
    dalcs_json_open(json, "infeasible", '{', false);
    dalcs_json_number(json, "time", report->infeasible.time);
    dalcs_json_open(json, "elements", '[', true);
    for (size_t i = 0; i < report->infeasible.n_elements; i++) {
        dalcs_json_string(json, NULL, report->infeasible.element[i]);
    }
    dalcs_json_close(json, ']');
    dalcs_json_string(json, "kind", report->infeasible.kind);
    dalcs_json_string(json, "because", report->infeasible.because);
    dalcs_json_close(json, '}');
}

static void write_envelope(struct dalcs_json *json, const struct dalcs_report *report) {
    if (!report->envelope.present) {
        return;
    }
    dalcs_json_open(json, "envelope", '{', false);
    dalcs_json_number(json, "period", report->envelope.period);
    dalcs_json_integer(json, "periods", report->envelope.periods);
    dalcs_json_integer(json, "run", report->envelope.run);
    dalcs_json_integer(json, "leaps", report->envelope.leaps);
    dalcs_json_integer(json, "rejected", report->envelope.rejected);
    dalcs_json_number(json, "worst", report->envelope.worst);
    dalcs_json_number(json, "allowed", report->envelope.allowed);
    dalcs_json_close(json, '}');
}

static void write_losses(struct dalcs_json *json, const struct dalcs_report *report) {
    if (report->n_losses == 0) {
        return;
    }
    dalcs_json_open(json, "losses", '[', false);
    for (size_t i = 0; i < report->n_losses; i++) {
        dalcs_losses_json_write(json, &report->losses[i]);
    }
    dalcs_json_close(json, ']');
}

void dalcs_report_write(FILE *stream, const struct dalcs_report *report, enum dalcs_status status) {
    struct dalcs_json json;
    dalcs_json_init(&json, stream);
    dalcs_json_open(&json, NULL, '{', false);
    dalcs_json_string(&json, "netlist", report->netlist);
    dalcs_json_string(&json, "title", report->title);
    dalcs_json_string(&json, "status", dalcs_status_text(status));
    write_method(&json, report);
    dalcs_json_number(&json, "tolerance", report->tolerance);
    dalcs_json_number(&json, "step", report->step);
    dalcs_json_number(&json, "stop", report->stop);
    write_size(&json, report);
    write_work(&json, report);
    write_certificate(&json, report);
    write_audit(&json, report);
    write_states(&json, "start", report, report->start);
    write_states(&json, "final", report, report->final);
    write_events(&json, report);
    write_jumps(&json, report);
    write_nonunique(&json, report);
    dalcs_measurements_json_write(&json, report);
    write_envelope(&json, report);
    write_losses(&json, report);
    write_energy(&json, report);
    write_steady(&json, report);
    dalcs_response_json_write(&json, report);
    write_transfer(&json, report);
    dalcs_sensitivity_json_write(&json, report);
    dalcs_worst_case_json_write(&json, report);
    dalcs_failed_steps_json_write(&json, report);
    write_infeasible(&json, report);
    dalcs_json_close(&json, '}');
}

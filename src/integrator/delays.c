/* delays.c - the signals that delayed sources read, at the nodes of the segments that have been passed through. A
 * circuit with such sources is one system, so that one part has them all. */
#include "delays.h"

#include "history.h"
#include "network.h"
#include "recurrence.h"

void dalcs_delays_setup(struct dalcs_radau *r, const struct dalcs_circuit *circuit) {
    for (int k = 0; k < circuit->control.n_delayed; k++) {
        struct dalcs_history *history = circuit->control.delayed[k].history;
        dalcs_history_start(history, 0.0);
        history->tolerance = r->inner_tolerance;
    }
}

/* Adds what a probe reads to value[s + 1]. */
static void add_probe(const struct dalcs_radau_part *part, const struct dalcs_probe *probe,
                      double sign, double *value) {
    const struct dalcs_component *c = part->component;
    const struct dalcs_collocation *method = part->stages.method;
    const int n_equations = dalcs_system_n_equations(c->system);
    for (int k = 0; k < probe->n_terms + probe->n_inputs; k++) {
        const struct dalcs_probe_term *term = &probe->term[k];
        const double factor = sign * term->coefficient;
        const bool is_input = k >= probe->n_terms;
        if (!is_input && term->index >= n_equations &&
            !dalcs_osnsp_is_on(&c->osnsp, term->index - n_equations)) {
            continue;
        }
        for (int i = 0; i <= method->s; i++) {
            const double t = part->segment.t + part->segment.h * method->node[i];
            const double *y = part->segment.out + i * part->stages.layout.stride;
            const int stimulus = is_input ? c->system->stimulus[term->index] : -1;
            value[i] +=
                factor * (!is_input       ? y[term->index]
                          : stimulus >= 0 ? dalcs_stimulus_value(&c->circuit->stimulus[stimulus], t,
                                                                 i == 0 ? DALCS_RIGHT : DALCS_LEFT)
                                          : 1.0);
        }
    }
}

enum dalcs_status dalcs_delays_note(const struct dalcs_radau *r, struct dalcs_radau_part *part) {
    const struct dalcs_circuit *circuit = part->component->circuit;
    const struct dalcs_collocation *method = part->stages.method;
    if (circuit->control.n_delayed > 0) {
        dalcs_recurrence_complete(part);
    }
    for (int k = 0; k < circuit->control.n_delayed; k++) {
        const struct dalcs_delayed *delayed = &circuit->control.delayed[k];
        const struct dalcs_output *output =
            &r->base->network->output[circuit->results.measured[delayed->signal]];
        struct dalcs_history_piece piece = {
            .t = part->segment.t, .h = part->segment.h, .end = part->segment.t_end};
        delayed->history->degree = method->s;
        delayed->history->node = method->node;
        delayed->history->weight = method->barycentric;
        if (output->plus.system == part->index) {
            add_probe(part, &output->plus, 1.0, piece.value);
        }
        if (output->minus.system == part->index) {
            add_probe(part, &output->minus, -1.0, piece.value);
        }
        if (output->plus.system == part->index || output->minus.system == part->index) {
            DALCS_TRY(dalcs_history_add(delayed->history, &piece, !part->segment.anew));
        }
    }
    return DALCS_OK;
}

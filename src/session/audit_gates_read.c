/* audit_gates_read.c - what gates show and read at an instant, in the sources and switches that the circuit has. */
#include "audit_gate.h"

#include "radau.h"

#include <math.h>

int audit_gate_shown_by(const struct dalcs_logic_gate *g) {
    return g->output[0] >= 0 ? g->output[0] : g->output[1];
}

/* Of a pin that is wired, its place among what gates and comparators say. */
static int source_of(const struct dalcs_audit_gates *a, const struct dalcs_logic_input *input) {
    return input->from == DALCS_GATE_GATE ? input->index
                                          : a->circuit->control.n_gates + input->index;
}

enum dalcs_status audit_gates_list_sources(struct dalcs_audit_gates *a) {
    const struct dalcs_circuit *c = a->circuit;
    size_t n = 0;
    for (int k = 0; k < c->control.n_gates; k++) {
        n += (size_t)c->control.gate[k].n_inputs;
    }
    a->says =
        dalcs_alloc((size_t)(c->control.n_gates + c->control.n_comparators), sizeof(*a->says));
    int *next = a->source = dalcs_alloc(n + 1, sizeof(*a->source));
    if (a->says == NULL || next == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < c->control.n_gates; k++) {
        struct audit_gate *s = &a->gate[k];
        s->source = next;
        for (int i = 0; i < c->control.gate[k].n_inputs; i++) {
            if (c->control.gate[k].input[i].from != DALCS_GATE_OPEN) {
                *next++ = source_of(a, &c->control.gate[k].input[i]);
            }
        }
        s->n_sources = (int)(next - s->source);
    }
    return DALCS_OK;
}

/* In the source that shows q or its complement: the last level that was written. */
static bool shows(const struct dalcs_audit_gates *a, const struct dalcs_logic_gate *g) {
    const int pin = audit_gate_shown_by(g);
    const struct dalcs_stimulus *s = pin >= 0 ? &a->circuit->stimulus[pin] : NULL;
    return s != NULL &&
           (s->u.pwl.v[s->u.pwl.n - 1] > 0.5 * (g->low + g->high)) == (g->output[0] >= 0);
}

/* Is each pin at its level of the bit that the first one shows? */
static bool are_levels(const struct dalcs_audit_gates *a, const struct dalcs_logic_gate *g,
                       bool says) {
    bool are = true;
    for (int pin = 0; pin < 2 && g->kind != DALCS_GATE_SAMPLE; pin++) {
        if (g->output[pin] >= 0) {
            const struct dalcs_stimulus *s = &a->circuit->stimulus[g->output[pin]];
            are = are && s->u.pwl.v[s->u.pwl.n - 1] == (says == (pin == 0) ? g->high : g->low);
        }
    }
    return are;
}

bool audit_gate_is_written(const struct dalcs_audit_gates *a, int k) {
    const struct dalcs_logic_gate *g = &a->circuit->control.gate[k];
    bool is = are_levels(a, g, a->says[k]);
    for (int pin = 0; pin < 2; pin++) {
        const struct dalcs_stimulus *s =
            g->output[pin] >= 0 ? &a->circuit->stimulus[g->output[pin]] : NULL;
        if (s != NULL && s->u.pwl.n > 1) {
            const double *t = &s->u.pwl.t[s->u.pwl.n - 2];
            const double *v = &s->u.pwl.v[s->u.pwl.n - 2];
            const double whole = v[1] == g->high ? g->rise : g->fall;
            const double lasts = whole * fabs(v[1] - v[0]) / (g->high - g->low);
            is = is && !(fabs(t[1] - t[0] - lasts) > 4.0 * a->radau->resolution);
        }
    }
    return is;
}

bool audit_gates_read(struct dalcs_audit_gates *a) {
    const struct dalcs_circuit *c = a->circuit;
    bool differs = false;
    for (int k = 0; k < c->control.n_gates; k++) {
        const bool says = shows(a, &c->control.gate[k]);
        differs = differs || says != a->says[k];
        a->says[k] = says;
    }
    for (int k = 0; k < c->control.n_comparators; k++) {
        const struct dalcs_logic_place *p = &a->place[k];
        const bool says = dalcs_osnsp_is_on(&a->radau->part[p->part].component->osnsp, p->pair);
        differs = differs || says != a->says[c->control.n_gates + k];
        a->says[c->control.n_gates + k] = says;
    }
    return differs;
}

bool audit_gate_reads(const struct dalcs_audit_gates *a, const struct dalcs_logic_input *input,
                      bool *is_known) {
    const bool is_wired = input->from != DALCS_GATE_OPEN;
    const bool is_shown = input->from != DALCS_GATE_GATE ||
                          audit_gate_shown_by(&a->circuit->control.gate[input->index]) >= 0;
    *is_known = *is_known && is_shown;
    return (is_wired && a->says[source_of(a, input)]) != input->is_inverted;
}

bool audit_gate_reads_another(const struct dalcs_audit_gates *a, int k) {
    struct audit_gate *s = &a->gate[k];
    const bool showed = s->showed;
    const unsigned before = s->read;
    s->showed = a->says[k];
    s->read = 0;
    for (int i = 0; i < s->n_sources && i < AUDIT_GATE_BITS; i++) {
        s->read |= (a->says[s->source[i]] ? 1u : 0u) << i;
    }
    return s->showed != showed || s->read != before;
}

/* audit_delays.c - signals are read now and then, and read again where their delayed sources put them out. What the run
 * keeps of them (history.h) has no part in it. */
#include "audit_delays.h"

#include "history.h"
#include "readout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct audit_delay {
    int device; /* the source */
    int input;  /* node, against ground */
    int system; /* of both */
    double seconds;
    size_t first, n, capacity;

    struct audit_delay_sample {
        double due, value; /* s, V */
    } * sample;            /* [n] by time; those before `first` have been compared */
};

static int source_of(const struct dalcs_circuit *c, const struct dalcs_history *history) {
    int device = -1;
    for (int d = 0; d < c->n_devices && device < 0; d++) {
        const int stimulus = c->device[d].kind == DALCS_VSOURCE ? c->device[d].stimulus : -1;
        const bool is_delayed =
            stimulus >= 0 && c->stimulus[stimulus].kind == DALCS_STIMULUS_DELAYED;
        device = is_delayed && c->stimulus[stimulus].u.history == history ? d : -1;
    }
    return device;
}

enum dalcs_status dalcs_audit_delays_start(struct dalcs_audit_delays *a,
                                           const struct dalcs_circuit *circuit,
                                           struct dalcs_radau *radau,
                                           const struct dalcs_readout *readout) {
    *a = (struct dalcs_audit_delays){.circuit = circuit, .radau = radau, .readout = readout};
    if (circuit->control.n_delayed == 0) {
        return DALCS_OK;
    }
    a->delay = dalcs_alloc((size_t)circuit->control.n_delayed, sizeof(*a->delay));
    if (a->delay == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < circuit->control.n_delayed; k++) {
        const struct dalcs_delayed *d = &circuit->control.delayed[k];
        const int device = source_of(circuit, d->history);
        a->delay[k] = (struct audit_delay){
            .device = device,
            .input = circuit->results.signal[circuit->results.measured[d->signal]].node[0],
            .system = readout->device_system[device],
            .seconds = d->history->delay};
    }
    return DALCS_OK;
}

void dalcs_audit_delays_finish(struct dalcs_audit_delays *a) {
    for (int k = 0; a->delay != NULL && k < a->circuit->control.n_delayed; k++) {
        free(a->delay[k].sample);
    }
    free(a->delay);
    *a = (struct dalcs_audit_delays){0};
}

static double potential(const struct dalcs_audit_delays *a, const struct audit_delay *d, int node) {
    const int column = node != 0 ? a->readout->node_column[node] : -1;
    return column >= 0 ? a->radau->part[d->system].component->y[column] : 0.0;
}

static enum dalcs_status add(struct audit_delay *d, double due, double value) {
    if (2 * d->first > d->capacity) {
        d->n -= d->first;
        memmove(d->sample, d->sample + d->first, d->n * sizeof(*d->sample));
        d->first = 0;
    }
    DALCS_TRY(dalcs_grow(&d->sample, &d->capacity, d->n + 1, sizeof(*d->sample)));
    d->sample[d->n++] = (struct audit_delay_sample){due, value};
    return DALCS_OK;
}

static void compare(struct dalcs_audit_delays *a, struct dalcs_audit *audit, struct audit_delay *d,
                    double to) {
    const struct dalcs_radau_part *part = &a->radau->part[d->system];
    const int *node = a->circuit->device[d->device].node;
    for (; d->first < d->n && d->sample[d->first].due <= to; d->first++) {
        const struct audit_delay_sample *s = &d->sample[d->first];
        if (s->due < part->segment.t || dalcs_segment_is_coarse(part)) {
            continue;
        }
        dalcs_radau_read(a->radau, d->system, s->due, DALCS_LEFT);
        const double now = potential(a, d, node[0]) - potential(a, d, node[1]);
        const double scale = fmax(part->scales.unit[0], fabs(s->value));
        dalcs_audit_add(audit, DALCS_AUDIT_BRANCH, d->device,
                        scale > 0.0 ? fabs(now - s->value) / scale : 0.0, s->due);
    }
}

enum dalcs_status dalcs_audit_delays_leave(struct dalcs_audit_delays *a, struct dalcs_audit *audit,
                                           int part, double to, bool samples, double at) {
    for (int k = 0; a->delay != NULL && k < a->circuit->control.n_delayed; k++) {
        struct audit_delay *d = &a->delay[k];
        const struct dalcs_radau_part *p = &a->radau->part[part];
        if (d->system != part) {
            continue;
        }
        compare(a, audit, d, to);
        if (samples && !dalcs_segment_is_coarse(p)) {
            const double t = p->segment.t + at * (to - p->segment.t);
            dalcs_radau_read(a->radau, part, t, DALCS_LEFT);
            DALCS_TRY(add(d, t + d->seconds, potential(a, d, d->input)));
        }
    }
    return DALCS_OK;
}

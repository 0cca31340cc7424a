/* rows.c - is what a row has of each signal what the waveform has there? Rows are read from the same polynomials another
 * way (src/rows), so that they differ by rounding alone. */
#include "audit_internal.h"

/* Whose signal it is; -1: of no part. */
static int owner_of(const struct dalcs_audit *audit, const struct dalcs_signal *signal) {
    const int *node = signal->kind == DALCS_SIGNAL_CURRENT
                          ? audit->circuit->device[signal->device].node
                          : signal->node;
    const int own = audit->net.owner[audit->net.node_of[node[0]]];
    return own >= 0 ? own : audit->net.owner[audit->net.node_of[node[1]]];
}

static void check_signal(struct dalcs_audit *audit, int index, double value) {
    const struct dalcs_signal *signal = &audit->circuit->signal[index];
    const struct dalcs_audit_state *s = &audit->now;
    const int own = owner_of(audit, signal);
    if (own < 0) {
        return;
    }
    const struct audit_part *part = &audit->part[own];
    if (signal->kind == DALCS_SIGNAL_VOLTAGE) {
        const double *v = s->v;
        const int *node = signal->node;
        if (!audit->net.is_read[node[0]] || !audit->net.is_read[node[1]]) {
            return; /* behind a short, of which no part is */
        }
        const double is = v[node[0]] - v[node[1]];
        audit_find(audit, part, DALCS_AUDIT_ROW, index,
                   fabs(value - is) - AUDIT_ROUNDING * (fabs(v[node[0]]) + fabs(v[node[1]])),
                   audit_volts(audit, part, node[0], node[1]), s->t);
        return;
    }
    const struct dalcs_device *d = &audit->circuit->device[signal->device];
    if (d->kind == DALCS_CAPACITOR) {
        return; /* a derivative */
    }
    const double is = audit_current(audit, s, signal->device);
    const double g = d->kind == DALCS_RESISTOR && d->value != 0.0 ? fabs(1.0 / d->value) : 0.0;
    const double volts = fabs(s->v[d->node[0]]) + fabs(s->v[d->node[1]]);
    audit_find(audit, part, DALCS_AUDIT_ROW, index,
               fabs(value - is) - AUDIT_ROUNDING * (g * volts + fabs(is)),
               audit_amperes(audit, part, signal->device), s->t);
}

void dalcs_audit_row(struct dalcs_audit *audit, double t, enum dalcs_side side,
                     const double *value) {
    struct dalcs_audit_state *s = &audit->now;
    s->t = t;
    s->side = side;
    for (int k = 0; k < audit->options.n_parts; k++) {
        audit->part[k].at.is_coarse = false; /* a row shows what is there, however near that is */
        audit->reader.read(audit->reader.user, k, s);
        audit->reader.raise(audit->reader.user, k, audit->scale.v, audit->scale.i,
                            audit->scale.lambda);
        audit_note_scales(audit, &audit->part[k], s);
    }
    for (int k = 0; k < audit->circuit->n_signals; k++) {
        check_signal(audit, k, value[k]);
    }
}

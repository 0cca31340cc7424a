/* signals.c - signals, and formulas of them, as the auditor reads them. */
#include "audit_currents.h"

#include "claims.h"

/* Whose signal it is; -1: of no part. */
static int owner_of(const struct dalcs_audit *audit, const struct dalcs_signal *signal) {
    const int *node = signal->kind == DALCS_SIGNAL_CURRENT
                          ? audit->circuit->device[signal->device].node
                          : signal->node;
    const int own = audit->net.owner[audit->net.node_of[node[0]]];
    return own >= 0 ? own : audit->net.owner[audit->net.node_of[node[1]]];
}

int dalcs_audit_part_of(const struct dalcs_audit *audit, int index) {
    const struct dalcs_signal *signal = &audit->circuit->results.signal[index];
    if (audit->options.n_parts == 0) {
        return -1;
    }
    if (signal->kind == DALCS_SIGNAL_CURRENT) {
        return audit->circuit->device[signal->device].kind == DALCS_CAPACITOR
                   ? -1
                   : owner_of(audit, signal);
    }
    /* one behind a short is of no part */
    const bool is_there =
        audit->net.is_read[signal->node[0]] && audit->net.is_read[signal->node[1]];
    return is_there ? owner_of(audit, signal) : -1;
}

double audit_signal_value(const struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                          int index, struct audit_signal *of) {
    const struct dalcs_signal *signal = &audit->circuit->results.signal[index];
    const struct audit_part *part = &audit->part[dalcs_audit_part_of(audit, index)];
    if (signal->kind == DALCS_SIGNAL_VOLTAGE) {
        const int *node = signal->node;
        of->scale = audit_volts(audit, part, node[0], node[1]);
        of->rounding = AUDIT_ROUNDING * (fabs(s->v[node[0]]) + fabs(s->v[node[1]]));
        return s->v[node[0]] - s->v[node[1]];
    }
    of->scale = audit_amperes(audit, part, signal->device);
    of->rounding = audit_current_rounding(audit, s, signal->device);
    return audit_current(audit, s, signal->device);
}

double dalcs_audit_signal(struct dalcs_audit *audit, int index, double t, enum dalcs_side side,
                          double *doubt) {
    struct dalcs_audit_state *s = &audit->state.asked;
    const int own = dalcs_audit_part_of(audit, index);
    struct audit_part *part = &audit->part[own];
    if (!(part->asked_at == t && part->asked_side == side)) {
        s->t = t;
        s->side = side;
        audit->reader.read(audit->reader.user, own, s);
        part->asked_at = t;
        part->asked_side = side;
    }
    struct audit_signal of;
    const double value = audit_signal_value(audit, s, index, &of);
    /* where a polynomial is small beside what it is elsewhere, that is what rounds it */
    *doubt = fmax(of.rounding, AUDIT_ROUNDING * of.scale);
    return value;
}

double dalcs_audit_signal_scale(const struct dalcs_audit *audit, int index) {
    const struct dalcs_signal *signal = &audit->circuit->results.signal[index];
    const int own = dalcs_audit_part_of(audit, index);
    if (own < 0) {
        return 0.0;
    }
    return signal->kind == DALCS_SIGNAL_VOLTAGE
               ? audit_volts(audit, &audit->part[own], signal->node[0], signal->node[1])
               : audit_amperes(audit, &audit->part[own], signal->device);
}

void dalcs_audit_forget_asked(struct dalcs_audit *audit) {
    for (int k = 0; k < audit->options.n_parts; k++) {
        audit->part[k].asked_at = -1.0;
    }
}

/* ---- Formulas ------------------------------------------------------------------------------------ */

struct asked {
    struct dalcs_audit *audit;
    double t;
    enum dalcs_side side;
    int bumped; /* the measured signal that is off by its doubt; -1: none is */
};

static double signal_at(const struct dalcs_signal_formula_point *point, int index,
                        enum dalcs_signal_part part) {
    (void)part; /* signals over time are real */
    const struct asked *a = point->user;
    double doubt;
    const double value = dalcs_audit_signal(a->audit, a->audit->circuit->results.measured[index],
                                            a->t, a->side, &doubt);
    return index == a->bumped ? value + doubt : value;
}

/* Does a step before this one put the same signal there? */
static bool was_put(const struct dalcs_signal_formula *formula, int step) {
    bool was = false;
    for (int k = 0; k < step && !was; k++) {
        was = formula->step[k].push == DALCS_PUT_SIGNAL &&
              formula->step[k].index == formula->step[step].index;
    }
    return was;
}

double dalcs_audit_formula(struct dalcs_audit *audit, const struct dalcs_signal_formula *formula,
                           double t, enum dalcs_side side, const double *result, double *doubt) {
    struct asked a = {audit, t, side, -1};
    const struct dalcs_signal_formula_point point = {
        .time = t, .user = &a, .signal = signal_at, .result = result};
    const double value = dalcs_signal_formula_value(formula, &point);
    if (doubt == NULL) {
        return value;
    }
    *doubt = AUDIT_ROUNDING * fabs(value);
    for (int k = 0; k < formula->n; k++) {
        if (formula->step[k].push == DALCS_PUT_SIGNAL && !was_put(formula, k)) {
            a.bumped = formula->step[k].index;
            const double off = fabs(dalcs_signal_formula_value(formula, &point) - value);
            *doubt += off >= 0.0 ? off : INFINITY; /* it has no value so near */
        }
    }
    return value;
}

/* findings.c - the worst that was found of each law, and its name. */
#include "audit_internal.h"

#include <stdio.h>

int dalcs_audit_n_of(const struct dalcs_audit *audit, enum dalcs_audit_law law) {
    switch (law) {
    case DALCS_AUDIT_KCL:
        return audit->circuit->n_nodes;
    case DALCS_AUDIT_ENERGY:
    case DALCS_AUDIT_PERIOD:
        return audit->options.n_parts;
    case DALCS_AUDIT_ROW:
        return audit->circuit->n_signals;
    case DALCS_AUDIT_MEASURE:
        return audit->circuit->n_measures;
    case DALCS_AUDIT_FOURIER:
        return audit->circuit->n_fouriers;
    default:
        return audit->circuit->n_devices;
    }
}

/* At ends of coarse stretches the worst of all. */
static void find_coarse(struct audit_coarse *coarse, enum dalcs_audit_law law, int index,
                        double ratio, double time) {
    if (!(ratio <= coarse->defect)) {
        *coarse = (struct audit_coarse){isnan(ratio) ? INFINITY : ratio, time, law, index};
    }
}

void audit_find(struct dalcs_audit *audit, const struct audit_part *part, enum dalcs_audit_law law,
                int index, double defect, double scale, double time) {
    const double ratio = audit_ratio(defect, scale);
    if (part->at.is_coarse) {
        find_coarse(&audit->coarse, law, index, ratio, time);
        return;
    }
    struct audit_worst *worst = &audit->worst_of[law][index];
    worst->part = (int)(part - audit->part);
    if (!(ratio <= worst->defect)) { /* not a number is as wrong as can be */
        worst->defect = isnan(ratio) ? INFINITY : ratio;
        worst->time = time;
    }
}

struct dalcs_audit_finding dalcs_audit_finding_of(const struct dalcs_audit *audit,
                                                  enum dalcs_audit_law law, int index) {
    const struct audit_worst *worst = &audit->worst_of[law][index];
    return (struct dalcs_audit_finding){worst->defect, worst->time};
}

struct dalcs_audit_summary dalcs_audit_summarise(const struct dalcs_audit *audit) {
    struct dalcs_audit_summary sum = audit->count;
    sum.index = -1;
    for (int law = 0; law < DALCS_AUDIT_N_LAWS && audit->options.n_parts > 0; law++) {
        for (int i = 0; i < dalcs_audit_n_of(audit, law); i++) {
            const struct dalcs_audit_finding f = dalcs_audit_finding_of(audit, law, i);
            const double allowed = audit->part[audit->worst_of[law][i].part].tolerance;
            const bool is_broken = f.defect > audit->options.failure;
            const bool is_worse = f.defect * sum.allowed > sum.defect * allowed;
            if (sum.index < 0 || is_broken > sum.is_broken ||
                (is_broken == sum.is_broken && is_worse)) {
                sum.is_broken = is_broken;
                sum.defect = f.defect;
                sum.allowed = allowed;
                sum.time = f.time;
                sum.law = law;
                sum.index = i;
            }
        }
    }
    return sum;
}

struct dalcs_audit_summary dalcs_audit_summarise_coarse(const struct dalcs_audit *audit) {
    struct dalcs_audit_summary sum = audit->count;
    sum.index = audit->coarse.defect > 0.0 ? audit->coarse.index : -1;
    sum.defect = audit->coarse.defect;
    sum.time = audit->coarse.time;
    sum.law = audit->coarse.law;
    return sum;
}

void dalcs_audit_law_name(const struct dalcs_audit *audit, enum dalcs_audit_law law, int index,
                          char *text, size_t size) {
    const struct dalcs_circuit *c = audit->circuit;
    switch (law) {
    case DALCS_AUDIT_KCL:
        snprintf(text, size, "KCL at %s", c->node_name[index]);
        break;
    case DALCS_AUDIT_BRANCH:
        snprintf(text, size, "%s", c->device[index].name);
        break;
    case DALCS_AUDIT_CURRENT:
        snprintf(text, size, "i(%s)", c->device[index].name);
        break;
    case DALCS_AUDIT_POSITION:
        snprintf(text, size, "position of %s", c->device[index].name);
        break;
    case DALCS_AUDIT_ENERGY:
        snprintf(text, size, "the energy balance");
        break;
    case DALCS_AUDIT_ROW:
        snprintf(text, size, "the rows of %s", c->signal[index].name);
        break;
    case DALCS_AUDIT_MEASURE:
        snprintf(text, size, ".meas %s", c->measure[index].name);
        break;
    case DALCS_AUDIT_FOURIER:
        snprintf(text, size, ".four %s", c->fourier[index].formula.text);
        break;
    case DALCS_AUDIT_LOSSES:
        snprintf(text, size, ".losses of %s", c->device[index].name);
        break;
    case DALCS_AUDIT_EVENT:
        snprintf(text, size, "events of %s", c->device[index].name);
        break;
    case DALCS_AUDIT_JUMP:
        snprintf(text, size, "jumps of %s", c->device[index].name);
        break;
    default:
        snprintf(text, size, "periods leapt over");
        break;
    }
}

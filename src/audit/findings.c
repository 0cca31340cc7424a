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

static void keep_if_worse(struct audit_found *kept, const struct audit_found *found, double is,
                          double was) {
    if (is > was) {
        *kept = *found;
    }
}

void audit_find(struct dalcs_audit *audit, const struct audit_part *part, enum dalcs_audit_law law,
                int index, double defect, double scale, double time) {
    const double off = isnan(defect) || isnan(scale) ? INFINITY : defect; /* as wrong as can be */
    const double ratio = audit_ratio(off, scale);
    if (part->at.is_coarse) {
        find_coarse(&audit->coarse, law, index, ratio, time);
        return;
    }
    const struct audit_found found = {off, scale, time, part->at.duration};
    struct audit_worst *worst = &audit->worst_of[law][index];
    worst->part = (int)(part - audit->part);
    worst->scale = fmax(worst->scale, scale);
    keep_if_worse(&worst->largest, &found, off, worst->largest.defect);
    keep_if_worse(&worst->beside_scale, &found, ratio,
                  audit_ratio(worst->beside_scale.defect, worst->beside_scale.scale));
}

/* A signal below this part of the largest of its unit is held to that (doc/methods.md, "What the tolerance means"), and so is
 * one to what it becomes. At the very start transients that are shorter than any step are taken at once: leaks behind coils,
 * above all. What that makes is held to what becomes of it. */
static double over_scale(const struct dalcs_audit *audit, enum dalcs_audit_law law, int index,
                         const struct audit_found *found) {
    const struct audit_worst *worst = &audit->worst_of[law][index];
    const double becomes =
        audit_is_of_storage(audit, law, index)
            ? audit_storage_scale(audit, &audit->part[worst->part], law, index, found->duration)
            : worst->scale;
    const double least = found->time == 0.0 ? 1.0 : AUDIT_NOTHING;
    return audit_ratio(found->defect, fmax(found->scale, least * becomes));
}

struct dalcs_audit_finding dalcs_audit_finding_of(const struct dalcs_audit *audit,
                                                  enum dalcs_audit_law law, int index) {
    const struct audit_worst *worst = &audit->worst_of[law][index];
    if (!(worst->largest.defect > 0.0)) {
        return (struct dalcs_audit_finding){0.0, worst->largest.time};
    }
    const double largest = over_scale(audit, law, index, &worst->largest);
    const double beside_scale = over_scale(audit, law, index, &worst->beside_scale);
    return beside_scale > largest
               ? (struct dalcs_audit_finding){beside_scale, worst->beside_scale.time}
               : (struct dalcs_audit_finding){largest, worst->largest.time};
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

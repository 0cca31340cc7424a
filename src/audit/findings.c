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
        return audit->circuit->results.n_signals;
    case DALCS_AUDIT_MEASURE:
        return audit->circuit->results.n_measures;
    case DALCS_AUDIT_FOURIER:
        return audit->circuit->results.n_fouriers;
    default:
        return audit->circuit->n_devices;
    }
}

static void find_coarse(struct dalcs_audit *audit, enum dalcs_audit_law law, int index,
                        double defect, double time) {
    if (!(defect <= audit->coarse.defect)) {
        audit->coarse.defect = isnan(defect) ? INFINITY : defect;
        audit->coarse.time = time;
        audit->coarse.law = law;
        audit->coarse.index = index;
    }
}

static void note(struct audit_worst *worst, double defect, double scale, double time) {
    worst->scale = fmax(worst->scale, scale);
    if (!(defect <= worst->defect)) { /* not a number is as wrong as can be */
        worst->defect = isnan(defect) ? INFINITY : defect;
        worst->time = time;
    }
}

void audit_find(struct dalcs_audit *audit, const struct audit_part *part, enum dalcs_audit_law law,
                int index, double defect, double scale, double time) {
    if (part->at.is_coarse) {
        find_coarse(audit, law, index, audit_ratio(defect, scale), time);
        return;
    }
    audit->worst_of[law][index].part = (int)(part - audit->part);
    note(&audit->worst_of[law][index], defect, scale, time);
}

/* Is it found without what corners may be off by? Then it is asked again. */
static bool waits(struct dalcs_audit *audit, const struct audit_part *part, double defect,
                  double scale) {
    const bool does =
        audit->crossing.is_first_try && !(audit_ratio(defect, scale) <= part->tolerance);
    audit->crossing.holds = audit->crossing.holds && !does;
    return does;
}

void audit_find_charge(struct dalcs_audit *audit, const struct audit_part *part, int node,
                       double defect, double scale, double time) {
    if (!waits(audit, part, defect, scale)) {
        audit_find(audit, part, DALCS_AUDIT_KCL, node, defect, scale, time);
    }
}

void audit_find_flux(struct dalcs_audit *audit, const struct audit_part *part, int device,
                     double defect, double scale, double time) {
    if (waits(audit, part, defect, scale)) {
        return;
    }
    if (part->at.is_coarse) {
        find_coarse(audit, DALCS_AUDIT_BRANCH, device, audit_ratio(defect, scale), time);
        return;
    }
    audit->worst_of[DALCS_AUDIT_BRANCH][device].part = (int)(part - audit->part);
    note(&audit->flux[device], defect, scale, time);
}

/* Of what a coil's flux jumped by where it should not, and what passed a diode forward; the scale of a coil is that of the
 * largest current so far. */
static struct dalcs_audit_finding finding_of_flux(const struct dalcs_audit *audit, int device) {
    const struct audit_worst *worst = &audit->flux[device];
    const struct audit_part *part = &audit->part[audit->worst_of[DALCS_AUDIT_BRANCH][device].part];
    const bool is_coil = audit->circuit->device[device].kind == DALCS_INDUCTOR;
    const double own = worst->defect > 0.0 && is_coil ? audit_flux_scale(audit, part, device) : 0.0;
    const double scale = fmax(worst->scale, own);
    return (struct dalcs_audit_finding){audit_ratio(worst->defect, scale), worst->time};
}

struct dalcs_audit_finding dalcs_audit_finding_of(const struct dalcs_audit *audit,
                                                  enum dalcs_audit_law law, int index) {
    const struct audit_worst *worst = &audit->worst_of[law][index];
    struct dalcs_audit_finding found = {audit_ratio(worst->defect, worst->scale), worst->time};
    if (law == DALCS_AUDIT_BRANCH) {
        const struct dalcs_audit_finding of_flux = finding_of_flux(audit, index);
        found = of_flux.defect > found.defect ? of_flux : found;
    }
    return found;
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
                sum.stays = audit->worst_of[law][i].stays;
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
        snprintf(text, size, "the rows of %s", c->results.signal[index].name);
        break;
    case DALCS_AUDIT_MEASURE:
        snprintf(text, size, ".meas %s", c->results.measure[index].name);
        break;
    case DALCS_AUDIT_FOURIER:
        snprintf(text, size, ".four %s", c->results.fourier[index].formula.text);
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

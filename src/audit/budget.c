/* budget.c - what looks cost, and whether a run can afford one. */
#include "audit_internal.h"

/* Instructions of an instant and a device, a node: measured with callgrind on the netlists of the repository
 * (doc/testing.md). */
static const double device_work = 300.0, node_work = 120.0;

/* Of switches, whose controls are read, and sources, whose edges are looked for. */
static const double moving_work = 1800.0;

/* Of a coupling, for all coils of which fluxes are added up. */
static const double coupling_work = 1200.0;

double audit_instant_work(const struct dalcs_circuit *c, const struct audit_part *part) {
    double work = node_work * part->n_nodes + coupling_work * part->n_couplings;
    for (int k = 0; k < part->n_devices; k++) {
        const struct dalcs_device *d = &c->device[part->device[k]];
        const bool moves =
            d->kind == DALCS_SWITCH ||
            (d->kind == DALCS_VSOURCE && c->stimulus[d->stimulus].kind != DALCS_STIMULUS_DC);
        work += moves ? moving_work : device_work;
    }
    return work;
}

bool audit_is_drawn(struct dalcs_audit *audit, double cost) {
    if (audit->options.mode == DALCS_AUDIT_FULL) {
        return true;
    }
    if (audit->budget.credit < audit->budget.threshold) {
        return false;
    }
    audit->budget.threshold = 2.0 * cost * audit_draw(audit);
    return true;
}

bool dalcs_audit_may(struct dalcs_audit *audit, double work) {
    const bool may = audit_is_drawn(audit, work);
    audit->budget.credit -= may ? work : 0.0;
    return may;
}

double dalcs_audit_chance(struct dalcs_audit *audit) {
    return audit_draw(audit);
}

void dalcs_audit_add(struct dalcs_audit *audit, enum dalcs_audit_law law, int index, double defect,
                     double time) {
    audit->part[index].at.is_coarse = false; /* what the last look was at is no matter here */
    audit_find(audit, &audit->part[index], law, index, defect, 1.0, time);
}

void dalcs_audit_add_position(struct dalcs_audit *audit, int device, double defect, double time) {
    audit->part[0].at.is_coarse = false;
    audit_find(audit, &audit->part[0], DALCS_AUDIT_POSITION, device, defect, 1.0, time);
}

void dalcs_audit_earn(struct dalcs_audit *audit, double work) {
    audit->budget.credit += audit_earned(audit, work, audit->budget.spent);
    audit->budget.spent = 0.0;
}

/* budget.c - what looks cost, and whether a run can afford one. */
#include "audit_internal.h"

/* Instructions of an instant for each device, besides those of reading the state: measured with callgrind on the netlists of
 * the repository, 550 to 640 (doc/testing.md). */
static const double device_work = 600.0;

double audit_instant_work(const struct audit_part *part) {
    return device_work * part->n_devices;
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

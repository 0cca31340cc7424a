/* audit_leaps.c - leaps over periods are tried, and passed once more. */
#include "audit_reader.h"

#include "cycle.h"

#include <math.h>
#include <string.h>

enum { TRIED_PERIODS = 3 };

enum dalcs_status dalcs_audit_run_leap(struct dalcs_audit_run *a, double until, bool *may) {
    const struct dalcs_radau_part *part = a->radau->cycling;
    *may = a->tried_time == INFINITY;
    if (a->audit == NULL || !*may || a->was_tried) {
        a->was_tried = false;
        return DALCS_OK;
    }
    const double work = TRIED_PERIODS * dalcs_cycle_n_segments(part->cycle) * dalcs_audit_segment_work;
    if (!dalcs_audit_may(a->audit, work) && a->has_tried) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_cycle_try(a->radau, until, TRIED_PERIODS, a->tried, &a->tried_time));
    *may = a->tried_time == INFINITY;
    a->has_tried |= !*may;
    return DALCS_OK;
}

/* How far the states of the cycling part are from x, over their scales. */
static double distance(const struct dalcs_radau_part *part, const double *x) {
    double worst = 0.0;
    for (int k = 0; k < part->component->system->n_x; k++) {
        const double off = fabs(x[k] - part->x[k]);
        worst = off > worst * part->scale[k] ? off / part->scale[k] : worst;
    }
    return worst;
}

void dalcs_audit_run_start_leap(struct dalcs_audit_run *a) {
    const struct dalcs_radau_part *part = a->radau->cycling;
    if (a->audit != NULL) {
        memcpy(a->tried, part->x, (size_t)part->component->system->n_x * sizeof(double));
        a->leap_time = part->t;
    }
}

void dalcs_audit_run_end_leap(struct dalcs_audit_run *a) {
    const struct dalcs_radau_part *part = a->radau->cycling;
    if (a->audit != NULL) {
        dalcs_audit_put_off(a->audit, part->index);
    }
    const int n_x = part->component->system->n_x;
    const double periods = rint((part->t - a->leap_time) / dalcs_cycle_period(part->cycle));
    const double work = 3.0 * n_x * (n_x + 1) * periods;
    if (a->audit != NULL && (dalcs_audit_may(a->audit, work) || !a->has_passed)) {
        a->has_passed = true;
        dalcs_cycle_pass(part, (long)periods, a->tried, a->tried + n_x);
        dalcs_audit_add(a->audit, DALCS_AUDIT_PERIOD, part->index, distance(part, a->tried),
                        part->t);
    }
}

/* The segment that a leap was tried to has begun, or another one has instead. */
void dalcs_audit_leaps_compare(struct dalcs_audit_run *a) {
    const struct dalcs_radau_part *part = a->radau->cycling;
    const double near = 4.0 * a->radau->resolution;
    if (part == NULL || part->t < a->tried_time - near) {
        return;
    }
    const bool is_other = part->t > a->tried_time + near;
    const double worst = is_other ? 1.0 : distance(part, a->tried);
    dalcs_audit_add(a->audit, DALCS_AUDIT_PERIOD, part->index, worst, part->t);
    a->tried_time = INFINITY;
    a->was_tried = true;
}

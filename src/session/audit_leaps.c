/* audit_leaps.c - leaps over periods are tried, and passed once more. */
#include "audit_reader.h"

#include "cycle.h"

#include <math.h>
#include <string.h>

enum { TRIED_PERIODS = 3 };

/* What a leap passes over holds no longer where its states are others: signs are linear in these. Behind one that took a state
 * by so much of its scale a whole period is stepped, so that all its signs are asked. From rest to where a circuit settles
 * that are a few. */
static const double far = 0.25;

static bool is_on_probation(struct dalcs_audit_run *a) {
    const struct dalcs_radau_part *part = a->radau->cycling;
    const double near = 4.0 * a->radau->resolution;
    if (part->segment.t + near >= a->leaps.landed + dalcs_cycle_period(part->memory.cycle)) {
        a->leaps.landed = INFINITY;
    }
    return a->leaps.landed < INFINITY;
}

enum dalcs_status dalcs_audit_run_leap(struct dalcs_audit_run *a, double until, bool *may) {
    const struct dalcs_radau_part *part = a->radau->cycling;
    *may = a->leaps.tried_time == INFINITY && !(a->audit != NULL && is_on_probation(a));
    if (a->audit == NULL || !*may || a->leaps.was_tried) {
        a->leaps.was_tried = false;
        return DALCS_OK;
    }
    const double work =
        TRIED_PERIODS * dalcs_cycle_n_segments(part->memory.cycle) * dalcs_audit_segment_work;
    if (!dalcs_audit_may(a->audit, work) && a->leaps.has_tried) {
        return DALCS_OK;
    }
    DALCS_TRY(
        dalcs_cycle_try(a->radau, until, TRIED_PERIODS, a->leaps.tried, &a->leaps.tried_time));
    *may = a->leaps.tried_time == INFINITY;
    a->leaps.has_tried |= !*may;
    return DALCS_OK;
}

/* How far the states of the cycling part are from x, over their scales. */
static double distance(const struct dalcs_radau_part *part, const double *x) {
    double worst = 0.0;
    for (int k = 0; k < part->component->system->n_x; k++) {
        const double off = fabs(x[k] - part->x[k]);
        worst = off > worst * part->scales.column[k] ? off / part->scales.column[k] : worst;
    }
    return worst;
}

void dalcs_audit_run_start_leap(struct dalcs_audit_run *a) {
    const struct dalcs_radau_part *part = a->radau->cycling;
    if (a->audit != NULL) {
        dalcs_audit_run_settle(a, part->index);
        memcpy(a->leaps.tried, part->x, (size_t)part->component->system->n_x * sizeof(double));
        a->leaps.began = part->segment.t;
        if (!a->leaps.has_passed) {
            memcpy(a->leaps.passed, part->x, (size_t)part->component->system->n_x * sizeof(double));
        }
    }
}

/* map is applied to that of `to`, into work, which both have [n][n + 1] of. */
static void compose(int n, const double *map, const double *to, double *work) {
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= n; j++) {
            double sum = j == n ? map[i * (n + 1) + n] : 0.0;
            for (int k = 0; k < n; k++) {
                sum += map[i * (n + 1) + k] * to[k * (n + 1) + j];
            }
            work[i * (n + 1) + j] = sum;
        }
    }
}

static void apply(int n, const double *map, double *x, double *work) {
    for (int i = 0; i < n; i++) {
        work[i] = map[i * (n + 1) + n];
        for (int k = 0; k < n; k++) {
            work[i] += map[i * (n + 1) + k] * x[k];
        }
    }
    memcpy(x, work, (size_t)n * sizeof(double));
}

/* x[n] goes so many periods on. By squares of the map (D. E. Knuth, The Art of Computer Programming 2, sec. 4.6.3), not
 * one by one as the leap went. */
static void go_on(int n, const double *map, long periods, double *x, double *work) {
    double *square = work + n;
    double *next = square + n * (n + 1);
    memcpy(square, map, (size_t)(n * (n + 1)) * sizeof(double));
    for (long left = periods; left > 0; left /= 2) {
        if (left % 2 == 1) {
            apply(n, square, x, work);
        }
        if (left > 1) {
            compose(n, square, square, next);
            memcpy(square, next, (size_t)(n * (n + 1)) * sizeof(double));
        }
    }
}

/* Instructions, about, of a product and its sum; and of a period that is leapt over, for each element of its map. */
static const double product_work = 5.0, leapt_work = 2.0;

/* A leap takes some thousand instructions, whatever it leads over: so many more, and each is looked at. */
static const double small_work = 3000.0;

void dalcs_audit_run_end_leap(struct dalcs_audit_run *a) {
    const struct dalcs_radau_part *part = a->radau->cycling;
    if (a->audit == NULL) {
        return;
    }
    dalcs_audit_put_off(a->audit, part->index);
    const int n_x = part->component->system->n_x;
    if (distance(part, a->leaps.passed) > far) {
        a->leaps.landed = part->segment.t;
        memcpy(a->leaps.passed, part->x, (size_t)n_x * sizeof(double));
    }
    const double elements = (double)n_x * (n_x + 1);
    const double periods =
        rint((part->segment.t - a->leaps.began) / dalcs_cycle_period(part->memory.cycle));
    const double work = product_work * elements * (n_x + 1) * (1.0 + log2(fmax(periods, 1.0)));
    dalcs_audit_earn(a->audit, leapt_work * elements * periods);
    if (work <= small_work || dalcs_audit_may(a->audit, work) || !a->leaps.has_passed) {
        a->leaps.has_passed = true;
        go_on(n_x, dalcs_cycle_map(part), (long)periods, a->leaps.tried, a->leaps.tried + n_x);
        dalcs_audit_add(a->audit, DALCS_AUDIT_PERIOD, part->index, distance(part, a->leaps.tried),
                        part->segment.t);
    }
}

/* Instructions of the segment that a leap lands in, and of another leap from there. */
static const double landing_work = 10000.0;

double dalcs_audit_run_until(struct dalcs_audit_run *a, double until) {
    const struct dalcs_radau_part *part = a->radau->cycling;
    if (a->audit == NULL) {
        return until;
    }
    /* so that there is one behind the last leap of all */
    const double last = a->radau->options.stop - dalcs_cycle_period(part->memory.cycle);
    until = until > last && last > part->segment.t ? last : until;
    if (!(until < INFINITY) || !dalcs_audit_may(a->audit, landing_work)) {
        return until;
    }
    return part->segment.t + dalcs_audit_chance(a->audit) * (until - part->segment.t);
}

/* The segment that a leap was tried to has begun, or another one has instead. */
void dalcs_audit_leaps_compare(struct dalcs_audit_run *a) {
    const struct dalcs_radau_part *part = a->radau->cycling;
    const double near = 4.0 * a->radau->resolution;
    if (part == NULL || part->segment.t < a->leaps.tried_time - near) {
        return;
    }
    const bool is_other = part->segment.t > a->leaps.tried_time + near;
    const double worst = is_other ? 1.0 : distance(part, a->leaps.tried);
    dalcs_audit_add(a->audit, DALCS_AUDIT_PERIOD, part->index, worst, part->segment.t);
    a->leaps.tried_time = INFINITY;
    a->leaps.was_tried = true;
}

/* audit_rows.c - rows that are written, against the waveform. */
#include "audit_reader.h"

#include "step_error.h"
#include "transient.h"

#include <math.h>

/* Instructions, about, of what is compared in a row: a signal, and of each device its scales. */
static const double signal_work = 200.0, device_work = 100.0;

/* Instructions of a comparison of all parts and outputs. */
static double checking_work(const struct dalcs_audit_run *a) {
    double work =
        signal_work * a->run->s->network.n_outputs + device_work * a->run->s->circuit.n_devices;
    for (int k = 0; k < a->radau->n_parts; k++) {
        work += dalcs_audit_state_work(a, k);
    }
    for (int i = 0; i < a->n_stepped; i++) {
        const int k = a->stepped[i];
        work += a->radau->part[k].segment.late != NULL ? a->part[k].work.elements : 0.0;
    }
    return work;
}

/* On a step of implicit Euler rows are lines. And a segment may be so
 * short that the resolution of its times is more of it than is allowed of a value. */
static bool is_coarse(const struct dalcs_audit_run *a) {
    const double shortest = 4.0 * a->radau->resolution / dalcs_audit_most_allowed(a);
    bool is = false;
    for (int i = 0; i < a->n_stepped && !is; i++) {
        const struct dalcs_radau_part *part = &a->radau->part[a->stepped[i]];
        is = dalcs_segment_is_coarse(part) || part->segment.t_end - part->segment.t < shortest;
    }
    return is;
}

/* Some of n rows that were handed on are compared with the waveform. */
static void check_rows(struct dalcs_audit_run *a, const struct dalcs_recorder *recorder,
                       const double *time, enum dalcs_side side, int n) {
    const bool is_full = a->run->options->audit == DALCS_AUDIT_FULL;
    struct audit_row_budget *rows = &a->rows.side[side];
    const double work = checking_work(a);
    rows->credit -= work;
    /* also in a run of a few rows: at the latest when as many have come as there were */
    rows->threshold =
        is_full ? -INFINITY
                : fmin(2.0 * work * dalcs_audit_run_chance(a), rows->credit + rows->earned);
    const int first = is_full ? 0 : (int)(dalcs_audit_run_chance(a) * n);
    for (int i = first; i < n && (is_full || i == first); i++) {
        dalcs_audit_row(a->audit, time[i], side, recorder->row + (size_t)i * recorder->n_shown,
                        recorder->n_shown);
    }
}

void dalcs_audit_earn_rows(struct dalcs_audit_run *a) {
    if (a->rows.since > 0.0) {
        dalcs_audit_earn(a->audit, a->rows.since);
        a->rows.since = 0.0;
    }
}

void dalcs_audit_run_rows_now(struct dalcs_audit_run *a, const struct dalcs_recorder *recorder,
                              const double *time, enum dalcs_side side, int n) {
    struct audit_row_budget *rows = &a->rows.side[side];
    if (rows->credit >= rows->threshold) {
        if (is_coarse(a)) {
            rows->credit = rows->threshold; /* the next one may be */
        } else {
            check_rows(a, recorder, time, side, n);
        }
    }
    if (a->has_algebraic) {
        dalcs_audit_earn_rows(a);
    }
    for (int k = 0; a->has_algebraic && k < a->radau->n_parts; k++) {
        if (a->radau->part[k].kind == DALCS_PART_ALGEBRAIC) {
            dalcs_audit_instant(a->audit, k, time[n - 1], side, dalcs_audit_segment_work);
        }
    }
}

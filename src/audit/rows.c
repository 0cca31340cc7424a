/* rows.c - is what a row has of each signal what the waveform has there? Rows are read from the same polynomials another
 * way (src/rows), so that they differ by rounding alone. */
#include "audit_internal.h"

#include "claims.h"

/* Of the tolerance: a row on the right of an event that is so close to the one on its left is made equal to it (rows.h). */
static const double joins = 0.125;

/* ... over a scale that may be that of its unit, as those of diodes that block are; of a current also what the largest
 * conductance makes of a voltage. */
static double largest_of_unit(const struct audit_part *part, const struct dalcs_signal *signal) {
    return signal->kind == DALCS_SIGNAL_VOLTAGE
               ? part->floor.largest_volt
               : fmax(part->floor.ampere / 1e-5, part->floor.most * part->floor.largest_volt);
}

static void check_signal(struct dalcs_audit *audit, int index, double value, bool may_be_joined) {
    const int own = dalcs_audit_part_of(audit, index);
    if (own < 0) {
        return;
    }
    const struct audit_part *part = &audit->part[own];
    struct audit_signal of;
    const double is = audit_signal_value(audit, &audit->state.now, index, &of);
    const double joined = may_be_joined
                              ? joins * audit->options.failure *
                                    largest_of_unit(part, &audit->circuit->results.signal[index])
                              : 0.0;
    audit_find(audit, part, DALCS_AUDIT_ROW, index, fabs(value - is) - of.rounding - joined,
               of.scale, audit->state.now.t);
}

void dalcs_audit_row(struct dalcs_audit *audit, double t, enum dalcs_side side, const double *value,
                     int n) {
    struct dalcs_audit_state *s = &audit->state.now;
    s->t = t;
    s->side = side;
    for (int k = 0; k < audit->options.n_parts; k++) {
        audit->part[k].at.is_coarse = false; /* a row shows what is there, however near that is */
        audit->reader.read(audit->reader.user, k, s);
        audit->reader.raise(audit->reader.user, k, audit->scale.v, audit->scale.i,
                            audit->scale.lambda);
        audit_note_scales(audit, &audit->part[k], s);
    }
    for (int k = 0; k < n; k++) {
        check_signal(audit, k, value[k], side == DALCS_RIGHT);
    }
}

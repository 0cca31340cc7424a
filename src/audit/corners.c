/* corners.c - what the voltage and the current of a diode may be off by just behind a jump.
 *
 * A diode that let charge pass stands at its knee, and one that let flux pass carries nothing. An amplifier may hold it there,
 * and what rounding leaves of the amplifier's control is multiplied by its gain; 16 roundings of 3 V and a gain of 1e8 are 1 uV.
 * The diode may also leave its corner at once: the gain multiplies how fast it does, and times are known to what the
 * signs of diodes may be late by. */
#include "audit_crossing.h"
#include "audit_formula.h"

/* What a device puts out is a sum of terms, each of which is rounded; in the unit that it puts out. */
static double rounding_of_output(const struct dalcs_audit *audit, const struct audit_part *part,
                                 const struct dalcs_audit_state *s, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    if (d->behaviour != NULL) {
        return d->behaviour->smooth == NULL
                   ? AUDIT_ROUNDING * audit_formula_terms(audit, part, s, device)
                   : 0.0;
    }
    const bool by_current = d->kind == DALCS_CCVS || d->kind == DALCS_CCCS;
    const double read = by_current ? audit_amperes(audit, part, d->control)
                                   : audit_volts(audit, part, d->node[2], d->node[3]);
    return AUDIT_ROUNDING * fabs(d->value) * read;
}

void audit_widen_corners(struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *after) {
    struct audit_corners *corners = &audit->crossing.corners;
    *corners = (struct audit_corners){.later = &audit->state.shifted};
    for (int k = 0; k < part->n_devices; k++) {
        const enum dalcs_device_kind kind = audit->circuit->device[part->device[k]].kind;
        if (kind == DALCS_VCVS || kind == DALCS_CCVS) {
            corners->volts += rounding_of_output(audit, part, after, part->device[k]);
        } else if (kind == DALCS_VCCS || kind == DALCS_CCCS) {
            corners->amperes += rounding_of_output(audit, part, after, part->device[k]);
        }
    }
    audit->state.shifted.side = after->side;
    audit->state.shifted.t = after->t + part->at.lateness;
    audit->reader.read(audit->reader.user, (int)(part - audit->part), &audit->state.shifted);
}

double audit_volts_off_corner(const struct dalcs_audit *audit,
                              const struct dalcs_audit_state *after, int device) {
    const struct audit_corners *corners = &audit->crossing.corners;
    const struct dalcs_device *d = &audit->circuit->device[device];
    return corners->later == NULL
               ? 0.0
               : corners->volts + fabs(audit_voltage(corners->later, d) - audit_voltage(after, d));
}

double audit_amperes_off_corner(const struct dalcs_audit *audit,
                                const struct dalcs_audit_state *after, int device) {
    const struct audit_corners *corners = &audit->crossing.corners;
    return corners->later == NULL
               ? 0.0
               : corners->amperes + fabs(corners->later->i[device] - after->i[device]);
}

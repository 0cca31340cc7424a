/* positions_between.c - where a switch may stand between the two sides of an event.
 *
 * It turns where its control reaches the threshold, and what jumps is what the circuit does thereafter: behind what sources
 * alone decide, or what stands still, it is where it is seen. A control that jumps itself may have been beyond a threshold
 * before, after or in between: a switch that remembers its side turns, a state jumps, and it turns back on what it finds
 * behind the jump. So does one that gates command, where what they read jumps over a threshold: a comparator discharges its
 * own capacitor, and the gate is low before and behind. A formula that stands where it jumps has every value between. */
#include "audit_crossing.h"
#include "audit_formula.h"
#include "audit_positions.h"

/* How far a control jumps, against what it is known to. */
struct jump {
    double before, after, half_width, allowed;
};

static struct jump jump_of(const struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *before,
                           const struct dalcs_audit_state *after, int device) {
    struct jump j;
    j.before = audit_control(audit, before, device, &j.half_width);
    j.after = audit_control(audit, after, device, &j.half_width);
    j.allowed = part->tolerance * audit_control_scale(audit, part, device);
    return j;
}

/* Does a formula that puts out what controls a switch stand where it jumps? */
static bool is_formula_between(const struct dalcs_audit *audit, const struct audit_part *part,
                               const struct dalcs_audit_state *before, int device) {
    const struct dalcs_device *s = &audit->circuit->device[device];
    bool is = false;
    for (int k = 0; k < part->n_devices && s->control < 0 && part->has.formula && !is; k++) {
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        bool feeds = false;
        for (int end = 0; end < 2 && d->behaviour != NULL && d->behaviour->n_pairs > 0; end++) {
            const int node = audit->net.node_of[d->node[end]];
            feeds = feeds || (node != 0 && (node == audit->net.node_of[s->node[2]] ||
                                            node == audit->net.node_of[s->node[3]]));
        }
        is = feeds && audit_behaviour_may_turn(audit, part, before, part->device[k]);
    }
    return is;
}

/* May a comparator have been on both sides? */
static bool may_flash(const struct dalcs_audit *audit, const struct audit_part *part,
                      const struct dalcs_audit_state *before, const struct dalcs_audit_state *after,
                      int device) {
    const struct jump j = jump_of(audit, part, before, after, device);
    if (fabs(j.after - j.before) <= j.allowed) {
        return is_formula_between(audit, part, before, device);
    }
    return fmax(j.before, j.after) >= j.half_width - j.allowed &&
           fmin(j.before, j.after) <= j.allowed - j.half_width;
}

/* Do gates command a switch, and has one of their comparators in this part been on both sides? */
static bool gates_may_turn(const struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *before,
                           const struct dalcs_audit_state *after, int device) {
    const struct dalcs_circuit *c = audit->circuit;
    const int *node = c->device[device].node;
    bool may = false;
    if (!audit->net.is_gated[node[2]] && !audit->net.is_gated[node[3]]) {
        return false;
    }
    for (int k = 0; k < c->control.n_comparators && !may; k++) {
        const int comparator = c->control.comparator[k];
        const int inner = audit->net.node_of[c->device[comparator].node[0]];
        const int other = audit->net.node_of[c->device[comparator].node[1]];
        const int part_index = (int)(part - audit->part);
        may = (audit->net.owner[inner] == part_index || audit->net.owner[other] == part_index) &&
              may_flash(audit, part, before, after, comparator);
    }
    return may;
}

void audit_find_positions(const struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *before,
                          const struct dalcs_audit_state *after, int device, bool may_be[2]) {
    const bool now = after->is_closed[device];
    may_be[now] = true;
    if (audit_is_commanded(audit, device)) {
        may_be[!now] = before != after && gates_may_turn(audit, part, before, after, device);
        return;
    }
    const struct jump j = jump_of(audit, part, before, after, device);
    const bool turns = j.half_width > 0.0 || before->is_closed[device] != now;
    may_be[!now] = turns && (before == after || fabs(j.after - j.before) > j.allowed ||
                             is_formula_between(audit, part, before, device));
}

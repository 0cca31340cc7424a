/* kirchhoff.c - what leaves each node, with its rounding, and all that holds at one time. */
#include "audit_crossing.h"
#include "audit_currents.h"
#include "audit_formula.h"

#include "union_find.h"

static void leave(const struct dalcs_audit *audit, int node, double current, double scale,
                  double rounding) {
    node = audit->net.node_of[node];
    audit->sums.current[node] += current;
    audit->sums.scale[node] += scale;
    audit->sums.rounding[node] += rounding;
}

/* Charge and flux are each a product and a sum, at the two ends that a derivative is taken between. */
#define STORED_ROUNDING (4.0 * 0x1p-52)

/* What rounding of fluxes makes of voltages and of charges of currents. Conducting branches hand it on, and along a chain
 * of them it adds up: what is at one device may come from all others. */
void audit_round_storage(struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *s) {
    const double least = STORED_ROUNDING * part->at.slope;
    audit->sums.volts = audit->sums.amperes = 0.0;
    for (int k = 0; k < part->n_devices; k++) {
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        if (d->kind == DALCS_INDUCTOR) {
            audit->sums.volts += least * audit_flux_scale(audit, part, part->device[k]);
        } else if (d->kind == DALCS_CAPACITOR) {
            const double volts = fabs(s->v[d->node[0]]) + fabs(s->v[d->node[1]]);
            audit->sums.amperes += least * d->value * volts;
        }
    }
    for (int k = 0; k < part->n_devices; k++) { /* a derivative is read as a voltage */
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        audit->sums.volts += d->kind == DALCS_CCVS ? fabs(d->value) * audit->sums.amperes : 0.0;
    }
}

/* What rounding of the voltages at a device makes of its current, of a charge over a step, or over a step of a flux. A value
 * between the nodes of a step is a sum of those at the nodes: where it passes through 0 it has the rounding of these. */
static double rounding_of(const struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *s, int device, double current) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const double *v = audit->scale.v;
    const double volts = fabs(s->v[d->node[0]]) + fabs(s->v[d->node[1]]);
    if (d->kind == DALCS_CAPACITOR) {
        return STORED_ROUNDING * d->value * part->at.slope * volts;
    }
    if (d->kind == DALCS_VCCS && d->behaviour == NULL) {
        const double controls = v[d->node[2]] + v[d->node[3]];
        return fabs(d->value) * (AUDIT_ROUNDING * controls + audit->sums.volts);
    }
    if (d->kind == DALCS_CCCS) {
        return AUDIT_ROUNDING * fabs(current) + fabs(d->value) * audit->sums.amperes;
    }
    if (d->kind == DALCS_INDUCTOR) {
        /* a voltage of 0 is that to the rounding of the largest one in the same equations (Wilkinson) */
        return AUDIT_ROUNDING * fabs(current) +
               STORED_ROUNDING * fmax(volts, part->floor.largest_volt) * part->at.step / d->value;
    }
    const bool is_made = d->kind == DALCS_RESISTOR && !audit->net.is_told[device];
    const double g = is_made ? fabs(1.0 / d->value) : 0.0;
    const double at_nodes = v[d->node[0]] + v[d->node[1]];
    return AUDIT_ROUNDING * (g * at_nodes + fabs(current)) + 2.0 * g * audit->sums.volts;
}

void audit_sum_currents(struct dalcs_audit *audit, const struct audit_part *part,
                        const struct dalcs_audit_state *s) {
    for (int k = 0; k < part->n_nodes; k++) {
        const int node = part->node[k];
        audit->sums.current[node] = audit->sums.scale[node] = audit->sums.rounding[node] = 0.0;
    }
    audit_round_storage(audit, part, s);
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        const struct dalcs_device *d = &audit->circuit->device[device];
        const bool is_charge = d->kind == DALCS_CAPACITOR;
        const double current = is_charge ? 0.0 : audit_current(audit, s, device);
        const double scale = is_charge ? 0.0 : audit_amperes(audit, part, device);
        const double rounding = rounding_of(audit, part, s, device, current);
        leave(audit, d->node[0], current, scale, rounding);
        leave(audit, d->node[1], -current, scale, rounding);
    }
    audit->sums.rounding[0] = 0.0;
}

static void note_levels(struct dalcs_audit *audit, struct audit_part *part,
                        const struct dalcs_audit_state *s, int device) {
    const bool is_inner = audit->net.is_inner != NULL && audit->net.is_inner[device];
    if (!is_inner) {
        double *of = &part->floor.levels[audit->circuit->device[device].kind == DALCS_VCVS ? 0 : 1];
        *of = fmax(*of, audit_formula_levels(audit, s, device));
    }
}

void audit_note_scales(struct dalcs_audit *audit, struct audit_part *part,
                       const struct dalcs_audit_state *s) {
    const int *part_of = audit->net.part_of; /* other voltages are not measured by those */
    double volt = 0.0;
    double ampere = 0.0;
    double rounding[2] = {0.0, 0.0}; /* V, A */
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        const struct dalcs_device *d = &audit->circuit->device[device];
        const double i = d->kind == DALCS_CAPACITOR ? 0.0 : audit_current(audit, s, device);
        audit->scale.i[device] = fmax(audit->scale.i[device], fabs(i));
        ampere = fmax(ampere, audit->scale.i[device]);
        for (int e = 0; e < 2; e++) {
            const int node = d->node[e];
            audit->scale.v[node] = fmax(audit->scale.v[node], fabs(s->v[node]));
            volt = part_of == NULL || part_of[node] < 0 ? fmax(volt, audit->scale.v[node]) : volt;
        }
        if (d->behaviour != NULL) {
            double *of = &rounding[d->kind == DALCS_VCVS ? 0 : 1];
            *of = fmax(*of, audit_formula_rounding(audit, part, s, device));
            note_levels(audit, part, s, device);
        }
        for (int p = 0; d->behaviour != NULL && p < d->behaviour->n_pairs; p++) {
            double *scale = &audit->scale.lambda[audit->net.first_lambda[device] + p];
            *scale = fmax(*scale, fabs(s->lambda[audit->net.first_lambda[device] + p]));
        }
    }
    volt = fmax(volt, part->floor.levels[0]);
    ampere = fmax(ampere, part->floor.levels[1]);
    part->floor.largest_volt = volt;
    /* doc/methods.md, "What the tolerance means": signals below 1e-5 of the largest of their unit are held to
     * that one's scale, and each unit vouches a millionth for the other through the conductances, of 1 S where there
     * are none. */
    const bool has_any = part->floor.most > 0.0;
    const double most = has_any ? part->floor.most : 1.0;
    const double least = has_any ? part->floor.least : 1.0;
    part->floor.volt = fmax(1e-5 * volt, 1e-6 / most * ampere);
    part->floor.ampere = fmax(1e-5 * ampere, 1e-6 * least * volt);
    /* Nothing is known to less than the rounding of a formula makes of it. */
    const double volts = (rounding[0] + rounding[1] / most) / audit->options.failure;
    const double amperes = (rounding[1] + rounding[0] * least) / audit->options.failure;
    part->floor.volt = fmax(part->floor.volt, volts);
    part->floor.ampere = fmax(part->floor.ampere, amperes);
}

/* What ideal branches hand on: an impedance of nothing is no barrier for a current that rounding makes. */
static bool hands_on(const struct dalcs_audit *audit, const struct audit_part *part,
                     const struct dalcs_audit_state *before, const struct dalcs_audit_state *s,
                     int device) {
    (void)part, (void)before;
    const struct dalcs_device *d = &audit->circuit->device[device];
    switch (d->kind) {
    case DALCS_VSOURCE:
    case DALCS_VCVS:
    case DALCS_CCVS:
        return true;
    case DALCS_RESISTOR:
        return audit->net.is_told[device];
    case DALCS_SWITCH:
        return s->is_closed[device];
    case DALCS_DIODE:
        return s->i[device] != 0.0;
    default:
        return false;
    }
}

double audit_rounding_around(struct dalcs_audit *audit, const struct audit_part *part,
                             const struct dalcs_audit_state *s, int node) {
    double sum = 0.0;
    audit_find_clusters(audit, part, s, s, hands_on);
    const int root = dalcs_union_find(audit->crossing.cluster, node);
    for (int k = 0; k < part->n_nodes; k++) {
        const bool is_near = dalcs_union_find(audit->crossing.cluster, part->node[k]) == root;
        sum += is_near ? audit->sums.rounding[part->node[k]] : 0.0;
    }
    return sum;
}

/* How far a node that hangs on a source moves while times cannot be told apart, until audit->shifted.t. */
static double source_moves(const struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *s, int node) {
    bool hangs = false;
    for (int k = 0; k < part->n_devices && node > 0 && !hangs; k++) {
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        const bool is_source =
            d->kind == DALCS_VSOURCE || d->kind == DALCS_VCVS || d->kind == DALCS_CCVS;
        hangs = is_source &&
                (audit->net.node_of[d->node[0]] == node || audit->net.node_of[d->node[1]] == node);
    }
    return hangs ? fabs(audit->state.shifted.v[node] - s->v[node]) : 0.0;
}

static void read_a_moment_away(struct dalcs_audit *audit, const struct audit_part *part,
                               const struct dalcs_audit_state *s) {
    const double away = audit->options.resolution;
    audit->state.shifted.side = s->side;
    audit->state.shifted.t = s->t + (s->side == DALCS_RIGHT ? away : -away);
    audit->reader.read(audit->reader.user, (int)(part - audit->part), &audit->state.shifted);
}

double audit_sources_move(struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *s, const struct dalcs_device *d) {
    read_a_moment_away(audit, part, s);
    return source_moves(audit, part, s, audit->net.node_of[d->node[0]]) +
           source_moves(audit, part, s, audit->net.node_of[d->node[1]]);
}

/* What rounding of time makes of the current that leaves a node. A source is what it is at a time, and what follows it is a
 * polynomial of the time since a step began: on a steep flank two copies of one voltage differ, and a resistor between
 * them carries that. */
static double rounding_of_time(struct dalcs_audit *audit, const struct audit_part *part,
                               const struct dalcs_audit_state *s, int node) {
    read_a_moment_away(audit, part, s);
    double sum = 0.0;
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        const struct dalcs_device *d = &audit->circuit->device[device];
        const int a = audit->net.node_of[d->node[0]];
        const int b = audit->net.node_of[d->node[1]];
        if (d->kind == DALCS_RESISTOR && !audit->net.is_told[device] &&
            (a == node) != (b == node)) {
            sum += (source_moves(audit, part, s, a) + source_moves(audit, part, s, b)) /
                   fabs(d->value);
        }
    }
    return sum;
}

/* What the currents of formulas at a node are held to at this state: no current is known better than what makes it. One that
 * is 0 may be the difference of large ones. */
static double formula_currents(const struct dalcs_audit *audit, const struct audit_part *part,
                               const struct dalcs_audit_state *s, int node) {
    double sum = 0.0;
    for (int k = 0; k < part->n_devices; k++) {
        const struct dalcs_device *d = &audit->circuit->device[part->device[k]];
        const bool is_here =
            audit->net.node_of[d->node[0]] == node || audit->net.node_of[d->node[1]] == node;
        if (d->behaviour != NULL && d->kind == DALCS_VCCS && is_here) {
            sum += audit_formula_size(audit, part, s, part->device[k]);
        }
    }
    return sum;
}

void audit_check_instant(struct dalcs_audit *audit, struct audit_part *part,
                         const struct dalcs_audit_state *s) {
    audit->count.instants++;
    audit_sum_currents(audit, part, s);
    for (int k = 0; k < part->n_devices; k++) {
        audit_check_branch(audit, part, s, part->device[k]);
    }
    for (int k = 0; k < part->n_nodes; k++) {
        const int node = part->node[k];
        if (!audit->net.has_charge[node]) {
            double off = fabs(audit->sums.current[node]) - audit->options.abstol;
            const double allowed =
                audit->sums.rounding[node] + part->tolerance * audit->sums.scale[node];
            off -= off > allowed ? audit_rounding_around(audit, part, s, node) +
                                       rounding_of_time(audit, part, s, node)
                                 : audit->sums.rounding[node];
            if (off > part->tolerance * audit->sums.scale[node]) {
                const double of_all =
                    audit->sums.scale[node] + formula_currents(audit, part, s, node);
                off *= audit_ratio(audit->sums.scale[node], of_all);
            }
            audit_find(audit, part, DALCS_AUDIT_KCL, node, off, audit->sums.scale[node], s->t);
        }
    }
}

/* impulse_laws.c - impulses of all elements from those of states, switches and diodes.
 *
 * What one law alone leaves open follows from it, again and again: charges by Kirchhoff's current law at nodes where one
 * is left, impulses of voltage from node to node. Elements that hold a voltage are a forest, apart from wires in
 * loops, whose charges stay unknown. A passive resistor has neither a charge nor a flux (impulse_network.h); one that a
 * source drives by what it reads may have both, between nodes that are known otherwise. */
#include "impulses.h"

#include "magnitudes.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

bool dalcs_holds_voltage(const struct dalcs_device *d) {
    return d->kind == DALCS_VSOURCE || d->kind == DALCS_VCVS || d->kind == DALCS_CCVS ||
           dalcs_device_is_short(d);
}

bool dalcs_holds_current(const struct dalcs_device *d) {
    return d->kind == DALCS_ISOURCE || d->kind == DALCS_VCCS || d->kind == DALCS_CCCS;
}

/* What rounding leaves is none. */
static double difference(double a, double b) {
    return fabs(a - b) <= dalcs_alike * fmax(fabs(a), fabs(b)) ? 0.0 : a - b;
}

static bool is_resistor(const struct dalcs_device *d) {
    return d->kind == DALCS_RESISTOR && !dalcs_device_is_short(d);
}

/* Wb of a coil with those that it is coupled to. */
static double flux_of(const struct dalcs_impulses *m, int k) {
    const struct dalcs_circuit *c = m->circuit;
    double flux = c->device[k].value * m->change[k];
    for (int j = 0; j < c->n_couplings; j++) {
        const struct dalcs_coupling *coupling = &c->coupling[j];
        if (coupling->inductor[0] == k || coupling->inductor[1] == k) {
            const int other = coupling->inductor[coupling->inductor[0] == k ? 1 : 0];
            flux +=
                coupling->k * sqrt(c->device[k].value * c->device[other].value) * m->change[other];
        }
    }
    return flux;
}

/* Coils without leakage pass charge to each other, as windings of an ideal transformer do. */
static bool passes_charge(const struct dalcs_circuit *c, int k) {
    bool passes = false;
    for (int j = 0; j < c->n_couplings; j++) {
        const struct dalcs_coupling *coupling = &c->coupling[j];
        passes = passes || ((coupling->inductor[0] == k || coupling->inductor[1] == k) &&
                            fabs(coupling->k) == 1.0);
    }
    return passes;
}

/* ---- What sources read --------------------------------------------------------------------------- */

static double read_sum(const struct dalcs_impulses *m, const struct dalcs_affine *f) {
    double plus = 0.0;
    double minus = 0.0;
    for (int i = 0; i < f->n; i++) {
        const struct dalcs_affine_term *t = &f->term[i];
        const double term = t->kind == DALCS_QUANTITY_VOLTAGE ? t->coefficient * m->node[t->index]
                            : t->kind == DALCS_QUANTITY_CURRENT
                                ? t->coefficient * m->charge[t->index]
                            : t->kind == DALCS_QUANTITY_PAIR ? t->coefficient * m->pair[t->index]
                                                             : 0.0;
        plus += term > 0.0 ? term : 0.0;
        minus -= term < 0.0 ? term : 0.0;
        plus = isnan(term) ? term : plus;
    }
    return difference(plus, minus);
}

/* Of a source with bends: its formula far from all of them, where their places do not count. Pairs follow one from the other;
 * where they do not, as those of a jump, or where one has no answer without the places, it is not told. */
static double far_away(const struct dalcs_impulses *m, const struct dalcs_behaviour *b) {
    memset(m->pair, 0, (size_t)b->n_pairs * sizeof(double));
    bool reads = read_sum(m, &b->output) != 0.0;
    for (int p = 0; p < b->n_pairs; p++) {
        reads = reads || read_sum(m, &b->w[p]) != 0.0;
    }
    for (int p = 0; p < b->n_pairs && reads; p++) {
        m->pair[p] = NAN;
    }
    for (bool moves = reads; moves;) {
        moves = false;
        for (int p = 0; p < b->n_pairs; p++) {
            if (isnan(m->pair[p])) {
                const double own = dalcs_affine_of_pair(&b->w[p], p);
                m->pair[p] = 0.0;
                const double w = read_sum(m, &b->w[p]);
                m->pair[p] = w >= 0.0 ? 0.0 : w < 0.0 && own > 0.0 ? -w / own : (double)NAN;
                moves = moves || !isnan(m->pair[p]);
            }
        }
    }
    return read_sum(m, &b->output);
}

/* Of what a source puts out, where it reads others. A smooth one puts out no impulse where it reads none, and else what is not
 * told. */
static double put_out(const struct dalcs_impulses *m, const struct dalcs_device *d) {
    const struct dalcs_behaviour *b = d->behaviour;
    if (d->is_storage) {
        return NAN;
    }
    if (b == NULL && (d->kind == DALCS_VCVS || d->kind == DALCS_VCCS)) {
        return d->value * difference(m->node[d->node[2]], m->node[d->node[3]]);
    }
    if (b == NULL && (d->kind == DALCS_CCVS || d->kind == DALCS_CCCS)) {
        return d->value * m->charge[d->control];
    }
    if (b == NULL) {
        return 0.0;
    }
    if (b->smooth == NULL) {
        return far_away(m, b);
    }
    bool none = read_sum(m, &b->output) == 0.0;
    for (int p = 0; p < b->n_pairs && none; p++) {
        none = read_sum(m, &b->w[p]) == 0.0;
    }
    return none ? 0.0 : (double)NAN;
}

/* ---- Steps, each until nothing follows ----------------------------------------------------------- */

static void pass_charge(struct dalcs_impulses *m, int k, double charge) {
    const int *node = m->circuit->device[k].node;
    m->charge[k] = charge;
    for (int side = 0; side < 2; side++) {
        m->sum[node[side]] += side == 0 ? charge : -charge;
        m->size[node[side]] += fabs(charge);
        m->n_open[node[side]]--;
    }
}

/* A charge by its own law, or by that of a node where it is the only one left. */
static bool find_charge(struct dalcs_impulses *m, int k) {
    const struct dalcs_device *d = &m->circuit->device[k];
    if (!isnan(m->charge[k])) {
        return false;
    }
    double charge = dalcs_holds_current(d) ? put_out(m, d)
                    : is_resistor(d)
                        ? difference(m->node[d->node[0]], m->node[d->node[1]]) / d->value
                        : (double)NAN;
    for (int side = 0; side < 2 && isnan(charge); side++) {
        const int n = d->node[side];
        if (m->n_open[n] == 1) {
            const bool is_rounding = fabs(m->sum[n]) <= dalcs_alike * m->size[n];
            charge = is_rounding ? 0.0 : side == 0 ? -m->sum[n] : m->sum[n];
        }
    }
    if (!isnan(charge)) {
        pass_charge(m, k, charge);
    }
    return !isnan(charge);
}

/* From a node to the next one. joins: over resistors, too, as if nothing were across them. */
static bool find_node(struct dalcs_impulses *m, int k, bool joins) {
    const struct dalcs_device *d = &m->circuit->device[k];
    const bool is_known[2] = {!isnan(m->node[d->node[0]]), !isnan(m->node[d->node[1]])};
    if (is_known[0] == is_known[1] || dalcs_holds_current(d)) {
        return false;
    }
    const double across = dalcs_holds_voltage(d) ? put_out(m, d)
                          : is_resistor(d)       ? (joins ? 0.0 : (double)NAN)
                                                 : m->across[k];
    if (isnan(across)) {
        return false;
    }
    if (is_known[0]) {
        m->node[d->node[1]] = difference(m->node[d->node[0]], across);
    } else {
        m->node[d->node[0]] = difference(m->node[d->node[1]], -across);
    }
    return true;
}

/* Forwards and backwards, as elements of a chain are in either order. */
static bool go_round(struct dalcs_impulses *m, bool joins) {
    const int n = m->circuit->n_devices;
    bool moves = false;
    for (int i = 0; i < 2 * n; i++) {
        const int k = i < n ? i : 2 * n - 1 - i;
        moves = find_node(m, k, joins) || moves;
        moves = find_charge(m, k) || moves;
    }
    return moves;
}

/* A node that nothing leads to is of a part that does not touch ground, or of a loop of sources that read each other. That all
 * is 0 there is an answer, unless something drives it. */
static bool take_reference(struct dalcs_impulses *m) {
    for (int n = 0; n < m->circuit->n_nodes; n++) {
        if (isnan(m->node[n])) {
            m->node[n] = 0.0;
            return true;
        }
    }
    return false;
}

/* ---- What was found, against all laws ------------------------------------------------------------ */

/* Does a source put out what was found at its nodes? */
static bool obeys(const struct dalcs_impulses *m, int k) {
    const struct dalcs_device *d = &m->circuit->device[k];
    const bool holds[2] = {dalcs_holds_voltage(d), dalcs_holds_current(d)};
    if (!(holds[0] || holds[1]) || d->is_storage) {
        return true;
    }
    const double law = put_out(m, d);
    const double own =
        holds[0] ? difference(m->node[d->node[0]], m->node[d->node[1]]) : m->charge[k];
    return fabs(law - own) <= dalcs_nothing * (fabs(own) + fabs(law));
}

/* Where charges do not add up, a source drives what is between nodes that are not known otherwise. */
static bool adds_up(const struct dalcs_impulses *m) {
    double largest = 0.0;
    bool adds = true;
    for (int n = 0; n < m->circuit->n_nodes; n++) {
        largest = fmax(largest, m->size[n]);
    }
    for (int n = 0; n < m->circuit->n_nodes && adds; n++) {
        const double allowed = dalcs_nothing * m->size[n] + dalcs_alike * largest;
        adds = m->n_open[n] > 0 || fabs(m->sum[n]) <= allowed;
    }
    for (int k = 0; k < m->circuit->n_devices && adds; k++) {
        adds = obeys(m, k);
    }
    return adds;
}

/* From node to node over batteries and wires, or over capacitors, which say by how much their voltage changes. */
static bool spread_moves(struct dalcs_impulses *m, bool over_capacitors) {
    const struct dalcs_circuit *c = m->circuit;
    bool moves = false;
    for (int k = 0; k < c->n_devices; k++) {
        const struct dalcs_device *d = &c->device[k];
        const bool is_battery = d->kind == DALCS_VSOURCE && d->stimulus >= 0 &&
                                c->stimulus[d->stimulus].kind == DALCS_STIMULUS_DC;
        const bool leads = over_capacitors ? d->kind == DALCS_CAPACITOR && !isnan(m->change[k])
                                           : is_battery || dalcs_device_is_short(d);
        const double change = over_capacitors ? m->change[k] : 0.0;
        double *end[2] = {&m->moved[d->node[0]], &m->moved[d->node[1]]};
        if (leads && isnan(*end[0]) && !isnan(*end[1])) {
            *end[0] = *end[1] + change;
            moves = true;
        } else if (leads && isnan(*end[1]) && !isnan(*end[0])) {
            *end[1] = *end[0] - change;
            moves = true;
        }
    }
    return moves;
}

/* A battery holds its node, whatever a capacitor there was said to start from. */
static void find_moves(struct dalcs_impulses *m) {
    for (int n = 0; n < m->circuit->n_nodes; n++) {
        m->moved[n] = n == 0 ? 0.0 : (double)NAN;
    }
    do {
        while (spread_moves(m, false)) {
        }
    } while (spread_moves(m, true));
}

static void begin(struct dalcs_impulses *m) {
    const struct dalcs_circuit *c = m->circuit;
    memset(m->sum, 0, 2 * (size_t)c->n_nodes * sizeof(double));
    memset(m->n_open, 0, (size_t)c->n_nodes * sizeof(int));
    for (int n = 0; n < c->n_nodes; n++) {
        m->node[n] = n == 0 ? 0.0 : (double)NAN;
    }
    for (int k = 0; k < c->n_devices; k++) {
        const struct dalcs_device *d = &c->device[k];
        double charge = m->charge[k];
        m->n_open[d->node[0]]++;
        m->n_open[d->node[1]]++;
        if (d->kind == DALCS_CAPACITOR) {
            /* what rounding makes of its charge is seen in no sum */
            const double rounding = dalcs_answer_rounded * d->value * m->level[k] / dalcs_nothing;
            m->size[d->node[0]] += rounding;
            m->size[d->node[1]] += rounding;
            charge = d->value * m->change[k];
        } else if (d->kind == DALCS_INDUCTOR) {
            m->across[k] = flux_of(m, k);
            charge = passes_charge(c, k) ? (double)NAN : charge;
        } else if (dalcs_holds_voltage(d) || dalcs_holds_current(d) || is_resistor(d)) {
            charge = NAN;
        }
        m->charge[k] = NAN;
        if (!isnan(charge)) {
            pass_charge(m, k, charge);
        }
    }
}

void dalcs_impulses_solve(struct dalcs_impulses *m) {
    begin(m);
    find_moves(m);
    do {
        while (go_round(m, false)) {
        }
        while (go_round(m, true)) {
        }
    } while (take_reference(m));
    if (!adds_up(m)) {
        begin(m); /* what the laws say without an answer that was taken */
        while (go_round(m, false)) {
        }
    }
}

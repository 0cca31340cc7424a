/* audit_gates.c - gates and flip-flops, decided a second time.
 *
 * Each gate is held to its own law (doc/netlist.md): what it shows is what its inputs say, or said its delay before. Inputs
 * are the comparators' positions, which are audited as those of all switches, and what other gates show, in the sources
 * that the circuit has. Nothing of the network or its queue is asked. What depends on an order within one instant (data
 * that change with their clock, a pulse of no width that sets a latch) is taken as it is shown. */
#include "audit_gate.h"

#include "radau.h"

#include <math.h>
#include <stdlib.h>

static enum dalcs_status find_systems(struct dalcs_audit_gates *a) {
    const struct dalcs_circuit *c = a->circuit;
    a->node_system = dalcs_alloc((size_t)c->n_nodes, sizeof(*a->node_system));
    if (a->node_system == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < c->n_nodes; k++) {
        a->node_system[k] = -1;
    }
    for (int d = 0; d < c->n_devices; d++) {
        for (int k = 0; k < 2 && a->readout->device_system[d] >= 0; k++) {
            a->node_system[c->device[d].node[k]] = a->readout->device_system[d];
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_audit_gates_start(struct dalcs_audit_gates *a,
                                          const struct dalcs_circuit *circuit,
                                          struct dalcs_radau *radau,
                                          const struct dalcs_readout *readout) {
    bool has_samples = false;
    *a = (struct dalcs_audit_gates){.circuit = circuit, .radau = radau, .readout = readout};
    if (circuit->control.n_gates == 0) {
        return DALCS_OK;
    }
    a->gate = dalcs_alloc((size_t)circuit->control.n_gates, sizeof(*a->gate));
    a->place = dalcs_alloc((size_t)circuit->control.n_comparators + 1, sizeof(*a->place));
    a->n_restless = circuit->control.n_gates;
    enum dalcs_status status = a->gate != NULL && a->place != NULL ? DALCS_OK : DALCS_E_NOMEM;
    status = status == DALCS_OK ? audit_gates_list_sources(a) : status;
    status =
        status == DALCS_OK ? dalcs_logic_find_comparators(circuit, radau->base, a->place) : status;
    for (int k = 0; status == DALCS_OK && k < circuit->control.n_gates; k++) {
        a->gate[k].is_lost = true; /* until it is looked at for the first time */
        a->gate[k].count = circuit->control.gate[k].first;
        a->gate[k].held = circuit->control.gate[k].held;
        has_samples = has_samples || circuit->control.gate[k].sampled >= 0;
    }
    if (has_samples && status == DALCS_OK) {
        status = find_systems(a);
    }
    if (status != DALCS_OK) {
        dalcs_audit_gates_finish(a);
    }
    return status;
}

void dalcs_audit_gates_finish(struct dalcs_audit_gates *a) {
    for (int k = 0; a->gate != NULL && k < a->circuit->control.n_gates; k++) {
        free(a->gate[k].due);
    }
    free(a->gate);
    free(a->place);
    free(a->says);
    free(a->source);
    free(a->node_system);
    *a = (struct dalcs_audit_gates){0};
}

/* What it has to show by t. *is_near: it changes about then, and which side t is on is rounding. *last: when it last had to
 * change since it was looked at, if it did. */
static void go_to(struct audit_gate *s, double t, double near, bool *is_near, double *last) {
    *is_near = false;
    while (s->first_due < s->n_due && s->due[s->first_due] <= t + near) {
        *is_near = *is_near || s->due[s->first_due] > t - near;
        *last = s->due[s->first_due];
        s->shown = !s->shown;
        s->first_due++;
    }
    if (s->first_due == s->n_due) {
        s->first_due = s->n_due = 0;
    }
}

/* The time of the last change that was written; its ramp may go on. */
static double changed_at(const struct dalcs_audit_gates *a, int k) {
    const struct dalcs_stimulus *s =
        &a->circuit->stimulus[audit_gate_shown_by(&a->circuit->control.gate[k])];
    return s->u.pwl.n > 1 ? s->u.pwl.t[s->u.pwl.n - 2] : -INFINITY;
}

static struct audit_verdict decide(const struct dalcs_audit_gates *a, int k, bool now, double t) {
    const struct dalcs_logic_gate *g = &a->circuit->control.gate[k];
    struct audit_gate *s = &a->gate[k];
    return g->kind == DALCS_GATE_COUNTER      ? audit_gate_of_counter(a, g, s, now)
           : g->kind == DALCS_GATE_MONOSTABLE ? audit_gate_of_monostable(a, g, s, t)
           : g->kind == DALCS_GATE_LATCH || dalcs_gate_has_clock(g) ? audit_gate_of_memory(a, g, s)
                                                                    : audit_gate_of_inputs(a, g);
}

static double longest_delay(const struct dalcs_logic_gate *g) {
    return fmax(fmax(g->delay[0], g->delay[1]), fmax(g->forced_delay[0], g->forced_delay[1]));
}

/* Does a gate without memory show what it has decided? So it does at once, but for a monostable whose pulse nobody has seen
 * begin: what that decided is shown when it has decided nothing else for its longest delay. */
static bool is_settled(const struct dalcs_audit_gates *a, int k, const struct audit_verdict *v,
                       bool now, double t) {
    const struct dalcs_logic_gate *g = &a->circuit->control.gate[k];
    struct audit_gate *s = &a->gate[k];
    if (g->kind != DALCS_GATE_MONOSTABLE) {
        return v->is_known;
    }
    if (!v->is_known || v->q != s->q) {
        s->q = v->q;
        s->free_at = t + longest_delay(g) + 4.0 * a->radau->resolution;
    }
    return v->is_known && v->q == now && t >= s->free_at;
}

/* Gate k at t; is_wrong: it does not show what it has to. */
static enum dalcs_status look_at(struct dalcs_audit_gates *a, int k, double t, bool *is_wrong) {
    const struct dalcs_logic_gate *g = &a->circuit->control.gate[k];
    struct audit_gate *s = &a->gate[k];
    const bool has_memory = g->kind == DALCS_GATE_LATCH || dalcs_gate_has_clock(g);
    const bool now = a->says[k];
    if (has_memory && s->is_lost && t >= s->free_at) {
        s->is_lost = false;
        s->q = s->shown = now;
        s->first_due = s->n_due = 0;
    }
    const struct audit_verdict v = decide(a, k, now, t);
    s->was_seen = true;
    const bool is_open = !v.is_known || (v.is_held && audit_gate_may_have_missed(a, g)) ||
                         audit_gate_may_be_undone(a, g, &v);
    *is_wrong = false;
    if (s->is_lost && !has_memory && is_settled(a, k, &v, now, t)) {
        s->is_lost = false; /* what it showed stands until it decides else */
        s->q = s->shown = now;
        s->first_due = s->n_due = 0;
    }
    if (has_memory && (is_open || !v.is_held)) {
        s->free_at = t + longest_delay(g) + 4.0 * a->radau->resolution;
    }
    if (s->is_lost) {
        return DALCS_OK;
    }
    if (!dalcs_gate_has_delay(g)) {
        const bool q = is_open ? now : v.is_held ? s->q : v.q;
        s->q = s->shown = q;
        *is_wrong = q != now;
        s->rests = !is_open;
        return DALCS_OK;
    }
    s->is_lost = is_open;
    const bool q = v.is_held ? s->q : v.q;
    bool is_near;
    double last = -INFINITY;
    const double near = 4.0 * a->radau->resolution;
    DALCS_TRY(audit_gate_expect(s, q, t + (v.is_forced ? g->forced_delay : g->delay)[q]));
    go_to(s, t, near, &is_near, &last);
    const bool is_late = last > -INFINITY && s->shown == now && changed_at(a, k) > last + near;
    *is_wrong = !is_open && !is_near && (s->shown != now || is_late);
    s->rests = !is_open && !is_near && s->n_due == 0;
    return DALCS_OK;
}

enum dalcs_status dalcs_audit_gates_go_on(struct dalcs_audit_gates *a,
                                          const struct dalcs_logic_run *logic) {
    if (a->gate != NULL) {
        (void)audit_gates_read(a);
        a->n_restless = a->circuit->control.n_gates;
    }
    for (int k = 0; a->gate != NULL && k < a->circuit->control.n_gates; k++) {
        const struct dalcs_logic_gate *g = &a->circuit->control.gate[k];
        const struct dalcs_logic_state *state = &logic->network.state[k];
        const struct dalcs_logic_output *o = &logic->output[k];
        struct audit_gate *s = &a->gate[k];
        bool is_known = true;
        DALCS_TRY(dalcs_grow(&s->due, &s->capacity, o->n_due + 1, sizeof(*s->due)));
        for (size_t i = 0; i < o->n_due; i++) {
            s->due[i] = o->due[o->first_due + i].t;
        }
        s->n_due = o->n_due;
        s->is_lost = s->rests = false;
        s->was_seen = true;
        s->q = state->q;
        s->shown = o->shown;
        s->clock = state->clock;
        s->data = g->kind >= DALCS_GATE_FLIP_FLOP && g->kind <= DALCS_GATE_SR_LATCH &&
                  audit_gate_reads(a, &g->input[DALCS_GATE_DATA], &is_known);
        s->reset = (g->kind == DALCS_GATE_JK || g->kind == DALCS_GATE_SR ||
                    g->kind == DALCS_GATE_SR_LATCH) &&
                   audit_gate_reads(a, &g->input[DALCS_GATE_RESET], &is_known);
        s->count = state->count;
        s->ends = o->ends;
        if (g->kind == DALCS_GATE_SAMPLE) {
            s->held = a->circuit->stimulus[g->output[0]].u.pwl.v[0];
        }
        if (g->sampled >= 0) {
            s->before = logic->taken[k];
        }
    }
    return DALCS_OK;
}

static double potential(const struct dalcs_audit_gates *a, int node) {
    const int column = a->readout->node_column[node];
    const int system = column >= 0 ? a->node_system[node] : -1;
    return system >= 0 ? a->radau->part[system].component->y[column] : 0.0;
}

enum dalcs_status dalcs_audit_gates_sample(struct dalcs_audit_gates *a, double t) {
    const struct dalcs_circuit *c = a->circuit;
    if (a->node_system == NULL) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_radau_evaluate(a->radau, t, DALCS_LEFT));
    for (int k = 0; k < c->control.n_gates; k++) {
        if (c->control.gate[k].sampled >= 0) {
            const struct dalcs_signal *s =
                &c->results.signal[c->results.measured[c->control.gate[k].sampled]];
            a->gate[k].before = potential(a, s->node[0]) - potential(a, s->node[1]);
        }
    }
    return DALCS_OK;
}

/* V, the errors that waveforms of the nodes may have that a gate samples: none where these are one. */
static double doubt_of(const struct dalcs_audit_gates *a, const struct dalcs_logic_gate *g) {
    const struct dalcs_circuit *c = a->circuit;
    const struct dalcs_signal *s =
        g->sampled >= 0 ? &c->results.signal[c->results.measured[g->sampled]] : NULL;
    double doubt = 0.0;
    for (int k = 0; s != NULL && k < 2; k++) {
        const int system = a->node_system[s->node[k]];
        const struct dalcs_radau_part *part = system >= 0 ? &a->radau->part[system] : NULL;
        doubt += part != NULL ? part->tolerance * part->scales.unit[0] : 0.0;
    }
    return doubt;
}

/* A sample at t; does it hold and show what it has to? */
static bool is_sample_wrong(struct dalcs_audit_gates *a, int k) {
    const struct dalcs_circuit *c = a->circuit;
    const struct dalcs_logic_gate *g = &c->control.gate[k];
    struct audit_gate *s = &a->gate[k];
    const struct dalcs_stimulus *held = &c->stimulus[g->output[0]];
    const struct dalcs_stimulus *mode = g->output[1] >= 0 ? &c->stimulus[g->output[1]] : NULL;
    const double value = held->u.pwl.v[held->u.pwl.n - 1];
    bool is_known = true;
    const bool clock = audit_gate_reads(a, &g->input[DALCS_GATE_CLOCK], &is_known);
    const bool tracks = audit_gate_reads(a, &g->input[DALCS_GATE_PRESET], &is_known);
    if (!s->is_lost && ((clock && !s->clock) || (s->q && !tracks) || s->flashes != 0)) {
        s->held = s->before;
    } else if (!is_known || audit_gate_may_have_missed(a, g) || (s->is_lost && clock)) {
        s->held =
            value; /* a pulse of no width may have been there, or the clock has risen at the start */
    }
    s->is_lost = false;
    s->clock = clock;
    s->q = tracks;
    const double doubt = doubt_of(a, g);
    return fabs(value - s->held) > doubt ||
           (mode != NULL && is_known && (mode->u.pwl.v[mode->u.pwl.n - 1] != 0.0) != tracks);
}

static bool any_flashes(const struct dalcs_audit_gates *a) {
    bool any = false;
    for (int k = 0; k < a->circuit->control.n_comparators && !any; k++) {
        any = dalcs_logic_run_flashed(a->logic, k);
    }
    return any;
}

static enum dalcs_status look_again(struct dalcs_audit_gates *a, struct dalcs_audit *audit, int k,
                                    double t) {
    const struct dalcs_logic_gate *g = &a->circuit->control.gate[k];
    struct audit_gate *s = &a->gate[k];
    bool is_wrong;
    s->rests = false;
    s->flashes = audit_gate_flashes(a, g, audit, t);
    if (g->kind == DALCS_GATE_SAMPLE) {
        is_wrong = is_sample_wrong(a, k);
    } else {
        DALCS_TRY(look_at(a, k, t, &is_wrong));
        is_wrong = is_wrong || !audit_gate_is_written(a, k);
    }
    if (is_wrong && g->device >= 0) {
        dalcs_audit_add_position(audit, g->device, 1.0, t);
    }
    s->rests = s->rests && !is_wrong && s->flashes == 0 && g->kind != DALCS_GATE_MONOSTABLE &&
               s->n_sources <= AUDIT_GATE_BITS;
    return DALCS_OK;
}

/* A gate at rest for which nothing has changed is as it was found: most are, at most instants. */
enum dalcs_status dalcs_audit_gates_look(struct dalcs_audit_gates *a, struct dalcs_audit *audit,
                                         const struct dalcs_logic_run *logic, double t) {
    a->logic = logic;
    if (a->gate == NULL) {
        return DALCS_OK;
    }
    const bool differs = audit_gates_read(a);
    const bool flashes = any_flashes(a);
    if (!differs && !flashes && a->n_restless == 0) {
        return DALCS_OK;
    }
    a->n_restless = 0;
    for (int k = 0; k < a->circuit->control.n_gates; k++) {
        if (audit_gate_shown_by(&a->circuit->control.gate[k]) >= 0) {
            if (audit_gate_reads_another(a, k) || flashes || !a->gate[k].rests) {
                DALCS_TRY(look_again(a, audit, k, t));
            }
            a->n_restless += a->gate[k].rests ? 0 : 1;
        }
    }
    return DALCS_OK;
}

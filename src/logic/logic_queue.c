/* logic_queue.c - what gates have decided and is seen later: delays, and pulses that end by themselves. */
#include "logic_queue.h"

#include <math.h>
#include <string.h>

/* Times nearer than this are one, s. */
static double resolution(const struct dalcs_logic_run *l) {
    return l->radau != NULL ? l->radau->resolution : 4.0 * l->euler->grid.resolution;
}

void dalcs_logic_queue(void *user, int gate, const struct dalcs_logic_state *next) {
    struct dalcs_logic_run *l = user;
    struct dalcs_logic_output *o = &l->output[gate];
    const struct dalcs_logic_gate *g = &l->network.gate[gate];
    const double due = l->now + (next->is_forced ? g->forced_delay : g->delay)[next->q];
    if (!dalcs_gate_has_delay(g)) {
        return;
    }
    if (o->n_due > 0 && o->due[o->first_due + o->n_due - 1].t >= due) {
        o->n_due--; /* there and back in no time, or back before it is there */
        return;
    }
    if (o->first_due > 0 && o->first_due >= o->n_due) {
        memmove(o->due, o->due + o->first_due, o->n_due * sizeof(*o->due));
        o->first_due = 0;
    }
    const size_t end = o->first_due + o->n_due;
    if (dalcs_grow(&o->due, &o->due_capacity, end + 1, sizeof(*o->due)) != DALCS_OK) {
        l->out_of_memory = true;
        return;
    }
    o->due[end] = (struct dalcs_logic_due){due, l->instant};
    o->n_due++;
    dalcs_logic_set_add(&l->waits, gate);
}

double dalcs_logic_run_next(const struct dalcs_logic_run *l) {
    double next = INFINITY;
    for (int i = 0; i < l->waits.n; i++) {
        const struct dalcs_logic_output *o = &l->output[l->waits.gate[i]];
        next = fmin(next, o->n_due > 0 ? fmin(o->ends, o->due[o->first_due].t) : o->ends);
    }
    return next;
}

void dalcs_logic_start_pulses(struct dalcs_logic_run *l, double t) {
    for (int i = 0; i < l->n_pulses; i++) {
        const int k = l->pulse[i];
        const struct dalcs_logic_gate *g = &l->network.gate[k];
        struct dalcs_logic_state *state = &l->network.state[k];
        if (state->takes) {
            l->output[k].ends =
                t + g->pulse.lead + (g->sampled >= 0 ? fmax(0.0, l->taken[k]) : g->pulse.length);
            l->output[k].ends_since = ++l->number;
            dalcs_logic_set_add(&l->waits, k);
            dalcs_logic_touch(&l->network, k, false);
            if (l->observer != NULL) {
                l->observer->pulse(l->observer->user, k, l->number);
            }
        } else if (state->count == 0) {
            l->output[k].ends = INFINITY;
        }
        state->takes = false;
    }
}

static void tell_due(const struct dalcs_logic_run *l, long since) {
    if (l->observer != NULL) {
        l->observer->due(l->observer->user, since);
    }
}

/* One that ends is followed by a time in which no other begins. */
static bool end_pulses(struct dalcs_logic_run *l, double t) {
    bool any = false;
    for (int i = 0; i < l->n_pulses; i++) {
        const int k = l->pulse[i];
        const struct dalcs_logic_gate *g = &l->network.gate[k];
        struct dalcs_logic_state *state = &l->network.state[k];
        struct dalcs_logic_output *o = &l->output[k];
        while (o->ends <= t + resolution(l)) {
            tell_due(l, o->ends_since);
            dalcs_logic_touch(&l->network, k, false);
            const bool rests = state->count == 1 && !g->pulse.is_retriggered;
            if (state->q) {
                state->q = state->is_forced = false;
                dalcs_logic_queue(l, k, state);
                any = true;
            }
            state->count = rests ? 2 : 0;
            o->ends = rests ? o->ends + g->pulse.recovery : INFINITY;
        }
    }
    return any;
}

bool dalcs_logic_release(struct dalcs_logic_run *l, double t) {
    bool any = end_pulses(l, t);
    for (int i = l->waits.n - 1; i >= 0; i--) {
        const int k = l->waits.gate[i];
        struct dalcs_logic_output *o = &l->output[k];
        while (o->n_due > 0 && o->due[o->first_due].t <= t + resolution(l)) {
            tell_due(l, o->due[o->first_due].since);
            l->network.state[k].seen = !l->network.state[k].seen;
            dalcs_logic_touch(&l->network, k, true);
            o->first_due++;
            o->n_due--;
            any = true;
        }
        if (o->n_due == 0 && isinf(o->ends)) {
            l->waits.has[k] = false;
            l->waits.gate[i] = l->waits.gate[--l->waits.n];
        }
    }
    return any;
}

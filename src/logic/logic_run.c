/* logic_run.c - the queue of logic, what its outputs show, and where that acts. */
#include "logic_outputs.h"

#include "radau.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Times nearer than this are one, s. */
static double resolution(const struct dalcs_logic_run *l) {
    return l->radau != NULL ? l->radau->resolution : 4.0 * l->euler->grid.resolution;
}

/* ---- The queue -------------------------------------------------------------------------------------------- */

static void queue(void *user, int gate, const struct dalcs_logic_state *next) {
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

/* Pulses that begin at t. */
static void start_pulses(struct dalcs_logic_run *l, double t) {
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
                queue(l, k, state);
                any = true;
            }
            state->count = rests ? 2 : 0;
            o->ends = rests ? o->ends + g->pulse.recovery : INFINITY;
        }
    }
    return any;
}

/* Has anything come due? */
static bool release(struct dalcs_logic_run *l, double t) {
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

/* ---- Events ------------------------------------------------------------------------------------------------ */

static void read_bits(struct dalcs_logic_run *l) {
    for (int k = 0; k < l->n_comparators; k++) {
        const struct dalcs_component *component = &l->euler->component[l->place[k].part];
        const bool bit = dalcs_osnsp_is_on(&component->osnsp, l->place[k].pair);
        if (bit != l->bit[k]) {
            struct dalcs_logic_change *change = &l->change[k];
            change->n = change->instant == l->instant ? change->n + 1 : 1;
            change->instant = l->instant;
            l->bit[k] = bit;
            dalcs_logic_touch_bit(&l->network, k);
        }
    }
}

bool dalcs_logic_run_flashed(const struct dalcs_logic_run *l, int comparator) {
    const struct dalcs_logic_change *change = &l->change[comparator];
    return change->instant == l->instant && change->n > 1;
}

bool dalcs_logic_run_is_at_rest(struct dalcs_logic_run *l) {
    if (l->circuit != NULL) {
        read_bits(l);
    }
    return l->circuit == NULL || dalcs_logic_is_at_rest(&l->network);
}

enum dalcs_status dalcs_logic_run_rest(struct dalcs_logic_run *l, bool *changed) {
    *changed = false;
    if (l->circuit == NULL) {
        return DALCS_OK;
    }
    read_bits(l);
    dalcs_logic_rest(&l->network);
    l->now = 0.0;
    for (int k = 0; k < l->network.n; k++) {
        l->output[k].n_due = 0;
        if (l->network.state[k].q != l->network.state[k].seen) {
            queue(l, k, &l->network.state[k]);
        }
        l->network.state[k].takes = false;
        DALCS_TRY(dalcs_logic_output_start(l, k, changed));
    }
    for (int k = 0; l->radau != NULL && k < l->radau->n_parts && *changed; k++) {
        dalcs_excitation_enter(&l->radau->part[k].excitation, 0.0);
    }
    return l->out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
}

/* Shows what has changed at t. *acts: something has. */
static enum dalcs_status show_changes(struct dalcs_logic_run *l, double t, bool *acts) {
    *acts = false;
    dalcs_logic_effect_begin(l);
    for (int i = 0; i < l->network.moved.n; i++) {
        const int k = l->network.moved.gate[i];
        l->network.moves[k] =
            l->network.state[k].seen != l->output[k].shown || l->network.state[k].takes;
        if (l->network.moves[k]) {
            DALCS_TRY(dalcs_logic_output_show(l, k, t));
            *acts = true;
        }
    }
    if (!*acts) {
        dalcs_logic_set_clear(&l->network.moved);
    }
    return l->inputs != NULL ? dalcs_logic_inputs_show(l, t, acts) : DALCS_OK;
}

/* All parts that the changes act on; implicit Euler looks at what is just after t. */
static enum dalcs_status disturb(struct dalcs_logic_run *l, double t) {
    for (int k = 0; k < l->euler->n_components && l->radau == NULL; k++) {
        dalcs_component_disturb(&l->euler->component[k], t);
    }
    if (l->radau == NULL) {
        return dalcs_euler_cross(l->euler);
    }
    for (int k = 0; k < l->radau->n_parts; k++) {
        struct dalcs_radau_part *part = &l->radau->part[k];
        if (!l->effect.acts[k]) {
            continue;
        }
        if (part->kind == DALCS_PART_STEPPED && part->segment.t < t) {
            dalcs_radau_cut(part, t);
            if (l->cut.tell != NULL) {
                l->cut.tell(l->cut.user, k, t);
            }
        }
        DALCS_TRY(dalcs_radau_disturb(l->radau, part, t, l->effect.changed));
    }
    return DALCS_OK;
}

/* Until nothing changes, what comes due at once included. */
static bool settle(struct dalcs_logic_run *l, double t, long most) {
    bool settles;
    do {
        (void)release(l, t);
        settles = dalcs_logic_settle(&l->network, l, queue);
        start_pulses(l, t);
    } while (settles && release(l, t) && most-- > 0);
    return settles && most >= 0;
}

/* Until nothing changes at t. Each round moves an output. Without a loop through the circuit a change passes each
 * comparator and each gate at most once on its way, there and, as with the positions of switches, back. */
static enum dalcs_status decide(struct dalcs_logic_run *l, double t) {
    const long most = 2L * (l->network.n + l->n_comparators + 1);
    bool acts = true;
    if (!l->is_open || l->now != t) {
        l->is_open = true;
        l->now = t;
        l->instant = l->network.instant = ++l->number;
    }
    for (long round = 0; acts; round++) {
        read_bits(l);
        if (!settle(l, t, most)) {
            return DALCS_NOT_CONVERGED;
        }
        DALCS_TRY(show_changes(l, t, &acts));
        if (l->out_of_memory) {
            return DALCS_E_NOMEM;
        }
        if (acts && round == most) {
            return DALCS_NOT_CONVERGED;
        }
        if (acts) {
            DALCS_TRY(disturb(l, t));
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_logic_decide_early(void *user, double t) {
    const enum dalcs_status status = decide(user, t);
    return status == DALCS_NOT_CONVERGED ? DALCS_OK : status;
}

enum dalcs_status dalcs_logic_run_at(struct dalcs_logic_run *l, double t) {
    if (l->circuit == NULL) {
        return DALCS_OK;
    }
    DALCS_TRY(decide(l, t));
    l->is_open = false;
    return l->observer != NULL ? l->observer->decided(l->observer->user, t, l->instant) : DALCS_OK;
}

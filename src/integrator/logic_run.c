/* logic_run.c - the queue of logic, what its outputs show, and where that acts. */
#include "logic_outputs.h"

#include "radau.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Set up ------------------------------------------------------------------------------------------- */

/* All switches by their names. */
static enum dalcs_status list_switches(const struct dalcs_euler *euler, struct dalcs_names *names,
                                       struct dalcs_logic_place **place) {
    size_t capacity = 0;
    for (int part = 0; part < euler->n_components; part++) {
        const struct dalcs_system *s = euler->component[part].system;
        for (int d = 0; d < s->n_pairs; d++) {
            if (s->pair[d].kind == DALCS_PAIR_SWITCH) {
                const size_t n = names->n;
                DALCS_TRY(dalcs_grow(place, &capacity, n + 1, sizeof(**place)));
                (*place)[n] = (struct dalcs_logic_place){part, d};
                DALCS_TRY(dalcs_names_set(names, s->pair[d].element, (int)n));
            }
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_logic_find_comparators(const struct dalcs_circuit *circuit,
                                               const struct dalcs_euler *euler,
                                               struct dalcs_logic_place *place) {
    struct dalcs_names names = {0};
    struct dalcs_logic_place *all = NULL;
    enum dalcs_status status = list_switches(euler, &names, &all);
    for (int k = 0; k < circuit->n_comparators && status == DALCS_OK; k++) {
        const int at = dalcs_names_find(&names, circuit->device[circuit->comparator[k]].name);
        status = at >= 0 ? DALCS_OK : DALCS_E_INTERNAL;
        place[k] = at >= 0 ? all[at] : (struct dalcs_logic_place){0};
    }
    dalcs_names_finish(&names);
    free(all);
    return status;
}

static enum dalcs_status allocate(struct dalcs_logic_run *l) {
    const size_t n = (size_t)l->circuit->n_gates;
    const size_t n_comparators = (size_t)l->circuit->n_comparators;
    const size_t n_stimuli = (size_t)l->circuit->n_stimuli;
    struct dalcs_logic_network *w = &l->network;
    l->bit = dalcs_alloc(n_comparators + 1, sizeof(*l->bit));
    l->place = dalcs_alloc(n_comparators + 1, sizeof(*l->place));
    l->output = dalcs_alloc(n, sizeof(*l->output));
    l->sample = dalcs_alloc(n, sizeof(*l->sample));
    l->taken = dalcs_alloc(n, sizeof(*l->taken));
    l->changed = dalcs_alloc(n_stimuli, sizeof(*l->changed));
    l->as_built = dalcs_alloc(n_stimuli, sizeof(*l->as_built));
    w->state = dalcs_alloc(n, sizeof(*w->state));
    w->next = dalcs_alloc(n, sizeof(*w->next));
    w->mark = dalcs_alloc(n, sizeof(*w->mark));
    w->moves = dalcs_alloc(n, sizeof(*w->moves));
    bool complete = l->bit != NULL && l->place != NULL && l->output != NULL && l->sample != NULL &&
                    l->taken != NULL && l->changed != NULL && l->as_built != NULL &&
                    w->state != NULL && w->next != NULL && w->mark != NULL && w->moves != NULL;
    if (complete) {
        memcpy(l->as_built, l->circuit->stimulus, n_stimuli * sizeof(*l->as_built));
    }
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_logic_run_setup(struct dalcs_logic_run *l, struct dalcs_circuit *circuit,
                                        struct dalcs_euler *euler, struct dalcs_radau *radau) {
    *l = (struct dalcs_logic_run){.euler = euler, .radau = radau};
    if (circuit->n_gates == 0 && circuit->n_externals == 0) {
        return DALCS_OK;
    }
    l->circuit = circuit;
    l->n_comparators = circuit->n_comparators;
    l->network.n = circuit->n_gates;
    l->network.gate = circuit->gate;
    enum dalcs_status status = allocate(l);
    l->network.bit = l->bit;
    status = status == DALCS_OK ? dalcs_logic_find_comparators(circuit, euler, l->place) : status;
    for (int k = 0; k < l->network.n && status == DALCS_OK; k++) {
        struct dalcs_logic_state *state = &l->network.state[k];
        state->q = state->seen = circuit->gate[k].initial;
        state->count = circuit->gate[k].first;
        l->output[k].ends = INFINITY;
        if (circuit->gate[k].sampled >= 0) {
            l->sample[l->n_samples++] = k;
        }
    }
    if (status != DALCS_OK) {
        dalcs_logic_run_finish(l);
    }
    return status;
}

void dalcs_logic_run_finish(struct dalcs_logic_run *l) {
    for (int k = 0; l->output != NULL && k < l->network.n; k++) {
        struct dalcs_logic_output *o = &l->output[k];
        free(o->time);
        free(o->value);
        free(o->time_bar);
        free(o->value_bar);
        free(o->due);
    }
    if (l->as_built != NULL) {
        memcpy(l->circuit->stimulus, l->as_built,
               (size_t)l->circuit->n_stimuli * sizeof(*l->as_built));
    }
    free(l->bit);
    free(l->place);
    free(l->output);
    free(l->sample);
    free(l->taken);
    free(l->changed);
    free(l->as_built);
    free(l->network.state);
    free(l->network.next);
    free(l->network.mark);
    free(l->network.moves);
    *l = (struct dalcs_logic_run){0};
}

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
}

double dalcs_logic_run_next(const struct dalcs_logic_run *l) {
    double next = INFINITY;
    for (int k = 0; l->circuit != NULL && k < l->network.n; k++) {
        const struct dalcs_logic_output *o = &l->output[k];
        next = fmin(next, o->n_due > 0 ? fmin(o->ends, o->due[o->first_due].t) : o->ends);
    }
    return next;
}

/* Pulses that begin at t. */
static void start_pulses(struct dalcs_logic_run *l, double t) {
    for (int k = 0; k < l->network.n; k++) {
        const struct dalcs_logic_gate *g = &l->network.gate[k];
        struct dalcs_logic_state *state = &l->network.state[k];
        if (g->kind != DALCS_GATE_MONOSTABLE) {
            continue;
        }
        if (state->takes) {
            l->output[k].ends =
                t + g->pulse.lead + (g->sampled >= 0 ? fmax(0.0, l->taken[k]) : g->pulse.length);
            l->output[k].ends_since = ++l->number;
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
    for (int k = 0; k < l->network.n; k++) {
        const struct dalcs_logic_gate *g = &l->network.gate[k];
        struct dalcs_logic_state *state = &l->network.state[k];
        struct dalcs_logic_output *o = &l->output[k];
        while (o->ends <= t + resolution(l)) {
            tell_due(l, o->ends_since);
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
    for (int k = 0; k < l->network.n; k++) {
        struct dalcs_logic_output *o = &l->output[k];
        while (o->n_due > 0 && o->due[o->first_due].t <= t + resolution(l)) {
            tell_due(l, o->due[o->first_due].since);
            l->network.state[k].seen = !l->network.state[k].seen;
            o->first_due++;
            o->n_due--;
            any = true;
        }
    }
    return any;
}

/* ---- Events ------------------------------------------------------------------------------------------------ */

static void read_bits(struct dalcs_logic_run *l) {
    for (int k = 0; k < l->n_comparators; k++) {
        const struct dalcs_component *component = &l->euler->component[l->place[k].part];
        l->bit[k] = dalcs_osnsp_is_on(&component->osnsp, l->place[k].pair);
    }
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
    memset(l->changed, 0, (size_t)l->circuit->n_stimuli * sizeof(bool));
    for (int k = 0; k < l->network.n; k++) {
        l->network.moves[k] =
            l->network.state[k].seen != l->output[k].shown || l->network.state[k].takes;
        if (l->network.moves[k]) {
            DALCS_TRY(dalcs_logic_output_show(l, k, t));
            *acts = true;
        }
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
        if (!dalcs_radau_is_disturbed(part, l->changed)) {
            continue;
        }
        if (part->kind == DALCS_PART_STEPPED && part->segment.t < t) {
            dalcs_radau_cut(part, t);
            if (l->cut.tell != NULL) {
                l->cut.tell(l->cut.user, k, t);
            }
        }
        DALCS_TRY(dalcs_radau_disturb(l->radau, part, t, l->changed));
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

/* Each round moves an output. Without a loop through the circuit a change passes each comparator and each gate at most
 * once on its way, there and, as with the positions of switches, back. */
enum dalcs_status dalcs_logic_run_at(struct dalcs_logic_run *l, double t) {
    const long most = 2L * (l->network.n + l->n_comparators + 1);
    bool acts = l->circuit != NULL;
    l->now = t;
    l->instant = ++l->number;
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
    return l->circuit != NULL && l->observer != NULL
               ? l->observer->decided(l->observer->user, t, l->instant)
               : DALCS_OK;
}

/* logic_run.c - what gates decide at an instant, in waves.
 *
 * A wave is what has come from outside at once: events, commands, what is due, and what comparators make of sources that
 * jump, which is looked at before anything begins. What has no memory passes it on, through the circuit, too, until
 * nothing changes. Then what has memory acts, once. What the circuit makes of that is the next wave. */
#include "logic_outputs.h"

#include "guard_scale.h"
#include "logic_queue.h"
#include "look_behind.h"
#include "radau.h"

#include <string.h>

/* What has come from outside has been there: where gates undo it through the circuit, memory sees it before it goes. */
static bool is_to_stay(const struct dalcs_logic_run *l, int comparator, bool is_answer) {
    return is_answer && l->change[comparator].wave == l->wave;
}

/* is_answer: to what gates show, within a wave. Returns whether any is another one. */
static bool read_bits(struct dalcs_logic_run *l, bool is_answer) {
    bool any = false;
    for (int k = 0; k < l->n_comparators; k++) {
        const struct dalcs_component *component = &l->euler->component[l->place[k].part];
        const bool bit = dalcs_osnsp_is_on(&component->osnsp, l->place[k].pair);
        if (bit == l->bit[k]) {
            continue;
        }
        if (is_to_stay(l, k, is_answer)) {
            l->is_late = true;
            continue;
        }
        any = true;
        l->change[k].wave = is_answer ? l->change[k].wave : l->wave;
        dalcs_logic_touch_bit(&l->network, k, l->bit[k]);
        l->bit[k] = bit;
    }
    return any;
}

/* What comparators say is what memory acts on now: a change before that which has gone back has been for nobody. */
static void count_changes(struct dalcs_logic_run *l) {
    for (int k = 0; k < l->n_comparators; k++) {
        struct dalcs_logic_change *change = &l->change[k];
        if (change->bit != l->bit[k]) {
            change->n = change->instant == l->instant ? change->n + 1 : 1;
            change->instant = l->instant;
            change->bit = l->bit[k];
        }
    }
}

bool dalcs_logic_run_flashed(const struct dalcs_logic_run *l, int comparator) {
    const struct dalcs_logic_change *change = &l->change[comparator];
    return change->instant == l->instant && change->n > 1;
}

bool dalcs_logic_run_is_at_rest(struct dalcs_logic_run *l) {
    if (l->circuit != NULL) {
        (void)read_bits(l, false);
    }
    return l->circuit == NULL || dalcs_logic_is_at_rest(&l->network);
}

enum dalcs_status dalcs_logic_run_rest(struct dalcs_logic_run *l, bool with_memory, bool *changed) {
    *changed = false;
    if (l->circuit == NULL) {
        return DALCS_OK;
    }
    (void)read_bits(l, false);
    dalcs_logic_rest(&l->network, with_memory);
    l->now = 0.0;
    for (int k = 0; k < l->network.n; k++) {
        l->output[k].n_due = 0;
        if (l->network.state[k].q != l->network.state[k].seen) {
            dalcs_logic_queue(l, k, &l->network.state[k]);
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
        const bool moves =
            l->network.state[k].seen != l->output[k].shown || l->network.state[k].takes;
        l->network.moves[k] = moves || (l->network.gathers && l->network.moves[k]);
        if (moves) {
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
        l->effect.disturbed[k] = l->instant;
    }
    return DALCS_OK;
}

/* Until nothing changes, what comes due at once included. */
static bool settle(struct dalcs_logic_run *l, double t, long most) {
    bool settles;
    do {
        (void)dalcs_logic_release(l, t);
        settles = dalcs_logic_settle(&l->network, l, dalcs_logic_queue);
        dalcs_logic_start_pulses(l, t);
    } while (settles && dalcs_logic_release(l, t) && most-- > 0);
    return settles && most >= 0;
}

static bool is_comparator(const struct dalcs_logic_run *l, int part, int pair) {
    bool is = false;
    for (int i = 0; i < l->n_comparators && !is; i++) {
        is = l->place[i].part == part && l->place[i].pair == pair;
    }
    return is;
}

/* May what comparators of a part read jump at the instant where its segment has ended? */
static bool may_jump(const struct dalcs_logic_run *l, int k) {
    const struct dalcs_radau_part *part = &l->radau->part[k];
    const bool starts = part->segment.t == 0.0 &&
                        (l->radau->is_given || dalcs_component_jumps_at_start(part->component));
    bool may = starts || part->guards.leaps;
    for (int i = 0; i < part->guards.n_crossed && !may; i++) {
        may = !is_comparator(l, k, dalcs_guard_pair(part, part->guards.crossed[i]));
    }
    return may;
}

static bool is_to_look_at(const struct dalcs_logic_run *l, int k) {
    const struct dalcs_logic_effect *e = &l->effect;
    return e->reads[k] && l->radau->part[k].waits &&
           (e->looked[k] == l->instant ? e->disturbed[k] == l->instant
                                       : e->disturbed[k] == l->instant || may_jump(l, k));
}

/* Has a switch moved, in part->work.mode_first, that is no comparator? */
static bool has_moved(const struct dalcs_logic_run *l, int k) {
    const struct dalcs_radau_part *part = &l->radau->part[k];
    const struct dalcs_positions *p = &part->component->positions;
    bool has = false;
    for (int i = 0; i < p->n && !has; i++) {
        const bool is_on = dalcs_osnsp_is_on(p->osnsp, p->pair[i]);
        has = dalcs_mode_has(part->work.mode_first, p->pair[i]) != is_on &&
              !is_comparator(l, k, p->pair[i]);
    }
    return has;
}

/* Does one that remembers act on a part, and has still to decide? */
static bool is_acted_on(const struct dalcs_logic_run *l, int k) {
    const struct dalcs_logic_effect *e = &l->effect;
    bool is = false;
    for (int i = 0; i < 2 * l->network.asked.n && !is; i++) {
        const struct dalcs_logic_gate *g = &l->network.gate[l->network.asked.gate[i / 2]];
        const int stimulus = g->output[i % 2];
        const bool remembers = g->kind == DALCS_GATE_LATCH || dalcs_gate_has_clock(g);
        for (int n = stimulus >= 0 ? e->first[stimulus] : 0;
             stimulus >= 0 && remembers && n < e->first[stimulus + 1] && !is; n++) {
            is = e->part[n] == k;
        }
    }
    return is;
}

/* Comparators of a part that waits to begin, where what they read has jumped since it was looked at: as they stand behind that,
 * before any state jumps with it. */
static enum dalcs_status look_at(struct dalcs_logic_run *l, int k) {
    struct dalcs_radau_part *part = &l->radau->part[k];
    l->effect.looked[k] = l->instant;
    l->effect.disturbed[k] = 0;
    DALCS_TRY(dalcs_look_behind(l->radau, part, part->work.mode_first));
    if (has_moved(l, k) && is_acted_on(l, k)) {
        return DALCS_OK; /* another switch of the same leg may be to move with it: all of it is for the part to find */
    }
    for (int i = 0; i < l->n_comparators; i++) {
        const struct dalcs_logic_place *place = &l->place[i];
        if (place->part == k && !is_to_stay(l, i, true)) {
            dalcs_osnsp_command(&part->component->osnsp, place->pair,
                                dalcs_mode_has(part->work.mode_first, place->pair));
        }
    }
    return DALCS_OK;
}

static enum dalcs_status look(struct dalcs_logic_run *l) {
    for (int k = 0; l->radau != NULL && k < l->radau->n_parts; k++) {
        if (is_to_look_at(l, k)) {
            DALCS_TRY(look_at(l, k));
        }
    }
    return DALCS_OK;
}

/* What has come from outside: events, commands, what is due, and, before anything else is decided, what comparators make of
 * sources that jump. */
static enum dalcs_status begin_wave(struct dalcs_logic_run *l, double t, bool is_first) {
    l->wave++;
    l->is_late = false;
    (void)read_bits(l, false);
    (void)dalcs_logic_release(l, t);
    if (is_first || l->network.asked.n > 0) {
        DALCS_TRY(look(l));
        (void)read_bits(l, true);
    }
    return DALCS_OK;
}

/* What passes from gates to gates through the circuit is shown, and read there. *differs: some comparator does. */
static enum dalcs_status answer(struct dalcs_logic_run *l, double t, bool *differs) {
    bool acts;
    *differs = false;
    DALCS_TRY(show_changes(l, t, &acts));
    if (acts) {
        DALCS_TRY(disturb(l, t));
        DALCS_TRY(look(l));
        *differs = read_bits(l, true);
    }
    return DALCS_OK;
}

/* Gates without memory: before others decide, the circuit has what they make of what has come, and they have what the
 * circuit makes of that. So it does not count which way an input has come. Where that goes on and on, memory is to end it. */
static enum dalcs_status pass_without_memory(struct dalcs_logic_run *l, double t, long most) {
    bool differs = true;
    if (l->network.asked.n == 0) {
        return DALCS_OK;
    }
    for (long round = 0; differs && round < most; round++) {
        (void)dalcs_logic_pass(&l->network, DALCS_RANK_WITHOUT_MEMORY, l, dalcs_logic_queue);
        DALCS_TRY(answer(l, t, &differs));
    }
    count_changes(l);
    return DALCS_OK;
}

/* Where waves go on, the second half of those that are allowed tells which gates move in them: what a gate does in the last one
 * may be undone in it. */
static void gather_moves(struct dalcs_logic_network *network, bool gathers) {
    if (gathers && !network->gathers) {
        memset(network->moves, 0, (size_t)network->n * sizeof(bool));
    }
    network->gathers = gathers;
}

/* Until nothing changes at t. Each wave moves an output. Without a loop through the circuit a change passes each
 * comparator and each gate at most once on its way, there and, as with the positions of switches, back. */
static enum dalcs_status decide(struct dalcs_logic_run *l, double t) {
    const long most = 2L * (l->network.n + l->n_comparators + 1);
    long rounds = most;
    bool acts = true;
    bool is_first = !l->is_open || l->now != t;
    if (is_first) {
        l->is_open = true;
        l->now = t;
        l->instant = l->network.instant = ++l->number;
    }
    while (acts || l->is_late) {
        gather_moves(&l->network, rounds <= most / 2);
        DALCS_TRY(begin_wave(l, t, is_first));
        is_first = false;
        DALCS_TRY(pass_without_memory(l, t, most));
        if (!settle(l, t, most)) {
            return DALCS_NOT_CONVERGED;
        }
        DALCS_TRY(show_changes(l, t, &acts));
        if (l->out_of_memory) {
            return DALCS_E_NOMEM;
        }
        if ((acts || l->is_late) && rounds-- <= 0) {
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

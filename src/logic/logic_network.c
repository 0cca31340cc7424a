/* logic_network.c - what gates, flip-flops and samples decide.
 *
 * What comes from outside at one instant passes what has no memory first, then latches: a set and a reset may come through
 * different numbers of gates, and a latch must not keep what one of them was before the other one has come. Then, in a
 * round, each gate decides from what all showed before it, as in the delta cycles of hardware languages: a reset that
 * its own output takes away clears all that it reaches. A clock takes what has come from outside, but of what such rounds
 * have changed it takes what stood before them: all flip-flops of one instant act at once. What a round makes is a function of the state alone, so that a network that does not settle comes back to a state, and one that
 * comes back does not settle: Brent's way finds that without a bound to choose. */
#include "logic_network.h"

#include <string.h>

void dalcs_logic_set_add(struct dalcs_logic_set *set, int gate) {
    if (!set->has[gate]) {
        set->has[gate] = true;
        set->gate[set->n++] = gate;
    }
}

void dalcs_logic_set_clear(struct dalcs_logic_set *set) {
    for (int i = 0; i < set->n; i++) {
        set->has[set->gate[i]] = false;
    }
    set->n = 0;
}

static void ask_readers(struct dalcs_logic_network *l, int source) {
    for (int i = l->first_reader[source]; i < l->first_reader[source + 1]; i++) {
        dalcs_logic_set_add(&l->asked, l->reader[i]);
    }
}

/* What others read of a gate, or behind all of them of a comparator, is another bit now. */
static void note_change(struct dalcs_logic_network *l, int source, bool before) {
    if (l->was[source].instant != l->instant) {
        l->was[source] = (struct dalcs_logic_was){l->instant, before};
    }
}

void dalcs_logic_touch(struct dalcs_logic_network *l, int gate, bool seen) {
    dalcs_logic_set_add(&l->asked, gate);
    dalcs_logic_set_add(&l->marked, gate);
    dalcs_logic_set_add(&l->moved, gate);
    if (seen) {
        ask_readers(l, gate);
    }
}

void dalcs_logic_touch_bit(struct dalcs_logic_network *l, int comparator, bool before) {
    const int source = l->n + comparator;
    ask_readers(l, source);
    if (l->acted == l->instant) {
        note_change(l, source, before);
    }
}

void dalcs_logic_touch_all(struct dalcs_logic_network *l) {
    for (int k = 0; k < l->n; k++) {
        dalcs_logic_touch(l, k, false);
    }
}

static bool read(const struct dalcs_logic_network *l, const struct dalcs_logic_input *input) {
    bool bit = input->from == DALCS_GATE_COMPARATOR ? l->bit[input->index]
               : input->from == DALCS_GATE_GATE     ? l->state[input->index].seen
                                                    : false;
    return bit != input->is_inverted;
}

/* As it stood before flip-flops changed it in this instant. */
static bool read_before(const struct dalcs_logic_network *l,
                        const struct dalcs_logic_input *input) {
    const int source = input->from == DALCS_GATE_COMPARATOR ? l->n + input->index : input->index;
    if (input->from == DALCS_GATE_OPEN || l->was[source].instant != l->instant) {
        return read(l, input);
    }
    return l->was[source].bit != input->is_inverted;
}

static bool of_inputs(const struct dalcs_logic_network *l, const struct dalcs_logic_gate *g) {
    int n = 0;
    int n_high = 0;
    for (int k = 0; k < g->n_inputs; k++) {
        if (g->input[k].from != DALCS_GATE_OPEN) {
            n++;
            n_high += read(l, &g->input[k]) ? 1 : 0;
        }
    }
    return g->kind == DALCS_GATE_AND   ? n_high == n
           : g->kind == DALCS_GATE_XOR ? n_high % 2 == 1
           : g->kind == DALCS_GATE_ONE ? n_high == 1
                                       : n_high > 0;
}

static bool of_latch(const struct dalcs_logic_network *l, const struct dalcs_logic_gate *g,
                     bool q) {
    const bool set = read(l, &g->input[0]);
    const bool reset = read(l, &g->input[1]);
    return !reset && (set || q);
}

static bool rises(const struct dalcs_logic_network *l, bool clock,
                  const struct dalcs_logic_state *before) {
    return clock && !before->clock && !l->rests;
}

/* What q becomes where the clock rises, or while it is high. */
static bool next(const struct dalcs_logic_network *l, const struct dalcs_logic_gate *g, bool q) {
    bool (*of)(const struct dalcs_logic_network *, const struct dalcs_logic_input *) =
        dalcs_gate_is_transparent(g) ? read : read_before;
    const bool data = of(l, &g->input[DALCS_GATE_DATA]);
    const bool reset = of(l, &g->input[DALCS_GATE_RESET]);
    return g->kind == DALCS_GATE_TOGGLE                                 ? q != data
           : g->kind == DALCS_GATE_JK                                   ? (q ? !reset : data)
           : g->kind == DALCS_GATE_SR || g->kind == DALCS_GATE_SR_LATCH ? !reset && (data || q)
                                                                        : data;
}

static void go_flip_flop(const struct dalcs_logic_network *l, const struct dalcs_logic_gate *g,
                         struct dalcs_logic_state *state) {
    const bool clock = read(l, &g->input[DALCS_GATE_CLOCK]);
    const bool clears = read(l, &g->input[DALCS_GATE_CLEAR]);
    state->is_forced = clears || read(l, &g->input[DALCS_GATE_PRESET]);
    if (state->is_forced) {
        state->q = !clears;
    } else if (dalcs_gate_is_transparent(g) ? clock : rises(l, clock, state)) {
        state->q = next(l, g, state->q);
    }
    state->clock = clock;
}

static void go_counter(const struct dalcs_logic_network *l, const struct dalcs_logic_gate *g,
                       struct dalcs_logic_state *state) {
    const bool clock = read(l, &g->input[0]);
    if (read(l, &g->input[1])) {
        state->count = 0;
    } else if (rises(l, clock, state)) {
        state->count = state->count % g->cycles + 1;
    }
    state->q = state->count > 0 && state->count <= g->n_high;
    state->clock = clock;
}

/* q: its input is shown, not what is held. What is held is taken where the clock rises, and where that ends. */
static void go_sample(const struct dalcs_logic_network *l, const struct dalcs_logic_gate *g,
                      struct dalcs_logic_state *state) {
    const bool clock = read(l, &g->input[DALCS_GATE_CLOCK]);
    const bool tracks = read(l, &g->input[DALCS_GATE_PRESET]);
    state->takes = state->takes || rises(l, clock, state) || (state->q && !tracks && !l->rests);
    state->q = tracks;
    state->clock = clock;
}

/* How a pulse ends, time says. */
static void go_monostable(const struct dalcs_logic_network *l, const struct dalcs_logic_gate *g,
                          struct dalcs_logic_state *state) {
    const bool clock = read(l, &g->input[DALCS_GATE_CLOCK]);
    state->is_forced = read(l, &g->input[DALCS_GATE_CLEAR]);
    if (state->is_forced) {
        state->q = state->takes = false;
        state->count = 0;
    } else if (rises(l, clock, state) && (state->count == 0 || g->pulse.is_retriggered)) {
        state->q = state->takes = true;
        state->count = 1;
    }
    state->clock = clock;
}

static struct dalcs_logic_state decide(const struct dalcs_logic_network *l, int k) {
    const struct dalcs_logic_gate *g = &l->gate[k];
    struct dalcs_logic_state state = l->state[k];
    if (g->kind == DALCS_GATE_LATCH) {
        state.q = of_latch(l, g, state.q);
    } else if (g->kind == DALCS_GATE_COUNTER) {
        go_counter(l, g, &state);
    } else if (g->kind == DALCS_GATE_SAMPLE) {
        go_sample(l, g, &state);
    } else if (g->kind == DALCS_GATE_MONOSTABLE) {
        go_monostable(l, g, &state);
    } else if (dalcs_gate_has_clock(g)) {
        go_flip_flop(l, g, &state);
    } else {
        state.q = of_inputs(l, g);
    }
    state.seen = dalcs_gate_has_delay(g) ? state.seen : state.q;
    return state;
}

static bool is_same(const struct dalcs_logic_state *a, const struct dalcs_logic_state *b) {
    return a->q == b->q && a->seen == b->seen && a->clock == b->clock && a->count == b->count &&
           a->takes == b->takes;
}

static enum dalcs_logic_rank rank_of(const struct dalcs_logic_gate *g) {
    if (dalcs_gate_has_delay(g)) {
        return DALCS_RANK_ALL;
    }
    if (g->kind == DALCS_GATE_LATCH || dalcs_gate_is_transparent(g)) {
        return DALCS_RANK_LATCHES;
    }
    return dalcs_gate_has_clock(g) ? DALCS_RANK_ALL : DALCS_RANK_WITHOUT_MEMORY;
}

static enum dalcs_logic_rank lowest_asked(const struct dalcs_logic_network *l) {
    enum dalcs_logic_rank lowest = DALCS_RANK_ALL;
    for (int i = 0; i < l->asked.n && lowest > DALCS_RANK_WITHOUT_MEMORY; i++) {
        const enum dalcs_logic_rank rank = rank_of(&l->gate[l->asked.gate[i]]);
        lowest = rank < lowest ? rank : lowest;
    }
    return lowest;
}

/* Those asked up to a rank are those of the next round; the others stay asked. */
static void take_asked(struct dalcs_logic_network *l, enum dalcs_logic_rank rank) {
    int n = 0;
    for (int i = 0; i < l->asked.n; i++) {
        const int k = l->asked.gate[i];
        if (rank_of(&l->gate[k]) <= rank) {
            l->asked.has[k] = false;
            dalcs_logic_set_add(&l->round, k);
        } else {
            l->asked.gate[n++] = k;
        }
    }
    l->asked.n = n;
}

/* One round; does anything change? */
static bool change(struct dalcs_logic_network *l, enum dalcs_logic_rank rank, void *user,
                   void (*on_q)(void *user, int gate, const struct dalcs_logic_state *next)) {
    bool any = false;
    take_asked(l, rank);
    const struct dalcs_logic_set asked = l->round;
    for (int i = 0; i < asked.n; i++) {
        l->next[asked.gate[i]] = decide(l, asked.gate[i]);
    }
    for (int i = 0; i < asked.n; i++) {
        const int k = asked.gate[i];
        const struct dalcs_logic_state before = l->state[k];
        if (l->next[k].q != before.q) {
            on_q(user, k, &l->next[k]);
        }
        l->state[k] = l->next[k];
        if (!is_same(&l->state[k], &before)) {
            const bool is_seen = l->state[k].seen != before.seen;
            if (is_seen && rank == DALCS_RANK_ALL) {
                note_change(l, k, before.seen);
                l->acted = l->instant;
            }
            dalcs_logic_touch(l, k, is_seen);
            any = true;
        }
    }
    dalcs_logic_set_clear(&l->round);
    return any;
}

bool dalcs_logic_pass(struct dalcs_logic_network *l, enum dalcs_logic_rank most, void *user,
                      void (*on_q)(void *user, int gate, const struct dalcs_logic_state *next)) {
    enum dalcs_logic_rank rank = lowest_asked(l);
    for (int k = 0; k <= 2 * l->n && rank <= most; k++) {
        (void)change(l, rank, user, on_q);
        rank = lowest_asked(l);
    }
    return l->asked.n > 0;
}

static bool has_memory(const struct dalcs_logic_gate *g) {
    return g->kind == DALCS_GATE_LATCH || dalcs_gate_has_clock(g);
}

void dalcs_logic_rest(struct dalcs_logic_network *l, bool with_memory) {
    bool any = true;
    l->rests = true;
    for (int pass = 0; pass <= l->n && any; pass++) {
        any = false;
        for (int k = 0; k < l->n; k++) {
            const bool holds = !with_memory && has_memory(&l->gate[k]);
            struct dalcs_logic_state state = holds ? l->state[k] : decide(l, k);
            any = any || state.q != l->state[k].q;
            state.seen = state.q;
            l->state[k] = state;
        }
    }
    for (int k = 0; k < l->n; k++) { /* what is still to come, for those with a delay */
        const bool is_asked =
            dalcs_gate_has_delay(&l->gate[k]) && (with_memory || !has_memory(&l->gate[k]));
        l->state[k].q = is_asked ? decide(l, k).q : l->state[k].q;
    }
    l->rests = false;
    dalcs_logic_touch_all(l);
}

bool dalcs_logic_is_at_rest(struct dalcs_logic_network *l) {
    bool rests = true;
    l->rests = true;
    for (int k = 0; k < l->n; k++) {
        l->moves[k] = decide(l, k).q != l->state[k].seen;
        rests = rests && !l->moves[k];
    }
    l->rests = false;
    return rests;
}

static bool is_at_mark(const struct dalcs_logic_network *l) {
    bool is = true;
    for (int i = 0; i < l->marked.n && is; i++) {
        is = is_same(&l->state[l->marked.gate[i]], &l->mark[l->marked.gate[i]]);
    }
    return is;
}

static void set_mark(struct dalcs_logic_network *l) {
    for (int i = 0; i < l->marked.n; i++) {
        l->mark[l->marked.gate[i]] = l->state[l->marked.gate[i]];
    }
    dalcs_logic_set_clear(&l->marked);
}

static void note_moves(void *user, int gate, const struct dalcs_logic_state *next) {
    struct dalcs_logic_network *l = user;
    (void)next;
    l->moves[gate] = true;
}

/* Once round. */
static void find_loop(struct dalcs_logic_network *l) {
    memset(l->moves, 0, (size_t)l->n * sizeof(bool));
    do {
        (void)change(l, DALCS_RANK_ALL, l, note_moves);
    } while (!is_at_mark(l));
}

bool dalcs_logic_settle(struct dalcs_logic_network *l, void *user,
                        void (*on_q)(void *user, int gate, const struct dalcs_logic_state *next)) {
    (void)dalcs_logic_pass(l, DALCS_RANK_LATCHES, user, on_q);
    set_mark(l);
    for (long round = 1; change(l, DALCS_RANK_ALL, user, on_q); round++) {
        if (is_at_mark(l)) {
            find_loop(l);
            return false;
        }
        if ((round & (round - 1)) == 0) {
            set_mark(l);
        }
    }
    return true;
}

/* logic_network.h - gates, flip-flops and samples at one instant: from bits to bits, by rounds in which all decide at once. */
#ifndef DALCS_LOGIC_NETWORK_H
#define DALCS_LOGIC_NETWORK_H

#include "circuit.h"

struct dalcs_logic_state {
    bool q;     /* what the inputs make of it */
    bool seen;  /* q a delay ago: what others read and the output shows */
    bool clock; /* its level */
    int count; /* of clocks, from 1 to those of a cycle; 0: none yet; of a monostable 1 in a pulse, 2 behind it */
    bool is_forced; /* q, by preset or clear */
    bool takes;     /* a sample takes what stood before this instant, a pulse begins */
};

/* Some of the gates, each once. */
struct dalcs_logic_set {
    int n, *gate; /* [n] */
    bool *has;    /* [n gates] */
};

/* Which gates decide first. A delay ends what others read of a gate at this instant, so that it waits for the last ones. */
enum dalcs_logic_rank { DALCS_RANK_WITHOUT_MEMORY, DALCS_RANK_LATCHES, DALCS_RANK_ALL };

/* What others read of a gate, or what a comparator says, before flip-flops changed it, and in which instant. */
struct dalcs_logic_was {
    long instant;
    bool bit;
};

/* What has not changed, and reads nothing that has, decides as before: no round asks it. An instant costs what acts in it,
 * however many gates there are. */
struct dalcs_logic_network {
    int n;
    const struct dalcs_logic_gate *gate;   /* [n] */
    const bool *bit;                       /* of comparators */
    struct dalcs_logic_state *state;       /* [n] */
    struct dalcs_logic_state *next, *mark; /* [n] work */
    int *first_reader,
        *reader; /* of the bits of gate k, k < n, and of comparator k - n: first_reader[k] up to the next */
    struct dalcs_logic_set asked, round; /* to decide in the next round, and in this one */
    struct dalcs_logic_set marked;       /* whose state may differ from its mark */
    struct dalcs_logic_set moved; /* whose state has changed since what it shows was looked at */
    long instant;                 /* the number of this one, from 1 on */
    long acted;                   /* of the last one in which flip-flops have acted */
    struct dalcs_logic_was *was;  /* [n gates and comparators] */
    bool rests;                   /* a clock that stands high has not risen */
    bool *moves;  /* [n] after a failure: in the loop that does not settle, or not at rest */
    bool gathers; /* moves keeps what has moved before at this instant */
};

/* Behind n, gate and bit. */
enum dalcs_status dalcs_logic_network_setup(struct dalcs_logic_network *network,
                                            int n_comparators) DALCS_MUST_CHECK;
void dalcs_logic_network_finish(struct dalcs_logic_network *network);

enum dalcs_status dalcs_logic_set_setup(struct dalcs_logic_set *set, int n_gates) DALCS_MUST_CHECK;
void dalcs_logic_set_finish(struct dalcs_logic_set *set);
void dalcs_logic_set_add(struct dalcs_logic_set *set, int gate);
void dalcs_logic_set_clear(struct dalcs_logic_set *set);

/* The state of a gate has been changed from outside; seen: what others read of it, too. */
void dalcs_logic_touch(struct dalcs_logic_network *network, int gate, bool seen);

/* The bit of a comparator has changed. */
void dalcs_logic_touch_bit(struct dalcs_logic_network *network, int comparator, bool before);

/* All may have. */
void dalcs_logic_touch_all(struct dalcs_logic_network *network);

/* The states at rest as the bits have them, one gate after the other, with no delay. What has no rest goes on from there:
 * where gates in a ring differ, one does, as of a ring oscillator that runs. Without memory: what remembers stays, for what
 * it reads may not be at rest yet. */
void dalcs_logic_rest(struct dalcs_logic_network *network, bool with_memory);

/* Do all show what their inputs make of them, and will? If not, moves says which do not. */
bool dalcs_logic_is_at_rest(struct dalcs_logic_network *network);

/* What has come passes gates up to a rank, without the others. Without a loop each gate is asked no more often than there are
 * gates before it; a loop may need what waits to break it. Are any asked still? */
bool dalcs_logic_pass(struct dalcs_logic_network *network, enum dalcs_logic_rank most, void *user,
                      void (*on_q)(void *user, int gate, const struct dalcs_logic_state *next));

/* Until nothing changes, without time passing: gates with a delay change q alone. False: it goes round for ever, for a
 * state comes back. on_q is told of each change of a q, and of the state that it is part of. */
bool dalcs_logic_settle(struct dalcs_logic_network *network, void *user,
                        void (*on_q)(void *user, int gate, const struct dalcs_logic_state *next));

#endif

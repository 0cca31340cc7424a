/* steady_watch.h - the events of a run: when a part goes from one mode to another, and where its states are then; where no
 * part has modes, when gates turn over. */
#ifndef DALCS_STEADY_WATCH_H
#define DALCS_STEADY_WATCH_H

#include "logic_run.h"
#include "memory.h"
#include "radau_state.h"

/* Segments without an event, that a run is given: thousands of turns of what rings. */
enum { DALCS_WATCH_WITHOUT_EVENTS = 20000 };

struct dalcs_steady_event {
    double t; /* s */
    int part;
    uint64_t kind; /* of the modes before and after */
    double *x;     /* [n_x of the part] */
};

struct dalcs_steady_watch {
    enum dalcs_status status;
    long n_segments;
    int n, most;
    struct dalcs_steady_event *event; /* [n], of `most` */
    int n_parts;
    const struct dalcs_radau *radau; /* of the run that is observed */
    uint64_t *mode;                  /* [n_parts] the last one, and whether there was one */
    uint64_t *jumped; /* [n_parts] the mode of a jump since the last segment; 0: there was none */
    bool *begun;

    struct dalcs_watched_gates {
        const struct dalcs_logic_run *logic;
        struct dalcs_logic_observer observer;
        uint64_t seen; /* by others, at the last instant */
    } gates;

    struct dalcs_arena arena;
};

/* Of up to `most` events. */
enum dalcs_status dalcs_steady_watch_setup(struct dalcs_steady_watch *watch, int n_parts,
                                           int most) DALCS_MUST_CHECK;
/* Has it seen enough? */
bool dalcs_steady_watch_is_full(const struct dalcs_steady_watch *watch);

void dalcs_steady_watch_finish(struct dalcs_steady_watch *watch);

/* Gates are watched if nothing else in the circuit changes its side. */
void dalcs_steady_watch_gates(struct dalcs_steady_watch *watch, struct dalcs_logic_run *logic);

/* For radau->base->listener.observer; user is the watch. */
struct dalcs_observer dalcs_steady_watch_observer(struct dalcs_steady_watch *watch,
                                                  const struct dalcs_radau *radau);

/* The last event and one like it before, between which a period may lie: from -> to. False: no event has come twice. */
bool dalcs_steady_watch_recurs(const struct dalcs_steady_watch *watch,
                               const struct dalcs_radau *radau, int *from, int *to);

#endif

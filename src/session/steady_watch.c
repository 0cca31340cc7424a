/* steady_watch.c - events of a run, and which of them is which one come again. */
#include "steady_watch.h"

#include "segments_observer.h"

#include <math.h>
#include <string.h>

static uint64_t hash_of(const uint64_t *word, int n_words) {
    uint64_t mode = 0;
    for (int k = 0; k < n_words; k++) {
        mode = (mode ^ word[k]) * 0x9e3779b97f4a7c15u;
        mode ^= mode >> 29;
    }
    return mode;
}

static uint64_t mode_of(const struct dalcs_radau_part *part) {
    return hash_of(part->component->osnsp.mode, part->component->osnsp.n_words);
}

/* Where formulas are curved a part may oscillate in one mode: then its events are the extremes of its first state, which
 * lie in the segment before. */
static uint64_t direction_of(const struct dalcs_radau_part *part, const double *start) {
    return (mode_of(part) << 1) + (part->x[0] > start[0] ? 1u : 0u);
}

static void note_event(struct dalcs_steady_watch *watch, const struct dalcs_radau_part *part,
                       double t, const double *x, uint64_t kind) {
    const size_t n_x = (size_t)part->component->system->n_x;
    struct dalcs_steady_event *event = &watch->event[watch->n];
    event->x = dalcs_arena_alloc(&watch->arena, n_x + 1, sizeof(double));
    if (event->x == NULL) {
        watch->status = DALCS_E_NOMEM;
        return;
    }
    memcpy(event->x, x, n_x * sizeof(double));
    event->t = t;
    event->part = part->index;
    event->kind = kind;
    watch->n++;
}

static void segment(void *user, const struct dalcs_radau_part *part, const double *start) {
    struct dalcs_steady_watch *watch = user;
    watch->n_segments++;
    const uint64_t mode = part->smooth != NULL ? direction_of(part, start) : mode_of(part);
    const uint64_t jumped = watch->jumped[part->index];
    const bool is_new = mode != watch->mode[part->index];
    const uint64_t before = watch->mode[part->index] ^ (is_new ? 0 : jumped);
    const bool is_event = watch->begun[part->index] && (is_new || jumped != 0);
    watch->mode[part->index] = mode;
    watch->jumped[part->index] = 0;
    watch->begun[part->index] = true;
    if (!is_event || watch->n == watch->most || watch->status != DALCS_OK) {
        return;
    }
    note_event(watch, part, part->segment.t, start, (before * 0xff51afd7ed558ccdu) ^ mode);
}

/* A switch that closes and opens in one instant leaves the mode as it was, and moves charge: its mode is that of the jump. */
static void jump(void *user, const struct dalcs_euler_jump *told) {
    struct dalcs_steady_watch *watch = user;
    const struct dalcs_radau_part *part = &watch->radau->part[told->system];
    watch->jumped[told->system] =
        hash_of(part->work.mode_first, part->component->osnsp.n_words) | 1u;
}

/* ---- Gates ------------------------------------------------------------------------------------------------- */

static void ignore_due(void *user, long since) {
    (void)user;
    (void)since;
}

static void ignore_taken(void *user, int gate) {
    (void)user;
    (void)gate;
}

static void ignore_pulse(void *user, int gate, long number) {
    (void)user;
    (void)gate;
    (void)number;
}

static enum dalcs_status decided(void *user, double t, long number) {
    struct dalcs_steady_watch *watch = user;
    const struct dalcs_logic_run *logic = watch->gates.logic;
    const struct dalcs_radau_part *part = &logic->radau->part[0];
    uint64_t seen = 0;
    (void)number;
    for (int k = 0; k < logic->network.n; k++) {
        seen = (seen ^ (logic->network.state[k].seen ? 1u : 2u)) * 0x9e3779b97f4a7c15u;
        seen ^= seen >> 29;
    }
    const uint64_t before = watch->gates.seen;
    watch->gates.seen = seen;
    if (before != 0 && seen != before && watch->n < watch->most && watch->status == DALCS_OK) {
        note_event(watch, part, t, part->x, (before * 0xff51afd7ed558ccdu) ^ seen);
    }
    return watch->status;
}

void dalcs_steady_watch_gates(struct dalcs_steady_watch *watch, struct dalcs_logic_run *logic) {
    if (logic->circuit == NULL || logic->radau->part[0].component->system->n_pairs > 0) {
        return;
    }
    watch->gates.logic = logic;
    watch->gates.observer = (struct dalcs_logic_observer){.user = watch,
                                                          .due = ignore_due,
                                                          .took = ignore_taken,
                                                          .pulse = ignore_pulse,
                                                          .decided = decided};
    logic->observer = &watch->gates.observer;
}

/* ---- The watch --------------------------------------------------------------------------------------------- */

struct dalcs_observer dalcs_steady_watch_observer(struct dalcs_steady_watch *watch,
                                                  const struct dalcs_radau *radau) {
    struct dalcs_observer observer = dalcs_segments_observer(watch, segment);
    watch->radau = radau;
    observer.jump = jump;
    return observer;
}

bool dalcs_steady_watch_is_full(const struct dalcs_steady_watch *watch) {
    return watch->n == watch->most ||
           (watch->n == 0 && watch->n_segments >= DALCS_WATCH_WITHOUT_EVENTS);
}

enum dalcs_status dalcs_steady_watch_setup(struct dalcs_steady_watch *watch, int n_parts,
                                           int most) {
    *watch = (struct dalcs_steady_watch){.most = most, .n_parts = n_parts};
    watch->event = dalcs_arena_alloc(&watch->arena, (size_t)most, sizeof(*watch->event));
    watch->mode = dalcs_arena_alloc(&watch->arena, (size_t)n_parts + 1, sizeof(*watch->mode));
    watch->jumped = dalcs_arena_alloc(&watch->arena, (size_t)n_parts + 1, sizeof(*watch->jumped));
    watch->begun = dalcs_arena_alloc(&watch->arena, (size_t)n_parts + 1, sizeof(bool));
    if (watch->event == NULL || watch->mode == NULL || watch->jumped == NULL ||
        watch->begun == NULL) {
        dalcs_steady_watch_finish(watch);
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

void dalcs_steady_watch_finish(struct dalcs_steady_watch *watch) {
    dalcs_arena_finish(&watch->arena);
    *watch = (struct dalcs_steady_watch){0};
}

/* How far two states of a part are apart, each over what it moves by from event to event. */
static double distance(const struct dalcs_steady_watch *watch, int n_x, int one, int other) {
    const struct dalcs_steady_event *a = &watch->event[one];
    const struct dalcs_steady_event *b = &watch->event[other];
    double most = 0.0;
    for (int x = 0; x < n_x; x++) {
        double low = a->x[x];
        double high = a->x[x];
        for (int k = other; k <= one; k++) {
            const struct dalcs_steady_event *e = &watch->event[k];
            low = e->part == a->part ? fmin(low, e->x[x]) : low;
            high = e->part == a->part ? fmax(high, e->x[x]) : high;
        }
        const double off = fabs(a->x[x] - b->x[x]);
        most = off > 0.0 ? fmax(most, off / (high - low)) : most;
    }
    return most;
}

bool dalcs_steady_watch_recurs(const struct dalcs_steady_watch *watch,
                               const struct dalcs_radau *radau, int *from, int *to) {
    const int last = watch->n - 1;
    double nearest = INFINITY;
    if (last < 1) {
        return false;
    }
    const struct dalcs_steady_event *e = &watch->event[last];
    const int n_x = radau->part[e->part].component->system->n_x;
    for (int k = last - 1; k >= 0; k--) { /* a later one wins, unless one before is far nearer */
        const struct dalcs_steady_event *b = &watch->event[k];
        if (b->part != e->part || b->kind != e->kind) {
            continue;
        }
        const double off = distance(watch, n_x, last, k);
        if (off < 0.1 * nearest) {
            nearest = off;
            *from = k;
        }
    }
    *to = last;
    return nearest < INFINITY;
}

/* event_log.c - keeping events and jumps in bounded memory. */
#include "event_log.h"

#include "magnitudes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum dalcs_status dalcs_event_log_setup(struct dalcs_event_log *log,
                                        const struct dalcs_network *network, bool keep,
                                        size_t limit) {
    *log = (struct dalcs_event_log){.network = network, .keep = keep, .limit = limit};
    struct dalcs_arena *arena = &log->arena;
    log->seen = dalcs_arena_alloc(arena, (size_t)network->n_systems, sizeof(*log->seen));
    log->jump_state = dalcs_arena_alloc(arena, (size_t)network->n_states, sizeof(*log->jump_state));
    bool complete = log->seen != NULL && log->jump_state != NULL;
    size_t most_pairs = 0;
    for (int k = 0; complete && k < network->n_systems; k++) {
        size_t n_pairs = (size_t)network->system[k].n_pairs;
        most_pairs = n_pairs > most_pairs ? n_pairs : most_pairs;
        log->seen[k] = dalcs_arena_alloc(arena, (n_pairs + 63) / 64, sizeof(uint64_t));
        complete = log->seen[k] != NULL;
    }
    log->impulse = dalcs_arena_alloc(arena, 2 * most_pairs, sizeof(*log->impulse));
    return complete && log->impulse != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

void dalcs_event_log_finish(struct dalcs_event_log *log) {
    free(log->event);
    free(log->jump);
    dalcs_arena_finish(&log->arena);
    *log = (struct dalcs_event_log){0};
}

/* A source whose formula has several pairs crosses them all at once where it jumps: one event. */
static bool is_told(const struct dalcs_event_log *log, const struct dalcs_pair *pair, double t,
                    bool on) {
    const struct dalcs_event *last = log->n_events > 0 ? &log->event[log->n_events - 1] : NULL;
    return pair->is_formula && last != NULL && strcmp(last->element, pair->element) == 0 &&
           last->time == t && last->on == on;
}

enum dalcs_status dalcs_event_log_note(struct dalcs_event_log *log, const struct dalcs_euler *e,
                                       bool record) {
    if (!log->keep) {
        return DALCS_OK;
    }
    for (int k = 0; k < e->n_components; k++) {
        const struct dalcs_osnsp *p = &e->component[k].osnsp;
        for (int word = 0; word < p->n_words; word++) {
            uint64_t changed = log->seen[k][word] ^ p->mode[word];
            if (changed == 0) {
                continue;
            }
            log->seen[k][word] = p->mode[word];
            for (int bit = 0; record && bit < 64; bit++) {
                int d = 64 * word + bit;
                if ((changed >> bit & 1) == 0 ||
                    is_told(log, &p->system->pair[d], e->t, dalcs_osnsp_is_on(p, d))) {
                    continue;
                }
                if (log->n_events == log->limit) {
                    log->n_events_dropped++;
                    continue;
                }
                DALCS_TRY(dalcs_grow(&log->event, &log->event_capacity, log->n_events + 1,
                                     sizeof(*log->event)));
                log->event[log->n_events++] =
                    (struct dalcs_event){.time = e->t,
                                         .element = p->system->pair[d].element,
                                         .on = dalcs_osnsp_is_on(p, d)};
            }
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_event_log_leap(struct dalcs_event_log *log, const struct dalcs_leap *leap) {
    if (!log->keep) {
        return DALCS_OK;
    }
    size_t n = (size_t)leap->n_periods * (size_t)leap->n_events;
    size_t kept = n < log->limit - log->n_events ? n : log->limit - log->n_events;
    DALCS_TRY(
        dalcs_grow(&log->event, &log->event_capacity, log->n_events + kept, sizeof(*log->event)));
    struct dalcs_event *to = log->event + log->n_events;
    const struct dalcs_event *end = to + kept;
    for (long k = 0; to < end; k++) {
        double time = 0.0;
        for (int i = 0; i < leap->n_events && to < end; i++, to++) {
            const struct dalcs_leap_event *e = &leap->event[i];
            bool is_same = i > 0 && e->moment == leap->event[i - 1].moment;
            time = is_same ? time : dalcs_leap_time(e->moment, k);
            *to = (struct dalcs_event){
                .time = time, .element = leap->system->pair[e->pair].element, .on = e->is_on};
        }
    }
    log->n_events += kept;
    log->n_events_dropped += n - kept;
    return DALCS_OK;
}

/* States and pairs of a jump are worth a line that changed by more than a one-step problem may be off by. */
static bool is_noticeable(double change, double largest) {
    return fabs(change) > dalcs_alike * largest;
}

static size_t list_jump_states(const struct dalcs_event_log *log,
                               const struct dalcs_euler_jump *j) {
    static const double no_inputs[1] = {1.0}; /* states are columns only */
    size_t n = 0;
    for (int i = 0; i < log->network->n_states; i++) {
        const struct dalcs_state *x = &log->network->state[i];
        if (x->probe.system != j->system || !dalcs_probe_is_known(&x->probe, j->n_known)) {
            continue;
        }
        double before = dalcs_probe_value(&x->probe, j->before, no_inputs);
        double after = dalcs_probe_value(&x->probe, j->after, no_inputs);
        double change = after - before;
        if (is_noticeable(change, fmax(fabs(before), fabs(after)))) {
            log->jump_state[n++] =
                (struct dalcs_jump_state){.element = x->element, .before = before, .after = after};
        }
    }
    return n;
}

static size_t list_impulses(const struct dalcs_event_log *log, const struct dalcs_euler_jump *j) {
    const struct dalcs_system *s = &log->network->system[j->system];
    double largest[2] = {0.0, 0.0};
    for (int d = 0; d < s->n_pairs; d++) {
        largest[0] = fmax(largest[0], fabs(j->charge[d]));
        largest[1] = fmax(largest[1], fabs(j->flux[d]));
    }
    size_t n = 0;
    for (int d = 0; d < s->n_pairs; d++) {
        /* w is the reverse voltage of a diode; a person reads a switch forward */
        bool is_switch = s->pair[d].kind == DALCS_PAIR_SWITCH;
        const double value[2] = {j->charge[d], is_switch ? -j->flux[d] : j->flux[d]};
        for (int i = 0; i < 2; i++) {
            if (!s->pair[d].is_formula && value[i] != 0.0 && is_noticeable(value[i], largest[i])) {
                log->impulse[n++] = (struct dalcs_impulse){
                    .element = s->pair[d].element, .is_flux = i == 1, .value = value[i]};
            }
        }
    }
    return n;
}

enum dalcs_status dalcs_event_log_jump(void *user, const struct dalcs_euler_jump *j) {
    struct dalcs_event_log *log = user;
    if (!log->keep) {
        return DALCS_OK;
    }
    size_t n_states = list_jump_states(log, j);
    size_t n_impulses = list_impulses(log, j);
    if (n_states + n_impulses == 0 || log->n_jumps == log->limit) {
        log->n_jumps_dropped += n_states + n_impulses > 0 ? 1 : 0;
        return DALCS_OK;
    }
    struct dalcs_jump_state *state = dalcs_arena_alloc(&log->arena, n_states, sizeof(*state));
    struct dalcs_impulse *impulse = dalcs_arena_alloc(&log->arena, n_impulses, sizeof(*impulse));
    DALCS_TRY(dalcs_grow(&log->jump, &log->jump_capacity, log->n_jumps + 1, sizeof(*log->jump)));
    if (state == NULL || impulse == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(state, log->jump_state, n_states * sizeof(*state));
    memcpy(impulse, log->impulse, n_impulses * sizeof(*impulse));
    log->jump[log->n_jumps++] = (struct dalcs_jump){.time = j->time,
                                                    .n_states = n_states,
                                                    .state = state,
                                                    .n_impulses = n_impulses,
                                                    .impulse = impulse,
                                                    .energy_lost = j->energy_lost,
                                                    .source_work = j->source_work};
    return DALCS_OK;
}

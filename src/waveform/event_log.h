/* event_log.h - the events and jumps of a run, as many as are wanted. */
#ifndef DALCS_EVENT_LOG_H
#define DALCS_EVENT_LOG_H

#include "cycle.h"
#include "dalcs.h"

struct dalcs_event_log {
    const struct dalcs_network *network;
    bool keep; /* false: nothing is */
    size_t limit;
    uint64_t **seen; /* [n_systems] modes last seen */
    struct dalcs_event *event;
    size_t n_events, event_capacity, n_events_dropped;
    struct dalcs_jump *jump;
    size_t n_jumps, jump_capacity, n_jumps_dropped;
    struct dalcs_arena arena; /* what jumps point to, and what has the same size during the run */
    struct dalcs_jump_state *jump_state; /* work [n_states]: what a jump is made of */
    struct dalcs_impulse *impulse;       /* work [2 * pairs of the largest system] */
};

/* To be finished even if it fails. */
enum dalcs_status dalcs_event_log_setup(struct dalcs_event_log *log,
                                        const struct dalcs_network *network, bool keep,
                                        size_t limit) DALCS_MUST_CHECK;
void dalcs_event_log_finish(struct dalcs_event_log *log);

/* Modes that changed at e->t become events; record = false: they are only what later ones are compared with. */
enum dalcs_status dalcs_event_log_note(struct dalcs_event_log *log, const struct dalcs_euler *e,
                                       bool record) DALCS_MUST_CHECK;

/* The events of the periods that were leapt over. */
enum dalcs_status dalcs_event_log_leap(struct dalcs_event_log *log,
                                       const struct dalcs_leap *leap) DALCS_MUST_CHECK;

/* dalcs_euler's on_jump; user is the log. */
enum dalcs_status dalcs_event_log_jump(void *user, const struct dalcs_euler_jump *j);

#endif

/* periodic.c - one period of segments, from an event to the same event. */
#include "periodic.h"

#include "extremes.h"
#include "magnitudes.h"
#include "pi.h"
#include "present.h"
#include "recurrence.h"
#include "rounding.h"
#include "source_period.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Shorter runs have nothing to repeat; doubles that are kept at most. */
enum { FEWEST_PERIODS = 3, MOST_KEPT = 1 << 18 };

struct periodic_segment {
    double h, end; /* s, and steps */
    double t_end;  /* s, since the event */
    enum dalcs_radau_end why;
    int level; /* of the step to come */
    int n_crossed;
    size_t first_crossed;
};

struct dalcs_periodic {
    double
        period; /* s, of all sources; 0: that of the commands, which is not known before the start */
    bool by_commands; /* it is that of PULSEs */

    struct { /* mode and states there */
        bool is;
        double since; /* s */
        double *x;
        uint64_t *mode;
    } event;

    bool keeps; /* all segments since then */
    size_t n;
    struct periodic_segment *segment; /* [n] */
    double *values;                   /* [n][size.values]: out, in and x */
    uint64_t *modes;                  /* [n][size.words] */
    int *crossed;

    struct {
        size_t out, in, x, values, words, crossed;
    } size;

    struct {
        size_t segment, values, modes, crossed;
    } room;

    bool repeats;
    double start;  /* s: it came back then */
    double n_done; /* periods since */
    size_t next;
    double *own_out; /* while part->segment.out is one of those kept */
};

enum dalcs_status dalcs_periodic_setup(const struct dalcs_radau *r, struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    double period;
    DALCS_TRY(dalcs_source_period(part, &period));
    bool is_commanded = part->commands.n > 0 && !part->excitation.is_curved;
    bool is_sinusoidal = period > 0.0 && FEWEST_PERIODS * period < r->options.stop;
    bool may_come_back = (is_sinusoidal || is_commanded) && part->component->system->monotone &&
                         r->options.fixed_step == 0.0;
    if (!may_come_back) {
        return DALCS_OK;
    }
    const struct dalcs_stage_layout *l = &part->stages.layout;
    struct dalcs_periodic *periodic = part->memory.periodic =
        dalcs_arena_alloc(&part->arena, 1, sizeof(*periodic));
    if (periodic == NULL) {
        return DALCS_E_NOMEM;
    }
    periodic->period = period;
    periodic->by_commands = period == 0.0;
    periodic->size.out = (size_t)l->drift;
    periodic->size.in = (size_t)part->stages.n_in;
    periodic->size.x = (size_t)p->system->n_x;
    periodic->size.values = periodic->size.out + periodic->size.in + periodic->size.x;
    periodic->size.words = (size_t)p->n_words;
    periodic->event.x = dalcs_arena_alloc(&part->arena, (size_t)p->system->n_x, sizeof(double));
    periodic->event.mode = dalcs_arena_alloc(&part->arena, (size_t)p->n_words, sizeof(uint64_t));
    return periodic->event.x != NULL && periodic->event.mode != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

void dalcs_periodic_finish(struct dalcs_radau_part *part) {
    struct dalcs_periodic *periodic = part->memory.periodic;
    if (periodic == NULL) {
        return;
    }
    free(periodic->segment);
    free(periodic->values);
    free(periodic->modes);
    free(periodic->crossed);
    part->memory.periodic = NULL;
}

/* How far the circuit is from where it was at the event a period ago, over what it may be; INFINITY:
 * it is something else that happened. */
static double distance(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    const struct dalcs_periodic *periodic = part->memory.periodic;
    const struct dalcs_osnsp *p = &part->component->osnsp;
    double to_come = (r->options.stop - part->segment.t) / periodic->period;
    /* In all periods to come together states may miss what a step may. */
    double share = dalcs_larger(part->inner_tolerance / to_come, dalcs_rounded);
    /* An event that comes a period after another, but for a small part of the period, may be the same. */
    double late = fabs(part->segment.t - periodic->event.since - periodic->period);
    if (late > dalcs_small * periodic->period ||
        !dalcs_mode_is(periodic->event.mode, p->mode, p->n_words)) {
        return INFINITY;
    }
    double farthest = late / dalcs_larger(dalcs_rounded * part->segment.t,
                                          share / dalcs_two_pi * periodic->period);
    for (int x = 0; x < p->system->n_x; x++) {
        double off = fabs(part->x[x] - periodic->event.x[x]);
        if (off > farthest * share * part->scales.column[x]) {
            farthest = off / (share * part->scales.column[x]);
        }
    }
    return farthest;
}

/* Of sources that act on the part, or on what commands its switches; those of PULSEs are periodic themselves. */
static bool has_edges_to_come(const struct dalcs_radau_part *part) {
    const struct dalcs_commands *c = &part->commands;
    bool has = isfinite(part->excitation.next_edge);
    for (int k = 0; k < c->n && !has && !part->memory.periodic->by_commands; k++) {
        has = isfinite(dalcs_control_next_edge(&c->control, c->command[k].pair, part->segment.t));
    }
    return has;
}

void dalcs_periodic_look_ahead(struct dalcs_radau_part *part) {
    if (!part->memory.periodic->by_commands) {
        dalcs_commands_look(&part->commands,
                            part->segment.t + (1.0 + dalcs_small) * part->memory.periodic->period);
    }
}

void dalcs_periodic_event(const struct dalcs_radau *r, struct dalcs_radau_part *part) {
    struct dalcs_periodic *periodic = part->memory.periodic;
    bool is_command = part->guards.n_crossed == 0;
    if (has_edges_to_come(part) || (is_command && periodic->by_commands)) {
        return; /* the times of PULSEs are counted, not taken from an event that is one of them */
    }
    if (periodic->period == 0.0) {
        periodic->period = dalcs_commands_period(&part->commands);
        periodic->period = periodic->period > 0.0 ? periodic->period : INFINITY;
    }
    bool is_first = !periodic->event.is;
    if (!is_first &&
        part->segment.t < periodic->event.since + periodic->period * (1.0 - dalcs_small)) {
        return;
    }
    double off = is_first ? INFINITY : distance(r, part);
    periodic->repeats = periodic->keeps && off <= 1.0;
    /* The states will hardly have come back a period later if they are farther off than any error. The period of a converter is short, and what happens in it moves about for many: that is not worth a copy. */
    periodic->keeps = dalcs_nothing * off < 1.0 || (isinf(off) && !periodic->by_commands);
    if (periodic->repeats) {
        periodic->start = part->segment.t;
        return;
    }
    periodic->event.is = true;
    periodic->event.since = part->segment.t;
    memcpy(periodic->event.x, part->x, periodic->size.x * sizeof(double));
    memcpy(periodic->event.mode, part->component->osnsp.mode,
           periodic->size.words * sizeof(uint64_t));
    periodic->n = 0;
    periodic->size.crossed = 0;
}

/* ---- Segments that are kept -------------------------------------------------------------------- */

/* For one more. */
static enum dalcs_status make_room(struct dalcs_periodic *periodic, size_t n_crossed) {
    size_t n = periodic->n + 1;
    DALCS_TRY(
        dalcs_grow(&periodic->segment, &periodic->room.segment, n, sizeof(*periodic->segment)));
    DALCS_TRY(dalcs_grow(&periodic->values, &periodic->room.values, n * periodic->size.values,
                         sizeof(double)));
    DALCS_TRY(dalcs_grow(&periodic->modes, &periodic->room.modes, n * periodic->size.words,
                         sizeof(uint64_t)));
    return dalcs_grow(&periodic->crossed, &periodic->room.crossed,
                      periodic->size.crossed + n_crossed, sizeof(int));
}

enum dalcs_status dalcs_periodic_note(struct dalcs_radau_part *part) {
    struct dalcs_periodic *periodic = part->memory.periodic;
    if (!periodic->keeps) {
        return DALCS_OK;
    }
    bool is_over = part->segment.t > periodic->event.since + periodic->period * (1.0 + dalcs_small);
    periodic->keeps = !part->segment.by_euler && !part->segment.jumped && !is_over &&
                      (periodic->n + 1) * periodic->size.values <= MOST_KEPT;
    if (!periodic->keeps) {
        return DALCS_OK;
    }
    dalcs_recurrence_complete(part);
    size_t n_crossed = (size_t)part->guards.n_crossed;
    DALCS_TRY(make_room(periodic, n_crossed));
    double *value = periodic->values + periodic->n * periodic->size.values;
    memcpy(value, part->segment.out, periodic->size.out * sizeof(double));
    value += periodic->size.out;
    memcpy(value, part->segment.in, periodic->size.in * sizeof(double));
    value += periodic->size.in;
    memcpy(value, part->x, periodic->size.x * sizeof(double));
    memcpy(periodic->modes + periodic->n * periodic->size.words, part->component->osnsp.mode,
           periodic->size.words * sizeof(uint64_t));
    for (size_t k = 0; k < n_crossed; k++) {
        periodic->crossed[periodic->size.crossed + k] = part->guards.crossed[k];
    }
    periodic->segment[periodic->n++] =
        (struct periodic_segment){.h = part->segment.h,
                                  .end = part->segment.end,
                                  .t_end = part->segment.t_end - periodic->event.since,
                                  .why = part->segment.why,
                                  .level = part->length.level,
                                  .n_crossed = part->guards.n_crossed,
                                  .first_crossed = periodic->size.crossed};
    periodic->size.crossed += n_crossed;
    return DALCS_OK;
}

/* ---- And taken again --------------------------------------------------------------------------- */

/* When the next segment ends. Periods are counted, never accumulated. */
static double next_end(const struct dalcs_periodic *periodic) {
    bool is_last = periodic->next + 1 == periodic->n;
    double begin = periodic->start + periodic->n_done * periodic->period;
    return is_last ? periodic->start + (periodic->n_done + 1.0) * periodic->period
                   : begin + periodic->segment[periodic->next].t_end;
}

/* What comes next is looked for as always, from where the present segment ends. */
static void stop_repeating(struct dalcs_radau_part *part) {
    struct dalcs_periodic *periodic = part->memory.periodic;
    periodic->repeats = false;
    periodic->keeps = false;
    if (periodic->own_out != NULL) {
        memcpy(periodic->own_out, part->segment.out, periodic->size.out * sizeof(double));
        part->segment.out = periodic->own_out;
        periodic->own_out = NULL;
        part->guards.fresh = true;
        dalcs_present_hold(part);
    }
}

bool dalcs_periodic_repeats(const struct dalcs_radau *r, struct dalcs_radau_part *part) {
    const struct dalcs_periodic *periodic = part->memory.periodic;
    if (!periodic->repeats) {
        return false;
    }
    /* what crosses just before the stop time may be left to a longer run (guards.c) */
    double last = r->options.stop * (1.0 - dalcs_beyond * part->inner_tolerance) - r->resolution;
    bool goes_on = next_end(periodic) < last;
    if (!goes_on) {
        stop_repeating(part);
    }
    return goes_on;
}

void dalcs_periodic_take(struct dalcs_radau *r, struct dalcs_radau_part *part) {
    struct dalcs_periodic *periodic = part->memory.periodic;
    const struct periodic_segment *segment = &periodic->segment[periodic->next];
    double *value = periodic->values + periodic->next * periodic->size.values;
    if (periodic->own_out == NULL) {
        periodic->own_out = part->segment.out;
    }
    part->segment.out = value;
    dalcs_segment_renew(part);
    if (r->base->listener.observer != NULL) {
        memcpy(part->segment.in, value + periodic->size.out, periodic->size.in * sizeof(double));
        memcpy(part->work.after, value + periodic->size.out + periodic->size.in,
               periodic->size.x * sizeof(double));
        dalcs_radau_go_after(r, part);
    }
    bool is_commanded = segment->why == DALCS_END_AT_EDGE;
    part->segment.t_end = is_commanded ? part->commands.next : next_end(periodic);
    part->segment.brief = NULL;
    part->segment.h = segment->h;
    part->segment.end = segment->end;
    part->segment.why = segment->why;
    part->length.level = segment->level;
    part->guards.fresh = false;
    part->guards.flipped = false;
    part->guards.n_crossed = segment->n_crossed;
    for (int k = 0; k < segment->n_crossed; k++) {
        part->guards.crossed[k] = periodic->crossed[segment->first_crossed + (size_t)k];
    }
    for (size_t k = 0; k < periodic->size.words; k++) {
        part->component->osnsp.mode[k] = periodic->modes[periodic->next * periodic->size.words + k];
    }
    periodic->next++;
    if (periodic->next == periodic->n) {
        periodic->next = 0;
        periodic->n_done += 1.0;
    }
    r->steps++;
    r->periodic_steps++;
}

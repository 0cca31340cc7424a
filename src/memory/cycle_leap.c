/* cycle_leap.c - one map for a period, and leaps over periods by it. */
#include "cycle_internal.h"

#include "extremes.h"
#include "present.h"
#include "quads.h"
#include "recurrence.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Fewer periods are not worth the look at the conditions. */
enum { FEWEST_PERIODS = 2 };

/* Segments until it is tried again, after it failed, at most. */
enum { MOST_PATIENCE = 64 };

/* Divides a condition by what a change of the states by their scales may make of it; false: no change does. */
static bool normalise(int n_x, const double *scale, long double *row) {
    long double most = 0.0L;
    for (int k = 0; k < n_x; k++) {
        most += fabsl(row[k]) * scale[k];
    }
    for (int k = 0; k <= n_x && most > 0.0L; k++) {
        row[k] /= most;
    }
    return most > 0.0L || row[n_x] < 0.0L;
}

/* The conditions of a segment on the states at the start of the period, from where `inner` leads. */
static void add_conditions(const struct dalcs_radau_part *part,
                           const struct dalcs_cycle_segment *of, const long double *inner,
                           long double *work, struct dalcs_affine_quads *all) {
    int n_x = part->component->system->n_x;
    dalcs_affine_compose(n_x, &of->condition, inner, work);
    for (int i = 0; i < of->condition.n; i++) {
        const long double *row = work + i * (n_x + 1);
        if (normalise(n_x, part->scales.column, work + i * (n_x + 1))) {
            dalcs_affine_quads_put(n_x, row, all);
        }
    }
}

static void compose_maps(const struct dalcs_radau_part *part, int first, long double *inner,
                         long double *work) {
    const struct dalcs_cycle *cycle = part->memory.cycle;
    struct dalcs_cycle_segment *segment = &part->memory.cycle->segment[first];
    int n_x = part->component->system->n_x;
    size_t bytes = (size_t)n_x * (size_t)(n_x + 1) * sizeof(*inner);
    for (int k = 0; k < n_x * (n_x + 1); k++) {
        inner[k] = k % (n_x + 2) == 0 ? 1.0L : 0.0L;
    }
    for (int i = 0; i < cycle->n; i++) {
        const struct dalcs_cycle_segment *of = &cycle->segment[(first + i) % cycle->n];
        add_conditions(part, of, inner, work, &segment->period_condition);
        dalcs_affine_compose(n_x, &of->last, inner, work);
        memcpy(inner, work, bytes);
    }
    dalcs_affine_quads_fill_up(n_x, &segment->period_condition);
    dalcs_affine_round(n_x, n_x, inner, segment->period_last.row);
}

/* What changes sides where the k-th segment ends and the next begins. */
static void list_changes(const struct dalcs_radau_part *part, int k,
                         struct dalcs_cycle_segment *of) {
    const struct dalcs_cycle *cycle = part->memory.cycle;
    int n_words = part->component->osnsp.n_words;
    int next = (k + 1) % cycle->n;
    const uint64_t *from = cycle->mode + k * n_words;
    const uint64_t *to = cycle->mode + next * n_words;
    for (int d = 0; d < part->component->system->n_pairs; d++) {
        bool is_on = dalcs_mode_has(to, d);
        if (is_on != dalcs_mode_has(from, d)) {
            of->event[of->n_events++] =
                (struct dalcs_leap_event){&cycle->segment[next].began, d, is_on};
        }
    }
}

/* What is known of the period that begins with the present segment. false: it is too large. */
static enum dalcs_status compose_period(const struct dalcs_radau_part *part, bool *done) {
    struct dalcs_cycle *cycle = part->memory.cycle;
    struct dalcs_cycle_segment *segment = &cycle->segment[cycle->at];
    const struct dalcs_system *s = part->component->system;
    size_t width = (size_t)s->n_x + 1;
    int n = 0;
    int most = s->n_x;
    for (int k = 0; k < cycle->n; k++) {
        n += cycle->segment[k].condition.n;
        most = most < cycle->segment[k].condition.n ? cycle->segment[k].condition.n : most;
    }
    *done = (size_t)n * width * (size_t)cycle->n <= DALCS_CYCLE_MOST_DOUBLES;
    if (!*done) {
        return DALCS_OK;
    }
    segment->period_last.row = dalcs_alloc((size_t)s->n_x * width, sizeof(double));
    segment->period_condition.number =
        dalcs_alloc((size_t)dalcs_quads_of(n) * width, sizeof(double));
    segment->event = dalcs_alloc((size_t)(s->n_pairs * cycle->n), sizeof(*segment->event));
    long double *inner = dalcs_alloc((size_t)(s->n_x + most) * width, sizeof(*inner));
    if (segment->period_last.row == NULL || segment->period_condition.number == NULL ||
        segment->event == NULL || inner == NULL) {
        free(inner);
        return DALCS_E_NOMEM;
    }
    segment->period_last.n = s->n_x;
    compose_maps(part, cycle->at, inner, inner + (size_t)s->n_x * width);
    for (int i = 0; i < cycle->n; i++) {
        list_changes(part, (cycle->at + i) % cycle->n, segment);
    }
    segment->is_composed = true;
    free(inner);
    return DALCS_OK;
}

/* How far states may move from x, cycle->most; false: not at all. */
static bool look_around(const struct dalcs_radau_part *part, const double *x) {
    struct dalcs_cycle *cycle = part->memory.cycle;
    int n_x = part->component->system->n_x;
    double room = dalcs_affine_quads_least(n_x, &cycle->segment[cycle->at].period_condition, x);
    for (int k = 0; k < n_x; k++) {
        cycle->near[k] = x[k];
        cycle->most[k] = room * part->scales.column[k];
    }
    return room > 0.0;
}

/* Takes the states of the present segment to those that it has periods later, as many as may be, and from
 * which a period holds, too. */
static long go_on(const struct dalcs_radau_part *part, long most) {
    struct dalcs_cycle *cycle = part->memory.cycle;
    const double *map = cycle->segment[cycle->at].period_last.row;
    int n_x = part->component->system->n_x;
    double *states[2] = {cycle->x, cycle->later};
    long n = 0;
    memcpy(states[0], part->x, (size_t)n_x * sizeof(double));
    bool holds = look_around(part, states[0]);
    while (holds && n < most) {
        n += dalcs_affine_pass(n_x, map, cycle->near, cycle->most, most - n, states);
        holds = n < most && look_around(part, states[1]);
        if (holds) {
            dalcs_affine_swap(states);
            n++;
        }
    }
    memcpy(part->x, states[0], (size_t)n_x * sizeof(double));
    return n;
}

/* Currents need no closer look: no state has a lever on them, as far as is known (current_error.c). */
static bool has_no_lever(const struct dalcs_radau_part *part) {
    bool none = true;
    for (int k = 0; k < part->memory.cycle->n && part->stages.n_levered > 0 && none; k++) {
        none = *dalcs_stage_note(part->memory.cycle->segment[k].brief->entry) > 0;
    }
    return none;
}

/* Periods until the present segment begins before `until` for the last time, and ends before an edge or the
 * stop time. */
static double periods_until(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                            double until) {
    double near = 4.0 * r->resolution;
    double edge = dalcs_smaller(part->excitation.next_edge, r->options.stop);
    double room = dalcs_smaller(until - near - part->segment.t, edge - near - part->segment.t_end);
    return floor(room / part->memory.cycle->period);
}

/* s; when the present segment begins n periods later. */
static double start_later(struct dalcs_cycle_segment *segment, long n) {
    for (int i = 0; i < segment->began.n_moves; i++) {
        segment->began.move[i].n = segment->began.move[i].command->n[segment->began.move[i].way];
    }
    return dalcs_leap_time(&segment->began, n - 1);
}

/* The present segment, with part->x as its state, n periods later. */
static void put_off(struct dalcs_radau *r, struct dalcs_radau_part *part, long n) {
    struct dalcs_cycle *cycle = part->memory.cycle;
    struct dalcs_cycle_segment *segment = &cycle->segment[cycle->at];
    cycle->leap.n_periods = n;
    cycle->leap.n_steps = n * cycle->n;
    cycle->leap.n_events = segment->n_events;
    cycle->leap.event = segment->event;
    for (int k = 0; k < cycle->n; k++) {
        struct dalcs_leap_moment *began = &cycle->segment[k].began;
        for (int i = 0; i < began->n_moves; i++) {
            began->move[i].n = began->move[i].command->n[began->move[i].way];
        }
    }
    part->segment.t = start_later(segment, n);
    dalcs_commands_leap(&part->commands, n);
    part->segment.t_end = dalcs_radau_limit(r, part);
    memcpy(part->segment.in, part->x, (size_t)part->component->system->n_x * sizeof(double));
    dalcs_recurrence_begin(part);
    r->steps += cycle->leap.n_steps;
    r->leapt_steps += cycle->leap.n_steps;
}

/* Takes the states of the present segment as many periods on as they may be, *n. */
static enum dalcs_status pass_periods(const struct dalcs_radau *r, double until, double most,
                                      long *n) {
    struct dalcs_radau_part *part = r->cycling;
    struct dalcs_cycle *cycle = part->memory.cycle;
    *n = 0;
    if (cycle->waits > 0) {
        cycle->waits--;
        return DALCS_OK;
    }
    most = dalcs_smaller(most, periods_until(r, part, until));
    if (!(most >= FEWEST_PERIODS)) {
        return DALCS_OK;
    }
    bool done = true;
    if (!cycle->segment[cycle->at].is_composed) {
        DALCS_TRY(compose_period(part, &done));
    }
    *n = done && has_no_lever(part) ? go_on(part, (long)most) : 0;
    if (*n == 0) {
        cycle->waits = cycle->patience;
        cycle->patience = cycle->patience < MOST_PATIENCE ? 2 * cycle->patience : MOST_PATIENCE;
        return DALCS_OK;
    }
    cycle->patience = 1;
    return DALCS_OK;
}

enum dalcs_status dalcs_cycle_leap(struct dalcs_radau *r, double until, long most_steps,
                                   const struct dalcs_leap **leap) {
    struct dalcs_radau_part *part = r->cycling;
    struct dalcs_cycle *cycle = part->memory.cycle;
    long n;
    *leap = NULL;
    DALCS_TRY(pass_periods(r, until, 1.0 + (double)most_steps / cycle->n, &n));
    if (n > 0) {
        put_off(r, part, n);
        *leap = &cycle->leap;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_cycle_try(const struct dalcs_radau *r, double until, long most_periods,
                                  double *x, double *t) {
    struct dalcs_radau_part *part = r->cycling;
    const size_t bytes = (size_t)part->component->system->n_x * sizeof(double);
    long n;
    memcpy(x, part->x, bytes);
    enum dalcs_status status = pass_periods(r, until, (double)most_periods, &n);
    for (int k = 0; k < part->component->system->n_x; k++) {
        const double before = x[k];
        x[k] = part->x[k];
        part->x[k] = before;
    }
    *t = n > 0 ? start_later(&part->memory.cycle->segment[part->memory.cycle->at], n) : INFINITY;
    return status;
}

int dalcs_cycle_n_segments(const struct dalcs_cycle *cycle) {
    return cycle->n;
}

double dalcs_cycle_period(const struct dalcs_cycle *cycle) {
    return cycle->period;
}

const double *dalcs_cycle_map(const struct dalcs_radau_part *part) {
    return part->memory.cycle->segment[part->memory.cycle->at].period_last.row;
}

/* recorder.c - scheduling rows, and keeping events and jumps in bounded memory. */
#include "recorder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Output times this close to a step's end, over the step, are at its end. */
static const double same_time = 1e-9;

enum dalcs_status dalcs_recorder_setup(struct dalcs_recorder *r,
                                       const struct dalcs_network *network,
                                       const struct dalcs_sink *sink,
                                       const struct dalcs_schedule *schedule, bool keep,
                                       size_t limit) {
    *r = (struct dalcs_recorder){
        .network = network, .sink = sink, .schedule = *schedule, .keep = keep, .limit = limit};
    size_t n = (size_t)network->n_outputs;
    r->n_shown = network->n_outputs;
    r->now = dalcs_arena_alloc(&r->arena, n, sizeof(double));
    r->before = dalcs_arena_alloc(&r->arena, n, sizeof(double));
    r->row = dalcs_arena_alloc(&r->arena, n, DALCS_MOST_ROWS * sizeof(double));
    r->seen = dalcs_arena_alloc(&r->arena, (size_t)network->n_systems, sizeof(*r->seen));
    r->jump_state = dalcs_arena_alloc(&r->arena, (size_t)network->n_states, sizeof(*r->jump_state));
    bool complete = r->now != NULL && r->before != NULL && r->row != NULL && r->seen != NULL &&
                    r->jump_state != NULL;
    size_t most_pairs = 0;
    for (int k = 0; complete && k < network->n_systems; k++) {
        size_t n_pairs = (size_t)network->system[k].n_pairs;
        most_pairs = n_pairs > most_pairs ? n_pairs : most_pairs;
        r->seen[k] = dalcs_arena_alloc(&r->arena, (n_pairs + 63) / 64, sizeof(uint64_t));
        complete = r->seen[k] != NULL;
    }
    r->impulse = dalcs_arena_alloc(&r->arena, 2 * most_pairs, sizeof(*r->impulse));
    complete = complete && r->impulse != NULL;
    if (!complete) {
        dalcs_recorder_finish(r);
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

void dalcs_recorder_finish(struct dalcs_recorder *r) {
    free(r->event);
    free(r->jump);
    dalcs_arena_finish(&r->arena);
    *r = (struct dalcs_recorder){0};
}

static double probe(const struct dalcs_probe *p, const struct dalcs_euler *e) {
    if (p->system < 0) {
        return 0.0;
    }
    const struct dalcs_component *c = &e->component[p->system];
    return dalcs_probe_value(p, c->y, c->u + c->system->n_x);
}

double dalcs_recorder_signal(const struct dalcs_network *network, const struct dalcs_euler *e,
                             int output) {
    const struct dalcs_output *out = &network->output[output];
    return probe(&out->plus, e) - (out->minus.system < 0 ? 0.0 : probe(&out->minus, e));
}

void dalcs_recorder_evaluate(const struct dalcs_network *network, const struct dalcs_euler *e,
                             double *value) {
    for (int i = 0; i < network->n_outputs; i++) {
        value[i] = dalcs_recorder_signal(network, e, i);
    }
}

void dalcs_recorder_states(const struct dalcs_network *network, const struct dalcs_euler *e,
                           double *value) {
    for (int i = 0; i < network->n_states; i++) {
        value[i] = probe(&network->state[i].probe, e);
    }
}

/* The next time a row is due, INFINITY when none is. */
static double next_output(const struct dalcs_schedule *s) {
    switch (s->kind) {
    case DALCS_ON_GRID: {
        double due = s->start + (double)s->next * s->step;
        /* the stop time is the last row, unless the grid has just been there */
        bool past = due > s->stop && due - s->step < s->stop * (1.0 - same_time);
        return past ? s->stop : due;
    }
    case DALCS_AT_TIMES:
        return s->next < s->n_at ? s->at[s->next] : INFINITY;
    case DALCS_EVERY_STEP:
        return s->start;
    }
    return INFINITY;
}

static void look(struct dalcs_watched *w, double time, double value) {
    if (w->sign * value > w->largest) {
        w->largest = w->sign * value;
        w->at = time;
    }
}

static enum dalcs_status emit(struct dalcs_recorder *r, double time, const double *value) {
    for (int k = 0; k < r->n_watched; k++) {
        look(&r->watched[k], time, value[r->watched[k].output]);
    }
    return r->sink->row(r->sink->user, time, value);
}

/* Modes that changed since last time become events. */
/* A source whose formula has several pairs crosses them all at once where it jumps: one event. */
static bool is_told(const struct dalcs_recorder *r, const struct dalcs_pair *pair, double t,
                    bool on) {
    const struct dalcs_event *last = r->n_events > 0 ? &r->event[r->n_events - 1] : NULL;
    return pair->is_formula && last != NULL && strcmp(last->element, pair->element) == 0 &&
           last->time == t && last->on == on;
}

static enum dalcs_status note_events(struct dalcs_recorder *r, const struct dalcs_euler *e,
                                     bool record) {
    for (int k = 0; k < e->n_components; k++) {
        const struct dalcs_osnsp *p = &e->component[k].osnsp;
        for (int word = 0; word < p->n_words; word++) {
            uint64_t changed = r->seen[k][word] ^ p->mode[word];
            if (changed == 0) {
                continue;
            }
            r->seen[k][word] = p->mode[word];
            for (int bit = 0; record && bit < 64; bit++) {
                int d = 64 * word + bit;
                if ((changed >> bit & 1) == 0 ||
                    is_told(r, &p->system->pair[d], e->t, dalcs_osnsp_is_on(p, d))) {
                    continue;
                }
                if (r->n_events == r->limit) {
                    r->n_events_dropped++;
                    continue;
                }
                DALCS_TRY(
                    dalcs_grow(&r->event, &r->event_capacity, r->n_events + 1, sizeof(*r->event)));
                r->event[r->n_events++] =
                    (struct dalcs_event){.time = e->t,
                                         .element = p->system->pair[d].element,
                                         .on = dalcs_osnsp_is_on(p, d)};
            }
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_recorder_before_start(struct dalcs_recorder *r,
                                              const struct dalcs_euler *e) {
    if (r->keep) {
        DALCS_TRY(note_events(r, e, false));
    }
    dalcs_recorder_evaluate(r->network, e, r->before);
    r->starts_on_edge = true;
    return DALCS_OK;
}

enum dalcs_status dalcs_recorder_start(struct dalcs_recorder *r, const struct dalcs_euler *e) {
    if (r->keep) {
        DALCS_TRY(note_events(r, e, r->starts_on_edge));
    }
    dalcs_recorder_evaluate(r->network, e, r->now);
    r->have_before = true;
    if (next_output(&r->schedule) <= 0.0) {
        bool both = r->starts_on_edge && r->schedule.kind != DALCS_AT_TIMES;
        DALCS_TRY(emit(r, 0.0, r->starts_on_edge ? r->before : r->now));
        DALCS_TRY(both ? emit(r, 0.0, r->now) : DALCS_OK);
        r->schedule.next++;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_recorder_step(struct dalcs_recorder *r, const struct dalcs_euler *e) {
    if (r->keep) {
        DALCS_TRY(note_events(r, e, true));
    }
    struct dalcs_schedule *s = &r->schedule;
    double due = next_output(s);
    double near = same_time * e->h;
    if (s->kind == DALCS_EVERY_STEP) {
        if (e->t < s->start - near) {
            return DALCS_OK;
        }
        dalcs_recorder_evaluate(r->network, e, r->now);
        return emit(r, e->t, r->now);
    }
    /* Signals are needed at both ends of a step that an output time falls into, and before a
     * discontinuity. */
    if (due > e->t + 2.0 * e->grid.h && !e->at_jump) {
        r->have_before = false;
        return DALCS_OK;
    }
    double *swap = r->before;
    r->before = r->now;
    r->now = swap;
    dalcs_recorder_evaluate(r->network, e, r->now);
    int n = r->network->n_outputs;
    for (; due <= e->t + near; due = next_output(s)) {
        if (due >= e->t - near || !r->have_before) {
            DALCS_TRY(emit(r, s->kind == DALCS_AT_TIMES ? due : e->t, r->now));
        } else {
            double part = (due - e->t_before) / (e->t - e->t_before);
            for (int i = 0; i < n; i++) {
                r->row[i] = r->before[i] + part * (r->now[i] - r->before[i]);
            }
            DALCS_TRY(emit(r, due, r->row));
        }
        s->next++;
    }
    r->have_before = true;
    return DALCS_OK;
}

enum dalcs_status dalcs_recorder_cross(struct dalcs_recorder *r, const struct dalcs_euler *e) {
    if (r->keep) {
        DALCS_TRY(note_events(r, e, true));
    }
    struct dalcs_schedule *s = &r->schedule;
    double near = same_time * e->h;
    bool wanted = s->kind != DALCS_AT_TIMES && e->t >= s->start - near;
    if (wanted) {
        /* Both sides of the discontinuity, on the grid or not. */
        double last = s->kind == DALCS_ON_GRID && s->next > 0
                          ? s->start + (double)(s->next - 1) * s->step
                          : e->t;
        if (fabs(last - e->t) > near && r->have_before) {
            DALCS_TRY(emit(r, e->t, r->now));
        }
    }
    dalcs_recorder_evaluate(r->network, e, r->now);
    r->have_before = true;
    return wanted ? emit(r, e->t, r->now) : DALCS_OK;
}

/* The same, not a rounding behind the stop time. */
static double due_before_stop(const struct dalcs_schedule *s) {
    double due = next_output(s);
    return due <= s->stop ? due : due <= s->stop * (1.0 + same_time) ? s->stop : INFINITY;
}

double dalcs_recorder_due(const struct dalcs_recorder *r) {
    return due_before_stop(&r->schedule);
}

/* Those of a grid before both `until` and the stop time. They ascend, so the last one may stand for all. */
static int list_grid(const struct dalcs_schedule *s, double until, double near, double *due,
                     int most) {
    const double start = s->start;
    const double step = s->step;
    const double stop = s->stop;
    const double next = (double)s->next; /* whole, as is each sum below */
    double last = start + (next + (most - 1)) * step;
    if (last + near < until && last <= stop) {
        for (int n = 0; n < most; n++) {
            due[n] = start + (next + n) * step;
        }
        return most;
    }
    for (int n = 0; n < most; n++) {
        due[n] = start + (next + n) * step;
        if (!(due[n] + near < until && due[n] <= stop)) {
            return n;
        }
    }
    return most;
}

int dalcs_recorder_list_due(const struct dalcs_recorder *r, int after, double until, double near,
                            double *due, int most) {
    struct dalcs_schedule s = r->schedule;
    s.next += (size_t)after;
    int n = s.kind == DALCS_ON_GRID ? list_grid(&s, until, near, due, most) : 0;
    s.next += (size_t)n;
    for (; n < most; n++, s.next++) {
        due[n] = due_before_stop(&s);
        if (!(due[n] + near < until)) {
            break;
        }
    }
    return n;
}

bool dalcs_recorder_wants_sides(const struct dalcs_recorder *r, double t) {
    return r->schedule.kind != DALCS_AT_TIMES && t >= r->schedule.start;
}

enum dalcs_status dalcs_recorder_row(struct dalcs_recorder *r, const struct dalcs_rows *rows,
                                     double t, bool is_due) {
    r->schedule.next += is_due ? 1 : 0;
    for (int i = 0; i < rows->n_outputs; i++) {
        r->row[i] = rows->value[i].at[0];
    }
    return emit(r, t, r->row);
}

static void watch(struct dalcs_recorder *r, const struct dalcs_rows *rows, const double *time,
                  int n) {
    for (int i = 0; i < r->n_watched; i++) {
        const double *value = rows->value[r->watched[i].output].at;
        for (int k = 0; k < n; k++) {
            look(&r->watched[i], time[k], value[k]);
        }
    }
}

enum dalcs_status dalcs_recorder_rows(struct dalcs_recorder *r, const struct dalcs_rows *rows,
                                      const double *time, int n, int n_due) {
    const struct dalcs_sink *sink = r->sink;
    const size_t n_shown = (size_t)r->n_shown;
    r->schedule.next += (size_t)n_due;
    watch(r, rows, time, n);
    for (size_t i = 0; i < n_shown; i++) {
        const double *value = rows->value[i].at;
        double *to = r->row + i;
        for (int k = 0; k < n; k++, to += n_shown) {
            *to = value[k];
        }
    }
    if (sink->rows != NULL) {
        return sink->rows(sink->user, (size_t)n, time, r->row);
    }
    for (int k = 0; k < n; k++) {
        DALCS_TRY(sink->row(sink->user, time[k], r->row + (size_t)k * n_shown));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_recorder_events(struct dalcs_recorder *r, const struct dalcs_euler *e) {
    return r->keep ? note_events(r, e, true) : DALCS_OK;
}

enum dalcs_status dalcs_recorder_leap(struct dalcs_recorder *r, const struct dalcs_leap *leap) {
    if (!r->keep) {
        return DALCS_OK;
    }
    size_t n = (size_t)leap->n_periods * (size_t)leap->n_events;
    size_t kept = n < r->limit - r->n_events ? n : r->limit - r->n_events;
    DALCS_TRY(dalcs_grow(&r->event, &r->event_capacity, r->n_events + kept, sizeof(*r->event)));
    struct dalcs_event *to = r->event + r->n_events;
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
    r->n_events += kept;
    r->n_events_dropped += n - kept;
    return DALCS_OK;
}

/* Which states and pairs of a jump are worth a line: those that changed by more than rounding. */
static bool is_noticeable(double change, double largest) {
    return fabs(change) > 1e-9 * largest;
}

static size_t list_jump_states(const struct dalcs_recorder *r, const struct dalcs_euler_jump *j) {
    static const double no_inputs[1] = {1.0}; /* states are columns only */
    size_t n = 0;
    for (int i = 0; i < r->network->n_states; i++) {
        const struct dalcs_state *x = &r->network->state[i];
        if (x->probe.system != j->system || !dalcs_probe_is_known(&x->probe, j->n_known)) {
            continue;
        }
        double before = dalcs_probe_value(&x->probe, j->before, no_inputs);
        double after = dalcs_probe_value(&x->probe, j->after, no_inputs);
        double change = after - before;
        if (is_noticeable(change, fmax(fabs(before), fabs(after)))) {
            r->jump_state[n++] =
                (struct dalcs_jump_state){.element = x->element, .before = before, .after = after};
        }
    }
    return n;
}

static size_t list_impulses(const struct dalcs_recorder *r, const struct dalcs_euler_jump *j) {
    const struct dalcs_system *s = &r->network->system[j->system];
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
                r->impulse[n++] = (struct dalcs_impulse){
                    .element = s->pair[d].element, .is_flux = i == 1, .value = value[i]};
            }
        }
    }
    return n;
}

enum dalcs_status dalcs_recorder_jump(void *user, const struct dalcs_euler_jump *j) {
    struct dalcs_recorder *r = user;
    if (!r->keep) {
        return DALCS_OK;
    }
    size_t n_states = list_jump_states(r, j);
    size_t n_impulses = list_impulses(r, j);
    if (n_states + n_impulses == 0 || r->n_jumps == r->limit) {
        r->n_jumps_dropped += n_states + n_impulses > 0 ? 1 : 0;
        return DALCS_OK;
    }
    struct dalcs_jump_state *state = dalcs_arena_alloc(&r->arena, n_states, sizeof(*state));
    struct dalcs_impulse *impulse = dalcs_arena_alloc(&r->arena, n_impulses, sizeof(*impulse));
    DALCS_TRY(dalcs_grow(&r->jump, &r->jump_capacity, r->n_jumps + 1, sizeof(*r->jump)));
    if (state == NULL || impulse == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(state, r->jump_state, n_states * sizeof(*state));
    memcpy(impulse, r->impulse, n_impulses * sizeof(*impulse));
    r->jump[r->n_jumps++] = (struct dalcs_jump){.time = j->time,
                                                .n_states = n_states,
                                                .state = state,
                                                .n_impulses = n_impulses,
                                                .impulse = impulse,
                                                .energy_lost = j->energy_lost,
                                                .source_work = j->source_work};
    return DALCS_OK;
}

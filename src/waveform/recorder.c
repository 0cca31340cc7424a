/* recorder.c - scheduling rows. */
#include "recorder.h"

#include <math.h>

/* Output times this close to a step's end, over the step, are at its end. */
static const double same_time = 1e-9;

enum dalcs_status dalcs_recorder_setup(struct dalcs_recorder *r,
                                       const struct dalcs_network *network,
                                       const struct dalcs_sink *sink,
                                       const struct dalcs_schedule *schedule, bool keep,
                                       size_t limit) {
    *r = (struct dalcs_recorder){.network = network, .sink = sink, .schedule = *schedule};
    size_t n = (size_t)network->n_outputs;
    r->n_shown = network->n_outputs;
    r->now = dalcs_arena_alloc(&r->arena, n, sizeof(double));
    r->before = dalcs_arena_alloc(&r->arena, n, sizeof(double));
    r->row = dalcs_arena_alloc(&r->arena, n, DALCS_MOST_ROWS * sizeof(double));
    const bool complete = r->now != NULL && r->before != NULL && r->row != NULL;
    const enum dalcs_status status = dalcs_event_log_setup(&r->log, network, keep, limit);
    if (!complete || status != DALCS_OK) {
        dalcs_recorder_finish(r);
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

void dalcs_recorder_finish(struct dalcs_recorder *r) {
    dalcs_event_log_finish(&r->log);
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

enum dalcs_status dalcs_recorder_before_start(struct dalcs_recorder *r,
                                              const struct dalcs_euler *e) {
    DALCS_TRY(dalcs_event_log_note(&r->log, e, false));
    dalcs_recorder_evaluate(r->network, e, r->before);
    r->starts_on_edge = true;
    return DALCS_OK;
}

enum dalcs_status dalcs_recorder_start(struct dalcs_recorder *r, const struct dalcs_euler *e) {
    DALCS_TRY(dalcs_event_log_note(&r->log, e, r->starts_on_edge));
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
    DALCS_TRY(dalcs_event_log_note(&r->log, e, true));
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
    DALCS_TRY(dalcs_event_log_note(&r->log, e, true));
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

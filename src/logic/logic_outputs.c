/* logic_outputs.c - what outputs show: points at the end of a stimulus, for what is past stands. */
#include "logic_outputs.h"

#include "logic_memory.h"
#include "rounding.h"

#include <math.h>

/* From t on to a level, in this time for a whole swing. */
struct ramp {
    double t, level, duration, swing;
};

/* A pin goes to a level from t on. What was to come, of a ramp not yet over, does not. */
static enum dalcs_status write(struct dalcs_stimulus *s, double **time, double **value,
                               size_t *capacity, const struct ramp *to) {
    const double t = to->t;
    const double level = to->level;
    int n = s->u.pwl.n;
    const double now = dalcs_stimulus_value(s, t, DALCS_RIGHT);
    DALCS_TRY(dalcs_grow(time, &capacity[0], (size_t)n + 2, sizeof(**time)));
    DALCS_TRY(dalcs_grow(value, &capacity[1], (size_t)n + 2, sizeof(**value)));
    const double near = dalcs_rounded * t;
    while (n > 1 && (*time)[n - 1] > t + near) {
        n--;
    }
    const bool is_twice = n > 1 && (*time)[n - 1] >= t - near && (*time)[n - 2] >= t - near;
    if (is_twice && to->duration == 0.0) {
        (*value)[n - 1] = level; /* nothing in between has lasted */
    } else {
        if ((*time)[n - 1] < t - near || (*value)[n - 1] != now) {
            (*time)[n] = t;
            (*value)[n++] = now;
        }
        (*time)[n] = to->duration > 0.0 ? t + to->duration * fabs(level - now) / to->swing : t;
        (*value)[n++] = level;
    }
    s->u.pwl.n = n;
    s->u.pwl.t = *time;
    s->u.pwl.v = *value;
    return DALCS_OK;
}

/* A pin is at a level at the start. *changed: it was at another one before. */
static enum dalcs_status start(struct dalcs_stimulus *s, double **time, double **value,
                               size_t *capacity, double level, bool *changed) {
    *changed = *changed || s->u.pwl.v[0] != level;
    DALCS_TRY(dalcs_grow(time, &capacity[0], 1, sizeof(**time)));
    DALCS_TRY(dalcs_grow(value, &capacity[1], 1, sizeof(**value)));
    (*time)[0] = 0.0;
    (*value)[0] = level;
    s->u.pwl.n = 1;
    s->u.pwl.t = *time;
    s->u.pwl.v = *value;
    return DALCS_OK;
}

static double level_of(const struct dalcs_logic_gate *g, int pin, bool q) {
    if (g->kind == DALCS_GATE_SAMPLE) {
        return pin == 0 ? g->held : q;
    }
    return q == (pin == 0) ? g->high : g->low;
}

/* What is held changes at once, and which of both is shown. */
static enum dalcs_status show_sample(struct dalcs_logic_run *l, int k, double t) {
    const struct dalcs_logic_gate *g = &l->network.gate[k];
    struct dalcs_logic_state *state = &l->network.state[k];
    struct dalcs_logic_output *o = &l->output[k];
    if (state->takes) {
        if (l->observer != NULL) {
            l->observer->took(l->observer->user, k);
        }
        dalcs_logic_effect_note(l, g->output[0]);
        DALCS_TRY(write(&l->circuit->stimulus[g->output[0]], &o->time, &o->value, o->capacity,
                        &(struct ramp){t, l->taken[k], 0.0, 1.0}));
    }
    if (g->output[1] >= 0 && o->shown != state->seen) {
        dalcs_logic_effect_note(l, g->output[1]);
        DALCS_TRY(write(&l->circuit->stimulus[g->output[1]], &o->time_bar, &o->value_bar,
                        &o->capacity[2], &(struct ramp){t, state->seen, 0.0, 1.0}));
    }
    state->takes = false;
    dalcs_logic_set_add(&l->network.marked, k);
    o->shown = state->seen;
    return DALCS_OK;
}

enum dalcs_status dalcs_logic_output_show(struct dalcs_logic_run *l, int k, double t) {
    const struct dalcs_logic_gate *g = &l->network.gate[k];
    struct dalcs_logic_output *o = &l->output[k];
    if (g->kind == DALCS_GATE_SAMPLE) {
        return show_sample(l, k, t);
    }
    for (int pin = 0; pin < 2; pin++) {
        if (g->output[pin] >= 0) {
            const double level = level_of(g, pin, l->network.state[k].seen);
            dalcs_logic_effect_note(l, g->output[pin]);
            DALCS_TRY(write(
                &l->circuit->stimulus[g->output[pin]], pin == 0 ? &o->time : &o->time_bar,
                pin == 0 ? &o->value : &o->value_bar, &o->capacity[2 * pin],
                &(struct ramp){t, level, level == g->high ? g->rise : g->fall, g->high - g->low}));
        }
    }
    o->shown = l->network.state[k].seen;
    return DALCS_OK;
}

enum dalcs_status dalcs_logic_output_start(struct dalcs_logic_run *l, int k, bool *changed) {
    const struct dalcs_logic_gate *g = &l->network.gate[k];
    struct dalcs_logic_output *o = &l->output[k];
    for (int pin = 0; pin < 2; pin++) {
        if (g->output[pin] >= 0) {
            DALCS_TRY(start(&l->circuit->stimulus[g->output[pin]],
                            pin == 0 ? &o->time : &o->time_bar,
                            pin == 0 ? &o->value : &o->value_bar, &o->capacity[2 * pin],
                            level_of(g, pin, l->network.state[k].seen), changed));
        }
    }
    o->shown = l->network.state[k].seen;
    return DALCS_OK;
}

enum dalcs_status dalcs_logic_output_restore(struct dalcs_logic_run *l,
                                             const struct dalcs_logic_pin *pin, double value) {
    const struct dalcs_logic_gate *g = &l->network.gate[pin->gate];
    struct dalcs_logic_output *o = &l->output[pin->gate];
    struct dalcs_stimulus *s = &l->circuit->stimulus[pin->stimulus];
    double **time = pin->which == 0 ? &o->time : &o->time_bar;
    double **at = pin->which == 0 ? &o->value : &o->value_bar;
    const double level = pin->holds                     ? value
                         : g->kind == DALCS_GATE_SAMPLE ? o->shown
                                                        : level_of(g, pin->which, o->shown);
    const double lasts = level == g->high ? g->rise : g->fall;
    const bool is_level = g->kind == DALCS_GATE_SAMPLE ||
                          lasts * fabs(level - value) <= l->radau->resolution * (g->high - g->low);
    bool changed = false;
    DALCS_TRY(start(s, time, at, &o->capacity[2 * pin->which], is_level ? level : value, &changed));
    return is_level ? DALCS_OK
                    : write(s, time, at, &o->capacity[2 * pin->which],
                            &(struct ramp){0.0, level, lasts, g->high - g->low});
}

enum dalcs_status dalcs_logic_inputs_start(struct dalcs_logic_run *l) {
    bool changed = false;
    for (int k = 0; k < l->inputs->n; k++) {
        struct dalcs_logic_given *g = &l->inputs->source[k];
        DALCS_TRY(start(&l->circuit->stimulus[g->stimulus], &g->time, &g->value, g->capacity,
                        g->now, &changed));
    }
    for (int k = 0; l->radau != NULL && k < l->radau->n_parts && changed; k++) {
        dalcs_excitation_enter(&l->radau->part[k].excitation, 0.0);
    }
    l->inputs->is_given = false;
    return DALCS_OK;
}

enum dalcs_status dalcs_logic_inputs_show(struct dalcs_logic_run *l, double t, bool *acts) {
    for (int k = 0; l->inputs->is_given && k < l->inputs->n; k++) {
        struct dalcs_logic_given *g = &l->inputs->source[k];
        struct dalcs_stimulus *s = &l->circuit->stimulus[g->stimulus];
        if (s->u.pwl.v[s->u.pwl.n - 1] != g->now) {
            dalcs_logic_effect_note(l, g->stimulus);
            *acts = true;
            DALCS_TRY(
                write(s, &g->time, &g->value, g->capacity, &(struct ramp){t, g->now, 0.0, 1.0}));
        }
    }
    l->inputs->is_given = false;
    return DALCS_OK;
}

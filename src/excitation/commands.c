/* commands.c - walking the edges of control sources and the curves between them, or counting the periods of a PULSE. */
#include "commands.h"

#include "extremes.h"
#include "rounding.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Edges looked at in one search; a control that never crosses must not cost its whole future. */
enum { EDGES_AT_A_TIME = 64 };

/* The side of the switch at this control, with its hysteresis. */
static bool wants(const struct dalcs_pair *s, bool is_on, double control) {
    return is_on ? !(control < s->turn_off) : control > s->turn_on;
}

/* A switch without hysteresis whose control comes to rest at its threshold is open there; at a control that
 * only touches it nothing happens. */
static bool comes_to_rest(const struct dalcs_pair *s, double first, double last) {
    return s->turn_off == s->turn_on && first <= s->turn_on && last <= s->turn_on;
}

/* From `first` at t along a straight line to `last` at its edge: does it move on the way? */
static bool moves_on_line(const struct dalcs_pair *pair, struct dalcs_command *m, double t,
                          double edge, double first, double last) {
    double threshold = m->is_on ? pair->turn_off : pair->turn_on;
    if (m->is_on && comes_to_rest(pair, first, last)) {
        m->next = t;
        return true;
    }
    if (isinf(edge) || wants(pair, m->is_on, last) == m->is_on) {
        m->next = edge;
        return false;
    }
    m->next = t + (edge - t) * fmax(0.0, (threshold - first) / (last - first));
    m->on_ramp = true;
    return true;
}

/* The same along a curve; m->next is its edge, or how far it was looked at, where it does not. */
static bool moves_on_curve(const struct dalcs_commands *c, struct dalcs_command *m, double t,
                           double edge) {
    const struct dalcs_pair *pair = &c->system->pair[m->pair];
    m->next = t;
    m->on_ramp = dalcs_control_follow(&c->control, m->pair, m->is_on ? 1.0 : -1.0,
                                      m->is_on ? pair->turn_off : pair->turn_on, edge, &m->next);
    return m->on_ramp;
}

static void search(const struct dalcs_commands *c, struct dalcs_command *m) {
    const struct dalcs_pair *pair = &c->system->pair[m->pair];
    double t = m->searched;
    bool on_ramp = m->on_ramp;
    m->moves = true;
    m->on_ramp = false;
    for (int k = 0; k < EDGES_AT_A_TIME; k++, on_ramp = false) {
        double first = dalcs_control_value(&c->control, m->pair, t, DALCS_RIGHT);
        if (!on_ramp && wants(pair, m->is_on, first) != m->is_on) {
            m->next = t;
            return;
        }
        double edge = dalcs_control_next_edge(&c->control, m->pair, t);
        double last =
            isinf(edge) ? first : dalcs_control_value(&c->control, m->pair, edge, DALCS_LEFT);
        if (dalcs_control_is_straight(&c->control, m->pair, t)
                ? moves_on_line(pair, m, t, edge, first, last)
                : moves_on_curve(c, m, t, edge)) {
            return;
        }
        if (isinf(m->next)) {
            return;
        }
        t = m->next;
        if (t < edge) {
            break;
        }
    }
    m->moves = false;
    m->next = t;
}

/* A PULSE of a regular shape, all else constant, that crosses both thresholds on its ramps. One that
 * began before t = 0, or whose rise and fall coincide, is none. */
static void recognise_pulse(const struct dalcs_commands *c, struct dalcs_command *m) {
    const struct dalcs_csr *a = &c->system->direct_control;
    const struct dalcs_pair *pair = &c->system->pair[m->pair];
    const struct dalcs_stimulus *pulse = NULL;
    double level = 0.0;
    double factor = 0.0;
    for (int k = a->p[m->pair]; k < a->p[m->pair + 1]; k++) {
        const struct dalcs_stimulus *s = dalcs_control_stimulus(&c->control, a->j[k]);
        if (s == NULL || s->kind == DALCS_STIMULUS_DC) {
            level += a->x[k] * (s != NULL ? s->dc : 1.0);
        } else if (s->kind == DALCS_STIMULUS_PULSE && pulse == NULL) {
            pulse = s;
            factor = a->x[k];
        } else {
            return;
        }
    }
    if (pulse == NULL || pulse->u.pulse.delay < 0.0 || isinf(pulse->u.pulse.period) ||
        pulse->u.pulse.n_periods > 0.0 ||
        pulse->u.pulse.rise + pulse->u.pulse.width + pulse->u.pulse.fall >=
            pulse->u.pulse.period * (1 - 8 * DBL_EPSILON)) {
        return;
    }
    double low = level + factor * pulse->u.pulse.low;
    double high = level + factor * pulse->u.pulse.high;
    double fall_start = pulse->u.pulse.rise + pulse->u.pulse.width;
    if ((low < pair->turn_off || comes_to_rest(pair, low, low)) && high > pair->turn_on) {
        m->offset[0] = pulse->u.pulse.rise * ((pair->turn_on - low) / (high - low));
        m->offset[1] = fall_start + pulse->u.pulse.fall * ((high - pair->turn_off) / (high - low));
    } else if ((high < pair->turn_off || comes_to_rest(pair, high, high)) && low > pair->turn_on) {
        m->offset[1] = pulse->u.pulse.rise * ((low - pair->turn_off) / (low - high));
        m->offset[0] = fall_start + pulse->u.pulse.fall * ((pair->turn_on - high) / (low - high));
    } else {
        return;
    }
    m->pulse = m->offset[0] != m->offset[1] ? pulse : NULL;
}

static void next_of_pulse(struct dalcs_command *m) {
    int way = m->is_on ? 1 : 0;
    m->next = dalcs_command_time(m, way, m->n[way]);
    m->moves = true;
}

enum dalcs_status dalcs_commands_setup(struct dalcs_commands *commands,
                                       const struct dalcs_circuit *circuit,
                                       const struct dalcs_system *system) {
    *commands = (struct dalcs_commands){
        .system = system, .control = {.circuit = circuit, .system = system}, .next = INFINITY};
    size_t n_terms = (size_t)dalcs_control_most_terms(&commands->control);
    commands->command = dalcs_alloc((size_t)system->n_pairs, sizeof(*commands->command));
    commands->control.term = dalcs_alloc(n_terms, sizeof(*commands->control.term));
    if (commands->command == NULL || commands->control.term == NULL) {
        dalcs_commands_finish(commands);
        return DALCS_E_NOMEM;
    }
    for (int d = 0; d < system->n_pairs; d++) {
        if (system->pair[d].kind == DALCS_PAIR_SWITCH && system->pair[d].is_direct) {
            commands->command[commands->n++] = (struct dalcs_command){
                .pair = d, .is_on = system->pair[d].initially_on, .next = INFINITY};
        }
    }
    return DALCS_OK;
}

void dalcs_commands_finish(struct dalcs_commands *commands) {
    free(commands->command);
    free(commands->control.term);
    *commands = (struct dalcs_commands){0};
}

static void find_earliest(struct dalcs_commands *commands) {
    commands->next = INFINITY;
    for (int k = 0; k < commands->n; k++) {
        commands->next = dalcs_smaller(commands->next, commands->command[k].next);
    }
}

void dalcs_commands_start(struct dalcs_commands *commands) {
    for (int k = 0; k < commands->n; k++) {
        struct dalcs_command *m = &commands->command[k];
        const struct dalcs_pair *pair = &commands->system->pair[m->pair];
        const double control = dalcs_control_value(&commands->control, m->pair, 0.0, DALCS_RIGHT);
        const bool stays = m->is_on && pair->turn_off < pair->turn_on;
        m->is_on = wants(pair, stays, control);
        m->searched = 0.0;
        recognise_pulse(commands, m);
        if (m->pulse == NULL) {
            search(commands, m);
            continue;
        }
        /* the first move after 0 alternates from where the switch stands */
        bool closes_first = m->offset[0] < m->offset[1];
        m->n[0] = m->is_on && closes_first ? 1 : 0;
        m->n[1] = !m->is_on && !closes_first ? 1 : 0;
        next_of_pulse(m);
    }
    find_earliest(commands);
}

/* Its next move, if it has one. */
static void pass_one(const struct dalcs_commands *commands, struct dalcs_command *m) {
    if (m->moves) {
        m->n[m->is_on ? 1 : 0]++;
        m->is_on = !m->is_on;
    }
    m->searched = m->next;
    if (m->pulse != NULL) {
        next_of_pulse(m);
    } else {
        search(commands, m);
    }
}

/* A control that touches its threshold may cross it by rounding and come back at the same time. The switch has not moved
 * then: if it were open for no time, it would cut off the current of a coil. */
bool dalcs_commands_obey(struct dalcs_commands *commands, double until) {
    const double last = until + dalcs_rounded * until;
    bool moved = false;
    for (int k = 0; k < commands->n; k++) {
        struct dalcs_command *m = &commands->command[k];
        const bool was_on = m->is_on;
        for (int i = 0; i < EDGES_AT_A_TIME && m->next <= last; i++) {
            pass_one(commands, m);
        }
        moved = moved || m->is_on != was_on;
    }
    find_earliest(commands);
    return moved;
}

void dalcs_commands_disturb(struct dalcs_commands *commands, double t, const bool *changed) {
    const struct dalcs_csr *a = &commands->system->direct_control;
    for (int k = 0; k < commands->n; k++) {
        struct dalcs_command *m = &commands->command[k];
        bool is = false;
        for (int i = a->p[m->pair]; i < a->p[m->pair + 1] && !is; i++) {
            is = dalcs_stimulus_depends(commands->control.circuit,
                                        commands->system->stimulus[a->j[i]], changed);
        }
        if (is) {
            m->searched = t;
            m->on_ramp = false;
            search(commands, m);
        }
    }
    find_earliest(commands);
}

void dalcs_commands_look(struct dalcs_commands *commands, double until) {
    for (int k = 0; k < commands->n; k++) {
        struct dalcs_command *m = &commands->command[k];
        while (!m->moves && m->next < until) {
            m->searched = m->next;
            search(commands, m);
        }
    }
    find_earliest(commands);
}

double dalcs_commands_period(const struct dalcs_commands *commands) {
    const struct dalcs_stimulus *first = commands->n > 0 ? commands->command[0].pulse : NULL;
    bool is_common = first != NULL;
    for (int k = 1; k < commands->n && is_common; k++) {
        const struct dalcs_stimulus *pulse = commands->command[k].pulse;
        is_common = pulse != NULL && pulse->u.pulse.period == first->u.pulse.period;
    }
    return is_common ? first->u.pulse.period : 0.0;
}

void dalcs_commands_leap(struct dalcs_commands *commands, long n_periods) {
    for (int k = 0; k < commands->n; k++) {
        struct dalcs_command *m = &commands->command[k];
        m->n[0] += n_periods;
        m->n[1] += n_periods;
        next_of_pulse(m);
    }
    find_earliest(commands);
}

/* orbit_commands.c - how far small signals of sources move the commands at which spans end. */
#include "orbit_commands.h"

#include "magnitudes.h"
#include "orbit_rates.h"
#include "rounding.h"

#include <math.h>

/* dt of the command of a pair that moves at t > 0, of the small signals of its sources; by[n_pins] of the outputs of gates, or
 * NULL. */
static void find_command(const struct dalcs_orbit_log *log, const struct dalcs_radau_part *part,
                         int pair, double t, double *dt, double *by) {
    const struct dalcs_logic_memory *gates = log->gates != NULL ? log->gates->memory : NULL;
    const struct dalcs_control *control = &part->commands.control;
    const struct dalcs_csr *a = &part->component->system->direct_control;
    double left = dalcs_control_value(control, pair, t * (1.0 - dalcs_answer_rounded), DALCS_LEFT);
    double right = dalcs_control_value(control, pair, t, DALCS_RIGHT);
    double size = 0.0;
    double slope = 0.0;
    double moved[2] = {0.0, 0.0};
    for (int k = a->p[pair]; k < a->p[pair + 1]; k++) {
        const struct dalcs_stimulus *s = dalcs_control_stimulus(control, a->j[k]);
        if (s != NULL) {
            size += fabs(a->x[k] * dalcs_stimulus_value(s, t, DALCS_RIGHT));
            slope += a->x[k] * dalcs_slope_before(s, t, control->term);
            const double complex small =
                log->sources.of(log->sources.user, part->component->system->stimulus[a->j[k]]);
            moved[0] += a->x[k] * creal(small);
            moved[1] += a->x[k] * cimag(small);
        }
    }
    const double steep =
        slope * t * dalcs_answer_rounded; /* a ramp of no time goes as far from there to here */
    bool is_edge = fabs(left + steep - right) > dalcs_alike * size || slope == 0.0;
    dt[0] = is_edge ? 0.0 : -moved[0] / slope;
    dt[1] = is_edge ? 0.0 : -moved[1] / slope;
    for (int k = a->p[pair]; k < a->p[pair + 1] && by != NULL; k++) {
        const int pin = dalcs_logic_pin_of(gates, part->component->system->stimulus[a->j[k]]);
        if (pin >= 0 && !is_edge) {
            by[pin] -= a->x[k] / slope;
        }
    }
}

void dalcs_orbit_take_command(struct dalcs_orbit_part *p, struct dalcs_orbit_span *span, int pair,
                              double t, bool *any) {
    double dt[2];
    double *by = !*any && span->gates != NULL ? span->gates->by : NULL;
    find_command(p->log, p->rates.part, pair, t, dt, by);
    if (!*any) {
        span->moved[0] = dt[0];
        span->moved[1] = dt[1];
        *any = true;
        return;
    }
    double off = hypot(dt[0] - span->moved[0], dt[1] - span->moved[1]);
    if (off > dalcs_alike * hypot(dt[0], dt[1])) {
        p->log->is_exact = false;
    }
}

void dalcs_orbit_find_commands(struct dalcs_orbit_part *p, struct dalcs_orbit_span *span) {
    const struct dalcs_commands *c = &p->rates.part->commands;
    bool any = false;
    for (int k = 0; k < c->n; k++) {
        const struct dalcs_command *m = &c->command[k];
        if (m->moves && m->next <= span->to + p->log->radau->resolution) {
            dalcs_orbit_take_command(p, span, m->pair, span->to, &any);
        }
    }
}

/* ---- Where the period ends ----------------------------------------------------------------------- */

/* A command of t = 0 that comes along a ramp is one of t = T, of which the run has seen the other side. */
static bool find_last_commands(struct dalcs_orbit_part *p, struct dalcs_orbit_span *last) {
    const struct dalcs_commands *c = &p->rates.part->commands;
    bool any = false;
    for (int k = 0; k < c->n; k++) {
        const int pair = c->command[k].pair;
        if (dalcs_mode_has(p->span[0].mode, pair) != dalcs_mode_has(last->mode, pair)) {
            dalcs_orbit_take_command(p, last, pair, last->to, &any);
        }
    }
    return any;
}

/* A diode at its corner where the last segment ends, over the largest that this guard has in it. */
static bool is_at_corner(const struct dalcs_radau_part *part, int row) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    double largest = 0.0;
    double weight[DALCS_MAX_NODES];
    dalcs_collocation_weights(part->stages.method, part->segment.end, weight);
    for (int node = 0; node < l->n_nodes; node++) {
        largest = fmax(largest, fabs(part->segment.out[node * l->stride + row]));
    }
    return fabs(dalcs_orbit_weigh(l, weight, part->segment.out, row)) <= dalcs_alike * largest;
}

/* A diode that a sine from 0 on turns over is at its corner at t = 0. The run begins behind that, and ends before it. */
static void find_last_diode(const struct dalcs_orbit_part *p, struct dalcs_orbit_span *last) {
    const struct dalcs_radau_part *part = p->rates.part;
    const struct dalcs_system *s = part->component->system;
    for (int k = 0; k < s->n_pairs && last->row < 0 && !part->segment.by_euler; k++) {
        const int row = dalcs_orbit_guard_row(part, k);
        if (s->pair[k].kind == DALCS_PAIR_DIODE &&
            dalcs_mode_has(p->span[0].mode, k) != dalcs_mode_has(last->mode, k) &&
            is_at_corner(part, row)) {
            last->rate = dalcs_orbit_guard_rate(part, row);
            last->row = last->rate < 0.0 ? row : -1;
        }
    }
}

bool dalcs_orbit_find_last(struct dalcs_orbit_part *p) {
    struct dalcs_orbit_span *last = &p->span[p->n - 1];
    if (!find_last_commands(p, last)) {
        find_last_diode(p, last);
    }
    return last->row >= 0 || last->moved[0] != 0.0 || last->moved[1] != 0.0;
}

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

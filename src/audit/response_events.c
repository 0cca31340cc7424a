/* response_events.c - what small signals make of the events of an orbit.
 *
 * A small signal makes an event late by dt. The states behind it are then off by (f- - f+) dt more than before it, with their
 * derivatives f on both sides (Aizerman and Gantmakher, 1958). A diode or a switch that changes sides where its guard g passes
 * through 0 is late by dt = -dg / g'. Where a source has an edge, what that brings about is not late. */
#include "response_internal.h"

#include "magnitudes.h"

/* ---- States -------------------------------------------------------------------------------------- */

static bool is_storage(const struct dalcs_response_audit *a, int device) {
    const enum dalcs_device_kind kind = a->circuit->device[device].kind;
    return a->of.are_there[device] && !a->circuit->device[device].is_storage &&
           (kind == DALCS_CAPACITOR || kind == DALCS_INDUCTOR);
}

/* Of a capacitor its voltage, of a coil its flux: coils that are coupled perfectly may exchange their currents. */
struct state {
    double complex value, rate;
    double size;  /* what it is a sum of */
    double orbit; /* the most that the orbit may have of it */
};

static void add_flux(const struct dalcs_response_audit *a, const struct dalcs_response_values *is,
                     struct state *to, int device, double inductance) {
    to->value += inductance * is->i[device];
    to->rate += inductance * is->i_rate[device];
    to->size += fabs(inductance) * fmax(is->size[device], 0.0);
    to->orbit += fabs(inductance) * a->orbit.amperes;
}

static struct state state_of(const struct dalcs_response_audit *a,
                             const struct dalcs_response_values *is, int device) {
    const struct dalcs_circuit *c = a->circuit;
    const struct dalcs_device *d = &c->device[device];
    struct state s = {0};
    if (d->kind == DALCS_CAPACITOR) {
        return (struct state){is->u[device], is->u_rate[device], response_magnitude(is->u[device]),
                              a->orbit.volts};
    }
    add_flux(a, is, &s, device, d->value);
    for (int k = 0; k < c->n_couplings; k++) {
        const struct dalcs_coupling *m = &c->coupling[k];
        const int end = m->inductor[0] == device ? 1 : m->inductor[1] == device ? 0 : -1;
        if (end >= 0) {
            const int other = m->inductor[end];
            add_flux(a, is, &s, other, m->k * sqrt(d->value * c->device[other].value));
        }
    }
    return s;
}

/* Behind a jump of the orbit states are what charges and fluxes make of them. */
static bool orbit_jumps(const struct dalcs_response_audit *a,
                        const struct dalcs_response_event *e) {
    bool does = false;
    for (int d = 0; d < a->circuit->n_devices && !does; d++) {
        if (is_storage(a, d)) {
            const struct state before = state_of(a, e->at[0], d), behind = state_of(a, e->at[1], d);
            does = response_magnitude(behind.value - before.value) > dalcs_nothing * before.orbit;
        }
    }
    return does;
}

static struct response_gain gain_of(const struct dalcs_response_audit *a,
                                    const struct dalcs_response_event *e, int device) {
    const struct state before = state_of(a, e->is[0], device);
    const struct state behind = state_of(a, e->is[1], device);
    const struct dalcs_device *d = &a->circuit->device[device];
    const double late = response_magnitude(e->late);
    const double largest = d->kind == DALCS_CAPACITOR ? a->volts : d->value * a->amperes;
    double complex off = behind.value - before.value;
    double allowed =
        a->tolerance * (response_magnitude(before.value) + response_magnitude(behind.value));
    for (int side = 0; side < 2 && late > 0.0; side++) {
        const struct state s = state_of(a, e->at[side], device);
        off += (side == 0 ? -s.rate : s.rate) * e->late;
        allowed += late * (a->tolerance * response_magnitude(s.rate) +
                           a->orbit.tolerance * e->at[side]->steepness * s.orbit);
    }
    return (struct response_gain){off,
                                  allowed + a->rounding * (before.size + behind.size + largest)};
}

static void check_states(struct dalcs_response_audit *a, const struct dalcs_response_event *e) {
    if (e->at[0] != NULL && orbit_jumps(a, e)) {
        a->n_not_checked++;
        return;
    }
    response_find_small(a, e->is[0]);
    const bool joins = e->at[0] != NULL && response_may_join(a, e);
    const bool parts = e->at[0] != NULL && response_may_part(a, e);
    for (int d = 0; d < a->circuit->n_devices; d++) {
        if (!is_storage(a, d)) {
            continue;
        }
        a->work.gain[d] = gain_of(a, e, d);
        const bool is_coil = response_is_coil(a, d);
        if (is_coil ? !parts : !joins) {
            const double per = is_coil ? a->circuit->device[d].value : 1.0;
            response_found(a, DALCS_RESPONSE_STATE, d,
                           response_magnitude(a->work.gain[d].off) / per,
                           a->work.gain[d].allowed / per);
        }
    }
    if (joins) {
        response_check_charges(a, e, a->work.gain);
    }
    if (parts) {
        response_check_fluxes(a, e, a->work.gain);
    }
}

/* ---- Times --------------------------------------------------------------------------------------- */

/* What passes through 0: a control and its threshold, a diode's own current, or its voltage and its drop. */
struct guard {
    double at, rate, size; /* of the orbit */
    double complex moved;
    double moved_size; /* what it is a sum of, or beside */
};

static double complex read_guard(const struct dalcs_response_audit *a, int device, bool was_on,
                                 const double complex *v, const double complex *i) {
    const struct dalcs_device *d = &a->circuit->device[device];
    const double complex u = v[d->node[0]] - v[d->node[1]];
    if (d->kind == DALCS_SWITCH) {
        return d->control >= 0 ? i[d->control] : v[d->node[2]] - v[d->node[3]];
    }
    const struct dalcs_diode_model *m = &a->circuit->models.of_diode[d->model];
    return was_on ? i[device] - (isfinite(m->roff) ? u / m->roff : 0.0) : u;
}

static struct guard find_guard(const struct dalcs_response_audit *a,
                               const struct dalcs_response_event *e, int device,
                               const double small[2]) {
    const bool on = e->changes[device] < 0;
    const struct dalcs_device *d = &a->circuit->device[device];
    const struct dalcs_response_values *at = e->at[0], *is = e->is[0];
    const double complex now = read_guard(a, device, on, at->v, at->i);
    struct guard g = {.moved = read_guard(a, device, on, is->v, is->i),
                      .rate = creal(read_guard(a, device, on, at->v_rate, at->i_rate))};
    const bool is_current = d->kind == DALCS_SWITCH ? d->control >= 0 : on;
    double threshold = 0.0;
    if (d->kind == DALCS_SWITCH) {
        const struct dalcs_switch_model *m = &a->circuit->models.of_switch[d->model];
        const double width = fabs(m->vh);
        const double low = creal(now) - (m->vt - width), high = creal(now) - (m->vt + width);
        threshold = fabs(low) < fabs(high) ? m->vt - width : m->vt + width;
    } else if (!on) {
        threshold = a->circuit->models.of_diode[d->model].vfwd;
    }
    g.at = creal(now) - threshold;
    g.size = (is_current ? a->orbit.amperes : a->orbit.volts) + fabs(threshold);
    g.moved_size =
        small[is_current ? 1 : 0] +
        (is_current ? fmax(is->size[d->kind == DALCS_SWITCH ? d->control : device], 0.0) : 0.0);
    return g;
}

/* How far the lateness is from what the guard says, over what is allowed; INFINITY: it says nothing. *is_at: the guard is at its
 * threshold there. */
static double look_at_guard(const struct dalcs_response_audit *a,
                            const struct dalcs_response_event *e, const struct guard *g,
                            double off[2], bool *is_at) {
    const double late = response_magnitude(e->late);
    const double error = a->orbit.tolerance * e->at[0]->steepness * g->size;
    *is_at = fabs(g->at) <= a->tolerance * g->size;
    if (!*is_at || !(fabs(g->rate) > error)) {
        return INFINITY;
    }
    const double moved = response_magnitude(g->moved);
    off[0] = response_magnitude(g->moved + g->rate * e->late);
    off[1] = a->tolerance * (moved + fabs(g->rate) * late) + error * late +
             a->rounding * (g->moved_size + moved);
    return off[0] / off[1];
}

/* Of all that change sides one brings the event about, or an edge does. */
static void check_time(struct dalcs_response_audit *a, const struct dalcs_response_event *e) {
    double least = INFINITY;
    double of[2] = {0.0, 0.0};
    int who = -1;
    bool is_open = e->has_other_causes || (e->is_at_edge && e->late == 0.0);
    response_find_small(a, e->is[0]);
    const double small[2] = {a->volts, a->amperes};
    for (int d = 0; d < a->circuit->n_devices && !is_open; d++) {
        if (e->changes[d] == 0) {
            continue;
        }
        double off[2] = {0.0, 0.0};
        bool is_at;
        const struct guard g = find_guard(a, e, d, small);
        const double far = look_at_guard(a, e, &g, off, &is_at);
        is_open = isnan(g.at) || isnan(creal(g.moved)) || (is_at && isinf(far));
        if (far < least) {
            least = far;
            who = d;
            of[0] = off[0];
            of[1] = off[1];
        }
    }
    if (is_open || who < 0) {
        a->n_not_checked++;
    } else {
        response_found(a, DALCS_RESPONSE_TIME, who, of[0], of[1]);
    }
}

void dalcs_response_audit_event(struct dalcs_response_audit *a,
                                const struct dalcs_response_event *e) {
    bool any = false;
    for (int d = 0; d < a->circuit->n_devices; d++) {
        any = any || e->changes[d] != 0;
    }
    check_states(a, e);
    if (any) {
        check_time(a, e);
    }
}

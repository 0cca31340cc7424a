/* interruption.c - coils whose current an ideal switch cuts off.
 *
 * The current stops at once, and the voltage is an impulse: a jump like any other, but hardly ever what
 * was meant. A real switch would burn. */
#include "session_internal.h"

#include <math.h>

/* A flux below this part of the largest is rounding, and so is a change of a current. */
static const double noticeable = 1e-9;

/* J: what is less is rounding that an operating point has left in a coil. */
static const double slight = 1e-24;

/* The coil whose current changes most. */
static const struct dalcs_state *interrupted_coil(const struct dalcs_network *n,
                                                  const struct dalcs_euler_jump *j, double *before,
                                                  double *after) {
    static const double no_inputs[1] = {1.0}; /* states are columns only */
    const struct dalcs_state *coil = NULL;
    double most = 0.0;
    for (int i = 0; i < n->n_states; i++) {
        const struct dalcs_state *x = &n->state[i];
        if (!x->is_current || x->probe.system != j->system) {
            continue;
        }
        double from = dalcs_probe_value(&x->probe, j->before, no_inputs);
        double to = dalcs_probe_value(&x->probe, j->after, no_inputs);
        bool jumps = fabs(to - from) > noticeable * fmax(fabs(from), fabs(to));
        if (jumps && fabs(to - from) > most) {
            most = fabs(to - from);
            coil = x;
            *before = from;
            *after = to;
        }
    }
    return coil;
}

static enum dalcs_status warn(struct dalcs_run *r, const struct dalcs_euler_jump *j,
                              const char *name, double flux) {
    double before = 0.0;
    double after = 0.0;
    const struct dalcs_state *coil = interrupted_coil(&r->s->network, j, &before, &after);
    if (coil == NULL || j->energy_lost < slight || dalcs_names_find(&r->interrupting, name) >= 0) {
        return DALCS_OK;
    }
    dalcs_diag_add(
        &r->s->diag, DALCS_WARNING, dalcs_place_of(&r->s->circuit, name),
        "a diode or a capacitor would let the current go on, Roff= would bound the voltage",
        "opening at t = %.9g s, '%s' interrupts the current of '%s': it jumps from %.6g A "
        "to %.6g A with a voltage impulse of %.6g Wb, and %.6g J are lost",
        j->time, name, coil->element, before, after, fabs(flux), j->energy_lost);
    return dalcs_names_add(&r->interrupting, name, 0);
}

enum dalcs_status dalcs_note_jump(void *user, const struct dalcs_euler_jump *j) {
    struct dalcs_run *r = user;
    const struct dalcs_system *s = &r->s->network.system[j->system];
    double largest = 0.0;
    for (int d = 0; d < s->n_pairs; d++) {
        largest = fmax(largest, fabs(j->flux[d]));
    }
    for (int d = 0; d < s->n_pairs; d++) {
        if (s->pair[d].kind == DALCS_PAIR_SWITCH && fabs(j->flux[d]) > noticeable * largest) {
            DALCS_TRY(warn(r, j, s->pair[d].element, j->flux[d]));
        }
    }
    return dalcs_recorder_jump(&r->s->recorder, j);
}

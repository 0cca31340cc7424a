/* transient.c - the loop over time of the Radau methods: rows when they are due, both sides of what
 * happens in between. */
#include "session_internal.h"

#include "radau.h"

#include <math.h>
#include <stdlib.h>

struct transient {
    struct dalcs_run *run;
    struct dalcs_recorder *recorder;
    struct dalcs_radau *radau;
    double t;
    double next_edge; /* s, of any source: rows are wanted there */
};

static double edge_after(const struct transient *c, double t) {
    const struct dalcs_circuit *circuit = &c->run->s->circuit;
    double edge = INFINITY;
    for (int i = 0; i < circuit->n_stimuli && dalcs_recorder_wants_sides(c->recorder, INFINITY);
         i++) {
        edge = fmin(edge, dalcs_stimulus_next_edge(&circuit->stimulus[i], t));
    }
    return edge;
}

static bool source_jumps(const struct transient *c) {
    const struct dalcs_circuit *circuit = &c->run->s->circuit;
    bool jumps = false;
    for (int i = 0; i < circuit->n_stimuli && !jumps; i++) {
        jumps = dalcs_stimulus_jumps_at(&circuit->stimulus[i], c->t);
    }
    return jumps;
}

static enum dalcs_status row(struct transient *c, enum dalcs_side side, bool is_due) {
    DALCS_TRY(dalcs_radau_evaluate(c->radau, c->t, side));
    return dalcs_recorder_row(c->recorder, c->radau->base, c->t, is_due);
}

/* To the next time at which there is something to write or to do. */
static enum dalcs_status advance(struct transient *c) {
    struct dalcs_radau *radau = c->radau;
    double near = radau->resolution;
    double stop = radau->options.stop;
    bool happens;
    double due = dalcs_recorder_due(c->recorder);
    double end = dalcs_radau_next_stop(radau, &happens);
    double t = fmin(fmin(due, end), fmin(c->next_edge, stop));
    bool ends = end <= t + near;
    bool edge = c->next_edge <= t + near;
    if (ends) {
        t = end;
    } else if (edge) {
        t = c->next_edge;
    }
    c->t = t;
    bool sides = dalcs_recorder_wants_sides(c->recorder, t);
    bool is_due = due <= t + near;
    bool written = is_due || (sides && (edge || (ends && happens)));
    if (written) {
        DALCS_TRY(row(c, DALCS_LEFT, is_due));
    }
    if (t >= stop - near) {
        c->t = stop;
        return DALCS_OK;
    }
    if (ends) {
        radau->base->t = t;
        DALCS_TRY(dalcs_radau_pass(radau, t));
        radau->base->t = t;
        DALCS_TRY(dalcs_recorder_events(c->recorder, radau->base));
    }
    bool jumps = edge && source_jumps(c);
    if (edge) {
        c->next_edge = edge_after(c, t);
    }
    if (sides && ((ends && happens) || jumps)) {
        DALCS_TRY(row(c, DALCS_RIGHT, false));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_transient_run(struct dalcs_run *r, struct dalcs_radau *radau) {
    struct transient c = {.run = r, .recorder = &r->s->recorder, .radau = radau};
    c.next_edge = edge_after(&c, 0.0);
    long rounds = 0;
    while (c.t < radau->options.stop) {
        DALCS_TRY(advance(&c));
        if ((++rounds & 0xfff) == 0) {
            DALCS_TRY(r->sink->progress(r->sink->user, c.t, radau->options.stop));
        }
    }
    return DALCS_OK;
}

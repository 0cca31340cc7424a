/* start.c - where a run stands at t = 0, and its first segments. */
#include "radau.h"

#include "radau_enter.h"
#include "restart.h"
#include "segment.h"

#include <math.h>
#include <string.h>

void dalcs_radau_obey_commands(struct dalcs_radau_part *part) {
    for (int k = 0; k < part->commands.n; k++) {
        const struct dalcs_command *m = &part->commands.command[k];
        dalcs_osnsp_command(&part->component->osnsp, m->pair, m->is_on);
    }
}

/* Those of the operating point, where there was one: a hysteresis goes on from there. */
static void remember_switches(struct dalcs_radau_part *part) {
    for (int k = 0; k < part->commands.n; k++) {
        struct dalcs_command *m = &part->commands.command[k];
        m->is_on = dalcs_osnsp_is_on(&part->component->osnsp, m->pair);
    }
}

bool dalcs_radau_enter_edges(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                             bool *jumps) {
    struct dalcs_excitation *e = &part->excitation;
    bool any = false;
    *jumps = false;
    while (e->next_edge <= part->segment.t + r->resolution) {
        dalcs_excitation_enter(e, fmax(part->segment.t, e->next_edge));
        *jumps = *jumps || e->jumps;
        any = true;
    }
    return any;
}

bool dalcs_radau_commands_at_start(struct dalcs_radau *r) {
    bool moves = false;
    for (int k = 0; k < r->n_parts; k++) {
        struct dalcs_radau_part *part = &r->part[k];
        if (part->kind != DALCS_PART_ALGEBRAIC) {
            remember_switches(part);
            dalcs_commands_start(&part->commands);
            moves = dalcs_commands_obey(&part->commands, r->resolution) || moves;
        }
    }
    return moves;
}

/* All but its first segment. */
static void stand(struct dalcs_radau *r, struct dalcs_radau_part *part, const double *x) {
    struct dalcs_component *c = part->component;
    memcpy(part->x, x, (size_t)c->system->n_x * sizeof(double));
    if (r->base->listener.observer != NULL) {
        r->base->listener.observer->start(r->base->listener.observer->user, part->index, x);
    }
    part->is_answered = false;
    part->answered_at = 0.0;
    part->waits = part->kind == DALCS_PART_STEPPED;
    if (!part->waits) {
        part->segment.t_end = INFINITY;
        return;
    }
    remember_switches(part);
    dalcs_commands_start(&part->commands);
    (void)dalcs_commands_obey(&part->commands, r->resolution);
    bool jumps; /* as a start does anyhow */
    (void)dalcs_radau_enter_edges(r, part, &jumps);
    dalcs_radau_obey_commands(part);
    part->guards.fresh = true;
    part->segment.anew = true;
}

enum dalcs_status dalcs_radau_decide(struct dalcs_radau *r, double t) {
    if (r->decider.decide == NULL) {
        return DALCS_OK;
    }
    r->decider.is_asked = true;
    const enum dalcs_status status = r->decider.decide(r->decider.user, t);
    r->decider.is_asked = false;
    return status;
}

void dalcs_radau_start(struct dalcs_radau *r, double *const *initial) {
    r->is_given = initial != NULL;
    for (int k = 0; k < r->n_parts; k++) {
        struct dalcs_radau_part *part = &r->part[k];
        stand(r, part, initial != NULL ? initial[k] : part->component->y);
    }
}

enum dalcs_status dalcs_radau_begin(struct dalcs_radau *r) {
    DALCS_TRY(dalcs_radau_decide(r, 0.0));
    for (int k = 0; k < r->n_parts; k++) {
        struct dalcs_radau_part *part = &r->part[k];
        struct dalcs_component *c = part->component;
        dalcs_component_sample(c, 0.0, DALCS_RIGHT, c->u);
        if (part->waits && (r->is_given || dalcs_component_jumps_at_start(c))) {
            bool is_off; /* for the first segment to find */
            DALCS_TRY(dalcs_radau_restart(r, part, 0, false, &is_off));
        }
        if (part->waits) {
            part->waits = false;
            DALCS_TRY(dalcs_segment_begin(r, part));
        }
    }
    return dalcs_radau_tell_open(r);
}

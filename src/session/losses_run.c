/* losses_run.c - passes segments and instants of a run on to the sums of losses. */
#include "losses_run.h"

#include "sliding.h"

#include <stdlib.h>

static enum dalcs_status find_pairs(struct dalcs_losses_run *losses, const struct dalcs_run *r) {
    const struct dalcs_network *n = &r->s->network;
    DALCS_TRY(dalcs_device_map_setup(&losses->devices, &r->s->circuit, n));
    for (int k = 0; k < r->s->circuit.n_devices; k++) {
        losses->forward[k] = (struct dalcs_loss_pair){-1, -1};
    }
    for (int s = 0; s < n->n_systems; s++) {
        for (int d = 0; d < n->system[s].n_pairs; d++) {
            const int k = losses->devices.of_pair[s][d];
            if (k >= 0 && !n->system[s].pair[d].is_breakdown) {
                losses->forward[k] = (struct dalcs_loss_pair){s, d};
            }
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_losses_run_start(struct dalcs_losses_run *losses, struct dalcs_run *r,
                                         const struct dalcs_euler *e, bool is_euler, double near) {
    const struct dalcs_circuit *c = &r->s->circuit;
    if (!dalcs_run_wants_losses(r)) {
        return DALCS_OK;
    }
    losses->wanted = true;
    r->transient.losses = losses;
    losses->engine = e;
    losses->is_euler = is_euler;
    DALCS_TRY(dalcs_losses_sum_setup(&losses->sum, c, c->analyses.transient.stop, near));
    losses->sum.is_euler = is_euler;
    losses->forward = dalcs_alloc((size_t)c->n_devices, sizeof(*losses->forward));
    losses->on = dalcs_alloc((size_t)c->n_devices, sizeof(bool));
    losses->slid = dalcs_alloc((size_t)c->n_devices, sizeof(bool));
    losses->network = &r->s->network;
    if (losses->forward == NULL || losses->on == NULL || losses->slid == NULL) {
        return DALCS_E_NOMEM;
    }
    return find_pairs(losses, r);
}

double dalcs_losses_run_begin(const struct dalcs_losses_run *losses) {
    return losses->sum.from - 4.0 * losses->sum.near;
}

void dalcs_losses_run_finish(struct dalcs_losses_run *losses) {
    dalcs_device_map_finish(&losses->devices);
    free(losses->forward);
    free(losses->on);
    free(losses->slid);
    dalcs_losses_sum_finish(&losses->sum);
    *losses = (struct dalcs_losses_run){0};
}

static void take_sides(struct dalcs_losses_run *losses) {
    for (int k = 0; k < losses->sum.circuit->n_devices; k++) {
        const struct dalcs_loss_pair *p = &losses->forward[k];
        losses->on[k] = p->system >= 0 &&
                        dalcs_osnsp_is_on(&losses->engine->component[p->system].osnsp, p->pair);
    }
}

void dalcs_losses_run_before_start(struct dalcs_losses_run *losses) {
    take_sides(losses);
    for (int k = 0; k < losses->sum.circuit->n_devices; k++) {
        losses->sum.device[k].is_on = losses->on[k];
    }
    losses->sum.knows_sides = true;
}

/* The energy stored before a jump at the start. */
static void note_first(struct dalcs_losses_run *losses, const struct dalcs_euler_jump *j) {
    static const double no_inputs[1] = {1.0}; /* states are columns only */
    for (int i = 0; i < losses->network->n_states; i++) {
        const struct dalcs_state *x = &losses->network->state[i];
        if (x->probe.system == j->system && losses->devices.of_state[i] >= 0 &&
            dalcs_probe_is_known(&x->probe, j->n_known)) {
            losses->sum.device[losses->devices.of_state[i]].first =
                dalcs_probe_value(&x->probe, j->before, no_inputs);
        }
    }
}

enum dalcs_status dalcs_losses_run_jump(struct dalcs_losses_run *losses,
                                        const struct dalcs_euler_jump *j) {
    const struct dalcs_circuit *c = losses->sum.circuit;
    if (!losses->wanted) {
        return DALCS_OK;
    }
    const struct dalcs_system *s = losses->engine->component[j->system].system;
    struct dalcs_loss_jump *jump = dalcs_losses_sum_jump(&losses->sum, j->time, s->n_pairs);
    if (jump == NULL) {
        return DALCS_E_NOMEM;
    }
    if (!losses->sum.has_last) {
        note_first(losses, j);
    }
    jump->energy_lost = j->energy_lost;
    jump->is_in_steps = losses->is_euler;
    for (int d = 0; d < s->n_pairs; d++) {
        const int k = losses->devices.of_pair[j->system][d];
        if (k < 0) {
            continue;
        }
        struct dalcs_loss_impulse *i = &jump->impulse[jump->n++];
        const bool back = s->pair[d].is_breakdown;
        *i = (struct dalcs_loss_impulse){.device = k, .charge = j->charge[d]};
        if (c->device[k].kind == DALCS_DIODE) {
            const struct dalcs_diode_model *m = &c->models.of_diode[c->device[k].model];
            i->in_thresholds =
                j->charge[d] == 0.0 ? 0.0 : (back ? m->vrev : m->vfwd) * j->charge[d];
        }
        i->charge = back ? -i->charge : i->charge;
        i->flux = back ? 0.0 : -j->flux[d]; /* w is a voltage in reverse */
    }
    return DALCS_OK;
}

static void note_slides(struct dalcs_losses_run *losses, const struct dalcs_stretch *stretch) {
    if (stretch->to <= losses->sum.from || stretch->from >= losses->sum.to) {
        return;
    }
    for (int k = 0; k < losses->sum.circuit->n_devices; k++) {
        const struct dalcs_loss_pair *of = &losses->forward[k];
        if (of->system >= 0 && losses->engine->component[of->system].positions.joined) {
            losses->slid[k] =
                losses->slid[k] ||
                dalcs_sliding_turns(&losses->engine->component[of->system].positions, of->pair);
        }
    }
}

void dalcs_losses_run_stretch(struct dalcs_losses_run *losses,
                              const struct dalcs_stretch *stretch) {
    take_sides(losses);
    note_slides(losses, stretch);
    dalcs_audit_losses_begin(&losses->audit, &losses->sum, stretch);
    dalcs_losses_sum_stretch(&losses->sum, stretch, losses->on);
    dalcs_audit_losses_end(&losses->audit, &losses->sum, stretch);
}

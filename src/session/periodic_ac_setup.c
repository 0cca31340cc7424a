/* periodic_ac_setup.c - the parts of the circuit that a small signal reaches, before the first frequency. */
#include "periodic_ac.h"

#include "pi.h"

#include <math.h>

static void mark_probe(const struct dalcs_probe *probe, int system, bool *is_read) {
    for (int m = 0; probe->system == system && m < probe->n_terms; m++) {
        is_read[probe->term[m].index] = true;
    }
}

/* Columns of a system that outputs read, or the loop. */
static void mark_read(const struct dalcs_periodic_ac *a, int system, bool *is_read) {
    const struct dalcs_network *network = &a->run->s->network;
    for (int i = 0; i < network->n_outputs; i++) {
        mark_probe(&network->output[i].plus, system, is_read);
        mark_probe(&network->output[i].minus, system, is_read);
    }
    if (a->loop.device >= 0 && a->loop.system == system) {
        dalcs_periodic_loop_mark(a, is_read);
    }
}

static double fastest_of(const struct dalcs_sweep *f) {
    double fastest = 0.0;
    for (int k = 0; k < f->n; k++) {
        fastest = fmax(fastest, dalcs_sweep_value(f, k));
    }
    return dalcs_two_pi * fastest;
}

static enum dalcs_status go_on(void *user) {
    const struct dalcs_periodic_ac *a = user;
    return dalcs_run_progress(a->run, 0.0, a->sweep->n);
}

static enum dalcs_status refuse_rough(const struct dalcs_periodic_ac *a) {
    struct dalcs_run *r = a->run;
    dalcs_diag_add(
        &r->s->diag, DALCS_ERROR, &r->s->circuit.analyses.ac.where,
        "leave out elements of nearly no effect, or make nearly ideal ones ideal, such as a "
        "coupling next to 1; or inject a small sine in .tran",
        "the response was not found: small signals are not accurate enough over a period, "
        "however short its segments are");
    return DALCS_NOT_CONVERGED;
}

/* of: the device whose stimulus alone has a small signal; -1: the AC values of all. */
static enum dalcs_status part_setup(struct dalcs_periodic_ac *a, struct dalcs_periodic_ac_part *p,
                                    int k, int of, double fastest) {
    const struct dalcs_system *s = &a->run->s->network.system[k];
    const size_t n_columns = (size_t)dalcs_system_n_columns(s);
    const size_t n_inputs = (size_t)s->n_inputs;
    bool *is_read = dalcs_arena_alloc(&a->arena, n_columns, sizeof(bool));
    p->source = dalcs_arena_alloc(&a->arena, n_inputs, sizeof *p->source);
    bool complete = is_read != NULL && p->source != NULL;
    for (int which = 0; which < 2; which++) {
        p->y[which] = dalcs_arena_alloc(&a->arena, n_columns, sizeof(double));
        p->s[which] = dalcs_arena_alloc(&a->arena, n_inputs, sizeof(double));
        complete = complete && p->y[which] != NULL && p->s[which] != NULL;
    }
    if (!complete) {
        return DALCS_E_NOMEM;
    }
    p->rests = true;
    for (int i = 1; i < s->n_inputs; i++) {
        p->source[i] = dalcs_periodic_loop_source(a, of, s->stimulus[i]);
        p->s[0][i] = a->sideband == 0 ? creal(p->source[i]) : 0.0;
        p->s[1][i] = a->sideband == 0 ? cimag(p->source[i]) : 0.0;
        p->rests = p->rests && p->source[i] == 0.0;
    }
    if (p->rests) {
        return DALCS_OK;
    }
    mark_read(a, k, is_read);
    const struct dalcs_periodic_flow_asked asked = {.source = p->source,
                                                    .is_still = of >= 0 && of != a->loop.device,
                                                    .is_read = is_read,
                                                    .keeps_all = a->log.is_recorded,
                                                    .fastest = fastest,
                                                    .period = a->st->period,
                                                    .go_on = go_on,
                                                    .user = a};
    const enum dalcs_status status = dalcs_periodic_flow_setup(&p->flow, &a->log.part[k], &asked);
    if (status == DALCS_NOT_CONVERGED || status == DALCS_SINGULAR) {
        return refuse_rough(a);
    }
    DALCS_TRY(status);
    return dalcs_periodic_response_setup(&p->response, &p->flow, is_read);
}

enum dalcs_status dalcs_periodic_ac_setup(struct dalcs_periodic_ac *a) {
    const double fastest = fastest_of(a->sweep);
    const size_t n_outputs = (size_t)a->run->s->network.n_outputs;
    a->part = dalcs_arena_alloc(&a->arena, (size_t)a->log.n_parts, sizeof *a->part);
    a->row = dalcs_arena_alloc(&a->arena, 2 * n_outputs, sizeof(double));
    a->shown = dalcs_arena_alloc(&a->arena, 2 * n_outputs + 2, sizeof(double));
    if (a->part == NULL || a->row == NULL || a->shown == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < a->log.n_parts; k++) {
        a->n_parts = k + 1;
        DALCS_TRY(part_setup(a, &a->part[k], k, a->loop.device, fastest));
    }
    return a->loop.is_loaded ? part_setup(a, &a->by_current, a->loop.system, a->loop.probe, fastest)
                             : DALCS_OK;
}

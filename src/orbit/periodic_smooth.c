/* periodic_smooth.c - slopes of smooth sources along an orbit, and the small dense system of a piece. */
#include "periodic_smooth.h"

#include <string.h>

/* Of an answer at all nodes. */
static size_t answer_size(const struct dalcs_periodic_flow *flow) {
    const struct dalcs_stage_layout *l = &flow->stages.layout;
    return (size_t)l->n_nodes * (size_t)l->stride;
}

enum dalcs_status dalcs_flow_smooth_setup(struct dalcs_periodic_flow *flow, int first) {
    const size_t size = answer_size(flow);
    struct dalcs_flow_smooth *p = dalcs_arena_alloc(&flow->arena, 1, sizeof *p);
    if (p == NULL) {
        return DALCS_E_NOMEM;
    }
    flow->smooth = p;
    p->first = first;
    DALCS_TRY(dalcs_smooth_newton_setup(&p->newton, flow->system, flow->stages.layout.n_nodes,
                                        &flow->arena));
    p->unit = dalcs_arena_alloc(&flow->arena, (size_t)p->newton.n * size, sizeof(double));
    p->dx = dalcs_arena_alloc(&flow->arena, (size_t)p->newton.n, sizeof *p->dx);
    return p->unit != NULL && p->dx != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* What the sources read on the orbit, at the nodes of the piece. */
static void find_arguments(struct dalcs_periodic_flow *flow, const struct dalcs_orbit_span *span,
                           double t, double h) {
    struct dalcs_smooth_newton *n = &flow->smooth->newton;
    const struct dalcs_stages *run = &flow->orbit->rates.part->stages;
    const int n_smooth = flow->system->n_smooth;
    double weight[DALCS_MAX_NODES];
    for (int node = 0; node < n->n_points; node++) {
        const double at = t + h * flow->stages.method->node[node];
        dalcs_collocation_weights(run->method, (at - span->from) / span->h, weight);
        for (int k = 0; k < n_smooth; k++) {
            double *x = n->x[node * n_smooth + k];
            x[0] = x[1] = 0.0;
            for (int i = 0; i < run->layout.n_nodes; i++) {
                x[0] += weight[i] * span->argument[i * n_smooth + k][0];
                x[1] += weight[i] * span->argument[i * n_smooth + k][1];
            }
        }
    }
}

/* p->unit, by the answers to Legendre polynomials. */
static enum dalcs_status find_units(struct dalcs_periodic_flow *flow,
                                    struct dalcs_stage_entry *entry) {
    const struct dalcs_flow_smooth *p = flow->smooth;
    const size_t size = answer_size(flow);
    const int n_smooth = flow->system->n_smooth;
    const int n_nodes = p->newton.n_points;
    memset(p->unit, 0, (size_t)p->newton.n * size * sizeof(double));
    for (int f = 0; f < n_smooth * n_nodes; f++) {
        memset(flow->work.in, 0, (size_t)flow->stages.n_in * sizeof(double));
        flow->work.in[flow->n_x + 1 + p->first + f] = 1.0;
        DALCS_TRY(dalcs_stages_apply(&flow->stages, entry, flow->work.in, flow->work.out));
        for (int node = 0; node < n_nodes; node++) {
            const double part = flow->legendre[f % n_nodes][node];
            double *unit = p->unit + (size_t)(node * n_smooth + f / n_nodes) * size;
            for (size_t i = 0; i < size; i++) {
                unit[i] += part * flow->work.out[i];
            }
        }
    }
    return DALCS_OK;
}

/* Columns that the sources read at all nodes of an answer. */
static void read(const struct dalcs_periodic_flow *flow, const double *out) {
    const struct dalcs_flow_smooth *p = flow->smooth;
    const int n_smooth = flow->system->n_smooth;
    for (int q = 0; q < p->newton.n; q++) {
        const struct dalcs_smooth_input *of = &flow->system->smooth[q % n_smooth];
        const double *y = out + q / n_smooth * flow->stages.layout.stride;
        for (int j = 0; j < 2; j++) {
            p->dx[q][j] = j < of->n && of->column[j] >= 0 ? y[of->column[j]] : 0.0;
        }
    }
}

enum dalcs_status dalcs_flow_smooth_begin(struct dalcs_periodic_flow *flow,
                                          struct dalcs_stage_entry *entry,
                                          const struct dalcs_orbit_span *span, double t, double h) {
    struct dalcs_flow_smooth *p = flow->smooth;
    struct dalcs_smooth_newton *n = &p->newton;
    const size_t size = answer_size(flow);
    find_arguments(flow, span, t, h);
    DALCS_TRY(find_units(flow, entry));
    for (int q = 0; q < n->n; q++) {
        read(flow, p->unit + (size_t)q * size);
        for (int k = 0; k < 2 * n->n; k++) {
            n->slope[(size_t)k * (size_t)n->n + (size_t)q] = p->dx[k / 2][k % 2];
        }
    }
    return dalcs_smooth_newton_factor(n) ? DALCS_OK : DALCS_SINGULAR;
}

void dalcs_flow_smooth_vary(struct dalcs_periodic_flow *flow, double *out) {
    const struct dalcs_flow_smooth *p = flow->smooth;
    const size_t size = answer_size(flow);
    double *change = p->newton.work.step;
    read(flow, out);
    dalcs_smooth_newton_vary(&p->newton, p->dx, change);
    for (int q = 0; q < p->newton.n; q++) {
        const double *unit = p->unit + (size_t)q * size;
        for (size_t i = 0; i < size; i++) {
            out[i] += change[q] * unit[i];
        }
    }
}

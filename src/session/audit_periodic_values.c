/* audit_periodic_values.c - voltages and currents of an orbit, and of small signals around it, from the columns of a part. */
#include "audit_periodic.h"

#include "orbit_rates.h"
#include "pi.h"
#include "radau.h"

#include <math.h>

/* ---- Room ---------------------------------------------------------------------------------------- */

static bool make_values(struct dalcs_audit_periodic *a, struct dalcs_response_values *v) {
    const size_t n_nodes = (size_t)a->readout->n_nodes, n_devices = (size_t)a->readout->n_devices;
    v->v = dalcs_arena_alloc(&a->arena, n_nodes, sizeof *v->v);
    v->v_rate = dalcs_arena_alloc(&a->arena, n_nodes, sizeof *v->v_rate);
    v->i = dalcs_arena_alloc(&a->arena, n_devices, sizeof *v->i);
    v->i_rate = dalcs_arena_alloc(&a->arena, n_devices, sizeof *v->i_rate);
    v->size = dalcs_arena_alloc(&a->arena, n_devices, sizeof *v->size);
    v->u = dalcs_arena_alloc(&a->arena, n_devices, sizeof *v->u);
    v->u_rate = dalcs_arena_alloc(&a->arena, n_devices, sizeof *v->u_rate);
    return v->u != NULL && v->u_rate != NULL && v->v != NULL && v->v_rate != NULL && v->i != NULL &&
           v->i_rate != NULL && v->size != NULL;
}

static bool make_side(struct dalcs_audit_periodic *a, struct dalcs_periodic_side *side,
                      size_t n_columns) {
    side->y = dalcs_arena_alloc(&a->arena, n_columns, sizeof *side->y);
    return side->y != NULL && make_values(a, &side->is) && make_values(a, &side->at);
}

enum dalcs_status dalcs_periodic_values_make(struct dalcs_audit_periodic *a) {
    const size_t n_devices = (size_t)a->readout->n_devices;
    size_t n_columns = 1;
    size_t n_rows = 1;
    for (int k = 0; k < a->log->n_parts; k++) {
        const struct dalcs_system *s = a->log->part[k].rates.part->component->system;
        const size_t n = (size_t)dalcs_system_n_columns(s);
        const size_t stride = (size_t)a->log->part[k].rates.part->stages.layout.stride;
        n_columns = n > n_columns ? n : n_columns;
        n_rows = stride > n_rows ? stride : n_rows;
    }
    a->work.n_columns = n_columns;
    a->of.are_there = dalcs_arena_alloc(&a->arena, n_devices, sizeof *a->of.are_there);
    a->of.are_restless = dalcs_arena_alloc(&a->arena, n_devices, sizeof *a->of.are_restless);
    a->of.change = dalcs_arena_alloc(&a->arena, n_devices, sizeof *a->of.change);
    a->of.state = dalcs_arena_alloc(&a->arena, n_devices, sizeof *a->of.state);
    a->of.fed = dalcs_arena_alloc(&a->arena, n_devices, sizeof *a->of.fed);
    a->term = dalcs_arena_alloc(&a->arena, DALCS_STIMULUS_MOST_TERMS, sizeof *a->term);
    a->work.rate = dalcs_arena_alloc(&a->arena, n_columns, sizeof *a->work.rate);
    a->work.weight = dalcs_arena_alloc(&a->arena, n_columns, sizeof *a->work.weight);
    a->work.column = dalcs_arena_alloc(&a->arena, n_columns, sizeof *a->work.column);
    a->work.kept = dalcs_arena_alloc(&a->arena, n_rows, sizeof *a->work.kept);
    a->work.is_known =
        dalcs_arena_alloc(&a->arena, (size_t)a->readout->n_nodes, sizeof *a->work.is_known);
    return a->of.are_there != NULL && a->of.are_restless != NULL && a->of.change != NULL &&
                   a->of.fed != NULL && a->of.state != NULL && a->term != NULL &&
                   a->work.rate != NULL && a->work.weight != NULL && a->work.column != NULL &&
                   a->work.kept != NULL && a->work.is_known != NULL &&
                   make_side(a, &a->first, n_columns) && make_side(a, &a->end, n_columns) &&
                   make_side(a, &a->start, n_columns)
               ? DALCS_OK
               : DALCS_E_NOMEM;
}

/* ---- Values -------------------------------------------------------------------------------------- */

/* Voltages that sources alone decide, outside of the part: of[0] is a source's, of[1] its derivative. */
static void feed(const struct dalcs_audit_periodic *a, struct dalcs_response_values *v, int device,
                 const double complex *of) {
    const struct dalcs_device *d = &a->run->s->circuit.device[device];
    const int known = isnan(creal(v->v[d->node[0]])) ? 1 : 0;
    const double sign = known == 1 ? 1.0 : -1.0;
    double complex u[2] = {of[0], of[1]};
    if (d->kind == DALCS_VCVS) {
        u[0] = d->value * (v->v[d->node[2]] - v->v[d->node[3]]);
        u[1] = d->value * (v->v_rate[d->node[2]] - v->v_rate[d->node[3]]);
    }
    v->v[d->node[1 - known]] = v->v[d->node[known]] + sign * u[0];
    v->v_rate[d->node[1 - known]] = v->v_rate[d->node[known]] + sign * u[1];
}

/* From a->column and a->rate. */
static void take(const struct dalcs_audit_periodic *a, struct dalcs_response_values *v) {
    const struct dalcs_readout *r = a->readout;
    for (int n = 0; n < r->n_nodes; n++) {
        const bool is_here = n > 0 && a->rows.node_system[n] == a->look.part;
        const int column = is_here ? r->node_column[n] : -1;
        v->v[n] = column >= 0 ? a->work.column[column] : n == 0 || is_here ? 0.0 : NAN;
        v->v_rate[n] = column >= 0 ? a->work.rate[column] : 0.0;
    }
    for (int d = 0; d < r->n_devices; d++) {
        const bool is_read = a->of.are_there[d] && r->start[d + 1] > r->start[d];
        const int state = a->of.are_there[d] ? a->of.state[d] : -1;
        v->u[d] = state >= 0 ? a->work.column[state] : 0.0;
        v->u_rate[d] = state >= 0 ? a->work.rate[state] : 0.0;
        v->i[d] = v->i_rate[d] = 0.0;
        v->size[d] = is_read ? 0.0 : -1.0;
        for (int k = r->start[d]; k < r->start[d + 1] && is_read; k++) {
            const double complex term = r->term[k].coefficient * a->work.column[r->term[k].column];
            v->i[d] += term;
            v->i_rate[d] += r->term[k].coefficient * a->work.rate[r->term[k].column];
            v->size[d] += cabs(term);
        }
    }
}

/* Resistors, whose currents no equation has and formulas may read. */
static void complete(const struct dalcs_audit_periodic *a, struct dalcs_response_values *v) {
    const struct dalcs_circuit *c = &a->run->s->circuit;
    for (int d = 0; d < c->n_devices; d++) {
        const struct dalcs_device *device = &c->device[d];
        if (a->of.are_there[d] && v->size[d] < 0.0 && device->kind == DALCS_RESISTOR &&
            device->value != 0.0) {
            v->i[d] = (v->v[device->node[0]] - v->v[device->node[1]]) / device->value;
            v->size[d] = cabs(v->i[d]);
        }
    }
}

/* Those that sources alone decide follow from these. */
static void read_bystander(struct dalcs_audit_periodic *a, const struct dalcs_radau_part *part,
                           int k, double t, enum dalcs_side side) {
    const struct dalcs_bystanders *b = &part->excitation.bystanders;
    const struct dalcs_system *s = part->component->system;
    const double *gain = b->gain + (size_t)k * (size_t)s->n_inputs;
    double rate = 0.0;
    for (int i = 1; i < s->n_inputs; i++) {
        const struct dalcs_stimulus *of = &a->run->s->circuit.stimulus[s->stimulus[i]];
        rate += gain[i] == 0.0       ? 0.0
                : side == DALCS_LEFT ? gain[i] * dalcs_slope_before(of, t, a->term)
                                     : gain[i] * dalcs_slope_behind(of, t, a->term);
    }
    a->work.column[b->column[k]] = dalcs_radau_bystander(part, k, t, side);
    a->work.rate[b->column[k]] = rate;
}

/* Outputs of gates are over with the run. In a segment they are straight. */
static void read_bystanders(struct dalcs_audit_periodic *a, const struct dalcs_radau_part *part,
                            const struct dalcs_orbit_segment *of, double t, enum dalcs_side side) {
    const struct dalcs_bystanders *b = &part->excitation.bystanders;
    for (int k = 0; k < b->n; k++) {
        if (a->log->gates == NULL) {
            read_bystander(a, part, k, t, side);
            continue;
        }
        const double slope = (of->bystanders[1][k] - of->bystanders[0][k]) / (of->to - of->from);
        a->work.column[b->column[k]] = of->bystanders[0][k] + (t - of->from) * slope;
        a->work.rate[b->column[k]] = slope;
    }
}

/* The columns of a segment at a time. */
static void read_segment(struct dalcs_audit_periodic *a, const struct dalcs_radau_part *part,
                         const struct dalcs_orbit_segment *segment, double t) {
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const struct dalcs_system *s = part->component->system;
    const int n_equations = dalcs_system_n_equations(s);
    double weight[DALCS_MAX_NODES];
    double slope[DALCS_MAX_NODES];
    dalcs_orbit_record_weights(part->stages.method, (t - segment->from) / segment->h, weight,
                               slope);
    for (int c = 0; c < dalcs_system_n_columns(s); c++) {
        const bool is_open = c >= n_equations && !dalcs_mode_has(segment->mode, c - n_equations);
        a->work.column[c] = a->work.rate[c] = 0.0;
        for (int node = 0; node < l->n_nodes && !is_open; node++) {
            const double value = segment->out[node * l->stride + c];
            a->work.column[c] += weight[node] * value;
            a->work.rate[c] += slope[node] / segment->h * value;
        }
    }
}

/* Markov's inequality, for the derivative of a polynomial of degree s on a step. */
static double steepness_of(const struct dalcs_collocation *method, double h) {
    return 2.0 * method->s * method->s / h;
}

void dalcs_periodic_values_orbit(struct dalcs_audit_periodic *a, double t, enum dalcs_side side,
                                 struct dalcs_periodic_side *to) {
    const struct dalcs_orbit_part *p = &a->log->part[a->look.part];
    const struct dalcs_radau_part *part = p->rates.part;
    const struct dalcs_circuit *c = &a->run->s->circuit;
    const double until = p->record.n > 0 ? p->record.segment[p->record.n - 1].to : t;
    const int k = dalcs_orbit_record_find(&p->record, fmin(t, until), side);
    to->segment = k >= 0 ? &p->record.segment[k] : NULL;
    if (to->segment == NULL) {
        return;
    }
    read_segment(a, part, to->segment, t);
    read_bystanders(a, part, to->segment, t, side);
    for (int m = 0; m < dalcs_system_n_columns(part->component->system); m++) {
        to->y[m] = creal(a->work.column[m]);
    }
    take(a, &to->at);
    complete(a, &to->at);
    to->at.steepness = steepness_of(part->stages.method, to->segment->h);
    for (int m = 0; m < a->of.n_fed; m++) {
        const struct dalcs_device *d = &c->device[a->of.fed[m]];
        double complex of[2] = {0.0, 0.0};
        if (d->kind == DALCS_VSOURCE) {
            const struct dalcs_stimulus *s = &c->stimulus[d->stimulus];
            of[0] = dalcs_stimulus_value(s, t, side);
            of[1] = side == DALCS_LEFT ? dalcs_slope_before(s, t, a->term)
                                       : dalcs_slope_behind(s, t, a->term);
        }
        feed(a, &to->at, a->of.fed[m], of);
    }
}

bool dalcs_periodic_values_is_open(const struct dalcs_periodic_flow *flow,
                                   const struct dalcs_flow_map *map, int column) {
    const int pair = column - dalcs_system_n_equations(flow->system);
    return pair >= 0 && !dalcs_mode_has(map->mode, pair);
}

/* value[kept.n] += factor * the sum over the nodes of weight * rows of an answer. */
static void add_rows(const struct dalcs_periodic_flow *flow, const double *weight,
                     const double *rows, double complex factor, double complex *value) {
    const int n = flow->kept.n;
    for (int i = 0; i < flow->stages.layout.n_nodes; i++) {
        const double complex by = weight[i] * factor;
        for (int m = 0; m < n && by != 0.0; m++) {
            value[m] += by * rows[(size_t)i * (size_t)n + (size_t)m];
        }
    }
}

/* What starts from the states of a piece, and what sources add, as a sum over its nodes, into the columns. */
static void find_columns(const struct dalcs_audit_periodic *a,
                         const struct dalcs_piece_passed *passed, const double *weight,
                         double complex back, double complex *column) {
    const struct dalcs_periodic_flow *flow = a->look.response->flow;
    const struct dalcs_flow_map *map = passed->piece->map;
    const size_t size = dalcs_periodic_flow_size(flow);
    const int n = flow->kept.n;
    for (int m = 0; m < n; m++) {
        a->work.kept[m] = 0.0;
    }
    for (int i = 0; i < flow->stages.layout.n_nodes; i++) {
        const double complex by = weight[i] * back * passed->phase;
        for (int m = 0; m < n && by != 0.0; m++) {
            a->work.kept[m] += by * map->driven[(size_t)i * (size_t)n + (size_t)m];
        }
    }
    for (int k = 0; k < flow->n_columns; k++) {
        add_rows(flow, weight, map->state + (size_t)k * size, back * passed->start[k],
                 a->work.kept);
    }
    for (int c = 0; c < dalcs_system_n_columns(flow->system); c++) {
        const bool is_open = dalcs_periodic_values_is_open(flow, map, c);
        column[c] = is_open ? 0.0 : a->work.kept[flow->kept.place[c]];
    }
}

void dalcs_periodic_values_small(struct dalcs_audit_periodic *a,
                                 const struct dalcs_piece_passed *passed, int node, bool has_rates,
                                 struct dalcs_response_values *is) {
    const struct dalcs_periodic_flow *flow = a->look.response->flow;
    const struct dalcs_collocation *method = flow->stages.method;
    const struct dalcs_circuit *c = &a->run->s->circuit;
    const double h = passed->piece->map->h;
    const double t = passed->piece->t + method->node[node] * h;
    const double complex back = cexp(-I * fmod(a->look.w * t, dalcs_two_pi));
    double weight[DALCS_MAX_NODES] = {0.0};
    double slope[DALCS_MAX_NODES] = {0.0};
    if (has_rates) {
        dalcs_orbit_record_weights(method, method->node[node], weight, slope);
    }
    for (int i = 0; i <= method->s; i++) {
        weight[i] = i == node ? 1.0 : 0.0;
        slope[i] /= h;
    }
    find_columns(a, passed, weight, back, a->work.column);
    if (has_rates) {
        find_columns(a, passed, slope, back, a->work.rate);
    }
    take(a, is);
    is->steepness = steepness_of(method, h);
    for (int m = 0; m < a->of.n_fed; m++) {
        const struct dalcs_device *d = &c->device[a->of.fed[m]];
        const double complex s = d->kind == DALCS_VSOURCE ? a->source[d->stimulus] : 0.0;
        feed(a, is, a->of.fed[m], (double complex[2]){s, I * a->look.w * s});
    }
}

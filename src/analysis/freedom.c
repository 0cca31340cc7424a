/* freedom.c - what each element leaves open.
 *
 * What dissipates has one voltage and one current, so do states and their derivatives in a transient.
 * At an operating point capacitors are open and inductors shorts. */
#include "freedom.h"

#include <math.h>
#include <string.h>

/* Intervals narrower than this part of the largest voltage or current are rounding. */
static const double narrow = 1e-9;

/* Bounds below this part of it are 0. */
static const double rounding = 1e-13;

enum side { BLOCKS, CONDUCTS, TIED };

static enum side side_of(const struct dalcs_view *view, int pair) {
    if (view->at->tied[pair]) {
        return TIED;
    }
    return dalcs_mode_has(view->at->mode, pair) ? CONDUCTS : BLOCKS;
}

/* A branch of a diode; `resistance` in series with it. */
static void add_pair(struct dalcs_view *view, int device, int pair, double resistance,
                     bool has_leak) {
    const struct dalcs_device *d = &view->u->circuit->device[device];
    bool reversed = view->system->pair[pair].is_breakdown;
    enum side side = side_of(view, pair);
    double lambda = view->y[dalcs_system_n_equations(view->system) + pair];
    struct dalcs_freedom *f = &view->freedom[view->n++];
    *f = (struct dalcs_freedom){.name = d->name,
                                .device = device,
                                .node = {d->node[reversed ? 1 : 0], d->node[reversed ? 0 : 1]},
                                .is_diode = true};
    if (side != CONDUCTS && !has_leak) {
        f->voltage = DALCS_VOLTAGE_BELOW;
        f->is_tied = side == TIED;
        f->slack = f->is_tied ? 0.0 : fmax(view->at->w[pair], 0.0);
    }
    if (side != BLOCKS && resistance == 0.0) {
        f->may_carry = true;
        f->back = side == TIED ? 0.0 : fmax(lambda, 0.0);
        /* A current that has not begun is rounding of either sign; what it shares is seen later. */
        view->has_narrow = view->has_narrow || (side == CONDUCTS && !(lambda > 0.0));
    }
}

static void add(struct dalcs_view *view, int device, enum dalcs_voltage_freedom voltage,
                bool may_carry) {
    const struct dalcs_device *d = &view->u->circuit->device[device];
    view->freedom[view->n++] = (struct dalcs_freedom){.name = d->name,
                                                      .device = device,
                                                      .node = {d->node[0], d->node[1]},
                                                      .voltage = voltage,
                                                      .may_carry = may_carry,
                                                      .back = INFINITY};
}

static const struct dalcs_probe *coil_probe(const struct dalcs_view *view, const char *name) {
    for (int k = 0; k < view->network->n_states; k++) {
        if (view->network->state[k].element == name) {
            return &view->network->state[k].probe;
        }
    }
    return NULL;
}

/* A coil carries a state, and with perfect coupling what its partners allow as well. */
static bool carries_more(const struct dalcs_view *view, const char *name) {
    const struct dalcs_probe *probe = coil_probe(view, name);
    bool more = false;
    for (int k = 0; probe != NULL && k < probe->n_terms; k++) {
        more = more || probe->term[k].index >= view->system->n_x;
    }
    return more;
}

static void add_device(struct dalcs_view *view, int device) {
    const struct dalcs_circuit *c = view->u->circuit;
    const struct dalcs_device *d = &c->device[device];
    bool resting = view->at->at_operating_point;
    int pair = view->u->first_pair[device];
    switch (d->kind) {
    case DALCS_RESISTOR:
        add(view, device, DALCS_VOLTAGE_FIXED, d->value == 0.0);
        break;
    case DALCS_VSOURCE:
    case DALCS_VCVS: /* controlled ones do not act on what they read: for what that is now they are sources */
    case DALCS_CCVS:
        add(view, device, DALCS_VOLTAGE_FIXED, true);
        break;
    case DALCS_CAPACITOR:
        add(view, device, resting ? DALCS_VOLTAGE_ANY : DALCS_VOLTAGE_FIXED, false);
        break;
    case DALCS_INDUCTOR: {
        bool is_coil = !resting && c->n_couplings > 0 && carries_more(view, d->name);
        add(view, device, DALCS_VOLTAGE_FIXED, resting || is_coil);
        view->freedom[view->n - 1].is_coil = is_coil;
        break;
    }
    case DALCS_DIODE: {
        const struct dalcs_diode_model *m = &c->models.of_diode[d->model];
        add_pair(view, device, pair, m->ron, isfinite(m->roff));
        if (isfinite(m->vrev)) {
            add_pair(view, device, pair + 1, m->rrev, isfinite(m->roff));
        }
        break;
    }
    case DALCS_SWITCH: {
        const struct dalcs_switch_model *m = &c->models.of_switch[d->model];
        bool closed = side_of(view, pair) == CONDUCTS;
        bool holds = closed || isfinite(m->roff);
        add(view, device, holds ? DALCS_VOLTAGE_FIXED : DALCS_VOLTAGE_ANY, closed && m->ron == 0.0);
        break;
    }
    default: /* current sources */
        add(view, device, DALCS_VOLTAGE_ANY, false);
        view->freedom[view->n - 1].is_source = true;
        break;
    }
}

static void number_node(struct dalcs_view *view, int node) {
    if (view->u->vertex_of[node] < 0) {
        view->u->vertex_of[node] = view->n_vertices;
        view->node[view->n_vertices++] = node;
    }
}

/* Shorts without a current of their own belong to where their nodes are. */
static void add_shorts(struct dalcs_view *view, int component) {
    const struct dalcs_topology *t = &view->u->topology;
    for (int k = 0; k < view->u->n_shorts; k++) {
        const struct dalcs_device *d = &view->u->circuit->device[view->u->shorts[k]];
        int root = t->node_of[d->node[0]];
        if (root == 0 || t->node_component[root] == component) {
            add(view, view->u->shorts[k], DALCS_VOLTAGE_FIXED, true);
        }
    }
}

/* The voltages that .ic holds, as sources do. */
static void add_clamps(struct dalcs_view *view, int component) {
    const struct dalcs_topology *t = &view->u->topology;
    const struct dalcs_circuit *c = view->u->circuit;
    for (int k = 0; k < c->n_initial_conditions; k++) {
        const int *node = c->initial_condition[k].node;
        int root[2] = {t->node_of[node[0]], t->node_of[node[1]]};
        int of = t->node_component[root[root[0] != 0 ? 0 : 1]];
        if (root[0] == root[1] || of != component) {
            continue;
        }
        int second = node[1] != 0 ? node[1] : t->reference_of[root[0]];
        view->freedom[view->n++] = (struct dalcs_freedom){.name = ".ic",
                                                          .device = -1,
                                                          .node = {node[0], second},
                                                          .voltage = DALCS_VOLTAGE_FIXED,
                                                          .may_carry = true,
                                                          .back = INFINITY};
    }
}

enum dalcs_status dalcs_view_setup(struct dalcs_view *view, struct dalcs_undetermined *u,
                                   const struct dalcs_open_instant *at, struct dalcs_arena *work) {
    const struct dalcs_network *network = at->engine->network;
    const struct dalcs_system *s = &network->system[at->system];
    *view = (struct dalcs_view){.u = u,
                                .at = at,
                                .network = network,
                                .system = s,
                                .y = at->engine->component[at->system].y,
                                .work = work};
    view->largest[0] = at->scale[0];
    view->largest[1] = at->scale[1];
    for (int c = 0; c < dalcs_system_n_columns(s); c++) {
        double *largest = &view->largest[s->column_is_current[c] ? 1 : 0];
        *largest = fmax(*largest, fabs(view->y[c]));
    }
    int first = u->device_start[at->system];
    int n_devices = u->device_start[at->system + 1] - first;
    size_t most = (size_t)(2 * n_devices + u->n_shorts + u->circuit->n_initial_conditions);
    view->freedom = dalcs_arena_alloc(work, most, sizeof(*view->freedom));
    view->node = dalcs_arena_alloc(work, 2 * most + 1, sizeof(*view->node));
    if (view->freedom == NULL || view->node == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < n_devices; k++) {
        add_device(view, u->device[first + k]);
    }
    add_shorts(view, at->system);
    if (network == u->clamped) {
        add_clamps(view, at->system);
    }
    number_node(view, 0);
    for (int i = 0; i < view->n; i++) {
        number_node(view, view->freedom[i].node[0]);
        number_node(view, view->freedom[i].node[1]);
    }
    view->link = dalcs_arena_alloc(work, (size_t)view->n_vertices, sizeof(*view->link));
    view->degree = dalcs_arena_alloc(work, (size_t)view->n_vertices, sizeof(*view->degree));
    return view->link != NULL && view->degree != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

void dalcs_view_finish(struct dalcs_view *view) {
    for (int k = 0; k < view->n_vertices; k++) {
        view->u->vertex_of[view->node[k]] = -1;
    }
    for (int i = 0; i < view->n; i++) {
        if (view->freedom[i].device >= 0) {
            view->u->branch_of[2 * view->freedom[i].device] = -1;
            view->u->branch_of[2 * view->freedom[i].device + 1] = -1;
        }
    }
}

int dalcs_view_current_of(const struct dalcs_view *view, int output) {
    const struct dalcs_output *out = &view->network->output[output];
    bool is_here = out->is_current && out->plus.system == view->at->system;
    return is_here && !view->u->told[output].is_told
               ? view->u->circuit->results.signal[output].device
               : -1;
}

static double probe_value(const struct dalcs_view *view, const struct dalcs_probe *probe) {
    if (probe->system < 0) {
        return 0.0;
    }
    const struct dalcs_component *c = &view->at->engine->component[probe->system];
    return dalcs_probe_value(probe, c->y, c->u + c->system->n_x);
}

double dalcs_view_value(const struct dalcs_view *view, int output) {
    const struct dalcs_output *out = &view->network->output[output];
    return probe_value(view, &out->plus) - probe_value(view, &out->minus);
}

void dalcs_view_place(const struct dalcs_freedom *f, struct dalcs_finding *finding) {
    if (finding->device < 0 || (f->is_diode && !finding->has_diodes)) {
        finding->device = f->device;
    }
    finding->has_diodes = finding->has_diodes || f->is_diode;
}

void dalcs_view_bound(const struct dalcs_view *view, bool is_current, double fall, double rise,
                      struct dalcs_open_signal *signal) {
    double nothing = rounding * view->largest[is_current ? 1 : 0];
    signal->lower = signal->value - fall;
    signal->upper = signal->value + rise;
    signal->lower = fabs(signal->lower) <= nothing ? 0.0 : signal->lower;
    signal->upper = fabs(signal->upper) <= nothing ? 0.0 : signal->upper;
}

bool dalcs_view_is_open(struct dalcs_view *view, bool is_current, double lower, double upper) {
    bool open = upper - lower > narrow * view->largest[is_current ? 1 : 0];
    view->has_narrow = view->has_narrow || !open;
    return open;
}

enum dalcs_status dalcs_view_sort_signals(struct dalcs_view *view, int n_parts, const int *part,
                                          int **start, struct dalcs_open_signal **signal) {
    int n = 0;
    *start = dalcs_arena_alloc(view->work, (size_t)n_parts + 2, sizeof(**start));
    if (*start == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < view->network->n_outputs; i++) {
        if (part[i] >= 0) {
            (*start)[part[i] + 2]++;
            n++;
        }
    }
    for (int k = 0; k < n_parts; k++) {
        (*start)[k + 2] += (*start)[k + 1];
    }
    *signal = dalcs_arena_alloc(view->work, (size_t)n, sizeof(**signal));
    if (*signal == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < view->network->n_outputs; i++) {
        if (part[i] >= 0) {
            (*signal)[(*start)[part[i] + 1]++] =
                (struct dalcs_open_signal){.output = i, .value = dalcs_view_value(view, i)};
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_view_tell(struct dalcs_view *view, struct dalcs_finding *finding) {
    if (finding->n_signals == 0) {
        return DALCS_OK;
    }
    if (finding->because == NULL) {
        return DALCS_E_NOMEM;
    }
    view->has_told = true;
    finding->time = view->at->time;
    finding->at_operating_point = view->at->at_operating_point;
    for (int k = 0; k < finding->n_signals; k++) {
        const struct dalcs_open_signal *s = &finding->signal[k];
        view->u->told[s->output] = (struct dalcs_told){.is_told = true,
                                                       .system = view->at->system,
                                                       .time = finding->time,
                                                       .fall = s->value - s->lower,
                                                       .rise = s->upper - s->value};
    }
    return view->u->on_finding(view->u->user, finding);
}

/* response.c - Kirchhoff's laws and those of the branches at one frequency. */
#include "response_internal.h"

#include "union_find.h"

/* ---- Start --------------------------------------------------------------------------------------- */

static void merge_shorts(struct dalcs_response_audit *a) {
    const struct dalcs_circuit *c = a->circuit;
    dalcs_union_reset(a->node_of, c->n_nodes);
    for (int d = 0; d < c->n_devices; d++) {
        if (dalcs_device_is_short(&c->device[d])) {
            dalcs_union_join(a->node_of, c->device[d].node[0], c->device[d].node[1]);
        }
    }
    for (int n = 0; n < c->n_nodes; n++) {
        a->node_of[n] = dalcs_union_find(a->node_of, n);
    }
}

enum dalcs_status dalcs_response_audit_start(struct dalcs_response_audit *a,
                                             const struct dalcs_circuit *circuit,
                                             const struct dalcs_response_devices *of,
                                             const struct dalcs_response_values *at,
                                             double tolerance) {
    const size_t n_nodes = (size_t)circuit->n_nodes, n_devices = (size_t)circuit->n_devices;
    size_t most = 1;
    *a = (struct dalcs_response_audit){.circuit = circuit,
                                       .of = *of,
                                       .tolerance = tolerance,
                                       .rounding = dalcs_answer_rounded,
                                       .t = NAN};
    for (int d = 0; d < circuit->n_devices; d++) {
        const struct dalcs_behaviour *b = dalcs_device_written(&circuit->device[d]);
        most = b != NULL && (size_t)b->n_pairs > most ? (size_t)b->n_pairs : most;
    }
    a->node_of = dalcs_arena_alloc(&a->arena, n_nodes, sizeof *a->node_of);
    a->work.cluster = dalcs_arena_alloc(&a->arena, n_nodes, sizeof *a->work.cluster);
    a->work.gain = dalcs_arena_alloc(&a->arena, n_devices, sizeof *a->work.gain);
    a->work.node = dalcs_arena_alloc(&a->arena, n_nodes, sizeof *a->work.node);
    a->lines = dalcs_arena_alloc(&a->arena, n_devices, sizeof *a->lines);
    a->work.lambda = dalcs_arena_alloc(&a->arena, most, sizeof *a->work.lambda);
    a->work.lambda_size = dalcs_arena_alloc(&a->arena, most, sizeof *a->work.lambda_size);
    enum dalcs_status status = DALCS_E_NOMEM;
    if (a->node_of != NULL && a->work.cluster != NULL && a->work.gain != NULL &&
        a->work.node != NULL && a->lines != NULL && a->work.lambda != NULL &&
        a->work.lambda_size != NULL) {
        merge_shorts(a);
        response_find_largest(a, at);
        status = response_find_lines(a, at);
    }
    if (status != DALCS_OK) {
        dalcs_response_audit_finish(a);
    }
    return status;
}

enum dalcs_status dalcs_response_audit_settle(struct dalcs_response_audit *a, double t,
                                              const struct dalcs_response_values *at) {
    a->t = t;
    response_find_largest(a, at);
    return response_find_lines(a, at);
}

void dalcs_response_audit_finish(struct dalcs_response_audit *a) {
    dalcs_arena_finish(&a->arena);
    *a = (struct dalcs_response_audit){0};
}

/* ---- What is found ------------------------------------------------------------------------------- */

void response_found(struct dalcs_response_audit *a, enum dalcs_response_law law, int index,
                    double defect, double allowed) {
    const struct dalcs_response_finding *w = &a->worst;
    a->n_checked++;
    if (defect > 0.0 && (w->allowed == 0.0 || defect * w->allowed > w->defect * allowed)) {
        a->worst = (struct dalcs_response_finding){law, index, defect, fmax(allowed, 0x1p-1022)};
    }
}

/* ---- Branches ------------------------------------------------------------------------------------ */

/* Of a voltage: what its nodes have. */
static double voltage_size(const struct dalcs_response_audit *a,
                           const struct dalcs_response_values *is, const int node[2]) {
    return response_size(a, is->v[node[0]]) + response_size(a, is->v[node[1]]);
}

static double complex across(const struct dalcs_response_values *is, const struct dalcs_device *d) {
    return is->v[d->node[0]] - is->v[d->node[1]];
}

/* u is y; of small differences of large numbers the rounding is allowed. */
static void check_voltage(struct dalcs_response_audit *a, const struct dalcs_response_values *is,
                          int device, struct response_sum y, double doubt) {
    const struct dalcs_device *d = &a->circuit->device[device];
    const double complex u = across(is, d);
    const double size = voltage_size(a, is, d->node) + y.size;
    response_found(a, DALCS_RESPONSE_BRANCH, device, response_magnitude(u - y.value),
                   a->tolerance * fmax(response_magnitude(u), y.scale) +
                       a->rounding * (size + a->volts) + doubt);
}

/* i is y, or what is not known is it from now on. */
static void take_current(struct dalcs_response_audit *a, struct dalcs_response_values *is,
                         int device, struct response_sum y, double doubt) {
    if (is->size[device] < 0.0) {
        is->i[device] = y.value;
        is->size[device] = y.size;
        return;
    }
    response_found(a, DALCS_RESPONSE_BRANCH, device, response_magnitude(is->i[device] - y.value),
                   a->tolerance *
                           fmax(response_magnitude(is->i[device]), response_magnitude(y.value)) +
                       a->rounding * (is->size[device] + y.size + a->amperes) + doubt);
}

static struct response_sum times(double complex factor, double complex x, double size) {
    return (struct response_sum){factor * x, response_magnitude(factor * x),
                                 response_magnitude(factor) * size};
}

static struct response_sum read_voltage(const struct dalcs_response_audit *a,
                                        const struct dalcs_response_values *is,
                                        double complex factor, const int node[2]) {
    return times(factor, is->v[node[0]] - is->v[node[1]], voltage_size(a, is, node));
}

/* The current of a capacitor: the derivative of its charge. */
static struct response_sum charging(const struct dalcs_response_audit *a,
                                    const struct dalcs_response_values *is, int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    if (is->u_rate == NULL) {
        return read_voltage(a, is, a->omega * d->value * I, d->node);
    }
    return times(d->value, is->u_rate[device], response_magnitude(is->u_rate[device]));
}

/* That of the current of a coil. */
static struct response_sum current_rate(const struct dalcs_response_audit *a,
                                        const struct dalcs_response_values *is, double factor,
                                        int device) {
    if (is->i_rate == NULL) {
        return times(a->omega * factor * I, is->i[device], is->size[device]);
    }
    return times(factor, is->i_rate[device], response_magnitude(is->i_rate[device]));
}

/* u is the derivative of sum M i. */
static void check_coil(struct dalcs_response_audit *a, const struct dalcs_response_values *is,
                       int device) {
    const struct dalcs_circuit *c = a->circuit;
    const double l = c->device[device].value;
    struct response_sum y = current_rate(a, is, l, device);
    bool is_known = is->size[device] >= 0.0;
    for (int k = 0; k < c->n_couplings && is_known; k++) {
        const struct dalcs_coupling *m = &c->coupling[k];
        const int end = m->inductor[0] == device ? 1 : m->inductor[1] == device ? 0 : -1;
        if (end >= 0) {
            const int other = m->inductor[end];
            const double mutual = m->k * sqrt(l * c->device[other].value);
            const struct response_sum part = current_rate(a, is, mutual, other);
            is_known = is->size[other] >= 0.0;
            y.value += part.value;
            y.scale += part.scale;
            y.size += part.size;
        }
    }
    if (is_known) {
        check_voltage(a, is, device, y, 0.0);
    }
}

/* One of the lines that it may be on has to hold: p u = q i. */
static void check_lines(struct dalcs_response_audit *a, const struct dalcs_response_values *is,
                        int device) {
    const struct response_lines *l = &a->lines[device];
    const struct dalcs_device *d = &a->circuit->device[device];
    const double complex u = across(is, d), i = is->i[device];
    double least = INFINITY, of[2] = {0.0, 0.0};
    bool is_known = false;
    for (int k = 0; k < l->n && is->size[device] >= 0.0; k++) {
        const double p = l->line[k].p, q = l->line[k].q;
        const double defect = response_magnitude(p * u - q * i);
        const double size = p * voltage_size(a, is, d->node) + q * is->size[device];
        const double allowed =
            a->tolerance * fmax(response_magnitude(p * u), response_magnitude(q * i)) +
            a->rounding * (size + p * a->volts + q * a->amperes);
        /* Where no node has a voltage nothing is allowed, and a line may hold without a defect all the same. */
        const double ratio = defect > 0.0 ? defect / allowed : 0.0;
        if (!is_known || ratio < least) {
            least = ratio;
            of[0] = defect;
            of[1] = allowed;
            is_known = true;
        }
    }
    if (is_known) {
        response_found(a, DALCS_RESPONSE_BRANCH, device, of[0], of[1]);
    } else {
        a->n_not_checked++;
    }
}

static void check_formula(struct dalcs_response_audit *a, struct dalcs_response_values *is,
                          int device) {
    struct response_sum y;
    double doubt;
    if (!response_formula(a, is, device, &y, &doubt)) {
        a->n_not_checked++;
    } else if (a->circuit->device[device].kind == DALCS_VCVS) {
        check_voltage(a, is, device, y, doubt);
    } else {
        take_current(a, is, device, y, doubt);
    }
}

static struct response_sum source_of(const struct dalcs_response_audit *a, int stimulus) {
    const struct dalcs_stimulus *s = &a->circuit->stimulus[stimulus];
    const double complex value =
        a->source != NULL ? a->source[stimulus] : s->ac_real + s->ac_imaginary * I;
    return (struct response_sum){value, response_magnitude(value), response_magnitude(value)};
}

static void check_resistor(struct dalcs_response_audit *a, struct dalcs_response_values *is,
                           int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    if (dalcs_device_is_short(d)) {
        check_voltage(a, is, device, (struct response_sum){0}, 0.0);
    } else if (is->size[device] >= 0.0) {
        check_voltage(a, is, device, times(d->value, is->i[device], is->size[device]), 0.0);
    } else {
        /* each end has the rounding of coils */
        struct response_sum y = read_voltage(a, is, 1.0 / d->value, d->node);
        y.size += a->small.of_flux / dalcs_answer_rounded / fabs(d->value);
        take_current(a, is, device, y, 0.0);
    }
}

static void check_branch(struct dalcs_response_audit *a, struct dalcs_response_values *is,
                         int device) {
    const struct dalcs_device *d = &a->circuit->device[device];
    if (d->behaviour != NULL) {
        check_formula(a, is, device);
        return;
    }
    switch (d->kind) {
    case DALCS_RESISTOR:
        check_resistor(a, is, device);
        break;
    case DALCS_INDUCTOR:
        check_coil(a, is, device);
        break;
    case DALCS_CAPACITOR:
        take_current(a, is, device, charging(a, is, device), 0.0);
        if (is->u != NULL) {
            check_voltage(a, is, device,
                          times(1.0, is->u[device], response_magnitude(is->u[device])), 0.0);
        }
        break;
    case DALCS_VSOURCE:
        check_voltage(a, is, device, source_of(a, d->stimulus), 0.0);
        break;
    case DALCS_ISOURCE:
        take_current(a, is, device, source_of(a, d->stimulus), 0.0);
        break;
    case DALCS_VCVS:
        check_voltage(a, is, device, read_voltage(a, is, d->value, d->node + 2), 0.0);
        break;
    case DALCS_VCCS:
        take_current(a, is, device, read_voltage(a, is, d->value, d->node + 2), 0.0);
        break;
    case DALCS_CCVS:
        check_voltage(a, is, device, times(d->value, is->i[d->control], is->size[d->control]), 0.0);
        break;
    case DALCS_CCCS:
        take_current(a, is, device, times(d->value, is->i[d->control], is->size[d->control]), 0.0);
        break;
    default:
        check_lines(a, is, device);
        break;
    }
}

/* ---- Kirchhoff's current law --------------------------------------------------------------------- */

static void add_to_node(struct dalcs_response_audit *a, const struct dalcs_response_values *is,
                        int device, int end) {
    struct response_node *n = &a->work.node[a->node_of[a->circuit->device[device].node[end]]];
    const double complex i = is->i[device];
    n->is_open = n->is_open || !a->of.are_there[device] || is->size[device] < 0.0;
    n->sum += end == 0 ? i : -i;
    n->scale += response_magnitude(i);
    n->size += fmax(is->size[device], 0.0);
}

static void check_nodes(struct dalcs_response_audit *a, const struct dalcs_response_values *is) {
    const struct dalcs_circuit *c = a->circuit;
    for (int n = 0; n < c->n_nodes; n++) {
        a->work.node[n] = (struct response_node){0};
    }
    for (int d = 0; d < c->n_devices; d++) {
        if (a->node_of[c->device[d].node[0]] != a->node_of[c->device[d].node[1]]) {
            add_to_node(a, is, d, 0);
            add_to_node(a, is, d, 1);
        }
    }
    for (int n = 1; n < c->n_nodes; n++) {
        const struct response_node *s = &a->work.node[n];
        if (a->node_of[n] == n && a->node_of[0] != n && !s->is_open) {
            response_found(a, DALCS_RESPONSE_NODE, n, response_magnitude(s->sum),
                           a->tolerance * s->scale + a->rounding * (s->size + a->amperes));
        }
    }
}

void dalcs_response_audit_look(struct dalcs_response_audit *a, double omega,
                               struct dalcs_response_values *is) {
    a->omega = omega;
    if (is->v_rate != NULL) {
        response_find_small(a, is);
    } else {
        response_find_largest(a, is);
    }
    for (int d = 0; d < a->circuit->n_devices; d++) {
        if (a->of.are_there[d]) {
            check_branch(a, is, d);
        }
    }
    check_nodes(a, is);
}

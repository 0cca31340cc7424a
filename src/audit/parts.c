/* parts.c - who belongs to a part, and room for what is read of it. */
#include "watch.h"

#include "union_find.h"

/* ---- Parts --------------------------------------------------------------------------------------- */

bool audit_remembers(const struct dalcs_circuit *c, int device) {
    const struct dalcs_device *d = &c->device[device];
    return d->kind == DALCS_SWITCH && c->switch_model[d->model].vh != 0.0;
}

static void count_members(struct dalcs_audit *audit, int *owner) {
    const struct dalcs_circuit *c = audit->circuit;
    audit->net.is_read[0] = true;
    for (int i = 0; i < c->n_devices; i++) {
        const int k = audit->options.device_part[i];
        for (int e = 0; e < 2 && k >= 0; e++) {
            audit->net.is_read[c->device[i].node[e]] = true;
        }
        if (k < 0 || audit->net.is_merged[i]) {
            continue;
        }
        audit->part[k].n_devices++;
        audit->part[k].n_latches += audit_remembers(c, i) ? 1 : 0;
        for (int e = 0; e < 2; e++) {
            const int node = audit->net.node_of[c->device[i].node[e]];
            if (node != 0 && owner[node] < 0) {
                owner[node] = k;
                audit->part[k].n_nodes++;
            }
        }
    }
    for (int i = 0; i < c->n_couplings; i++) {
        const int k = audit->options.device_part[c->coupling[i].inductor[0]];
        if (k >= 0) {
            audit->part[k].n_couplings++;
        }
    }
}

static void see_conductance(struct audit_part *part, double g) {
    if (g > 0.0 && isfinite(g)) {
        part->floor.most = fmax(part->floor.most, g);
        part->floor.least = part->floor.least > 0.0 ? fmin(part->floor.least, g) : g;
    }
}

/* Of a pair (pairs.c): w = lambda / g + ... is a kink, w = H - another lambda ends its rise at H, and what is neither is a
 * step. */
static bool is_step(const struct dalcs_affine *w, int pair) {
    double own = 0.0;
    for (int i = 0; i < w->n; i++) {
        const struct dalcs_affine_term *term = &w->term[i];
        own += term->kind == DALCS_QUANTITY_PAIR && term->index == pair ? term->coefficient : 0.0;
    }
    const bool is_end =
        w->n == 1 && w->term[0].kind == DALCS_QUANTITY_PAIR && w->term[0].coefficient < 0.0;
    return !(own > 0.0) && !is_end;
}

/* May it jump where what it reads does not? */
static bool jumps(const struct dalcs_behaviour *b) {
    bool may = false;
    for (int k = 0; b != NULL && k < b->n_pairs && !may; k++) {
        may = is_step(&b->w[k], k);
    }
    return may;
}

static void list_members(struct dalcs_audit *audit) {
    const int *owner = audit->net.owner;
    const struct dalcs_circuit *c = audit->circuit;
    for (int k = 0; k < audit->options.n_parts; k++) {
        audit->part[k].n_devices = audit->part[k].n_nodes = audit->part[k].n_couplings = 0;
        audit->part[k].n_latches = 0;
    }
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        const int k = audit->options.device_part[i];
        if (k < 0 || audit->net.is_merged[i]) {
            continue;
        }
        struct audit_part *part = &audit->part[k];
        part->device[part->n_devices++] = i;
        if (audit_remembers(c, i)) {
            part->latch[part->n_latches++] = i;
        }
        for (int e = 0; e < 2; e++) {
            const bool is_charged = d->kind == DALCS_CAPACITOR;
            audit->net.has_charge[audit->net.node_of[d->node[e]]] |= is_charged;
        }
        part->has_reader |= d->behaviour != NULL || d->kind == DALCS_CCVS || d->kind == DALCS_CCCS;
        part->has_voltage_reader |= d->kind == DALCS_VCVS || d->kind == DALCS_VCCS;
        part->has_smooth |= d->behaviour != NULL && d->behaviour->smooth != NULL;
        part->has_formula |= jumps(d->behaviour);
        if (d->kind == DALCS_RESISTOR) {
            see_conductance(part, fabs(1.0 / d->value));
        } else if (d->kind == DALCS_VCCS && d->behaviour == NULL) {
            see_conductance(part, fabs(d->value));
        } else if (d->kind == DALCS_SWITCH) {
            see_conductance(part, 1.0 / c->switch_model[d->model].ron);
            see_conductance(part, 1.0 / c->switch_model[d->model].roff);
        } else if (d->kind == DALCS_DIODE) {
            see_conductance(part, 1.0 / c->diode_model[d->model].ron);
            see_conductance(part, 1.0 / c->diode_model[d->model].roff);
        }
    }
    for (int node = 1; node < c->n_nodes; node++) {
        if (owner[node] >= 0) {
            struct audit_part *part = &audit->part[owner[node]];
            part->node[part->n_nodes++] = node;
        }
    }
    for (int i = 0; i < c->n_couplings; i++) {
        const int k = audit->options.device_part[c->coupling[i].inductor[0]];
        if (k >= 0) {
            audit->part[k].coupling[audit->part[k].n_couplings++] = i;
        }
    }
}

static enum dalcs_status make_parts(struct dalcs_audit *audit) {
    struct dalcs_arena *arena = &audit->arena;
    const struct dalcs_circuit *c = audit->circuit;
    int *owner = audit->net.owner = dalcs_arena_alloc(arena, (size_t)c->n_nodes, sizeof(int));
    audit->part = dalcs_arena_alloc(arena, (size_t)audit->options.n_parts, sizeof(*audit->part));
    if (owner == NULL || audit->part == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int n = 0; n < c->n_nodes; n++) {
        owner[n] = -1;
    }
    count_members(audit, owner);
    for (int k = 0; k < audit->options.n_parts; k++) {
        struct audit_part *part = &audit->part[k];
        part->device = dalcs_arena_alloc(arena, (size_t)part->n_devices, sizeof(int));
        part->node = dalcs_arena_alloc(arena, (size_t)part->n_nodes, sizeof(int));
        part->watch = dalcs_arena_alloc(arena, 1, sizeof(*part->watch));
        part->coupling = dalcs_arena_alloc(arena, (size_t)part->n_couplings, sizeof(int));
        part->latch = dalcs_arena_alloc(arena, (size_t)part->n_latches, sizeof(int));
        part->was_closed = dalcs_arena_alloc(arena, (size_t)part->n_latches, sizeof(bool));
        part->has_turned = dalcs_arena_alloc(arena, (size_t)part->n_latches, sizeof(bool));
        if (part->watch == NULL || part->device == NULL || part->node == NULL ||
            part->coupling == NULL || part->latch == NULL || part->was_closed == NULL ||
            part->has_turned == NULL) {
            return DALCS_E_NOMEM;
        }
        part->tolerance = audit->options.tolerance[k];
    }
    list_members(audit);
    return DALCS_OK;
}

static void note_read(void *to, const struct dalcs_affine_term *term) {
    bool *is_merged = to;
    if (term->kind == DALCS_QUANTITY_CURRENT) {
        is_merged[term->index] = false;
    }
}

/* A current that a formula reads is an unknown, with Kirchhoff's law at both ends, also that of a short. */
static void merge_shorts(struct dalcs_audit *audit) {
    const struct dalcs_circuit *c = audit->circuit;
    dalcs_union_reset(audit->net.node_of, c->n_nodes);
    for (int i = 0; i < c->n_devices; i++) {
        audit->net.is_merged[i] = dalcs_device_is_short(&c->device[i]);
    }
    for (int i = 0; i < c->n_devices; i++) {
        dalcs_behaviour_visit(c->device[i].behaviour, note_read, audit->net.is_merged);
    }
    for (int i = 0; i < c->n_devices; i++) {
        if (audit->net.is_merged[i]) {
            dalcs_union_join(audit->net.node_of, c->device[i].node[0], c->device[i].node[1]);
        }
    }
    for (int n = 0; n < c->n_nodes; n++) {
        audit->net.node_of[n] = dalcs_union_find(audit->net.node_of, n);
    }
}

/* ---- Room ---------------------------------------------------------------------------------------- */

static enum dalcs_status make_state(struct dalcs_audit *audit, struct dalcs_audit_state *s) {
    const struct dalcs_circuit *c = audit->circuit;
    s->v = dalcs_arena_alloc(&audit->arena, (size_t)c->n_nodes, sizeof(double));
    s->i = dalcs_arena_alloc(&audit->arena, (size_t)c->n_devices, sizeof(double));
    s->lambda = dalcs_arena_alloc(&audit->arena, (size_t)audit->net.n_lambdas, sizeof(double));
    s->is_closed = dalcs_arena_alloc(&audit->arena, (size_t)c->n_devices, sizeof(bool));
    s->is_mean = dalcs_arena_alloc(&audit->arena, (size_t)c->n_devices, sizeof(bool));
    bool complete = s->v != NULL && s->i != NULL && s->lambda != NULL && s->is_closed != NULL &&
                    s->is_mean != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

static enum dalcs_status make_sums(struct dalcs_audit *audit) {
    const size_t n_nodes = (size_t)audit->circuit->n_nodes;
    const size_t n_devices = (size_t)audit->circuit->n_devices;
    double **per_node[] = {&audit->sums.current, &audit->sums.scale, &audit->sums.rounding,
                           &audit->scale.v, &audit->crossing.offset};
    double **per_device[] = {&audit->sums.flux, &audit->scale.i, &audit->crossing.stored};
    bool complete = true;
    for (size_t k = 0; k < sizeof per_node / sizeof *per_node; k++) {
        *per_node[k] = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(double));
        complete = complete && *per_node[k] != NULL;
    }
    for (size_t k = 0; k < sizeof per_device / sizeof *per_device; k++) {
        *per_device[k] = dalcs_arena_alloc(&audit->arena, n_devices, sizeof(double));
        complete = complete && *per_device[k] != NULL;
    }
    for (int law = 0; law < DALCS_AUDIT_N_LAWS; law++) {
        audit->worst_of[law] = dalcs_arena_alloc(
            &audit->arena, (size_t)dalcs_audit_n_of(audit, law), sizeof(*audit->worst_of[law]));
        complete = complete && audit->worst_of[law] != NULL;
    }
    audit->flux = dalcs_arena_alloc(&audit->arena, n_devices, sizeof(*audit->flux));
    complete = complete && audit->flux != NULL;
    audit->scale.lambda =
        dalcs_arena_alloc(&audit->arena, (size_t)audit->net.n_lambdas, sizeof(double));
    audit->crossing.cluster = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(int));
    audit->crossing.tie = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(int));
    audit->crossing.has_impulse = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(bool));
    complete = complete && audit->crossing.tie != NULL && audit->crossing.has_impulse != NULL;
    return complete && audit->scale.lambda != NULL && audit->crossing.cluster != NULL
               ? DALCS_OK
               : DALCS_E_NOMEM;
}

static enum dalcs_status make_courses(struct dalcs_audit *audit) {
    const int n = audit->circuit->n_stimuli;
    audit->course = dalcs_arena_alloc(&audit->arena, (size_t)n, sizeof(*audit->course));
    for (int k = 0; k < n && audit->course != NULL; k++) {
        audit->course[k].from = audit->course[k].origin = INFINITY;
    }
    return audit->course != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

static enum dalcs_status number_lambdas(struct dalcs_audit *audit) {
    const struct dalcs_circuit *c = audit->circuit;
    audit->net.first_lambda = dalcs_arena_alloc(&audit->arena, (size_t)c->n_devices, sizeof(int));
    if (audit->net.first_lambda == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < c->n_devices; i++) {
        audit->net.first_lambda[i] = audit->net.n_lambdas;
        audit->net.n_lambdas +=
            c->device[i].behaviour != NULL ? c->device[i].behaviour->n_pairs : 0;
    }
    return DALCS_OK;
}

/* Parts of formulas. One that an element without a formula reads, as a term of a POLY, is held to its own law. */
static enum dalcs_status find_formula_parts(struct dalcs_audit *audit) {
    const struct dalcs_circuit *c = audit->circuit;
    if (c->n_smooth == 0) {
        return DALCS_OK;
    }
    audit->net.part_of = dalcs_arena_alloc(&audit->arena, (size_t)c->n_nodes, sizeof(int));
    audit->net.is_inner = dalcs_arena_alloc(&audit->arena, (size_t)c->n_devices, sizeof(bool));
    if (audit->net.part_of == NULL || audit->net.is_inner == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int n = 0; n < c->n_nodes; n++) {
        audit->net.part_of[n] = -1;
    }
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_behaviour *b = c->device[i].behaviour;
        if (b != NULL && b->is_part) {
            audit->net.part_of[c->device[i].node[0]] = i;
            audit->net.is_inner[i] = true;
        }
    }
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        for (int k = 2; k < 4 && d->behaviour == NULL; k++) {
            if (d->node[k] > 0 && audit->net.part_of[d->node[k]] >= 0) {
                audit->net.is_inner[audit->net.part_of[d->node[k]]] = false;
            }
        }
    }
    return DALCS_OK;
}

/* Does it hold one of its nodes with the other, by what is held already? Sources, and E and formulas without pairs that
 * read only such. */
static bool hands_on(const struct dalcs_audit *audit, const struct dalcs_device *d) {
    const bool *is_held = audit->net.is_held;
    if (d->behaviour == NULL) {
        return d->kind == DALCS_VSOURCE ||
               (d->kind == DALCS_VCVS && is_held[d->node[2]] && is_held[d->node[3]]);
    }
    const struct dalcs_affine *f = &d->behaviour->output;
    bool only = d->kind == DALCS_VCVS && d->behaviour->n_pairs == 0 && d->behaviour->smooth == NULL;
    for (int k = 0; k < f->n && only; k++) {
        only = f->term[k].kind == DALCS_QUANTITY_STIMULUS ||
               (f->term[k].kind == DALCS_QUANTITY_VOLTAGE && is_held[f->term[k].index]);
    }
    return only;
}

/* Nodes that sources alone decide, whatever lies between. */
static void find_held(const struct dalcs_audit *audit) {
    const struct dalcs_circuit *c = audit->circuit;
    bool grows = true;
    while (grows) {
        grows = false;
        for (int i = 0; i < c->n_devices; i++) {
            const struct dalcs_device *d = &c->device[i];
            bool *held[2] = {&audit->net.is_held[d->node[0]], &audit->net.is_held[d->node[1]]};
            if (*held[0] != *held[1] && hands_on(audit, d)) {
                *held[0] = *held[1] = grows = true;
            }
        }
    }
}

static void find_fed(const struct dalcs_audit *audit) {
    const struct dalcs_circuit *c = audit->circuit;
    audit->net.is_fed[0] = audit->net.is_held[0] = true;
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        if (d->kind == DALCS_VSOURCE && (d->node[0] == 0 || d->node[1] == 0)) {
            const struct dalcs_stimulus *s = &c->stimulus[d->stimulus];
            audit->net.is_fed[d->node[d->node[0] == 0]] =
                dalcs_stimulus_value(s, 0.0, DALCS_LEFT) ==
                dalcs_stimulus_value(s, 0.0, DALCS_RIGHT);
        }
    }
}

enum dalcs_status audit_set_up(struct dalcs_audit *audit) {
    const size_t n_nodes = (size_t)audit->circuit->n_nodes;
    audit->net.node_of = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(int));
    audit->net.has_charge = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(bool));
    audit->net.is_read = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(bool));
    audit->net.is_fed = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(bool));
    audit->net.is_held = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(bool));
    audit->net.is_merged =
        dalcs_arena_alloc(&audit->arena, (size_t)audit->circuit->n_devices, sizeof(bool));
    if (audit->net.is_merged == NULL || audit->net.is_read == NULL || audit->net.is_held == NULL ||
        audit->net.node_of == NULL || audit->net.has_charge == NULL || audit->net.is_fed == NULL) {
        return DALCS_E_NOMEM;
    }
    find_fed(audit);
    find_held(audit);
    merge_shorts(audit);
    DALCS_TRY(number_lambdas(audit));
    DALCS_TRY(find_formula_parts(audit));
    DALCS_TRY(make_parts(audit));
    DALCS_TRY(make_sums(audit));
    DALCS_TRY(make_courses(audit));
    DALCS_TRY(make_state(audit, &audit->now));
    DALCS_TRY(make_state(audit, &audit->later));
    DALCS_TRY(make_state(audit, &audit->shifted));
    DALCS_TRY(make_state(audit, &audit->before));
    DALCS_TRY(make_state(audit, &audit->asked));
    return DALCS_OK;
}

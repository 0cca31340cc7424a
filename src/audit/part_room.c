/* part_room.c - room for what is read of a part. */
#include "audit_formula.h"
#include "watch.h"

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
    if (c->control.n_smooth == 0) {
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

/* Is what it puts out part of a gate's output? */
static bool is_of_gate(const struct dalcs_audit *audit, const struct dalcs_device *d) {
    const struct dalcs_stimulus *s = audit->circuit->stimulus;
    const bool *is_gated = audit->net.is_gated;
    if (d->behaviour == NULL) {
        return d->kind == DALCS_VSOURCE ? s[d->stimulus].is_written && !s[d->stimulus].is_external
                                        : is_gated[d->node[2]] || is_gated[d->node[3]];
    }
    const struct dalcs_affine *f = &d->behaviour->output;
    bool is = false;
    for (int k = 0; k < f->n && !is; k++) {
        is = f->term[k].kind == DALCS_QUANTITY_STIMULUS
                 ? s[f->term[k].index].is_written && !s[f->term[k].index].is_external
                 : is_gated[f->term[k].index];
    }
    return is;
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
                bool *gated = audit->net.is_gated;
                *held[0] = *held[1] = grows = true;
                gated[d->node[0]] = gated[d->node[1]] =
                    gated[d->node[0]] || gated[d->node[1]] || is_of_gate(audit, d);
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
    audit->net.is_gated = dalcs_arena_alloc(&audit->arena, n_nodes, sizeof(bool));
    const size_t n_devices = (size_t)audit->circuit->n_devices;
    audit->net.is_merged = dalcs_arena_alloc(&audit->arena, n_devices, sizeof(bool));
    audit->net.is_told = dalcs_arena_alloc(&audit->arena, n_devices, sizeof(bool));
    if (audit->net.is_merged == NULL || audit->net.is_read == NULL || audit->net.is_held == NULL ||
        audit->net.node_of == NULL || audit->net.has_charge == NULL || audit->net.is_fed == NULL ||
        audit->net.is_gated == NULL || audit->net.is_told == NULL) {
        return DALCS_E_NOMEM;
    }
    find_fed(audit);
    find_held(audit);
    audit_merge_shorts(audit);
    audit_find_told(audit);
    DALCS_TRY(number_lambdas(audit));
    DALCS_TRY(find_formula_parts(audit));
    DALCS_TRY(audit_find_reads(audit));
    DALCS_TRY(audit_make_parts(audit));
    DALCS_TRY(make_sums(audit));
    DALCS_TRY(make_courses(audit));
    DALCS_TRY(make_state(audit, &audit->state.now));
    DALCS_TRY(make_state(audit, &audit->state.later));
    DALCS_TRY(make_state(audit, &audit->state.shifted));
    DALCS_TRY(make_state(audit, &audit->state.before));
    DALCS_TRY(make_state(audit, &audit->state.asked));
    return DALCS_OK;
}

/* formula_reads.c - the circuit's own voltages and currents, and the sources, that each formula reads by way of its parts. */
#include "audit_formula.h"

#include "memory.h"

struct search {
    struct dalcs_audit *audit;
    int *seen; /* [n_devices] parts: the formula that they were found for last, and 1 */
    size_t room;
    int n;
};

static enum dalcs_status add(struct search *f, int device, enum dalcs_quantity_kind kind,
                             int index) {
    struct audit_reads *reads = &f->audit->net.reads;
    for (int k = reads->first[device]; k < f->n; k++) {
        if (reads->of[k].kind == kind && reads->of[k].index == index) {
            return DALCS_OK;
        }
    }
    DALCS_TRY(dalcs_grow(&reads->of, &f->room, (size_t)f->n + 1, sizeof(*reads->of)));
    reads->of[f->n++] = (struct audit_read){kind, index};
    return DALCS_OK;
}

static enum dalcs_status add_device(struct search *f, int device, int of);

static enum dalcs_status add_node(struct search *f, int device, int node) {
    const int *part_of = f->audit->net.part_of;
    if (part_of == NULL || part_of[node] < 0) {
        return node > 0 ? add(f, device, DALCS_QUANTITY_VOLTAGE, node) : DALCS_OK;
    }
    if (f->seen[part_of[node]] == device + 1) {
        return DALCS_OK;
    }
    f->seen[part_of[node]] = device + 1;
    return add_device(f, device, part_of[node]);
}

static enum dalcs_status add_affine(struct search *f, int device, const struct dalcs_affine *a) {
    for (int k = 0; k < a->n; k++) {
        const struct dalcs_affine_term *term = &a->term[k];
        if (term->kind == DALCS_QUANTITY_VOLTAGE) {
            DALCS_TRY(add_node(f, device, term->index));
        } else if (term->kind != DALCS_QUANTITY_PAIR) {
            DALCS_TRY(add(f, device, term->kind, term->index));
        }
    }
    return DALCS_OK;
}

/* `of`: the formula itself, or a part of it. */
static enum dalcs_status add_device(struct search *f, int device, int of) {
    const struct dalcs_behaviour *own = f->audit->circuit->device[of].behaviour;
    const struct dalcs_behaviour *b = own->is_implicit ? own->written : own;
    if (b->smooth != NULL) {
        for (int k = 0; k < b->smooth->n; k++) {
            if (b->smooth->node[k] >= 0) {
                DALCS_TRY(add_node(f, device, b->smooth->node[k]));
            }
        }
        return DALCS_OK;
    }
    DALCS_TRY(add_affine(f, device, &b->output));
    for (int k = 0; k < b->n_pairs; k++) {
        DALCS_TRY(add_affine(f, device, &b->w[k]));
    }
    return DALCS_OK;
}

enum dalcs_status audit_find_reads(struct dalcs_audit *audit) {
    const struct dalcs_circuit *c = audit->circuit;
    struct audit_reads *reads = &audit->net.reads;
    struct search f = {.audit = audit};
    reads->first = dalcs_arena_alloc(&audit->arena, (size_t)c->n_devices + 1, sizeof(int));
    f.seen = dalcs_arena_alloc(&audit->arena, (size_t)c->n_devices, sizeof(int));
    reads->lambda =
        dalcs_arena_alloc(&audit->arena, (size_t)audit->net.n_lambdas, sizeof(*reads->lambda));
    if (reads->first == NULL || f.seen == NULL || reads->lambda == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < c->n_devices; i++) {
        reads->first[i] = f.n;
        if (c->device[i].behaviour != NULL) {
            DALCS_TRY(add_device(&f, i, i));
        }
    }
    reads->first[c->n_devices] = f.n;
    return DALCS_OK;
}

double audit_read_scale(const struct dalcs_audit *audit, const struct audit_part *part,
                        const struct dalcs_audit_state *s, struct audit_read of) {
    switch (of.kind) {
    case DALCS_QUANTITY_VOLTAGE:
        return fmax(audit_volts(audit, part, of.index, 0), fabs(s->v[of.index]));
    case DALCS_QUANTITY_CURRENT:
        return fmax(audit_amperes(audit, part, of.index), fabs(audit_current(audit, s, of.index)));
    default:
        return fabs(dalcs_stimulus_value(&audit->circuit->stimulus[of.index], s->t, s->side));
    }
}

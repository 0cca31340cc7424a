/* parts.c - who belongs to a part. */
#include "audit_positions.h"
#include "watch.h"

#include "union_find.h"

bool audit_remembers(const struct dalcs_circuit *c, int device) {
    const struct dalcs_device *d = &c->device[device];
    return d->kind == DALCS_SWITCH && c->models.of_switch[d->model].vh != 0.0;
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
        audit->part[k].latches.n += audit_remembers(c, i) ? 1 : 0;
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

static void see_conductance(struct audit_floor *floor, double g) {
    if (g > 0.0 && isfinite(g)) {
        floor->most = fmax(floor->most, g);
        floor->least = floor->least > 0.0 ? fmin(floor->least, g) : g;
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

/* The conductances that a device may have. */
void audit_see_conductances(struct audit_floor *floor, const struct dalcs_circuit *c,
                            const struct dalcs_device *d) {
    if (d->kind == DALCS_RESISTOR) {
        see_conductance(floor, fabs(1.0 / d->value));
    } else if (d->kind == DALCS_VCCS && d->behaviour == NULL) {
        see_conductance(floor, fabs(d->value));
    } else if (d->kind == DALCS_SWITCH) {
        see_conductance(floor, 1.0 / c->models.of_switch[d->model].ron);
        see_conductance(floor, 1.0 / c->models.of_switch[d->model].roff);
    } else if (d->kind == DALCS_DIODE) {
        see_conductance(floor, 1.0 / c->models.of_diode[d->model].ron);
        see_conductance(floor, 1.0 / c->models.of_diode[d->model].roff);
    }
}

static void list_members(struct dalcs_audit *audit) {
    const int *owner = audit->net.owner;
    const struct dalcs_circuit *c = audit->circuit;
    for (int k = 0; k < audit->options.n_parts; k++) {
        audit->part[k].n_devices = audit->part[k].n_nodes = audit->part[k].n_couplings = 0;
        audit->part[k].latches.n = 0;
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
            part->latches.device[part->latches.n++] = i;
        }
        for (int e = 0; e < 2; e++) {
            const bool is_charged = d->kind == DALCS_CAPACITOR;
            audit->net.has_charge[audit->net.node_of[d->node[e]]] |= is_charged;
        }
        part->has.reader |= d->behaviour != NULL || d->kind == DALCS_CCVS || d->kind == DALCS_CCCS;
        part->has.voltage_reader |= d->kind == DALCS_VCVS || d->kind == DALCS_VCCS;
        part->has.smooth |= d->behaviour != NULL && d->behaviour->smooth != NULL;
        part->has.formula |= jumps(d->behaviour);
        audit_see_conductances(&part->floor, c, d);
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

enum dalcs_status audit_make_parts(struct dalcs_audit *audit) {
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
        part->latches.device = dalcs_arena_alloc(arena, (size_t)part->latches.n, sizeof(int));
        part->latches.was_closed = dalcs_arena_alloc(arena, (size_t)part->latches.n, sizeof(bool));
        part->latches.has_turned = dalcs_arena_alloc(arena, (size_t)part->latches.n, sizeof(bool));
        if (part->watch == NULL || part->device == NULL || part->node == NULL ||
            part->coupling == NULL || part->latches.device == NULL ||
            part->latches.was_closed == NULL || part->latches.has_turned == NULL) {
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

static bool is_told(const struct dalcs_audit *audit, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const struct dalcs_audit_reader *r = &audit->reader;
    return d->kind == DALCS_RESISTOR &&
           (d->value == 0.0 || (r->tells_current != NULL && r->tells_current(r->user, device)));
}

void audit_find_told(struct dalcs_audit *audit) {
    for (int i = 0; i < audit->circuit->n_devices; i++) {
        audit->net.is_told[i] = is_told(audit, i);
    }
}

void audit_merge_shorts(struct dalcs_audit *audit) {
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

void dalcs_audit_has_no_rest(struct dalcs_audit *audit, int part) {
    audit->part[part].is_restless = true;
}

bool dalcs_audit_begins(struct dalcs_audit *audit, int index) {
    const struct audit_part *part = &audit->part[index];
    return part->is_open || !part->has_entered;
}

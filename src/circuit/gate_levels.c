/* gate_levels.c - switches whose threshold is a value that their control rests at.
 *
 * A gate that a formula makes of numbers, such as v(a) > v(b) ? 1 : 0, has a few values and no others
 * between its jumps. A switch without hysteresis is on above Vt alone, and so off at a value that is Vt
 * itself: with Vt half way to the next value above it does the same, and rounding no longer decides. */
#include "behaviour.h"
#include "model_cards.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_STEPS = 6, MOST_VALUES = 1 << MOST_STEPS, DEEPEST = 4 };

/* v(node[0]) - v(node[1]) has these values. */
struct dalcs_gate {
    int node[2];
    int n;
    double value[MOST_VALUES];
};

/* Each step is on or off, whatever the others are: a circuit may never reach some of the values. */
static bool list_values(const struct dalcs_levels *levels, struct dalcs_gate *gate) {
    if (levels == NULL || levels->n < 1 || levels->n > MOST_STEPS) {
        return false;
    }
    gate->n = 1 << levels->n;
    for (int k = 0; k < gate->n; k++) {
        gate->value[k] = levels->base;
        for (int i = 0; i < levels->n; i++) {
            gate->value[k] += (k >> i & 1) != 0 ? levels->level[i].height : 0;
        }
    }
    return true;
}

/* Vt, or half way to the next value above it where it is one itself. */
static double threshold(const struct dalcs_gate *gate, double sign, double vt) {
    bool is_value = false;
    double next = INFINITY;
    for (int k = 0; k < gate->n; k++) {
        const double value = sign * gate->value[k];
        is_value = is_value || value == vt;
        next = value > vt ? fmin(next, value) : next;
    }
    return is_value && isfinite(next) ? vt + 0.5 * (next - vt) : vt;
}

static void set_threshold(struct dalcs_builder *builder, struct dalcs_device *device, double vt) {
    struct dalcs_switch_model model = builder->circuit->models.of_switch[device->model];
    model.vt = vt;
    const int added = dalcs_switch_add_model(builder, &model);
    device->model = added >= 0 ? added : device->model;
}

/* +1, -1: is this the gate, or turned around? 0: it is another voltage. */
static double sign_of(const struct dalcs_gate *gate, const int *node) {
    const bool is_same = node[0] == gate->node[0] && node[1] == gate->node[1];
    const bool is_turned = node[0] == gate->node[1] && node[1] == gate->node[0];
    return is_same ? 1 : is_turned ? -1 : 0;
}

int dalcs_gate_node(const struct dalcs_gate *gate) {
    return gate->node[0];
}

bool dalcs_gate_bounds(const struct dalcs_gate *gate, int node, int reference, double *low,
                       double *high) {
    const double sign = sign_of(gate, (const int[]){node, reference});
    *low = INFINITY;
    *high = -INFINITY;
    for (int k = 0; k < gate->n && sign != 0; k++) {
        *low = fmin(*low, sign * gate->value[k]);
        *high = fmax(*high, sign * gate->value[k]);
    }
    return sign != 0;
}

static bool list_readers(struct dalcs_builder *builder, struct dalcs_gate_readers *r) {
    const struct dalcs_circuit *circuit = builder->circuit;
    r->first = dalcs_alloc((size_t)circuit->n_nodes, sizeof *r->first);
    r->next = dalcs_alloc((size_t)circuit->n_devices, sizeof *r->next);
    if (r->first == NULL || r->next == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    for (int i = circuit->n_devices - 1; i >= 0; i--) {
        const struct dalcs_device *device = &circuit->device[i];
        const bool reads = device->kind == DALCS_SWITCH || device->kind == DALCS_VCVS;
        for (int e = 0; e < 2 && reads; e++) {
            r->next[i][e] = r->first[device->node[2 + e]];
            r->first[device->node[2 + e]] = 2 * i + e + 1;
        }
    }
    return true;
}

static void settle(struct dalcs_builder *builder, const struct dalcs_gate_readers *readers,
                   const struct dalcs_gate *gate, int depth) {
    struct dalcs_circuit *circuit = builder->circuit;
    const int node = gate->node[0] != 0 ? gate->node[0] : gate->node[1];
    for (int at = readers->first[node]; at != 0 && !builder->out_of_memory;
         at = readers->next[(at - 1) / 2][(at - 1) % 2]) {
        struct dalcs_device *device = &circuit->device[(at - 1) / 2];
        const double sign = sign_of(gate, device->node + 2);
        if (device->kind == DALCS_SWITCH && device->model >= 0 && sign != 0) {
            const struct dalcs_switch_model *model = &circuit->models.of_switch[device->model];
            const double vt = threshold(gate, sign, model->vt);
            if (model->vh == 0 && !model->is_inverted && vt != model->vt) {
                set_threshold(builder, device, vt);
            }
        } else if (device->kind == DALCS_VCVS && device->behaviour == NULL && sign != 0 &&
                   depth < DEEPEST) {
            struct dalcs_gate driven = {.node = {device->node[0], device->node[1]}, .n = gate->n};
            for (int k = 0; k < gate->n; k++) {
                driven.value[k] = device->value * sign * gate->value[k];
            }
            settle(builder, readers, &driven, depth + 1);
        }
    }
}

const struct dalcs_gate *dalcs_gate_find(struct dalcs_compiler *c,
                                         const struct dalcs_device *device,
                                         const struct dalcs_form *form) {
    struct dalcs_gate found = {.node = {device->node[0], device->node[1]}};
    if (device->kind != DALCS_VCVS || c->builder->circuit->models.n_switches == 0 ||
        !list_values(dalcs_levels_of(c, form), &found)) {
        return NULL;
    }
    struct dalcs_gate *gate = dalcs_arena_alloc(c->arena, 1, sizeof *gate);
    if (gate == NULL) {
        c->builder->out_of_memory = true;
        return NULL;
    }
    *gate = found;
    return gate;
}

void dalcs_gate_settle(struct dalcs_builder *builder, struct dalcs_gate_readers *readers,
                       const struct dalcs_gate *gate) {
    if (readers->first != NULL || list_readers(builder, readers)) {
        settle(builder, readers, gate, 0);
    }
}

void dalcs_gate_readers_finish(struct dalcs_gate_readers *readers) {
    free(readers->first);
    free(readers->next);
    *readers = (struct dalcs_gate_readers){0};
}

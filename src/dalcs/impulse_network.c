/* impulse_network.c - the circuit of capacitors and the circuit of coils that a jump takes place in. */
#include "impulse_network.h"

#include <math.h>
#include <stdlib.h>

struct reduction {
    const struct dalcs_circuit *from;
    struct dalcs_circuit *to;
    enum dalcs_impulse_kind kind;
    int *device_of;       /* [from->n_devices] where it went, -1 if nowhere */
    bool *is_transformer; /* [from->n_devices] */
};

void dalcs_mark_transformers(const struct dalcs_circuit *c, bool *is_transformer) {
    for (int k = 0; k < c->n_couplings; k++) {
        const int *coil = c->coupling[k].inductor;
        bool is_perfect = fabs(c->coupling[k].k) == 1.0;
        is_transformer[coil[0]] = is_transformer[coil[0]] || is_perfect;
        is_transformer[coil[1]] = is_transformer[coil[1]] || is_perfect;
    }
    for (bool more = true; more;) {
        more = false;
        for (int k = 0; k < c->n_couplings; k++) {
            const int *coil = c->coupling[k].inductor;
            if (is_transformer[coil[0]] != is_transformer[coil[1]]) {
                is_transformer[coil[0]] = is_transformer[coil[1]] = true;
                more = true;
            }
        }
    }
}

const char *dalcs_breakdown_name(struct dalcs_arena *arena, const char *diode) {
    return dalcs_arena_printf(arena, "%s breakdown", diode);
}

static struct dalcs_device *add(struct reduction *r, const struct dalcs_device *d) {
    struct dalcs_device *copy = &r->to->device[r->to->n_devices++];
    *copy = *d;
    return copy;
}

static void add_short(struct reduction *r, const struct dalcs_device *d) {
    struct dalcs_device *copy = add(r, d);
    copy->kind = DALCS_RESISTOR;
    copy->value = 0.0;
}

/* Is it a source, though a formula says of what? One that reads states acts where the circuit has gone to, and jumps are
 * problems without it (jumps.h). */
static bool is_source(const struct dalcs_device *d) {
    const struct dalcs_behaviour *b = d->behaviour;
    bool is = d->kind == DALCS_VSOURCE || d->kind == DALCS_ISOURCE;
    if (b != NULL && !b->is_part && b->smooth == NULL && b->n_pairs == 0) {
        is = true;
        for (int k = 0; k < b->output.n; k++) {
            is = is && b->output.term[k].kind == DALCS_QUANTITY_STIMULUS;
        }
    }
    return is;
}

/* An exactly ideal diode with a threshold, from the first to the second node of d. */
static void add_diode(struct reduction *r, const struct dalcs_device *d, const char *name,
                      double threshold) {
    struct dalcs_device *copy = add(r, d);
    copy->name = name;
    copy->model = r->to->models.n_diodes;
    r->to->models.of_diode[r->to->models.n_diodes++] = (struct dalcs_diode_model){
        .name = name, .roff = INFINITY, .vfwd = threshold, .vrev = INFINITY};
}

/* Charge passes a branch without resistance alone. */
static enum dalcs_status reduce_to_charge(struct reduction *r, const struct dalcs_device *d) {
    switch (d->kind) {
    case DALCS_INDUCTOR:
        if (r->is_transformer[d - r->from->device]) {
            /* Its magnetising current has no time to change: an inductance without end, which overflows in no product. */
            add(r, d)->value *= 0x1p100;
        }
        break;
    case DALCS_CAPACITOR:
        add(r, d);
        break;
    case DALCS_VSOURCE:
    case DALCS_VCVS:
        if (is_source(d)) {
            add(r, d);
        }
        break;
    case DALCS_RESISTOR:
        if (d->value == 0.0) {
            add(r, d);
        }
        break;
    case DALCS_SWITCH:
        if (r->from->models.of_switch[d->model].ron == 0.0) {
            add(r, d);
        }
        break;
    case DALCS_DIODE: {
        const struct dalcs_diode_model *m = &r->from->models.of_diode[d->model];
        if (m->ron == 0.0) {
            add_diode(r, d, d->name, m->vfwd);
        }
        if (isfinite(m->vrev) && m->rrev == 0.0) {
            const char *name = dalcs_breakdown_name(&r->to->arena, d->name);
            if (name == NULL) {
                return DALCS_E_NOMEM;
            }
            struct dalcs_device reverse = *d;
            reverse.node[0] = d->node[1];
            reverse.node[1] = d->node[0];
            add_diode(r, &reverse, name, m->vrev);
        }
        break;
    }
    default:
        break;
    }
    return DALCS_OK;
}

/* Flux builds up across what can block every current. */
static void reduce_to_flux(struct reduction *r, const struct dalcs_device *d) {
    switch (d->kind) {
    case DALCS_INDUCTOR:
        add(r, d);
        break;
    case DALCS_ISOURCE:
    case DALCS_VCCS:
        if (is_source(d)) {
            add(r, d);
        }
        break;
    case DALCS_RESISTOR:
    case DALCS_CAPACITOR:
        add_short(r, d);
        break;
    case DALCS_VSOURCE:
    case DALCS_VCVS:
        if (is_source(d)) {
            add_short(r, d);
        }
        break;
    case DALCS_SWITCH:
        if (isfinite(r->from->models.of_switch[d->model].roff)) {
            add_short(r, d);
        } else {
            add(r, d);
        }
        break;
    case DALCS_DIODE: {
        const struct dalcs_diode_model *m = &r->from->models.of_diode[d->model];
        if (isfinite(m->roff) || isfinite(m->vrev)) {
            add_short(r, d);
        } else {
            add_diode(r, d, d->name, 0.0);
        }
        break;
    }
    default:
        break;
    }
}

/* Switches are commanded; what controls them is elsewhere. */
static void let_go_of_controls(struct dalcs_circuit *to) {
    for (int i = 0; i < to->n_devices; i++) {
        if (to->device[i].kind == DALCS_SWITCH) {
            to->device[i].node[2] = to->device[i].node[3] = 0;
            to->device[i].control = -1;
            to->device[i].valve = -1;
        }
    }
    for (int k = 0; k < to->models.n_switches; k++) {
        to->models.of_switch[k].ron = 0.0;
        to->models.of_switch[k].roff = INFINITY;
    }
}

/* Of each source the impulse, then what it drives: its power is their product. */
static void add_signals(struct dalcs_circuit *to, enum dalcs_impulse_kind kind) {
    const enum dalcs_device_kind driven[] = {
        [DALCS_IMPULSE_CHARGE] = DALCS_VSOURCE, [DALCS_IMPULSE_FLUX] = DALCS_ISOURCE};

    const enum dalcs_device_kind by_formula[] = {
        [DALCS_IMPULSE_CHARGE] = DALCS_VCVS, [DALCS_IMPULSE_FLUX] = DALCS_VCCS};

    for (int i = 0; i < to->n_devices; i++) {
        const struct dalcs_device *d = &to->device[i];
        if (d->kind != driven[kind] && d->kind != by_formula[kind]) {
            continue;
        }
        const struct dalcs_signal current = {
            .kind = DALCS_SIGNAL_CURRENT, .name = d->name, .device = i};
        const struct dalcs_signal voltage = {.kind = DALCS_SIGNAL_VOLTAGE,
                                             .name = d->name,
                                             .node = {d->node[0], d->node[1]},
                                             .device = -1};
        to->results.signal[to->results.n_signals++] =
            kind == DALCS_IMPULSE_CHARGE ? current : voltage;
        to->results.signal[to->results.n_signals++] =
            kind == DALCS_IMPULSE_CHARGE ? voltage : current;
    }
}

static void add_couplings(struct reduction *r) {
    for (int k = 0; k < r->from->n_couplings; k++) {
        struct dalcs_coupling m = r->from->coupling[k];
        m.inductor[0] = r->device_of[m.inductor[0]];
        m.inductor[1] = r->device_of[m.inductor[1]];
        if (m.inductor[0] >= 0) {
            r->to->coupling[r->to->n_couplings++] = m;
        }
    }
}

static enum dalcs_status reduce(struct reduction *r) {
    const struct dalcs_circuit *from = r->from;
    struct dalcs_circuit *to = r->to;
    size_t n = (size_t)from->n_devices;
    *to = (struct dalcs_circuit){.title = from->title,
                                 .n_nodes = from->n_nodes,
                                 .node_name = from->node_name,
                                 .n_stimuli = from->n_stimuli,
                                 .stimulus = from->stimulus,
                                 .models.n_switches = from->models.n_switches};
    to->device = dalcs_arena_alloc(&to->arena, 2 * n, sizeof(*to->device));
    to->models.of_diode = dalcs_arena_alloc(&to->arena, 2 * n, sizeof(*to->models.of_diode));
    to->models.of_switch = dalcs_arena_alloc(&to->arena, (size_t)from->models.n_switches,
                                             sizeof(*to->models.of_switch));
    to->coupling = dalcs_arena_alloc(&to->arena, (size_t)from->n_couplings, sizeof(*to->coupling));
    to->results.signal = dalcs_arena_alloc(&to->arena, 2 * n, sizeof(*to->results.signal));
    if (to->device == NULL || to->models.of_diode == NULL || to->models.of_switch == NULL ||
        to->coupling == NULL || to->results.signal == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < from->n_devices; i++) {
        int place = to->n_devices;
        if (r->kind == DALCS_IMPULSE_CHARGE) {
            DALCS_TRY(reduce_to_charge(r, &from->device[i]));
        } else {
            reduce_to_flux(r, &from->device[i]);
        }
        r->device_of[i] = to->n_devices > place ? place : -1;
    }
    add_couplings(r);
    let_go_of_controls(to);
    add_signals(to, r->kind);
    return DALCS_OK;
}

enum dalcs_status dalcs_impulse_network_build(struct dalcs_impulse_network *impulse,
                                              const struct dalcs_circuit *circuit,
                                              enum dalcs_impulse_kind kind) {
    *impulse = (struct dalcs_impulse_network){0};
    struct reduction r = {.from = circuit,
                          .to = &impulse->circuit,
                          .kind = kind,
                          .device_of = dalcs_alloc((size_t)circuit->n_devices, sizeof(int)),
                          .is_transformer = dalcs_alloc((size_t)circuit->n_devices, sizeof(bool))};
    struct dalcs_diag nobody = {0};
    enum dalcs_status status = DALCS_E_NOMEM;
    if (r.device_of != NULL && r.is_transformer != NULL) {
        dalcs_mark_transformers(circuit, r.is_transformer);
        status = reduce(&r);
    }
    if (status == DALCS_OK) {
        status = dalcs_network_build(&impulse->network, &impulse->circuit,
                                     &(struct dalcs_network_options){.silent = true}, &nobody);
    }
    dalcs_diag_finish(&nobody);
    free(r.device_of);
    free(r.is_transformer);
    if (status != DALCS_OK) {
        dalcs_circuit_finish(&impulse->circuit);
        *impulse = (struct dalcs_impulse_network){0};
    }
    return status;
}

void dalcs_impulse_network_finish(struct dalcs_impulse_network *impulse) {
    dalcs_network_finish(&impulse->network);
    dalcs_circuit_finish(&impulse->circuit);
    *impulse = (struct dalcs_impulse_network){0};
}

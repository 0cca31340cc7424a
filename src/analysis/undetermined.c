/* undetermined.c - when to look, and the tables that all looks share. */
#include "freedom.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void dalcs_undetermined_init(struct dalcs_undetermined *u, const struct dalcs_circuit *circuit,
                             void *user,
                             enum dalcs_status (*on_finding)(void *user,
                                                             const struct dalcs_finding *finding)) {
    *u = (struct dalcs_undetermined){.circuit = circuit, .user = user, .on_finding = on_finding};
}

void dalcs_undetermined_finish(struct dalcs_undetermined *u) {
    dalcs_topology_finish(&u->topology);
    free(u->device_start);
    free(u->device);
    free(u->shorts);
    free(u->first_pair);
    free(u->vertex_of);
    free(u->branch_of);
    free(u->told);
    *u = (struct dalcs_undetermined){0};
}

static void fill(int *item, size_t n) {
    for (size_t k = 0; k < n; k++) {
        item[k] = -1;
    }
}

/* Devices by component, in their order, and their pairs: as they were assembled. */
static void sort_devices(struct dalcs_undetermined *u) {
    const struct dalcs_circuit *c = u->circuit;
    const int *component = u->topology.device_component;
    for (int i = 0; i < c->n_devices; i++) {
        if (component[i] >= 0) {
            u->device_start[component[i] + 2]++;
        } else {
            u->shorts[u->n_shorts++] = i;
        }
    }
    for (int k = 0; k < u->topology.n_components; k++) {
        u->device_start[k + 2] += u->device_start[k + 1];
    }
    for (int i = 0; i < c->n_devices; i++) {
        if (component[i] >= 0) {
            u->device[u->device_start[component[i] + 1]++] = i;
        }
    }
    for (int k = 0; k < u->topology.n_components; k++) {
        int pair = 0;
        for (int j = u->device_start[k]; j < u->device_start[k + 1]; j++) {
            const struct dalcs_device *d = &c->device[u->device[j]];
            bool is_diode = d->kind == DALCS_DIODE;
            u->first_pair[u->device[j]] = pair;
            pair += is_diode || d->kind == DALCS_SWITCH ? 1 : 0;
            pair += is_diode && isfinite(c->models.of_diode[d->model].vrev) ? 1 : 0;
            pair += d->behaviour != NULL ? d->behaviour->n_pairs : 0;
        }
    }
}

enum dalcs_status dalcs_undetermined_prepare(struct dalcs_undetermined *u) {
    if (u->is_ready) {
        return DALCS_OK;
    }
    const struct dalcs_circuit *c = u->circuit;
    size_t n_devices = (size_t)c->n_devices;
    size_t n_nodes = (size_t)c->n_nodes;
    bool *wants_current = dalcs_alloc(n_devices, sizeof(*wants_current));
    if (wants_current == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_circuit_mark_wanted_currents(c, wants_current);
    enum dalcs_status status = dalcs_topology_build(&u->topology, c, wants_current);
    free(wants_current);
    DALCS_TRY(status);
    u->device_start = dalcs_alloc((size_t)u->topology.n_components + 2, sizeof(int));
    u->device = dalcs_alloc(n_devices, sizeof(int));
    u->shorts = dalcs_alloc(n_devices, sizeof(int));
    u->first_pair = dalcs_alloc(n_devices, sizeof(int));
    u->vertex_of = dalcs_alloc(n_nodes, sizeof(int));
    u->branch_of = dalcs_alloc(2 * n_devices, sizeof(int));
    u->told = dalcs_alloc((size_t)c->results.n_signals, sizeof(*u->told));
    if (u->device_start == NULL || u->device == NULL || u->shorts == NULL ||
        u->first_pair == NULL || u->vertex_of == NULL || u->branch_of == NULL || u->told == NULL) {
        return DALCS_E_NOMEM;
    }
    fill(u->vertex_of, n_nodes);
    fill(u->branch_of, 2 * n_devices);
    sort_devices(u);
    u->is_ready = true;
    return DALCS_OK;
}

/* A hash of an instant: component, mode and ties. FNV-1a, never 0. */
static uint64_t name_of(const struct dalcs_open_instant *at) {
    const struct dalcs_system *s = &at->engine->network->system[at->system];
    uint64_t name = 14695981039346656037u ^ (at->at_operating_point ? 1u : 0u);
    name = (name ^ (uint64_t)at->system) * 1099511628211u;
    for (int d = 0; d < s->n_pairs; d++) {
        uint64_t is_on = dalcs_mode_has(at->mode, d) ? 1 : 0;
        name = (name ^ (2 * is_on + (at->tied[d] ? 1 : 0))) * 1099511628211u;
    }
    return name != 0 ? name : 1;
}

/* Should this instant be looked at? One where all intervals vanish is, again and again, but more and
 * more rarely. */
static bool is_news(struct dalcs_seen *seen, uint64_t name) {
    if (seen->name != name) {
        *seen = (struct dalcs_seen){.name = name};
    }
    unsigned asked = seen->n_asked++;
    return !seen->is_done && (asked & (asked - 1)) == 0;
}

enum dalcs_status dalcs_undetermined_at(void *user, const struct dalcs_open_instant *at,
                                        bool *vanishes) {
    struct dalcs_undetermined *u = user;
    *vanishes = false;
    bool has_graph = u->circuit->n_devices > 0; /* a system file has none */
    if (!dalcs_osnsp_is_monotone(&at->engine->component[at->system].osnsp) || !has_graph) {
        return DALCS_OK;
    }
    uint64_t name = name_of(at);
    struct dalcs_seen *seen = &u->seen[name % DALCS_SEEN_SLOTS];
    if (!is_news(seen, name)) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_undetermined_prepare(u));
    struct dalcs_arena work = {0};
    struct dalcs_view view;
    enum dalcs_status status = dalcs_view_setup(&view, u, at, &work);
    if (status == DALCS_OK) {
        status = dalcs_loops_find(&view);
    }
    if (status == DALCS_OK) {
        status = dalcs_islands_find(&view);
    }
    dalcs_view_finish(&view);
    dalcs_arena_finish(&work);
    *vanishes = view.has_narrow;
    seen->is_done = !view.has_narrow;
    return status;
}

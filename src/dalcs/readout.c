/* readout.c - the columns of nodes and currents, kept from the layout. */
#include "readout.h"

#include "current.h"
#include "stamp.h"

/* Is its current a column of an equation? The currents of others follow from voltages; only formulas read that of a
 * capacitor. */
static bool has_own_current(const struct dalcs_layout *l, int device) {
    const struct dalcs_device *d = &l->circuit->device[device];
    switch (d->kind) {
    case DALCS_CAPACITOR:
        return l->current_column[device] >= 0;
    case DALCS_VSOURCE:
    case DALCS_INDUCTOR:
    case DALCS_VCVS:
    case DALCS_CCVS:
    case DALCS_DIODE:
    case DALCS_SWITCH:
        return true;
    case DALCS_RESISTOR: /* a short that is asked for it, or one beside much larger ones */
        return l->current_column[device] >= 0;
    default:
        return d->behaviour != NULL;
    }
}

/* Devices whose currents are in the work arena at a time, and bytes for each, which most need. */
enum { DEVICES_AT_A_TIME = 4096, BYTES_EACH = 64 };

/* Counts the terms of each current into r->start or, where r->term is there, lists them. */
static enum dalcs_status go_through(struct dalcs_readout *r, const struct dalcs_network *network,
                                    const struct dalcs_layout *l) {
    struct dalcs_arena work = {0};
    enum dalcs_status status = DALCS_OK;
    for (int d = 0; d < r->n_devices && status == DALCS_OK; d++) {
        if (d % DEVICES_AT_A_TIME == 0) {
            const int n =
                r->n_devices - d < DEVICES_AT_A_TIME ? r->n_devices - d : DEVICES_AT_A_TIME;
            dalcs_arena_finish(&work);
            status = dalcs_arena_reserve(&work, (size_t)n * BYTES_EACH);
        }
        struct dalcs_current current = {0};
        const int system = l->topology.device_component[d];
        if (status == DALCS_OK && system >= 0 && has_own_current(l, d)) {
            status = dalcs_layout_current(l, &network->system[system], d, &work, &current);
        }
        r->start[d + 1] = r->start[d] + current.n_terms;
        for (int k = 0; k < current.n_terms && r->term != NULL && status == DALCS_OK; k++) {
            r->term[r->start[d] + k] =
                (struct dalcs_readout_term){current.term[k].index, current.term[k].coefficient};
        }
    }
    dalcs_arena_finish(&work);
    return status;
}

static enum dalcs_status fill(struct dalcs_readout *r, const struct dalcs_network *network,
                              const struct dalcs_layout *l, struct dalcs_arena *arena) {
    for (int n = 0; n < r->n_nodes; n++) {
        r->node_column[n] = dalcs_stamp_node_column(l, n);
    }
    for (int d = 0; d < r->n_devices; d++) {
        r->device_system[d] = l->topology.device_component[d];
        r->first_pair[d] = l->pair[d];
    }
    DALCS_TRY(go_through(r, network, l));
    r->term = dalcs_arena_alloc(arena, (size_t)r->start[r->n_devices], sizeof(*r->term));
    return r->term != NULL ? go_through(r, network, l) : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_readout_build(struct dalcs_network *network,
                                      const struct dalcs_layout *layout) {
    struct dalcs_arena *arena = &network->arena;
    struct dalcs_readout *r = dalcs_arena_alloc(arena, 1, sizeof(*r));
    if (r == NULL) {
        return DALCS_E_NOMEM;
    }
    r->n_nodes = layout->circuit->n_nodes;
    r->n_devices = layout->circuit->n_devices;
    const size_t n_devices = (size_t)r->n_devices;
    r->node_column = dalcs_arena_alloc(arena, (size_t)r->n_nodes, sizeof(int));
    r->device_system = dalcs_arena_alloc(arena, n_devices, sizeof(int));
    r->first_pair = dalcs_arena_alloc(arena, n_devices, sizeof(int));
    r->start = dalcs_arena_alloc(arena, n_devices + 1, sizeof(int));
    if (r->node_column == NULL || r->device_system == NULL || r->first_pair == NULL ||
        r->start == NULL) {
        return DALCS_E_NOMEM;
    }
    const enum dalcs_status status = fill(r, network, layout, arena);
    network->readout = status == DALCS_OK ? r : NULL;
    return status;
}

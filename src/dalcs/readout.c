/* readout.c - the columns of nodes and currents, kept from the layout. */
#include "readout.h"

#include "current.h"
#include "stamp.h"

#include <stdlib.h>

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

struct terms {
    struct dalcs_readout_term *term; /* heap */
    size_t n, capacity;
    struct dalcs_arena arena; /* work */
};

static enum dalcs_status add_current(const struct dalcs_layout *l,
                                     const struct dalcs_network *network, int device,
                                     struct terms *all) {
    const int system = l->topology.device_component[device];
    if (system < 0 || !has_own_current(l, device)) {
        return DALCS_OK;
    }
    struct dalcs_current current = {0};
    enum dalcs_status status =
        dalcs_layout_current(l, &network->system[system], device, &all->arena, &current);
    if (status == DALCS_OK) {
        status = dalcs_grow(&all->term, &all->capacity, all->n + (size_t)current.n_terms,
                            sizeof *all->term);
    }
    for (int k = 0; k < current.n_terms && status == DALCS_OK; k++) {
        all->term[all->n++] =
            (struct dalcs_readout_term){current.term[k].index, current.term[k].coefficient};
    }
    return status;
}

static enum dalcs_status fill(struct dalcs_readout *r, const struct dalcs_network *network,
                              const struct dalcs_layout *l, struct terms *all) {
    for (int n = 0; n < r->n_nodes; n++) {
        r->node_column[n] = dalcs_stamp_node_column(l, n);
    }
    for (int d = 0; d < r->n_devices; d++) {
        r->device_system[d] = l->topology.device_component[d];
        r->first_pair[d] = l->pair[d];
        DALCS_TRY(add_current(l, network, d, all));
        r->start[d + 1] = (int)all->n;
    }
    return DALCS_OK;
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
    struct terms all = {0};
    enum dalcs_status status = fill(r, network, layout, &all);
    if (status == DALCS_OK) {
        r->term = dalcs_arena_alloc(arena, all.n, sizeof(*r->term));
        status = r->term != NULL ? DALCS_OK : DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < all.n && status == DALCS_OK; k++) {
        r->term[k] = all.term[k];
    }
    free(all.term);
    dalcs_arena_finish(&all.arena);
    network->readout = status == DALCS_OK ? r : NULL;
    return status;
}

/* idle_sources.c - the loops of V sources of a circuit whose values change. */
#include "idle_sources.h"

#include "memory.h"
#include "source_conflicts.h"

#include <stdlib.h>
#include <string.h>

/* Into idle[n_devices]: those that are no signal's short. */
static enum dalcs_status mark(const struct dalcs_circuit *circuit, bool *idle) {
    bool *wants_none = dalcs_alloc((size_t)circuit->n_devices, sizeof(*wants_none));
    if (wants_none == NULL) {
        return DALCS_E_NOMEM;
    }
    memset(idle, 0, (size_t)circuit->n_devices * sizeof(*idle));
    const enum dalcs_status status = dalcs_source_mark_idle(circuit, wants_none, idle);
    free(wants_none);
    return status;
}

enum dalcs_status dalcs_idle_sources_find(struct dalcs_idle_sources *idle,
                                          const struct dalcs_circuit *circuit) {
    *idle = (struct dalcs_idle_sources){0};
    idle->was = dalcs_alloc((size_t)circuit->n_devices, sizeof(bool));
    idle->is = dalcs_alloc((size_t)circuit->n_devices, sizeof(bool));
    enum dalcs_status status = idle->was == NULL || idle->is == NULL ? DALCS_E_NOMEM : DALCS_OK;
    if (status == DALCS_OK) {
        status = mark(circuit, idle->was);
    }
    bool any = false;
    for (int d = 0; d < circuit->n_devices && status == DALCS_OK; d++) {
        any = any || idle->was[d];
    }
    if (!any) {
        dalcs_idle_sources_finish(idle);
    }
    return status;
}

enum dalcs_status dalcs_idle_sources_compare(const struct dalcs_idle_sources *idle,
                                             const struct dalcs_circuit *circuit, bool *differ) {
    *differ = false;
    if (idle->was == NULL) {
        return DALCS_OK;
    }
    DALCS_TRY(mark(circuit, idle->is));
    for (int d = 0; d < circuit->n_devices; d++) {
        *differ = *differ || idle->was[d] != idle->is[d];
    }
    return DALCS_OK;
}

void dalcs_idle_sources_finish(struct dalcs_idle_sources *idle) {
    free(idle->was);
    free(idle->is);
    *idle = (struct dalcs_idle_sources){0};
}

/* kept_modes.c - the modes of an engine, handed on to another one. */
#include "kept_modes.h"

#include <stdlib.h>
#include <string.h>

void dalcs_kept_modes_finish(struct dalcs_kept_modes *kept) {
    for (int i = 0; i < kept->n_systems; i++) {
        free(kept->mode[i]);
    }
    free(kept->mode);
    free(kept->n_pairs);
    *kept = (struct dalcs_kept_modes){0};
}

enum dalcs_status dalcs_kept_modes_take(struct dalcs_kept_modes *kept,
                                        const struct dalcs_euler *e) {
    dalcs_kept_modes_finish(kept);
    kept->mode = dalcs_alloc((size_t)e->n_components, sizeof *kept->mode);
    kept->n_pairs = dalcs_alloc((size_t)e->n_components, sizeof *kept->n_pairs);
    if (kept->mode == NULL || kept->n_pairs == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < e->n_components; i++) {
        const struct dalcs_osnsp *p = &e->component[i].osnsp;
        kept->mode[i] = dalcs_alloc((size_t)p->n_words, sizeof(uint64_t));
        if (kept->mode[i] == NULL) {
            return DALCS_E_NOMEM;
        }
        memcpy(kept->mode[i], p->mode, (size_t)p->n_words * sizeof(uint64_t));
        kept->n_pairs[i] = p->system->n_pairs;
        kept->n_systems = i + 1;
    }
    return DALCS_OK;
}

void dalcs_kept_modes_hand_on(const struct dalcs_kept_modes *kept, struct dalcs_euler *e) {
    bool same = kept->n_systems == e->n_components;
    for (int i = 0; i < e->n_components && same; i++) {
        same = kept->n_pairs[i] == e->component[i].system->n_pairs;
    }
    for (int i = 0; i < e->n_components && same; i++) {
        struct dalcs_osnsp *p = &e->component[i].osnsp;
        memcpy(p->mode, kept->mode[i], (size_t)p->n_words * sizeof(uint64_t));
    }
}

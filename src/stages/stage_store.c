/* stage_store.c - maps go from run to run as they are. */
#include "stage_store.h"

#include "stage_workshop.h"
#include "stages_internal.h"

#include <stdlib.h>
#include <string.h>

/* Of one part: its stages, and a copy of what else its maps depend on. */
struct dalcs_stage_left {
    bool is_there;
    struct dalcs_stages stages;
    int n_waves, n_functions;
    struct dalcs_excitation_function *function; /* [n_functions] */
    double *constant;                           /* [n_inputs] */
};

static void drop(struct dalcs_stage_left *left) {
    if (left->is_there) {
        dalcs_stages_finish(&left->stages);
    }
    free(left->function);
    free(left->constant);
    *left = (struct dalcs_stage_left){.is_there = false};
}

enum dalcs_status dalcs_stage_store_setup(struct dalcs_stage_store *store, int n) {
    *store = (struct dalcs_stage_store){.n = n};
    store->left = dalcs_alloc((size_t)n, sizeof *store->left);
    return store->left != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

void dalcs_stage_store_finish(struct dalcs_stage_store *store) {
    for (int k = 0; store->left != NULL && k < store->n; k++) {
        drop(&store->left[k]);
    }
    free(store->left);
    *store = (struct dalcs_stage_store){.n = 0};
}

static bool is_same_function(const struct dalcs_excitation_function *a,
                             const struct dalcs_excitation_function *b) {
    return a->input == b->input && a->shape == b->shape && a->decay == b->decay &&
           a->omega == b->omega && a->degree == b->degree;
}

static bool is_alike(const struct dalcs_stage_left *left, const struct dalcs_stages *stages) {
    const struct dalcs_stages *of = &left->stages;
    const struct dalcs_excitation *e = stages->excitation;
    bool is = of->system == stages->system && of->method == stages->method &&
              of->dense_limit == stages->dense_limit && of->rcond_min == stages->rcond_min &&
              of->unseen == stages->unseen && of->layout.n_fixed == stages->layout.n_fixed &&
              left->n_waves == e->n_waves && left->n_functions == e->n_functions;
    for (int f = 0; f < left->n_functions && is; f++) {
        is = is_same_function(&left->function[f], &e->function[f]);
    }
    for (int i = 0; i < stages->system->n_inputs && is; i++) {
        is = left->constant[i] == e->constant[i];
    }
    return is;
}

void dalcs_stage_store_take(struct dalcs_stage_store *store, int part,
                            struct dalcs_stages *stages) {
    struct dalcs_stage_left *left = &store->left[part];
    if (left->is_there && is_alike(left, stages)) {
        const struct dalcs_stage_cache own = stages->cache;
        stages->cache = left->stages.cache;
        stages->cache.factorizations = stages->cache.cache_hits = 0;
        left->stages.cache = own;
        stages->workshop = left->stages.workshop;
        left->stages.workshop = NULL;
        if (stages->workshop != NULL) {
            stages->workshop->stages = stages;
        }
        for (struct dalcs_stage_entry *e = stages->cache.newest; e != NULL; e = e->older) {
            e->note = 0;
        }
    }
    drop(left);
}

/* A system of smooth sources has other equations in each step. */
static bool is_kept(const struct dalcs_stages *stages) {
    return dalcs_stages_have_maps(stages) && stages->system->n_smooth == 0;
}

void dalcs_stage_store_put(struct dalcs_stage_store *store, int part, struct dalcs_stages *stages) {
    struct dalcs_stage_left *left = &store->left[part];
    const struct dalcs_excitation *e = stages->excitation;
    const size_t n_inputs = (size_t)stages->system->n_inputs;
    const size_t n_functions = (size_t)e->n_functions;
    drop(left);
    if (is_kept(stages)) {
        left->function = dalcs_alloc(n_functions, sizeof *left->function);
        left->constant = dalcs_alloc(n_inputs, sizeof *left->constant);
    }
    if (left->function == NULL || left->constant == NULL) { /* they are made again */
        dalcs_stages_finish(stages);
        drop(left);
        return;
    }
    memcpy(left->function, e->function, n_functions * sizeof *left->function);
    memcpy(left->constant, e->constant, n_inputs * sizeof *left->constant);
    left->n_waves = e->n_waves;
    left->n_functions = e->n_functions;
    left->stages = *stages;
    left->is_there = true;
    *stages = (struct dalcs_stages){0};
}

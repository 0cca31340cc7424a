/* stage_cache.c - entries by (mode, h), least recently used out first. */
#include "stage_update.h"
#include "stage_workshop.h"

#include <stdlib.h>
#include <string.h>

/* The latest entries are looked at one by one before all are asked. */
enum { RECENT = 3 };

static void unlink_entry(struct dalcs_stages *stages, struct dalcs_stage_entry *e) {
    *(e->newer != NULL ? &e->newer->older : &stages->cache.newest) = e->older;
    *(e->older != NULL ? &e->older->newer : &stages->cache.oldest) = e->newer;
    e->newer = NULL;
    e->older = NULL;
}

static void link_newest(struct dalcs_stages *stages, struct dalcs_stage_entry *e) {
    e->older = stages->cache.newest;
    e->newer = NULL;
    *(stages->cache.newest != NULL ? &stages->cache.newest->newer : &stages->cache.oldest) = e;
    stages->cache.newest = e;
}

static void offer_as_base(struct dalcs_stages *stages, struct dalcs_stage_entry *e) {
    e->as_base.older = stages->cache.newest_base;
    if (stages->cache.newest_base != NULL) {
        stages->cache.newest_base->as_base.newer = e;
    }
    stages->cache.newest_base = e;
}

static void withdraw_as_base(struct dalcs_stages *stages, struct dalcs_stage_entry *e) {
    if (e->as_base.newer != NULL) {
        e->as_base.newer->as_base.older = e->as_base.older;
    } else if (stages->cache.newest_base == e) {
        stages->cache.newest_base = e->as_base.older;
    }
    if (e->as_base.older != NULL) {
        e->as_base.older->as_base.newer = e->as_base.newer;
    }
}

static void entry_destroy(struct dalcs_stages *stages, struct dalcs_stage_entry *e) {
    withdraw_as_base(stages, e);
    dalcs_stage_factors_destroy(stages, e->factors);
    free(e->map);
    free(e);
}

void dalcs_stages_hold(struct dalcs_stage_entry *entry) {
    entry->as_base.n_holders++;
}

/* The last one destroys it. */
void dalcs_stages_release(struct dalcs_stages *stages, struct dalcs_stage_entry *entry) {
    if (--entry->as_base.n_holders == 0) {
        stages->cache.bytes -= entry->bytes;
        entry_destroy(stages, entry);
    }
}

static void remove_entry(struct dalcs_stages *stages, struct dalcs_stage_entry *e) {
    HASH_DELETE(hh, stages->cache.entries, e);
    unlink_entry(stages, e);
    dalcs_stages_release(stages, e);
}

static void remove_all(struct dalcs_stages *stages) {
    while (stages->cache.oldest != NULL) {
        remove_entry(stages, stages->cache.oldest);
    }
}

void dalcs_stages_forget(struct dalcs_stages *stages) {
    remove_all(stages);
    dalcs_stage_plan_destroy(stages);
    dalcs_stage_workshop_destroy(stages->workshop);
    stages->plan = NULL;
    stages->workshop = NULL;
}

/* An entry with what all have, in one piece: a short run makes a handful. Returns the bytes of it. */
static size_t lay_out(const struct dalcs_stages *stages, struct dalcs_stage_entry *e,
                      void *storage) {
    size_t used = 0;
    (void)dalcs_carve(storage, &used, 1, sizeof(*e));
    size_t n_equations = (size_t)dalcs_system_n_equations(stages->system);
    e->key = dalcs_carve(storage, &used, (size_t)stages->n_words + 1, sizeof(*e->key));
    e->natural = dalcs_carve(storage, &used, 2 * n_equations, sizeof(*e->natural));
    e->on = dalcs_carve(storage, &used, (size_t)stages->system->n_pairs, sizeof(*e->on));
    return used;
}

static struct dalcs_stage_entry *entry_alloc(const struct dalcs_stages *stages) {
    struct dalcs_stage_entry laid_out = {.as_base.n_holders = 1};
    struct dalcs_stage_entry *e = dalcs_alloc(1, lay_out(stages, &laid_out, NULL));
    if (e != NULL) {
        lay_out(stages, &laid_out, e);
        *e = laid_out;
    }
    return e;
}

/* Builds the entry for stages->cache.key. */
static enum dalcs_status entry_create(struct dalcs_stages *stages, double h, bool of_its_own,
                                      struct dalcs_stage_entry **entry) {
    struct dalcs_stage_entry *e = entry_alloc(stages);
    *entry = NULL;
    if (e == NULL) {
        return DALCS_E_NOMEM;
    }
    int n_pairs = stages->system->n_pairs;
    e->h = h;
    memcpy(e->key, stages->cache.key, ((size_t)stages->n_words + 1) * sizeof(*e->key));
    e->mode = e->key;
    for (int d = 0; d < n_pairs; d++) {
        if (dalcs_stage_is_on(e, d)) {
            e->on[e->n_on++] = d;
        }
    }
    e->n = dalcs_system_n_equations(stages->system) + e->n_on;
    enum dalcs_status status = e->n <= stages->dense_limit
                                   ? dalcs_stage_map_build(stages, e)
                                   : dalcs_stage_factors_build(stages, e, of_its_own);
    stages->cache.factorizations += dalcs_stage_is_update(e) ? 0 : 1;
    for (int c = 0, n = dalcs_system_n_equations(stages->system); c < n; c++) {
        e->natural[n + c] = 1.0 / e->natural[c];
    }
    if (status != DALCS_OK) {
        entry_destroy(stages, e);
        return status;
    }
    e->bytes += sizeof(*e) + ((size_t)stages->n_words + 1) * sizeof(uint64_t) +
                (size_t)n_pairs * sizeof(int);
    if (dalcs_stage_update_can_be_base(e)) {
        offer_as_base(stages, e);
    }
    *entry = e;
    return DALCS_OK;
}

static bool is_key(const struct dalcs_stages *stages, const struct dalcs_stage_entry *e,
                   const uint64_t *mode, double h) {
    return e->h == h && dalcs_mode_is(e->mode, mode, stages->n_words);
}

static void set_key(struct dalcs_stages *stages, const uint64_t *mode, double h) {
    size_t words = (size_t)stages->n_words;
    memcpy(stages->cache.key, mode, words * sizeof(*mode));
    memcpy(stages->cache.key + words, &h, sizeof(h));
}

struct dalcs_stage_entry *dalcs_stages_find(struct dalcs_stages *stages, const uint64_t *mode,
                                            double h) {
    set_key(stages, mode, h);
    struct dalcs_stage_entry *e;
    HASH_FIND(hh, stages->cache.entries, stages->cache.key,
              ((size_t)stages->n_words + 1) * sizeof(*mode), e);
    return e;
}

enum dalcs_status dalcs_stages_get(struct dalcs_stages *stages, const uint64_t *mode, double h,
                                   struct dalcs_stage_entry **entry) {
    size_t words = (size_t)stages->n_words;
    struct dalcs_stage_entry *e = stages->cache.newest;
    for (int k = 0; k < RECENT && e != NULL && !is_key(stages, e, mode, h); k++) {
        e = e->older;
    }
    if (e == NULL || !is_key(stages, e, mode, h)) {
        e = dalcs_stages_find(stages, mode, h);
    }
    bool is_spent = e != NULL && dalcs_stage_update_is_spent(stages, e);
    if (e != NULL && !is_spent) {
        stages->cache.cache_hits++;
        if (e != stages->cache.newest) {
            unlink_entry(stages, e);
            link_newest(stages, e);
        }
        *entry = e;
        return DALCS_OK;
    }
    set_key(stages, mode, h);
    if (is_spent) {
        remove_entry(stages, e);
    }
    DALCS_TRY(entry_create(stages, h, is_spent, &e));
    HASH_ADD_KEYPTR(hh, stages->cache.entries, e->key, (words + 1) * sizeof(*mode), e);
    if (e->hh.tbl == NULL) { /* uthash ran out of memory and left the entry out */
        entry_destroy(stages, e);
        return DALCS_E_NOMEM;
    }
    link_newest(stages, e);
    stages->cache.bytes += e->bytes;
    while (stages->cache.bytes > stages->cache.most_bytes && stages->cache.oldest != e) {
        remove_entry(stages, stages->cache.oldest);
    }
    *entry = e;
    return DALCS_OK;
}

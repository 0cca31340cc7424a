/* mode_cache.c - factors by (mode, sigma), bounded in bytes, least recently used out first. */
#include "osnsp_internal.h"

#include <stdlib.h>
#include <string.h>

/* Step sizes remembered whatever they hold: the regular step, the pieces of a few edges, the micro-steps. */
enum { FEW_FORMS = 32 };

static void unlink_entry(struct dalcs_osnsp *p, struct dalcs_mode_entry *e) {
    *(e->newer != NULL ? &e->newer->older : &p->cache.newest) = e->older;
    *(e->older != NULL ? &e->older->newer : &p->cache.oldest) = e->newer;
    e->newer = NULL;
    e->older = NULL;
}

static void link_newest(struct dalcs_osnsp *p, struct dalcs_mode_entry *e) {
    e->older = p->cache.newest;
    e->newer = NULL;
    *(p->cache.newest != NULL ? &p->cache.newest->newer : &p->cache.oldest) = e;
    p->cache.newest = e;
}

static void entry_destroy(struct dalcs_mode_entry *e) {
    dalcs_lu_finish(&e->lu);
    free(e->scale_of);
    if (e->whole != NULL) {
        dalcs_whole_finish(e->whole);
        free(e->whole);
    }
    free(e->map);
    free(e);
}

static void remove_entry(struct dalcs_osnsp *p, struct dalcs_mode_entry *e) {
    HASH_DELETE(hh, p->cache.entries, e);
    unlink_entry(p, e);
    p->cache.entry_bytes -= e->bytes;
    entry_destroy(e);
}

/* Never below a handful: the entries that one solve holds at a time stay valid. */
enum { MIN_ENTRIES = 4 };

static void make_room(struct dalcs_osnsp *p, const struct dalcs_mode_entry *keep) {
    while (p->cache.entry_bytes > p->options.cache_bytes &&
           HASH_COUNT(p->cache.entries) > MIN_ENTRIES && p->cache.oldest != keep) {
        remove_entry(p, p->cache.oldest);
    }
}

void dalcs_modes_grew(struct dalcs_osnsp *p, struct dalcs_mode_entry *entry, size_t bytes) {
    entry->bytes += bytes;
    p->cache.entry_bytes += bytes;
    make_room(p, entry);
}

static void remove_form(struct dalcs_osnsp *p, int k) {
    for (struct dalcs_mode_entry *e = p->cache.newest; e != NULL;) {
        struct dalcs_mode_entry *next = e->older;
        if ((uint32_t)(e->key[p->n_words] >> 8) == p->cache.form_id[k]) {
            remove_entry(p, e);
        }
        e = next;
    }
    p->cache.form_bytes -= dalcs_step_form_bytes(p->cache.form[k]);
    dalcs_step_form_finish(p->cache.form[k]);
    free(p->cache.form[k]);
}

/* For one more form. */
static void make_room_for_form(struct dalcs_osnsp *p, size_t bytes) {
    struct dalcs_mode_cache *c = &p->cache;
    while (c->n_forms == DALCS_MOST_FORMS ||
           (c->n_forms >= FEW_FORMS &&
            c->form_bytes + bytes + c->entry_bytes > p->options.cache_bytes)) {
        remove_form(p, --c->n_forms);
    }
    c->form_bytes += bytes;
}

enum dalcs_status dalcs_forms_get(struct dalcs_osnsp *p, double sigma) {
    int k = 0;
    while (k < p->cache.n_forms && p->cache.form[k]->sigma != sigma) {
        k++;
    }
    struct dalcs_step_form *form;
    uint32_t id;
    if (k < p->cache.n_forms) {
        form = p->cache.form[k];
        id = p->cache.form_id[k];
    } else {
        form = dalcs_alloc(1, sizeof(*form));
        if (form == NULL) {
            return DALCS_E_NOMEM;
        }
        enum dalcs_status status = dalcs_step_form_build(form, p->system, sigma);
        if (status != DALCS_OK) {
            free(form);
            return status;
        }
        id = p->cache.next_form_id++;
        make_room_for_form(p, dalcs_step_form_bytes(form));
        k = p->cache.n_forms++;
    }
    memmove(p->cache.form + 1, p->cache.form, (size_t)k * sizeof(*p->cache.form));
    memmove(p->cache.form_id + 1, p->cache.form_id, (size_t)k * sizeof(*p->cache.form_id));
    p->cache.form[0] = form;
    p->cache.form_id[0] = id;
    return DALCS_OK;
}

/* Of p->work.key and p->mode, without factors; its key and list are behind it. */
static struct dalcs_mode_entry *entry_alloc(const struct dalcs_osnsp *p) {
    int n_pairs = p->system->n_pairs;
    int n_on = 0;
    for (int d = 0; d < n_pairs; d++) {
        n_on += dalcs_osnsp_is_on(p, d) ? 1 : 0;
    }
    struct dalcs_mode_entry *e;
    size_t key_bytes = ((size_t)p->n_words + 1) * sizeof(*e->key);
    size_t bytes = sizeof(*e) + key_bytes + (size_t)n_on * sizeof(*e->on);
    e = dalcs_alloc(1, bytes);
    if (e == NULL) {
        return NULL;
    }
    e->bytes = bytes;
    e->key = (void *)(e + 1);
    memcpy(e->key, p->work.key, key_bytes);
    e->on = (void *)(e->key + p->n_words + 1);
    for (int d = 0; d < n_pairs; d++) {
        if (dalcs_osnsp_is_on(p, d)) {
            e->on[e->n_on++] = d;
        }
    }
    return e;
}

static enum dalcs_status entry_create(struct dalcs_osnsp *p, enum dalcs_mode_kind kind,
                                      struct dalcs_mode_entry **entry) {
    struct dalcs_mode_entry *e = entry_alloc(p);
    *entry = NULL;
    if (e == NULL) {
        return DALCS_E_NOMEM;
    }
    p->counters.factorizations++;
    enum dalcs_status status =
        kind == DALCS_PLAIN ? dalcs_modes_factor_plain(p, e) : dalcs_proximal_factor(p, e);
    if (status == DALCS_SINGULAR) {
        e->singular = true;
        status = DALCS_OK;
    }
    if (status != DALCS_OK) {
        entry_destroy(e);
        return status;
    }
    e->bytes += dalcs_lu_bytes(&e->lu) + (size_t)e->lu.n * (2 * sizeof(int) + sizeof(double));
    *entry = e;
    return DALCS_OK;
}

static bool is_key(const uint64_t *key, const uint64_t *mode, size_t words, uint64_t last_word) {
    uint64_t different = key[words] ^ last_word;
    for (size_t i = 0; i < words; i++) {
        different |= key[i] ^ mode[i];
    }
    return different == 0;
}

enum dalcs_status dalcs_modes_get(struct dalcs_osnsp *p, enum dalcs_mode_kind kind,
                                  struct dalcs_mode_entry **entry) {
    size_t words = (size_t)p->n_words;
    uint64_t last_word =
        (uint64_t)p->cache.form_id[0] << 8 | (uint64_t)p->asks.insists << 7 | (uint64_t)kind;
    if (p->cache.newest != NULL && is_key(p->cache.newest->key, p->mode, words, last_word)) {
        *entry = p->cache.newest; /* as in most steps */
        p->counters.cache_hits++;
        return DALCS_OK;
    }
    memcpy(p->work.key, p->mode, words * sizeof(*p->work.key));
    p->work.key[words] = last_word;
    size_t key_bytes = (words + 1) * sizeof(*p->work.key);
    struct dalcs_mode_entry *e;
    HASH_FIND(hh, p->cache.entries, p->work.key, key_bytes, e);
    if (e != NULL) {
        p->counters.cache_hits++;
        unlink_entry(p, e);
        link_newest(p, e);
    } else {
        DALCS_TRY(entry_create(p, kind, &e));
        HASH_ADD_KEYPTR(hh, p->cache.entries, e->key, key_bytes, e);
        if (e->hh.tbl == NULL) { /* uthash ran out of memory and left the entry out */
            entry_destroy(e);
            return DALCS_E_NOMEM;
        }
        link_newest(p, e);
        p->cache.entry_bytes += e->bytes;
        make_room(p, e);
    }
    *entry = e;
    return DALCS_OK;
}

void dalcs_modes_finish(struct dalcs_osnsp *p) {
    while (p->cache.oldest != NULL) {
        remove_entry(p, p->cache.oldest);
    }
    for (int k = 0; k < p->cache.n_forms; k++) {
        dalcs_step_form_finish(p->cache.form[k]);
        free(p->cache.form[k]);
    }
    p->cache.n_forms = 0;
    dalcs_lu_patterns_finish(&p->cache.patterns, &p->cache.klu);
    free(p->cache.matched_row);
    p->cache.matched_row = NULL;
    p->cache.n_matched = 0;
}

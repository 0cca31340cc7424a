/* names.c - a table from names to small integers, and the search for a mistyped name.
 *
 * The table is a uthash; running out of memory in it is reported, not fatal. */
#include "names.h"

#include <stdint.h>
#include <string.h>

#define HASH_NONFATAL_OOM 1
/* Expands inside dalcs_names_add, where the flag lives. */
#define uthash_nonfatal_oom(element)                                                               \
    do {                                                                                           \
        (void)(element);                                                                           \
        out_of_memory = true;                                                                      \
    } while (0)
#include <uthash.h>

struct dalcs_names_entry {
    const char *name;
    int value;
    UT_hash_handle hh;
};

/* Longer names are not searched for a near one: nobody mistypes them by two letters and the search
 * keeps its rows on the stack. */
enum { NEAREST_MAX_LENGTH = 63 };

int dalcs_names_find(const struct dalcs_names *names, const char *name) {
    struct dalcs_names_entry *entry = NULL;
    HASH_FIND_STR(names->head, name, entry);
    return entry != NULL ? entry->value : -1;
}

enum dalcs_status dalcs_names_add(struct dalcs_names *names, const char *name, int value) {
    bool out_of_memory = false;
    struct dalcs_names_entry *entry = dalcs_arena_alloc(&names->arena, 1, sizeof *entry);
    if (entry == NULL) {
        return DALCS_E_NOMEM;
    }
    entry->name = name;
    entry->value = value;
    HASH_ADD_KEYPTR(hh, names->head, entry->name, strlen(entry->name), entry);
    return out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
}

static int least(int a, int b, int c) {
    const int smaller = a < b ? a : b;
    return smaller < c ? smaller : c;
}

/* Damerau-Levenshtein distance (neighbours may be swapped once), a table with three live rows. */
static int distance(const char *a, int length_a, const char *b, int length_b) {
    int row[3][NEAREST_MAX_LENGTH + 1];
    for (int j = 0; j <= length_b; j++) {
        row[0][j] = j;
    }
    for (int i = 1; i <= length_a; i++) {
        int *now = row[i % 3];
        const int *above = row[(i + 2) % 3];
        const int *above2 = row[(i + 1) % 3];
        now[0] = i;
        for (int j = 1; j <= length_b; j++) {
            const int change = above[j - 1] + (a[i - 1] != b[j - 1]);
            now[j] = least(above[j] + 1, now[j - 1] + 1, change);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] &&
                above2[j - 2] + 1 < now[j]) {
                now[j] = above2[j - 2] + 1;
            }
        }
    }
    return row[length_a % 3][length_b];
}

/* Is `candidate` a likelier meaning of `name` than a distance of *best? Then *best shrinks. */
static bool improves(const char *candidate, const char *name, int length, int *best) {
    const size_t n = strlen(candidate);
    if (n > NEAREST_MAX_LENGTH) {
        return false;
    }
    const int candidate_length = (int)n;
    const int longer = candidate_length > length ? candidate_length : length;
    const int difference = candidate_length > length ? candidate_length - length
                                                     : length - candidate_length;
    if (difference >= *best) {
        return false;
    }
    const int d = distance(candidate, candidate_length, name, length);
    if (d >= *best || 3 * d > longer) {
        return false;
    }
    *best = d;
    return true;
}

const char *dalcs_names_nearest(const struct dalcs_names *names, const char *name) {
    const size_t length = strlen(name);
    if (length > NEAREST_MAX_LENGTH) {
        return NULL;
    }
    const char *nearest = NULL;
    int best = 3;
    const struct dalcs_names_entry *entry = names->head;
    for (; entry != NULL; entry = entry->hh.next) {
        if (improves(entry->name, name, (int)length, &best)) {
            nearest = entry->name;
        }
    }
    return nearest;
}

const char *dalcs_names_nearest_of(const char *const *candidate, size_t n, const char *name) {
    const size_t length = strlen(name);
    if (length > NEAREST_MAX_LENGTH) {
        return NULL;
    }
    const char *nearest = NULL;
    int best = 3;
    for (size_t k = 0; k < n; k++) {
        if (improves(candidate[k], name, (int)length, &best)) {
            nearest = candidate[k];
        }
    }
    return nearest;
}

const char *dalcs_names_join(const struct dalcs_names *names, size_t most,
                             struct dalcs_arena *arena) {
    if (HASH_COUNT(names->head) > most) {
        return NULL;
    }
    const char *list = NULL;
    const struct dalcs_names_entry *entry = names->head;
    for (; entry != NULL; entry = entry->hh.next) {
        list = list == NULL ? entry->name : dalcs_arena_printf(arena, "%s, %s", list, entry->name);
        if (list == NULL) {
            return NULL;
        }
    }
    return list;
}

void dalcs_names_finish(struct dalcs_names *names) {
    /* Frees the table only: the entries are the arena's. */
    HASH_CLEAR(hh, names->head);
    dalcs_arena_finish(&names->arena);
    names->head = NULL;
}

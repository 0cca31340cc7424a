/* names.c - a table from names to small integers, and the search for a mistyped name. */
#include "names.h"

#define HASH_NONFATAL_OOM 1
#include <uthash.h>

#include <stdlib.h>
#include <string.h>

struct dalcs_names_entry {
    UT_hash_handle hh;
    const char *name;
    int value;
};

/* Longer names are not searched for a near one: nobody mistypes them by two letters and the search
 * keeps its rows on the stack. */
enum { NEAREST_MAX_LENGTH = 63 };

int dalcs_names_find(const struct dalcs_names *names, const char *name) {
    struct dalcs_names_entry *entry;
    HASH_FIND_STR(names->entry, name, entry);
    return entry == NULL ? -1 : entry->value;
}

enum dalcs_status dalcs_names_add(struct dalcs_names *names, const char *name, int value) {
    struct dalcs_names_entry *entry = dalcs_arena_alloc(&names->arena, 1, sizeof *entry);
    if (entry == NULL) {
        return DALCS_E_NOMEM;
    }
    entry->name = name;
    entry->value = value;
    HASH_ADD_KEYPTR(hh, names->entry, name, strlen(name), entry);
    if (entry->hh.tbl == NULL) { /* uthash ran out of memory and left the entry out */
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

static const struct dalcs_names_entry *next_of(const struct dalcs_names_entry *entry) {
    return entry->hh.next;
}

/* ---- Mistyped names ------------------------------------------------------------------------ */

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

/* The best candidate so far. */
struct nearest {
    const char *name; /* NULL: none */
    int distance;
    size_t prefix; /* bytes shared with the name from its start: decides between equals */
};

static size_t common_prefix(const char *a, const char *b) {
    size_t n = 0;
    while (a[n] != '\0' && a[n] == b[n]) {
        n++;
    }
    return n;
}

static void consider(struct nearest *nearest, const char *candidate, const char *name,
                     size_t length) {
    const size_t n = strlen(candidate);
    const size_t longer = n > length ? n : length;
    const size_t difference = longer - (n > length ? length : n);
    if (longer > NEAREST_MAX_LENGTH || difference > 2) {
        return;
    }
    const int d = distance(candidate, (int)n, name, (int)length);
    const size_t prefix = common_prefix(candidate, name);
    if (d > 2 || 3 * d > (int)longer) {
        return;
    }
    if (nearest->name == NULL || d < nearest->distance ||
        (d == nearest->distance && prefix > nearest->prefix)) {
        *nearest = (struct nearest){candidate, d, prefix};
    }
}

const char *dalcs_names_nearest(const struct dalcs_names *names, const char *name) {
    struct nearest nearest = {0};
    for (const struct dalcs_names_entry *e = names->entry; e != NULL; e = next_of(e)) {
        consider(&nearest, e->name, name, strlen(name));
    }
    return nearest.name;
}

const char *dalcs_names_nearest_of(const char *const *candidate, size_t n, const char *name) {
    struct nearest nearest = {0};
    for (size_t k = 0; k < n; k++) {
        consider(&nearest, candidate[k], name, strlen(name));
    }
    return nearest.name;
}

const char *dalcs_names_join(const struct dalcs_names *names, size_t most,
                             struct dalcs_arena *arena) {
    const struct dalcs_names_entry *e = names->entry;
    if (e == NULL || HASH_COUNT(names->entry) > most) {
        return NULL;
    }
    const char *list = e->name;
    for (e = next_of(e); e != NULL && list != NULL; e = next_of(e)) {
        list = dalcs_arena_printf(arena, "%s, %s", list, e->name);
    }
    return list;
}

void dalcs_names_finish(struct dalcs_names *names) {
    HASH_CLEAR(hh, names->entry);
    dalcs_arena_finish(&names->arena);
    *names = (struct dalcs_names){0};
}

/* names.c - a table from names to small integers, and the search for a mistyped name.
 *
 * Open addressing with linear probing, half empty at least. A slot holds the hash beside the place of
 * its entry, so that a name that is not there costs one look into memory, also in a table of a
 * million names, where each look is a cache miss. */
#include "names.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

struct dalcs_names_entry {
    const char *name;
    int value;
};

struct dalcs_names_slot {
    uint32_t hash;
    uint32_t place; /* of the entry, from 1; 0: free */
};

enum { FIRST_SLOTS = 32 };

/* Longer names are not searched for a near one: two wrong letters in one are rare, and the search
 * keeps its rows on the stack. */
enum { NEAREST_MAX_LENGTH = 63 };

/* FNV-1a of 64 bits, folded (G. Fowler, L. C. Noll, K.-P. Vo, RFC 9923), of all but the last
 * character, which counts up in the lowest bits: r10 to r19 are neighbours, and mostly come one after
 * the other. */
static uint32_t hash_of(const char *name) {
    uint64_t hash = 0xCBF29CE484222325U;
    unsigned char last = (unsigned char)*name;
    for (; last != '\0' && name[1] != '\0'; last = (unsigned char)*name) {
        hash = (hash ^ last) * 0x100000001B3U;
        name++;
    }
    return (uint32_t)(hash >> 32 ^ hash) << 4 ^ last;
}

/* The slot of a name, or the free one where it belongs. There is one: the table is never full. */
static struct dalcs_names_slot *slot_of(const struct dalcs_names *names, const char *name,
                                        uint32_t hash) {
    const size_t last = names->n_slots - 1;
    size_t k = hash & last;
    for (; names->slot[k].place != 0; k = (k + 1) & last) {
        if (names->slot[k].hash == hash &&
            strcmp(names->entry[names->slot[k].place - 1].name, name) == 0) {
            break;
        }
    }
    return &names->slot[k];
}

int dalcs_names_find(const struct dalcs_names *names, const char *name) {
    if (names->n == 0) {
        return -1;
    }
    const struct dalcs_names_slot *slot = slot_of(names, name, hash_of(name));
    return slot->place == 0 ? -1 : names->entry[slot->place - 1].value;
}

/* Twice the slots. */
static enum dalcs_status spread(struct dalcs_names *names) {
    const size_t n_slots = names->n_slots == 0 ? FIRST_SLOTS : 2 * names->n_slots;
    struct dalcs_names_slot *slot = NULL;
    size_t capacity = 0;
    DALCS_TRY(dalcs_grow(&slot, &capacity, n_slots, sizeof *slot));
    for (size_t k = 0; k < names->n_slots; k++) {
        const struct dalcs_names_slot old = names->slot[k];
        size_t to = old.hash & (n_slots - 1);
        while (old.place != 0 && slot[to].place != 0) {
            to = (to + 1) & (n_slots - 1);
        }
        slot[to] = old.place != 0 ? old : slot[to];
    }
    free(names->slot);
    names->slot = slot;
    names->n_slots = n_slots;
    return DALCS_OK;
}

enum dalcs_status dalcs_names_find_or_add(struct dalcs_names *names, const char *name, int value,
                                          int *found) {
    if (2 * names->n >= names->n_slots) {
        DALCS_TRY(spread(names));
    }
    DALCS_TRY(dalcs_grow(&names->entry, &names->capacity, names->n + 1, sizeof *names->entry));
    const uint32_t hash = hash_of(name);
    struct dalcs_names_slot *slot = slot_of(names, name, hash);
    if (slot->place == 0) {
        names->entry[names->n++] = (struct dalcs_names_entry){name, value};
        *slot = (struct dalcs_names_slot){hash, (uint32_t)names->n};
    }
    *found = names->entry[slot->place - 1].value;
    return DALCS_OK;
}

enum dalcs_status dalcs_names_add(struct dalcs_names *names, const char *name, int value) {
    int found;
    return dalcs_names_find_or_add(names, name, value, &found);
}

enum dalcs_status dalcs_names_set(struct dalcs_names *names, const char *name, int value) {
    const size_t n = names->n;
    int found;
    const enum dalcs_status status = dalcs_names_find_or_add(names, name, value, &found);
    for (size_t k = 0; status == DALCS_OK && k < n && names->n == n; k++) {
        if (strcmp(names->entry[k].name, name) == 0) {
            names->entry[k].value = value;
        }
    }
    return status;
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
    for (size_t k = 0; k < names->n; k++) {
        consider(&nearest, names->entry[k].name, name, strlen(name));
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

bool dalcs_names_is_inner(const char *name) {
    const char *open = strchr(name, '(');
    return open != NULL && (open == name || open[-1] != '-');
}

size_t dalcs_names_current_of(const char *text) {
    const char *bracket = text[0] == '@' ? strchr(text, '[') : NULL;
    const bool is_current =
        bracket != NULL && (strcmp(bracket, "[i]") == 0 || strcmp(bracket, "[id]") == 0 ||
                            strcmp(bracket, "[current]") == 0);
    return is_current ? (size_t)(bracket - text) - 1 : 0;
}

const char *dalcs_names_join(const struct dalcs_names *names, size_t most,
                             struct dalcs_arena *arena) {
    if (names->n == 0 || names->n > most) {
        return NULL;
    }
    const char *list = names->entry[0].name;
    for (size_t k = 1; k < names->n && list != NULL; k++) {
        list = dalcs_arena_printf(arena, "%s, %s", list, names->entry[k].name);
    }
    return list;
}

void dalcs_names_finish(struct dalcs_names *names) {
    free(names->entry);
    free(names->slot);
    *names = (struct dalcs_names){0};
}

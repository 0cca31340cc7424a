/* names.h - a table from names to small integers: nodes, devices, models by name.
 *
 * Zero-initialise; finish frees everything. Names are borrowed and compared byte by byte. */
#ifndef DALCS_NAMES_H
#define DALCS_NAMES_H

#include "memory.h"

struct dalcs_names {
    struct dalcs_names_entry *entry; /* [n] in the order of insertion */
    size_t n, capacity;
    struct dalcs_names_slot *slot; /* [n_slots], a power of 2 */
    size_t n_slots;
};

/* The value of a name, or -1. */
int dalcs_names_find(const struct dalcs_names *names, const char *name);

/* Adds a name that is not in the table yet; value >= 0. */
enum dalcs_status dalcs_names_add(struct dalcs_names *names, const char *name,
                                  int value) DALCS_MUST_CHECK;

/* The value of a name in *found; one that is not in the table is added first, with this value. */
enum dalcs_status dalcs_names_find_or_add(struct dalcs_names *names, const char *name, int value,
                                          int *found) DALCS_MUST_CHECK;

/* Gives a name this value, whether it is in the table or not. */
enum dalcs_status dalcs_names_set(struct dalcs_names *names, const char *name,
                                  int value) DALCS_MUST_CHECK;

/* The name most like this one, were it mistyped: a distance of at most 2 edits (insert, delete,
 * change, swap neighbours) and at most a third of the length; NULL when there is none. */
const char *dalcs_names_nearest(const struct dalcs_names *names, const char *name);

/* The same among candidate[0..n-1]. */
const char *dalcs_names_nearest_of(const char *const *candidate, size_t n, const char *name);

/* Bytes of the element's name in @name[i], of a diode @name[id] or of a source @name[current], as ngspice calls its current; 0
 * where `text` is something else. The name begins at text + 1. */
size_t dalcs_names_current_of(const char *text);

/* Is it the name of an element or node that nobody has written, such as "rser(c1)"? KiCad's "net-(d1-k)" a person gave. */
bool dalcs_names_is_inner(const char *name);

/* "a, b, c": the names in order of insertion, in `arena`; NULL when the table is empty, has more
 * than `most` names, or memory runs out. */
const char *dalcs_names_join(const struct dalcs_names *names, size_t most,
                             struct dalcs_arena *arena);

void dalcs_names_finish(struct dalcs_names *names);

#endif

/* variables.h - what `set` and `foreach` name, and `$name` in a line. */
#ifndef DALCS_VARIABLES_H
#define DALCS_VARIABLES_H

#include "memory.h"

#include <stdbool.h>

struct dalcs_variable {
    char *name, *value; /* heap; a list has blanks between its items */
};

/* Zero-initialise. */
struct dalcs_variables {
    struct dalcs_variable *variable; /* heap */
    size_t n, capacity;
};

/* NULL: not set. */
const char *dalcs_variables_get(const struct dalcs_variables *variables, const char *name);

enum dalcs_status dalcs_variables_set(struct dalcs_variables *variables, const char *name,
                                      const char *value) DALCS_MUST_CHECK;

/* What stands behind `set`, "name", "name = value", "name = ( a b c )": its name, which may be empty, and its value,
 * both in `text`, which is cut. */
struct dalcs_assignment {
    char *name, *value;
};
struct dalcs_assignment dalcs_variables_split(char *text);

void dalcs_variables_unset(struct dalcs_variables *variables, const char *name);

void dalcs_variables_finish(struct dalcs_variables *variables);

#endif

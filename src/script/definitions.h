/* definitions.h - functions that a script makes: define power(u,i) u*i. */
#ifndef DALCS_DEFINITIONS_H
#define DALCS_DEFINITIONS_H

#include "memory.h"

#include <stdbool.h>

enum { DALCS_MOST_PARAMETERS = 8 };

struct dalcs_definition {
    char *name, *body;                      /* heap */
    char *parameter[DALCS_MOST_PARAMETERS]; /* heap */
    size_t n_parameters;
};

/* Zero-initialise. */
struct dalcs_definitions {
    struct dalcs_definition *definition; /* heap */
    size_t n, capacity;
};

/* With as many parameters; NULL: there is none. */
const struct dalcs_definition *dalcs_definitions_find(const struct dalcs_definitions *all,
                                                      const char *name, size_t n_parameters);

/* "power(u,i) u*i" in lower case, an equal sign before the body or none. DALCS_E_NETLIST: it is not of this form. */
enum dalcs_status dalcs_definitions_add(struct dalcs_definitions *all,
                                        const char *text) DALCS_MUST_CHECK;

/* All of this name; false: there was none. */
bool dalcs_definitions_remove(struct dalcs_definitions *all, const char *name);

void dalcs_definitions_finish(struct dalcs_definitions *all);

#endif

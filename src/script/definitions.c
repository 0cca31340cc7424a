/* definitions.c - a short list of functions. */
#include "definitions.h"

#include <stdlib.h>
#include <string.h>

const struct dalcs_definition *dalcs_definitions_find(const struct dalcs_definitions *all,
                                                      const char *name, size_t n_parameters) {
    for (size_t k = 0; all != NULL && k < all->n; k++) {
        const struct dalcs_definition *d = &all->definition[k];
        if (d->n_parameters == n_parameters && strcmp(d->name, name) == 0) {
            return d;
        }
    }
    return NULL;
}

static void forget(struct dalcs_definition *d) {
    free(d->name);
    free(d->body);
    for (size_t k = 0; k < d->n_parameters; k++) {
        free(d->parameter[k]);
    }
    *d = (struct dalcs_definition){0};
}

/* Without blanks at its ends; NULL: no memory. */
static char *copy_of(const char *text, size_t n) {
    while (n > 0 && (text[0] == ' ' || text[0] == '\t')) {
        text++;
        n--;
    }
    while (n > 0 && (text[n - 1] == ' ' || text[n - 1] == '\t')) {
        n--;
    }
    char *copy = dalcs_alloc(n + 1, 1);
    if (copy != NULL) {
        memcpy(copy, text, n);
    }
    return copy;
}

static enum dalcs_status read_parameters(struct dalcs_definition *d, const char *text, size_t n) {
    for (size_t at = 0; at < n;) {
        const size_t length = strcspn(text + at, ",)");
        if (d->n_parameters == DALCS_MOST_PARAMETERS) {
            return DALCS_E_NETLIST;
        }
        char *name = copy_of(text + at, length);
        if (name == NULL) {
            return DALCS_E_NOMEM;
        }
        d->parameter[d->n_parameters++] = name;
        if (name[0] == '\0') {
            return DALCS_E_NETLIST;
        }
        at += length + 1;
    }
    return DALCS_OK;
}

static enum dalcs_status read(struct dalcs_definition *d, const char *text) {
    const char *open = strchr(text, '(');
    const char *close = open != NULL ? strchr(open, ')') : NULL;
    if (close == NULL) {
        return DALCS_E_NETLIST;
    }
    const char *body = close + 1 + strspn(close + 1, " \t");
    body += *body == '=';
    d->name = copy_of(text, (size_t)(open - text));
    d->body = copy_of(body, strlen(body));
    if (d->name == NULL || d->body == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(read_parameters(d, open + 1, (size_t)(close - open - 1)));
    return d->name[0] != '\0' && d->body[0] != '\0' ? DALCS_OK : DALCS_E_NETLIST;
}

enum dalcs_status dalcs_definitions_add(struct dalcs_definitions *all, const char *text) {
    struct dalcs_definition made = {0};
    enum dalcs_status status = read(&made, text);
    if (status == DALCS_OK) {
        status = dalcs_grow(&all->definition, &all->capacity, all->n + 1, sizeof *all->definition);
    }
    if (status != DALCS_OK) {
        forget(&made);
        return status;
    }
    for (size_t k = 0; k < all->n; k++) {
        struct dalcs_definition *old = &all->definition[k];
        if (old->n_parameters == made.n_parameters && strcmp(old->name, made.name) == 0) {
            forget(old);
            *old = made;
            return DALCS_OK;
        }
    }
    all->definition[all->n++] = made;
    return DALCS_OK;
}

bool dalcs_definitions_remove(struct dalcs_definitions *all, const char *name) {
    size_t n = 0;
    for (size_t k = 0; k < all->n; k++) {
        if (strcmp(all->definition[k].name, name) == 0) {
            forget(&all->definition[k]);
        } else {
            all->definition[n++] = all->definition[k];
        }
    }
    const bool was = n < all->n;
    all->n = n;
    return was;
}

void dalcs_definitions_finish(struct dalcs_definitions *all) {
    for (size_t k = 0; k < all->n; k++) {
        forget(&all->definition[k]);
    }
    free(all->definition);
    *all = (struct dalcs_definitions){0};
}

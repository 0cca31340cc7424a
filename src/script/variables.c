/* variables.c - a short list of names and texts. */
#include "variables.h"

#include <stdlib.h>
#include <string.h>

static struct dalcs_variable *find(const struct dalcs_variables *v, const char *name) {
    for (size_t k = 0; k < v->n; k++) {
        if (strcmp(v->variable[k].name, name) == 0) {
            return &v->variable[k];
        }
    }
    return NULL;
}

static char *copy_of(const char *text) {
    char *copy = dalcs_alloc(strlen(text) + 1, 1);
    return copy != NULL ? strcpy(copy, text) : NULL;
}

const char *dalcs_variables_get(const struct dalcs_variables *v, const char *name) {
    const struct dalcs_variable *known = find(v, name);
    return known != NULL ? known->value : NULL;
}

enum dalcs_status dalcs_variables_set(struct dalcs_variables *v, const char *name,
                                      const char *value) {
    struct dalcs_variable *known = find(v, name);
    char *copy = copy_of(value);
    if (copy == NULL) {
        return DALCS_E_NOMEM;
    }
    if (known != NULL) {
        free(known->value);
        known->value = copy;
        return DALCS_OK;
    }
    char *own = copy_of(name);
    if (own == NULL ||
        dalcs_grow(&v->variable, &v->capacity, v->n + 1, sizeof *v->variable) != DALCS_OK) {
        free(own);
        free(copy);
        return DALCS_E_NOMEM;
    }
    v->variable[v->n++] = (struct dalcs_variable){own, copy};
    return DALCS_OK;
}

static char *trimmed(char *text) {
    text += strspn(text, " \t");
    size_t n = strlen(text);
    while (n > 0 && strchr(" \t", text[n - 1]) != NULL) {
        n--;
    }
    text[n] = '\0';
    return text;
}

struct dalcs_assignment dalcs_variables_split(char *text) {
    char *equal = text + strcspn(text, "=");
    char *value = trimmed(*equal == '=' ? equal + 1 : equal);
    *equal = '\0';
    const size_t n = strlen(value);
    if (n >= 2 &&
        ((value[0] == '(' && value[n - 1] == ')') || (value[0] == '"' && value[n - 1] == '"'))) {
        value[n - 1] = '\0';
        value++;
    }
    char *name = trimmed(text);
    name[strcspn(name, " \t")] = '\0';
    return (struct dalcs_assignment){name, value};
}

void dalcs_variables_unset(struct dalcs_variables *v, const char *name) {
    struct dalcs_variable *known = find(v, name);
    if (known != NULL) {
        free(known->name);
        free(known->value);
        *known = v->variable[--v->n];
    }
}

void dalcs_variables_finish(struct dalcs_variables *v) {
    for (size_t k = 0; k < v->n; k++) {
        free(v->variable[k].name);
        free(v->variable[k].value);
    }
    free(v->variable);
    *v = (struct dalcs_variables){0};
}

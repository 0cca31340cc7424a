/* written.c - functions that are written in those that there are, as .func writes them: found where a netlist has none of
 * the name. */
#include "language.h"

#include <string.h>

/* LTspice's limits that set in smoothly: z before y is reached, with a slope that is continuous. */
static const struct {
    const char *name, *body;
} WRITTEN[] = {
    {"uplim", "min(x,y-z)+z*(1-exp(-uramp(x-y+z)/z))"},
    {"dnlim", "max(x,y+z)-z*(1-exp(-uramp(y+z-x)/z))"},
};

enum { N = sizeof WRITTEN / sizeof WRITTEN[0] };

_Static_assert((int)N == (int)DALCS_WRITTEN_FUNCTIONS, "there is a place for each");

/* For messages. */
static const struct dalcs_source source = {.name = "a function that every netlist has"};

static struct dalcs_user_function *make(struct dalcs_language *language, int k) {
    static const char *const arguments[] = {"x", "y", "z"};
    struct dalcs_user_function *function = &language->written[k];
    struct dalcs_source_line *line = dalcs_arena_alloc(language->arena, 1, sizeof *line);
    struct dalcs_token *body = dalcs_arena_alloc(language->arena, 1, sizeof *body);
    if (line == NULL || body == NULL) {
        language->out_of_memory = true;
        return NULL;
    }
    *line = (struct dalcs_source_line){.source = &source, .text = WRITTEN[k].body, .number = 1};
    *body = (struct dalcs_token){.line = line,
                                 .text = WRITTEN[k].body,
                                 .length = (unsigned)strlen(WRITTEN[k].body) & 0x7ffffffu,
                                 .kind = DALCS_TOKEN_WORD};
    for (int i = 0; i < 3; i++) {
        if (dalcs_names_add(&function->arguments, arguments[i], i) != DALCS_OK) {
            language->out_of_memory = true;
            return NULL;
        }
    }
    function->n_arguments = 3;
    function->name = function->body = body;
    function->n_tokens = 1;
    return function;
}

struct dalcs_user_function *dalcs_language_function(struct dalcs_language *language,
                                                    struct dalcs_scope *scope, const char *name) {
    struct dalcs_user_function *found = dalcs_scope_find_function(scope, name);
    for (int k = 0; k < N && found == NULL; k++) {
        if (strcmp(WRITTEN[k].name, name) == 0) {
            found = language->written[k].body != NULL ? &language->written[k] : make(language, k);
        }
    }
    return found;
}

void dalcs_language_finish_written(struct dalcs_language *language) {
    for (int k = 0; k < N; k++) {
        dalcs_names_finish(&language->written[k].arguments);
    }
}

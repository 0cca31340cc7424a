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

static struct dalcs_user_function *make(struct dalcs_language *language,
                                        struct dalcs_user_function *function, const char *text,
                                        const char *const *argument, int n_arguments) {
    struct dalcs_source_line *line = dalcs_arena_alloc(language->arena, 1, sizeof *line);
    struct dalcs_token *body = dalcs_arena_alloc(language->arena, 1, sizeof *body);
    if (line == NULL || body == NULL) {
        language->out_of_memory = true;
        return NULL;
    }
    *line = (struct dalcs_source_line){.source = &source, .text = text, .number = 1};
    *body = (struct dalcs_token){.line = line,
                                 .text = text,
                                 .length = (unsigned)strlen(text) & 0x7ffffffu,
                                 .kind = DALCS_TOKEN_WORD};
    for (int i = 0; i < n_arguments; i++) {
        if (dalcs_names_add(&function->arguments, argument[i], i) != DALCS_OK) {
            language->out_of_memory = true;
            return NULL;
        }
    }
    function->n_arguments = n_arguments;
    function->name = function->body = body;
    function->n_tokens = 1;
    return function;
}

struct dalcs_user_function *dalcs_language_function(struct dalcs_language *language,
                                                    struct dalcs_scope *scope, const char *name) {
    static const char *const arguments[] = {"x", "y", "z"};
    struct dalcs_user_function *found = dalcs_scope_find_function(scope, name);
    for (int k = 0; k < N && found == NULL; k++) {
        if (strcmp(WRITTEN[k].name, name) == 0) {
            found = &language->written[k];
            found =
                found->body != NULL ? found : make(language, found, WRITTEN[k].body, arguments, 3);
        }
    }
    return found;
}

/* y1 and, for each line, (y2-y1) times how much of it lies below x. */
static const char *table_body(struct dalcs_language *language, int n) {
    const char *body = "y1";
    for (int k = 1; k < n && body != NULL; k++) {
        body = dalcs_language_text(language, "%s+(y%d-y%d)*limit((x-x%d)/(x%d-x%d),0,1)", body,
                                   k + 1, k, k, k + 1, k);
    }
    return body;
}

struct dalcs_user_function *dalcs_language_table(struct dalcs_language *language, int n) {
    if (n < 2 || n > DALCS_VARYING_POINTS) {
        return NULL;
    }
    struct dalcs_user_function *function = &language->table[n];
    if (function->body != NULL) {
        return function;
    }
    const char *argument[1 + 2 * DALCS_VARYING_POINTS] = {"x"};
    const char *body = table_body(language, n);
    bool has_memory = body != NULL;
    for (int k = 1; k <= n; k++) {
        argument[2 * k - 1] = dalcs_language_text(language, "x%d", k);
        argument[2 * k] = dalcs_language_text(language, "y%d", k);
        has_memory = has_memory && argument[2 * k - 1] != NULL && argument[2 * k] != NULL;
    }
    return has_memory ? make(language, function, body, argument, 1 + 2 * n) : NULL;
}

void dalcs_language_finish_written(struct dalcs_language *language) {
    for (int k = 0; k < N; k++) {
        dalcs_names_finish(&language->written[k].arguments);
    }
    for (int n = 0; n <= DALCS_VARYING_POINTS; n++) {
        dalcs_names_finish(&language->table[n].arguments);
    }
}

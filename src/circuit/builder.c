/* builder.c - messages while a circuit is being built, and the places that it keeps.
 *
 * Names and places that the finished circuit shows are copied into its arena: the netlist dies
 * before it. Running out of memory is remembered in out_of_memory and ends the build. */
#include "builder.h"

#include "foreign.h"

#include <string.h>

/* A list of names longer than this is no help in a hint. */
enum { MOST_NAMES_IN_HINT = 8 };

bool dalcs_builder_note_memory(struct dalcs_builder *builder, bool ok) {
    builder->out_of_memory = builder->out_of_memory || !ok;
    return ok;
}

void dalcs_builder_error_at(struct dalcs_builder *builder, const struct dalcs_location *where,
                            const char *hint, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    dalcs_diag_add_list(builder->diag, DALCS_ERROR, where, hint, format, arguments);
    va_end(arguments);
    builder->failed = true;
}

void dalcs_builder_error(struct dalcs_builder *builder, const struct dalcs_token *token,
                         const char *hint, const char *format, ...) {
    const struct dalcs_location where = dalcs_token_location(token);
    const char *sign = dalcs_foreign_sign(token->line->text + token->offset, (size_t)token->length);
    va_list arguments;
    va_start(arguments, format);
    dalcs_diag_add_list(builder->diag, DALCS_ERROR, &where, sign != NULL ? sign : hint, format,
                        arguments);
    va_end(arguments);
    builder->failed = true;
}

void dalcs_builder_warn_at(struct dalcs_builder *builder, const struct dalcs_location *where,
                           const char *hint, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    dalcs_diag_add_list(builder->diag, DALCS_WARNING, where, hint, format, arguments);
    va_end(arguments);
}

void dalcs_builder_warn(struct dalcs_builder *builder, const struct dalcs_token *token,
                        const char *hint, const char *format, ...) {
    const struct dalcs_location where = dalcs_token_location(token);
    va_list arguments;
    va_start(arguments, format);
    dalcs_diag_add_list(builder->diag, DALCS_WARNING, &where, hint, format, arguments);
    va_end(arguments);
}

void dalcs_builder_note(struct dalcs_builder *builder, const struct dalcs_token *token,
                        const char *hint, const char *format, ...) {
    const struct dalcs_location where = dalcs_token_location(token);
    va_list arguments;
    va_start(arguments, format);
    dalcs_diag_add_list(builder->diag, DALCS_NOTE, &where, hint, format, arguments);
    va_end(arguments);
}

const char *dalcs_builder_hint(struct dalcs_builder *builder, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const char *hint = dalcs_arena_printf_list(&builder->scratch, format, arguments);
    va_end(arguments);
    dalcs_builder_note_memory(builder, hint != NULL);
    return hint;
}

const char *dalcs_builder_suggest(struct dalcs_builder *builder, const struct dalcs_names *names,
                                  const char *name, const char *plural) {
    /* Suggestions for a thousand errors among a million names would take minutes. */
    if (builder->diag->n_errors > 20) {
        return NULL;
    }
    const char *nearest = dalcs_names_nearest(names, name);
    if (nearest != NULL) {
        return dalcs_builder_hint(builder, "did you mean '%s'?", nearest);
    }
    const char *list = dalcs_names_join(names, MOST_NAMES_IN_HINT, &builder->scratch);
    return list != NULL ? dalcs_builder_hint(builder, "the %s are: %s", plural, list) : NULL;
}

const char *dalcs_builder_suggest_of(struct dalcs_builder *builder, const char *const *candidate,
                                     size_t n, const char *name, const char *otherwise) {
    const char *nearest = dalcs_names_nearest_of(candidate, n, name);
    return nearest != NULL ? dalcs_builder_hint(builder, "did you mean '%s'?", nearest) : otherwise;
}

bool dalcs_builder_is_label(const char *name) {
    static const char *const labels[] = {"mfg",  "pn",   "type", "pppkg", "tol",
                                         "pwr",  "v",    "vpk",  "ipk",   "irms",
                                         "iave", "diss", "vceo", "mtbf",  "icrating"};
    return dalcs_builder_is_one_of(name, labels, sizeof labels / sizeof labels[0]);
}

bool dalcs_builder_is_one_of(const char *name, const char *const *list, size_t n) {
    for (size_t k = 0; k < n; k++) {
        if (strcmp(name, list[k]) == 0) {
            return true;
        }
    }
    return false;
}

const char *dalcs_builder_place(struct dalcs_builder *builder, const struct dalcs_token *token) {
    const struct dalcs_location where = dalcs_token_location(token);
    const char *text =
        dalcs_builder_hint(builder, "%s:%d:%d", where.file, where.line, where.column);
    return text != NULL ? text : where.file;
}

/* A copy of a chain of calls or inclusions. */
static const struct dalcs_origin *keep_chain(struct dalcs_builder *builder,
                                             const struct dalcs_origin *origin) {
    struct dalcs_arena *arena = &builder->circuit->arena;
    const struct dalcs_origin *first = NULL;
    struct dalcs_origin *last = NULL;
    for (; origin != NULL; origin = origin->outer) {
        struct dalcs_origin *copy = dalcs_arena_alloc(arena, 1, sizeof *copy);
        const char *file = dalcs_arena_copy(arena, origin->file, strlen(origin->file));
        const char *name = origin->instance != NULL
                               ? dalcs_arena_copy(arena, origin->instance, strlen(origin->instance))
                               : "";
        if (!dalcs_builder_note_memory(builder, copy != NULL && file != NULL && name != NULL)) {
            return NULL;
        }
        *copy =
            (struct dalcs_origin){origin->instance != NULL ? name : NULL, file, origin->line, NULL};
        if (last != NULL) {
            last->outer = copy;
        } else {
            first = copy;
        }
        last = copy;
    }
    return first;
}

struct dalcs_location dalcs_builder_keep_location(struct dalcs_builder *builder,
                                                  const struct dalcs_token *token) {
    struct dalcs_arena *arena = &builder->circuit->arena;
    const struct dalcs_source *source = token->line->source;
    if (builder->kept.source != source) {
        builder->kept.source = source;
        builder->kept.file = dalcs_arena_copy(arena, source->name, strlen(source->name));
        builder->kept.included = keep_chain(builder, source->included);
        dalcs_builder_note_memory(builder, builder->kept.file != NULL);
    }
    if (builder->kept.origin != token->line->instance) {
        builder->kept.origin = token->line->instance;
        builder->kept.instance = keep_chain(builder, token->line->instance);
    }
    if (builder->kept.line != token->line) {
        const char *text = token->line->text;
        builder->kept.line = token->line;
        builder->kept.text = dalcs_arena_copy(arena, text, strlen(text));
        dalcs_builder_note_memory(builder, builder->kept.text != NULL);
    }
    struct dalcs_location where = dalcs_token_location(token);
    where.file = builder->kept.file;
    where.source_line = builder->kept.text;
    where.included = builder->kept.included;
    where.instance = builder->kept.instance;
    return where;
}

/* language.c - messages of this folder, with the calls by which a place came in. */
#include "language.h"

#include <string.h>

/* A list of names longer than this is no help in a hint. */
enum { MOST_NAMES_IN_HINT = 8 };

static void report_list(struct dalcs_language *language, enum dalcs_severity severity,
                        const struct dalcs_scope *scope, struct dalcs_location where,
                        const char *hint, const char *format, va_list arguments)
    __attribute__((format(printf, 6, 0)));

static void report_list(struct dalcs_language *language, enum dalcs_severity severity,
                        const struct dalcs_scope *scope, struct dalcs_location where,
                        const char *hint, const char *format, va_list arguments) {
    where.instance = scope != NULL ? scope->origin : NULL;
    dalcs_diag_add_list(language->diag, severity, &where, hint, format, arguments);
    language->deck->has_errors = language->deck->has_errors || severity == DALCS_ERROR;
}

void dalcs_language_report(struct dalcs_language *language, enum dalcs_severity severity,
                           const struct dalcs_scope *scope, const struct dalcs_token *token,
                           const char *hint, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    report_list(language, severity, scope, dalcs_token_location(token), hint, format, arguments);
    va_end(arguments);
}

void dalcs_language_report_at(struct dalcs_language *language, enum dalcs_severity severity,
                              const struct dalcs_scope *scope, struct dalcs_location where,
                              const char *hint, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    report_list(language, severity, scope, where, hint, format, arguments);
    va_end(arguments);
}

const char *dalcs_language_text(struct dalcs_language *language, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const char *text = dalcs_arena_printf_list(language->arena, format, arguments);
    va_end(arguments);
    language->out_of_memory = language->out_of_memory || text == NULL;
    return text;
}

const char *dalcs_language_suggest(struct dalcs_language *language, const struct dalcs_names *names,
                                   const char *name, const char *plural) {
    /* Suggestions for a thousand errors among a million names would take minutes. */
    if (language->diag->n_errors > 20) {
        return NULL;
    }
    const char *nearest = dalcs_names_nearest(names, name);
    if (nearest != NULL) {
        return dalcs_language_text(language, "did you mean '%s'?", nearest);
    }
    const char *list = dalcs_names_join(names, MOST_NAMES_IN_HINT, language->arena);
    return list != NULL ? dalcs_language_text(language, "the %s are: %s", plural, list) : NULL;
}

const char *dalcs_language_place(struct dalcs_language *language, const struct dalcs_token *token) {
    const struct dalcs_location where = dalcs_token_location(token);
    const char *text =
        dalcs_language_text(language, "%s:%d:%d", where.file, where.line, where.column);
    return text != NULL ? text : where.file;
}

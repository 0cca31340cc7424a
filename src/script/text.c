/* text.c - words, numbers and formulas of a statement's text, and how they are refused. */
#include "script_internal.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Was something said of the statement before? From now on it was. */
static bool was_reported(struct dalcs_script *script, const struct dalcs_statement *s) {
    const struct dalcs_statements *all = &script->statements;
    for (size_t k = 0; k < all->n; k++) {
        struct dalcs_statement *own = &all->statement[k];
        if (own->line == s->line && own->column == s->column) {
            const bool was = own->is_reported;
            own->is_reported = true;
            return was;
        }
    }
    return false;
}

enum dalcs_status dalcs_script_refuse(struct dalcs_script *script, const struct dalcs_statement *s,
                                      const char *hint, const char *format, ...) {
    const bool goes_on = !script->host->is_strict && dalcs_statement_may_be_left_out(s);
    char text[400];
    if (script->is_silent || was_reported(script, s)) {
        return DALCS_E_NETLIST;
    }
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    const char *line = dalcs_session_script_line(script->host->session, s->line);
    size_t length = strlen(line + s->column - 1);
    const size_t n = strlen(text);
    snprintf(text + n, sizeof text - n, "%s", goes_on ? "; this line is left out" : "");
    dalcs_session_script_message(script->host->session, s->line, s->column, length > 0 ? length : 1,
                                 goes_on ? DALCS_LEVEL_WARNING : DALCS_LEVEL_ERROR, hint, text);
    return DALCS_E_NETLIST;
}

const char *dalcs_script_word(struct dalcs_script *script, const char **text) {
    const char *begin = *text + strspn(*text, " \t,");
    if (*begin == '\0') {
        return NULL;
    }
    size_t n;
    if (*begin == '"') {
        begin++;
        n = strcspn(begin, "\"");
        *text = begin + n + (begin[n] == '"' ? 1 : 0);
    } else {
        n = strcspn(begin, " \t,");
        *text = begin + n;
    }
    return dalcs_arena_copy(&script->arena, begin, n);
}

struct dalcs_vector_formula dalcs_script_formula(struct dalcs_script *script, const char *text) {
    return (struct dalcs_vector_formula){.vectors = &script->vectors,
                                         .definitions = &script->definitions,
                                         .text = text,
                                         .arena = &script->arena};
}

enum dalcs_status dalcs_script_refuse_formula(struct dalcs_script *script,
                                              const struct dalcs_statement *s,
                                              const struct dalcs_vector_formula *f) {
    if (f->out_of_memory) {
        return DALCS_E_NOMEM;
    }
    return dalcs_script_refuse(script, s, f->hint[0] != '\0' ? f->hint : NULL, "%s", f->message);
}

enum dalcs_status dalcs_script_value(struct dalcs_script *script, const struct dalcs_statement *s,
                                     const char *text, const struct dalcs_vector **value) {
    struct dalcs_vector_formula f = dalcs_script_formula(script, text);
    *value = dalcs_vector_formula_next(&f);
    if (*value == NULL) {
        return dalcs_script_refuse_formula(script, s, &f);
    }
    if (!dalcs_vector_formula_at_end(&f)) {
        return dalcs_script_refuse(script, s, NULL, "did not expect '%s'", text + f.at);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_script_number(struct dalcs_script *script, const struct dalcs_statement *s,
                                      const char *text, double *value) {
    const struct dalcs_vector *v;
    DALCS_TRY(dalcs_script_value(script, s, text, &v));
    if (v->n != 1) {
        return dalcs_script_refuse(script, s, "an index picks one: v(out)[0]",
                                   "'%s' is a vector of length %zu, not a number", v->name, v->n);
    }
    *value = creal(v->value[0]);
    return isfinite(*value)
               ? DALCS_OK
               : dalcs_script_refuse(script, s, NULL, "'%s' is not a finite number", v->name);
}

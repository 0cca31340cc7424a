/* text.c - substitution, words and formulas of a statement's text. */
#include "script_internal.h"

#include "lower_case.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
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

/* A text that grows in the arena of the statement. */
struct growing {
    struct dalcs_script *script;
    char *text;
    size_t n, capacity;
    bool failed;
};

static void append(struct growing *g, const char *text, size_t n) {
    if (g->n + n + 1 > g->capacity && !g->failed) {
        size_t capacity = 2 * (g->n + n + 64);
        char *more = dalcs_arena_alloc(&g->script->arena, capacity, 1);
        if (more == NULL) {
            g->failed = true;
            return;
        }
        if (g->n > 0) {
            memcpy(more, g->text, g->n);
        }
        g->text = more;
        g->capacity = capacity;
    }
    if (!g->failed) {
        memcpy(g->text + g->n, text, n);
        g->n += n;
        g->text[g->n] = '\0';
    }
}

static bool is_name_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/* A number so that it reads back as it is, in few digits where they do. */
static void append_number(struct growing *g, double value) {
    char text[40];
    snprintf(text, sizeof text, "%.12g", value);
    if (strtod(text, NULL) != value) {
        snprintf(text, sizeof text, "%.17g", value);
    }
    append(g, text, strlen(text));
}

/* All values of a vector, for the list of a foreach. */
static enum dalcs_status append_vector(struct growing *g, const struct dalcs_statement *s,
                                       const char *text, size_t n) {
    struct dalcs_script *script = g->script;
    char *name = dalcs_arena_copy(&script->arena, text, n);
    const struct dalcs_vector **vector;
    size_t n_vectors;
    if (name == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_script_vectors(script, s, dalcs_lower_text(name), &vector, &n_vectors));
    for (size_t k = 0; n_vectors == 1 && k < vector[0]->n; k++) {
        append(g, " ", 1);
        append_number(g, creal(vector[0]->value[k]));
    }
    return DALCS_OK;
}

static enum dalcs_status append_formula(struct growing *g, const struct dalcs_statement *s,
                                        const char *text, size_t n) {
    double value;
    char *formula = dalcs_arena_copy(&g->script->arena, text, n);
    if (formula == NULL) {
        return DALCS_E_NOMEM;
    }
    enum dalcs_status status = dalcs_script_number(g->script, s, dalcs_lower_text(formula), &value);
    if (status == DALCS_OK) {
        append_number(g, value);
    }
    return status;
}

/* {formula}: what a measurement's card cannot know before the run, it finds itself. */
static enum dalcs_status append_braces(struct growing *g, const struct dalcs_statement *s,
                                       const char *formula) {
    struct dalcs_script *script = g->script;
    const bool is_measured = s->kind == DALCS_STATEMENT_MEASURE;
    const bool was_silent = script->is_silent;
    script->is_silent = was_silent || is_measured;
    script->vectors.prefers_parameters = true;
    enum dalcs_status status = append_formula(g, s, formula, strlen(formula));
    script->vectors.prefers_parameters = false;
    script->is_silent = was_silent;
    if (status != DALCS_E_NETLIST || !is_measured) {
        return status;
    }
    append(g, "{", 1);
    append(g, formula, strlen(formula));
    append(g, "}", 1);
    return DALCS_OK;
}

/* After a `$` at *p: $name, ${name} or $&vector. */
static enum dalcs_status append_variable(struct growing *g, const struct dalcs_statement *s,
                                         const char **p) {
    const char *begin = *p;
    const bool is_vector = *begin == '&';
    const bool has_brace = *begin == '{';
    begin += is_vector || has_brace ? 1 : 0;
    const char *end = begin;
    while (is_name_character(*end) || (is_vector && *end != '\0' && strchr(".#@", *end) != NULL)) {
        end++;
    }
    *p = end + (has_brace && *end == '}' ? 1 : 0);
    if (is_vector && s->kind == DALCS_STATEMENT_FOREACH) {
        return append_vector(g, s, begin, (size_t)(end - begin));
    }
    if (is_vector) {
        return append_formula(g, s, begin, (size_t)(end - begin));
    }
    char *name = dalcs_arena_copy(&g->script->arena, begin, (size_t)(end - begin));
    if (name == NULL) {
        return DALCS_E_NOMEM;
    }
    const char *value = dalcs_variables_get(&g->script->variables, dalcs_lower_text(name));
    if (value == NULL) {
        return dalcs_script_refuse(g->script, s, "set it: set name=value",
                                   "there is no variable '%s'", name);
    }
    append(g, value, strlen(value));
    return DALCS_OK;
}

enum dalcs_status dalcs_script_expand(struct dalcs_script *script, const struct dalcs_statement *s,
                                      const char **text) {
    struct growing g = {.script = script};
    enum dalcs_status status = DALCS_OK;
    append(&g, "", 0);
    for (const char *p = s->rest; *p != '\0' && status == DALCS_OK;) {
        const char *close = *p == '{' ? strchr(p, '}') : NULL;
        if (*p == '$' && (is_name_character(p[1]) || p[1] == '&' || p[1] == '{')) {
            p++;
            status = append_variable(&g, s, &p);
        } else if (close != NULL) {
            /* What stands in the braces may hold variables itself. */
            struct dalcs_statement inner = *s;
            const char *formula;
            inner.rest = dalcs_arena_copy(&script->arena, p + 1, (size_t)(close - p - 1));
            status =
                inner.rest != NULL ? dalcs_script_expand(script, &inner, &formula) : DALCS_E_NOMEM;
            if (status == DALCS_OK) {
                status = append_braces(&g, s, formula);
            }
            p = close + 1;
        } else {
            append(&g, p++, 1);
        }
    }
    *text = g.text;
    return status == DALCS_OK && g.failed ? DALCS_E_NOMEM : status;
}

enum dalcs_status dalcs_script_expand_low(struct dalcs_script *script,
                                          const struct dalcs_statement *s, const char **text) {
    enum dalcs_status status = dalcs_script_expand(script, s, text);
    if (status != DALCS_OK) {
        return status;
    }
    char *copy = dalcs_arena_copy(&script->arena, *text, strlen(*text));
    if (copy == NULL) {
        return DALCS_E_NOMEM;
    }
    *text = dalcs_lower_text(copy);
    return DALCS_OK;
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

static enum dalcs_status report(struct dalcs_script *script, const struct dalcs_statement *s,
                                const struct dalcs_vector_formula *f) {
    if (f->out_of_memory) {
        return DALCS_E_NOMEM;
    }
    return dalcs_script_refuse(script, s, f->hint[0] != '\0' ? f->hint : NULL, "%s", f->message);
}

enum dalcs_status dalcs_script_number(struct dalcs_script *script, const struct dalcs_statement *s,
                                      const char *text, double *value) {
    struct dalcs_vector_formula f = {
        .vectors = &script->vectors, .text = text, .arena = &script->arena};
    const struct dalcs_vector *v = dalcs_vector_formula_next(&f);
    if (v == NULL) {
        return report(script, s, &f);
    }
    if (!dalcs_vector_formula_at_end(&f)) {
        return dalcs_script_refuse(script, s, NULL, "did not expect '%s'", text + f.at);
    }
    if (v->n != 1) {
        return dalcs_script_refuse(script, s, "an index picks one: v(out)[0]",
                                   "'%s' is a vector of length %zu, not a number", v->name, v->n);
    }
    *value = creal(v->value[0]);
    return isfinite(*value)
               ? DALCS_OK
               : dalcs_script_refuse(script, s, NULL, "'%s' is not a finite number", v->name);
}

/* The word `all`, and nothing behind it. */
static bool is_all(const char *text) {
    return strncmp(text, "all", 3) == 0 && text[3 + strspn(text + 3, " \t")] == '\0';
}

/* vector[n_before..*n-1] become all of the plot but its scale. */
static enum dalcs_status all_vectors(struct dalcs_script *script, size_t n_before,
                                     const struct dalcs_vector ***vector, size_t *n) {
    const struct dalcs_plot_vectors *plot = &script->vectors.plot;
    const size_t first = plot->analysis == DALCS_OPERATING_POINT ? 0 : 1;
    *vector = dalcs_arena_alloc(&script->arena, n_before + plot->n, sizeof(struct dalcs_vector *));
    *n = n_before;
    if (*vector == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = first; k < plot->n; k++) {
        (*vector)[(*n)++] = plot->vector[k];
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_script_vectors(struct dalcs_script *script, const struct dalcs_statement *s,
                                       const char *text, const struct dalcs_vector ***vector,
                                       size_t *n) {
    struct dalcs_vector_formula f = {
        .vectors = &script->vectors, .text = text, .arena = &script->arena};
    if (dalcs_vector_formula_at_end(&f)) {
        return all_vectors(script, 0, vector, n);
    }
    *vector = dalcs_arena_alloc(&script->arena, strlen(text), sizeof(struct dalcs_vector *));
    if (*vector == NULL) {
        return DALCS_E_NOMEM;
    }
    *n = 0;
    while (!dalcs_vector_formula_at_end(&f)) {
        if (is_all(f.text + f.at)) {
            const struct dalcs_vector **listed = *vector;
            const size_t n_listed = *n;
            enum dalcs_status status = all_vectors(script, n_listed, vector, n);
            if (status != DALCS_OK) {
                return status;
            }
            memcpy(*vector, listed, n_listed * sizeof(struct dalcs_vector *));
            return DALCS_OK;
        }
        const struct dalcs_vector *v = dalcs_vector_formula_next(&f);
        if (v == NULL) {
            return report(script, s, &f);
        }
        (*vector)[(*n)++] = v;
    }
    return DALCS_OK;
}

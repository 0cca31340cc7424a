/* expansion.c - $variables and {formulas} in a statement's text are what they stand for. */
#include "script_internal.h"

#include "lower_case.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
    for (size_t k = 0; n_vectors == 1 && k < vector[0]->n && !g->failed; k++) {
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

/* {formula}: a value that is not known before the run is computed by the measurement. */
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

/* What `set` did not make, but the plots have; NULL: it is none of these. */
static const char *variable_of_plots(struct dalcs_script *script, const char *name) {
    const struct dalcs_vectors *all = &script->vectors;
    const struct dalcs_plot_vectors *plot = dalcs_plots_current(all);
    if (strcmp(name, "curplot") == 0) {
        return plot == &all->own ? "const" : plot->type;
    }
    if (strcmp(name, "curplotname") == 0) {
        return plot->kind != NULL ? plot->kind : "constants";
    }
    if (strcmp(name, "curplottitle") == 0) {
        return plot->title != NULL ? plot->title : "Constant values";
    }
    if (strcmp(name, "plots") != 0) {
        return NULL;
    }
    const char *list = "const";
    for (size_t k = 0; k < all->n && list != NULL; k++) {
        list = dalcs_arena_printf(&script->arena, "%s %s", list, all->plot[k]->type);
    }
    return list;
}

static const char *variable_of(struct dalcs_script *script, const char *name) {
    const char *value = dalcs_variables_get(&script->variables, name);
    return value != NULL ? value : variable_of_plots(script, name);
}

static size_t count_words(struct dalcs_script *script, const char *text) {
    size_t n = 0;
    while (dalcs_script_word(script, &text) != NULL) {
        n++;
    }
    return n;
}

/* The words number `first` to `last`, from 1, of a list. */
static enum dalcs_status append_words(struct growing *g, const struct dalcs_statement *s,
                                      const char *name, const char *list, long first, long last) {
    const char *word = dalcs_script_word(g->script, &list);
    long k = 1;
    for (; word != NULL && k <= last; k++) {
        if (k > first) {
            append(g, " ", 1);
        }
        if (k >= first) {
            append(g, word, strlen(word));
        }
        word = dalcs_script_word(g->script, &list);
    }
    return k > last && first >= 1 && first <= last
               ? DALCS_OK
               : dalcs_script_refuse(g->script, s, NULL, "the variable '%s' has no word number %ld",
                                     name, k > last ? first : last);
}

/* The value, or of an index behind the name, [2] or [2-3], these words of it. */
static enum dalcs_status append_value(struct growing *g, const struct dalcs_statement *s,
                                      const char *name, const char **p) {
    const char *value = variable_of(g->script, name);
    if (value == NULL) {
        return dalcs_script_refuse(g->script, s, "set it: set name=value",
                                   "there is no variable '%s'", name);
    }
    const char *close = **p == '[' ? strchr(*p, ']') : NULL;
    if (close == NULL) {
        append(g, value, strlen(value));
        return DALCS_OK;
    }
    struct dalcs_statement inside = *s;
    const char *text;
    inside.rest = dalcs_arena_copy(&g->script->arena, *p + 1, (size_t)(close - *p - 1));
    *p = close + 1;
    if (inside.rest == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_script_expand(g->script, &inside, &text));
    char *end;
    const long first = strtol(text, &end, 10);
    const long last = *end == '-' ? strtol(end + 1, &end, 10) : first;
    return append_words(g, s, name, value, first, last);
}

/* $&vector, $&v(out): its value, in the list of a foreach all of them; $&vector[2]. */
static enum dalcs_status append_vector_value(struct growing *g, const struct dalcs_statement *s,
                                             const char **p) {
    const char *begin = *p;
    const char *end = begin;
    while (is_name_character(*end) || (*end != '\0' && strchr(".#@", *end) != NULL)) {
        end++;
    }
    const bool is_signal = *end == '(' && end - begin <= 3 &&
                           (*begin == 'v' || *begin == 'i' || *begin == 'V' || *begin == 'I');
    const char *close = is_signal ? strchr(end, ')') : NULL;
    end = close != NULL ? close + 1 : end;
    close = *end == '[' ? strchr(end, ']') : NULL;
    end = close != NULL ? close + 1 : end;
    *p = end;
    return s->kind == DALCS_STATEMENT_FOREACH ? append_vector(g, s, begin, (size_t)(end - begin))
                                              : append_formula(g, s, begin, (size_t)(end - begin));
}

/* After a `$` at *p: $name, ${name}, $?name (is it set?), $#name (how many words?) or $&vector. */
static enum dalcs_status append_variable(struct growing *g, const struct dalcs_statement *s,
                                         const char **p) {
    const char sign = **p;
    const char *begin = *p + (sign == '{' || sign == '?' || sign == '#' || sign == '&' ? 1 : 0);
    if (sign == '&') {
        *p = begin;
        return append_vector_value(g, s, p);
    }
    const char *end = begin;
    while (is_name_character(*end)) {
        end++;
    }
    *p = end + (sign == '{' && *end == '}' ? 1 : 0);
    char *name = dalcs_arena_copy(&g->script->arena, begin, (size_t)(end - begin));
    if (name == NULL) {
        return DALCS_E_NOMEM;
    }
    const char *value = variable_of(g->script, dalcs_lower_text(name));
    if (sign == '?') {
        append(g, value != NULL ? "1" : "0", 1);
    } else if (sign == '#') {
        append_number(g, value != NULL ? (double)count_words(g->script, value) : 0.0);
    } else {
        return append_value(g, s, name, p);
    }
    return DALCS_OK;
}

/* Is this a variable behind a dollar? */
static bool begins_variable(const char *p) {
    return is_name_character(p[0]) || p[0] == '&' || p[0] == '{' ||
           ((p[0] == '?' || p[0] == '#') && is_name_character(p[1]));
}

/* A brace that only ties a name to what follows, {$run}: the name itself, as it is. */
static bool is_variable_alone(const char *p, const char *close) {
    const char *end = p + 2;
    while (is_name_character(*end)) {
        end++;
    }
    return p[1] == '$' && end > p + 2 && end == close;
}

enum dalcs_status dalcs_script_expand(struct dalcs_script *script, const struct dalcs_statement *s,
                                      const char **text) {
    struct growing g = {.script = script};
    enum dalcs_status status = DALCS_OK;
    append(&g, "", 0);
    for (const char *p = s->rest; *p != '\0' && status == DALCS_OK;) {
        const char *close = *p == '{' ? strchr(p, '}') : NULL;
        if (*p == '$' && begins_variable(p + 1)) {
            p++;
            status = append_variable(&g, s, &p);
        } else if (close != NULL && is_variable_alone(p, close)) {
            p += 2;
            status = append_variable(&g, s, &p);
            p = close + 1;
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

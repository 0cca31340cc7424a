/* let_command.c - vectors and functions that the script makes: let, unlet, compose, cross, define. */
#include "script_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_VALUES = 100000000 };

/* ---- let ------------------------------------------------------------------------------------------ */

/* `name[index] = formula`; behind: from the equal sign on. */
static enum dalcs_status let_element(struct dalcs_script *script, const struct dalcs_statement *s,
                                     const char *left, const char *behind) {
    const size_t n = strcspn(left, " \t[");
    const char *open = strchr(left, '[');
    const char *close = strrchr(left, ']');
    if (close == NULL || close[1 + strspn(close + 1, " \t")] != '\0' || behind[0] != '=') {
        return dalcs_script_refuse(script, s, "let name[index] = formula",
                                   "an index, ']' and '=' are missing");
    }
    const char *name = dalcs_arena_copy(&script->arena, left, n);
    const char *inside = dalcs_arena_copy(&script->arena, open + 1, (size_t)(close - open - 1));
    const struct dalcs_vector *value;
    double k;
    if (name == NULL || inside == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_script_number(script, s, inside, &k));
    DALCS_TRY(dalcs_script_value(script, s, behind + 1, &value));
    if (value->n != 1) {
        return dalcs_script_refuse(script, s, "an index picks one: v(out)[0]",
                                   "'%s' is a vector of length %zu, not a number", value->name,
                                   value->n);
    }
    const struct dalcs_vector *known = dalcs_vectors_find_exactly(&script->vectors, name);
    if (known == NULL) {
        return dalcs_script_refuse(script, s, "let name = vector(n) makes one",
                                   "there is no vector '%s'", name);
    }
    if (!(k >= 0.0 && k < (double)known->n)) {
        return dalcs_script_refuse(script, s, NULL, "index %g of a vector of length %zu", k,
                                   known->n);
    }
    known->value[(size_t)k] = value->value[0];
    if (!value->is_complex || known->is_complex) {
        return DALCS_OK;
    }
    struct dalcs_vector now = *known; /* one complex number makes it a complex vector */
    now.is_complex = true;
    return dalcs_vectors_let(&script->vectors, name, &now);
}

enum dalcs_status dalcs_script_let(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *text;
    const struct dalcs_vector *v;
    DALCS_TRY(dalcs_script_expand_low(script, s, &text));
    const size_t length = strcspn(text, "=");
    const char *name = dalcs_arena_copy(&script->arena, text, length);
    if (name == NULL) {
        return DALCS_E_NOMEM;
    }
    const char *rest = name;
    const char *first = dalcs_script_word(script, &rest);
    if (first != NULL && strchr(name, '[') != NULL) {
        return let_element(script, s, name, text + length);
    }
    if (text[length] == '\0' || first == NULL || strchr(first, '(') != NULL ||
        dalcs_script_word(script, &rest) != NULL) {
        return dalcs_script_refuse(script, s, "let name = formula", "a name and '=' are missing");
    }
    DALCS_TRY(dalcs_script_value(script, s, text + length + 1, &v));
    return dalcs_vectors_let(&script->vectors, first, v);
}

enum dalcs_status dalcs_script_unlet(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *text;
    DALCS_TRY(dalcs_script_expand_low(script, s, &text));
    for (const char *name; (name = dalcs_script_word(script, &text)) != NULL;) {
        if (!dalcs_plots_unlet(&script->vectors, name)) {
            return dalcs_script_refuse(script, s, NULL, "there is no vector '%s'", name);
        }
    }
    return DALCS_OK;
}

/* ---- compose and cross ------------------------------------------------------------------------------- */

struct range {
    double start, stop, step, n;
    bool has_start, has_stop, has_step, has_n;
};

/* "start=1" and so on; false: it is no such word. */
static enum dalcs_status take_range_word(struct dalcs_script *script,
                                         const struct dalcs_statement *s, struct range *range,
                                         const char *word, bool *is_one) {
    const char *equal = strchr(word, '=');
    const size_t n = equal != NULL ? (size_t)(equal - word) : 0;

    struct {
        const char *name;
        double *value;
        bool *has;
    } const known[] = {{"start", &range->start, &range->has_start},
                       {"stop", &range->stop, &range->has_stop},
                       {"step", &range->step, &range->has_step},
                       {"lin", &range->n, &range->has_n}};

    *is_one = false;
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        if (n == strlen(known[k].name) && strncmp(word, known[k].name, n) == 0) {
            *is_one = *known[k].has = true;
            return dalcs_script_number(script, s, equal + 1, known[k].value);
        }
    }
    return DALCS_OK;
}

/* start to stop by step, both ends included; or n of them. */
static enum dalcs_status fill_range(struct dalcs_script *script, const struct dalcs_statement *s,
                                    const struct range *range, struct dalcs_vector *made) {
    const double width = range->stop - range->start;
    const double n = range->has_n      ? range->n
                     : range->has_step ? floor(width / range->step * DALCS_ROUNDED_UP) + 1.0
                                       : 0.0;
    if (!range->has_start || !range->has_stop || !(n >= 1.0 && n <= MOST_VALUES)) {
        return dalcs_script_refuse(script, s, "compose name start=1 stop=2 step=0.5",
                                   "no values lie between this start and stop");
    }
    made->n = (size_t)n;
    made->value = dalcs_arena_alloc(&script->arena, made->n, sizeof *made->value);
    if (made->value == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < made->n; k++) {
        made->value[k] = range->has_n && made->n > 1
                             ? range->start + width * (double)k / (double)(made->n - 1)
                             : range->start + range->step * (double)k;
    }
    return DALCS_OK;
}

/* All values of all vectors, one behind the other. */
static enum dalcs_status join(struct dalcs_script *script, const struct dalcs_vector *const *vector,
                              size_t n_vectors, struct dalcs_vector *made) {
    for (size_t k = 0; k < n_vectors; k++) {
        made->n += vector[k]->n;
        made->is_complex = made->is_complex || vector[k]->is_complex;
    }
    made->value = dalcs_arena_alloc(&script->arena, made->n, sizeof *made->value);
    if (made->value == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0, at = 0; k < n_vectors; at += vector[k++]->n) {
        memcpy(&made->value[at], vector[k]->value, vector[k]->n * sizeof *made->value);
    }
    return DALCS_OK;
}

/* compose name values 1 2 3; compose name start=0 stop=1 step=0.1 */
enum dalcs_status dalcs_script_compose(struct dalcs_script *script,
                                       const struct dalcs_statement *s) {
    static const char usage[] = "compose name values 1 2 3; compose name start=0 stop=1 step=0.1";
    const char *text;
    struct dalcs_vector made = {.unit = DALCS_UNIT_NONE};
    struct range range = {0};
    DALCS_TRY(dalcs_script_expand_low(script, s, &text));
    const char *name = dalcs_script_word(script, &text);
    const char *rest = text;
    const char *word = name != NULL ? dalcs_script_word(script, &rest) : NULL;
    if (word == NULL) {
        return dalcs_script_refuse(script, s, usage, "a name and values are missing");
    }
    if (strcmp(word, "values") == 0) {
        const struct dalcs_vector **vector;
        size_t n;
        DALCS_TRY(dalcs_script_vectors(script, s, rest, &vector, &n));
        DALCS_TRY(join(script, vector, n, &made));
        return dalcs_vectors_let(&script->vectors, name, &made);
    }
    while ((word = dalcs_script_word(script, &text)) != NULL) {
        bool is_one;
        DALCS_TRY(take_range_word(script, s, &range, word, &is_one));
        if (!is_one) {
            return dalcs_script_refuse(script, s, usage, "did not expect '%s'", word);
        }
    }
    DALCS_TRY(fill_range(script, s, &range, &made));
    return dalcs_vectors_let(&script->vectors, name, &made);
}

/* cross name index vector ...: the values there, one of each vector. */
enum dalcs_status dalcs_script_cross(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *text;
    const struct dalcs_vector **vector;
    size_t n;
    double at = 0.0;
    DALCS_TRY(dalcs_script_expand_low(script, s, &text));
    const char *name = dalcs_script_word(script, &text);
    const char *index = name != NULL ? dalcs_script_word(script, &text) : NULL;
    if (index == NULL || text[strspn(text, " \t")] == '\0') {
        return dalcs_script_refuse(script, s, "cross name 0 v(a) v(b)",
                                   "a name, an index and vectors are missing");
    }
    DALCS_TRY(dalcs_script_number(script, s, index, &at));
    DALCS_TRY(dalcs_script_vectors(script, s, text, &vector, &n));
    struct dalcs_vector made = {.unit = DALCS_UNIT_NONE, .n = n};
    made.value = dalcs_arena_alloc(&script->arena, n, sizeof *made.value);
    if (made.value == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        if (!(at >= 0.0 && at < (double)vector[k]->n)) {
            return dalcs_script_refuse(script, s, NULL, "index %g of a vector of length %zu", at,
                                       vector[k]->n);
        }
        made.value[k] = vector[k]->value[(size_t)at];
        made.is_complex = made.is_complex || vector[k]->is_complex;
    }
    return dalcs_vectors_let(&script->vectors, name, &made);
}

/* ---- define ------------------------------------------------------------------------------------------ */

enum dalcs_status dalcs_script_define(struct dalcs_script *script,
                                      const struct dalcs_statement *s) {
    const char *text;
    DALCS_TRY(dalcs_script_expand_low(script, s, &text));
    const enum dalcs_status status = dalcs_definitions_add(&script->definitions, text);
    return status == DALCS_E_NETLIST
               ? dalcs_script_refuse(script, s, "define power(u,i) u*i",
                                     "a function with at most %d parameters and its formula are "
                                     "missing",
                                     (int)DALCS_MOST_PARAMETERS)
               : status;
}

enum dalcs_status dalcs_script_undefine(struct dalcs_script *script,
                                        const struct dalcs_statement *s) {
    const char *text;
    DALCS_TRY(dalcs_script_expand_low(script, s, &text));
    for (const char *name; (name = dalcs_script_word(script, &text)) != NULL;) {
        if (strcmp(name, "*") == 0) {
            dalcs_definitions_finish(&script->definitions);
        } else if (!dalcs_definitions_remove(&script->definitions, name)) {
            return dalcs_script_refuse(script, s, NULL, "there is no definition of '%s'", name);
        }
    }
    return DALCS_OK;
}

/* vector_names.c - words in a formula: vectors, signals, constants, arguments, functions. */
#include "vector_formula.h"

#include <stdio.h>
#include <string.h>

static struct dalcs_vector *parameter(struct dalcs_vector_formula *f, const char *name) {
    double value;
    enum dalcs_status status = dalcs_session_parameter(f->vectors->session, name, &value);
    if (status == DALCS_E_NOMEM) {
        f->out_of_memory = true;
        return dalcs_vector_fail(f, "out of memory");
    }
    return status == DALCS_OK ? dalcs_vector_number(f, value) : NULL;
}

/* Of a definition at work. */
static const struct dalcs_vector *argument_of(const struct dalcs_vector_formula *f,
                                              const char *name) {
    const size_t n = f->definition != NULL ? f->definition->n_parameters : 0;
    for (size_t k = 0; k < n; k++) {
        if (strcmp(f->definition->parameter[k], name) == 0) {
            return f->argument[k];
        }
    }
    return NULL;
}

/* What ngspice has in its plot "const", as far as it is about circuits. */
static struct dalcs_vector *constant(struct dalcs_vector_formula *f, const char *name) {
    static const struct {
        const char *name;
        double value;
    } known[] = {{"pi", 3.141592653589793},
                 {"e", 2.718281828459045},
                 {"c", 299792458.0},
                 {"kelvin", -273.15},
                 {"boltz", 1.380649e-23},
                 {"echarge", 1.602176634e-19},
                 {"yes", 1.0},
                 {"true", 1.0},
                 {"no", 0.0},
                 {"false", 0.0}};

    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        if (strcmp(known[k].name, name) == 0) {
            return dalcs_vector_number(f, known[k].value);
        }
    }
    return strcmp(name, "i") == 0 ? dalcs_vector_number(f, I) : NULL;
}

static struct dalcs_vector *of_plot(struct dalcs_vector_formula *f,
                                    const struct dalcs_plot_vectors *plot,
                                    const struct dalcs_vector *v) {
    struct dalcs_vector *copy = dalcs_vector_copy(f, v);
    if (copy != NULL) {
        copy->scale = plot->scale != NULL && plot->scale->n == v->n ? plot->scale : NULL;
    }
    return copy;
}

/* @r1[resistance], @r.x1.r1[resistance] */
static struct dalcs_vector *element_value(struct dalcs_vector_formula *f, const char *name) {
    const char *open = name[0] == '@' ? strchr(name, '[') : NULL;
    char element[DALCS_VECTOR_NAME], field[DALCS_VECTOR_NAME];
    double value;
    if (open == NULL) {
        return NULL;
    }
    snprintf(element, sizeof element, "%.*s", (int)(open - name) - 1, name + 1);
    snprintf(field, sizeof field, "%.*s", (int)strcspn(open + 1, "]"), open + 1);
    struct dalcs_session *session = f->vectors->session;
    enum dalcs_status status = dalcs_session_element_value(session, element, field, &value);
    if (status == DALCS_E_OPTION && element[0] != '\0' && element[1] == '.') {
        status = dalcs_session_element_value(session, element + 2, field, &value);
    }
    if (status == DALCS_E_NOMEM) {
        f->out_of_memory = true;
        return dalcs_vector_fail(f, "out of memory");
    }
    return status == DALCS_OK ? dalcs_vector_number(f, value) : NULL;
}

/* A vector of the plot, or else a parameter of the netlist; in braces a parameter comes before the voltage of a
 * node of its name. */
static struct dalcs_vector *find(struct dalcs_vector_formula *f,
                                 const struct dalcs_plot_vectors *plot, const char *name) {
    const struct dalcs_vectors *all = f->vectors;
    const struct dalcs_vector *v = argument_of(f, name);
    if (v != NULL) {
        return dalcs_vector_copy(f, v);
    }
    v = all->prefers_parameters ? dalcs_vectors_find_exactly(all, name)
                                : dalcs_vectors_find_in(all, plot, name);
    struct dalcs_vector *known = v == NULL ? parameter(f, name) : NULL;
    known = v == NULL && known == NULL && !f->failed ? element_value(f, name) : known;
    if (known != NULL || f->failed) {
        return known;
    }
    v = v == NULL ? dalcs_vectors_find_in(all, plot, name) : v;
    known = v == NULL ? constant(f, name) : of_plot(f, plot, v);
    if (known == NULL && !f->failed) {
        if (all->current == NULL) {
            snprintf(f->hint, sizeof f->hint, "no analysis has been run yet");
        }
        if (plot != dalcs_plots_current(all)) {
            return dalcs_vector_fail(f, "there is no vector '%.100s' in %s", name, plot->type);
        }
        return dalcs_vector_fail(f, "there is no vector '%s'", name);
    }
    return known;
}

/* v(a), v(a,b), i(x): the text in parentheses is no formula. `what` may have a suffix: vdb, vm, vp, vr,
 * vi. */
static struct dalcs_vector *read_signal(struct dalcs_vector_formula *f,
                                        const struct dalcs_plot_vectors *plot, char letter,
                                        const char *suffix) {
    char inside[2][200] = {"", ""};
    int part = 0;
    size_t n = 0;
    const char *p = f->text + f->at;
    for (; *p != ')' && *p != '\0'; p++) {
        if (*p == ',' && part == 0) {
            part = 1;
            n = 0;
        } else if (*p != ' ' && *p != '\t' && n + 1 < sizeof inside[0]) {
            inside[part][n++] = *p;
            inside[part][n] = '\0';
        }
    }
    if (*p != ')') {
        return dalcs_vector_fail(f, "a parenthesis is never closed");
    }
    f->at = (size_t)(p - f->text) + 1;
    char name[2][210];
    struct dalcs_vector *v = NULL;
    snprintf(name[0], sizeof name[0], "%c(%s)", letter, inside[0]);
    char pair[420];
    snprintf(pair, sizeof pair, "%c(%s,%s)", letter, inside[0], inside[1]);
    if (part == 1 && dalcs_vectors_find_in(f->vectors, plot, pair) == NULL) {
        snprintf(name[1], sizeof name[1], "%c(%s)", letter, inside[1]);
        const bool is_ground[2] = {strcmp(inside[0], "0") == 0, strcmp(inside[1], "0") == 0};
        struct dalcs_vector *a =
            is_ground[0] ? dalcs_vector_number(f, 0.0) : find(f, plot, name[0]);
        struct dalcs_vector *b =
            is_ground[1] ? dalcs_vector_number(f, 0.0) : find(f, plot, name[1]);
        v = dalcs_vector_combine(f, DALCS_VECTOR_SUBTRACT, a, b);
    } else {
        const char *as_written = part == 1 ? pair : name[0];
        /* what `let` made, or a parameter of a definition: v(gain) is gain */
        const bool is_made = part == 0 && letter == 'v' &&
                             dalcs_vectors_find_in(f->vectors, plot, name[0]) == NULL &&
                             (argument_of(f, inside[0]) != NULL ||
                              dalcs_vectors_find_in(f->vectors, plot, inside[0]) != NULL);
        v = find(f, plot, is_made ? inside[0] : as_written);
    }
    return v == NULL || suffix[0] == '\0'
               ? v
               : dalcs_vector_call(f, suffix, (const struct dalcs_vector *const[]){v}, 1);
}

/* im() is the imaginary part, as in ngspice. */
static const char *suffix_function(const char *word) {
    static const char *const pair[][2] = {{"", ""},    {"m", "mag"}, {"p", "ph"},
                                          {"r", "re"}, {"i", "im"},  {"db", "db"}};
    for (size_t k = 0; k < sizeof pair / sizeof pair[0]; k++) {
        if (strcmp(word + 1, pair[k][0]) == 0 && strcmp(word, "im") != 0) {
            return pair[k][1];
        }
    }
    return NULL;
}

/* name(formula, formula, ...): behind the parenthesis. */
static struct dalcs_vector *read_call(struct dalcs_vector_formula *f, const char *name) {
    const struct dalcs_vector *argument[DALCS_MOST_ARGUMENTS];
    size_t n = 0;
    do {
        if (n == DALCS_MOST_ARGUMENTS) {
            return dalcs_vector_fail(f, "too many arguments of %s", name);
        }
        argument[n] = dalcs_vector_formula_choice(f);
        if (argument[n] == NULL) {
            return NULL;
        }
        n++;
    } while (dalcs_vector_formula_take(f, ","));
    if (!dalcs_vector_formula_take(f, ")")) {
        return dalcs_vector_fail(f, "expected ')' after the argument of %s", name);
    }
    return dalcs_vector_call(f, name, argument, n);
}

/* The characters of a name; @r1[i] with its brackets. */
static void read_name(struct dalcs_vector_formula *f, char word[DALCS_VECTOR_NAME]) {
    size_t n = 0;
    const char *p = f->text + f->at;
    while (dalcs_vector_formula_is_of_name(p[n]) && n + 1 < DALCS_VECTOR_NAME) {
        word[n] = p[n];
        n++;
    }
    f->at += n;
    word[n] = '\0';
    const char *element = strchr(word, '@');
    if (element != NULL && f->text[f->at] == '[') {
        while (f->text[f->at] != '\0' && f->text[f->at - 1] != ']' && n + 1 < DALCS_VECTOR_NAME) {
            word[n++] = f->text[f->at++];
        }
        word[n] = '\0';
    }
}

struct dalcs_vector *dalcs_vector_formula_word(struct dalcs_vector_formula *f) {
    char name[DALCS_VECTOR_NAME];
    const char *word;
    read_name(f, name);
    const struct dalcs_plot_vectors *plot = dalcs_plots_split(f->vectors, name, &word);
    if ((strcmp(word, "v") == 0 || strcmp(word, "i") == 0) &&
        strncmp(f->text + f->at, "-sweep", 6) == 0) {
        f->at += 6;
        return find(f, plot, word[0] == 'v' ? "v-sweep" : "i-sweep");
    }
    if (f->text[f->at] != '(') {
        return find(f, plot, word);
    }
    const char *dot = strrchr(word, '.');
    if (dot != NULL && (strcmp(dot, ".v") == 0 || strcmp(dot, ".i") == 0)) {
        return dalcs_vector_fail(f, "there is no plot '%.*s'", (int)(dot - word), word);
    }
    f->at++;
    const char *suffix = word[0] == 'v' || word[0] == 'i' ? suffix_function(word) : NULL;
    if (suffix != NULL && dalcs_definitions_find(f->definitions, word, 1) == NULL) {
        return read_signal(f, plot, word[0], suffix);
    }
    return read_call(f, word);
}

/* vector_formula.c - parses and evaluates in one pass. */
#include "vector_formula.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 100 };

/* ---- Reading ----------------------------------------------------------------------------------- */

static void skip_blanks(struct dalcs_vector_formula *f) {
    f->at += strspn(f->text + f->at, " \t,");
}

bool dalcs_vector_formula_at_end(struct dalcs_vector_formula *f) {
    skip_blanks(f);
    return f->text[f->at] == '\0';
}

static bool take(struct dalcs_vector_formula *f, const char *symbol) {
    f->at += strspn(f->text + f->at, " \t");
    size_t n = strlen(symbol);
    if (strncmp(f->text + f->at, symbol, n) != 0) {
        return false;
    }
    bool is_word = symbol[0] >= 'a' && symbol[0] <= 'z';
    char next = f->text[f->at + n];
    if (is_word && ((next >= 'a' && next <= 'z') || (next >= '0' && next <= '9') || next == '_' ||
                    next == '(')) {
        return false;
    }
    f->at += n;
    return true;
}

static bool is_name_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '#' || c == '@' ||
           c == '.' || c == ':' || c == '$' || (unsigned char)c >= 0x80;
}

/* ---- Names -------------------------------------------------------------------------------------- */

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

static const char *suffix_function(const char *word) {
    static const char *const pair[][2] = {{"", ""},    {"m", "mag"}, {"p", "ph"},
                                          {"r", "re"}, {"i", "im"},  {"db", "db"}};
    for (size_t k = 0; k < sizeof pair / sizeof pair[0]; k++) {
        if (strcmp(word + 1, pair[k][0]) == 0) {
            return pair[k][1];
        }
    }
    return NULL;
}

static struct dalcs_vector *parse_choice(struct dalcs_vector_formula *f);

/* name(formula, formula, ...): behind the parenthesis. */
static struct dalcs_vector *read_call(struct dalcs_vector_formula *f, const char *name) {
    const struct dalcs_vector *argument[DALCS_MOST_ARGUMENTS];
    size_t n = 0;
    do {
        if (n == DALCS_MOST_ARGUMENTS) {
            return dalcs_vector_fail(f, "too many arguments of %s", name);
        }
        argument[n] = parse_choice(f);
        if (argument[n] == NULL) {
            return NULL;
        }
        n++;
    } while (take(f, ","));
    if (!take(f, ")")) {
        return dalcs_vector_fail(f, "expected ')' after the argument of %s", name);
    }
    return dalcs_vector_call(f, name, argument, n);
}

/* The characters of a name; @r1[i] with its brackets. */
static void read_name(struct dalcs_vector_formula *f, char word[DALCS_VECTOR_NAME]) {
    size_t n = 0;
    const char *p = f->text + f->at;
    while (is_name_character(p[n]) && n + 1 < DALCS_VECTOR_NAME) {
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

static struct dalcs_vector *read_word(struct dalcs_vector_formula *f) {
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

/* ---- From tight to loose -------------------------------------------------------------------------- */

static struct dalcs_vector *read_number(struct dalcs_vector_formula *f) {
    char text[64];
    size_t n = 0;
    const char *p = f->text + f->at;
    while (n + 1 < sizeof text &&
           ((p[n] >= '0' && p[n] <= '9') || p[n] == '.' || (p[n] >= 'a' && p[n] <= 'z') ||
            ((p[n] == '+' || p[n] == '-') && n > 0 && p[n - 1] == 'e'))) {
        text[n] = p[n];
        n++;
    }
    text[n] = '\0';
    double value;
    if (dalcs_parse_number(text, &value) != DALCS_OK) {
        return dalcs_vector_fail(f, "'%s' is not a number", text);
    }
    f->at += n;
    return dalcs_vector_number(f, value);
}

/* x[index], or x[from,to] with both ends. */
static struct dalcs_vector *read_index(struct dalcs_vector_formula *f, struct dalcs_vector *v) {
    const struct dalcs_vector *from = parse_choice(f);
    const struct dalcs_vector *to = from != NULL && take(f, ",") ? parse_choice(f) : from;
    if (to == NULL) {
        return NULL;
    }
    if (!take(f, "]")) {
        return dalcs_vector_fail(f, "expected ']' after an index");
    }
    const double first = creal(from->value[0]);
    const double last = creal(to->value[0]);
    if (!(first >= 0.0 && first < (double)v->n && last >= first && last < (double)v->n)) {
        const bool is_first = !(first >= 0.0 && first < (double)v->n);
        return dalcs_vector_fail(f, "index %g of a vector of length %zu", is_first ? first : last,
                                 v->n);
    }
    const size_t at = (size_t)first;
    struct dalcs_vector *part = dalcs_vector_make(f, (size_t)last - at + 1, v->is_complex);
    if (part != NULL) {
        memcpy(part->value, &v->value[at], part->n * sizeof *v->value);
        part->unit = v->unit;
    }
    return part;
}

static struct dalcs_vector *parse_primary(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v;
    skip_blanks(f);
    char c = f->text[f->at];
    if (take(f, "(")) {
        v = parse_choice(f);
        if (v != NULL && !take(f, ")")) {
            v = dalcs_vector_fail(f, "a parenthesis is never closed");
        }
    } else if ((c >= '0' && c <= '9') || c == '.') {
        v = read_number(f);
    } else if (is_name_character(c)) {
        v = read_word(f);
    } else if (c == '\0') {
        v = dalcs_vector_fail(f, "a formula is missing");
    } else {
        v = dalcs_vector_fail(f, "did not expect '%c'", c);
    }
    while (v != NULL && f->text[f->at] == '[') {
        f->at++;
        v = read_index(f, v);
    }
    return v;
}

static struct dalcs_vector *parse_power(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v;
    if (++f->depth > DEEPEST) {
        return dalcs_vector_fail(f, "too many signs and parentheses");
    }
    if (take(f, "-")) {
        v = dalcs_vector_combine(f, DALCS_VECTOR_SUBTRACT, dalcs_vector_number(f, 0.0),
                                 parse_power(f));
    } else if (take(f, "+")) {
        v = parse_power(f);
    } else if (take(f, "~") || take(f, "!")) {
        v = parse_power(f);
        v = v != NULL ? dalcs_vector_call(f, "not", (const struct dalcs_vector *const[]){v}, 1)
                      : NULL;
    } else {
        v = parse_primary(f);
        if (v != NULL && (take(f, "**") || take(f, "^"))) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_POWER, v, parse_power(f));
        }
    }
    f->depth--;
    return v;
}

static struct dalcs_vector *parse_product(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v = parse_power(f);
    for (;;) {
        if (v != NULL && take(f, "*")) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_MULTIPLY, v, parse_power(f));
        } else if (v != NULL && take(f, "/")) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_DIVIDE, v, parse_power(f));
        } else if (v != NULL && take(f, "%")) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_REMAINDER, v, parse_power(f));
        } else {
            return v;
        }
    }
}

static struct dalcs_vector *parse_sum(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v = parse_product(f);
    for (;;) {
        if (v != NULL && take(f, "+")) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_ADD, v, parse_product(f));
        } else if (v != NULL && take(f, "-")) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_SUBTRACT, v, parse_product(f));
        } else {
            return v;
        }
    }
}

static struct dalcs_vector *parse_comparison(struct dalcs_vector_formula *f) {
    static const struct {
        const char *symbol;
        enum dalcs_vector_operation operation;
    } table[] = {{"<=", DALCS_VECTOR_LESS_EQUAL}, {">=", DALCS_VECTOR_GREATER_EQUAL},
                 {"<>", DALCS_VECTOR_UNEQUAL},    {"!=", DALCS_VECTOR_UNEQUAL},
                 {"==", DALCS_VECTOR_EQUAL},      {"<", DALCS_VECTOR_LESS},
                 {">", DALCS_VECTOR_GREATER},     {"=", DALCS_VECTOR_EQUAL},
                 {"le", DALCS_VECTOR_LESS_EQUAL}, {"ge", DALCS_VECTOR_GREATER_EQUAL},
                 {"ne", DALCS_VECTOR_UNEQUAL},    {"eq", DALCS_VECTOR_EQUAL},
                 {"lt", DALCS_VECTOR_LESS},       {"gt", DALCS_VECTOR_GREATER}};

    struct dalcs_vector *v = parse_sum(f);
    for (size_t k = 0; v != NULL && k < sizeof table / sizeof table[0]; k++) {
        if (take(f, table[k].symbol)) {
            v = dalcs_vector_combine(f, table[k].operation, v, parse_sum(f));
            k = 0;
        }
    }
    return v;
}

static struct dalcs_vector *parse_or(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v = parse_comparison(f);
    for (;;) {
        if (v != NULL && (take(f, "&&") || take(f, "&") || take(f, "and"))) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_AND, v, parse_comparison(f));
        } else if (v != NULL && (take(f, "||") || take(f, "|") || take(f, "or"))) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_OR, v, parse_comparison(f));
        } else {
            return v;
        }
    }
}

/* condition ? formula : formula */
static struct dalcs_vector *parse_choice(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v = parse_or(f);
    if (v == NULL || !take(f, "?")) {
        return v;
    }
    if (v->n != 1) {
        return dalcs_vector_fail(f, "what stands before '?' is a vector of length %zu", v->n);
    }
    struct dalcs_vector *yes = parse_choice(f);
    if (yes != NULL && !take(f, ":")) {
        return dalcs_vector_fail(f, "expected ':' after '?'");
    }
    struct dalcs_vector *no = yes != NULL ? parse_choice(f) : NULL;
    return no == NULL ? NULL : v->value[0] != 0.0 ? yes : no;
}

struct dalcs_vector *dalcs_vector_formula_next(struct dalcs_vector_formula *f) {
    skip_blanks(f);
    size_t begin = f->at;
    struct dalcs_vector *v = parse_choice(f);
    if (v == NULL) {
        return NULL;
    }
    size_t end = f->at;
    while (end > begin && (f->text[end - 1] == ' ' || f->text[end - 1] == '\t')) {
        end--;
    }
    v->name = dalcs_arena_copy(f->arena, f->text + begin, end - begin);
    if (v->name == NULL) {
        f->out_of_memory = true;
        return dalcs_vector_fail(f, "out of memory");
    }
    return v;
}

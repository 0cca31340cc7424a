/* vector_formula.c - parses and evaluates in one pass; every value is a vector, a number one of length 1. */
#include "vector_formula.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 100 };

static struct dalcs_vector *fail(struct dalcs_vector_formula *f, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static struct dalcs_vector *fail(struct dalcs_vector_formula *f, const char *format, ...) {
    if (!f->failed) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(f->message, sizeof f->message, format, arguments);
        va_end(arguments);
    }
    f->failed = true;
    return NULL;
}

static struct dalcs_vector *make(struct dalcs_vector_formula *f, size_t n, bool is_complex) {
    struct dalcs_vector *v = dalcs_arena_alloc(f->arena, 1, sizeof *v);
    double complex *value = dalcs_arena_alloc(f->arena, n, sizeof *value);
    if (v == NULL || value == NULL) {
        f->out_of_memory = true;
        return fail(f, "out of memory");
    }
    *v = (struct dalcs_vector){
        .name = "", .unit = DALCS_UNIT_NONE, .n = n, .is_complex = is_complex, .value = value};
    return v;
}

static struct dalcs_vector *number(struct dalcs_vector_formula *f, double value) {
    struct dalcs_vector *v = make(f, 1, false);
    if (v != NULL) {
        v->value[0] = value;
    }
    return v;
}

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

/* ---- Operations --------------------------------------------------------------------------------- */

enum operation {
    ADD,
    SUBTRACT,
    MULTIPLY,
    DIVIDE,
    REMAINDER,
    POWER,
    LESS,
    LESS_EQUAL,
    GREATER,
    GREATER_EQUAL,
    EQUAL,
    UNEQUAL,
    AND,
    OR
};

static double complex apply(enum operation operation, double complex a, double complex b) {
    double x = creal(a);
    double y = creal(b);
    switch (operation) {
    case ADD:
        return a + b;
    case SUBTRACT:
        return a - b;
    case MULTIPLY:
        return cimag(a) == 0.0 && cimag(b) == 0.0 ? x * y : a * b;
    case DIVIDE:
        return cimag(a) == 0.0 && cimag(b) == 0.0 ? x / y : a / b;
    case REMAINDER:
        return fmod(x, y);
    case POWER:
        return cimag(a) == 0.0 && cimag(b) == 0.0 ? pow(x, y) : cpow(a, b);
    case LESS:
        return x < y;
    case LESS_EQUAL:
        return x <= y;
    case GREATER:
        return x > y;
    case GREATER_EQUAL:
        return x >= y;
    case EQUAL:
        return a == b;
    case UNEQUAL:
        return a != b;
    case AND:
        return a != 0.0 && b != 0.0;
    case OR:
        return a != 0.0 || b != 0.0;
    }
    return NAN;
}

static struct dalcs_vector *combine(struct dalcs_vector_formula *f, enum operation operation,
                                    const struct dalcs_vector *a, const struct dalcs_vector *b) {
    if (a == NULL || b == NULL) {
        return NULL;
    }
    if (a->n != b->n && a->n != 1 && b->n != 1) {
        return fail(f, "vectors of different lengths, %zu and %zu", a->n, b->n);
    }
    size_t n = a->n == 1 ? b->n : a->n;
    struct dalcs_vector *v = make(f, n, a->is_complex || b->is_complex);
    for (size_t k = 0; v != NULL && k < n; k++) {
        v->value[k] = apply(operation, a->value[a->n == 1 ? 0 : k], b->value[b->n == 1 ? 0 : k]);
    }
    if (v != NULL && (operation == ADD || operation == SUBTRACT) && a->unit == b->unit) {
        v->unit = a->unit;
    }
    return v;
}

/* ---- Functions ---------------------------------------------------------------------------------- */

static double complex db_of(double complex x) {
    return 20.0 * log10(cabs(x));
}

static double complex angle_of(double complex x) {
    return carg(x);
}

static double complex magnitude_of(double complex x) {
    return cabs(x);
}

static double complex real_of(double complex x) {
    return creal(x);
}

static double complex imaginary_of(double complex x) {
    return cimag(x);
}

static double complex log_of(double complex x) {
    return cimag(x) == 0.0 ? log(creal(x)) : clog(x);
}

static double complex log10_of(double complex x) {
    return cimag(x) == 0.0 ? log10(creal(x)) : clog(x) / log(10.0);
}

static double complex root_of(double complex x) {
    return cimag(x) == 0.0 && creal(x) >= 0.0 ? sqrt(creal(x)) : csqrt(x);
}

static double complex floor_of(double complex x) {
    return floor(creal(x));
}

static double complex ceiling_of(double complex x) {
    return ceil(creal(x));
}

static double complex not_of(double complex x) {
    return x == 0.0;
}

/* A function of the C library that a table names is searched for whenever the program starts; one that is
 * called, when it is called first. */
#define CALL(f)                                                                                    \
    static double complex call_##f(double complex x) {                                             \
        return f(x);                                                                               \
    }
CALL(cexp)
CALL(csin)
CALL(ccos)
CALL(ctan)
CALL(catan)
CALL(csinh)
CALL(ccosh)
CALL(ctanh)
CALL(conj)

static const struct {
    const char *name;
    double complex (*of)(double complex x);
    bool gives_reals;
} EACH[] = {
    {"abs", magnitude_of, true},  {"mag", magnitude_of, true}, {"magnitude", magnitude_of, true},
    {"ph", angle_of, true},       {"phase", angle_of, true},   {"db", db_of, true},
    {"re", real_of, true},        {"real", real_of, true},     {"im", imaginary_of, true},
    {"imag", imaginary_of, true}, {"sqrt", root_of, false},    {"exp", call_cexp, false},
    {"ln", log_of, false},        {"log", log_of, false},      {"log10", log10_of, false},
    {"sin", call_csin, false},    {"cos", call_ccos, false},   {"tan", call_ctan, false},
    {"atan", call_catan, false},  {"sinh", call_csinh, false}, {"cosh", call_ccosh, false},
    {"tanh", call_ctanh, false},  {"floor", floor_of, true},   {"ceil", ceiling_of, true},
    {"not", not_of, true},        {"conj", call_conj, false},
};

static double mean_of(const struct dalcs_vector *v) {
    double sum = 0.0;
    for (size_t k = 0; k < v->n; k++) {
        sum += creal(v->value[k]);
    }
    return v->n > 0 ? sum / (double)v->n : NAN;
}

static double largest_of(const struct dalcs_vector *v) {
    double largest = v->n > 0 ? creal(v->value[0]) : NAN;
    for (size_t k = 1; k < v->n; k++) {
        largest = fmax(largest, creal(v->value[k]));
    }
    return largest;
}

static double smallest_of(const struct dalcs_vector *v) {
    double smallest = v->n > 0 ? creal(v->value[0]) : NAN;
    for (size_t k = 1; k < v->n; k++) {
        smallest = fmin(smallest, creal(v->value[k]));
    }
    return smallest;
}

static double length_of(const struct dalcs_vector *v) {
    return (double)v->n;
}

static const struct {
    const char *name;
    double (*of)(const struct dalcs_vector *v);
} WHOLE[] = {
    {"mean", mean_of},       {"vecmax", largest_of},   {"maximum", largest_of},
    {"vecmin", smallest_of}, {"minimum", smallest_of}, {"length", length_of},
};

static struct dalcs_vector *call(struct dalcs_vector_formula *f, const char *name,
                                 const struct dalcs_vector *x) {
    for (size_t i = 0; i < sizeof EACH / sizeof EACH[0]; i++) {
        if (strcmp(EACH[i].name, name) == 0) {
            struct dalcs_vector *v = make(f, x->n, x->is_complex && !EACH[i].gives_reals);
            for (size_t k = 0; v != NULL && k < x->n; k++) {
                v->value[k] = EACH[i].of(x->value[k]);
                v->is_complex = v->is_complex || cimag(v->value[k]) != 0.0;
            }
            return v;
        }
    }
    for (size_t i = 0; i < sizeof WHOLE / sizeof WHOLE[0]; i++) {
        if (strcmp(WHOLE[i].name, name) == 0) {
            return number(f, WHOLE[i].of(x));
        }
    }
    if (strcmp(name, "vector") == 0 || strcmp(name, "unitvec") == 0) {
        double n = x->n == 1 ? creal(x->value[0]) : -1.0;
        if (!(n >= 1.0 && n <= 1e8)) {
            return fail(f, "%s() takes a length", name);
        }
        struct dalcs_vector *v = make(f, (size_t)n, false);
        for (size_t k = 0; v != NULL && k < v->n; k++) {
            v->value[k] = name[0] == 'u' ? 1.0 : (double)k;
        }
        return v;
    }
    return fail(f, "there is no function '%s'", name);
}

/* ---- Names -------------------------------------------------------------------------------------- */

static struct dalcs_vector *copy_of(struct dalcs_vector_formula *f, const struct dalcs_vector *v) {
    struct dalcs_vector *copy = make(f, v->n, v->is_complex);
    if (copy != NULL) {
        memcpy(copy->value, v->value, v->n * sizeof *v->value);
        copy->unit = v->unit;
    }
    return copy;
}

static struct dalcs_vector *parameter(struct dalcs_vector_formula *f, const char *name) {
    double value;
    enum dalcs_status status = dalcs_session_parameter(f->vectors->session, name, &value);
    if (status == DALCS_E_NOMEM) {
        f->out_of_memory = true;
        return fail(f, "out of memory");
    }
    return status == DALCS_OK ? number(f, value) : NULL;
}

/* A vector, or else a parameter of the netlist; in braces a parameter comes before the voltage of a
 * node of its name. */
static struct dalcs_vector *find(struct dalcs_vector_formula *f, const char *name) {
    const struct dalcs_vector *v = f->vectors->prefers_parameters
                                       ? dalcs_vectors_find_exactly(f->vectors, name)
                                       : dalcs_vectors_find(f->vectors, name);
    struct dalcs_vector *known = v == NULL ? parameter(f, name) : NULL;
    if (known != NULL || f->failed) {
        return known;
    }
    v = v == NULL ? dalcs_vectors_find(f->vectors, name) : v;
    if (v == NULL) {
        if (!f->vectors->has_plot) {
            snprintf(f->hint, sizeof f->hint, "no analysis has been run yet");
        }
        return fail(f, "there is no vector '%s'", name);
    }
    return copy_of(f, v);
}

/* v(a), v(a,b), i(x): the text in parentheses is no formula. `what` may have a suffix: vdb, vm, vp, vr,
 * vi. */
static struct dalcs_vector *read_signal(struct dalcs_vector_formula *f, char letter,
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
        return fail(f, "a parenthesis is never closed");
    }
    f->at = (size_t)(p - f->text) + 1;
    char name[2][210];
    struct dalcs_vector *v = NULL;
    snprintf(name[0], sizeof name[0], "%c(%s)", letter, inside[0]);
    char pair[420];
    snprintf(pair, sizeof pair, "%c(%s,%s)", letter, inside[0], inside[1]);
    if (part == 1 && dalcs_vectors_find(f->vectors, pair) == NULL) {
        snprintf(name[1], sizeof name[1], "%c(%s)", letter, inside[1]);
        struct dalcs_vector *a = strcmp(inside[0], "0") == 0 ? number(f, 0.0) : find(f, name[0]);
        struct dalcs_vector *b = strcmp(inside[1], "0") == 0 ? number(f, 0.0) : find(f, name[1]);
        v = combine(f, SUBTRACT, a, b);
    } else {
        v = find(f, part == 1 ? pair : name[0]);
    }
    return v == NULL || suffix[0] == '\0' ? v : call(f, suffix, v);
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

static struct dalcs_vector *parse_or(struct dalcs_vector_formula *f);

static struct dalcs_vector *read_word(struct dalcs_vector_formula *f) {
    char word[256];
    size_t n = 0;
    const char *p = f->text + f->at;
    while (is_name_character(p[n]) && n + 1 < sizeof word) {
        word[n] = p[n];
        n++;
    }
    word[n] = '\0';
    f->at += n;
    if (word[0] == '@' && f->text[f->at] == '[') {
        while (f->text[f->at] != '\0' && f->text[f->at - 1] != ']' && n + 1 < sizeof word) {
            word[n++] = f->text[f->at++];
        }
        word[n] = '\0';
    }
    if ((strcmp(word, "v") == 0 || strcmp(word, "i") == 0) &&
        strncmp(f->text + f->at, "-sweep", 6) == 0) {
        f->at += 6;
        return find(f, word[0] == 'v' ? "v-sweep" : "i-sweep");
    }
    if (f->text[f->at] != '(') {
        const bool is_pi = strcmp(word, "pi") == 0 && dalcs_vectors_find(f->vectors, word) == NULL;
        return is_pi ? number(f, acos(-1.0)) : find(f, word);
    }
    f->at++;
    const char *suffix = word[0] == 'v' || word[0] == 'i' ? suffix_function(word) : NULL;
    if (suffix != NULL) {
        return read_signal(f, word[0], suffix);
    }
    struct dalcs_vector *argument = parse_or(f);
    if (argument != NULL && !take(f, ")")) {
        return fail(f, "expected ')' after the argument of %s", word);
    }
    return argument != NULL ? call(f, word, argument) : NULL;
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
        return fail(f, "'%s' is not a number", text);
    }
    f->at += n;
    return number(f, value);
}

static struct dalcs_vector *read_index(struct dalcs_vector_formula *f, struct dalcs_vector *v) {
    struct dalcs_vector *index = parse_or(f);
    if (index == NULL) {
        return NULL;
    }
    if (!take(f, "]")) {
        return fail(f, "expected ']' after an index");
    }
    double k = creal(index->value[0]);
    if (!(k >= 0.0 && k < (double)v->n)) {
        return fail(f, "index %g of a vector of length %zu", k, v->n);
    }
    struct dalcs_vector *element = make(f, 1, v->is_complex);
    if (element != NULL) {
        element->value[0] = v->value[(size_t)k];
        element->unit = v->unit;
    }
    return element;
}

static struct dalcs_vector *parse_primary(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v;
    skip_blanks(f);
    char c = f->text[f->at];
    if (take(f, "(")) {
        v = parse_or(f);
        if (v != NULL && !take(f, ")")) {
            v = fail(f, "a parenthesis is never closed");
        }
    } else if ((c >= '0' && c <= '9') || c == '.') {
        v = read_number(f);
    } else if (is_name_character(c)) {
        v = read_word(f);
    } else if (c == '\0') {
        v = fail(f, "a formula is missing");
    } else {
        v = fail(f, "did not expect '%c'", c);
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
        return fail(f, "too many signs and parentheses");
    }
    if (take(f, "-")) {
        v = combine(f, SUBTRACT, number(f, 0.0), parse_power(f));
    } else if (take(f, "+")) {
        v = parse_power(f);
    } else if (take(f, "~") || take(f, "!")) {
        v = parse_power(f);
        v = v != NULL ? call(f, "not", v) : NULL;
    } else {
        v = parse_primary(f);
        if (v != NULL && (take(f, "**") || take(f, "^"))) {
            v = combine(f, POWER, v, parse_power(f));
        }
    }
    f->depth--;
    return v;
}

static struct dalcs_vector *parse_product(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v = parse_power(f);
    for (;;) {
        if (v != NULL && take(f, "*")) {
            v = combine(f, MULTIPLY, v, parse_power(f));
        } else if (v != NULL && take(f, "/")) {
            v = combine(f, DIVIDE, v, parse_power(f));
        } else if (v != NULL && take(f, "%")) {
            v = combine(f, REMAINDER, v, parse_power(f));
        } else {
            return v;
        }
    }
}

static struct dalcs_vector *parse_sum(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v = parse_product(f);
    for (;;) {
        if (v != NULL && take(f, "+")) {
            v = combine(f, ADD, v, parse_product(f));
        } else if (v != NULL && take(f, "-")) {
            v = combine(f, SUBTRACT, v, parse_product(f));
        } else {
            return v;
        }
    }
}

static struct dalcs_vector *parse_comparison(struct dalcs_vector_formula *f) {
    static const struct {
        const char *symbol;
        enum operation operation;
    } table[] = {{"<=", LESS_EQUAL}, {">=", GREATER_EQUAL}, {"<>", UNEQUAL}, {"!=", UNEQUAL},
                 {"==", EQUAL},      {"<", LESS},           {">", GREATER},  {"=", EQUAL},
                 {"le", LESS_EQUAL}, {"ge", GREATER_EQUAL}, {"ne", UNEQUAL}, {"eq", EQUAL},
                 {"lt", LESS},       {"gt", GREATER}};

    struct dalcs_vector *v = parse_sum(f);
    for (size_t k = 0; v != NULL && k < sizeof table / sizeof table[0]; k++) {
        if (take(f, table[k].symbol)) {
            v = combine(f, table[k].operation, v, parse_sum(f));
            k = 0;
        }
    }
    return v;
}

static struct dalcs_vector *parse_or(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v = parse_comparison(f);
    for (;;) {
        if (v != NULL && (take(f, "&&") || take(f, "&") || take(f, "and"))) {
            v = combine(f, AND, v, parse_comparison(f));
        } else if (v != NULL && (take(f, "||") || take(f, "|") || take(f, "or"))) {
            v = combine(f, OR, v, parse_comparison(f));
        } else {
            return v;
        }
    }
}

struct dalcs_vector *dalcs_vector_formula_next(struct dalcs_vector_formula *f) {
    skip_blanks(f);
    size_t begin = f->at;
    struct dalcs_vector *v = parse_or(f);
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
        return fail(f, "out of memory");
    }
    return v;
}

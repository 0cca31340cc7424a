/* vector_formula.c - parses and evaluates in one pass. */
#include "vector_formula.h"

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

bool dalcs_vector_formula_take(struct dalcs_vector_formula *f, const char *symbol) {
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

bool dalcs_vector_formula_is_of_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '#' || c == '@' ||
           c == '.' || c == ':' || c == '$' || (unsigned char)c >= 0x80;
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
    const struct dalcs_vector *from = dalcs_vector_formula_choice(f);
    const struct dalcs_vector *to =
        from != NULL && dalcs_vector_formula_take(f, ",") ? dalcs_vector_formula_choice(f) : from;
    if (to == NULL) {
        return NULL;
    }
    if (!dalcs_vector_formula_take(f, "]")) {
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

/* (re, im), behind its comma. Of parts that are complex themselves ngspice makes what is no number of algebra. */
static struct dalcs_vector *read_imaginary(struct dalcs_vector_formula *f,
                                           struct dalcs_vector *re) {
    struct dalcs_vector *im = dalcs_vector_formula_choice(f);
    if (im != NULL && (re->is_complex || im->is_complex)) {
        return dalcs_vector_fail(f, "the two parts of a complex number must be real");
    }
    struct dalcs_vector *unit = im != NULL ? dalcs_vector_make(f, 1, true) : NULL;
    if (unit == NULL) {
        return NULL;
    }
    unit->value[0] = I;
    im = dalcs_vector_combine(f, DALCS_VECTOR_MULTIPLY, im, unit);
    return im != NULL ? dalcs_vector_combine(f, DALCS_VECTOR_ADD, re, im) : NULL;
}

static struct dalcs_vector *parse_primary(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v;
    skip_blanks(f);
    char c = f->text[f->at];
    if (dalcs_vector_formula_take(f, "(")) {
        v = dalcs_vector_formula_choice(f);
        if (v != NULL && dalcs_vector_formula_take(f, ",")) {
            v = read_imaginary(f, v);
        }
        if (v != NULL && !dalcs_vector_formula_take(f, ")")) {
            v = dalcs_vector_fail(f, "a parenthesis is never closed");
        }
    } else if ((c >= '0' && c <= '9') || c == '.') {
        v = read_number(f);
    } else if (dalcs_vector_formula_is_of_name(c)) {
        v = dalcs_vector_formula_word(f);
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
    if (dalcs_vector_formula_take(f, "-")) {
        v = dalcs_vector_combine(f, DALCS_VECTOR_SUBTRACT, dalcs_vector_number(f, 0.0),
                                 parse_power(f));
    } else if (dalcs_vector_formula_take(f, "+")) {
        v = parse_power(f);
    } else if (dalcs_vector_formula_take(f, "~") || dalcs_vector_formula_take(f, "!")) {
        v = parse_power(f);
        v = v != NULL ? dalcs_vector_call(f, "not", (const struct dalcs_vector *const[]){v}, 1)
                      : NULL;
    } else {
        v = parse_primary(f);
        if (v != NULL &&
            (dalcs_vector_formula_take(f, "**") || dalcs_vector_formula_take(f, "^"))) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_POWER, v, parse_power(f));
        }
    }
    f->depth--;
    return v;
}

static struct dalcs_vector *parse_product(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v = parse_power(f);
    for (;;) {
        if (v != NULL && dalcs_vector_formula_take(f, "*")) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_MULTIPLY, v, parse_power(f));
        } else if (v != NULL && dalcs_vector_formula_take(f, "/")) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_DIVIDE, v, parse_power(f));
        } else if (v != NULL && dalcs_vector_formula_take(f, "%")) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_REMAINDER, v, parse_power(f));
        } else {
            return v;
        }
    }
}

static struct dalcs_vector *parse_sum(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v = parse_product(f);
    for (;;) {
        if (v != NULL && dalcs_vector_formula_take(f, "+")) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_ADD, v, parse_product(f));
        } else if (v != NULL && dalcs_vector_formula_take(f, "-")) {
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
        if (dalcs_vector_formula_take(f, table[k].symbol)) {
            v = dalcs_vector_combine(f, table[k].operation, v, parse_sum(f));
            k = 0;
        }
    }
    return v;
}

static struct dalcs_vector *parse_or(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v = parse_comparison(f);
    for (;;) {
        if (v != NULL && (dalcs_vector_formula_take(f, "&&") || dalcs_vector_formula_take(f, "&") ||
                          dalcs_vector_formula_take(f, "and"))) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_AND, v, parse_comparison(f));
        } else if (v != NULL &&
                   (dalcs_vector_formula_take(f, "||") || dalcs_vector_formula_take(f, "|") ||
                    dalcs_vector_formula_take(f, "or"))) {
            v = dalcs_vector_combine(f, DALCS_VECTOR_OR, v, parse_comparison(f));
        } else {
            return v;
        }
    }
}

struct dalcs_vector *dalcs_vector_formula_choice(struct dalcs_vector_formula *f) {
    struct dalcs_vector *v = parse_or(f);
    if (v == NULL || !dalcs_vector_formula_take(f, "?")) {
        return v;
    }
    if (v->n != 1) {
        return dalcs_vector_fail(f, "what stands before '?' is a vector of length %zu", v->n);
    }
    struct dalcs_vector *yes = dalcs_vector_formula_choice(f);
    if (yes != NULL && !dalcs_vector_formula_take(f, ":")) {
        return dalcs_vector_fail(f, "expected ':' after '?'");
    }
    struct dalcs_vector *no = yes != NULL ? dalcs_vector_formula_choice(f) : NULL;
    return no == NULL ? NULL : v->value[0] != 0.0 ? yes : no;
}

struct dalcs_vector *dalcs_vector_formula_next(struct dalcs_vector_formula *f) {
    skip_blanks(f);
    size_t begin = f->at;
    struct dalcs_vector *v = dalcs_vector_formula_choice(f);
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

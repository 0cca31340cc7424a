/* drawn_signal.c - a recursive-descent parser and the tree that it makes. */
#include "drawn_signal.h"

#include "names.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { MAX_DEPTH = 100, MAX_NAMES = 12, MAX_LENGTH = 4000 };

enum operation { NUMBER, COLUMN, NEGATE, ADD, SUBTRACT, MULTIPLY, DIVIDE, ABS, SQRT, DB };

struct dalcs_signal_node {
    enum operation operation;
    size_t column;
    double number;
    struct dalcs_dimension dimension;
    const struct dalcs_signal_node *left, *right;
};

struct parser {
    const struct dalcs_waveforms *waveforms;
    struct dalcs_arena *arena;
    struct dalcs_diag *diag;
    const char *text; /* without blanks */
    const char *at;
    int depth;
};

static const struct {
    const char *name;
    enum operation operation;
} function[] = {{"abs", ABS}, {"sqrt", SQRT}, {"db", DB}};

/* ---- Names ---------------------------------------------------------------------------------- */

long dalcs_signal_find_column(const struct dalcs_waveforms *waveforms, const char *name) {
    for (size_t c = 0; c < waveforms->n_columns; c++) {
        if (strcasecmp(waveforms->name[c], name) == 0) {
            return (long)c;
        }
    }
    return -1;
}

/* The other names that ngspice has for the current i(x). */
static long find_current(const struct dalcs_waveforms *waveforms, const char *name) {
    static const struct {
        const char *before, *after;
    } form[] = {{"", "#branch"}, {"@", "[i]"}, {"@", "[id]"}, {"i(@", "[i])"}, {"i(@", "[id])"}};

    size_t length = strlen(name);
    char other[128];
    if (length < 4 || length > sizeof other - 16 || strncasecmp(name, "i(", 2) != 0) {
        return -1;
    }
    for (size_t i = 0; i < sizeof form / sizeof form[0]; i++) {
        snprintf(other, sizeof other, "%s%.*s%s", form[i].before, (int)length - 3, name + 2,
                 form[i].after);
        long column = dalcs_signal_find_column(waveforms, other);
        if (column >= 0) {
            return column;
        }
    }
    return -1;
}

static bool is_ground(const char *node) {
    return strcmp(node, "0") == 0 || strcasecmp(node, "gnd") == 0;
}

static enum dalcs_status refuse_name(struct parser *parser, const char *name) {
    const struct dalcs_waveforms *w = parser->waveforms;
    const char *nearest = dalcs_names_nearest_of(w->name, w->n_columns, name);
    struct dalcs_names names = {0};
    const char *all = NULL;
    for (size_t c = 0; c < w->n_columns && c <= MAX_NAMES; c++) {
        if (dalcs_names_find(&names, w->name[c]) < 0 &&
            dalcs_names_add(&names, w->name[c], 0) != DALCS_OK) {
            break;
        }
    }
    all = dalcs_names_join(&names, MAX_NAMES, parser->arena);
    const char *hint = all ? dalcs_arena_printf(parser->arena, "the file has %s", all) : NULL;
    dalcs_names_finish(&names);
    dalcs_diag_add(parser->diag, DALCS_ERROR, NULL, hint, "there is no signal '%s'%s%s%s", name,
                   nearest ? "; did you mean '" : "", nearest ? nearest : "", nearest ? "'?" : "");
    return DALCS_E_OPTION;
}

/* ---- The tree ------------------------------------------------------------------------------- */

static enum dalcs_status make(struct parser *parser, const struct dalcs_signal_node *value,
                              const struct dalcs_signal_node **node) {
    struct dalcs_signal_node *made = dalcs_arena_alloc(parser->arena, 1, sizeof *made);
    if (!made) {
        return DALCS_E_NOMEM;
    }
    *made = *value;
    *node = made;
    return DALCS_OK;
}

static bool is_number(const struct dalcs_signal_node *node) {
    return dalcs_dimension_equal(node->dimension, (struct dalcs_dimension){0});
}

/* A plain number takes the unit of what it is added to; two different units give none. */
static struct dalcs_dimension sum_dimension(const struct dalcs_signal_node *a,
                                            const struct dalcs_signal_node *b) {
    if (is_number(a) || dalcs_dimension_equal(a->dimension, b->dimension)) {
        return b->dimension;
    }
    return is_number(b) ? a->dimension : (struct dalcs_dimension){0};
}

static enum dalcs_status combine(struct parser *parser, enum operation operation,
                                 const struct dalcs_signal_node *left,
                                 const struct dalcs_signal_node *right,
                                 const struct dalcs_signal_node **node) {
    struct dalcs_signal_node value = {.operation = operation, .left = left, .right = right};
    if (operation == ADD || operation == SUBTRACT) {
        value.dimension = sum_dimension(left, right);
    } else if (operation == MULTIPLY || operation == DIVIDE) {
        value.dimension = dalcs_dimension_multiply(left->dimension, right->dimension,
                                                   operation == MULTIPLY ? 1 : -1);
    } else if (operation == NEGATE || operation == ABS) {
        value.dimension = left->dimension;
    } else if (operation == DB) {
        value.dimension.decibel = true;
    }
    return make(parser, &value, node);
}

static enum dalcs_status take_column(struct parser *parser, size_t column,
                                     const struct dalcs_signal_node **node) {
    const struct dalcs_signal_node value = {
        .operation = COLUMN, .column = column, .dimension = parser->waveforms->dimension[column]};
    return make(parser, &value, node);
}

/* The voltage of a node against ground. */
static enum dalcs_status take_node(struct parser *parser, const char *node_name,
                                   const struct dalcs_signal_node **node) {
    if (is_ground(node_name)) {
        const struct dalcs_signal_node zero = {.operation = NUMBER, .dimension = {.volt = 1}};
        return make(parser, &zero, node);
    }
    const char *name = dalcs_arena_printf(parser->arena, "v(%s)", node_name);
    if (!name) {
        return DALCS_E_NOMEM;
    }
    long column = dalcs_signal_find_column(parser->waveforms, name);
    return column >= 0 ? take_column(parser, (size_t)column, node) : refuse_name(parser, name);
}

static enum dalcs_status take_name(struct parser *parser, char *name,
                                   const struct dalcs_signal_node **node) {
    long column = dalcs_signal_find_column(parser->waveforms, name);
    if (column < 0) {
        column = find_current(parser->waveforms, name);
    }
    if (column >= 0) {
        return take_column(parser, (size_t)column, node);
    }
    char *comma = strchr(name, ',');
    size_t length = strlen(name);
    if (!comma || strncasecmp(name, "v(", 2) != 0) {
        return refuse_name(parser, name);
    }
    const struct dalcs_signal_node *plus = NULL, *minus = NULL;
    *comma = '\0';
    name[length - 1] = '\0'; /* the parenthesis */
    DALCS_TRY(take_node(parser, name + 2, &plus));
    DALCS_TRY(take_node(parser, comma + 1, &minus));
    return combine(parser, SUBTRACT, plus, minus, node);
}

/* ---- The parser ------------------------------------------------------------------------------ */

static enum dalcs_status parse_sum(struct parser *parser, const struct dalcs_signal_node **node);

static enum dalcs_status refuse(struct parser *parser, const char *wanted) {
    dalcs_diag_add(parser->diag, DALCS_ERROR, NULL, NULL, "'%s': %s %s%s%s", parser->text, wanted,
                   *parser->at ? "at '" : "at the end", parser->at, *parser->at ? "'" : "");
    return DALCS_E_OPTION;
}

static bool is_name_character(char c) {
    return isalnum((unsigned char)c) || (c & 0x80) || (c != '\0' && strchr("_.#@[]$:!", c));
}

static enum dalcs_status parse_parenthesis(struct parser *parser,
                                           const struct dalcs_signal_node **node) {
    parser->at++;
    DALCS_TRY(parse_sum(parser, node));
    if (*parser->at != ')') {
        return refuse(parser, "')' is missing");
    }
    parser->at++;
    return DALCS_OK;
}

/* A name with what stands in parentheses behind it, whatever that is: nodes may have any name. */
static enum dalcs_status parse_name(struct parser *parser, const struct dalcs_signal_node **node) {
    const char *start = parser->at;
    while (is_name_character(*parser->at)) {
        parser->at++;
    }
    size_t length = (size_t)(parser->at - start);
    if (*parser->at == '(') {
        for (size_t i = 0; i < sizeof function / sizeof function[0]; i++) {
            if (strlen(function[i].name) == length &&
                strncasecmp(start, function[i].name, length) == 0) {
                DALCS_TRY(parse_parenthesis(parser, node));
                return combine(parser, function[i].operation, *node, NULL, node);
            }
        }
        int depth = 0;
        do {
            depth += *parser->at == '(' ? 1 : *parser->at == ')' ? -1 : 0;
            parser->at++;
        } while (depth > 0 && *parser->at);
        if (depth > 0) {
            return refuse(parser, "')' is missing");
        }
    }
    char *name = dalcs_arena_copy(parser->arena, start, (size_t)(parser->at - start));
    return name ? take_name(parser, name, node) : DALCS_E_NOMEM;
}

static enum dalcs_status parse_number(struct parser *parser,
                                      const struct dalcs_signal_node **node) {
    const char *end = parser->at;
    while (isalnum((unsigned char)*end) || *end == '.' ||
           ((*end == '-' || *end == '+') && (end[-1] == 'e' || end[-1] == 'E'))) {
        end++;
    }
    struct dalcs_signal_node value = {.operation = NUMBER};
    char *word = dalcs_arena_copy(parser->arena, parser->at, (size_t)(end - parser->at));
    if (!word) {
        return DALCS_E_NOMEM;
    }
    if (dalcs_parse_number(word, &value.number) != DALCS_OK) {
        return refuse(parser, "expected a number");
    }
    parser->at = end;
    return make(parser, &value, node);
}

static enum dalcs_status parse_factor(struct parser *parser,
                                      const struct dalcs_signal_node **node) {
    bool negative = false;
    while (*parser->at == '-' || *parser->at == '+') {
        negative ^= *parser->at == '-';
        parser->at++;
    }
    bool number = isdigit((unsigned char)*parser->at) ||
                  (*parser->at == '.' && isdigit((unsigned char)parser->at[1]));
    if (*parser->at == '(') {
        DALCS_TRY(parse_parenthesis(parser, node));
    } else if (number) {
        DALCS_TRY(parse_number(parser, node));
    } else if (is_name_character(*parser->at)) {
        DALCS_TRY(parse_name(parser, node));
    } else {
        return refuse(parser, "expected a signal");
    }
    return negative ? combine(parser, NEGATE, *node, NULL, node) : DALCS_OK;
}

static enum dalcs_status parse_product(struct parser *parser,
                                       const struct dalcs_signal_node **node) {
    DALCS_TRY(parse_factor(parser, node));
    while (*parser->at == '*' || *parser->at == '/') {
        enum operation operation = *parser->at++ == '*' ? MULTIPLY : DIVIDE;
        const struct dalcs_signal_node *right = NULL;
        DALCS_TRY(parse_factor(parser, &right));
        DALCS_TRY(combine(parser, operation, *node, right, node));
    }
    return DALCS_OK;
}

static enum dalcs_status parse_sum(struct parser *parser, const struct dalcs_signal_node **node) {
    if (++parser->depth > MAX_DEPTH) {
        return refuse(parser, "too many parentheses");
    }
    DALCS_TRY(parse_product(parser, node));
    while (*parser->at == '+' || *parser->at == '-') {
        enum operation operation = *parser->at++ == '+' ? ADD : SUBTRACT;
        const struct dalcs_signal_node *right = NULL;
        DALCS_TRY(parse_product(parser, &right));
        DALCS_TRY(combine(parser, operation, *node, right, node));
    }
    parser->depth--;
    return DALCS_OK;
}

enum dalcs_status dalcs_signal_parse(struct dalcs_signal *signal,
                                     const struct dalcs_waveforms *waveforms, const char *text,
                                     struct dalcs_arena *arena, struct dalcs_diag *diag) {
    if (strlen(text) > MAX_LENGTH) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "an expression of more than %d characters",
                       MAX_LENGTH);
        return DALCS_E_OPTION;
    }
    char *bare = dalcs_arena_alloc(arena, strlen(text) + 1, 1);
    if (!bare) {
        return DALCS_E_NOMEM;
    }
    char *to = bare;
    for (const char *from = text; *from; from++) {
        if (*from != ' ' && *from != '\t') {
            *to++ = *from;
        }
    }
    struct parser parser = {waveforms, arena, diag, bare, bare, 0};
    *signal = (struct dalcs_signal){.text = bare};
    DALCS_TRY(parse_sum(&parser, &signal->root));
    if (*parser.at) {
        return refuse(&parser, "expected an operator or a comma");
    }
    signal->dimension = signal->root->dimension;
    return DALCS_OK;
}

enum dalcs_status dalcs_signal_of_column(struct dalcs_signal *signal,
                                         const struct dalcs_waveforms *waveforms, size_t column,
                                         struct dalcs_arena *arena) {
    struct parser parser = {.waveforms = waveforms, .arena = arena};
    *signal = (struct dalcs_signal){.text = waveforms->name[column],
                                    .dimension = waveforms->dimension[column]};
    return take_column(&parser, column, &signal->root);
}

static double evaluate(const struct dalcs_signal_node *node, const double *row) {
    switch (node->operation) {
    case NUMBER:
        return node->number;
    case COLUMN:
        return row[node->column];
    case NEGATE:
        return -evaluate(node->left, row);
    case ADD:
        return evaluate(node->left, row) + evaluate(node->right, row);
    case SUBTRACT:
        return evaluate(node->left, row) - evaluate(node->right, row);
    case MULTIPLY:
        return evaluate(node->left, row) * evaluate(node->right, row);
    case DIVIDE:
        return evaluate(node->left, row) / evaluate(node->right, row);
    case ABS:
        return fabs(evaluate(node->left, row));
    case SQRT:
        return sqrt(evaluate(node->left, row));
    case DB:
        return 20.0 * log10(fabs(evaluate(node->left, row)));
    }
    return NAN;
}

double dalcs_signal_value(const struct dalcs_signal *signal, const double *row) {
    return evaluate(signal->root, row);
}

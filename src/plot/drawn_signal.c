/* drawn_signal.c - a recursive-descent parser of what is drawn, and its values. */
#include "drawn_tree.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include <strings.h>

static const struct {
    const char *name;
    enum dalcs_drawn_operation operation;
} function[] = {{"abs", DALCS_DRAWN_ABS}, {"sqrt", DALCS_DRAWN_SQRT}, {"db", DALCS_DRAWN_DB}};

static enum dalcs_status parse_sum(struct dalcs_drawn_parser *parser,
                                   const struct dalcs_signal_node **node);

static enum dalcs_status refuse(struct dalcs_drawn_parser *parser, const char *wanted) {
    dalcs_diag_add(parser->diag, DALCS_ERROR, NULL, NULL, "'%s': %s %s%s%s", parser->text, wanted,
                   *parser->at ? "at '" : "at the end", parser->at, *parser->at ? "'" : "");
    return DALCS_E_OPTION;
}

static bool is_name_character(char c) {
    return isalnum((unsigned char)c) || (c & 0x80) || (c != '\0' && strchr("_.#@[]$:!", c));
}

static enum dalcs_status parse_parenthesis(struct dalcs_drawn_parser *parser,
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
static enum dalcs_status parse_name(struct dalcs_drawn_parser *parser,
                                    const struct dalcs_signal_node **node) {
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
                return dalcs_drawn_combine(parser, function[i].operation, *node, NULL, node);
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
    return name ? dalcs_drawn_name(parser, name, node) : DALCS_E_NOMEM;
}

static enum dalcs_status parse_number(struct dalcs_drawn_parser *parser,
                                      const struct dalcs_signal_node **node) {
    const char *end = parser->at;
    while (isalnum((unsigned char)*end) || *end == '.' ||
           ((*end == '-' || *end == '+') && (end[-1] == 'e' || end[-1] == 'E'))) {
        end++;
    }
    struct dalcs_signal_node value = {.operation = DALCS_DRAWN_NUMBER};
    char *word = dalcs_arena_copy(parser->arena, parser->at, (size_t)(end - parser->at));
    if (!word) {
        return DALCS_E_NOMEM;
    }
    if (dalcs_parse_number(word, &value.number) != DALCS_OK) {
        return refuse(parser, "expected a number");
    }
    parser->at = end;
    return dalcs_drawn_make(parser, &value, node);
}

static enum dalcs_status parse_factor(struct dalcs_drawn_parser *parser,
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
    return negative ? dalcs_drawn_combine(parser, DALCS_DRAWN_NEGATE, *node, NULL, node) : DALCS_OK;
}

static enum dalcs_status parse_product(struct dalcs_drawn_parser *parser,
                                       const struct dalcs_signal_node **node) {
    DALCS_TRY(parse_factor(parser, node));
    while (*parser->at == '*' || *parser->at == '/') {
        enum dalcs_drawn_operation operation =
            *parser->at++ == '*' ? DALCS_DRAWN_MULTIPLY : DALCS_DRAWN_DIVIDE;
        const struct dalcs_signal_node *right = NULL;
        DALCS_TRY(parse_factor(parser, &right));
        DALCS_TRY(dalcs_drawn_combine(parser, operation, *node, right, node));
    }
    return DALCS_OK;
}

static enum dalcs_status parse_sum(struct dalcs_drawn_parser *parser,
                                   const struct dalcs_signal_node **node) {
    if (++parser->depth > DALCS_DRAWN_DEPTH) {
        return refuse(parser, "too many parentheses");
    }
    DALCS_TRY(parse_product(parser, node));
    while (*parser->at == '+' || *parser->at == '-') {
        enum dalcs_drawn_operation operation =
            *parser->at++ == '+' ? DALCS_DRAWN_ADD : DALCS_DRAWN_SUBTRACT;
        const struct dalcs_signal_node *right = NULL;
        DALCS_TRY(parse_product(parser, &right));
        DALCS_TRY(dalcs_drawn_combine(parser, operation, *node, right, node));
    }
    parser->depth--;
    return DALCS_OK;
}

enum dalcs_status dalcs_signal_parse(struct dalcs_signal *signal,
                                     const struct dalcs_waveforms *waveforms, const char *text,
                                     struct dalcs_arena *arena, struct dalcs_diag *diag) {
    if (strlen(text) > DALCS_DRAWN_LENGTH) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "an expression of more than %d characters",
                       DALCS_DRAWN_LENGTH);
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
    struct dalcs_drawn_parser parser = {waveforms, arena, diag, bare, bare, 0};
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
    struct dalcs_drawn_parser parser = {.waveforms = waveforms, .arena = arena};
    *signal = (struct dalcs_signal){.text = waveforms->name[column],
                                    .dimension = waveforms->dimension[column]};
    return dalcs_drawn_column(&parser, column, &signal->root);
}

static double evaluate(const struct dalcs_signal_node *node, const double *row) {
    switch (node->operation) {
    case DALCS_DRAWN_NUMBER:
        return node->number;
    case DALCS_DRAWN_COLUMN:
        return row[node->column];
    case DALCS_DRAWN_NEGATE:
        return -evaluate(node->left, row);
    case DALCS_DRAWN_ADD:
        return evaluate(node->left, row) + evaluate(node->right, row);
    case DALCS_DRAWN_SUBTRACT:
        return evaluate(node->left, row) - evaluate(node->right, row);
    case DALCS_DRAWN_MULTIPLY:
        return evaluate(node->left, row) * evaluate(node->right, row);
    case DALCS_DRAWN_DIVIDE:
        return evaluate(node->left, row) / evaluate(node->right, row);
    case DALCS_DRAWN_ABS:
        return fabs(evaluate(node->left, row));
    case DALCS_DRAWN_SQRT:
        return sqrt(evaluate(node->left, row));
    case DALCS_DRAWN_DB:
        return 20.0 * log10(fabs(evaluate(node->left, row)));
    }
    return NAN;
}

double dalcs_signal_value(const struct dalcs_signal *signal, const double *row) {
    return evaluate(signal->root, row);
}

/* reader.c - walks over the tokens of one card: numbers, names, nodes, parameters.
 *
 * Every function reports a missing or wrong token, at its place. Numbers
 * whose suffix is often meant otherwise (1M of resistance, 1F of capacitance) get a warning. */
#include "reader.h"
#include "number.h"

#include <math.h>
#include <string.h>

struct dalcs_reader dalcs_reader_start(struct dalcs_builder *builder, const struct dalcs_card *card,
                                       const char *usage) {
    return (struct dalcs_reader){.builder = builder, .card = card, .at = 1, .usage = usage};
}

const struct dalcs_token *dalcs_reader_peek(const struct dalcs_reader *reader, int ahead) {
    const int at = reader->at + ahead;
    return at < reader->card->n ? &reader->card->token[at] : NULL;
}

const struct dalcs_token *dalcs_reader_previous(const struct dalcs_reader *reader) {
    return &reader->card->token[reader->at - 1];
}

bool dalcs_reader_at_end(const struct dalcs_reader *reader) {
    return reader->at >= reader->card->n;
}

bool dalcs_reader_take_word(struct dalcs_reader *reader, const char *word) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    if (token == NULL || token->kind != DALCS_TOKEN_WORD || strcmp(token->text, word) != 0) {
        return false;
    }
    reader->at++;
    return true;
}

bool dalcs_reader_take(struct dalcs_reader *reader, enum dalcs_token_kind kind) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    if (token == NULL || token->kind != kind) {
        return false;
    }
    reader->at++;
    return true;
}

const struct dalcs_token *dalcs_reader_take_parameter(struct dalcs_reader *reader) {
    const struct dalcs_token *name = dalcs_reader_peek(reader, 0);
    const struct dalcs_token *equal = dalcs_reader_peek(reader, 1);
    if (name == NULL || name->kind != DALCS_TOKEN_WORD || equal == NULL ||
        equal->kind != DALCS_TOKEN_EQUAL) {
        return NULL;
    }
    reader->at += 2;
    return name;
}

void dalcs_reader_missing(struct dalcs_reader *reader, const char *what) {
    const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
    if (next != NULL && next->kind != DALCS_TOKEN_BAD) {
        dalcs_builder_error(reader->builder, next, reader->usage, "expected %s before '%s'", what,
                            next->text);
    } else if (next == NULL) {
        const struct dalcs_location where = dalcs_token_end(dalcs_reader_previous(reader));
        dalcs_builder_error_at(reader->builder, &where, reader->usage, "%s is missing", what);
    }
    reader->builder->failed = true;
}

static const char *brace_hint(struct dalcs_builder *builder, const struct dalcs_token *token) {
    return dalcs_builder_hint(builder, "a formula has braces: write {%s}", token->text);
}

static bool is_formula(const struct dalcs_token *token) {
    return token->kind == DALCS_TOKEN_WORD && strpbrk(token->text, "*/") != NULL;
}

/* Is it the suffix or the unit of the number before it, as in "100 uF"? Not F: a number with it would be femto. */
static bool is_unit(const struct dalcs_reader *reader, const struct dalcs_token *token) {
    static const char *const units[] = {"f", "h", "v", "a", "s", "hz", "ohm", "ohms"};

    enum { N = sizeof units / sizeof units[0] };
    const struct dalcs_token *number = reader->at > 0 ? dalcs_reader_previous(reader) : token;
    const bool are_words =
        token->kind == DALCS_TOKEN_WORD && number->kind == DALCS_TOKEN_WORD && number != token;
    if (!are_words || strcmp(token->text, "f") == 0 ||
        number->text[strspn(number->text, "0123456789.")] != '\0') {
        return false;
    }
    const bool is_mega = strncmp(token->text, "meg", 3) == 0;
    const size_t prefix = is_mega ? 3 : strspn(token->text, "fpnumkgt") > 0 ? 1 : 0;
    const char *unit = token->text + prefix;
    return dalcs_builder_is_one_of(token->text, units, N) ||
           (prefix > 0 && (*unit == '\0' || dalcs_builder_is_one_of(unit, units, N)));
}

const char *dalcs_reader_unit_hint(const struct dalcs_reader *reader,
                                   const struct dalcs_token *token, const char *otherwise) {
    return is_unit(reader, token)
               ? dalcs_builder_hint(reader->builder, "a value is one word: write %s%s",
                                    dalcs_reader_previous(reader)->text, token->text)
               : otherwise;
}

/* A name of .param, or a formula, that stands where a number is wanted; else how the card is written. */
static const char *hint_of_formula(const struct dalcs_reader *reader,
                                   const struct dalcs_token *token) {
    double value;
    const bool is_name = token->kind == DALCS_TOKEN_WORD &&
                         dalcs_deck_parameter(reader->builder->deck, token->text, &value);
    return is_name || is_formula(token) ? brace_hint(reader->builder, token) : reader->usage;
}

void dalcs_reader_unexpected(struct dalcs_reader *reader) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    reader->builder->failed = true;
    if (token == NULL || token->kind == DALCS_TOKEN_BAD) {
        return;
    }
    const char *hint = dalcs_reader_unit_hint(reader, token, hint_of_formula(reader, token));
    dalcs_builder_error(reader->builder, token, hint, "did not expect '%s' here", token->text);
}

bool dalcs_reader_end(struct dalcs_reader *reader) {
    if (dalcs_reader_at_end(reader)) {
        return true;
    }
    dalcs_reader_unexpected(reader);
    return false;
}

/* ---- Numbers ------------------------------------------------------------------------------- */

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool dalcs_reader_is_number(const struct dalcs_token *token) {
    const char *p = token->text;
    if (token->kind == DALCS_TOKEN_NUMBER || token->kind == DALCS_TOKEN_EXPRESSION ||
        token->kind == DALCS_TOKEN_BAD) {
        return true;
    }
    p += *p == '+' || *p == '-';
    p += *p == '.';
    return token->kind == DALCS_TOKEN_WORD && is_digit(*p);
}

/* 4k7 -> "write 4.7k", when the text has that shape; else NULL. */
static const char *rkm_hint(struct dalcs_builder *builder, const char *text) {
    static const char *const suffixes[] = {"r", "v", "t", "g", "meg",      "k",       "m",
                                           "u", "n", "p", "f", "\xC2\xB5", "\xCE\xBC"};
    const int sign = text[0] == '-' || text[0] == '+';
    const int whole = sign + (int)strspn(text + sign, "0123456789");
    const char *suffix = text + whole;
    const int length = (int)strcspn(suffix, "0123456789.");
    const char *rest = suffix + length;
    if (rest[0] == '\0' || rest[strspn(rest, "0123456789")] != '\0') {
        return NULL;
    }
    for (size_t k = 0; k < sizeof suffixes / sizeof suffixes[0]; k++) {
        if ((int)strlen(suffixes[k]) == length &&
            strncmp(suffix, suffixes[k], strlen(suffixes[k])) == 0) {
            /* The first two are no suffixes, they only stand for the point. */
            return dalcs_builder_hint(builder, "write %.*s.%s%.*s", whole, text, rest,
                                      k < 2 ? 0 : length, suffix);
        }
    }
    return NULL;
}

static const char NUMBER_USAGE[] = "a number is one like 0.5, 10u, 1Meg or 2e-3";

static void report_number(struct dalcs_builder *builder, const struct dalcs_token *token,
                          enum dalcs_number_status status) {
    switch (status) {
    case DALCS_NUMBER_OK:
        return;
    case DALCS_NUMBER_OVERFLOW:
        dalcs_builder_error(builder, token, NULL, "'%s' is larger than any number here",
                            token->text);
        return;
    case DALCS_NUMBER_UNDERFLOW:
        dalcs_builder_error(builder, token, "write 0 if it is meant to be 0",
                            "'%s' is too small: it would be rounded to 0", token->text);
        return;
    case DALCS_NUMBER_RKM: {
        const char *hint = rkm_hint(builder, token->text);
        dalcs_builder_error(builder, token, hint != NULL ? hint : NUMBER_USAGE,
                            "'%s' is not a number", token->text);
        return;
    }
    case DALCS_NUMBER_MALFORMED:
        dalcs_builder_error(builder, token,
                            is_formula(token) ? brace_hint(builder, token) : NUMBER_USAGE,
                            "'%s' is not a number", token->text);
        return;
    }
}

/* Warns where a suffix says something else than most people who write it mean. */
static void warn_of_suffix(struct dalcs_builder *builder, const struct dalcs_token *token,
                           const struct dalcs_number *number, enum dalcs_quantity quantity) {
    const char *digits = token->text;
    const char *tail = token->text + number->tail;
    const char *raw = token->line->text + token->offset; /* in the case it was written in */
    const bool capital_m = raw[number->digits] == 'M';

    if (number->suffix == 'm' && quantity == DALCS_OHM && capital_m) {
        dalcs_builder_warn(builder, token,
                           dalcs_builder_hint(builder,
                                              "write %.*sMeg for megohms, %.*sm for milliohms",
                                              number->digits, digits, number->digits, digits),
                           "M is milli: this is %g ohm", number->value);
    } else if (number->suffix == 'm' && quantity == DALCS_HERTZ &&
               (capital_m || strncmp(raw + number->tail, "hz", 2) == 0)) {
        dalcs_builder_warn(builder, token,
                           dalcs_builder_hint(builder, "write %.*sMeg", number->digits, digits),
                           "M is milli: this is %g Hz", number->value);
    } else if (number->suffix == 'f' && quantity == DALCS_FARAD && *tail != 'f') {
        dalcs_builder_warn(builder, token,
                           dalcs_builder_hint(builder,
                                              "write %.*s for farads, %.*sfF for femtofarads",
                                              number->digits, digits, number->digits, digits),
                           "F is femto: this is %g F", number->value);
    } else if (number->suffix == 'i') {
        dalcs_builder_warn(builder, token, "write m for milli", "mil is 25.4e-6: this is %g",
                           number->value);
    } else if (number->suffix == 0 && *tail == 'a' &&
               builder->netlist->dialect.name <= DALCS_DIALECT_NGSPICE) {
        dalcs_builder_warn(builder, token,
                           dalcs_builder_hint(builder, "write %.*s", number->digits, digits),
                           "A is the unit: this is %g; HSPICE and ngspice from 40 on read %g",
                           number->value, 1e-18 * number->value);
    } else if (number->suffix == 0 && *tail == 'x' &&
               !dalcs_dialect_is_told(builder->netlist->dialect, DALCS_DIALECT_NGSPICE)) {
        dalcs_builder_warn(
            builder, token,
            dalcs_builder_hint(builder, "write %.*sMeg if that is meant", number->digits, digits),
            "X is no suffix here: this is %g", number->value);
    }
}

/* A number that only one other simulator reads so; silent where the netlist is told to be its. */
static void warn_of_dialect(struct dalcs_builder *builder, const struct dalcs_token *token,
                            const struct dalcs_number *number) {
    const struct dalcs_dialect *dialect = &builder->netlist->dialect;
    if (number->is_special && !dialect->is_told) {
        dalcs_builder_warn(builder, token, NULL, "'%s' is %g, as %s reads it", token->text,
                           number->value, dalcs_dialect_simulator(dialect->name));
    }
}

static bool is_all_digits(const char *text) {
    return *text != '\0' && text[strspn(text, "0123456789")] == '\0';
}

/* 1,5 where one number is wanted: SPICE would silently read 1 and go on. */
static bool is_decimal_comma(const struct dalcs_reader *reader) {
    const struct dalcs_token *token = dalcs_reader_previous(reader);
    const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
    const char *text = token->text;
    text += *text == '+' || *text == '-';
    return next != NULL && next->after_comma && next->line == token->line &&
           next->offset == token->offset + token->length + 1 && is_all_digits(text) &&
           is_digit(next->text[0]);
}

bool dalcs_reader_list_number(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                              const char *what, double *value) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    if (token == NULL || token->kind == DALCS_TOKEN_OPEN || token->kind == DALCS_TOKEN_CLOSE ||
        token->kind == DALCS_TOKEN_EQUAL) {
        dalcs_reader_missing(reader, what);
        return false;
    }
    if (token->kind == DALCS_TOKEN_NUMBER) {
        reader->at++;
        *value = token->value;
        return true;
    }
    if (token->kind != DALCS_TOKEN_WORD) {
        dalcs_reader_unexpected(reader);
        return false;
    }
    struct dalcs_number number;
    const enum dalcs_number_status status =
        dalcs_number_parse_as(token->text, builder->netlist->dialect.name, &number);
    if (status == DALCS_NUMBER_MALFORMED && !dalcs_reader_is_number(token)) {
        dalcs_builder_error(builder, token, hint_of_formula(reader, token), "expected %s, not '%s'",
                            what, token->text);
        return false;
    }
    if (status != DALCS_NUMBER_OK) {
        report_number(builder, token, status);
        return false;
    }
    warn_of_suffix(builder, token, &number, quantity);
    warn_of_dialect(builder, token, &number);
    reader->at++;
    *value = number.value;
    return true;
}

bool dalcs_reader_number(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                         const char *what, double *value) {
    if (!dalcs_reader_list_number(reader, quantity, what, value)) {
        return false;
    }
    if (is_decimal_comma(reader)) {
        const struct dalcs_token *whole = dalcs_reader_previous(reader);
        const struct dalcs_token *part = dalcs_reader_peek(reader, 0);
        const struct dalcs_location where = dalcs_token_span(whole, part);
        dalcs_builder_error_at(
            reader->builder, &where,
            dalcs_builder_hint(reader->builder, "write %s.%s", whole->text, part->text),
            "a decimal comma: numbers have a point");
        reader->at++;
        return false;
    }
    return true;
}

bool dalcs_reader_number_or_infinity(struct dalcs_reader *reader, enum dalcs_quantity quantity,
                                     const char *what, double *value) {
    if (dalcs_reader_take_word(reader, "inf") || dalcs_reader_take_word(reader, "infinity")) {
        *value = INFINITY;
        return true;
    }
    return dalcs_reader_number(reader, quantity, what, value);
}

bool dalcs_reader_skip_value(struct dalcs_reader *reader) {
    const struct dalcs_token *value = dalcs_reader_peek(reader, 0);
    if (value == NULL || value->kind == DALCS_TOKEN_EQUAL || value->kind == DALCS_TOKEN_OPEN ||
        value->kind == DALCS_TOKEN_CLOSE) {
        dalcs_reader_missing(reader, "a value");
        return false;
    }
    reader->at++;
    return true;
}

/* ---- Names and nodes ----------------------------------------------------------------------- */

bool dalcs_reader_name(struct dalcs_reader *reader, const char *what,
                       const struct dalcs_token **name) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    if (token == NULL || token->kind != DALCS_TOKEN_WORD) {
        dalcs_reader_missing(reader, what);
        return false;
    }
    reader->at++;
    *name = token;
    return true;
}

bool dalcs_reader_nodes(struct dalcs_reader *reader, int n, int *node) {
    for (int k = 0; k < n; k++) {
        while (dalcs_reader_take(reader, DALCS_TOKEN_OPEN) ||
               dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        }
        const struct dalcs_token *token = NULL;
        if (!dalcs_reader_name(reader, "a node", &token)) {
            return false;
        }
        const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
        if (next != NULL && next->kind == DALCS_TOKEN_OPEN && next->line == token->line &&
            next->offset == token->offset + token->length) {
            static const char *const values[] = {"sin", "pulse", "pwl", "exp", "am", "sffm"};
            dalcs_builder_error(
                reader->builder, next,
                dalcs_builder_is_one_of(token->text, values, sizeof values / sizeof values[0])
                    ? reader->usage
                    : "rename the node, or put a blank before the parenthesis",
                "a node's name cannot contain a parenthesis");
            return false;
        }
        node[k] = dalcs_builder_node(reader->builder, token);
        if (node[k] < 0) {
            return false;
        }
    }
    while (dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
    }
    return true;
}

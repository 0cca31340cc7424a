/* reader_number.c - numbers on a card, and what is said of those that are none.
 *
 * Numbers whose suffix is often meant otherwise (1M of resistance, 1F of capacitance) get a warning. */
#include "reader.h"

#include "number.h"

#include <math.h>
#include <string.h>

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
                            dalcs_reader_is_formula(token) ? dalcs_reader_brace_hint(builder, token)
                                                           : NUMBER_USAGE,
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
        dalcs_builder_error(builder, token, dalcs_reader_hint_of_formula(reader, token),
                            "expected %s, not '%s'", what, token->text);
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

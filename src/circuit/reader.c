/* reader.c - walks over the tokens of one card: names, nodes, parameters.
 *
 * Every function reports a missing or wrong token, at its place. */
#include "reader.h"

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

const char *dalcs_reader_brace_hint(struct dalcs_builder *builder,
                                    const struct dalcs_token *token) {
    return dalcs_builder_hint(builder, "a formula has braces: write {%s}", token->text);
}

bool dalcs_reader_is_formula(const struct dalcs_token *token) {
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

const char *dalcs_reader_hint_of_formula(const struct dalcs_reader *reader,
                                         const struct dalcs_token *token) {
    double value;
    const bool is_name = token->kind == DALCS_TOKEN_WORD &&
                         dalcs_deck_parameter(reader->builder->deck, token->text, &value);
    return is_name || dalcs_reader_is_formula(token)
               ? dalcs_reader_brace_hint(reader->builder, token)
               : reader->usage;
}

void dalcs_reader_unexpected(struct dalcs_reader *reader) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    reader->builder->failed = true;
    if (token == NULL || token->kind == DALCS_TOKEN_BAD) {
        return;
    }
    const char *hint =
        dalcs_reader_unit_hint(reader, token, dalcs_reader_hint_of_formula(reader, token));
    dalcs_builder_error(reader->builder, token, hint, "did not expect '%s' here", token->text);
}

bool dalcs_reader_end(struct dalcs_reader *reader) {
    if (dalcs_reader_at_end(reader)) {
        return true;
    }
    dalcs_reader_unexpected(reader);
    return false;
}

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

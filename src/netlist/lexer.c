/* lexer.c - physical lines to cards.
 *
 * Works in place: a word is lower-cased and ended with a NUL in the `low` copy of the text, so that
 * tokens need no memory of their own, while `raw` keeps the line as written for messages. What can
 * end a word is therefore always read from `raw`. */
#include "lexer.h"

#include "eight_bytes.h"

#include <limits.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static bool ends_word(char c) {
    static const bool ends[UCHAR_MAX + 1] = {
        ['\0'] = true, [' '] = true, ['\t'] = true, ['\r'] = true, ['\v'] = true, ['\f'] = true,
        [','] = true,  ['='] = true, ['('] = true,  [')'] = true,  [';'] = true};
    return ends[(unsigned char)c];
}

/* From raw[begin] on; a long line has many places, whose columns are not to be counted one by one. */
static int count_ascii(struct dalcs_lexer *lexer, size_t begin) {
    if (begin < lexer->ascii_begin || begin >= lexer->ascii_end) {
        size_t end = begin + dalcs_eight_skip_ascii(lexer->raw + begin, lexer->length - begin);
        while (end < lexer->length && (unsigned char)lexer->raw[end] < 0x80) {
            end++;
        }
        lexer->ascii_begin = begin;
        lexer->ascii_end = end;
    }
    const size_t n = lexer->ascii_end - begin;
    return n < INT_MAX ? (int)n : INT_MAX;
}

static enum dalcs_status need_line(struct dalcs_lexer *lexer, size_t begin) {
    if (lexer->line != NULL) {
        return DALCS_OK;
    }
    struct dalcs_source_line *line = dalcs_arena_alloc(&lexer->netlist->arena, 1, sizeof *line);
    if (line == NULL) {
        return DALCS_E_NOMEM;
    }
    line->source = lexer->source;
    line->text = lexer->raw + begin;
    line->number = lexer->line_number;
    line->n_ascii = count_ascii(lexer, begin);
    lexer->line = line;
    return DALCS_OK;
}

void dalcs_lexer_report(struct dalcs_lexer *lexer, const struct dalcs_token *token,
                        const char *hint, const char *format, ...) {
    const struct dalcs_location where = dalcs_token_location(token);
    va_list arguments;
    va_start(arguments, format);
    dalcs_diag_add_list(lexer->diag, DALCS_ERROR, &where, hint, format, arguments);
    va_end(arguments);
    lexer->netlist->has_errors = true;
}

/* Net-(D1-K), as KiCad names a net: takes the part in parentheses into the word that ends at raw[*q],
 * and what follows it. Elsewhere a minus before a parenthesis is in an expression. */
static bool closes_name(const char *raw, size_t *q) {
    size_t r = *q + 1;
    while (!ends_word(raw[r])) {
        r++;
    }
    if (raw[r] != ')') {
        return false;
    }
    do {
        r++;
    } while (!ends_word(raw[r]));
    *q = r;
    return true;
}

/* .model name D{Ron=1m} and D[Ron=1m], as LTspice also has it: is the token being read the type, which ends at
 * such a bracket, or the one behind it, which may be one? */
static bool is_model_word(const struct dalcs_lexer *lexer, size_t index) {
    return lexer->n_tokens == index + 1 && strcmp(lexer->token[0].text, ".model") == 0;
}

/* The length of a word at raw[p]. */
static size_t word_length(const struct dalcs_lexer *lexer, size_t p) {
    const char *raw = lexer->raw;
    const bool is_type = is_model_word(lexer, 2);
    size_t q = p + 1;
    if (raw[p] == '[' &&
        (raw[q] == '{' || raw[q] == '\'')) { /* a list that begins with an expression */
        return 1;
    }
    if (raw[p] == '+' && raw[q] == '{') { /* a time of a PWL that counts from the one before */
        return 1;
    }
    while (!ends_word(raw[q]) && !(is_type && (raw[q] == '{' || raw[q] == '['))) {
        q++;
    }
    while (raw[q] == '(' && raw[q - 1] == '-' && closes_name(raw, &q)) {
    }
    return q - p;
}

/* Is it a token of one byte? */
static bool read_mark(const struct dalcs_lexer *lexer, char c, struct dalcs_token *token) {
    if (c == '=' || c == '(' || c == ')') {
        token->kind = c == '='   ? DALCS_TOKEN_EQUAL
                      : c == '(' ? DALCS_TOKEN_OPEN
                                 : DALCS_TOKEN_CLOSE;
        token->text = c == '=' ? "=" : c == '(' ? "(" : ")";
        token->length = 1;
        return true;
    }

    if ((c == '{' || c == '[') && is_model_word(lexer, 3)) {
        token->kind = DALCS_TOKEN_OPEN;
        token->text = c == '{' ? "{" : "[";
        token->length = 1;
        return true;
    }
    return false;
}

/* A text in quotes, an expression or a word from raw[p] on; the result is where it ends, before what closes it. */
static size_t read_text(struct dalcs_lexer *lexer, size_t p, struct dalcs_token *token,
                        bool *closed) {
    const char *raw = lexer->raw;
    char *low = lexer->low;
    const char c = raw[p];
    size_t q = p + 1;
    *closed = true;
    if (c == '\'' || c == '"') {
        token->kind = DALCS_TOKEN_STRING;
        while (raw[q] != '\0' && raw[q] != c) {
            q++;
        }
        *closed = raw[q] == c;
        if (c == '"') {
            memcpy(low + p + 1, raw + p + 1, q - p - 1);
        } else {
            token->kind = DALCS_TOKEN_EXPRESSION;
            lexer->netlist->has_language = true;
        }
        token->text = low + p + 1;
    } else if (c == '{') {
        token->kind = DALCS_TOKEN_EXPRESSION;
        lexer->netlist->has_language = true;
        int depth = 1;
        for (; raw[q] != '\0'; q++) {
            depth += (raw[q] == '{') - (raw[q] == '}');
            if (depth == 0) {
                break;
            }
        }
        *closed = depth == 0;
        token->text = low + p + 1;
    } else {
        token->kind = DALCS_TOKEN_WORD;
        q = p + word_length(lexer, p);
        token->text = low + p;
    }
    return q;
}

/* The token that starts at raw[p]; the result is the first byte after it. */
static size_t read_token(struct dalcs_lexer *lexer, size_t p, size_t begin,
                         struct dalcs_token *token) {
    const char *raw = lexer->raw;
    char *low = lexer->low;
    const char c = raw[p];
    token->line = lexer->line;
    token->offset = (int)(p - begin);

    if (read_mark(lexer, c, token)) {
        return p + 1;
    }
    bool closed;
    size_t q = read_text(lexer, p, token, &closed);
    const bool invalid = lexer->has_invalid && memchr(low + p, DALCS_LEXER_INVALID, q - p) != NULL;
    low[q] = '\0';
    if (token->kind != DALCS_TOKEN_WORD && closed) {
        q++;
    }
    token->length = (unsigned)(q - p);

    if (invalid) {
        dalcs_lexer_report(lexer, token, "save the netlist as UTF-8 text",
                           "a byte that is not text, shown as ?");
        token->kind = DALCS_TOKEN_BAD;
    } else if (!closed) {
        dalcs_lexer_report(lexer, token, NULL, "%s",
                           c == '{' ? "this brace is never closed" : "this quote is never closed");
        token->kind = DALCS_TOKEN_BAD;
    }
    return q;
}

/* "//" starts a comment in ngspice. */
static bool starts_slashes(const char *text) {
    return text[0] == '/' && text[1] == '/';
}

static enum dalcs_status read_tokens(struct dalcs_lexer *lexer, size_t p, size_t begin) {
    const char *raw = lexer->raw;
    lexer->after_comma = lexer->after_comma && lexer->n_tokens > 0;
    for (;;) {
        while (dalcs_lexer_is_blank(raw[p]) || raw[p] == ',') {
            lexer->after_comma = lexer->after_comma || raw[p] == ',';
            p++;
        }
        if (raw[p] == '\0' || raw[p] == ';') {
            return DALCS_OK;
        }
        if (raw[p] == '$' && (p == begin || dalcs_lexer_is_blank(raw[p - 1])) &&
            (raw[p + 1] == '\0' || dalcs_lexer_is_blank(raw[p + 1]))) {
            return DALCS_OK;
        }
        if (starts_slashes(raw + p) && (p == begin || dalcs_lexer_is_blank(raw[p - 1]))) {
            return DALCS_OK;
        }
        DALCS_TRY(need_line(lexer, begin));
        DALCS_TRY(
            dalcs_grow(&lexer->token, &lexer->capacity, lexer->n_tokens + 1, sizeof *lexer->token));
        struct dalcs_token *token = &lexer->token[lexer->n_tokens++];
        *token = (struct dalcs_token){.after_comma = lexer->after_comma};
        lexer->after_comma = false;
        const size_t end = read_token(lexer, p, begin, token);
        if (end - p > DALCS_LONGEST_TOKEN) {
            return DALCS_E_LIMIT;
        }
        p = end;
    }
}

bool dalcs_lexer_starts_with(const struct dalcs_lexer *lexer, size_t p, const char *word) {
    const size_t length = strlen(word);
    return strncmp(lexer->low + p, word, length) == 0 && ends_word(lexer->raw[p + length]);
}

/* With or without .title before it. */
static enum dalcs_status read_title(struct dalcs_lexer *lexer, size_t begin, size_t end) {
    while (begin < end && dalcs_lexer_is_blank(lexer->raw[begin])) {
        begin++;
    }
    begin += dalcs_lexer_starts_with(lexer, begin, ".title") ? strlen(".title") : 0;
    while (begin < end && dalcs_lexer_is_blank(lexer->raw[begin])) {
        begin++;
    }
    while (end > begin && dalcs_lexer_is_blank(lexer->raw[end - 1])) {
        end--;
    }
    lexer->netlist->title =
        dalcs_arena_copy(&lexer->netlist->arena, lexer->raw + begin, end - begin);
    return lexer->netlist->title != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* Does the card so far have a parenthesis that is not closed? */
static bool is_open(const struct dalcs_lexer *lexer) {
    int depth = 0;
    for (size_t k = 0; k < lexer->n_tokens; k++) {
        depth += lexer->token[k].kind == DALCS_TOKEN_OPEN ? 1 : 0;
        depth -= lexer->token[k].kind == DALCS_TOKEN_CLOSE ? 1 : 0;
    }
    return depth > 0;
}

static enum dalcs_status continue_card(struct dalcs_lexer *lexer, size_t plus, size_t begin) {
    if (lexer->n_tokens > 0) {
        return read_tokens(lexer, plus + 1, begin);
    }
    DALCS_TRY(need_line(lexer, begin));
    const struct dalcs_token token = {
        .line = lexer->line, .offset = (int)(plus - begin), .length = 1};
    dalcs_lexer_report(lexer, &token, "a line that starts with + continues the card before it",
                       "there is no card to continue");
    return DALCS_OK;
}

/* A line of .control ... .endc, kept for the script. */
static enum dalcs_status add_script_line(struct dalcs_lexer *lexer, size_t begin) {
    const struct dalcs_source_line line = {
        .source = lexer->source, .text = lexer->raw + begin, .number = lexer->line_number};
    return dalcs_source_lines_add(&lexer->netlist->commands, line);
}

enum dalcs_status dalcs_lexer_read_line(struct dalcs_lexer *lexer, size_t begin, size_t end) {
    lexer->line_number++;
    lexer->line = NULL;
    lexer->raw[end] = '\0';
    lexer->low[end] = '\0';
    if (lexer->line_number == 1 && lexer->source->outer == NULL) {
        DALCS_TRY(need_line(lexer, begin));
        lexer->netlist->title_line = lexer->line;
        return read_title(lexer, begin, end);
    }
    size_t p = begin;
    while (dalcs_lexer_is_blank(lexer->raw[p])) {
        p++;
    }
    if (lexer->in_control) {
        lexer->in_control = !dalcs_lexer_starts_with(lexer, p, ".endc");
        return lexer->in_control ? add_script_line(lexer, begin) : DALCS_OK;
    }
    if (p == end || lexer->raw[p] == '*' || lexer->raw[p] == ';' ||
        starts_slashes(lexer->raw + p)) {
        return DALCS_OK;
    }
    if (lexer->raw[p] == '+' && !lexer->section.is_skipped) {
        return continue_card(lexer, p, begin);
    }
    if (lexer->raw[p] == ')' && is_open(lexer)) {
        return read_tokens(lexer, p, begin); /* of a model whose last line has lost its + */
    }
    DALCS_TRY(dalcs_lexer_flush(lexer));
    if (lexer->section.is_skipped) {
        bool skips;
        DALCS_TRY(dalcs_include_skips(lexer, p, &skips));
        if (skips) {
            return DALCS_OK;
        }
    }
    if (lexer->raw[p] != '.') {
        return read_tokens(lexer, p, begin);
    }
    if (dalcs_lexer_starts_with(lexer, p, ".end")) {
        lexer->ended = true;
        return DALCS_OK;
    }
    if (dalcs_lexer_starts_with(lexer, p, ".title")) {
        return read_title(lexer, p, end);
    }
    lexer->in_control = dalcs_lexer_starts_with(lexer, p, ".control");
    return read_tokens(lexer, p, begin);
}

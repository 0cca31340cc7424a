/* lexer.c - physical lines to cards.
 *
 * Works in place: a word is lower-cased and ended with a NUL in the `low` copy of the text, so that
 * tokens need no memory of their own, while `raw` keeps the line as written for messages. What can
 * end a word is therefore always read from `raw`. */
#include "lexer.h"

#include "eight_bytes.h"
#include "lower_case.h"

#include <limits.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Stands in `low` for a byte that is no text; `raw` shows it as '?'. */
static const char INVALID = '\x01';

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

static bool ends_word(char c) {
    static const bool ends[UCHAR_MAX + 1] = {
        ['\0'] = true, [' '] = true, ['\t'] = true, ['\r'] = true, ['\v'] = true, ['\f'] = true,
        [','] = true,  ['='] = true, ['('] = true,  [')'] = true,  [';'] = true};
    return ends[(unsigned char)c];
}

/* The length of the UTF-8 character at p (n bytes follow), 0 when it is not one. */
static size_t utf8_length(const unsigned char *p, size_t n) {
    size_t length;
    unsigned least;
    unsigned code;
    if (p[0] < 0xC2) {
        return 0;
    } else if (p[0] < 0xE0) {
        length = 2;
        least = 0x80;
        code = p[0] & 0x1FU;
    } else if (p[0] < 0xF0) {
        length = 3;
        least = 0x800;
        code = p[0] & 0x0FU;
    } else if (p[0] < 0xF5) {
        length = 4;
        least = 0x10000;
        code = p[0] & 0x07U;
    } else {
        return 0;
    }
    if (n < length) {
        return 0;
    }
    for (size_t k = 1; k < length; k++) {
        if ((p[k] & 0xC0) != 0x80) {
            return 0;
        }
        code = code << 6 | (p[k] & 0x3FU);
    }
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    return code < least || code > 0x10FFFF || surrogate ? 0 : length;
}

/* Cleans the character at raw[k]; its bytes. A no-break space, which comes with text copied from web
 * pages, becomes blanks, and a carriage return that ends no line one. */
static size_t clean_character(struct dalcs_lexer *lexer, size_t k) {
    char *raw = lexer->raw;
    char *low = lexer->low;
    const size_t end = lexer->length;
    const char c = raw[k];
    const unsigned char byte = (unsigned char)c;
    const size_t length = byte < 0x80 ? 0 : utf8_length((const unsigned char *)raw + k, end - k);
    if (length == 2 && byte == 0xC2 && (unsigned char)raw[k + 1] == 0xA0) {
        raw[k] = raw[k + 1] = low[k] = low[k + 1] = ' ';
        return 2;
    }
    if (length > 0) {
        memcpy(low + k, raw + k, length);
        return length;
    }
    const bool ends_line = c == '\n' || (c == '\r' && (k + 1 == end || raw[k + 1] == '\n'));
    if (byte >= 0x7F || (byte < 0x20 && !is_blank(c) && !ends_line)) {
        raw[k] = '?';
        low[k] = INVALID;
        lexer->has_invalid = true;
    } else if (is_blank(c) && c != '\t' && !ends_line) {
        raw[k] = low[k] = ' ';
    } else {
        low[k] = dalcs_lower(c);
    }
    return 1;
}

void dalcs_lexer_clean(struct dalcs_lexer *lexer, size_t begin) {
    for (size_t k = begin; k < lexer->length;) {
        const bool is_room = lexer->length - k >= 8;
        const uint64_t eight = is_room ? dalcs_eight_load(lexer->raw + k) : 0;
        if (is_room && dalcs_eight_is_plain(eight)) {
            const uint64_t lower = dalcs_eight_lower(eight);
            memcpy(lexer->low + k, &lower, sizeof lower);
            k += 8;
        } else {
            k += clean_character(lexer, k);
        }
    }
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
    while (!ends_word(raw[q]) && !(is_type && (raw[q] == '{' || raw[q] == '['))) {
        q++;
    }
    while (raw[q] == '(' && raw[q - 1] == '-' && closes_name(raw, &q)) {
    }
    return q - p;
}

/* The token that starts at raw[p]; the result is the first byte after it. */
static size_t read_token(struct dalcs_lexer *lexer, size_t p, size_t begin,
                         struct dalcs_token *token) {
    const char *raw = lexer->raw;
    char *low = lexer->low;
    const char c = raw[p];
    size_t q = p + 1;
    token->line = lexer->line;
    token->offset = (int)(p - begin);

    if (c == '=' || c == '(' || c == ')') {
        token->kind = c == '='   ? DALCS_TOKEN_EQUAL
                      : c == '(' ? DALCS_TOKEN_OPEN
                                 : DALCS_TOKEN_CLOSE;
        token->text = c == '=' ? "=" : c == '(' ? "(" : ")";
        token->length = 1;
        return q;
    }

    if ((c == '{' || c == '[') && is_model_word(lexer, 3)) {
        token->kind = DALCS_TOKEN_OPEN;
        token->text = c == '{' ? "{" : "[";
        token->length = 1;
        return q;
    }

    bool closed = true;
    if (c == '\'' || c == '"') {
        token->kind = DALCS_TOKEN_STRING;
        while (raw[q] != '\0' && raw[q] != c) {
            q++;
        }
        closed = raw[q] == c;
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
        closed = depth == 0;
        token->text = low + p + 1;
    } else {
        token->kind = DALCS_TOKEN_WORD;
        q = p + word_length(lexer, p);
        token->text = low + p;
    }
    const bool invalid = lexer->has_invalid && memchr(low + p, INVALID, q - p) != NULL;
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
        while (is_blank(raw[p]) || raw[p] == ',') {
            lexer->after_comma = lexer->after_comma || raw[p] == ',';
            p++;
        }
        if (raw[p] == '\0' || raw[p] == ';') {
            return DALCS_OK;
        }
        if (raw[p] == '$' && (p == begin || is_blank(raw[p - 1])) &&
            (raw[p + 1] == '\0' || is_blank(raw[p + 1]))) {
            return DALCS_OK;
        }
        if (starts_slashes(raw + p) && (p == begin || is_blank(raw[p - 1]))) {
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
    while (begin < end && is_blank(lexer->raw[begin])) {
        begin++;
    }
    begin += dalcs_lexer_starts_with(lexer, begin, ".title") ? strlen(".title") : 0;
    while (begin < end && is_blank(lexer->raw[begin])) {
        begin++;
    }
    while (end > begin && is_blank(lexer->raw[end - 1])) {
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
    struct dalcs_netlist *netlist = lexer->netlist;
    DALCS_TRY(dalcs_grow(&netlist->script, &netlist->script_capacity, netlist->n_script_lines + 1,
                         sizeof *netlist->script));
    netlist->script[netlist->n_script_lines++] = (struct dalcs_source_line){
        .source = lexer->source, .text = lexer->raw + begin, .number = lexer->line_number};
    return DALCS_OK;
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
    while (is_blank(lexer->raw[p])) {
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
    if (lexer->raw[p] == '+' && !lexer->skipping) {
        return continue_card(lexer, p, begin);
    }
    if (lexer->raw[p] == ')' && is_open(lexer)) {
        return read_tokens(lexer, p, begin); /* of a model whose last line has lost its + */
    }
    DALCS_TRY(dalcs_lexer_flush(lexer));
    if (lexer->skipping) {
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

/* A card that is not of a flat netlist of numbers. */
static bool is_language(const struct dalcs_token *name) {
    static const char *const words[] = {
        ".param",  ".params", ".csparam", ".global_param", ".func",   ".function",
        ".subckt", ".ends",   ".global",  ".if",           ".elseif", ".else",
        ".endif",  ".step",   ".wcase",   ".wc",           ".params:"};
    for (size_t k = 0; k < sizeof words / sizeof words[0]; k++) {
        if (strcmp(name->text, words[k]) == 0) {
            return true;
        }
    }
    return false;
}

/* B sources, E, G, S and R with name=expression, L with Flux=, C with Q=: formulas need no braces. */
static bool may_have_formula(const struct dalcs_card *card) {
    bool may = card->letter == 'b';
    const bool has_forms = card->letter == 'e' || card->letter == 'g' || card->letter == 's' ||
                           (card->letter == 'r' && card->n > 6);
    for (int k = 3; k < card->n && has_forms && !may; k++) {
        may = card->token[k].kind == DALCS_TOKEN_EQUAL;
    }
    const bool is_coil = card->letter == 'l';
    for (int k = 4; k < card->n && (is_coil || card->letter == 'c') && !may; k++) {
        may = card->token[k].kind == DALCS_TOKEN_EQUAL &&
              strcmp(card->token[k - 1].text, is_coil ? "flux" : "q") == 0;
    }
    return may;
}

/* DEV=5%, LOT/1/gauss=2%, on an element or in a model. */
static bool may_have_tolerance(const struct dalcs_card *card) {
    bool may = false;
    for (int k = 3; k < card->n && !may; k++) {
        const char *text = card->token[k].text;
        may = card->token[k].kind == DALCS_TOKEN_WORD &&
              (strncmp(text, "dev", 3) == 0 || strncmp(text, "lot", 3) == 0) &&
              (text[3] == '\0' || text[3] == '/');
    }
    return may;
}

/* The brace or bracket that closes a model, which is the end of its last word or a word of its own. */
static enum dalcs_status close_model(struct dalcs_lexer *lexer) {
    const bool may = lexer->n_tokens > 4 && strcmp(lexer->token[0].text, ".model") == 0 &&
                     lexer->token[3].kind == DALCS_TOKEN_OPEN && lexer->token[3].text[0] != '(';
    struct dalcs_token *last = &lexer->token[lexer->n_tokens - 1];
    if (!may || last->kind != DALCS_TOKEN_WORD) {
        return DALCS_OK;
    }
    const char close = lexer->token[3].text[0] == '{' ? '}' : ']';
    const size_t n = strlen(last->text);
    if (last->text[n - 1] != close) {
        return DALCS_OK;
    }
    struct dalcs_token token = *last;
    token.kind = DALCS_TOKEN_CLOSE;
    token.text = ")";
    token.offset += (int)n - 1;
    token.length = 1;
    if (n == 1) {
        *last = token;
        return DALCS_OK;
    }
    ((char *)(uintptr_t)last->text)[n - 1] = '\0'; /* in `low`, which is the lexer's own */
    last->length--;
    DALCS_TRY(
        dalcs_grow(&lexer->token, &lexer->capacity, lexer->n_tokens + 1, sizeof *lexer->token));
    lexer->token[lexer->n_tokens++] = token;
    return DALCS_OK;
}

bool dalcs_card_is_derived_model(const struct dalcs_card *card) {
    return card->n > 2 && strcmp(card->token->text, ".model") == 0 &&
           card->token[2].kind == DALCS_TOKEN_WORD && strncmp(card->token[2].text, "ako:", 4) == 0;
}

/* The first letter; LTspice's F a b value={formula} and H a b value={formula} are G and E. */
static char letter_of(const struct dalcs_token *token, int n) {
    const char letter = token->text[0];
    const bool has_formula =
        n > 4 && (letter == 'f' || letter == 'h') && strcmp(token[3].text, "value") == 0 &&
        (token[4].kind == DALCS_TOKEN_EQUAL || token[4].kind == DALCS_TOKEN_EXPRESSION);
    return has_formula && letter == 'f' ? 'g' : has_formula ? 'e' : letter;
}

enum dalcs_status dalcs_lexer_flush(struct dalcs_lexer *lexer) {
    struct dalcs_netlist *netlist = lexer->netlist;
    if (lexer->n_tokens == 0) {
        return DALCS_OK;
    }
    DALCS_TRY(close_model(lexer));
    if (lexer->n_tokens > INT_MAX / 2) {
        return DALCS_E_LIMIT;
    }
    struct dalcs_token *token = dalcs_arena_alloc(&netlist->arena, lexer->n_tokens, sizeof *token);
    if (token == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(token, lexer->token, lexer->n_tokens * sizeof *token);
    const struct dalcs_card card = {token, (int)lexer->n_tokens,
                                    letter_of(token, (int)lexer->n_tokens), 0};
    lexer->n_tokens = 0;
    if (card.letter == '.' && dalcs_include_is_card(token->text)) {
        return dalcs_include_card(lexer, &card);
    }
    netlist->has_tolerances = netlist->has_tolerances || may_have_tolerance(&card);
    netlist->has_language = netlist->has_language || netlist->has_tolerances ||
                            card.letter == 'x' || (card.letter == '.' && is_language(token)) ||
                            may_have_formula(&card) || dalcs_card_is_derived_model(&card);
    DALCS_TRY(dalcs_grow(&netlist->card, &netlist->capacity, netlist->n_cards + 1,
                         sizeof *netlist->card));
    netlist->card[netlist->n_cards++] = card;
    return DALCS_OK;
}

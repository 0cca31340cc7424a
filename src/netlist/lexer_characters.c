/* lexer_characters.c - bytes to characters: what is no text is marked, letters are lower-cased. */
#include "lexer.h"

#include "eight_bytes.h"
#include "lower_case.h"

#include <stdint.h>
#include <string.h>

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
    if (byte >= 0x7F || (byte < 0x20 && !dalcs_lexer_is_blank(c) && !ends_line)) {
        raw[k] = '?';
        low[k] = DALCS_LEXER_INVALID;
        lexer->has_invalid = true;
    } else if (dalcs_lexer_is_blank(c) && c != '\t' && !ends_line) {
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

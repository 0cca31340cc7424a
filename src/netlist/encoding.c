/* encoding.c - UTF-16, Latin-1 and Windows-1252 to UTF-8. */
#include "encoding.h"

#include "eight_bytes.h"

#include <string.h>

/* How UTF-16 text starts; no byte order mark: two characters of ASCII. */
static bool is_utf16(const unsigned char *p, size_t n, bool *little, size_t *mark) {
    if (n < 2) {
        return false;
    }
    *mark = 2;
    *little = p[0] == 0xFF && p[1] == 0xFE;
    if (*little || (p[0] == 0xFE && p[1] == 0xFF)) {
        return true;
    }
    *mark = 0;
    if (n < 4) {
        return false;
    }
    *little = p[0] != 0 && p[1] == 0 && p[2] != 0 && p[3] == 0;
    return *little || (p[0] == 0 && p[1] != 0 && p[2] == 0 && p[3] != 0);
}

static unsigned unit_at(const unsigned char *p, bool little) {
    return little ? p[0] | (unsigned)p[1] << 8 : (unsigned)p[0] << 8 | p[1];
}

/* Writes a code point; the bytes written. */
static size_t put(char *to, unsigned code) {
    if (code < 0x80) {
        to[0] = (char)code;
        return 1;
    }
    const size_t n = code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    static const unsigned lead[] = {0, 0, 0xC0, 0xE0, 0xF0};
    for (size_t k = n - 1; k > 0; k--) {
        to[k] = (char)(0x80U | (code & 0x3FU));
        code >>= 6;
    }
    to[0] = (char)(lead[n] | code);
    return n;
}

/* The characters of Windows-1252 from 0x80 to 0x9F, where Latin-1 has none; 0: no character. */
static const unsigned short WINDOWS[32] = {
    0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0,      0x017D, 0,      0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};

static unsigned code_of(unsigned char c) {
    return c >= 0x80 && c < 0xA0 ? WINDOWS[c - 0x80] : c;
}

/* A line of old editors, where a byte is a character of Latin-1 or Windows-1252. One with any UTF-8 sequence is taken
 * to be UTF-8, and bytes that have no character are no text at all. */
static bool is_latin1(const unsigned char *p, size_t n) {
    bool found = false;
    for (size_t k = dalcs_eight_skip_ascii(p, n); k < n; k++) {
        const bool is_sequence = p[k] >= 0xC0 && k + 1 < n && p[k + 1] >= 0x80 && p[k + 1] < 0xC0;
        if ((p[k] != 0 && code_of(p[k]) == 0) || is_sequence) {
            return false;
        }
        found = found || p[k] >= 0x80;
    }
    return found;
}

static size_t line_length(const unsigned char *p, size_t n) {
    const unsigned char *newline = memchr(p, '\n', n);
    return newline != NULL ? (size_t)(newline - p) + 1 : n;
}

/* Where the first line of Latin-1 begins, n if there is none. */
static size_t first_latin1(const unsigned char *p, size_t n) {
    size_t at = dalcs_eight_skip_ascii(p, n);
    while (at > 0 && p[at - 1] != '\n') {
        at--;
    }
    while (at < n) {
        const size_t line = line_length(p + at, n - at);
        if (is_latin1(p + at, line)) {
            return at;
        }
        at += line;
    }
    return n;
}

/* Line by line: programs paste values in one encoding into text in another. */
static enum dalcs_status from_latin1(struct dalcs_arena *arena, const char **text, size_t *length) {
    const unsigned char *p = (const unsigned char *)*text;
    size_t at = first_latin1(p, *length);
    char *utf8 = at < *length ? dalcs_arena_alloc(arena, at + 3 * (*length - at) + 1, 1) : NULL;
    if (utf8 == NULL) {
        return at < *length ? DALCS_E_NOMEM : DALCS_OK;
    }
    memcpy(utf8, p, at);
    size_t n = at;
    while (at < *length) {
        const size_t end = at + line_length(p + at, *length - at);
        const bool latin1 = is_latin1(p + at, end - at);
        for (; at < end; at++) {
            if (latin1) {
                n += put(utf8 + n, code_of(p[at]));
            } else {
                utf8[n++] = (char)p[at];
            }
        }
    }
    *text = utf8;
    *length = n;
    return DALCS_OK;
}

enum dalcs_status dalcs_encoding_to_utf8(struct dalcs_arena *arena, const char **text,
                                         size_t *length) {
    enum { NO_CHARACTER = 0xFF };

    const unsigned char *p = (const unsigned char *)*text;
    bool little;
    size_t k;
    if (!is_utf16(p, *length, &little, &k)) {
        return from_latin1(arena, text, length);
    }
    /* A unit of two bytes takes three at most. */
    char *utf8 = dalcs_arena_alloc(arena, *length + *length / 2 + 4, 1);
    if (utf8 == NULL) {
        return DALCS_E_NOMEM;
    }
    size_t n = 0;
    for (; k + 1 < *length; k += 2) {
        unsigned code = unit_at(p + k, little);
        const bool high = code >= 0xD800 && code < 0xDC00;
        const unsigned low = high && k + 3 < *length ? unit_at(p + k + 2, little) : 0;
        if (low >= 0xDC00 && low < 0xE000) {
            code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
            k += 2;
        }
        if (code >= 0xD800 && code < 0xE000) {
            utf8[n++] = (char)NO_CHARACTER;
        } else {
            n += put(utf8 + n, code);
        }
    }
    if (k < *length) {
        utf8[n++] = (char)NO_CHARACTER; /* half a unit */
    }
    *text = utf8;
    *length = n;
    return DALCS_OK;
}

/* utf16.c - one pass over 16-bit units, low byte first, up to the numbers. */
#include "utf16.h"

#include "memory.h"

#include <string.h>

static const char binary[] = "Binary:\n";

bool dalcs_utf16_is_header(const char *text, size_t length) {
    const bool has_mark = length >= 2 && memcmp(text, "\377\376", 2) == 0;
    return has_mark || (length >= 4 && text[0] != '\0' && text[1] == '\0' && text[2] != '\0' &&
                        text[3] == '\0');
}

/* The character at text[*k], which ends before `length`; behind it thereafter. */
static unsigned long next_character(const unsigned char *text, size_t length, size_t *k) {
    unsigned long c = text[*k] | (unsigned long)text[*k + 1] << 8;
    *k += 2;
    if (c >= 0xd800 && c < 0xdc00 && *k + 1 < length) {
        const unsigned long low = text[*k] | (unsigned long)text[*k + 1] << 8;
        *k += 2;
        c = 0x10000 + ((c - 0xd800) << 10) + ((low - 0xdc00) & 0x3ff);
    }
    return c;
}

static char *put_character(char *to, unsigned long c) {
    if (c < 0x80) {
        *to++ = (char)c;
        return to;
    }
    int n = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
    *to++ = (char)((c >> (6 * n)) | (n == 1 ? 0xc0 : n == 2 ? 0xe0 : 0xf0));
    while (n-- > 0) {
        *to++ = (char)(0x80 | ((c >> (6 * n)) & 0x3f));
    }
    return to;
}

char *dalcs_utf16_to_plain(const char *text, size_t length, size_t *plain_length) {
    /* two bytes become three at most */
    char *plain = dalcs_alloc(length / 2 * 3 + length % 2 + 1, 1);
    char *to = plain;
    size_t k = length >= 2 && memcmp(text, "\377\376", 2) == 0 ? 2 : 0;
    bool is_header = true;
    while (plain != NULL && k + 1 < length && is_header) {
        to = put_character(to, next_character((const unsigned char *)text, length, &k));
        const size_t n = sizeof binary - 1;
        is_header = (size_t)(to - plain) < n || memcmp(to - n, binary, n) != 0;
    }
    if (plain != NULL) {
        memcpy(to, text + k, length - k);
        *plain_length = (size_t)(to - plain) + length - k;
        plain[*plain_length] = '\0';
    }
    return plain;
}

/* utf16.h - the raw files of LTspice, whose headers are in UTF-16, as others write them. */
#ifndef DALCS_UTF16_H
#define DALCS_UTF16_H

#include <stdbool.h>
#include <stddef.h>

/* Does the text begin in UTF-16, low bytes first, with or without a mark? */
bool dalcs_utf16_is_header(const char *text, size_t length);

/* The header in UTF-8, the bytes behind "Binary:" as they are, a NUL behind all; free() it. NULL: no memory. */
char *dalcs_utf16_to_plain(const char *text, size_t length, size_t *plain_length);

#endif

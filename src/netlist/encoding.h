/* encoding.h - UTF-16 and Latin-1 text, as LTspice writes them, to UTF-8. */
#ifndef DALCS_ENCODING_H
#define DALCS_ENCODING_H

#include "memory.h"

/* Replaces *text[*length] by its UTF-8 form, in `arena`, when it is UTF-16: by its byte order mark,
 * or without one by the zero bytes of its first two characters. A code unit that is no character becomes a
 * byte that is no text, which the lexer reports in its place. A line with bytes above 0x7F
 * and no sequence of UTF-8 is Latin-1, or Windows-1252. Else nothing changes. */
enum dalcs_status dalcs_encoding_to_utf8(struct dalcs_arena *arena, const char **text,
                                         size_t *length) DALCS_MUST_CHECK;

#endif

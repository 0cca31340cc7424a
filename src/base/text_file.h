/* text_file.h - a whole file in memory, and its lines. */
#ifndef DALCS_TEXT_FILE_H
#define DALCS_TEXT_FILE_H

#include "diag.h"

/* Reads the file at `path`, but not much more than `limit` bytes of it, into *text[*length], which the
 * caller frees; *text is NULL on failure. DALCS_E_IO comes with a message at `where`, the card that
 * names the file (or NULL). */
enum dalcs_status dalcs_text_file_read(const char *path, size_t limit, char **text, size_t *length,
                                       const struct dalcs_location *where,
                                       struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* Lines that end with a carriage return alone, in a text without a newline, end with a newline then. */
void dalcs_text_end_lines(char *text, size_t length);

#endif

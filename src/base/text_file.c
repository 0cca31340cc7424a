/* text_file.c - reads until the end or until it is too much. */
#include "text_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 1 << 12 }; /* what a netlist by hand takes */

static enum dalcs_status read_stream(FILE *file, size_t limit, char **text, size_t *length) {
    size_t capacity = 0;
    for (size_t got = 1; got > 0 && *length <= limit;) {
        DALCS_TRY(dalcs_grow(text, &capacity, *length + CHUNK, 1));
        got = fread(*text + *length, 1, capacity - *length, file);
        *length += got;
    }
    return ferror(file) ? DALCS_E_IO : DALCS_OK;
}

enum dalcs_status dalcs_text_file_read(const char *path, size_t limit, char **text, size_t *length,
                                       const struct dalcs_location *where,
                                       struct dalcs_diag *diag) {
    *text = NULL;
    *length = 0;
    FILE *file = fopen(path, "rb");
    enum dalcs_status status = file == NULL ? DALCS_E_IO : read_stream(file, limit, text, length);
    if (status == DALCS_E_IO) {
        dalcs_diag_add(diag, DALCS_ERROR, where, NULL, "cannot read '%s': %s", path,
                       strerror(errno));
    }
    if (file != NULL) {
        fclose(file);
    }
    if (status != DALCS_OK) {
        free(*text);
        *text = NULL;
    }
    return status;
}

void dalcs_text_end_lines(char *text, size_t length) {
    if (length == 0 || memchr(text, '\n', length) != NULL) {
        return;
    }
    const char *end = text + length;
    while ((text = memchr(text, '\r', (size_t)(end - text))) != NULL) {
        *text = '\n';
    }
}

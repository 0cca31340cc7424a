/* start_file.c - see start_file.h. */
#include "start_file.h"

#include "text_file.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static enum dalcs_status read_in(struct dalcs_start_file *file, const char *folder) {
    static const char name[] = "/.spiceinit";
    struct dalcs_diag diag = {0}; /* what is not there is no mistake */
    size_t length;
    file->path = dalcs_alloc(strlen(folder) + sizeof name, 1);
    if (file->path == NULL) {
        return DALCS_E_NOMEM;
    }
    strcat(strcpy(file->path, folder), name);
    const enum dalcs_status status =
        dalcs_text_file_read(file->path, INT_MAX, &file->text, &length, NULL, &diag);
    dalcs_diag_finish(&diag);
    if (status != DALCS_OK) {
        dalcs_start_file_finish(file);
    }
    return status == DALCS_E_IO ? DALCS_OK : status;
}

enum dalcs_status dalcs_start_file_read(struct dalcs_start_file *file) {
    DALCS_TRY(read_in(file, "."));
    const char *home = getenv("HOME");
    return file->text == NULL && home != NULL ? read_in(file, home) : DALCS_OK;
}

/* Where a command ends before its comment, which begins as in ngspice: with ";", " $ " or "//". */
static size_t length_of(const char *line) {
    static const char *const begin[] = {";", " $ ", "//"};
    size_t n = strlen(line);
    for (size_t k = 0; k < sizeof begin / sizeof begin[0]; k++) {
        const char *comment = strstr(line, begin[k]);
        n = comment != NULL && (size_t)(comment - line) < n ? (size_t)(comment - line) : n;
    }
    while (n > 0 && strchr(" \t\r", line[n - 1]) != NULL) {
        n--;
    }
    return n;
}

static bool is_taken(const char *command) {
    const size_t n = strcspn(command, " \t");
    return (n == 3 && strncasecmp(command, "set", n) == 0) ||
           (n == 5 && strncasecmp(command, "unset", n) == 0);
}

const char *dalcs_start_file_next(struct dalcs_start_file *file,
                                  void (*left_out)(void *user, const struct dalcs_start_file *file,
                                                   const char *command),
                                  void *user) {
    file->at = file->at == NULL ? file->text : file->at;
    while (file->at != NULL && *file->at != '\0') {
        char *line = file->at;
        const size_t n = strcspn(line, "\n");
        file->at = line + n + (line[n] == '\n');
        file->line++;
        line[n] = '\0';
        line += strspn(line, " \t\r");
        line[length_of(line)] = '\0';
        if (line[0] == '\0' || line[0] == '*') {
            continue;
        }
        if (is_taken(line)) {
            return line;
        }
        left_out(user, file, line);
    }
    return NULL;
}

void dalcs_start_file_finish(struct dalcs_start_file *file) {
    free(file->path);
    free(file->text);
    *file = (struct dalcs_start_file){0};
}

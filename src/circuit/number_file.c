/* number_file.c - reads number after number of a file. */
#include "number_file.h"

#include "number.h"
#include "text_file.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST_WORD = 64 };

/* The text of a name as it was written: file names have capitals. */
static const char *written_text(struct dalcs_builder *builder, const struct dalcs_token *token) {
    return token->kind == DALCS_TOKEN_STRING
               ? token->text
               : dalcs_builder_hint(builder, "%.*s", token->length,
                                    token->line->text + token->offset);
}

/* Relative to the netlist. */
static const char *find_path(struct dalcs_builder *builder, const struct dalcs_token *token) {
    const char *name = written_text(builder, token);
    const char *file = token->line->source->name;
    const char *slash = strrchr(file, '/');
    if (name == NULL || name[0] == '/' || slash == NULL) {
        return name;
    }
    return dalcs_builder_hint(builder, "%.*s/%s", (int)(slash - file), file, name);
}

bool dalcs_number_file_open(struct dalcs_builder *builder, const struct dalcs_token *name,
                            const char *what, struct dalcs_number_file *file) {
    *file = (struct dalcs_number_file){.path = find_path(builder, name), .line = 1};
    if (file->path == NULL) {
        return false;
    }
    struct dalcs_diag said = {0};
    size_t length;
    const enum dalcs_status status =
        dalcs_text_file_read(file->path, INT_MAX, &file->text, &length, NULL, &said);
    dalcs_diag_finish(&said);
    file->at = file->text;
    if (status == DALCS_E_IO) {
        dalcs_builder_error(builder, name, NULL, "cannot read the %s of %s", what, file->path);
    } else if (status != DALCS_OK) {
        builder->out_of_memory = true;
    }
    return status == DALCS_OK;
}

void dalcs_number_file_close(struct dalcs_number_file *file) {
    free(file->text);
    *file = (struct dalcs_number_file){0};
}

bool dalcs_number_file_next(struct dalcs_number_file *file, double *value) {
    const char *s = file->at;
    for (;;) {
        s += strspn(s, " \t\r,");
        if (*s == '\n') {
            file->line++;
            s++;
        } else if (*s == '*' || *s == '#' || *s == ';') {
            s += strcspn(s, "\n");
        } else {
            break;
        }
    }
    const size_t length = strcspn(s, " \t\r\n,;");
    file->at = s + length;
    if (length == 0) {
        return false;
    }
    char word[LONGEST_WORD];
    struct dalcs_number number;
    file->wrong = s;
    if (length >= sizeof word) {
        return false;
    }
    memcpy(word, s, length);
    word[length] = '\0';
    if (dalcs_number_parse(word, &number) != DALCS_NUMBER_OK) {
        return false;
    }
    file->wrong = NULL;
    *value = number.value;
    return true;
}

bool dalcs_number_file_is_read(struct dalcs_builder *builder, const struct dalcs_token *name,
                               const struct dalcs_number_file *file, const char *hint) {
    if (file->wrong != NULL) {
        const size_t length = strcspn(file->wrong, " \t\r\n,;");
        dalcs_builder_error(builder, name, hint, "%s:%d: '%.*s' is not a number", file->path,
                            file->line, (int)fmin((double)length, LONGEST_WORD), file->wrong);
        return false;
    }
    return true;
}

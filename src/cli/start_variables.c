/* start_variables.c - see start_variables.h. A .control block sees them all; of netlists without one, filetype decides
 * how raw files are written. */
#include "start_variables.h"

#include "memory.h"
#include "variables.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum dalcs_status dalcs_start_variables_take(struct dalcs_start_variables *v, const char *text) {
    struct dalcs_arguments *a = v->arguments;
    char *copy = dalcs_alloc(strlen(text) + 1, 1);
    if (copy == NULL) {
        return DALCS_E_NOMEM;
    }
    const struct dalcs_assignment given = dalcs_variables_split(strcpy(copy, text));
    if (strcasecmp(given.name, "filetype") == 0) {
        a->files.ascii = strcmp(given.value, "ascii") == 0;
    }
    free(copy);
    DALCS_TRY(dalcs_grow(&a->batch.variable, &v->capacity, a->batch.n_variables + 1,
                         sizeof(*a->batch.variable)));
    a->batch.variable[a->batch.n_variables++] = text;
    return DALCS_OK;
}

/* As if "name" or "name=value" had never been said. */
static void forget(struct dalcs_arguments *a, const char *name) {
    const size_t n = strlen(name);
    size_t kept = 0;
    for (size_t k = 0; k < a->batch.n_variables; k++) {
        const char *text = a->batch.variable[k];
        const bool is_it = strncasecmp(text, name, n) == 0 && strchr(" \t=", text[n]) != NULL;
        a->batch.variable[kept] = text;
        kept += is_it ? 0 : 1;
    }
    a->batch.n_variables = kept;
    a->files.ascii = a->files.ascii && strcasecmp(name, "filetype") != 0;
}

static void note_left_out(void *user, const struct dalcs_start_file *file, const char *command) {
    const struct dalcs_start_variables *v = user;
    fprintf(v->cli->err, "%s:%d: note: '%.60s' is left out: of this file, set and unset are done\n",
            file->path, file->line, command);
}

enum dalcs_status dalcs_start_variables_read(struct dalcs_start_variables *v) {
    DALCS_TRY(dalcs_start_file_read(&v->file));
    if (v->file.text != NULL) {
        fprintf(v->cli->err, "dalcs: note: '%s' was read, as ngspice does; -n: not\n",
                v->file.path);
    }
    for (const char *command;
         (command = dalcs_start_file_next(&v->file, note_left_out, v)) != NULL;) {
        const size_t n = strcspn(command, " \t");
        const char *rest = command + n + strspn(command + n, " \t");
        if (*rest == '=') {
            note_left_out(v, &v->file, command);
        } else if (n == strlen("unset")) {
            forget(v->arguments, rest);
        } else if (*rest != '\0') {
            DALCS_TRY(dalcs_start_variables_take(v, rest));
        }
    }
    return DALCS_OK;
}

void dalcs_start_variables_finish(struct dalcs_start_variables *v) {
    dalcs_start_file_finish(&v->file);
}

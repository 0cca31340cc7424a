/* library_path.c - where the file of a .lib or .include card is: netlists travel, the folders of their libraries do
 * not. */
#include "library_path.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

/* The names of files of models and subcircuits, and LTspice's own. */
static const char *const ENDINGS[] = {".lib", ".sub", ".mod", ".mdl", ".lbr",  ".dio", ".bjt",
                                      ".mos", ".jft", ".cap", ".ind", ".bead", ".res"};

bool dalcs_library_is_name(const char *path) {
    const char *dot = strrchr(path, '.');
    for (size_t k = 0; dot != NULL && k < sizeof ENDINGS / sizeof ENDINGS[0]; k++) {
        if (strcasecmp(dot, ENDINGS[k]) == 0) {
            return true;
        }
    }
    return false;
}

const char *dalcs_library_with_blanks(struct dalcs_lexer *lexer, const struct dalcs_card *card) {
    const struct dalcs_token *first = &card->token[1];
    const struct dalcs_token *last = &card->token[card->n - 1];
    const bool is_lib = strcmp(card->token->text, ".lib") == 0;
    if (card->n < 3 || first->kind != DALCS_TOKEN_WORD || last->line != first->line ||
        dalcs_library_is_name(first->text)) {
        return NULL;
    }
    const size_t end = (size_t)last->offset + last->length;
    const char *path = dalcs_arena_copy(&lexer->netlist->arena, first->line->text + first->offset,
                                        end - (size_t)first->offset);
    return path != NULL && is_lib && !dalcs_library_is_name(path) ? NULL : path;
}

/* `name` in the folder of the file that includes it. */
static const char *path_of(struct dalcs_lexer *lexer, const char *name) {
    const char *slash = strrchr(lexer->source->name, '/');
    if (name[0] == '/' || slash == NULL) {
        return name;
    }
    const int folder = (int)(slash - lexer->source->name) + 1;
    return dalcs_arena_printf(&lexer->netlist->arena, "%.*s%s", folder, lexer->source->name, name);
}

static bool is_readable(const char *path) {
    return path != NULL && access(path, R_OK) == 0;
}

/* A file of that name in the folder DALCS_LIBRARIES of the environment, else among the libraries that are installed with
 * dalcs, else in the source tree that it was built from. NULL: in none of them, or out of memory. */
static const char *installed(struct dalcs_lexer *lexer, const char *file) {
    const char *const folder[] = {getenv("DALCS_LIBRARIES"), DALCS_LIBRARIES,
                                  DALCS_SOURCE_LIBRARIES};
    const char *found = NULL;
    for (size_t k = 0; k < sizeof folder / sizeof *folder && found == NULL; k++) {
        const char *path =
            folder[k] != NULL ? dalcs_arena_printf(&lexer->netlist->arena, "%s/%s", folder[k], file)
                              : NULL;
        found = is_readable(path) ? path : NULL;
    }
    return found;
}

/* With the slashes of this system in place of Windows'. */
static const char *with_slashes(struct dalcs_lexer *lexer, const char *name) {
    char *copy = dalcs_arena_copy(&lexer->netlist->arena, name, strlen(name));
    for (char *p = copy; p != NULL && *p != '\0'; p++) {
        *p = *p == '\\' ? '/' : *p;
    }
    return copy;
}

const char *dalcs_library_path(struct dalcs_lexer *lexer, const char *name, bool *elsewhere) {
    const char *written = path_of(lexer, name);
    const char *slashed = with_slashes(lexer, name);
    const char *file = slashed != NULL ? strrchr(slashed, '/') : NULL;
    *elsewhere = false;
    if (written == NULL || slashed == NULL || is_readable(written)) {
        return written;
    }
    const char *path = path_of(lexer, slashed);
    if (is_readable(path)) {
        return path;
    }
    /* ngspice looks in the current folder then. */
    *elsewhere = is_readable(slashed);
    if (*elsewhere) {
        return slashed;
    }
    /* Of another machine, or of where the other program is installed. */
    file = file != NULL ? file + 1 : slashed;
    *elsewhere = file != slashed;
    path = path_of(lexer, file);
    if (*file == '\0' || path == NULL || is_readable(path)) {
        return *file == '\0' ? written : path;
    }
    path = installed(lexer, file);
    *elsewhere = *elsewhere && path != NULL;
    return path != NULL ? path : written;
}

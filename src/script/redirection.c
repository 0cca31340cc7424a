/* redirection.c - print and echo into files. */
#include "lower_case.h"
#include "script_internal.h"

#include <errno.h>
#include <string.h>

/* The last `>` that stands outside of quotes and parentheses; NULL: none. */
static char *last_sign(char *text) {
    char *found = NULL;
    bool quoted = false;
    int depth = 0;
    for (char *c = text; *c != '\0'; c++) {
        quoted = *c == '"' ? !quoted : quoted;
        depth += quoted ? 0 : (*c == '(') - (*c == ')');
        found = *c == '>' && !quoted && depth == 0 ? c : found;
    }
    return found;
}

/* One word that begins as files do and is no vector: with that something would be compared. */
static bool is_file_name(struct dalcs_script *script, const char *name) {
    char *low = dalcs_arena_copy(&script->arena, name, strlen(name));
    const char first = name[0];
    const bool begins = (first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z') ||
                        (first != '\0' && strchr("./~_", first) != NULL);
    const bool begins_number = first == '.' && name[1] >= '0' && name[1] <= '9';
    return low != NULL && begins && !begins_number && strpbrk(name, " \t()*+<>=") == NULL &&
           dalcs_vectors_find(&script->vectors, dalcs_lower_text(low)) == NULL;
}

enum dalcs_status dalcs_redirection_find(struct dalcs_redirection *to, struct dalcs_script *script,
                                         char *text) {
    *to = (struct dalcs_redirection){.file = script->host->out};
    char *sign = last_sign(text);
    if (sign == NULL) {
        return DALCS_OK;
    }
    const char *name = sign + 1 + strspn(sign + 1, " \t&!");
    const size_t n = strcspn(name, "\"");
    const char *own = name[0] == '"'
                          ? dalcs_arena_copy(&script->arena, name + 1, strcspn(name + 1, "\""))
                          : dalcs_arena_copy(&script->arena, name, n);
    if (own == NULL) {
        return DALCS_E_NOMEM;
    }
    if (is_file_name(script, own)) {
        to->path = own;
        to->appends = sign > text && sign[-1] == '>';
        *(sign - to->appends) = '\0';
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_script_refuse_file(struct dalcs_script *script,
                                           const struct dalcs_statement *s, const char *path,
                                           int error) {
    (void)dalcs_script_refuse(script, s, NULL, "cannot write '%s': %s", path, strerror(error));
    return DALCS_E_IO;
}

enum dalcs_status dalcs_redirection_open(struct dalcs_redirection *to, struct dalcs_script *script,
                                         const struct dalcs_statement *s) {
    if (to->path == NULL) {
        return DALCS_OK;
    }
    to->file = fopen(to->path, to->appends ? "a" : "w");
    return to->file != NULL ? DALCS_OK : dalcs_script_refuse_file(script, s, to->path, errno);
}

enum dalcs_status dalcs_redirection_close(struct dalcs_redirection *to, struct dalcs_script *script,
                                          const struct dalcs_statement *s) {
    if (to->path == NULL) {
        return DALCS_OK;
    }
    const bool failed = ferror(to->file) != 0;
    errno = 0;
    if (fclose(to->file) != 0 || failed) {
        return dalcs_script_refuse_file(script, s, to->path, errno != 0 ? errno : EIO);
    }
    return DALCS_OK;
}

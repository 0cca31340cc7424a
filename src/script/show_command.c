/* show_command.c - print, plot, hardcopy, write and wrdata. */
#include "drawing.h"
#include "script_internal.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static struct dalcs_writing writing(const struct dalcs_script *script) {
    const struct dalcs_variables *set = &script->variables;
    const char *digits = dalcs_variables_get(set, "numdgt");
    const long n = digits != NULL ? strtol(digits, NULL, 10) : 0;
    const char *type = dalcs_variables_get(set, "filetype");
    return (struct dalcs_writing){.digits = n >= 1 && n <= 17 ? (int)n : 0,
                                  .single_scale =
                                      dalcs_variables_get(set, "wr_singlescale") != NULL,
                                  .with_names = dalcs_variables_get(set, "wr_vecnames") != NULL,
                                  .appends = dalcs_variables_get(set, "appendwrite") != NULL,
                                  .ascii = type != NULL && strcmp(type, "ascii") == 0};
}

enum dalcs_status dalcs_script_print(struct dalcs_script *script, const struct dalcs_statement *s) {
    const struct dalcs_vector **vector;
    struct dalcs_writing how = writing(script);
    struct dalcs_redirection to;
    struct dalcs_statement rest = *s;
    const char *text;
    size_t n;
    DALCS_TRY(dalcs_script_expand(script, s, &text));
    char *line = dalcs_arena_copy(&script->arena, text, strlen(text));
    if (line == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_redirection_find(&to, script, line));
    rest.rest = line;
    DALCS_TRY(dalcs_script_expand_low(script, &rest, &text));
    how.as_lines = strncmp(text, "line ", 5) == 0;
    how.as_columns = strncmp(text, "col ", 4) == 0;
    text += how.as_lines ? 5 : how.as_columns ? 4 : 0;
    DALCS_TRY(dalcs_script_vectors(script, s, text, &vector, &n));
    DALCS_TRY(dalcs_redirection_open(&to, script, s));
    dalcs_writing_print(to.file, &how, dalcs_plots_current(&script->vectors), vector, n);
    return dalcs_redirection_close(&to, script, s);
}

/* ngspice takes for wrdata what it takes for plot. Bytes before the first word that only shapes a picture. */
static size_t length_of_vectors(const char *text) {
    static const char *const words[] = {
        "xlimit", "xl",     "ylimit", "yl",      "xlabel", "ylabel", "title",   "xlog",
        "ylog",   "loglog", "linear", "lingrid", "xdelta", "ydelta", "linplot", "pointplot"};
    const char *p = text;
    while (*p != '\0') {
        p += strspn(p, " \t");
        const size_t n = strcspn(p, " \t");
        for (size_t k = 0; k < sizeof words / sizeof words[0]; k++) {
            if (strlen(words[k]) == n && strncmp(p, words[k], n) == 0) {
                return (size_t)(p - text);
            }
        }
        p += n;
    }
    return strlen(text);
}

/* `plot formula ...` on the terminal, `hardcopy file.svg formula ...`; what shapes a picture is left out. */
enum dalcs_status dalcs_script_draw(struct dalcs_script *script, const struct dalcs_statement *s) {
    const bool is_file = s->word[0] == 'h';
    const struct dalcs_vector **vector;
    const char *text;
    size_t n;
    char message[DALCS_DRAWING_MESSAGE];
    DALCS_TRY(dalcs_script_expand(script, s, &text));
    const char *name = is_file ? dalcs_script_word(script, &text) : NULL;
    if (is_file && (name == NULL || !dalcs_drawing_can_write(name))) {
        return dalcs_script_refuse(script, s, "hardcopy picture.svg v(out) i(l1)",
                                   "a file named .svg, .png or .pdf is missing");
    }
    struct dalcs_statement rest = *s;
    rest.rest = text;
    DALCS_TRY(dalcs_script_expand_low(script, &rest, &text));
    text = dalcs_arena_copy(&script->arena, text, length_of_vectors(text));
    if (text == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_script_vectors(script, s, text, &vector, &n));
    const struct dalcs_vector *scale = dalcs_vectors_scale(&script->vectors);
    if (scale == NULL || n == 0 || scale->n < 2) {
        return dalcs_script_refuse(script, s, "tran, dc, ac or run must come before",
                                   "there is nothing to draw");
    }
    const struct dalcs_drawing drawing = {.title = dalcs_plots_current(&script->vectors)->title,
                                          .is_logarithmic = scale->unit == DALCS_UNIT_HERTZ &&
                                                            creal(scale->value[0]) > 0.0,
                                          .scale = scale,
                                          .vector = vector,
                                          .n = n};
    const enum dalcs_status status = dalcs_drawing_draw(&drawing, name, script->host->out, message);
    return status == DALCS_E_IO && name != NULL
               ? dalcs_script_refuse(script, s, NULL, "cannot draw '%s': %s", name, message)
               : status;
}

enum dalcs_status dalcs_script_write(struct dalcs_script *script, const struct dalcs_statement *s) {
    const struct dalcs_vector **vector;
    const struct dalcs_writing how = writing(script);
    const bool is_raw = s->kind == DALCS_STATEMENT_WRITE;
    const char *text;
    size_t n;
    enum dalcs_status status = dalcs_script_expand(script, s, &text);
    if (status != DALCS_OK) {
        return status;
    }
    const char *name = dalcs_script_word(script, &text);
    name = name == NULL && is_raw ? "rawspice.raw" : name;
    if (name == NULL) {
        return dalcs_script_refuse(script, s, "wrdata file v(out) i(l1)",
                                   "the name of the file is missing");
    }
    struct dalcs_statement rest = *s;
    rest.rest = text;
    status = dalcs_script_expand_low(script, &rest, &text);
    if (status == DALCS_OK && !is_raw) {
        text = dalcs_arena_copy(&script->arena, text, length_of_vectors(text));
        status = text == NULL ? DALCS_E_NOMEM : DALCS_OK;
    }
    status = status == DALCS_OK ? dalcs_script_vectors(script, s, text, &vector, &n) : status;
    if (status != DALCS_OK) {
        return status;
    }
    const struct dalcs_vector *scale = dalcs_vectors_scale(&script->vectors);
    if (scale == NULL || n == 0) {
        return dalcs_script_refuse(script, s, "tran, op, dc, ac or run must come before",
                                   "there is nothing to write");
    }
    int error;
    status = is_raw ? dalcs_writing_raw(name, &how, dalcs_plots_current(&script->vectors), scale,
                                        vector, n, &error)
                    : dalcs_writing_data(name, &how, scale, vector, n, &error);
    return status == DALCS_E_IO ? dalcs_script_refuse_file(script, s, name, error) : status;
}

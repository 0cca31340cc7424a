/* command.c - statements that are no blocks. */
#include "drawing.h"
#include "names.h"
#include "script_internal.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* ---- Runs ------------------------------------------------------------------------------------------ */

static enum dalcs_status begin(void *user, const struct dalcs_plot *plot) {
    struct dalcs_script *script = user;
    const struct dalcs_sink *sink = script->host->sink;
    enum dalcs_status status = dalcs_vectors_begin(&script->vectors, plot);
    script->n_signals = plot->n_signals;
    return status == DALCS_OK && sink->begin != NULL ? sink->begin(sink->user, plot) : status;
}

static enum dalcs_status row(void *user, double time, const double *value) {
    struct dalcs_script *script = user;
    const struct dalcs_sink *sink = script->host->sink;
    enum dalcs_status status = dalcs_vectors_row(&script->vectors, time, value);
    return status == DALCS_OK && sink->row != NULL ? sink->row(sink->user, time, value) : status;
}

static enum dalcs_status rows(void *user, size_t n, const double *time, const double *value) {
    struct dalcs_script *script = user;
    const struct dalcs_sink *sink = script->host->sink;
    enum dalcs_status status = DALCS_OK;
    for (size_t k = 0; k < n && status == DALCS_OK; k++) {
        status = dalcs_vectors_row(&script->vectors, time[k], value + k * script->n_signals);
    }
    return status == DALCS_OK ? sink->rows(sink->user, n, time, value) : status;
}

static enum dalcs_status end(void *user) {
    const struct dalcs_script *script = user;
    const struct dalcs_sink *sink = script->host->sink;
    return sink->end != NULL ? sink->end(sink->user) : DALCS_OK;
}

static enum dalcs_status progress(void *user, double time, double stop) {
    const struct dalcs_script *script = user;
    const struct dalcs_sink *sink = script->host->sink;
    return sink->progress != NULL ? sink->progress(sink->user, time, stop) : DALCS_OK;
}

enum dalcs_status dalcs_script_add_card(struct dalcs_script *script,
                                        const struct dalcs_statement *s, const char *word,
                                        const char *rest) {
    enum dalcs_status status = dalcs_grow(&script->card, &script->card_capacity,
                                          script->n_cards + 1, sizeof *script->card);
    const char *text = dalcs_arena_printf(&script->kept, "%s %s", word, rest);
    if (status != DALCS_OK || text == NULL) {
        return DALCS_E_NOMEM;
    }
    script->card[script->n_cards++] = (struct dalcs_extra_card){s->line, text};
    return DALCS_OK;
}

/* As in ngspice, what was measured is a vector of the run. */
static enum dalcs_status keep_measured(struct dalcs_script *script) {
    const struct dalcs_report *report = dalcs_session_report(script->host->session);
    for (size_t k = 0; report != NULL && k < report->n_measurements; k++) {
        double complex value = report->measurement[k].value;
        const struct dalcs_vector v = {
            .name = "", .unit = DALCS_UNIT_NONE, .n = 1, .value = &value};
        if (report->measurement[k].found) {
            DALCS_TRY(dalcs_vectors_let(&script->vectors, report->measurement[k].name, &v));
        }
    }
    return DALCS_OK;
}

static enum dalcs_status run_session(struct dalcs_script *script) {
    const struct dalcs_script_host *host = script->host;
    const struct dalcs_sink sink = {.user = script,
                                    .begin = begin,
                                    .row = row,
                                    .end = end,
                                    .progress = progress,
                                    .rows = host->sink->rows != NULL ? rows : NULL};
    const enum dalcs_status status =
        dalcs_session_run_cards(host->session, script->card, script->n_cards, host->options, &sink);
    if (host->after_run != NULL) {
        host->after_run(host->user, host->session, status);
    }
    return status == DALCS_OK ? keep_measured(script) : status;
}

/* Tells the host what is about to happen. */
static enum dalcs_status tell(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *rest;
    if (script->host->heard == NULL) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_script_expand(script, s, &rest));
    return script->host->heard(script->host->user, s->word, rest);
}

static enum dalcs_status run(struct dalcs_script *script, size_t index) {
    const struct dalcs_statement *s = &script->statements.statement[index];
    const size_t n_kept = script->n_cards;
    const char *rest;
    enum dalcs_status status = dalcs_script_expand(script, s, &rest);
    if (strcmp(s->word, "run") != 0) {
        status = status == DALCS_OK ? dalcs_script_add_card(script, s, s->word, rest) : status;
    } else if (status == DALCS_OK && !script->has_cards) {
        return dalcs_script_refuse(script, s, "add a line before .control such as: .tran 10u 20m",
                                   "run: the netlist has no analysis");
    }
    status = status == DALCS_OK ? dalcs_script_add_measurements(script, index + 1) : status;
    script->has_run = true;
    status = status == DALCS_OK ? run_session(script) : status;
    script->n_cards = n_kept;
    return status;
}

enum dalcs_status dalcs_script_run_cards(struct dalcs_script *script) {
    enum dalcs_status status =
        script->has_cards ? dalcs_script_add_measurements(script, 0) : DALCS_OK;
    status = status == DALCS_OK && script->has_cards ? run_session(script) : status;
    script->n_cards = 0;
    return status;
}

/* `save @r1[i] v(out)`: other names for what .save calls i(r1). */
static enum dalcs_status save(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *rest;
    enum dalcs_status status = dalcs_script_expand_low(script, s, &rest);
    if (status != DALCS_OK) {
        return status;
    }
    if (s->word[0] == 'o') {
        return dalcs_script_add_card(script, s, "options", rest);
    }
    const char *text = "";
    for (const char *word; text != NULL && (word = dalcs_script_word(script, &rest)) != NULL;) {
        const int n = (int)dalcs_names_current_of(word);
        text = n > 0 ? dalcs_arena_printf(&script->arena, "%s i(%.*s)", text, n, word + 1)
                     : dalcs_arena_printf(&script->arena, "%s %s", text, word);
    }
    return text != NULL ? dalcs_script_add_card(script, s, "save", text) : DALCS_E_NOMEM;
}

/* ---- Other values ---------------------------------------------------------------------------------- */

/* The field of an element that is its value. */
static bool is_value_field(const char *field) {
    static const char *const known[] = {"dc",         "r",    "c",     "l",          "resistance",
                                        "inductance", "gain", "value", "capacitance"};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        if (strcmp(known[k], field) == 0) {
            return true;
        }
    }
    return false;
}

/* What stands before the value: with an equal sign all before it, else the name and, of a model or where it is one,
 * the field: "alter r1 2k", "alter v1 dc 5", "altermod d1 ron 1m". */
static const char *split_left(struct dalcs_script *script, const struct dalcs_statement *s,
                              const char *text, const char **value) {
    const char *equal = strchr(text, '=');
    if (equal != NULL) {
        *value = equal + 1;
        return dalcs_arena_copy(&script->arena, text, (size_t)(equal - text));
    }
    const char *rest = text;
    const char *name = dalcs_script_word(script, &rest);
    const char *behind = rest;
    const char *field = dalcs_script_word(script, &rest);
    const bool has_field =
        field != NULL && (s->kind == DALCS_STATEMENT_ALTER_MODEL ||
                          (s->kind == DALCS_STATEMENT_ALTER && is_value_field(field)));
    *value = has_field ? rest : behind;
    *value += strspn(*value, " \t");
    return name != NULL ? dalcs_arena_copy(&script->arena, text, (size_t)(*value - text)) : NULL;
}

/* "name = formula", "name field = formula", "@name[field] = formula". */
static enum dalcs_status split_alter(struct dalcs_script *script, const struct dalcs_statement *s,
                                     const char **name, const char **field, double *value) {
    const char *text;
    enum dalcs_status status = dalcs_script_expand_low(script, s, &text);
    if (status != DALCS_OK) {
        return status;
    }
    const char *number;
    const char *left = split_left(script, s, text, &number);
    if (left == NULL || *number == '\0') {
        return dalcs_script_refuse(script, s,
                                   "alter r1 = 5k; altermod dmod vfwd = 0.7; "
                                   "alterparam rload = 10",
                                   "a name and its new value are missing");
    }
    *name = dalcs_script_word(script, &left);
    *field = dalcs_script_word(script, &left);
    const char *bracket = *name != NULL && (*name)[0] == '@' ? strchr(*name, '[') : NULL;
    if (bracket != NULL) {
        const size_t n = strcspn(bracket + 1, "]");
        *field = dalcs_arena_copy(&script->arena, bracket + 1, n);
        *name = dalcs_arena_copy(&script->arena, *name + 1, (size_t)(bracket - *name - 1));
    } else if (*name != NULL && (*name)[0] == '@') {
        ++*name; /* as KiCad's tuner writes it */
    }
    if (*name == NULL) {
        return dalcs_script_refuse(script, s, NULL, "a name before '=' is missing");
    }
    return dalcs_script_number(script, s, number, value);
}

static enum dalcs_status alter(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *name = NULL;
    const char *field = NULL;
    const char *nearest = NULL;
    char hint[120];
    double value;
    const bool is_parameter = s->kind == DALCS_STATEMENT_ALTER_PARAMETER;
    enum dalcs_status status = split_alter(script, s, &name, &field, &value);
    if (status != DALCS_OK) {
        return status;
    }
    const bool is_model = s->kind == DALCS_STATEMENT_ALTER_MODEL;
    if (is_model && field == NULL) {
        return dalcs_script_refuse(script, s, "altermod dmod vfwd = 0.7",
                                   "the parameter of the model is missing");
    }
    if (!is_model && field != NULL && !is_value_field(field)) {
        return dalcs_script_refuse(script, s, "write alter name = value",
                                   "'%s' of an element cannot be altered here", field);
    }
    status = dalcs_session_alter(script->host->session, is_parameter, name, is_model ? field : NULL,
                                 value, &nearest);
    if (status == DALCS_E_OPTION) {
        snprintf(hint, sizeof hint, "did you mean '%.80s'?", nearest != NULL ? nearest : "");
        return dalcs_script_refuse(script, s, nearest != NULL ? hint : NULL, "there is no %s '%s'",
                                   is_parameter ? "parameter"
                                   : is_model   ? "model"
                                                : "element",
                                   name);
    }
    return status;
}

/* ---- Vectors ---------------------------------------------------------------------------------------- */

/* `name[index] = formula`; behind: from the equal sign on. */
static enum dalcs_status let_element(struct dalcs_script *script, const struct dalcs_statement *s,
                                     const char *left, const char *behind) {
    const size_t n = strcspn(left, " \t[");
    const char *open = strchr(left, '[');
    const char *close = strrchr(left, ']');
    if (close == NULL || close[1 + strspn(close + 1, " \t")] != '\0' || behind[0] != '=') {
        return dalcs_script_refuse(script, s, "let name[index] = formula",
                                   "an index, ']' and '=' are missing");
    }
    const char *name = dalcs_arena_copy(&script->arena, left, n);
    const char *inside = dalcs_arena_copy(&script->arena, open + 1, (size_t)(close - open - 1));
    double k;
    double value;
    if (name == NULL || inside == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_script_number(script, s, inside, &k));
    DALCS_TRY(dalcs_script_number(script, s, behind + 1, &value));
    const struct dalcs_vector *v = dalcs_vectors_find_exactly(&script->vectors, name);
    if (v == NULL) {
        return dalcs_script_refuse(script, s, "let name = vector(n) makes one",
                                   "there is no vector '%s'", name);
    }
    if (!(k >= 0.0 && k < (double)v->n)) {
        return dalcs_script_refuse(script, s, NULL, "index %g of a vector of length %zu", k, v->n);
    }
    v->value[(size_t)k] = value;
    return DALCS_OK;
}

static enum dalcs_status let(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *text;
    enum dalcs_status status = dalcs_script_expand_low(script, s, &text);
    if (status != DALCS_OK) {
        return status;
    }
    const size_t length = strcspn(text, "=");
    const char *name = dalcs_arena_copy(&script->arena, text, length);
    if (name == NULL) {
        return DALCS_E_NOMEM;
    }
    const char *rest = name;
    const char *first = dalcs_script_word(script, &rest);
    if (first != NULL && strchr(name, '[') != NULL) {
        return let_element(script, s, name, text + length);
    }
    if (text[length] == '\0' || first == NULL || strchr(first, '(') != NULL ||
        dalcs_script_word(script, &rest) != NULL) {
        return dalcs_script_refuse(script, s, "let name = formula", "a name and '=' are missing");
    }
    struct dalcs_vector_formula f = {
        .vectors = &script->vectors, .text = text + length + 1, .arena = &script->arena};
    const struct dalcs_vector *v = dalcs_vector_formula_next(&f);
    if (v == NULL) {
        return f.out_of_memory ? DALCS_E_NOMEM
                               : dalcs_script_refuse(script, s, f.hint[0] != '\0' ? f.hint : NULL,
                                                     "%s", f.message);
    }
    if (!dalcs_vector_formula_at_end(&f)) {
        return dalcs_script_refuse(script, s, NULL, "did not expect '%s'", f.text + f.at);
    }
    return dalcs_vectors_let(&script->vectors, first, v);
}

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

static enum dalcs_status refuse_file(struct dalcs_script *script, const struct dalcs_statement *s,
                                     const char *path, int error) {
    (void)dalcs_script_refuse(script, s, NULL, "cannot write '%s': %s", path, strerror(error));
    return DALCS_E_IO;
}

/* `> name` or `>> name` at the end of a line, in a copy of which it is cut off; a name has a dot, which
 * tells it from what is compared. NULL: none. */
static const char *cut_redirection(char *text, bool *appends) {
    char *sign = strrchr(text, '>');
    if (sign == NULL || sign == text) {
        return NULL;
    }
    const char *name = sign + 1 + strspn(sign + 1, " \t");
    *appends = sign[-1] == '>';
    sign -= *appends;
    const bool is_name = strchr(name, '.') != NULL && strpbrk(name, " \t()*+") == NULL &&
                         strpbrk(name, "abcdefghijklmnopqrstuvwxyz") != NULL;
    if (!is_name) {
        return NULL;
    }
    *sign = '\0';
    return name;
}

static enum dalcs_status print(struct dalcs_script *script, const struct dalcs_statement *s) {
    const struct dalcs_vector **vector;
    const struct dalcs_writing how = writing(script);
    const char *text;
    size_t n;
    enum dalcs_status status = dalcs_script_expand_low(script, s, &text);
    if (status == DALCS_OK && strncmp(text, "line ", 5) == 0) {
        text += 5;
    } else if (status == DALCS_OK && strncmp(text, "col ", 4) == 0) {
        text += 4;
    }
    DALCS_TRY(status);
    bool appends = false;
    char *line = dalcs_arena_copy(&script->arena, text, strlen(text));
    if (line == NULL) {
        return DALCS_E_NOMEM;
    }
    const char *path = cut_redirection(line, &appends);
    DALCS_TRY(dalcs_script_vectors(script, s, line, &vector, &n));
    FILE *file = path != NULL ? fopen(path, appends ? "a" : "w") : script->host->out;
    if (file == NULL) {
        return refuse_file(script, s, path, errno);
    }
    const struct dalcs_plot_vectors *plot = &script->vectors.plot;
    const bool is_point = plot->analysis == DALCS_OPERATING_POINT;
    dalcs_writing_print(file, &how, is_point ? NULL : dalcs_vectors_scale(&script->vectors), vector,
                        n);
    if (path != NULL) {
        const bool failed = ferror(file) != 0;
        if (fclose(file) != 0 || failed) {
            return refuse_file(script, s, path, errno != 0 ? errno : EIO);
        }
    }
    return DALCS_OK;
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
static enum dalcs_status draw(struct dalcs_script *script, const struct dalcs_statement *s) {
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
    const struct dalcs_drawing drawing = {.title = script->vectors.plot.title,
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

static enum dalcs_status write_file(struct dalcs_script *script, const struct dalcs_statement *s) {
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
    status = is_raw ? dalcs_writing_raw(name, &how, &script->vectors.plot, scale, vector, n, &error)
                    : dalcs_writing_data(name, &how, scale, vector, n, &error);
    return status == DALCS_E_IO ? refuse_file(script, s, name, error) : status;
}

/* ---- set and echo ----------------------------------------------------------------------------------- */

/* `set` alone, as ngspice answers it. */
static void list_variables(const struct dalcs_script *script) {
    const struct dalcs_variables *all = &script->variables;
    for (size_t k = 0; k < all->n; k++) {
        fprintf(script->host->out, "%s\t%s\n", all->variable[k].name, all->variable[k].value);
    }
}

/* "name", "name = value", "name = ( a b c )". */
static enum dalcs_status set(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *text;
    enum dalcs_status status = dalcs_script_expand(script, s, &text);
    if (status != DALCS_OK) {
        return status;
    }
    const size_t length = strcspn(text, "=");
    const char *left = dalcs_arena_copy(&script->arena, text, length);
    const char *name = left != NULL ? dalcs_script_word(script, &left) : NULL;
    if (name == NULL && text[length] == '\0') {
        list_variables(script);
        return DALCS_OK;
    }
    if (name == NULL) {
        return dalcs_script_refuse(script, s, "set name=value", "a name is missing");
    }
    struct dalcs_statement lower = {.rest = name, .line = s->line, .column = s->column};
    status = dalcs_script_expand_low(script, &lower, &name);
    if (status != DALCS_OK) {
        return status;
    }
    const char *value = text[length] == '=' ? text + length + 1 : "";
    value += strspn(value, " \t");
    size_t n = strlen(value);
    while (n > 0 && (value[n - 1] == ' ' || value[n - 1] == '\t')) {
        n--;
    }
    const char first = value[0];
    const bool wrapped =
        n >= 2 && ((first == '(' && value[n - 1] == ')') || (first == '"' && value[n - 1] == '"'));
    const char *own = wrapped ? dalcs_arena_copy(&script->arena, value + 1, n - 2)
                              : dalcs_arena_copy(&script->arena, value, n);
    return own != NULL ? dalcs_variables_set(&script->variables, name, own) : DALCS_E_NOMEM;
}

static enum dalcs_status unset(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *text;
    enum dalcs_status status = dalcs_script_expand_low(script, s, &text);
    for (const char *name;
         status == DALCS_OK && (name = dalcs_script_word(script, &text)) != NULL;) {
        dalcs_variables_unset(&script->variables, name);
    }
    return status;
}

static enum dalcs_status echo(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *text;
    enum dalcs_status status = dalcs_script_expand(script, s, &text);
    if (status == DALCS_OK) {
        for (const char *c = text; *c != '\0'; c++) {
            if (*c != '"') {
                fputc(*c, script->host->out);
            }
        }
        fputc('\n', script->host->out);
    }
    return status;
}

/* Does it need a circuit? */
static bool needs_circuit(const struct dalcs_statement *s) {
    return s->kind == DALCS_STATEMENT_ANALYSIS || s->kind == DALCS_STATEMENT_MEASURE ||
           s->kind == DALCS_STATEMENT_ALTER || s->kind == DALCS_STATEMENT_ALTER_PARAMETER ||
           s->kind == DALCS_STATEMENT_ALTER_MODEL;
}

static bool is_heard(const struct dalcs_statement *s) {
    return (needs_circuit(s) && s->kind != DALCS_STATEMENT_MEASURE) ||
           s->kind == DALCS_STATEMENT_LET || s->kind == DALCS_STATEMENT_RESET ||
           s->kind == DALCS_STATEMENT_SAVE || s->kind == DALCS_STATEMENT_SET;
}

/* A measurement; where an analysis was before it, it is made. */
static enum dalcs_status measure(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *rest;
    if (script->has_run || script->host->measure == NULL) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_script_expand(script, s, &rest));
    return script->host->measure(script->host->user, rest);
}

/* What belongs to the host, with variables replaced. */
static enum dalcs_status leave_to_host(struct dalcs_script *script,
                                       const struct dalcs_statement *s) {
    const char *rest;
    DALCS_TRY(dalcs_script_expand(script, s, &rest));
    return script->host->execute(script->host->user, s->word, rest);
}

enum dalcs_status dalcs_script_command(struct dalcs_script *script, size_t index) {
    const struct dalcs_statement *s = &script->statements.statement[index];
    if (script->host->lacks_circuit && needs_circuit(s)) {
        return dalcs_script_refuse(script, s, NULL, "%s: there is no circuit", s->word);
    }
    if (is_heard(s)) {
        DALCS_TRY(tell(script, s));
    }
    switch (s->kind) {
    case DALCS_STATEMENT_ANALYSIS:
        return run(script, index);
    case DALCS_STATEMENT_PRINT:
        return print(script, s);
    case DALCS_STATEMENT_ECHO:
        return echo(script, s);
    case DALCS_STATEMENT_LET:
        return let(script, s);
    case DALCS_STATEMENT_SET:
        return set(script, s);
    case DALCS_STATEMENT_UNSET:
        return unset(script, s);
    case DALCS_STATEMENT_ALTER:
    case DALCS_STATEMENT_ALTER_PARAMETER:
    case DALCS_STATEMENT_ALTER_MODEL:
        return alter(script, s);
    case DALCS_STATEMENT_RESET:
        dalcs_session_reset(script->host->session);
        return DALCS_OK;
    case DALCS_STATEMENT_SAVE:
        return save(script, s);
    case DALCS_STATEMENT_DRAW:
        return draw(script, s);
    case DALCS_STATEMENT_WRDATA:
    case DALCS_STATEMENT_WRITE:
        return write_file(script, s);
    case DALCS_STATEMENT_MEASURE:
        return measure(script, s);
    case DALCS_STATEMENT_HOST:
        return leave_to_host(script, s);
    case DALCS_STATEMENT_BREAK:
        script->breaks = true;
        return DALCS_OK;
    case DALCS_STATEMENT_CONTINUE:
        script->continues = true;
        return DALCS_OK;
    case DALCS_STATEMENT_QUIT:
        script->quits = true;
        return DALCS_OK;
    default: /* skipped, or done with the analysis before */
        return DALCS_OK;
    }
}

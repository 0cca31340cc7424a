/* diag.c - formats and keeps the messages that a person reads.
 *
 *     bridge.cir:4:10: error: 'abc' is not a number
 *     R1 in out abc
 *               ^~~
 *       hint: ...
 *
 * Then follow the subcircuit calls and the inclusions by which the line came in. A message is one
 * string, made when it is added, so it needs nothing of the netlist afterwards.
 * Very long source lines are shown as an excerpt around the caret. */
#include "diag.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char ERROR_LABEL[] = "error: ";

enum { EXCERPT_BEFORE = 60, EXCERPT_AFTER = 90, LINE_MAX_SHOWN = 160, NAME_MAX_SHOWN = 60 };

/* A growing string; after a failed allocation `failed` is set and appending does nothing. */
struct text {
    char *data;
    size_t length;
    size_t capacity;
    bool failed;
};

static void append(struct text *text, const char *piece, size_t length) {
    if (text->failed ||
        dalcs_grow(&text->data, &text->capacity, text->length + length + 1, 1) != DALCS_OK) {
        text->failed = true;
        return;
    }
    memcpy(text->data + text->length, piece, length);
    text->length += length;
    text->data[text->length] = '\0';
}

static void append_text(struct text *text, const char *piece) {
    append(text, piece, strlen(piece));
}

static void append_format_list(struct text *text, const char *format, va_list arguments) {
    va_list again;
    va_copy(again, arguments);
    const int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    if (length < 0 || text->failed ||
        dalcs_grow(&text->data, &text->capacity, text->length + (size_t)length + 1, 1) !=
            DALCS_OK) {
        text->failed = true;
        return;
    }
    vsnprintf(text->data + text->length, (size_t)length + 1, format, arguments);
    text->length += (size_t)length;
}

static void append_format(struct text *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static void append_format(struct text *text, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    append_format_list(text, format, arguments);
    va_end(arguments);
}

static bool starts_character(char c) {
    return ((unsigned char)c & 0xC0) != 0x80;
}

/* The byte where character number `index` (from 0) starts; the end when there are fewer. */
static const char *character_at(const char *line, int index) {
    while (*line != '\0' && index > 0) {
        line++;
        if (starts_character(*line)) {
            index--;
        }
    }
    return line;
}

static int count_characters(const char *line) {
    int n = 0;
    for (; *line != '\0'; line++) {
        n += starts_character(*line);
    }
    return n;
}

/* The source line and the line with the caret under it. Tabs are repeated in the caret's line, so
 * that it stands right whatever their width. */
static void append_excerpt(struct text *text, const struct dalcs_location *where) {
    const int n = count_characters(where->source_line);
    const int caret = where->column > 0 ? where->column - 1 : 0;
    const bool whole = n <= LINE_MAX_SHOWN;
    int first = 0;
    int last = n;
    if (!whole) {
        first = caret > EXCERPT_BEFORE ? caret - EXCERPT_BEFORE : 0;
        last = caret < n - EXCERPT_AFTER ? caret + EXCERPT_AFTER : n;
    }
    const char *begin = character_at(where->source_line, first);
    const char *end = character_at(begin, last - first);
    append_text(text, first > 0 ? "\n..." : "\n");
    append(text, begin, (size_t)(end - begin));
    append_text(text, last < n ? "...\n" : "\n");

    append_text(text, first > 0 ? "   " : "");
    const char *p = begin;
    for (int k = first; k < caret; k++) {
        append_text(text, *p == '\t' ? "\t" : " ");
        p = *p == '\0' ? p : character_at(p, 1);
    }
    append_text(text, "^");
    for (int k = caret + 1; k < caret + where->length && k < last; k++) {
        append_text(text, "~");
    }
}

/* The calls or inclusions from the innermost outwards; of a long chain the inner ones and the last. */
static void append_chain(struct text *text, const struct dalcs_origin *origin) {
    enum { MOST_SHOWN = 4 };

    int n = 0;
    for (const struct dalcs_origin *o = origin; o != NULL; o = o->outer, n++) {
        append_text(text, n == 0 ? "\n  " : n < MOST_SHOWN || o->outer == NULL ? ", " : "");
        if (n == MOST_SHOWN && o->outer != NULL) {
            append_text(text, ", ...");
        } else if (n < MOST_SHOWN || o->outer == NULL) {
            if (o->instance != NULL) {
                const size_t length = strlen(o->instance);
                const bool whole = length <= NAME_MAX_SHOWN;
                append_format(text, "in %s%s (%s:%d)", whole ? "" : "...",
                              o->instance + (whole ? 0 : length - NAME_MAX_SHOWN), o->file,
                              o->line);
            } else {
                append_format(text, "%sfrom %s:%d", n == 0 ? "included " : "", o->file, o->line);
            }
        }
    }
}

/* Was this said of the same place in another instance of the subcircuit? */
static bool is_repetition(const struct dalcs_diag *diag, const struct dalcs_location *where,
                          const char *format) {
    if (where == NULL || where->instance == NULL) {
        return false;
    }
    for (size_t k = 0; k < diag->n; k++) {
        const struct dalcs_diagnostic *item = &diag->item[k];
        if (item->format != NULL && strcmp(item->format, format) == 0 &&
            item->line == where->line && item->column == where->column &&
            item->file_number == where->file_number) {
            return true;
        }
    }
    return false;
}

/* Takes over text->data. */
static void keep(struct dalcs_diag *diag, enum dalcs_severity severity,
                 const struct dalcs_location *where, const char *format, struct text *text) {
    if (text->failed ||
        dalcs_grow(&diag->item, &diag->capacity, diag->n + 1, sizeof *diag->item) != DALCS_OK) {
        free(text->data);
        diag->out_of_memory = true;
        return;
    }
    struct dalcs_diagnostic *item = &diag->item[diag->n++];
    item->severity = severity;
    item->file_number = where != NULL ? where->file_number : 0;
    item->format = where != NULL && where->instance != NULL ? format : NULL;
    item->line = where != NULL ? where->line : 0;
    item->column = where != NULL ? where->column : 0;
    item->text = text->data;
}

void dalcs_diag_add_list(struct dalcs_diag *diag, enum dalcs_severity severity,
                         const struct dalcs_location *where, const char *hint, const char *format,
                         va_list arguments) {
    static const char *const label[] = {"note", "warning", "error"};
    size_t *count = severity == DALCS_ERROR ? &diag->n_errors : &diag->n_other;
    const size_t limit = severity == DALCS_ERROR ? DALCS_DIAG_MAX_ERRORS : DALCS_DIAG_MAX_OTHER;
    if (is_repetition(diag, where, format)) {
        return;
    }
    ++*count;
    if (*count > limit) {
        return;
    }
    struct text text = {0};
    if (*count == limit) {
        append_text(&text, severity == DALCS_ERROR ? "error: more errors than are shown here"
                                                   : "note: more warnings than are shown here");
        keep(diag, severity, NULL, NULL, &text);
        return;
    }
    if (where != NULL && where->file != NULL) {
        append_format(&text, "%s:", where->file);
        if (where->line > 0) {
            append_format(&text, "%d:", where->line);
        }
        if (where->line > 0 && where->column > 0) {
            append_format(&text, "%d:", where->column);
        }
        append_text(&text, " ");
    }
    append_format(&text, "%s: ", label[severity]);
    append_format_list(&text, format, arguments);
    if (where != NULL && where->line > 0 && where->source_line != NULL) {
        append_excerpt(&text, where);
    }
    if (where != NULL) {
        append_chain(&text, where->instance);
        append_chain(&text, where->included);
    }
    if (hint != NULL) {
        append_format(&text, "\n  hint: %s", hint);
    }
    keep(diag, severity, where, format, &text);
}

void dalcs_diag_add(struct dalcs_diag *diag, enum dalcs_severity severity,
                    const struct dalcs_location *where, const char *hint, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    dalcs_diag_add_list(diag, severity, where, hint, format, arguments);
    va_end(arguments);
}

void dalcs_diag_add_text(struct dalcs_diag *diag, enum dalcs_severity severity, const char *text) {
    size_t *count = severity == DALCS_ERROR ? &diag->n_errors : &diag->n_other;
    const size_t limit = severity == DALCS_ERROR ? DALCS_DIAG_MAX_ERRORS : DALCS_DIAG_MAX_OTHER;
    struct text copy = {0};
    if (++*count <= limit) {
        append_text(&copy, text);
        keep(diag, severity, NULL, NULL, &copy);
    }
}

static bool comes_before(const struct dalcs_diagnostic *a, const struct dalcs_diagnostic *b) {
    if ((a->line == 0) != (b->line == 0)) {
        return b->line == 0;
    }
    if (a->file_number != b->file_number) {
        return a->file_number < b->file_number;
    }
    return a->line != b->line ? a->line < b->line : a->column < b->column;
}

void dalcs_diag_sort(struct dalcs_diag *diag) {
    /* Insertion: stable, needs no memory, and there are at most a thousand items, nearly sorted. */
    for (size_t k = 1; k < diag->n; k++) {
        const struct dalcs_diagnostic item = diag->item[k];
        size_t place = k;
        while (place > 0 && comes_before(&item, &diag->item[place - 1])) {
            diag->item[place] = diag->item[place - 1];
            place--;
        }
        diag->item[place] = item;
    }
}

struct dalcs_diag_mark dalcs_diag_mark(const struct dalcs_diag *diag) {
    return (struct dalcs_diag_mark){diag->n, diag->n_errors, diag->n_other};
}

void dalcs_diag_forget(struct dalcs_diag *diag, const struct dalcs_diag_mark *mark) {
    while (diag->n > mark->n) {
        free(diag->item[--diag->n].text);
    }
    diag->n_errors = mark->n_errors;
    diag->n_other = mark->n_other;
}

/* The text of an error as a warning that ends with what follows from it. */
static void soften(struct dalcs_diag *diag, struct dalcs_diagnostic *item,
                   const char *consequence) {
    struct text text = {0};
    size_t length;
    const char *sentence = dalcs_diag_sentence(item->text, &length);
    const size_t place = (size_t)(sentence - item->text) - strlen(ERROR_LABEL);
    append(&text, item->text, place);
    append_format(&text, "warning: %.*s: %s%s", (int)length, sentence, consequence,
                  sentence + length);
    if (text.failed) {
        free(text.data);
        diag->out_of_memory = true;
        return;
    }
    free(item->text);
    item->text = text.data;
}

size_t dalcs_diag_soften(struct dalcs_diag *diag, const struct dalcs_diag_mark *mark,
                         const char *consequence) {
    const size_t n = diag->n_errors - mark->n_errors;
    for (size_t k = mark->n; k < diag->n; k++) {
        struct dalcs_diagnostic *item = &diag->item[k];
        if (item->severity == DALCS_ERROR && strstr(item->text, ERROR_LABEL) != NULL) {
            soften(diag, item, consequence);
            item->severity = DALCS_WARNING;
        }
    }
    diag->n_errors = mark->n_errors;
    diag->n_other += n;
    return n;
}

const char *dalcs_diag_sentence(const char *text, size_t *length) {
    const char *at = strstr(text, ERROR_LABEL);
    const char *sentence = at != NULL ? at + strlen(ERROR_LABEL) : text;
    *length = strcspn(sentence, "\n");
    return sentence;
}

void dalcs_diag_finish(struct dalcs_diag *diag) {
    for (size_t k = 0; k < diag->n; k++) {
        free(diag->item[k].text);
    }
    free(diag->item);
    *diag = (struct dalcs_diag){0};
}

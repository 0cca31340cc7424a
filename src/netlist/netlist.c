/* netlist.c - a file or a text to cards.
 *
 * Splits the text into lines and hands them to the lexer. A file that is no text at all (a NUL byte)
 * is one error, not a thousand. */
#include "netlist.h"

#include "encoding.h"
#include "foreign.h"
#include "lexer.h"
#include "text_file.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Reports a text that is no netlist; false if it is one. */
static bool is_no_text(struct dalcs_netlist *netlist, const struct dalcs_source *source,
                       const char *text, size_t length, struct dalcs_diag *diag) {
    const char *nul = length > 0 ? memchr(text, '\0', length) : NULL;
    if (nul == NULL) {
        return false;
    }
    struct dalcs_location where = {.file = source->name,
                                   .line = 1,
                                   .length = 1,
                                   .file_number = source->number,
                                   .included = source->included};
    const char *line = text;
    for (const char *p = text; p < nul; p++) {
        if (*p == '\n') {
            where.line++;
            line = p + 1;
        }
    }
    where.column = (int)(nul - line) + 1;
    dalcs_diag_add(diag, DALCS_ERROR, &where, "save the netlist as UTF-8 text",
                   "NUL byte: this is not a text file");
    netlist->has_errors = true;
    return true;
}

static size_t end_of_line(const struct dalcs_lexer *lexer, size_t begin) {
    const char *newline = memchr(lexer->raw + begin, '\n', lexer->length - begin);
    return newline != NULL ? (size_t)(newline - lexer->raw) : lexer->length;
}

/* The braces and quotes of an expression that are still open at the end of a line. */
struct open_expression {
    int depth;
    bool quoted;
    size_t end; /* of the text of the last line, before its comment */
};

static bool is_blank(char c) {
    return c == ' ' || c == '\t';
}

/* Does a comment start at line[k], as dalcs_lexer_read_line sees it outside of expressions? */
static bool starts_comment(const char *line, size_t k, size_t length) {
    if (line[k] == ';') {
        return true;
    }
    const char next = k + 1 < length ? line[k + 1] : ' ';
    const bool is_sign =
        (line[k] == '$' && (is_blank(next) || next == '\r')) || (line[k] == '/' && next == '/');
    return is_sign && (k == 0 || is_blank(line[k - 1]));
}

/* Takes one more line, from `begin` on: what was open before it may end there. */
static void follow(struct open_expression *open, const char *raw, size_t begin, size_t length) {
    const char *line = raw + begin;
    size_t k = 0;
    for (; k < length && !starts_comment(line, k, length); k++) {
        open->depth += (line[k] == '{') - (line[k] == '}');
        open->quoted = open->quoted != (line[k] == '\'');
    }
    open->end = begin + k;
}

/* Does the line begin an expression that it does not end? */
static bool begins_expression(struct open_expression *open, const char *raw, size_t begin,
                              size_t length) {
    const char *line = raw + begin;
    if (memchr(line, '{', length) == NULL && memchr(line, '\'', length) == NULL) {
        return false;
    }
    size_t k = 0;
    while (k < length && is_blank(line[k])) {
        k++;
    }
    if (k < length && line[k] != '*') {
        follow(open, raw, begin, length);
    }
    return open->depth > 0 || open->quoted;
}

/* The begin of the next line that is neither blank nor a comment, *n_lines further on. */
static size_t next_text(const struct dalcs_lexer *lexer, size_t end, int *n_lines) {
    for (;;) {
        size_t p = end + 1;
        ++*n_lines;
        while (p < lexer->length && strchr(" \t\r", lexer->raw[p]) != NULL) {
            p++;
        }
        if (p >= lexer->length) {
            return p;
        }
        end = end_of_line(lexer, p);
        if (p < end && lexer->raw[p] != '*' && !starts_comment(lexer->raw + p, 0, end - p)) {
            return p;
        }
    }
}

/* Such an expression may go on behind a + on the next line, as cards do: one line is made of both,
 * without the comment between them. *n_joined: how many were added. */
static size_t join_lines(struct dalcs_lexer *lexer, size_t begin, size_t end, int *n_joined) {
    struct open_expression open = {0};
    bool is_open = end < lexer->length && begins_expression(&open, lexer->raw, begin, end - begin);
    while (is_open && end < lexer->length) {
        int n_lines = 0;
        const size_t next = next_text(lexer, end, &n_lines);
        if (next >= lexer->length || lexer->raw[next] != '+') {
            break;
        }
        memset(lexer->raw + open.end, ' ', next + 1 - open.end);
        memset(lexer->low + open.end, ' ', next + 1 - open.end);
        end = end_of_line(lexer, next);
        follow(&open, lexer->raw, next + 1, end - next - 1);
        is_open = open.depth > 0 || open.quoted;
        *n_joined += n_lines;
    }
    return end;
}

static enum dalcs_status read_lines(struct dalcs_lexer *lexer, size_t begin) {
    dalcs_lexer_clean(lexer, begin);
    while (begin < lexer->length && !lexer->ended) {
        size_t end = end_of_line(lexer, begin);
        int n_joined = 0;
        if (!lexer->in_control) {
            end = join_lines(lexer, begin, end, &n_joined);
        }
        /* The carriage return of a CRLF is no part of the line. */
        const bool crlf = end > begin && lexer->raw[end - 1] == '\r';
        lexer->at = begin;
        DALCS_TRY(dalcs_lexer_read_line(lexer, begin, crlf ? end - 1 : end));
        lexer->line_number += n_joined;
        begin = end + 1;
    }
    lexer->at = lexer->length;
    return dalcs_lexer_flush(lexer);
}

/* A library was read to its end: was the section there, and closed? */
static void check_section(struct dalcs_lexer *lexer, const struct dalcs_token *section) {
    if (section != NULL && !lexer->section.is_found) {
        struct dalcs_arena *arena = &lexer->netlist->arena;
        const char *near = dalcs_names_nearest(lexer->section.all, section->text);
        const char *list = dalcs_names_join(lexer->section.all, 8, arena);
        const char *hint = near != NULL   ? dalcs_arena_printf(arena, "did you mean '%s'?", near)
                           : list != NULL ? dalcs_arena_printf(arena, "its sections are: %s", list)
                                          : "a section is: .lib name ... .endl";
        dalcs_lexer_report(lexer, section, hint, "'%s' has no section '%s'", lexer->source->name,
                           section->text);
        lexer->netlist->misses_file = true;
    } else if (lexer->section.open != NULL) {
        dalcs_lexer_report(lexer, lexer->section.open, "add a line: .endl",
                           "this section is never closed");
    }
}

enum dalcs_status dalcs_source_read(struct dalcs_netlist *netlist,
                                    const struct dalcs_source *source, const char *text,
                                    size_t length, const struct dalcs_token *section,
                                    struct dalcs_diag *diag) {
    if (length > INT_MAX / 2 - netlist->n_bytes) {
        const struct dalcs_location where = {.file = source->name};
        dalcs_diag_add(diag, DALCS_ERROR, &where, NULL, "the netlist is larger than 1 GiB");
        netlist->has_errors = true;
        return DALCS_E_LIMIT;
    }
    netlist->n_bytes += length;
    struct dalcs_lexer lexer = {.netlist = netlist, .source = source, .diag = diag};
    DALCS_TRY(dalcs_encoding_to_utf8(&netlist->arena, &text, &length));
    lexer.raw = dalcs_arena_copy(&netlist->arena, text, length);
    lexer.low = dalcs_arena_alloc(&netlist->arena, length + 1, 1);
    if (lexer.raw == NULL || lexer.low == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_text_end_lines(lexer.raw, length);
    if (dalcs_foreign_is_reported(netlist, source, lexer.raw, length, diag) ||
        is_no_text(netlist, source, lexer.raw, length, diag)) {
        return DALCS_OK;
    }
    struct dalcs_names sections = {0};
    lexer.length = length;
    lexer.section.wanted = section != NULL ? section->text : NULL;
    lexer.section.is_skipped = section != NULL;
    lexer.section.all = &sections;
    const size_t bom = length >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    const enum dalcs_status status = read_lines(&lexer, bom);
    if (status == DALCS_OK) {
        check_section(&lexer, section);
    }
    dalcs_names_finish(&sections);
    free(lexer.token);
    return status;
}

/* The netlist itself: `real` is its absolute path, NULL for a text. */
static enum dalcs_status read_first(struct dalcs_netlist *netlist, const char *name,
                                    const char *real, const char *text, size_t length,
                                    struct dalcs_diag *diag) {
    struct dalcs_source *source = dalcs_arena_alloc(&netlist->arena, 1, sizeof *source);
    netlist->name = dalcs_arena_copy(&netlist->arena, name, strlen(name));
    netlist->title = "";
    if (source == NULL || netlist->name == NULL) {
        return DALCS_E_NOMEM;
    }
    source->name = netlist->name;
    netlist->n_sources = 1;
    if (real != NULL) {
        source->real = dalcs_arena_copy(&netlist->arena, real, strlen(real));
        if (source->real == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    DALCS_TRY(dalcs_source_read(netlist, source, text, length, NULL, diag));
    dalcs_dialect_settle(netlist, diag);
    DALCS_TRY(dalcs_other_transient(netlist, diag));
    return dalcs_second_analyses(netlist, diag);
}

enum dalcs_status dalcs_netlist_read_text(struct dalcs_netlist *netlist, const char *name,
                                          const char *text, size_t length,
                                          struct dalcs_diag *diag) {
    return read_first(netlist, name, NULL, text, length, diag);
}

enum dalcs_status dalcs_netlist_read_file_text(struct dalcs_netlist *netlist, const char *path,
                                               const char *text, size_t length,
                                               struct dalcs_diag *diag) {
    char *real = realpath(path, NULL); /* NULL: a pipe, say, which cannot include itself */
    enum dalcs_status status = read_first(netlist, path, real, text, length, diag);
    free(real);
    return status;
}

enum dalcs_status dalcs_netlist_read_file(struct dalcs_netlist *netlist, const char *path,
                                          struct dalcs_diag *diag) {
    char *text;
    size_t length;
    /* Beyond the limit, dalcs_source_read says that it is too large. */
    enum dalcs_status status = dalcs_text_file_read(path, INT_MAX, &text, &length, NULL, diag);
    if (status == DALCS_OK) {
        status = dalcs_netlist_read_file_text(netlist, path, text, length, diag);
    }
    free(text);
    return status;
}

void dalcs_netlist_finish(struct dalcs_netlist *netlist) {
    free(netlist->card);
    free(netlist->commands.line);
    free(netlist->later.line);
    dalcs_arena_finish(&netlist->arena);
    *netlist = (struct dalcs_netlist){0};
}

enum dalcs_status dalcs_netlist_add_card(struct dalcs_netlist *netlist,
                                         const struct dalcs_source_line *line, const char *text,
                                         struct dalcs_diag *diag) {
    struct dalcs_source *source = dalcs_arena_alloc(&netlist->arena, 1, sizeof *source);
    if (source == NULL) {
        return DALCS_E_NOMEM;
    }
    *source = *line->source;
    source->outer = line->source; /* its first line is no title */
    const size_t length = strlen(text);
    struct dalcs_lexer lexer = {.netlist = netlist,
                                .source = source,
                                .diag = diag,
                                .line_number = line->number - 1,
                                .length = length + 1};
    lexer.raw = dalcs_arena_alloc(&netlist->arena, length + 2, 1);
    lexer.low = dalcs_arena_alloc(&netlist->arena, length + 2, 1);
    if (lexer.raw == NULL || lexer.low == NULL) {
        return DALCS_E_NOMEM;
    }
    lexer.raw[0] = '.';
    memcpy(lexer.raw + 1, text, length);
    const enum dalcs_status status = read_lines(&lexer, 0);
    free(lexer.token);
    return status;
}

bool dalcs_token_is_word(const struct dalcs_token *token, const char *word) {
    return token->kind == DALCS_TOKEN_WORD && strcmp(token->text, word) == 0;
}

enum dalcs_status dalcs_source_lines_add(struct dalcs_source_lines *lines,
                                         struct dalcs_source_line line) {
    DALCS_TRY(dalcs_grow(&lines->line, &lines->capacity, lines->n + 1, sizeof *lines->line));
    lines->line[lines->n++] = line;
    return DALCS_OK;
}

/* netlist.c - a file or a text to cards, and the places of tokens.
 *
 * Splits the text into lines and hands them to the lexer. A file that is no text at all (UTF-16, a
 * NUL byte) is one error, not a thousand. */
#include "netlist.h"

#include "lexer.h"
#include "text_file.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Says so when the text is not one; else false. */
static bool is_no_text(struct dalcs_netlist *netlist, const char *text, size_t length,
                       struct dalcs_diag *diag) {
    const bool utf16 =
        length >= 2 && (memcmp(text, "\xFF\xFE", 2) == 0 || memcmp(text, "\xFE\xFF", 2) == 0);
    const char *nul = length > 0 ? memchr(text, '\0', length) : NULL;
    if (!utf16 && nul == NULL) {
        return false;
    }
    struct dalcs_location where = {.file = netlist->name, .line = 1, .length = 1};
    if (!utf16) {
        const char *line = text;
        for (const char *p = text; p < nul; p++) {
            if (*p == '\n') {
                where.line++;
                line = p + 1;
            }
        }
        where.column = (int)(nul - line) + 1;
    }
    dalcs_diag_add(diag, DALCS_ERROR, &where, "save the netlist as UTF-8 text",
                   utf16 ? "the file is UTF-16" : "NUL byte: this is not a text file");
    netlist->has_errors = true;
    return true;
}

static enum dalcs_status read_lines(struct dalcs_lexer *lexer, size_t begin, size_t length) {
    while (begin < length && !lexer->ended) {
        const char *newline = memchr(lexer->raw + begin, '\n', length - begin);
        const size_t end = newline != NULL ? (size_t)(newline - lexer->raw) : length;
        /* The carriage return of a CRLF is no part of the line. */
        const bool crlf = end > begin && lexer->raw[end - 1] == '\r';
        DALCS_TRY(dalcs_lexer_read_line(lexer, begin, crlf ? end - 1 : end));
        begin = end + 1;
    }
    return dalcs_lexer_flush(lexer);
}

enum dalcs_status dalcs_netlist_read_text(struct dalcs_netlist *netlist, const char *name,
                                          const char *text, size_t length,
                                          struct dalcs_diag *diag) {
    netlist->name = dalcs_arena_copy(&netlist->arena, name, strlen(name));
    if (netlist->name == NULL) {
        return DALCS_E_NOMEM;
    }
    netlist->title = "";
    if (length > INT_MAX / 2) {
        const struct dalcs_location where = {.file = netlist->name};
        dalcs_diag_add(diag, DALCS_ERROR, &where, NULL, "the netlist is larger than 1 GiB");
        netlist->has_errors = true;
        return DALCS_E_LIMIT;
    }
    if (is_no_text(netlist, text, length, diag)) {
        return DALCS_OK;
    }
    struct dalcs_lexer lexer = {.netlist = netlist, .diag = diag};
    lexer.raw = dalcs_arena_copy(&netlist->arena, text, length);
    lexer.low = dalcs_arena_alloc(&netlist->arena, length + 1, 1);
    if (lexer.raw == NULL || lexer.low == NULL) {
        return DALCS_E_NOMEM;
    }
    const size_t bom = length >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    const enum dalcs_status status = read_lines(&lexer, bom, length);
    free(lexer.token);
    return status;
}

enum dalcs_status dalcs_netlist_read_file(struct dalcs_netlist *netlist, const char *path,
                                          struct dalcs_diag *diag) {
    char *text;
    size_t length;
    /* Beyond the limit, read_text says that it is too large. */
    enum dalcs_status status = dalcs_text_file_read(path, INT_MAX, &text, &length, diag);
    if (status == DALCS_OK) {
        status = dalcs_netlist_read_text(netlist, path, text, length, diag);
    }
    free(text);
    return status;
}

void dalcs_netlist_finish(struct dalcs_netlist *netlist) {
    free(netlist->card);
    dalcs_arena_finish(&netlist->arena);
    *netlist = (struct dalcs_netlist){0};
}

/* Characters (UTF-8 code points) in text[0..bytes-1]. */
static int count_characters(const char *text, int bytes) {
    int n = 0;
    for (int k = 0; k < bytes; k++) {
        n += ((unsigned char)text[k] & 0xC0) != 0x80;
    }
    return n;
}

static struct dalcs_location make_location(const struct dalcs_source_line *line, int offset,
                                           int length) {
    return (struct dalcs_location){.file = line->file,
                                   .source_line = line->text,
                                   .line = line->number,
                                   .column = count_characters(line->text, offset) + 1,
                                   .length = count_characters(line->text + offset, length)};
}

struct dalcs_location dalcs_token_location(const struct dalcs_token *token) {
    return make_location(token->line, token->offset, token->length);
}

struct dalcs_location dalcs_token_span(const struct dalcs_token *first,
                                       const struct dalcs_token *last) {
    if (last->line != first->line || last->offset < first->offset) {
        return dalcs_token_location(first);
    }
    return make_location(first->line, first->offset, last->offset + last->length - first->offset);
}

struct dalcs_location dalcs_token_end(const struct dalcs_token *token) {
    struct dalcs_location where = make_location(token->line, token->offset + token->length, 0);
    where.length = 1;
    return where;
}

/* include.c - .include and .lib: the cards of another file in place of the card that names it.
 *
 *     .include "file"       all of the file (also .inc, .incl, .lib file)
 *     .lib "file" section   what stands there between .lib section and .endl
 *
 * library_path.c finds the file. `.lib name` with one word begins a section when an .endl follows before the next
 * .lib; a section that no card names is skipped. */
#include "lexer.h"
#include "library_path.h"
#include "lower_case.h"
#include "text_file.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Files that include nothing cost no bytes: they are counted too. */
enum { MOST_SOURCES = 100000, DEEPEST = 200 };

bool dalcs_include_is_card(const char *name) {
    static const char *const words[] = {".include", ".inc", ".incl", ".lib", ".endl"};
    for (size_t k = 0; k < sizeof words / sizeof words[0]; k++) {
        if (strcmp(name, words[k]) == 0) {
            return true;
        }
    }
    return false;
}

/* The name as written: names of files have an upper and a lower case. */
static const char *file_name(struct dalcs_lexer *lexer, const struct dalcs_token *token) {
    const char *text = token->line->text + token->offset;
    const int quotes = token->kind == DALCS_TOKEN_WORD ? 0 : 1;
    return dalcs_arena_copy(&lexer->netlist->arena, text + quotes,
                            (size_t)(token->length - 2 * quotes));
}

static bool is_cycle(struct dalcs_lexer *lexer, const struct dalcs_source *source,
                     const struct dalcs_token *token) {
    int depth = 0;
    for (const struct dalcs_source *s = source->outer; s != NULL; s = s->outer) {
        if (++depth > DEEPEST) {
            dalcs_lexer_report(lexer, token, NULL, "files include each other more than %d deep",
                               DEEPEST);
            return true;
        }
        if (s->real != NULL && strcmp(s->real, source->real) == 0) {
            dalcs_lexer_report(lexer, token, NULL, "'%s' includes itself", source->name);
            return true;
        }
    }
    return false;
}

static enum dalcs_status make_source(struct dalcs_lexer *lexer, const struct dalcs_token *token,
                                     const char *path, struct dalcs_source **made) {
    struct dalcs_arena *arena = &lexer->netlist->arena;
    struct dalcs_source *source = dalcs_arena_alloc(arena, 1, sizeof *source);
    struct dalcs_origin *origin = dalcs_arena_alloc(arena, 1, sizeof *origin);
    char *real = realpath(path, NULL);
    const char *kept = real != NULL ? dalcs_arena_copy(arena, real, strlen(real)) : "";
    free(real);
    if (source == NULL || origin == NULL || kept == NULL) {
        return DALCS_E_NOMEM;
    }
    *origin = (struct dalcs_origin){NULL, lexer->source->name, token->line->number,
                                    lexer->source->included};
    *source = (struct dalcs_source){path, kept, lexer->netlist->n_sources++, lexer->source, origin};
    *made = source;
    return DALCS_OK;
}

/* A library that is not here: what it has may not be needed, and what is needed and nowhere is an error at the
 * element that names it. */
static void leave_out(struct dalcs_lexer *lexer, const struct dalcs_token *token,
                      const char *name) {
    const struct dalcs_location where = dalcs_token_location(token);
    dalcs_diag_add(lexer->diag, DALCS_WARNING, &where,
                   "the models and subcircuits of the elements must be in the netlist",
                   "the library '%s' was not found: it is left out", name);
    lexer->netlist->missing_library = name;
}

static enum dalcs_status include(struct dalcs_lexer *lexer, const struct dalcs_token *token,
                                 const char *name, const struct dalcs_token *section,
                                 bool is_library) {
    struct dalcs_netlist *netlist = lexer->netlist;
    const struct dalcs_location where = dalcs_token_location(token);
    if (netlist->no_includes || netlist->n_sources >= MOST_SOURCES) {
        dalcs_lexer_report(lexer, token, NULL, "%s",
                           netlist->no_includes ? "no other file can be read from here"
                                                : "more than 100000 files are included");
        netlist->misses_file = true;
        return DALCS_OK;
    }
    bool elsewhere = false;
    const char *path = name != NULL ? dalcs_library_path(lexer, name, &elsewhere) : NULL;
    struct dalcs_source *source;
    if (path == NULL) {
        return DALCS_E_NOMEM;
    }
    if (section == NULL && is_library && access(path, F_OK) != 0) {
        leave_out(lexer, token, name);
        return DALCS_OK;
    }
    if (elsewhere) {
        dalcs_diag_add(lexer->diag, DALCS_NOTE, &where, NULL, "'%s' is read in its place", path);
    }
    DALCS_TRY(make_source(lexer, token, path, &source));
    if (is_cycle(lexer, source, token)) {
        return DALCS_OK;
    }
    char *text;
    size_t length;
    enum dalcs_status status =
        dalcs_text_file_read(path, INT_MAX, &text, &length, &where, lexer->diag);
    if (status == DALCS_E_IO) {
        netlist->has_errors = true;
        netlist->misses_file = true;
        return DALCS_OK;
    }
    if (status == DALCS_OK) {
        status = dalcs_source_read(netlist, source, text, length, section, lexer->diag);
    }
    free(text);
    return status;
}

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/* Does an .endl follow before the next .lib? Looks at the lines from the one being read on. */
static bool endl_follows(const struct dalcs_lexer *lexer) {
    const char *p = lexer->raw + lexer->at;
    const char *end = lexer->raw + lexer->length;
    while (p < end) {
        while (p < end && is_blank(*p)) {
            p++;
        }
        char word[6] = {0};
        for (size_t k = 0; k < 5 && p + k < end; k++) {
            word[k] = dalcs_lower(p[k]);
        }
        if (strcmp(word, ".endl") == 0) {
            return true;
        }
        if (strncmp(word, ".lib", 4) == 0) {
            return false;
        }
        /* Lines that were read end with a NUL. */
        while (p < end && *p != '\n' && *p != '\0') {
            p++;
        }
        p++;
    }
    return false;
}

static bool is_name(const struct dalcs_token *token) {
    return token->kind == DALCS_TOKEN_WORD || token->kind == DALCS_TOKEN_STRING ||
           token->kind == DALCS_TOKEN_EXPRESSION;
}

/* The end of a section; also of one that is read because it was asked for. */
static void end_section(struct dalcs_lexer *lexer, const struct dalcs_card *card) {
    if (lexer->section.open == NULL) {
        dalcs_lexer_report(lexer, card->token, "a section is: .lib name ... .endl",
                           "there is no section to end");
        return;
    }
    if (card->n > 1 && strcmp(card->token[1].text, lexer->section.open[1].text) != 0) {
        dalcs_lexer_report(lexer, &card->token[1], NULL, "the section that ends here is '%s'",
                           lexer->section.open[1].text);
    }
    lexer->section.open = NULL;
    lexer->section.is_skipped = lexer->section.wanted != NULL;
}

enum dalcs_status dalcs_include_card(struct dalcs_lexer *lexer, const struct dalcs_card *card) {
    const struct dalcs_token *token = card->token;
    const bool is_lib = strcmp(token->text, ".lib") == 0;
    const char *usage = is_lib ? ".lib \"file\" section" : ".include \"file\"";
    if (strcmp(token->text, ".endl") == 0) {
        end_section(lexer, card);
        return DALCS_OK;
    }
    for (int k = 1; k < card->n; k++) {
        if (token[k].kind == DALCS_TOKEN_BAD) {
            lexer->netlist->misses_file = true;
            return DALCS_OK;
        }
    }
    if (card->n < 2 || !is_name(&token[1])) {
        struct dalcs_location where = dalcs_token_end(token);
        dalcs_diag_add(lexer->diag, DALCS_ERROR, &where, usage, "the name of a file is missing");
        lexer->netlist->has_errors = true;
        lexer->netlist->misses_file = true;
        return DALCS_OK;
    }
    const char *library = dalcs_library_with_blanks(lexer, card);
    if (library != NULL) {
        return include(lexer, &token[1], library, NULL, dalcs_library_is_name(library));
    }
    if (card->n > (is_lib ? 3 : 2)) {
        dalcs_lexer_report(lexer, &token[is_lib ? 3 : 2], "put quotes around a name with blanks",
                           "did not expect '%s' here", token[is_lib ? 3 : 2].text);
        lexer->netlist->misses_file = true;
        return DALCS_OK;
    }
    if (is_lib && card->n == 2 && lexer->section.open == NULL && endl_follows(lexer)) {
        lexer->section.open = token;
        lexer->section.is_skipped = true;
        return DALCS_OK;
    }
    const char *name = file_name(lexer, &token[1]);
    return include(lexer, &token[1], name, card->n == 3 ? &token[2] : NULL,
                   is_lib || (name != NULL && dalcs_library_is_name(name)));
}

/* The word that starts at p, lower case, in the arena. */
static const char *word_at(const struct dalcs_lexer *lexer, size_t p) {
    size_t n = 0;
    while (lexer->low[p + n] != '\0' && !is_blank(lexer->low[p + n])) {
        n++;
    }
    return dalcs_arena_copy(&lexer->netlist->arena, lexer->low + p, n);
}

enum dalcs_status dalcs_include_skips(struct dalcs_lexer *lexer, size_t p, bool *skips) {
    *skips = true;
    if (lexer->section.open != NULL) {
        /* A section inside a file that is read as a whole. */
        *skips = !dalcs_lexer_starts_with(lexer, p, ".endl");
        return DALCS_OK;
    }
    if (!dalcs_lexer_starts_with(lexer, p, ".lib")) {
        return DALCS_OK;
    }
    const size_t line = p;
    p += strlen(".lib");
    while (is_blank(lexer->low[p])) {
        p++;
    }
    const char *name = word_at(lexer, p);
    if (name == NULL) {
        return DALCS_E_NOMEM;
    }
    if (dalcs_names_find(lexer->section.all, name) < 0) {
        DALCS_TRY(dalcs_names_add(lexer->section.all, name, 0));
    }
    if (strcmp(name, lexer->section.wanted) == 0) {
        struct dalcs_token *open = dalcs_arena_alloc(&lexer->netlist->arena, 2, sizeof *open);
        struct dalcs_source_line *where =
            dalcs_arena_alloc(&lexer->netlist->arena, 1, sizeof *where);
        if (open == NULL || where == NULL) {
            return DALCS_E_NOMEM;
        }
        where->source = lexer->source;
        where->text = lexer->raw + lexer->at;
        where->number = lexer->line_number;
        open[0] = (struct dalcs_token){.line = where,
                                       .text = ".lib",
                                       .offset = (int)(line - lexer->at),
                                       .length = sizeof ".lib" - 1};
        open[1].text = name;
        lexer->section.open = open;
        lexer->section.is_found = true;
        lexer->section.is_skipped = false;
    }
    return DALCS_OK;
}

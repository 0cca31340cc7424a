/* include.c - .include and .lib: the cards of another file in place of the card that names it.
 *
 *     .include "file"       all of the file (also .inc, .incl, .lib file)
 *     .lib "file" section   what stands there between .lib section and .endl
 *
 * A name is relative to the file that includes; one without a folder that is not there may be a library's that is
 * installed. `.lib name` with one word begins a section when an
 * .endl follows before the next .lib; a section that nobody asks for is skipped. */
#include "lexer.h"
#include "lower_case.h"
#include "text_file.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
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

/* A file of that name in the folder DALCS_LIBRARIES of the environment, else among the libraries that are installed with
 * dalcs, else in the source tree that it was built from; `path` where the netlist has such a file itself, or nobody. */
static const char *installed(struct dalcs_lexer *lexer, const char *name, const char *path) {
    const char *const folder[] = {getenv("DALCS_LIBRARIES"), DALCS_LIBRARIES,
                                  DALCS_SOURCE_LIBRARIES};
    if (path == NULL || strchr(name, '/') != NULL || access(path, R_OK) == 0) {
        return path;
    }
    for (size_t k = 0; k < sizeof folder / sizeof *folder; k++) {
        const char *found =
            folder[k] != NULL ? dalcs_arena_printf(&lexer->netlist->arena, "%s/%s", folder[k], name)
                              : path;
        if (found == NULL || access(found, R_OK) == 0) {
            return found;
        }
    }
    return path;
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

/* What LTspice writes into every netlist with a diode or a transistor: its own libraries, wherever it is
 * installed. */
static bool is_of_ltspice(const char *path) {
    static const char *const names[] = {"standard.dio", "standard.bjt", "standard.mos",
                                        "standard.jft", "standard.cap", "standard.ind",
                                        "standard.res", "standard.bead"};
    const size_t n = strlen(path);
    bool found = false;
    for (size_t k = 0; k < sizeof names / sizeof names[0] && !found; k++) {
        const size_t length = strlen(names[k]);
        found = n >= length && strcasecmp(path + n - length, names[k]) == 0;
    }
    return found;
}

/* The rest of the line behind .lib, where it is the path of such a library, whose blanks and brackets LTspice does
 * not quote; NULL: it is something else. */
static const char *library_path(struct dalcs_lexer *lexer, const struct dalcs_card *card) {
    const struct dalcs_token *first = &card->token[1];
    const struct dalcs_token *last = &card->token[card->n - 1];
    if (card->n < 2 || first->kind != DALCS_TOKEN_WORD || last->line != first->line) {
        return NULL;
    }
    const size_t end = (size_t)last->offset + last->length;
    const char *path = dalcs_arena_copy(&lexer->netlist->arena, first->line->text + first->offset,
                                        end - (size_t)first->offset);
    return path != NULL && is_of_ltspice(path) ? path : NULL;
}

static enum dalcs_status include(struct dalcs_lexer *lexer, const struct dalcs_token *token,
                                 const struct dalcs_token *section) {
    struct dalcs_netlist *netlist = lexer->netlist;
    if (netlist->no_includes || netlist->n_sources >= MOST_SOURCES) {
        dalcs_lexer_report(lexer, token, NULL, "%s",
                           netlist->no_includes ? "no other file can be read from here"
                                                : "more than 100000 files are included");
        netlist->misses_file = true;
        return DALCS_OK;
    }
    const char *name = file_name(lexer, token);
    const char *path = name != NULL ? installed(lexer, name, path_of(lexer, name)) : NULL;
    struct dalcs_source *source;
    if (path == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(make_source(lexer, token, path, &source));
    if (is_cycle(lexer, source, token)) {
        return DALCS_OK;
    }
    const struct dalcs_location where = dalcs_token_location(token);
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
    if (lexer->open == NULL) {
        dalcs_lexer_report(lexer, card->token, "a section is: .lib name ... .endl",
                           "there is no section to end");
        return;
    }
    if (card->n > 1 && strcmp(card->token[1].text, lexer->open[1].text) != 0) {
        dalcs_lexer_report(lexer, &card->token[1], NULL, "the section that ends here is '%s'",
                           lexer->open[1].text);
    }
    lexer->open = NULL;
    lexer->skipping = lexer->section != NULL;
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
    const char *library = library_path(lexer, card);
    if (library != NULL && access(library, R_OK) != 0) {
        const struct dalcs_location where = dalcs_token_span(&token[1], &token[card->n - 1]);
        dalcs_diag_add(lexer->diag, DALCS_WARNING, &where,
                       "the models of the elements must be in the netlist",
                       "LTspice's library '%s' is not here: it is left out", library);
        return DALCS_OK;
    }
    if (card->n > (is_lib ? 3 : 2)) {
        dalcs_lexer_report(lexer, &token[is_lib ? 3 : 2], "put quotes around a name with blanks",
                           "did not expect '%s' here", token[is_lib ? 3 : 2].text);
        lexer->netlist->misses_file = true;
        return DALCS_OK;
    }
    if (is_lib && card->n == 2 && lexer->open == NULL && endl_follows(lexer)) {
        lexer->open = token;
        lexer->skipping = true;
        return DALCS_OK;
    }
    return include(lexer, &token[1], card->n == 3 ? &token[2] : NULL);
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
    if (lexer->open != NULL) {
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
    if (dalcs_names_find(lexer->sections, name) < 0) {
        DALCS_TRY(dalcs_names_add(lexer->sections, name, 0));
    }
    if (strcmp(name, lexer->section) == 0) {
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
        lexer->open = open;
        lexer->section_found = true;
        lexer->skipping = false;
    }
    return DALCS_OK;
}

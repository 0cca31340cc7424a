/* script_look.c - whether a script asks for an analysis, before it runs. */
#include "script_internal.h"

#include <string.h>

/* A word for several vectors: all, allv, alli, ally, tran1.all. */
static bool names_all(const char *text) {
    for (const char *p = strstr(text, "all"); p != NULL; p = strstr(p + 1, "all")) {
        const bool begins = p == text || strchr(" \t,.", p[-1]) != NULL;
        const char *end = p + 3 + (p[3] != '\0' && strchr("viy", p[3]) != NULL);
        if (begins && (*end == '\0' || strchr(" \t,", *end) != NULL)) {
            return true;
        }
    }
    return false;
}

/* Does it work with all vectors? */
static bool takes_all(const struct dalcs_statement *s) {
    const bool has_file = s->kind == DALCS_STATEMENT_WRITE || s->kind == DALCS_STATEMENT_WRDATA ||
                          strcmp(s->word, "hardcopy") == 0;
    const bool takes = has_file || s->kind == DALCS_STATEMENT_PRINT ||
                       s->kind == DALCS_STATEMENT_DRAW || s->kind == DALCS_STATEMENT_LINEARIZE ||
                       s->kind == DALCS_STATEMENT_FFT;
    const char *rest = s->rest + (has_file ? strcspn(s->rest, " \t") : 0);
    rest += strspn(rest, " \t");
    return s->kind == DALCS_STATEMENT_DISPLAY || (takes && (*rest == '\0' || names_all(rest)));
}

bool dalcs_script_keeps_all(const struct dalcs_statements *all) {
    bool found = strstr(all->text, "($") != NULL || strstr(all->text, ",$") != NULL;
    for (size_t k = 0; k < all->n && !found; k++) {
        found = takes_all(&all->statement[k]);
    }
    return found;
}

bool dalcs_script_keeps_plots(const struct dalcs_statements *all) {
    static const char *const type[] = {"tran", "ac", "dc", "op", "tf", "pss", "sp", "unknown"};
    bool found = strstr(all->text, "curplot") != NULL || strstr(all->text, "$plots") != NULL ||
                 strstr(all->text, "}.") != NULL;
    for (size_t k = 0; k < all->n && !found; k++) {
        found = all->statement[k].kind == DALCS_STATEMENT_SETPLOT ||
                all->statement[k].kind == DALCS_STATEMENT_DESTROY;
    }
    for (size_t k = 0; k < sizeof type / sizeof type[0]; k++) {
        const size_t n = strlen(type[k]);
        for (const char *p = strstr(all->text, type[k]); p != NULL && !found;
             p = strstr(p + n, type[k])) {
            found = p[n + strspn(p + n, "0123456789")] == '.';
        }
    }
    return found;
}

bool dalcs_script_asks(const struct dalcs_statements *all) {
    bool found = false;
    for (size_t k = 0; k < all->n && !found; k++) {
        found = all->statement[k].kind == DALCS_STATEMENT_ANALYSIS;
    }
    return found;
}

enum dalcs_status dalcs_script_look(const struct dalcs_session *session, bool *is_there,
                                    enum dalcs_analysis *main) {
    static const struct {
        const char *word;
        enum dalcs_analysis analysis;
    } ranked[] = {{"tran", DALCS_TRANSIENT},
                  {"ac", DALCS_AC},
                  {"dc", DALCS_DC_SWEEP},
                  {"tf", DALCS_TRANSFER},
                  {"op", DALCS_OPERATING_POINT}};

    struct dalcs_statements all = {0};
    size_t best = sizeof ranked / sizeof ranked[0];
    const enum dalcs_status status =
        dalcs_statements_read(&all, session, 0, dalcs_session_n_script_lines(session));
    for (size_t k = 0; k < all.n; k++) {
        for (size_t i = 0; i < best; i++) {
            best = strcmp(all.statement[k].word, ranked[i].word) == 0 ? i : best;
        }
    }
    if (best < sizeof ranked / sizeof ranked[0]) {
        *main = ranked[best].analysis;
    }
    *is_there = all.n > 0;
    dalcs_statements_finish(&all);
    return status;
}

/* statement.c - words, comments and blocks of a .control block. */
#include "statement.h"

#include "lower_case.h"
#include "names.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 50 };

static const struct {
    const char *word;
    enum dalcs_statement_kind kind;
} WORDS[] = {
    {"tran", DALCS_STATEMENT_ANALYSIS},
    {"op", DALCS_STATEMENT_ANALYSIS},
    {"dc", DALCS_STATEMENT_ANALYSIS},
    {"ac", DALCS_STATEMENT_ANALYSIS},
    {"tf", DALCS_STATEMENT_ANALYSIS},
    {"run", DALCS_STATEMENT_ANALYSIS},
    {"meas", DALCS_STATEMENT_MEASURE},
    {"measure", DALCS_STATEMENT_MEASURE},
    {"print", DALCS_STATEMENT_PRINT},
    {"echo", DALCS_STATEMENT_ECHO},
    {"let", DALCS_STATEMENT_LET},
    {"set", DALCS_STATEMENT_SET},
    {"pre_set", DALCS_STATEMENT_SET},
    {"unset", DALCS_STATEMENT_UNSET},
    {"fourier", DALCS_STATEMENT_MEASURE},
    {"unlet", DALCS_STATEMENT_UNLET},
    {"compose", DALCS_STATEMENT_COMPOSE},
    {"cross", DALCS_STATEMENT_CROSS},
    {"define", DALCS_STATEMENT_DEFINE},
    {"undefine", DALCS_STATEMENT_UNDEFINE},
    {"strcmp", DALCS_STATEMENT_STRCMP},
    {"setseed", DALCS_STATEMENT_SETSEED},
    {"setplot", DALCS_STATEMENT_SETPLOT},
    {"destroy", DALCS_STATEMENT_DESTROY},
    {"display", DALCS_STATEMENT_DISPLAY},
    {"setscale", DALCS_STATEMENT_SETSCALE},
    {"settype", DALCS_STATEMENT_SETTYPE},
    {"linearize", DALCS_STATEMENT_LINEARIZE},
    {"fft", DALCS_STATEMENT_FFT},
    {"psd", DALCS_STATEMENT_PSD},
    {"spec", DALCS_STATEMENT_SPEC},
    {"label", DALCS_STATEMENT_LABEL},
    {"goto", DALCS_STATEMENT_GOTO},
    {"rusage", DALCS_STATEMENT_RUSAGE},
    {"remzerovec", DALCS_STATEMENT_NOTHING},
    {"esave", DALCS_STATEMENT_NOTHING},
    {"optran", DALCS_STATEMENT_NOTHING},
    {"setcs", DALCS_STATEMENT_NOTHING},
    {"stop", DALCS_STATEMENT_REFUSED},
    {"step", DALCS_STATEMENT_REFUSED},
    {"resume", DALCS_STATEMENT_REFUSED},
    {"source", DALCS_STATEMENT_REFUSED},
    {"alter", DALCS_STATEMENT_ALTER},
    {"alterparam", DALCS_STATEMENT_ALTER_PARAMETER},
    {"altermod", DALCS_STATEMENT_ALTER_MODEL},
    {"reset", DALCS_STATEMENT_RESET},
    {"save", DALCS_STATEMENT_SAVE},
    {"option", DALCS_STATEMENT_SAVE},
    {"options", DALCS_STATEMENT_SAVE},
    {"wrdata", DALCS_STATEMENT_WRDATA},
    {"write", DALCS_STATEMENT_WRITE},
    {"plot", DALCS_STATEMENT_DRAW},
    {"hardcopy", DALCS_STATEMENT_DRAW},
    {"foreach", DALCS_STATEMENT_FOREACH},
    {"repeat", DALCS_STATEMENT_REPEAT},
    {"while", DALCS_STATEMENT_WHILE},
    {"dowhile", DALCS_STATEMENT_DOWHILE},
    {"if", DALCS_STATEMENT_IF},
    {"else", DALCS_STATEMENT_ELSE},
    {"end", DALCS_STATEMENT_END},
    {"break", DALCS_STATEMENT_BREAK},
    {"continue", DALCS_STATEMENT_CONTINUE},
    {"quit", DALCS_STATEMENT_QUIT},
    {"exit", DALCS_STATEMENT_QUIT},
};

enum { N_WORDS = sizeof WORDS / sizeof WORDS[0] };

/* Commands of ngspice whose job is done elsewhere in dalcs, or not at all. */
static const char *const SKIPPED[] = {
    "gnuplot",  "asciiplot", "iplot",     "remcirc",       "listing",   "noise",   "pz",
    "sens",     "disto",     "sp",        "pss",           "status",    "show",    "showmod",
    "version",  "shell",     "history",   "help",          "alias",     "unalias", "load",
    "edit",     "trace",     "where",     "delete",        "bug",       "cd",      "circbyline",
    "deftype",  "diff",      "dump",      "eprint",        "eprvcd",    "fopen",   "fread",
    "fclose",   "getcwd",    "inventory", "jobs",          "mc_source", "mdump",   "mrdump",
    "rehash",   "reshape",   "rspice",    "setcirc",       "shift",     "snload",  "snsave",
    "state",    "strslice",  "strstr",    "sysinfo",       "tutorial",  "wrnodev", "wrs2p",
    "xgraph",   "aspice",    "codemodel", "devhelp",       "bltplot",   "pause",   "wrspice",
    "cutout",   "pre_osdi",  "cdump",     "pre_codemodel", "rempar",    "setdcop", "print_cirs",
    "use",      "osdi",      "tranop",    "prompt",        "edisplay",  "pyplot",  "pre_set",
    "sndparam", "sndprint",  "transpose"};

/* Why some of them are not done, where a reader would wonder. */
static const struct {
    const char *word, *reason;
} REASON[] = {
    {"shell", "a netlist starts no other programs here: run what follows outside"},
    {"load", "results are read by: dalcs plot FILE, or Python"},
    {"stop", "a run cannot be stopped and continued here: a second tran, or a switch or PWL source "
             "for what changes"},
    {"step", "a run cannot be stopped and continued here: a second tran, or a switch or PWL source "
             "for what changes"},
    {"resume", "a run cannot be stopped and continued here: a second tran, or a switch or PWL "
               "source for what changes"},
    {"source", "a netlist is one file: .include the other one, or run dalcs on it"},
    {"noise", "it is no analysis of circuits with ideal diodes"},
    {"pz", "it is no analysis of circuits with ideal diodes"},
    {"sens", "it is no analysis of circuits with ideal diodes"},
    {"disto", "it is no analysis of circuits with ideal diodes"},
};

static const char *reason_of(const char *word) {
    for (size_t k = 0; k < sizeof REASON / sizeof REASON[0]; k++) {
        if (strcmp(REASON[k].word, word) == 0) {
            return REASON[k].reason;
        }
    }
    return NULL;
}

static bool is_skipped(const char *word) {
    for (size_t k = 0; k < sizeof SKIPPED / sizeof SKIPPED[0]; k++) {
        if (strcmp(SKIPPED[k], word) == 0) {
            return true;
        }
    }
    return false;
}

static enum dalcs_statement_kind kind_of(const char *word) {
    for (size_t k = 0; k < N_WORDS; k++) {
        if (strcmp(WORDS[k].word, word) == 0) {
            return WORDS[k].kind;
        }
    }
    /* A card among commands is unknown to ngspice, which says so and goes on. */
    return word[0] == '.' || is_skipped(word) ? DALCS_STATEMENT_SKIPPED : DALCS_STATEMENT_UNKNOWN;
}

/* Where the text of a line ends: before a `;` or a `$` between blanks, and without blanks behind. */
static size_t length_of(const char *line) {
    size_t n = 0;
    for (bool quoted = false; line[n] != '\0'; n++) {
        quoted = line[n] == '"' ? !quoted : quoted;
        bool starts = n == 0 || line[n - 1] == ' ' || line[n - 1] == '\t';
        bool ends = line[n + 1] == '\0' || line[n + 1] == ' ' || line[n + 1] == '\t';
        if (!quoted && (line[n] == ';' || (line[n] == '$' && starts && ends))) {
            break;
        }
    }
    while (n > 0 && (line[n - 1] == ' ' || line[n - 1] == '\t')) {
        n--;
    }
    return n;
}

static enum dalcs_status add(struct dalcs_statements *s, size_t line, const char *text,
                             size_t begin, size_t end) {
    enum dalcs_status status =
        dalcs_grow(&s->statement, &s->capacity, s->n + 1, sizeof *s->statement);
    if (status != DALCS_OK) {
        return status;
    }
    size_t n = begin + strcspn(text + begin, " \t");
    n = n < end ? n : end;
    char *word = dalcs_arena_copy(&s->arena, text + begin, n - begin);
    size_t rest = n + strspn(text + n, " \t");
    char *tail = dalcs_arena_copy(&s->arena, text + rest, rest < end ? end - rest : 0);
    if (word == NULL || tail == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_lower_text(word);
    s->statement[s->n++] = (struct dalcs_statement){
        .kind = kind_of(word), .line = line, .column = begin + 1, .word = word, .rest = tail};
    return DALCS_OK;
}

static enum dalcs_status read_line(struct dalcs_statements *s, size_t line, const char *text) {
    size_t begin = strspn(text, " \t");
    size_t end = length_of(text);
    if (begin >= end || text[begin] == '*' || text[begin] == '#') {
        return DALCS_OK;
    }
    if (text[begin] == '+' && s->n > 0) {
        struct dalcs_statement *last = &s->statement[s->n - 1];
        last->rest = dalcs_arena_printf(&s->arena, "%s %.*s", last->rest, (int)(end - begin - 1),
                                        text + begin + 1);
        return last->rest != NULL ? DALCS_OK : DALCS_E_NOMEM;
    }
    return add(s, line, text, begin, end);
}

/* All of the script without blanks, lower case. */
static enum dalcs_status squeeze(struct dalcs_statements *s) {
    size_t length = 1;
    for (size_t k = 0; k < s->n; k++) {
        length += strlen(s->statement[k].rest) + 1;
    }
    s->text = dalcs_alloc(length, 1);
    if (s->text == NULL) {
        return DALCS_E_NOMEM;
    }
    size_t n = 0;
    for (size_t k = 0; k < s->n; k++) {
        for (const char *c = s->statement[k].rest; *c != '\0'; c++) {
            if (*c != ' ' && *c != '\t') {
                s->text[n++] = dalcs_lower(*c);
            }
        }
        s->text[n++] = '\n';
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_statements_read(struct dalcs_statements *s,
                                        const struct dalcs_session *session, size_t first,
                                        size_t end) {
    enum dalcs_status status = DALCS_OK;
    for (size_t k = first; k < end && status == DALCS_OK; k++) {
        status = read_line(s, k, dalcs_session_script_line(session, k));
    }
    return status == DALCS_OK ? squeeze(s) : status;
}

/* ---- Checks --------------------------------------------------------------------------------------- */

static void say(struct dalcs_session *session, const struct dalcs_statement *s,
                enum dalcs_level level, const char *hint, const char *text) {
    dalcs_session_script_message(session, s->line, s->column, strlen(s->word), level, hint, text);
}

static void refuse_word(struct dalcs_session *session, const struct dalcs_statement *s) {
    const char *name[N_WORDS];
    char hint[80];
    char text[120];
    for (size_t k = 0; k < N_WORDS; k++) {
        name[k] = WORDS[k].word;
    }
    const char *nearest = dalcs_names_nearest_of(name, N_WORDS, s->word);
    if (nearest == NULL) {
        nearest = dalcs_names_nearest_of(SKIPPED, sizeof SKIPPED / sizeof SKIPPED[0], s->word);
    }
    snprintf(hint, sizeof hint, "did you mean '%s'?", nearest != NULL ? nearest : "");
    snprintf(text, sizeof text, "unknown command '%.60s'", s->word);
    say(session, s, DALCS_LEVEL_ERROR, nearest != NULL ? hint : NULL, text);
}

/* What would be simulated is another thing without it. */
static void refuse_change(struct dalcs_session *session, const struct dalcs_statement *s) {
    char text[120];
    snprintf(text, sizeof text, "'%.60s' is not supported here", s->word);
    say(session, s, DALCS_LEVEL_ERROR, reason_of(s->word), text);
}

/* Each skipped word once. */
static void warn_of_skipped(struct dalcs_session *session, const struct dalcs_statements *all,
                            size_t at) {
    const struct dalcs_statement *s = &all->statement[at];
    char text[120];
    for (size_t k = 0; k < at; k++) {
        if (strcmp(all->statement[k].word, s->word) == 0) {
            return;
        }
    }
    const bool is_card = s->word[0] == '.';
    snprintf(text, sizeof text,
             is_card ? "'%.60s' is a card, not a command: it is skipped, as ngspice does"
                     : "'%.60s' is not supported here and skipped",
             s->word);
    say(session, s, DALCS_LEVEL_WARNING,
        is_card ? "put it outside of the .control block" : reason_of(s->word), text);
}

static bool opens(enum dalcs_statement_kind kind) {
    return kind == DALCS_STATEMENT_FOREACH || kind == DALCS_STATEMENT_REPEAT ||
           kind == DALCS_STATEMENT_WHILE || kind == DALCS_STATEMENT_DOWHILE ||
           kind == DALCS_STATEMENT_IF;
}

enum dalcs_status dalcs_statements_check(struct dalcs_statements *all,
                                         const struct dalcs_script_host *host) {
    struct dalcs_session *session = host->session;
    size_t open[DEEPEST];
    size_t n_open = 0;
    bool failed = false;
    for (size_t k = 0; k < all->n; k++) {
        struct dalcs_statement *s = &all->statement[k];
        const bool is_else = s->kind == DALCS_STATEMENT_ELSE;
        if (host->knows != NULL && host->knows(host->user, s->word)) {
            s->kind = DALCS_STATEMENT_HOST;
        }
        if (s->kind == DALCS_STATEMENT_UNKNOWN) {
            refuse_word(session, s);
            failed = true;
        } else if (s->kind == DALCS_STATEMENT_REFUSED) {
            refuse_change(session, s);
            failed = true;
        } else if (s->kind == DALCS_STATEMENT_SKIPPED) {
            warn_of_skipped(session, all, k);
        } else if (opens(s->kind)) {
            if (n_open == DEEPEST) {
                say(session, s, DALCS_LEVEL_ERROR, NULL, "blocks are nested too deep");
                return DALCS_E_NETLIST;
            }
            open[n_open++] = k;
        } else if (s->kind == DALCS_STATEMENT_END || is_else) {
            const bool fits = n_open > 0 && (!is_else || all->statement[open[n_open - 1]].kind ==
                                                             DALCS_STATEMENT_IF);
            if (!fits) {
                say(session, s, DALCS_LEVEL_ERROR, NULL,
                    is_else ? "'else' without an 'if'" : "'end' without a block");
                failed = true;
                continue;
            }
            all->statement[open[--n_open]].end = k;
            if (is_else) {
                open[n_open++] = k;
            }
        }
    }
    while (n_open > 0) {
        say(session, &all->statement[open[--n_open]], DALCS_LEVEL_ERROR, "add a line: end",
            "this block is never closed");
        failed = true;
    }
    return failed ? DALCS_E_NETLIST : DALCS_OK;
}

bool dalcs_statement_may_be_left_out(const struct dalcs_statement *s) {
    return s->kind == DALCS_STATEMENT_LET || s->kind == DALCS_STATEMENT_PRINT ||
           s->kind == DALCS_STATEMENT_ECHO || s->kind == DALCS_STATEMENT_MEASURE ||
           s->kind == DALCS_STATEMENT_WRDATA || s->kind == DALCS_STATEMENT_WRITE ||
           s->kind == DALCS_STATEMENT_DRAW ||
           (s->kind >= DALCS_STATEMENT_UNLET && s->kind <= DALCS_STATEMENT_SPEC);
}

void dalcs_statements_finish(struct dalcs_statements *s) {
    free(s->statement);
    free(s->text);
    dalcs_arena_finish(&s->arena);
    *s = (struct dalcs_statements){0};
}

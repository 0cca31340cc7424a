/* statement.h - the lines of a .control block as statements. */
#ifndef DALCS_STATEMENT_H
#define DALCS_STATEMENT_H

#include "memory.h"
#include "script.h"

#include <stdbool.h>

enum dalcs_statement_kind {
    DALCS_STATEMENT_ANALYSIS, /* tran, op, dc, ac, run */
    DALCS_STATEMENT_MEASURE,  /* goes with the analysis before it */
    DALCS_STATEMENT_PRINT,
    DALCS_STATEMENT_ECHO,
    DALCS_STATEMENT_LET,
    DALCS_STATEMENT_SET,
    DALCS_STATEMENT_UNSET,
    DALCS_STATEMENT_ALTER,
    DALCS_STATEMENT_ALTER_PARAMETER,
    DALCS_STATEMENT_ALTER_MODEL,
    DALCS_STATEMENT_RESET,
    DALCS_STATEMENT_SAVE, /* save, option: cards of all later runs */
    DALCS_STATEMENT_WRDATA,
    DALCS_STATEMENT_WRITE,
    DALCS_STATEMENT_DRAW, /* plot, hardcopy */
    /* of vectors and plots alone: no later run is another one without them */
    DALCS_STATEMENT_UNLET,
    DALCS_STATEMENT_COMPOSE,
    DALCS_STATEMENT_CROSS,
    DALCS_STATEMENT_DEFINE,
    DALCS_STATEMENT_UNDEFINE,
    DALCS_STATEMENT_STRCMP,
    DALCS_STATEMENT_SETSEED,
    DALCS_STATEMENT_SETPLOT,
    DALCS_STATEMENT_DESTROY,
    DALCS_STATEMENT_DISPLAY,
    DALCS_STATEMENT_SETSCALE,
    DALCS_STATEMENT_SETTYPE,
    DALCS_STATEMENT_LINEARIZE,
    DALCS_STATEMENT_FFT,
    DALCS_STATEMENT_PSD,
    DALCS_STATEMENT_SPEC,
    DALCS_STATEMENT_RUSAGE,
    DALCS_STATEMENT_NOTHING, /* of ngspice's own ways: there is nothing to do here */
    DALCS_STATEMENT_LABEL,
    DALCS_STATEMENT_GOTO,
    DALCS_STATEMENT_REFUSED, /* known, not done here, and a run would be another one without it */
    DALCS_STATEMENT_FOREACH,
    DALCS_STATEMENT_REPEAT,
    DALCS_STATEMENT_WHILE,
    DALCS_STATEMENT_DOWHILE, /* once whatever its formula says */
    DALCS_STATEMENT_IF,
    DALCS_STATEMENT_ELSE,
    DALCS_STATEMENT_END,
    DALCS_STATEMENT_BREAK,
    DALCS_STATEMENT_CONTINUE,
    DALCS_STATEMENT_QUIT,
    DALCS_STATEMENT_HOST,    /* the host does it */
    DALCS_STATEMENT_SKIPPED, /* known, but not done here */
    DALCS_STATEMENT_UNKNOWN
};

struct dalcs_statement {
    enum dalcs_statement_kind kind;
    size_t line;      /* of the script */
    size_t column;    /* of the word, from 1 */
    const char *word; /* lower case */
    const char *rest; /* what follows it, as written, continuation lines joined */
    size_t end; /* of a block: the statement of its end; of if: of its else, if there is one */
    bool is_reported; /* what is wrong with it was said: a loop comes by again */
};

struct dalcs_statements {
    struct dalcs_statement *statement; /* heap */
    size_t n, capacity;
    char *text; /* all of it, lower case without blanks; heap */
    struct dalcs_arena arena;
};

/* The session's lines `first` to `end` - 1. Zero-initialise. Touches no message. */
enum dalcs_status dalcs_statements_read(struct dalcs_statements *statements,
                                        const struct dalcs_session *session, size_t first,
                                        size_t end) DALCS_MUST_CHECK;

/* Matches blocks with their ends, leaves to the host its own commands; errors and warnings go to its session.
 * DALCS_E_NETLIST: there were errors. */
enum dalcs_status dalcs_statements_check(struct dalcs_statements *statements,
                                         const struct dalcs_script_host *host) DALCS_MUST_CHECK;

/* Can the script go on without this statement? What says, shows and measures changes no later run. */
bool dalcs_statement_may_be_left_out(const struct dalcs_statement *statement);

void dalcs_statements_finish(struct dalcs_statements *statements);

#endif

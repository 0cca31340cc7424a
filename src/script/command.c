/* command.c - which function executes a statement that is no block. */
#include "script_internal.h"

#include <stdio.h>
#include <string.h>

/* Announces the next command to the host. */
static enum dalcs_status tell(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *rest;
    if (script->host->heard == NULL) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_script_expand(script, s, &rest));
    return script->host->heard(script->host->user, s->word, rest);
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
           s->kind == DALCS_STATEMENT_SAVE || s->kind == DALCS_STATEMENT_SET ||
           s->kind == DALCS_STATEMENT_LINEARIZE || s->kind == DALCS_STATEMENT_FFT ||
           s->kind == DALCS_STATEMENT_PSD || s->kind == DALCS_STATEMENT_SPEC;
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

/* What the last run took. */
static enum dalcs_status rusage(struct dalcs_script *script, const struct dalcs_statement *s) {
    const struct dalcs_report *report = dalcs_session_report(script->host->session);
    (void)s;
    if (report != NULL) {
        fprintf(script->host->out, "Last run: %ld steps, %.6g s\n", report->work.steps,
                report->work.wall_s);
    }
    return DALCS_OK;
}

static const struct {
    enum dalcs_statement_kind kind;
    enum dalcs_status (*of)(struct dalcs_script *script, const struct dalcs_statement *s);
} FUNCTION[] = {{DALCS_STATEMENT_PRINT, dalcs_script_print},
                {DALCS_STATEMENT_ECHO, dalcs_script_echo},
                {DALCS_STATEMENT_RUSAGE, rusage},
                {DALCS_STATEMENT_LET, dalcs_script_let},
                {DALCS_STATEMENT_UNLET, dalcs_script_unlet},
                {DALCS_STATEMENT_COMPOSE, dalcs_script_compose},
                {DALCS_STATEMENT_CROSS, dalcs_script_cross},
                {DALCS_STATEMENT_DEFINE, dalcs_script_define},
                {DALCS_STATEMENT_UNDEFINE, dalcs_script_undefine},
                {DALCS_STATEMENT_SET, dalcs_script_set},
                {DALCS_STATEMENT_UNSET, dalcs_script_unset},
                {DALCS_STATEMENT_STRCMP, dalcs_script_strcmp},
                {DALCS_STATEMENT_SETSEED, dalcs_script_setseed},
                {DALCS_STATEMENT_ALTER, dalcs_script_alter},
                {DALCS_STATEMENT_ALTER_PARAMETER, dalcs_script_alter},
                {DALCS_STATEMENT_ALTER_MODEL, dalcs_script_alter},
                {DALCS_STATEMENT_SAVE, dalcs_script_save},
                {DALCS_STATEMENT_DRAW, dalcs_script_draw},
                {DALCS_STATEMENT_WRDATA, dalcs_script_write},
                {DALCS_STATEMENT_WRITE, dalcs_script_write},
                {DALCS_STATEMENT_SETPLOT, dalcs_script_setplot},
                {DALCS_STATEMENT_DESTROY, dalcs_script_destroy},
                {DALCS_STATEMENT_DISPLAY, dalcs_script_display},
                {DALCS_STATEMENT_SETSCALE, dalcs_script_setscale},
                {DALCS_STATEMENT_SETTYPE, dalcs_script_settype},
                {DALCS_STATEMENT_LINEARIZE, dalcs_script_linearize},
                {DALCS_STATEMENT_FFT, dalcs_script_fft},
                {DALCS_STATEMENT_PSD, dalcs_script_fft},
                {DALCS_STATEMENT_SPEC, dalcs_script_fft}};

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
        return dalcs_script_run_analysis(script, index);
    case DALCS_STATEMENT_RESET:
        dalcs_session_reset(script->host->session);
        return DALCS_OK;
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
    case DALCS_STATEMENT_GOTO:
        script->jump.label = s->rest;
        script->jump.from = s;
        return ++script->jump.n <= DALCS_MOST_ROUNDS
                   ? DALCS_OK
                   : dalcs_script_refuse(script, s, NULL, "goto was done %d times",
                                         (int)DALCS_MOST_ROUNDS);
    case DALCS_STATEMENT_QUIT:
        script->quits = true;
        return DALCS_OK;
    default: /* skipped, or done with the analysis before */
        break;
    }
    for (size_t k = 0; k < sizeof FUNCTION / sizeof FUNCTION[0]; k++) {
        if (FUNCTION[k].kind == s->kind) {
            return FUNCTION[k].of(script, s);
        }
    }
    return DALCS_OK;
}

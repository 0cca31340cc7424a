/* script.c - blocks and loops.
 *
 * dalcs_script_run at the end is the table of contents. */
#include "script_internal.h"

#include "lower_case.h"

#include <stdlib.h>
#include <string.h>

static enum dalcs_status execute(struct dalcs_script *script, size_t begin, size_t end);

/* The body of a loop once; *stops: it is over. */
static enum dalcs_status execute_body(struct dalcs_script *script, size_t loop, bool *stops) {
    const struct dalcs_statement *s = &script->statements.statement[loop];
    const enum dalcs_status status = execute(script, loop + 1, s->end);
    *stops = script->breaks || script->quits || script->jump.label != NULL;
    script->breaks = script->continues = false;
    return status;
}

static enum dalcs_status execute_foreach(struct dalcs_script *script, size_t loop) {
    const struct dalcs_statement *s = &script->statements.statement[loop];
    struct dalcs_arena arena = {0}; /* lives longer than the statements of the body */
    const char *text;
    bool stops = false;
    enum dalcs_status status = dalcs_script_expand(script, s, &text);
    const char *list = status == DALCS_OK ? dalcs_arena_copy(&arena, text, strlen(text)) : NULL;
    const char *word = list != NULL ? dalcs_script_word(script, &list) : NULL;
    const char *name = word != NULL ? dalcs_arena_copy(&arena, word, strlen(word)) : NULL;
    if (status == DALCS_OK && name == NULL) {
        status = dalcs_script_refuse(script, s, "foreach name value value ...",
                                     "the name of the variable is missing");
    }
    while (status == DALCS_OK && !stops && (word = dalcs_script_word(script, &list)) != NULL) {
        if (strcmp(word, "(") == 0 || strcmp(word, ")") == 0) {
            continue;
        }
        status = dalcs_variables_set(&script->variables, name, word);
        if (status == DALCS_OK) {
            status = execute_body(script, loop, &stops);
        }
    }
    dalcs_arena_finish(&arena);
    return status;
}

static enum dalcs_status refuse_endless(struct dalcs_script *script,
                                        const struct dalcs_statement *s) {
    return dalcs_script_refuse(script, s, NULL, "this loop has run %d times",
                               (int)DALCS_MOST_ROUNDS);
}

static enum dalcs_status execute_repeat(struct dalcs_script *script, size_t loop) {
    const struct dalcs_statement *s = &script->statements.statement[loop];
    const char *text;
    double n = DALCS_MOST_ROUNDS + 1.0; /* without a number: until break */
    bool stops = false;
    enum dalcs_status status = dalcs_script_expand_low(script, s, &text);
    if (status == DALCS_OK && text[0] != '\0') {
        status = dalcs_script_number(script, s, text, &n);
    }
    for (long k = 0; status == DALCS_OK && (double)k < n && !stops; k++) {
        status =
            k < DALCS_MOST_ROUNDS ? execute_body(script, loop, &stops) : refuse_endless(script, s);
    }
    return status;
}

static enum dalcs_status holds(struct dalcs_script *script, const struct dalcs_statement *s,
                               bool *yes) {
    const char *text;
    double value = 0.0;
    enum dalcs_status status = dalcs_script_expand_low(script, s, &text);
    if (status == DALCS_OK) {
        status = dalcs_script_number(script, s, text, &value);
    }
    *yes = value != 0.0;
    return status;
}

static enum dalcs_status execute_while(struct dalcs_script *script, size_t loop) {
    const struct dalcs_statement *s = &script->statements.statement[loop];
    bool stops = false;
    bool yes = true;
    enum dalcs_status status = s->kind == DALCS_STATEMENT_WHILE ? holds(script, s, &yes) : DALCS_OK;
    for (long k = 0; status == DALCS_OK && yes && !stops; k++) {
        status =
            k < DALCS_MOST_ROUNDS ? execute_body(script, loop, &stops) : refuse_endless(script, s);
        if (status == DALCS_OK && !stops) {
            status = holds(script, s, &yes);
        }
    }
    return status;
}

/* The statement behind the last of an if and its else. */
static size_t end_of(const struct dalcs_statements *all, size_t k) {
    size_t end = all->statement[k].end;
    return all->statement[end].kind == DALCS_STATEMENT_ELSE ? all->statement[end].end : end;
}

static enum dalcs_status execute_if(struct dalcs_script *script, size_t k) {
    const struct dalcs_statements *all = &script->statements;
    const struct dalcs_statement *s = &all->statement[k];
    bool yes;
    const enum dalcs_status status = holds(script, s, &yes);
    if (status != DALCS_OK) {
        return status;
    }
    if (yes) {
        return execute(script, k + 1, s->end);
    }
    const bool has_else = all->statement[s->end].kind == DALCS_STATEMENT_ELSE;
    return has_else ? execute(script, s->end + 1, end_of(all, k)) : DALCS_OK;
}

/* The statement in front of the label that is gone to, in this block; end: it is not here. */
static size_t find_label(const struct dalcs_script *script, size_t begin, size_t end) {
    const struct dalcs_statements *all = &script->statements;
    for (size_t k = begin; k < end; k++) {
        const struct dalcs_statement *s = &all->statement[k];
        if (s->kind == DALCS_STATEMENT_LABEL && strcmp(s->rest, script->jump.label) == 0) {
            return k;
        }
        k = s->end > k ? end_of(all, k) : k; /* not into a block */
    }
    return end;
}

static enum dalcs_status execute(struct dalcs_script *script, size_t begin, size_t end) {
    const struct dalcs_statements *all = &script->statements;
    enum dalcs_status status = DALCS_OK;
    for (size_t k = begin; k < end && status == DALCS_OK; k++) {
        if (script->jump.label != NULL) {
            k = find_label(script, begin, end);
            if (k == end) {
                return DALCS_OK; /* the block around this one may have it */
            }
            script->jump.label = NULL;
            continue;
        }
        if (script->quits || script->breaks || script->continues) {
            return DALCS_OK;
        }
        switch (all->statement[k].kind) {
        case DALCS_STATEMENT_FOREACH:
            status = execute_foreach(script, k);
            k = all->statement[k].end;
            break;
        case DALCS_STATEMENT_REPEAT:
            status = execute_repeat(script, k);
            k = all->statement[k].end;
            break;
        case DALCS_STATEMENT_WHILE:
        case DALCS_STATEMENT_DOWHILE:
            status = execute_while(script, k);
            k = all->statement[k].end;
            break;
        case DALCS_STATEMENT_IF:
            status = execute_if(script, k);
            k = end_of(all, k);
            break;
        default:
            status = dalcs_script_command(script, k);
            if (status == DALCS_E_NETLIST && !script->host->is_strict &&
                dalcs_statement_may_be_left_out(&all->statement[k])) {
                status = DALCS_OK; /* as in ngspice; a warning has told */
            }
            dalcs_arena_finish(&script->arena);
            break;
        }
        if (script->jump.label != NULL && k + 1 >= end) {
            k = begin - 1; /* the label may stand before this, the last statement */
        }
    }
    return status;
}

static bool has_analysis(const struct dalcs_session *session) {
    const struct dalcs_request asked = dalcs_session_request(session);
    return asked.operating_point || asked.transient || asked.dc_sweep || asked.ac || asked.transfer;
}

enum dalcs_status dalcs_script_open(struct dalcs_script **script,
                                    const struct dalcs_script_host *host) {
    *script = dalcs_alloc(1, sizeof **script);
    if (*script == NULL) {
        return DALCS_E_NOMEM;
    }
    (*script)->host = host;
    return DALCS_OK;
}

enum dalcs_status dalcs_script_read(struct dalcs_script *script, size_t first, size_t end) {
    const struct dalcs_script_host *host = script->host;
    dalcs_statements_finish(&script->statements);
    script->has_run = script->quits = script->breaks = script->continues = false;
    script->has_cards = has_analysis(host->session);
    script->vectors.session = host->session;
    script->vectors.random = &script->random;
    if (!script->is_seeded) {
        dalcs_script_seed(script, dalcs_session_seed(host->session));
    }
    DALCS_TRY(dalcs_statements_read(&script->statements, host->session, first, end));
    script->vectors.text = script->statements.text;
    script->vectors.keeps_all = dalcs_script_keeps_all(&script->statements);
    script->vectors.keeps_plots = dalcs_script_keeps_plots(&script->statements);
    return dalcs_statements_check(&script->statements, host);
}

struct dalcs_vectors *dalcs_script_vectors_of(struct dalcs_script *script) {
    return &script->vectors;
}

const char *dalcs_script_variable(const struct dalcs_script *script, const char *name) {
    return dalcs_variables_get(&script->variables, name);
}

enum dalcs_status dalcs_script_execute(struct dalcs_script *script, bool *quits) {
    enum dalcs_status status = execute(script, 0, script->statements.n);
    if (status == DALCS_OK && script->jump.label != NULL) {
        status = dalcs_script_refuse(script, script->jump.from, "label name",
                                     "there is no label '%s' around this", script->jump.label);
    }
    script->jump.label = NULL;
    if (quits != NULL) {
        *quits = script->quits;
    }
    dalcs_arena_finish(&script->arena);
    return status;
}

void dalcs_script_change_circuit(struct dalcs_script *script) {
    script->n_cards = 0;
    dalcs_arena_finish(&script->kept);
}

void dalcs_script_close(struct dalcs_script *script) {
    if (script == NULL) {
        return;
    }
    dalcs_arena_finish(&script->arena);
    dalcs_arena_finish(&script->kept);
    dalcs_vectors_finish(&script->vectors);
    dalcs_variables_finish(&script->variables);
    dalcs_definitions_finish(&script->definitions);
    dalcs_statements_finish(&script->statements);
    free(script->card);
    free(script);
}

static enum dalcs_status set_before(struct dalcs_script *script) {
    for (size_t k = 0; k < script->host->n_set; k++) {
        const char *text = script->host->set[k];
        char *own = dalcs_arena_copy(&script->arena, text, strlen(text));
        if (own == NULL) {
            return DALCS_E_NOMEM;
        }
        const struct dalcs_assignment given = dalcs_variables_split(own);
        DALCS_TRY(
            dalcs_variables_set(&script->variables, dalcs_lower_text(given.name), given.value));
    }
    dalcs_arena_finish(&script->arena);
    return DALCS_OK;
}

enum dalcs_status dalcs_script_run(const struct dalcs_script_host *host) {
    struct dalcs_script *script;
    DALCS_TRY(dalcs_script_open(&script, host));
    enum dalcs_status status = set_before(script);
    if (status == DALCS_OK) {
        status = dalcs_script_read(script, 0, dalcs_session_n_script_lines(host->session));
    }
    if (status == DALCS_OK && !dalcs_script_asks(&script->statements)) {
        status = dalcs_script_run_cards(script);
    }
    if (status == DALCS_OK) {
        status = dalcs_script_execute(script, NULL);
    }
    dalcs_script_close(script);
    return status;
}

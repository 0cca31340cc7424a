/* set_command.c - variables and what is said: set, unset, strcmp, echo; the seed of random values. */
#include "congruential.h"
#include "lower_case.h"
#include "script_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* `set` alone, as ngspice answers it. */
static void list_variables(const struct dalcs_script *script) {
    const struct dalcs_variables *all = &script->variables;
    for (size_t k = 0; k < all->n; k++) {
        fprintf(script->host->out, "%s\t%s\n", all->variable[k].name, all->variable[k].value);
    }
}

/* ---- The seed of random values ------------------------------------------------------------------- */

/* Two steps of the generator, for seeds side by side. */
void dalcs_script_seed(struct dalcs_script *script, double seed) {
    script->random = (uint64_t)seed;
    (void)dalcs_congruential_next(&script->random);
    (void)dalcs_congruential_next(&script->random);
    script->is_seeded = true;
}

static enum dalcs_status seed_by(struct dalcs_script *script, const struct dalcs_statement *s,
                                 const char *text) {
    double seed;
    DALCS_TRY(dalcs_script_number(script, s, text, &seed));
    if (!(seed >= 0.0 && seed <= 0x1p53) || seed != floor(seed)) {
        return dalcs_script_refuse(script, s, "setseed 7",
                                   "a seed is a whole number from 0 to 2^53");
    }
    dalcs_script_seed(script, seed);
    return DALCS_OK;
}

/* setseed n; alone it begins the row anew. */
enum dalcs_status dalcs_script_setseed(struct dalcs_script *script,
                                       const struct dalcs_statement *s) {
    const char *text;
    DALCS_TRY(dalcs_script_expand_low(script, s, &text));
    if (text[strspn(text, " \t")] != '\0') {
        return seed_by(script, s, text);
    }
    dalcs_script_seed(script, dalcs_session_seed(script->host->session));
    return DALCS_OK;
}

/* ---- The unit of angles -------------------------------------------------------------------------- */

bool dalcs_script_has_degrees(const struct dalcs_statement *s, bool had) {
    const char *rest = s->rest + strspn(s->rest, " \t");
    const size_t n = strcspn(rest, " \t=");
    char word[8] = "";
    if (n != strlen("units") || strncmp(rest, "units", n) != 0) {
        return had;
    }
    rest += n + strspn(rest + n, " \t=\"'");
    for (size_t k = 0; k + 1 < sizeof word && rest[k] != '\0'; k++) {
        word[k] = dalcs_lower(rest[k]);
    }
    return s->kind == DALCS_STATEMENT_SET && strcmp(word, "degrees") == 0;
}

/* ---- Variables ------------------------------------------------------------------------------------ */

/* "name", "name = value", "name = ( a b c )". */
enum dalcs_status dalcs_script_set(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *text;
    enum dalcs_status status = dalcs_script_expand(script, s, &text);
    if (status != DALCS_OK) {
        return status;
    }
    script->vectors.in_degrees = dalcs_script_has_degrees(s, script->vectors.in_degrees);
    char *own = dalcs_arena_copy(&script->arena, text, strlen(text));
    if (own == NULL) {
        return DALCS_E_NOMEM;
    }
    const struct dalcs_assignment given = dalcs_variables_split(own);
    if (given.name[0] == '\0' && strchr(text, '=') == NULL) {
        list_variables(script);
        return DALCS_OK;
    }
    if (given.name[0] == '\0') {
        return dalcs_script_refuse(script, s, "set name=value", "a name is missing");
    }
    const char *name;
    struct dalcs_statement lower = {.rest = given.name, .line = s->line, .column = s->column};
    status = dalcs_script_expand_low(script, &lower, &name);
    if (status != DALCS_OK) {
        return status;
    }
    const struct dalcs_script_host *host = script->host;
    if (strcmp(name, "rndseed") == 0) {
        return seed_by(script, s, given.value);
    }
    if (strcmp(name, "curplot") != 0) {
        return dalcs_variables_set(&script->variables, name, given.value);
    }
    const bool is_of_host = host->knows != NULL && host->knows(host->user, "setplot");
    return is_of_host ? DALCS_OK : dalcs_script_choose_plot(script, s, given.value);
}

enum dalcs_status dalcs_script_unset(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *text;
    enum dalcs_status status = dalcs_script_expand_low(script, s, &text);
    script->vectors.in_degrees = dalcs_script_has_degrees(s, script->vectors.in_degrees);
    for (const char *name;
         status == DALCS_OK && (name = dalcs_script_word(script, &text)) != NULL;) {
        dalcs_variables_unset(&script->variables, name);
    }
    return status;
}

/* strcmp name a b: the variable becomes 0 where both texts are the same, else -1 or 1. */
enum dalcs_status dalcs_script_strcmp(struct dalcs_script *script,
                                      const struct dalcs_statement *s) {
    const char *text;
    DALCS_TRY(dalcs_script_expand(script, s, &text));
    const char *name = dalcs_script_word(script, &text);
    const char *a = name != NULL ? dalcs_script_word(script, &text) : NULL;
    const char *b = a != NULL ? dalcs_script_word(script, &text) : NULL;
    if (b == NULL) {
        return dalcs_script_refuse(script, s, "strcmp same $curplot tran1",
                                   "a name and two texts are missing");
    }
    char *low = dalcs_arena_copy(&script->arena, name, strlen(name));
    const int order = strcmp(a, b);
    return low == NULL ? DALCS_E_NOMEM
                       : dalcs_variables_set(&script->variables, dalcs_lower_text(low),
                                             order < 0   ? "-1"
                                             : order > 0 ? "1"
                                                         : "0");
}

/* echo text, echo -n text; `> file` and `>> file`. */
enum dalcs_status dalcs_script_echo(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *text;
    struct dalcs_redirection to;
    DALCS_TRY(dalcs_script_expand(script, s, &text));
    const bool goes_on = strncmp(text, "-n", 2) == 0 && strchr(" \t", text[2]) != NULL;
    text += goes_on ? 2 + strspn(text + 2, " \t") : 0;
    char *line = dalcs_arena_copy(&script->arena, text, strlen(text));
    if (line == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_redirection_find(&to, script, line));
    size_t n = strlen(line);
    while (to.path != NULL && n > 0 && (line[n - 1] == ' ' || line[n - 1] == '\t')) {
        line[--n] = '\0';
    }
    DALCS_TRY(dalcs_redirection_open(&to, script, s));
    for (const char *c = line; *c != '\0'; c++) {
        if (*c != '"') {
            fputc(*c, to.file);
        }
    }
    if (!goes_on) {
        fputc('\n', to.file);
    }
    return dalcs_redirection_close(&to, script, s);
}

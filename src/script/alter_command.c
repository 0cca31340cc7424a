/* alter_command.c - alter, altermod and alterparam: other values for later runs. */
#include "script_internal.h"

#include <stdio.h>
#include <string.h>

/* The field of an element that is its value. */
static bool is_value_field(const char *field) {
    static const char *const known[] = {"dc",         "r",    "c",     "l",          "resistance",
                                        "inductance", "gain", "value", "capacitance"};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        if (strcmp(known[k], field) == 0) {
            return true;
        }
    }
    return false;
}

/* The function of a V or I, or what it is in .ac. */
static bool is_waveform(const char *field) {
    static const char *const known[] = {"pulse", "sin", "exp",   "pwl",    "sffm",
                                        "am",    "ac",  "acmag", "acphase"};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        if (strcmp(known[k], field) == 0) {
            return true;
        }
    }
    return false;
}

/* What stands before the value: with an equal sign all before it, else the name and, of a model or where it is one,
 * the field: "alter r1 2k", "alter v1 dc 5", "altermod d1 ron 1m". */
static const char *split_left(struct dalcs_script *script, const struct dalcs_statement *s,
                              const char *text, const char **value) {
    const char *equal = strchr(text, '=');
    if (equal != NULL) {
        *value = equal + 1;
        return dalcs_arena_copy(&script->arena, text, (size_t)(equal - text));
    }
    const char *rest = text;
    const char *name = dalcs_script_word(script, &rest);
    const char *behind = rest;
    const char *field = dalcs_script_word(script, &rest);
    const bool has_field =
        field != NULL &&
        (s->kind == DALCS_STATEMENT_ALTER_MODEL ||
         (s->kind == DALCS_STATEMENT_ALTER && (is_value_field(field) || is_waveform(field))));
    *value = has_field ? rest : behind;
    *value += strspn(*value, " \t");
    return name != NULL ? dalcs_arena_copy(&script->arena, text, (size_t)(*value - text)) : NULL;
}

/* "name = formula", "name field = formula", "@name[field] = formula"; *value: the text of the formula. */
static enum dalcs_status split_alter(struct dalcs_script *script, const struct dalcs_statement *s,
                                     const char **name, const char **field, const char **value) {
    const char *text;
    enum dalcs_status status = dalcs_script_expand_low(script, s, &text);
    if (status != DALCS_OK) {
        return status;
    }
    const char *number;
    const char *left = split_left(script, s, text, &number);
    if (left == NULL || *number == '\0') {
        return dalcs_script_refuse(script, s,
                                   "alter r1 = 5k; altermod dmod vfwd = 0.7; "
                                   "alterparam rload = 10",
                                   "a name and its new value are missing");
    }
    *name = dalcs_script_word(script, &left);
    *field = dalcs_script_word(script, &left);
    const char *bracket = *name != NULL && (*name)[0] == '@' ? strchr(*name, '[') : NULL;
    if (bracket != NULL) {
        const size_t n = strcspn(bracket + 1, "]");
        *field = dalcs_arena_copy(&script->arena, bracket + 1, n);
        *name = dalcs_arena_copy(&script->arena, *name + 1, (size_t)(bracket - *name - 1));
    } else if (*name != NULL && (*name)[0] == '@') {
        ++*name; /* as KiCad's tuner writes it */
    }
    if (*name == NULL) {
        return dalcs_script_refuse(script, s, NULL, "a name before '=' is missing");
    }
    *value = number;
    return DALCS_OK;
}

static enum dalcs_status refuse_name(struct dalcs_script *script, const struct dalcs_statement *s,
                                     const char *what, const char *name, const char *nearest) {
    char hint[120];
    snprintf(hint, sizeof hint, "did you mean '%.80s'?", nearest != NULL ? nearest : "");
    return dalcs_script_refuse(script, s, nearest != NULL ? hint : NULL, "there is no %s '%s'",
                               what, name);
}

/* alter @v1[pulse] = [ 0 5 0 1n 1n 5u 10u ] */
static enum dalcs_status alter_waveform(struct dalcs_script *script,
                                        const struct dalcs_statement *s, const char *name,
                                        const char *function, const char *text) {
    char *list = dalcs_arena_copy(&script->arena, text, strlen(text));
    double *value = dalcs_arena_alloc(&script->arena, strlen(text) + 1, sizeof *value);
    const char *nearest = NULL;
    size_t n = 0;
    if (list == NULL || value == NULL) {
        return DALCS_E_NOMEM;
    }
    for (char *c = list; *c != '\0'; c++) {
        *c = strchr("[]()", *c) != NULL ? ' ' : *c;
    }
    const char *rest = list;
    for (const char *word; (word = dalcs_script_word(script, &rest)) != NULL;) {
        DALCS_TRY(dalcs_script_number(script, s, word, &value[n++]));
    }
    if (n == 0) {
        return dalcs_script_refuse(script, s, "alter @v1[pulse] = [ 0 5 0 1n 1n 5u 10u ]",
                                   "the values of %s are missing", function);
    }
    const enum dalcs_status status =
        dalcs_session_alter_waveform(script->host->session, name, function, value, n, &nearest);
    return status == DALCS_E_OPTION ? refuse_name(script, s, "V or I", name, nearest) : status;
}

enum dalcs_status dalcs_script_alter(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *name = NULL;
    const char *field = NULL;
    const char *nearest = NULL;
    const char *text = "";
    double value;
    const bool is_parameter = s->kind == DALCS_STATEMENT_ALTER_PARAMETER;
    DALCS_TRY(split_alter(script, s, &name, &field, &text));
    const bool is_model = s->kind == DALCS_STATEMENT_ALTER_MODEL;
    if (is_model && field == NULL) {
        return dalcs_script_refuse(script, s, "altermod dmod vfwd = 0.7",
                                   "the parameter of the model is missing");
    }
    if (s->kind == DALCS_STATEMENT_ALTER && field != NULL && is_waveform(field)) {
        return alter_waveform(script, s, name, field, text);
    }
    if (!is_model && field != NULL && !is_value_field(field)) {
        return dalcs_script_refuse(script, s, "write alter name = value",
                                   "'%s' of an element cannot be altered here", field);
    }
    DALCS_TRY(dalcs_script_number(script, s, text, &value));
    const enum dalcs_status status = dalcs_session_alter(script->host->session, is_parameter, name,
                                                         is_model ? field : NULL, value, &nearest);
    const char *what = is_parameter ? "parameter" : is_model ? "model" : "element";
    return status == DALCS_E_OPTION ? refuse_name(script, s, what, name, nearest) : status;
}

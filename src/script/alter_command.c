/* alter_command.c - alter, altermod and alterparam: other values for later runs. */
#include "script_internal.h"

#include <stdlib.h>
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
        field != NULL && (s->kind == DALCS_STATEMENT_ALTER_MODEL ||
                          (s->kind == DALCS_STATEMENT_ALTER && is_value_field(field)));
    *value = has_field ? rest : behind;
    *value += strspn(*value, " \t");
    return name != NULL ? dalcs_arena_copy(&script->arena, text, (size_t)(*value - text)) : NULL;
}

/* "name = formula", "name field = formula", "@name[field] = formula". */
static enum dalcs_status split_alter(struct dalcs_script *script, const struct dalcs_statement *s,
                                     const char **name, const char **field, double *value) {
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
    return dalcs_script_number(script, s, number, value);
}

enum dalcs_status dalcs_script_alter(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *name = NULL;
    const char *field = NULL;
    const char *nearest = NULL;
    char hint[120];
    double value;
    const bool is_parameter = s->kind == DALCS_STATEMENT_ALTER_PARAMETER;
    enum dalcs_status status = split_alter(script, s, &name, &field, &value);
    if (status != DALCS_OK) {
        return status;
    }
    const bool is_model = s->kind == DALCS_STATEMENT_ALTER_MODEL;
    if (is_model && field == NULL) {
        return dalcs_script_refuse(script, s, "altermod dmod vfwd = 0.7",
                                   "the parameter of the model is missing");
    }
    if (!is_model && field != NULL && !is_value_field(field)) {
        return dalcs_script_refuse(script, s, "write alter name = value",
                                   "'%s' of an element cannot be altered here", field);
    }
    status = dalcs_session_alter(script->host->session, is_parameter, name, is_model ? field : NULL,
                                 value, &nearest);
    if (status == DALCS_E_OPTION) {
        snprintf(hint, sizeof hint, "did you mean '%.80s'?", nearest != NULL ? nearest : "");
        return dalcs_script_refuse(script, s, nearest != NULL ? hint : NULL, "there is no %s '%s'",
                                   is_parameter ? "parameter"
                                   : is_model   ? "model"
                                                : "element",
                                   name);
    }
    return status;
}

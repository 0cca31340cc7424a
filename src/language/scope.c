/* scope.c - instances of definitions: which parameters they have, and their values.
 *
 * The values of a scope are found in the order of the text. A parameter that needs another one waits
 * for it on a list, not by recursion; one that waits for itself is an error. */
#include "language.h"

#include <string.h>

/* ---- Finding names --------------------------------------------------------------------------- */

bool dalcs_scope_is_active(const struct dalcs_scope *scope, int item) {
    return scope->active == NULL || scope->active[item];
}

struct dalcs_value *dalcs_scope_find_value(struct dalcs_scope *scope, const char *name) {
    for (struct dalcs_scope *s = scope; s != NULL; s = s->caller) {
        const int slot = dalcs_names_find(&s->definition->parameters.names, name);
        if (slot >= 0 && s->value[slot].token != NULL) {
            return &s->value[slot];
        }
        for (int k = 0; k < s->n_extra; k++) {
            if (strcmp(s->extra[k].name->text, name) == 0) {
                return &s->extra[k];
            }
        }
    }
    return NULL;
}

struct dalcs_value *dalcs_scope_find_given(struct dalcs_scope *scope, const char *name) {
    const int slot = dalcs_names_find(&scope->definition->parameters.names, name);
    if (slot >= 0) {
        return scope->value[slot].is_given ? &scope->value[slot] : NULL;
    }
    struct dalcs_value *found = NULL;
    for (int k = 0; k < scope->n_extra && found == NULL; k++) {
        found = strcmp(scope->extra[k].name->text, name) == 0 ? &scope->extra[k] : NULL;
    }
    return found;
}

struct dalcs_user_function *dalcs_scope_find_function(struct dalcs_scope *scope, const char *name) {
    for (struct dalcs_scope *s = scope; s != NULL; s = s->caller) {
        const int first = dalcs_names_find(&s->definition->functions.names, name);
        struct dalcs_user_function *f =
            first >= 0 ? s->definition->functions.function[first] : NULL;
        while (f != NULL && !dalcs_scope_is_active(s, f->item)) {
            f = f->other;
        }
        if (f != NULL) {
            return f;
        }
    }
    return NULL;
}

struct dalcs_definition *dalcs_scope_find_subcircuit(struct dalcs_scope *scope, const char *name,
                                                     struct dalcs_scope **owner) {
    for (struct dalcs_scope *s = scope; s != NULL; s = s->enclosing) {
        const int first = dalcs_names_find(&s->definition->subcircuits, name);
        struct dalcs_definition *d = first >= 0 ? s->definition->inner[first] : NULL;
        while (d != NULL && !dalcs_scope_is_active(s, d->place)) {
            d = d->other;
        }
        if (d != NULL) {
            *owner = s;
            return d;
        }
    }
    return NULL;
}

/* ---- Making one ------------------------------------------------------------------------------ */

static void declare(struct dalcs_language *language, struct dalcs_scope *scope,
                    struct dalcs_assignment *assignment) {
    struct dalcs_value *value = &scope->value[assignment->slot];
    if (value->is_given) {
        return;
    }
    if (value->state != DALCS_VALUE_UNKNOWN) {
        dalcs_language_report(language, DALCS_ERROR, scope, assignment->name,
                              "set it in every branch, and nowhere else",
                              "'%s' is set here after a condition has used its other value",
                              assignment->name->text);
        return;
    }
    value->name = assignment->name;
    value->token = assignment->value;
    value->n_tokens = assignment->n_tokens;
    value->expression = &assignment->expression;
    value->where = scope;
}

struct dalcs_scope *dalcs_scope_make(struct dalcs_language *language,
                                     struct dalcs_definition *definition,
                                     struct dalcs_scope *caller, struct dalcs_scope *enclosing) {
    struct dalcs_arena *arena = language->arena;
    struct dalcs_scope *scope = dalcs_arena_alloc(arena, 1, sizeof *scope);
    struct dalcs_value *value =
        dalcs_arena_alloc(arena, (size_t)definition->parameters.n_slots, sizeof *value);
    if (scope == NULL || value == NULL) {
        return NULL;
    }
    scope->definition = definition;
    scope->caller = caller;
    scope->enclosing = enclosing;
    scope->name = "";
    scope->value = value;
    for (size_t k = 0; k < definition->parameters.n_assignments; k++) {
        if (!definition->parameters.assignment[k].is_conditional) {
            declare(language, scope, &definition->parameters.assignment[k]);
        }
    }
    if (definition->condition_depth > 0) {
        scope->active = dalcs_arena_alloc(arena, definition->n_items, sizeof *scope->active);
        return scope->active != NULL ? scope : NULL;
    }
    return scope;
}

/* ---- Values ---------------------------------------------------------------------------------- */

bool dalcs_scope_compile(struct dalcs_language *language, const struct dalcs_scope *scope,
                         const struct dalcs_token *token, int n,
                         const struct dalcs_names *arguments,
                         struct dalcs_expression **expression) {
    if (*expression == NULL) {
        const struct dalcs_expression_context context = {.arena = language->arena,
                                                         .diag = language->diag,
                                                         .instance =
                                                             scope != NULL ? scope->origin : NULL,
                                                         .arguments = arguments,
                                                         .has_signals = arguments != NULL,
                                                         .is_condition = language->is_condition,
                                                         .dialect = language->netlist->dialect,
                                                         .noted_caret = &language->noted.caret,
                                                         .noted_log = &language->noted.log};
        struct dalcs_expression_text text;
        if (!dalcs_expression_text(language->arena, token, n, &text) ||
            (*expression = dalcs_expression_parse(&context, &text)) == NULL) {
            language->out_of_memory = true;
            return false;
        }
        language->deck->has_errors = language->deck->has_errors || (*expression)->is_wrong;
    }
    return !(*expression)->is_wrong;
}

static enum dalcs_outcome try_value(struct dalcs_language *language, struct dalcs_value *value) {
    if (!dalcs_scope_compile(language, value->where, value->token, value->n_tokens, NULL,
                             value->expression)) {
        return DALCS_OUTCOME_WRONG;
    }
    const struct dalcs_draw_place before = dalcs_drawn_enter(
        language,
        (struct dalcs_draw_place){.scope = value->owner != NULL ? value->owner : value->where,
                                  .parameter = value->name->text});
    const enum dalcs_outcome outcome =
        dalcs_evaluate(language, value->where, *value->expression, &value->value);
    dalcs_drawn_leave(language, before, outcome == DALCS_OUTCOME_VALUE ? &value->value : NULL);
    return outcome;
}

/* `value` waits for itself: says by which way, and makes all on it wrong. */
static void report_cycle(struct dalcs_language *language, struct dalcs_value *value) {
    enum { MOST_SHOWN = 8 };

    size_t first = language->sought.n;
    while (language->sought.value[first - 1] != value) {
        first--;
    }
    first--;
    const char *way = value->name->text;
    for (size_t k = first + 1; k < language->sought.n && way != NULL; k++) {
        language->sought.value[k]->state = DALCS_VALUE_WRONG;
        if (k - first < MOST_SHOWN) {
            way = dalcs_language_text(language, "%s -> %s", way,
                                      language->sought.value[k]->name->text);
        }
    }
    const bool is_long = language->sought.n - first > MOST_SHOWN;
    value->state = DALCS_VALUE_WRONG;
    if (way != NULL) {
        dalcs_language_report(language, DALCS_ERROR, value->where, value->name,
                              dalcs_language_text(language, "%s%s -> %s", way,
                                                  is_long ? " -> ..." : "", value->name->text),
                              "parameter '%s' depends on itself", value->name->text);
    }
}

static void seek(struct dalcs_language *language, struct dalcs_value *value) {
    if (dalcs_grow(&language->sought.value, &language->sought.capacity, language->sought.n + 1,
                   sizeof(struct dalcs_value *)) != DALCS_OK) {
        language->out_of_memory = true;
        return;
    }
    value->state = DALCS_VALUE_SOUGHT;
    language->sought.value[language->sought.n++] = value;
}

/* Finds a value and those that it needs. */
static void find_value(struct dalcs_language *language, struct dalcs_value *value) {
    const size_t base = language->sought.n;
    seek(language, value);
    while (language->sought.n > base && !language->out_of_memory) {
        struct dalcs_value *now = language->sought.value[language->sought.n - 1];
        const enum dalcs_outcome outcome = try_value(language, now);
        if (outcome != DALCS_OUTCOME_WAITS) {
            now->state = outcome == DALCS_OUTCOME_VALUE ? DALCS_VALUE_KNOWN : DALCS_VALUE_WRONG;
        } else if (language->sought.awaited->state == DALCS_VALUE_SOUGHT) {
            report_cycle(language, language->sought.awaited);
        } else {
            seek(language, language->sought.awaited);
        }
        while (language->sought.n > base &&
               language->sought.value[language->sought.n - 1]->state != DALCS_VALUE_SOUGHT) {
            language->sought.n--;
        }
    }
    language->sought.n = base;
}

bool dalcs_scope_evaluate(struct dalcs_language *language, struct dalcs_scope *scope,
                          struct dalcs_expression *expression, double *value) {
    for (;;) {
        const enum dalcs_outcome outcome = dalcs_evaluate(language, scope, expression, value);
        if (outcome != DALCS_OUTCOME_WAITS) {
            return outcome == DALCS_OUTCOME_VALUE && !language->out_of_memory;
        }
        find_value(language, language->sought.awaited);
        if (language->out_of_memory) {
            return false;
        }
    }
}

/* ---- Conditions ------------------------------------------------------------------------------ */

/* An .if that is being walked through. */
struct branch {
    bool outer; /* what is around it counts */
    bool taken; /* one of its branches was chosen */
};

static bool holds(struct dalcs_language *language, struct dalcs_scope *scope,
                  struct dalcs_item *item) {
    const struct dalcs_card *card = item->card;
    double value = 0;
    if (item->expression == NULL) {
        item->expression =
            dalcs_arena_alloc(language->arena, (size_t)card->n, sizeof *item->expression);
        language->out_of_memory = language->out_of_memory || item->expression == NULL;
    }
    for (int k = 1; k < card->n; k++) {
        if (card->token[k].kind == DALCS_TOKEN_BAD) {
            return false;
        }
    }
    language->is_condition = true;
    const bool is_compiled = card->n >= 2 && !language->out_of_memory &&
                             dalcs_scope_compile(language, scope, card->token + 1, card->n - 1,
                                                 NULL, &item->expression[0]);
    language->is_condition = false;
    const struct dalcs_draw_place before = dalcs_drawn_enter(
        language, (struct dalcs_draw_place){.scope = scope, .card = card, .at = card->n});
    const bool is_known =
        is_compiled && dalcs_scope_evaluate(language, scope, item->expression[0], &value);
    dalcs_drawn_leave(language, before, NULL);
    if (!is_known) {
        /* What would have been chosen is not known. */
        language->deck->hides_all = true;
        return false;
    }
    return value != 0;
}

static void decide(struct dalcs_language *language, struct dalcs_scope *scope) {
    struct dalcs_definition *d = scope->definition;
    struct branch *branch =
        dalcs_arena_alloc(language->arena, (size_t)d->condition_depth, sizeof *branch);
    int depth = 0;
    bool counts = true;
    size_t next = 0;
    if (branch == NULL) {
        language->out_of_memory = true;
        return;
    }
    for (size_t k = 0; k < d->n_items; k++) {
        struct dalcs_item *item = &d->item[k];
        struct branch *top = depth > 0 ? &branch[depth - 1] : NULL;
        if (item->kind == DALCS_ITEM_IF) {
            branch[depth++] = (struct branch){counts, counts && holds(language, scope, item)};
            counts = branch[depth - 1].taken;
        } else if (item->kind == DALCS_ITEM_ELSEIF && top != NULL) {
            counts = top->outer && !top->taken && holds(language, scope, item);
            top->taken = top->taken || counts;
        } else if (item->kind == DALCS_ITEM_ELSE && top != NULL) {
            counts = top->outer && !top->taken;
            top->taken = true;
        } else if (item->kind == DALCS_ITEM_ENDIF && top != NULL) {
            counts = top->outer;
            depth--;
        }
        scope->active[k] = counts;
        for (; next < d->parameters.n_assignments && d->parameters.assignment[next].item <= (int)k;
             next++) {
            if (d->parameters.assignment[next].is_conditional && counts) {
                declare(language, scope, &d->parameters.assignment[next]);
            }
        }
    }
}

void dalcs_scope_settle(struct dalcs_language *language, struct dalcs_scope *scope) {
    if (scope->active != NULL) {
        decide(language, scope);
    }
    for (int k = 0; k < scope->definition->parameters.n_slots && !language->out_of_memory; k++) {
        if (scope->value[k].token != NULL && scope->value[k].state == DALCS_VALUE_UNKNOWN) {
            find_value(language, &scope->value[k]);
        }
    }
    for (int k = 0; k < scope->n_extra && !language->out_of_memory; k++) {
        if (scope->extra[k].state == DALCS_VALUE_UNKNOWN) {
            find_value(language, &scope->extra[k]);
        }
    }
}

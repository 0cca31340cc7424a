/* signal_formula_whole.c - a formula of signals when all its steps are known: its degree, differences of two. */
#include "result_cards.h"
#include "signal_formula_card.h"

#include <string.h>

/* Degree in signals and time of what the steps leave on the stack: 0, 1, or 2 for anything else. */
static int degree_of(const struct dalcs_signal_formula_step *step, size_t n) {
    unsigned char degree[DALCS_SIGNAL_FORMULA_DEEPEST];
    int top = 0;
    for (size_t k = 0; k < n; k++) {
        const enum dalcs_operation_code code = step[k].code;
        if (step[k].push == DALCS_PUT_ARGUMENT) {
            degree[top++] = degree[step[k].index];
        } else if (step[k].push == DALCS_PUT_DOWN) {
            degree[step[k].index] = degree[top - 1];
            top = step[k].index + 1;
        } else if (step[k].push != DALCS_PUT_NOTHING) {
            const bool varies = step[k].push == DALCS_PUT_TIME || step[k].push == DALCS_PUT_SIGNAL;
            degree[top++] = varies ? (step[k].part == DALCS_PART_PLAIN ? 1 : 2) : 0;
        } else if (code == DALCS_CALL) {
            unsigned char most = 0;
            for (int i = 0; i < step[k].count; i++) {
                most = degree[--top] > most ? degree[top] : most;
            }
            degree[top++] = most > 0 ? 2 : 0;
        } else if (code >= DALCS_JUMP && code <= DALCS_JUMP_OR) {
            return 2;
        } else if (code >= DALCS_ADD && code <= DALCS_GREATER_EQUAL) {
            const unsigned char b = degree[--top];
            unsigned char *a = &degree[top - 1];
            const unsigned char most = *a > b ? *a : b;
            const bool is_sum = code == DALCS_ADD || code == DALCS_SUBTRACT;
            const bool is_scaled =
                (code == DALCS_MULTIPLY && (*a == 0 || b == 0)) || (code == DALCS_DIVIDE && b == 0);
            *a = most == 0 || is_sum || is_scaled ? most : 2;
        } else if (code != DALCS_NEGATE && degree[top - 1] > 0) {
            degree[top - 1] = 2;
        }
    }
    return top > 0 ? degree[0] : 0;
}

void dalcs_signal_compilation_finish(struct dalcs_signal_compilation *c,
                                     struct dalcs_signal_formula *formula) {
    struct dalcs_signal_formula_step *step =
        dalcs_arena_alloc(&c->builder->circuit->arena, c->n_steps, sizeof *step);
    if (step == NULL) {
        c->builder->out_of_memory = true;
        c->failed = true;
        return;
    }
    memcpy(step, c->step, c->n_steps * sizeof *step);
    for (size_t k = 0; k < c->n_steps; k++) {
        formula->has_results = formula->has_results || step[k].push == DALCS_PUT_RESULT;
    }
    const int degree = degree_of(step, c->n_steps);
    formula->step = step;
    formula->n = (int)c->n_steps;
    formula->deepest = c->deepest;
    formula->is_affine = degree <= 1;
    formula->is_constant = degree == 0 && !formula->has_results;
}

bool dalcs_signal_formula_difference(struct dalcs_builder *builder,
                                     const struct dalcs_signal_formula *left,
                                     const struct dalcs_signal_formula *right,
                                     struct dalcs_signal_formula *difference) {
    const int n = left->n + right->n + 1;
    struct dalcs_signal_formula_step *step =
        dalcs_arena_alloc(&builder->circuit->arena, (size_t)n, sizeof *step);
    if (step == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    memcpy(step, left->step, (size_t)left->n * sizeof *step);
    memcpy(step + left->n, right->step, (size_t)right->n * sizeof *step);
    for (int k = left->n; k < n - 1; k++) {
        /* what the left side leaves lies below */
        step[k].index += step[k].push == DALCS_PUT_ARGUMENT || step[k].push == DALCS_PUT_DOWN;
    }
    step[n - 1].code = DALCS_SUBTRACT;
    *difference = (struct dalcs_signal_formula){
        .n = n,
        .step = step,
        .text = left->text,
        .deepest = left->deepest > right->deepest + 1 ? left->deepest : right->deepest + 1,
        .is_affine = left->is_affine && right->is_affine,
        .has_results = left->has_results || right->has_results};
    return difference->deepest <= DALCS_SIGNAL_FORMULA_DEEPEST;
}

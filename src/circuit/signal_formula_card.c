/* signal_formula_card.c - formulas of signals on cards: v(...), i(...) and names to what they mean.
 *
 * The parser of expressions knows no signals. Each is masked by a name of the same length that no
 * netlist can have, so that all places stay what they are. */
#include "signal_formula_card.h"

#include "result_cards.h"

void dalcs_signal_compilation_report(struct dalcs_signal_compilation *c,
                                     const struct dalcs_expression_text *text, int begin,
                                     int length, const char *hint, const char *format,
                                     va_list arguments) {
    const struct dalcs_location where = dalcs_expression_place(text, begin, length);
    dalcs_diag_add_list(c->builder->diag, DALCS_ERROR, &where, hint, format, arguments);
    c->builder->failed = true;
    c->failed = true;
}

bool dalcs_signal_formula_compile(struct dalcs_builder *builder, const struct dalcs_token *token,
                                  int n, const struct dalcs_signal_formula_rules *rules,
                                  struct dalcs_signal_formula *formula) {
    struct dalcs_signal_compilation c = {.builder = builder, .rules = rules};
    struct dalcs_arena *scratch = &builder->scratch;
    *formula = (struct dalcs_signal_formula){0};
    if (!dalcs_expression_text(scratch, token, n, &c.text)) {
        builder->out_of_memory = true;
        return false;
    }
    const size_t length = (size_t)c.text.length;
    c.masked = dalcs_arena_copy(scratch, c.text.text, length);
    c.signal = dalcs_arena_alloc(scratch, length / 4 + 1, sizeof *c.signal);
    c.part = dalcs_arena_alloc(scratch, length / 4 + 1, sizeof *c.part);
    c.factor = dalcs_arena_alloc(scratch, length / 4 + 1, sizeof *c.factor);
    formula->text = dalcs_arena_copy(&builder->circuit->arena, c.text.text, length);
    if (c.masked == NULL || c.signal == NULL || c.part == NULL || c.factor == NULL ||
        formula->text == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    dalcs_signal_compilation_mask(&c);
    if (c.failed) {
        return false;
    }
    const struct dalcs_expression_context context = {.arena = scratch,
                                                     .diag = builder->diag,
                                                     .dialect = builder->netlist->dialect,
                                                     .noted_caret = &builder->noted.caret,
                                                     .noted_log = &builder->noted.log};
    struct dalcs_expression_text masked = c.text;
    masked.text = c.masked;
    const struct dalcs_expression *e = dalcs_expression_parse(&context, &masked);
    if (e == NULL || e->is_wrong) {
        builder->out_of_memory = builder->out_of_memory || e == NULL;
        builder->failed = true;
        return false;
    }
    return dalcs_signal_compilation_steps(&c, e, formula);
}

/* formula_writer.c - see formula_writer.h. */
#include "formula_writer.h"

bool dalcs_formula_writer_start(struct dalcs_formula_writer *w, struct dalcs_builder *builder,
                                const struct dalcs_token *element) {
    struct dalcs_expression_text *text = dalcs_arena_alloc(&builder->scratch, 1, sizeof *text);
    if (text == NULL || !dalcs_expression_text(&builder->scratch, element, 1, text)) {
        builder->out_of_memory = true;
        return false;
    }
    *w = (struct dalcs_formula_writer){builder, element, text, 0};
    return true;
}

static struct dalcs_formula *make(struct dalcs_formula_writer *w, enum dalcs_formula_kind kind) {
    struct dalcs_formula *f = dalcs_arena_alloc(&w->builder->scratch, 1, sizeof *f);
    if (f == NULL) {
        w->builder->out_of_memory = true;
        return NULL;
    }
    *f = (struct dalcs_formula){.kind = kind,
                                .where = dalcs_token_location(w->element),
                                .text = w->text,
                                .end = w->text->length};
    return f;
}

static const struct dalcs_formula *finish(struct dalcs_formula_writer *w, struct dalcs_formula *f,
                                          int n, const struct dalcs_formula *const *argument) {
    const struct dalcs_formula **own = dalcs_arena_alloc(&w->builder->scratch, (size_t)n + 1,
                                                         sizeof(const struct dalcs_formula *));
    bool ok = f != NULL && own != NULL;
    for (int k = 0; k < n && ok; k++) {
        own[k] = argument[k];
        ok = own[k] != NULL;
    }
    if (!ok) {
        w->builder->out_of_memory = true;
        return NULL;
    }
    f->n = n;
    f->argument = own;
    f->number_of = w->n++;
    return f;
}

const struct dalcs_formula *dalcs_formula_number(struct dalcs_formula_writer *w, double value) {
    struct dalcs_formula *f = make(w, DALCS_FORMULA_NUMBER);
    if (f != NULL) {
        f->number = value;
    }
    return finish(w, f, 0, NULL);
}

const struct dalcs_formula *dalcs_formula_signal(struct dalcs_formula_writer *w,
                                                 enum dalcs_formula_kind kind,
                                                 const struct dalcs_token *a,
                                                 const struct dalcs_token *b) {
    struct dalcs_formula *f = make(w, kind);
    if (f != NULL) {
        f->signal[0] = a;
        f->signal[1] = b;
    }
    return finish(w, f, 0, NULL);
}

const struct dalcs_formula *dalcs_formula_operation(struct dalcs_formula_writer *w,
                                                    enum dalcs_operation_code code,
                                                    const struct dalcs_formula *a,
                                                    const struct dalcs_formula *b) {
    struct dalcs_formula *f = make(w, DALCS_FORMULA_OPERATION);
    if (f != NULL) {
        f->code = code;
    }
    return finish(w, f, 2, (const struct dalcs_formula *const[]){a, b});
}

const struct dalcs_formula *dalcs_formula_call(struct dalcs_formula_writer *w, const char *function,
                                               int n, const struct dalcs_formula *const *argument) {
    struct dalcs_formula *f = make(w, DALCS_FORMULA_CALL);
    if (f != NULL) {
        f->function = function;
    }
    return finish(w, f, n, argument);
}

const struct dalcs_formula *dalcs_formula_like(struct dalcs_formula_writer *w,
                                               const struct dalcs_formula *part,
                                               const struct dalcs_formula *const *argument) {
    struct dalcs_formula *f = dalcs_arena_alloc(&w->builder->scratch, 1, sizeof *f);
    if (f != NULL) {
        *f = *part;
    }
    return finish(w, f, part->n, argument);
}

struct dalcs_token *dalcs_formula_name(struct dalcs_builder *builder, const struct dalcs_token *at,
                                       const char *text) {
    struct dalcs_token *token = dalcs_arena_alloc(&builder->scratch, 1, sizeof *token);
    if (token == NULL || text == NULL) {
        builder->out_of_memory = true;
        return NULL;
    }
    *token = *at;
    token->text = text;
    return token;
}

const struct dalcs_token *dalcs_formula_token(struct dalcs_formula_writer *w,
                                              const struct dalcs_formula *formula) {
    struct dalcs_token *token = dalcs_formula_name(w->builder, w->element, w->element->text);
    if (token == NULL || formula == NULL) {
        return NULL;
    }
    token->kind = DALCS_TOKEN_FORMULA;
    token->formula = formula;
    return token;
}

/* formula_writer.c - formulas that no card has in full, part by part. */
#include "formula_writer.h"

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
    const struct dalcs_formula **own =
        dalcs_arena_alloc(&w->builder->scratch, 3, sizeof(const struct dalcs_formula *));
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

/* findings.c - conditions, verdicts, witnesses. */
#include "findings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *dalcs_answer_text(enum dalcs_answer answer) {
    static const char *const text[] = {[DALCS_NO] = "no",
                                       [DALCS_YES] = "yes",
                                       [DALCS_CONDITIONAL] = "depends",
                                       [DALCS_UNDECIDED] = "undecided",
                                       [DALCS_NOT_CHECKED] = "not checked"};
    return text[answer];
}

void dalcs_findings_finish(struct dalcs_findings *f) {
    free(f->condition);
    free(f->verdict);
}

enum dalcs_status dalcs_findings_condition(struct dalcs_findings *f, const char *id,
                                           const char *source, const char *text,
                                           enum dalcs_answer holds, const char *because, ...) {
    DALCS_TRY(dalcs_grow(&f->condition, &f->condition_capacity, f->n_conditions + 1,
                         sizeof(*f->condition)));
    struct dalcs_condition *c = &f->condition[f->n_conditions];
    *c = (struct dalcs_condition){.id = id, .source = source, .text = text, .holds = holds};
    if (because != NULL) {
        va_list arguments;
        va_start(arguments, because);
        c->because = dalcs_arena_printf_list(f->result, because, arguments);
        va_end(arguments);
        if (c->because == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    f->n_conditions++;
    return DALCS_OK;
}

enum dalcs_status dalcs_findings_verdict(struct dalcs_findings *f, const char *question,
                                         enum dalcs_answer answer, const char *source,
                                         const char *sentence, ...) {
    DALCS_TRY(
        dalcs_grow(&f->verdict, &f->verdict_capacity, f->n_verdicts + 1, sizeof(*f->verdict)));
    struct dalcs_verdict *v = &f->verdict[f->n_verdicts];
    *v = (struct dalcs_verdict){
        .question = question, .answer = answer, .source = source, .value = NAN};
    va_list arguments;
    va_start(arguments, sentence);
    v->sentence = dalcs_arena_printf_list(f->result, sentence, arguments);
    va_end(arguments);
    if (v->sentence == NULL) {
        return DALCS_E_NOMEM;
    }
    f->n_verdicts++;
    return DALCS_OK;
}

enum dalcs_status dalcs_findings_witness(struct dalcs_findings *f, bool of_verdict,
                                         const struct dalcs_evidence *witness) {
    struct dalcs_condition *c = of_verdict ? NULL : &f->condition[f->n_conditions - 1];
    struct dalcs_verdict *v = of_verdict ? &f->verdict[f->n_verdicts - 1] : NULL;
    size_t n = of_verdict ? v->n_witnesses : c->n_witnesses;
    const struct dalcs_evidence *old = of_verdict ? v->witness : c->witness;
    struct dalcs_evidence *all = dalcs_arena_alloc(f->result, n + 1, sizeof(*all));
    if (all == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        all[i] = old[i];
    }
    all[n] = *witness;
    if (of_verdict) {
        v->witness = all;
        v->n_witnesses = n + 1;
    } else {
        c->witness = all;
        c->n_witnesses = n + 1;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_evidence_new(struct dalcs_evidence *w, struct dalcs_findings *f,
                                     const char *kind, size_t room) {
    *w = (struct dalcs_evidence){.kind = kind};
    w->entry = dalcs_arena_alloc(f->result, room + 1, sizeof(*w->entry));
    return w->entry == NULL ? DALCS_E_NOMEM : DALCS_OK;
}

void dalcs_evidence_put(struct dalcs_evidence *w, const char *name, double re, double im) {
    struct dalcs_evidence_entry *entry = (struct dalcs_evidence_entry *)w->entry;
    entry[w->n_entries++] = (struct dalcs_evidence_entry){name, re, im};
}

enum dalcs_status dalcs_evidence_matrix(struct dalcs_evidence *w, struct dalcs_findings *f,
                                        const char *kind, const struct dalcs_matrix *m,
                                        const char *const *name) {
    size_t n = (size_t)m->rows;
    double *value = dalcs_arena_alloc(f->result, n * n + 1, sizeof(*value));
    const char **names = dalcs_arena_alloc(f->result, n + 1, sizeof(*names));
    if (value == NULL || names == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        names[i] = name[i];
        for (size_t j = 0; j < n; j++) {
            value[i * n + j] = *dalcs_at(m, (int)i, (int)j);
        }
    }
    *w = (struct dalcs_evidence){
        .kind = kind, .n_rows = n, .n_columns = n, .row = names, .column = names, .value = value};
    return DALCS_OK;
}

const char *dalcs_join_names(struct dalcs_arena *arena, size_t n, const char *const *name) {
    enum { MOST = 6 };

    const char *list = n == 0 ? "none" : name[0];
    for (size_t i = 1; i < n && list != NULL; i++) {
        if (i == MOST && n > MOST + 1) {
            return dalcs_arena_printf(arena, "%s and %zu more", list, n - i);
        }
        list = dalcs_arena_printf(arena, i + 1 < n ? "%s, %s" : "%s and %s", list, name[i]);
    }
    return list;
}

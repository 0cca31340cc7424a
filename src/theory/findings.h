/* findings.h - collects conditions and verdicts with their witnesses while a part is checked. */
#ifndef DALCS_FINDINGS_H
#define DALCS_FINDINGS_H

#include "lcs.h"

/* Everything that is kept is in `result`; what is not, in `work`. */
struct dalcs_findings {
    struct dalcs_arena *result, *work;
    size_t n_conditions, n_verdicts;
    size_t condition_capacity, verdict_capacity;
    struct dalcs_condition *condition; /* freed by finish */
    struct dalcs_verdict *verdict;
};

void dalcs_findings_finish(struct dalcs_findings *f);

/* Adds a condition; `because` is printf's, NULL: none. *added, which may be NULL, is valid until the
 * next one. */
enum dalcs_status dalcs_findings_condition(struct dalcs_findings *f, const char *id,
                                           const char *source, const char *text,
                                           enum dalcs_answer holds, const char *because, ...)
    __attribute__((format(printf, 6, 7))) DALCS_MUST_CHECK;

/* Adds a verdict without a value. */
enum dalcs_status dalcs_findings_verdict(struct dalcs_findings *f, const char *question,
                                         enum dalcs_answer answer, const char *source,
                                         const char *sentence, ...)
    __attribute__((format(printf, 5, 6))) DALCS_MUST_CHECK;

/* A witness of the condition, or verdict, added last. */
enum dalcs_status dalcs_findings_witness(struct dalcs_findings *f, bool of_verdict,
                                         const struct dalcs_evidence *witness) DALCS_MUST_CHECK;

/* An empty witness with room for entries. */
enum dalcs_status dalcs_evidence_new(struct dalcs_evidence *w, struct dalcs_findings *f,
                                     const char *kind, size_t room) DALCS_MUST_CHECK;
void dalcs_evidence_put(struct dalcs_evidence *w, const char *name, double re, double im);

/* A symmetric matrix over names. */
enum dalcs_status dalcs_evidence_matrix(struct dalcs_evidence *w, struct dalcs_findings *f,
                                        const char *kind, const struct dalcs_matrix *m,
                                        const char *const *name) DALCS_MUST_CHECK;

static inline enum dalcs_answer dalcs_answer_of(bool holds) {
    return holds ? DALCS_YES : DALCS_NO;
}

/* "d1", "d1 and d2", "d1, d2 and 5 more"; "none" of nothing. NULL when out of memory. */
const char *dalcs_join_names(struct dalcs_arena *arena, size_t n, const char *const *name);

#endif

/* failed_steps.h - steps of .step that ended early, for the report: they lose none of the others. */
#ifndef DALCS_FAILED_STEPS_H
#define DALCS_FAILED_STEPS_H

#include "pipeline.h"

/* Zero-initialise; finish frees. */
struct dalcs_failed_steps {
    struct dalcs_failed_step *step; /* heap; texts are the session's */
    size_t n, capacity;
    enum dalcs_status first;    /* of the first one; DALCS_OK: there is none */
    struct dalcs_report report; /* of that one: infeasible alone */
};

/* Is it one after which the others may be run? */
bool dalcs_step_lets_go_on(enum dalcs_status status);

/* Did this step fail in an analysis before? */
bool dalcs_failed_steps_has(const struct dalcs_failed_steps *failed, size_t step);

/* "r = 500, c = 1e-06"; NULL: out of memory. */
const char *dalcs_step_text(struct dalcs_session *s, const struct dalcs_plot *step);

/* Notes a step; messages behind the mark are of it. Those of the first few steps stay, with a note of which step it was. */
enum dalcs_status dalcs_failed_steps_add(struct dalcs_failed_steps *failed, struct dalcs_session *s,
                                         const struct dalcs_plot *step, enum dalcs_status status,
                                         const struct dalcs_diag_mark *before) DALCS_MUST_CHECK;

/* Into the report of so many steps, and a message of those that were not told. */
enum dalcs_status dalcs_failed_steps_report(const struct dalcs_failed_steps *failed,
                                            struct dalcs_session *s,
                                            size_t n_steps) DALCS_MUST_CHECK;
void dalcs_failed_steps_finish(struct dalcs_failed_steps *failed);

#endif

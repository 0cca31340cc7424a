/* failed_steps.c - which steps failed, and why. */
#include "failed_steps.h"

#include <stdlib.h>
#include <string.h>

/* Steps whose messages are kept, of a sweep in which thousands fail. The report has all of them. */
enum { MOST_TOLD = 10 };

bool dalcs_step_lets_go_on(enum dalcs_status status) {
    return status > DALCS_OK || status == DALCS_E_NETLIST;
}

bool dalcs_failed_steps_has(const struct dalcs_failed_steps *failed, size_t step) {
    bool has = false;
    for (size_t k = 0; k < failed->n && !has; k++) {
        has = failed->step[k].step == step;
    }
    return has;
}

const char *dalcs_step_text(struct dalcs_session *s, const struct dalcs_plot *step) {
    const char *values = "";
    for (size_t k = 0; k < step->n_parameters && values != NULL; k++) {
        values = dalcs_arena_printf(&s->arena, "%s%s%s = %.9g", values, k > 0 ? ", " : "",
                                    step->parameter[k], step->parameter_value[k]);
    }
    return values;
}

/* The sentence of the first error since `before`; what a step that could not be built says was perhaps said of another one. */
static const char *find_reason(struct dalcs_session *s, enum dalcs_status status,
                               const struct dalcs_diag_mark *before) {
    const char *text = status == DALCS_E_NETLIST ? s->source.why_unbuilt : NULL;
    for (size_t k = before->n; k < s->diag.n && text == NULL; k++) {
        text = s->diag.item[k].severity == DALCS_ERROR ? s->diag.item[k].text : NULL;
    }
    size_t length;
    const char *reason =
        dalcs_diag_sentence(text != NULL ? text : dalcs_status_text(status), &length);
    return dalcs_arena_copy(&s->arena, reason, length);
}

/* The circuit that the names are of goes. */
static enum dalcs_status keep_infeasible(struct dalcs_failed_steps *failed,
                                         struct dalcs_session *s) {
    const size_t n = s->results.report.infeasible.n_elements;
    const char **element = dalcs_arena_alloc(&s->arena, n, sizeof(*element));
    bool complete = element != NULL;
    for (size_t k = 0; k < n && complete; k++) {
        const char *name = s->results.report.infeasible.element[k];
        element[k] = dalcs_arena_copy(&s->arena, name, strlen(name));
        complete = element[k] != NULL;
    }
    failed->report.infeasible = s->results.report.infeasible;
    failed->report.infeasible.element = element;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_failed_steps_add(struct dalcs_failed_steps *failed, struct dalcs_session *s,
                                         const struct dalcs_plot *step, enum dalcs_status status,
                                         const struct dalcs_diag_mark *before) {
    const char *values = dalcs_step_text(s, step);
    const char *because = find_reason(s, status, before);
    if (values == NULL || because == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_grow(&failed->step, &failed->capacity, failed->n + 1, sizeof(*failed->step)));
    failed->step[failed->n++] = (struct dalcs_failed_step){step->step, values, status, because};
    if (failed->first == DALCS_OK) {
        failed->first = status;
        DALCS_TRY(keep_infeasible(failed, s));
    }
    if (failed->n > MOST_TOLD) {
        dalcs_diag_forget(&s->diag, before);
        return DALCS_OK;
    }
    dalcs_diag_add(&s->diag, DALCS_NOTE, NULL, NULL, "this was step %zu of %zu: %s", step->step + 1,
                   dalcs_steps_count(s), values);
    return DALCS_OK;
}

static int by_number(const void *a, const void *b) {
    const struct dalcs_failed_step *one = a, *other = b;
    return one->step < other->step ? -1 : one->step > other->step ? 1 : 0;
}

enum dalcs_status dalcs_failed_steps_report(const struct dalcs_failed_steps *failed,
                                            struct dalcs_session *s, size_t n_steps) {
    s->results.report.n_steps = n_steps;
    if (failed->n == 0) {
        return DALCS_OK;
    }
    if (failed->n > MOST_TOLD) {
        dalcs_diag_add(&s->diag, DALCS_ERROR, NULL,
                       "--report FILE.json has all of them in failed_steps, and -o none --measures "
                       "FILE.csv makes a table",
                       "%zu of %zu steps failed, the first %d as told above", failed->n, n_steps,
                       MOST_TOLD);
    }
    struct dalcs_failed_step *step = dalcs_arena_alloc(&s->arena, failed->n, sizeof(*step));
    if (step == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(step, failed->step, failed->n * sizeof(*step));
    qsort(step, failed->n, sizeof(*step), by_number);
    s->results.report.infeasible = failed->report.infeasible; /* goes with the status */
    s->results.report.failed_step = step;
    s->results.report.n_failed_steps = failed->n;
    return DALCS_OK;
}

void dalcs_failed_steps_finish(struct dalcs_failed_steps *failed) {
    free(failed->step);
    *failed = (struct dalcs_failed_steps){0};
}

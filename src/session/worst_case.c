/* worst_case.c - .wcase: runs of the circuit with its tolerances at their ends. */
#include "worst_case.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static enum dalcs_status list_all(struct dalcs_worst_case *w) {
    struct dalcs_arena *arena = &w->session->arena;
    const struct dalcs_report *report = &w->session->results.report;
    w->n_results = report->n_measurements;
    w->parameter = dalcs_arena_alloc(arena, w->n + 1, sizeof *w->parameter);
    w->result = dalcs_arena_alloc(arena, w->n_results + 1, sizeof *w->result);
    if (w->parameter == NULL || w->result == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t p = 0; p < w->n; p++) {
        w->parameter[p] =
            (struct dalcs_worst_case_parameter){.name = w->place[p].name, .low = -1, .high = 1};
    }
    dalcs_worst_case_read(w, &w->session->circuit, 0, w->n);
    for (size_t k = 0; k < w->n_results; k++) {
        w->result[k].name = report->measurement[k].name;
    }
    return DALCS_OK;
}

/* The run that the session has done already. */
static enum dalcs_status take_nominal(struct dalcs_worst_case *w, const signed char *at) {
    DALCS_TRY(dalcs_worst_case_add(w, at));
    dalcs_worst_case_take(w, &w->session->results.report, 0);
    w->n_done = 1;
    return DALCS_OK;
}

static enum dalcs_status add_alone(struct dalcs_worst_case *w, signed char *at) {
    for (size_t p = 0; p < w->n; p++) {
        for (int end = -1; end <= 1; end += 2) {
            memset(at, 0, w->n);
            at[p] = (signed char)end;
            DALCS_TRY(dalcs_worst_case_add(w, at));
        }
    }
    return DALCS_OK;
}

static enum dalcs_status add_told(struct dalcs_worst_case *w, signed char *at) {
    for (size_t k = 0; k < w->n_results; k++) {
        dalcs_worst_case_choose(w, k, false, at);
        DALCS_TRY(dalcs_worst_case_add(w, at));
        dalcs_worst_case_choose(w, k, true, at);
        DALCS_TRY(dalcs_worst_case_add(w, at));
    }
    return DALCS_OK;
}

static enum dalcs_status add_corners(struct dalcs_worst_case *w, signed char *at) {
    for (size_t corner = 0; corner < (size_t)1 << w->n; corner++) {
        for (size_t p = 0; p < w->n; p++) {
            at[p] = (signed char)((corner >> p & 1) != 0 ? 1 : -1);
        }
        DALCS_TRY(dalcs_worst_case_add(w, at));
    }
    return DALCS_OK;
}

/* The nominal one, with which `at` begins, is done. What is told follows from the runs before. */
static enum dalcs_status run_all(struct dalcs_worst_case *w, signed char *at, bool has_corners) {
    DALCS_TRY(take_nominal(w, at));
    DALCS_TRY(add_alone(w, at));
    DALCS_TRY(dalcs_worst_case_run_added(w));
    DALCS_TRY(add_told(w, at));
    if (has_corners) {
        DALCS_TRY(add_corners(w, at));
    }
    return dalcs_worst_case_run_added(w);
}

static enum dalcs_status fill_alone(struct dalcs_worst_case *w) {
    for (size_t k = 0; k < w->n_results; k++) {
        double *low = dalcs_arena_alloc(&w->session->arena, w->n + 1, sizeof *low);
        double *high = dalcs_arena_alloc(&w->session->arena, w->n + 1, sizeof *high);
        if (low == NULL || high == NULL) {
            return DALCS_E_NOMEM;
        }
        for (size_t p = 0; p < w->n; p++) {
            low[p] = w->run[dalcs_worst_case_alone(p, false)].value[k];
            high[p] = w->run[dalcs_worst_case_alone(p, true)].value[k];
        }
        w->result[k].at_low = low;
        w->result[k].at_high = high;
    }
    return DALCS_OK;
}

static enum dalcs_status report(struct dalcs_worst_case *w, bool has_corners) {
    struct dalcs_session *s = w->session;
    struct dalcs_worst_case_run *run =
        dalcs_arena_alloc(&s->arena, w->n_runs, sizeof *run); /* valid as long as the report */
    if (run == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(run, w->run, w->n_runs * sizeof *run);
    DALCS_TRY(fill_alone(w));
    dalcs_worst_case_judge(w);
    s->results.report.worst_case.present = true;
    s->results.report.worst_case.has_corners = has_corners;
    s->results.report.worst_case.n_parameters = w->n;
    s->results.report.worst_case.n_results = w->n_results;
    s->results.report.worst_case.n_runs = w->n_runs;
    s->results.report.worst_case.n_failed = w->n_failed;
    s->results.report.worst_case.parameter = w->parameter;
    s->results.report.worst_case.result = w->result;
    s->results.report.worst_case.run = run;
    return DALCS_OK;
}

enum dalcs_status dalcs_worst_case_run(struct dalcs_session *session,
                                       const struct dalcs_run_options *options,
                                       const struct dalcs_sink *sink) {
    const struct dalcs_worst_case_card *card = &session->circuit.analyses.worst_case;
    struct dalcs_run_options of_runs = *options;
    struct dalcs_worst_case w = {.session = session,
                                 .options = &of_runs,
                                 .sink = sink,
                                 .place = card->place,
                                 .n = (size_t)card->n,
                                 .lock = PTHREAD_MUTEX_INITIALIZER};
    const bool has_corners = !card->no_corners && card->n <= DALCS_MOST_OF_CORNERS;
    of_runs.record = of_runs.energy = false;
    of_runs.dump_path = NULL;
    dalcs_run_options_set_times(&of_runs, NULL, 0);
    of_runs.fill = of_runs.compress = 0.0;
    of_runs.curve = NULL;
    signed char *at = dalcs_alloc(w.n + 1, sizeof *at);
    enum dalcs_status status = at != NULL ? list_all(&w) : DALCS_E_NOMEM;
    w.n_expected = 2 * (w.n + w.n_results) + (has_corners ? (size_t)1 << w.n : 0) + 1;
    if (status == DALCS_OK) {
        status = run_all(&w, at, has_corners);
    }
    if (status == DALCS_OK) {
        status = report(&w, has_corners);
    }
    free(at);
    free(w.run);
    free(w.value);
    return status;
}

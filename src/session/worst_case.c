/* worst_case.c - .wcase: runs of the circuit with its tolerances at their ends. */
#include "worst_case.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- One run ----------------------------------------------------------------------------------- */

static enum dalcs_status begin(void *user, const struct dalcs_plot *plot) {
    struct dalcs_worst_case *w = user;
    (void)plot;
    return atomic_load(&w->session->is_cancelled) ? DALCS_E_CANCELLED : DALCS_OK;
}

static enum dalcs_status row(void *user, double time, const double *value) {
    (void)user;
    (void)time;
    (void)value;
    return DALCS_OK;
}

static enum dalcs_status end(void *user) {
    (void)user;
    return DALCS_OK;
}

/* All runs together are one to whoever looks on. */
static enum dalcs_status progress(void *user, double time, double stop) {
    const struct dalcs_worst_case *w = user;
    const double done = ((double)w->n_runs + (stop > 0 ? time / stop : 0)) / (double)w->n_expected;
    return atomic_load(&w->session->is_cancelled)
               ? DALCS_E_CANCELLED
               : w->sink->progress(w->sink->user, fmin(done, 1) * stop, stop);
}

/* A session of its own for the run, which borrows the netlist: what is wrong with it is no error of the others. */
static enum dalcs_status build(const struct dalcs_worst_case *w,
                               const struct dalcs_override *corner, struct dalcs_session *other) {
    const struct dalcs_session *of = w->session;
    other->name = of->name;
    other->asks_steady = of->asks_steady;
    other->netlist = of->netlist;
    other->override = of->override;
    other->n_altered = of->n_altered;
    other->n_resets = of->n_resets;
    DALCS_TRY(dalcs_session_build(other, corner, 1, &other->circuit, &other->network));
    other->has_circuit = other->has_network = true;
    other->circuit.worst_case.present = false;
    other->circuit.periodic.present = of->circuit.periodic.present;
    return DALCS_OK;
}

/* The sentence of the first error, else the status in words. */
static const char *reason_of(struct dalcs_arena *arena, const struct dalcs_diag *diag,
                             enum dalcs_status status) {
    static const char label[] = "error: ";
    const char *reason = dalcs_status_text(status);
    for (size_t k = 0; k < diag->n; k++) {
        if (diag->item[k].severity == DALCS_ERROR) {
            const char *at = strstr(diag->item[k].text, label);
            reason = at != NULL ? at + sizeof label - 1 : diag->item[k].text;
            break;
        }
    }
    return dalcs_arena_copy(arena, reason, strcspn(reason, "\n"));
}

/* Values that tolerances are of, in this circuit, into what `at` points to in each parameter. */
static void read_values(struct dalcs_worst_case *w, const struct dalcs_circuit *circuit, int place,
                        size_t only) {
    for (size_t p = 0; p < w->n; p++) {
        struct dalcs_worst_case_parameter *parameter = &w->parameter[p];
        double *value = place < 0   ? &parameter->low
                        : place > 0 ? &parameter->high
                                    : &parameter->nominal;
        for (int k = 0; k < circuit->n_drawn && (only == w->n || p == only); k++) {
            *value = strcmp(circuit->drawn[k].name, parameter->name) == 0 ? circuit->drawn[k].value
                                                                          : *value;
        }
    }
}

/* What was measured, by name: a run that failed may have less. */
static void take_results(const struct dalcs_worst_case *w, const struct dalcs_report *report,
                         double *value) {
    for (size_t k = 0; k < w->n_results; k++) {
        value[k] = (double)NAN;
        for (size_t i = 0; i < report->n_measurements; i++) {
            const struct dalcs_measurement *m = &report->measurement[i];
            if (strcmp(m->name, w->result[k].name) == 0) {
                value[k] = m->found ? m->value : (double)NAN;
            }
        }
    }
}

static enum dalcs_status make_room(struct dalcs_worst_case *w, signed char **place,
                                   double **value) {
    struct dalcs_arena *arena = &w->session->arena;
    *place = dalcs_arena_alloc(arena, w->n + 1, sizeof **place);
    *value = dalcs_arena_alloc(arena, w->n_results + 1, sizeof **value);
    return *place == NULL || *value == NULL
               ? DALCS_E_NOMEM
               : dalcs_grow(&w->run, &w->capacity, w->n_runs + 1, sizeof *w->run);
}

/* The circuit with the tolerances there, and its run. */
static enum dalcs_status run_other(struct dalcs_worst_case *w, const signed char *place,
                                   struct dalcs_session *other) {
    const struct dalcs_sink sink = {
        .user = w, .begin = begin, .row = row, .end = end, .progress = progress};
    double *list = dalcs_alloc(w->n, sizeof *list);
    uint64_t *key = dalcs_alloc(w->n, sizeof *key);
    enum dalcs_status status = list == NULL || key == NULL ? DALCS_E_NOMEM : DALCS_OK;
    for (size_t p = 0; p < w->n && status == DALCS_OK; p++) {
        list[p] = place[p];
        key[p] = w->place[p].key;
    }
    if (status == DALCS_OK) {
        const struct dalcs_override corner = {
            .kind = DALCS_OVERRIDE_CORNER, .name = "", .list = list, .key = key, .n_list = w->n};
        status = build(w, &corner, other);
    }
    free(list);
    free(key);
    if (status == DALCS_OK) {
        status = dalcs_operating_currents(other, w->options, &sink);
    }
    return status != DALCS_OK ? status : dalcs_run_asked(other, w->options, &sink);
}

/* One that fails is told of and lost, no other. */
static enum dalcs_status run_corner(struct dalcs_worst_case *w, const signed char *at) {
    struct dalcs_session other = {0};
    signed char *place;
    double *value;
    DALCS_TRY(make_room(w, &place, &value));
    memcpy(place, at, w->n);
    enum dalcs_status status = run_other(w, place, &other);
    take_results(w, &other.report, value);
    struct dalcs_worst_case_run *run = &w->run[w->n_runs];
    *run = (struct dalcs_worst_case_run){.place = place, .value = value};
    if (status != DALCS_OK && status != DALCS_E_CANCELLED && status != DALCS_E_NOMEM) {
        run->error = reason_of(&w->session->arena, &other.diag, status);
        status = run->error != NULL ? DALCS_OK : DALCS_E_NOMEM;
        w->n_failed++;
    }
    if (other.has_circuit && w->n_runs > 0 && w->n_runs <= 2 * w->n) {
        read_values(w, &other.circuit, w->n_runs % 2 == 1 ? -1 : 1, (w->n_runs - 1) / 2);
    }
    w->n_runs++;
    dalcs_session_finish_other(&other);
    return status;
}

/* ---- All of them ------------------------------------------------------------------------------- */

static enum dalcs_status list_all(struct dalcs_worst_case *w) {
    struct dalcs_arena *arena = &w->session->arena;
    const struct dalcs_report *report = &w->session->report;
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
    read_values(w, &w->session->circuit, 0, w->n);
    for (size_t k = 0; k < w->n_results; k++) {
        w->result[k].name = report->measurement[k].name;
    }
    return DALCS_OK;
}

/* The run that the session has done already. */
static enum dalcs_status take_nominal(struct dalcs_worst_case *w) {
    signed char *place;
    double *value;
    DALCS_TRY(make_room(w, &place, &value));
    memset(place, 0, w->n + 1);
    take_results(w, &w->session->report, value);
    w->run[w->n_runs++] = (struct dalcs_worst_case_run){.place = place, .value = value};
    return DALCS_OK;
}

static enum dalcs_status run_all(struct dalcs_worst_case *w, signed char *at, bool has_corners) {
    for (size_t p = 0; p < w->n; p++) {
        for (int end = -1; end <= 1; end += 2) {
            memset(at, 0, w->n);
            at[p] = (signed char)end;
            DALCS_TRY(run_corner(w, at));
        }
    }
    for (size_t k = 0; k < w->n_results; k++) {
        dalcs_worst_case_choose(w, k, false, at);
        DALCS_TRY(run_corner(w, at));
        dalcs_worst_case_choose(w, k, true, at);
        DALCS_TRY(run_corner(w, at));
    }
    for (size_t corner = 0; has_corners && corner < (size_t)1 << w->n; corner++) {
        for (size_t p = 0; p < w->n; p++) {
            at[p] = (signed char)((corner >> p & 1) != 0 ? 1 : -1);
        }
        DALCS_TRY(run_corner(w, at));
    }
    return DALCS_OK;
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
        dalcs_arena_alloc(&s->arena, w->n_runs, sizeof *run); /* lives as long as the report */
    if (run == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(run, w->run, w->n_runs * sizeof *run);
    DALCS_TRY(fill_alone(w));
    dalcs_worst_case_judge(w);
    s->report.worst_case.present = true;
    s->report.worst_case.has_corners = has_corners;
    s->report.worst_case.n_parameters = w->n;
    s->report.worst_case.n_results = w->n_results;
    s->report.worst_case.n_runs = w->n_runs;
    s->report.worst_case.n_failed = w->n_failed;
    s->report.worst_case.parameter = w->parameter;
    s->report.worst_case.result = w->result;
    s->report.worst_case.run = run;
    return DALCS_OK;
}

enum dalcs_status dalcs_worst_case_run(struct dalcs_session *session,
                                       const struct dalcs_run_options *options,
                                       const struct dalcs_sink *sink) {
    const struct dalcs_worst_case_card *card = &session->circuit.worst_case;
    struct dalcs_run_options of_runs = *options;
    struct dalcs_worst_case w = {.session = session,
                                 .options = &of_runs,
                                 .sink = sink,
                                 .place = card->place,
                                 .n = (size_t)card->n};
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
        status = take_nominal(&w);
    }
    if (status == DALCS_OK) {
        status = run_all(&w, at, has_corners);
    }
    if (status == DALCS_OK) {
        status = report(&w, has_corners);
    }
    free(at);
    free(w.run);
    return status;
}

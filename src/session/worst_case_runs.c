/* worst_case_runs.c - the runs of .wcase: each in a session of its own, in several threads.
 *
 * What a run gives does not depend on who makes it. Callbacks of the caller come in its own thread. */
#include "worst_case.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_THREADS = 256 };

/* ---- One run ----------------------------------------------------------------------------------- */

struct worker {
    struct dalcs_worst_case *w;
    bool is_caller; /* the thread in which the session was told to run */
};

static enum dalcs_status look(const struct dalcs_worst_case *w) {
    const bool ends = atomic_load(&w->ended) || atomic_load(&w->session->is_cancelled);
    return ends ? DALCS_E_CANCELLED : DALCS_OK;
}

static enum dalcs_status begin(void *user, const struct dalcs_plot *plot) {
    const struct worker *worker = user;
    (void)plot;
    return look(worker->w);
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

/* Progress is reported for all runs together. */
static enum dalcs_status progress(void *user, double time, double stop) {
    const struct worker *worker = user;
    const struct dalcs_worst_case *w = worker->w;
    DALCS_TRY(look(w));
    if (!worker->is_caller) {
        return DALCS_OK;
    }
    const double n_done = (double)atomic_load(&w->n_over);
    const double done = (n_done + (stop > 0 ? time / stop : 0)) / (double)w->n_expected;
    return w->sink->progress(w->sink->user, fmin(done, 1) * stop, stop);
}

/* A session of its own for the run, which borrows the netlist: what is wrong with it is no error of the others. */
static enum dalcs_status build(const struct dalcs_worst_case *w,
                               const struct dalcs_override *corner, struct dalcs_session *other) {
    const struct dalcs_session *of = w->session;
    other->name = of->name;
    other->asks.steady = of->asks.steady;
    other->source.netlist = of->source.netlist;
    other->source.override = of->source.override;
    other->source.n_altered = of->source.n_altered;
    other->source.n_resets = of->source.n_resets;
    DALCS_TRY(dalcs_session_build(other, corner, 1, &other->circuit, &other->network));
    other->has_circuit = other->has_network = true;
    other->circuit.analyses.worst_case.present = false;
    other->circuit.analyses.periodic.present = of->circuit.analyses.periodic.present;
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

void dalcs_worst_case_read(struct dalcs_worst_case *w, const struct dalcs_circuit *circuit,
                           int place, size_t only) {
    for (size_t p = 0; p < w->n; p++) {
        struct dalcs_worst_case_parameter *parameter = &w->parameter[p];
        double *value = place < 0   ? &parameter->low
                        : place > 0 ? &parameter->high
                                    : &parameter->nominal;
        for (int k = 0; k < circuit->random.n_drawn && (only == w->n || p == only); k++) {
            *value = strcmp(circuit->random.drawn[k].name, parameter->name) == 0
                         ? circuit->random.drawn[k].value
                         : *value;
        }
    }
}

void dalcs_worst_case_take(struct dalcs_worst_case *w, const struct dalcs_report *report,
                           size_t run) {
    double *value = w->value[run];
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

/* The circuit with the tolerances there, and its run. */
static enum dalcs_status run_other(struct worker *worker, const signed char *place,
                                   struct dalcs_session *other) {
    struct dalcs_worst_case *w = worker->w;
    const struct dalcs_sink sink = {
        .user = worker, .begin = begin, .row = row, .end = end, .progress = progress};
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

/* A run that fails is reported; the others go on. */
static enum dalcs_status run_one(struct worker *worker, size_t k) {
    struct dalcs_worst_case *w = worker->w;
    struct dalcs_worst_case_run *run = &w->run[k];
    struct dalcs_session other = {0};
    enum dalcs_status status = run_other(worker, run->place, &other);
    dalcs_worst_case_take(w, &other.results.report, k);
    if (status != DALCS_OK && status != DALCS_E_CANCELLED && status != DALCS_E_NOMEM) {
        pthread_mutex_lock(&w->lock); /* of the arena */
        run->error = reason_of(&w->session->arena, &other.diag, status);
        w->n_failed++;
        pthread_mutex_unlock(&w->lock);
        status = run->error != NULL ? DALCS_OK : DALCS_E_NOMEM;
    }
    if (other.has_circuit && k > 0 && k <= 2 * w->n) {
        dalcs_worst_case_read(w, &other.circuit, k % 2 == 1 ? -1 : 1, (k - 1) / 2);
    }
    dalcs_session_finish_other(&other);
    return status;
}

/* ---- All of them ------------------------------------------------------------------------------- */

enum dalcs_status dalcs_worst_case_add(struct dalcs_worst_case *w, const signed char *at) {
    struct dalcs_arena *arena = &w->session->arena;
    signed char *place = dalcs_arena_alloc(arena, w->n + 1, sizeof *place);
    double *value = dalcs_arena_alloc(arena, w->n_results + 1, sizeof *value);
    if (place == NULL || value == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_grow(&w->run, &w->capacity, w->n_runs + 1, sizeof *w->run));
    DALCS_TRY(dalcs_grow(&w->value, &w->value_capacity, w->n_runs + 1, sizeof *w->value));
    memcpy(place, at, w->n);
    w->value[w->n_runs] = value;
    w->run[w->n_runs++] = (struct dalcs_worst_case_run){.place = place, .value = value};
    return DALCS_OK;
}

static void take_runs(struct worker *worker) {
    struct dalcs_worst_case *w = worker->w;
    for (size_t k = atomic_fetch_add(&w->next, 1); k < w->n_runs && look(w) == DALCS_OK;
         k = atomic_fetch_add(&w->next, 1)) {
        const enum dalcs_status status = run_one(worker, k);
        atomic_fetch_add(&w->n_over, 1);
        if (status != DALCS_OK) {
            pthread_mutex_lock(&w->lock);
            const bool is_first = !atomic_load(&w->ended);
            w->status = is_first ? status : w->status;
            atomic_store(&w->ended, true);
            pthread_mutex_unlock(&w->lock);
        }
    }
}

static void *work(void *user) {
    take_runs(&(struct worker){.w = user});
    return NULL;
}

enum dalcs_status dalcs_worst_case_run_added(struct dalcs_worst_case *w) {
    pthread_t thread[MOST_THREADS];
    size_t n_started = 0;
    const size_t n_due = w->n_runs - w->n_done;
    const size_t n_wanted = w->options->workers < MOST_THREADS ? w->options->workers : MOST_THREADS;
    atomic_store(&w->next, w->n_done);
    atomic_store(&w->n_over, w->n_done);
    while (n_started + 1 < n_wanted && n_started + 1 < n_due &&
           pthread_create(&thread[n_started], NULL, work, w) == 0) {
        n_started++;
    }
    take_runs(&(struct worker){.w = w, .is_caller = true}); /* this thread, too */
    for (size_t k = 0; k < n_started; k++) {
        pthread_join(thread[k], NULL);
    }
    w->n_done = w->n_runs;
    return w->status != DALCS_OK ? w->status : look(w);
}

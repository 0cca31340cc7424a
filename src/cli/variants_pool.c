/* variants_pool.c - threads that take the next step until there is none.
 *
 * What a step gives does not depend on who runs it, and a session that has failed is not used again. */
#include "variants_pool.h"

#include "csv_cells.h"
#include "diag.h"
#include "memory.h"
#include "settings.h"
#include "verb.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* Steps that may be done before the one that is waited for, for each thread; steps of one session, whose names and
 * messages grow with each. */
enum { AHEAD = 64, MOST_OF_A_SESSION = 256, LEAST_WIDTH = 11 };

/* Steps that a thread takes one after the other: steady states are looked for from one that is near (steady_anchor.c). */
enum { MOST_IN_A_ROW = 8 };

struct crew {
    const struct dalcs_variants_pool *pool;
    pthread_mutex_t lock;
    pthread_cond_t moved;       /* taken has */
    size_t next, taken;         /* steps */
    struct dalcs_variant *slot; /* [n_slots] of step k: k modulo n_slots */
    size_t n_slots;
    size_t in_a_row;          /* that a thread takes at once, up to a multiple of MOST_IN_A_ROW */
    enum dalcs_status status; /* not DALCS_OK: all stop */
};

/* ---- One step -------------------------------------------------------------------------------- */

static enum dalcs_status look(const struct crew *crew) {
    return *crew->pool->cli->interrupted ? DALCS_E_CANCELLED : DALCS_OK;
}

static enum dalcs_status begin(void *crew, const struct dalcs_plot *plot) {
    (void)plot;
    return look(crew);
}

static enum dalcs_status progress(void *crew, double time, double stop) {
    (void)time;
    (void)stop;
    return look(crew);
}

int dalcs_variant_width(const char *name) {
    const int length = (int)strlen(name);
    return length > LEAST_WIDTH ? length : LEAST_WIDTH;
}

static void write_begin(const struct dalcs_variants_pool *pool, size_t step,
                        struct dalcs_csv_cells *cells) {
    for (size_t k = 0; k < pool->arguments->n_set; k++) {
        size_t length;
        dalcs_csv_number(cells, dalcs_settings_value(pool->arguments->set[k], &length));
    }
    double value;
    for (size_t k = 0; dalcs_session_step_parameter(pool->session, step, k, &value) != NULL; k++) {
        dalcs_csv_number(cells, value);
    }
}

char *dalcs_variant_begin(const struct dalcs_variants_pool *pool, size_t step) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (out == NULL) {
        return NULL;
    }
    struct dalcs_csv_cells cells = {.out = out, .decimal = pool->decimal};
    if (step < pool->end) {
        write_begin(pool, step, &cells);
        dalcs_csv_text(&cells, "", 0);
    }
    if (fclose(out) != 0) {
        free(text);
        return NULL;
    }
    return text;
}

/* NAN: there is none. */
static double measured(const struct dalcs_session *session, const char *name, size_t at) {
    const struct dalcs_measurement *m = dalcs_session_measurement(session, at);
    for (size_t k = 0; m == NULL || strcmp(m->name, name) != 0; k++) {
        m = dalcs_session_measurement(session, k);
        if (m == NULL) {
            return NAN;
        }
    }
    return m->found ? m->value : (double)NAN;
}

/* The same of a random value; in nearly all netlists all steps draw the same ones. */
static double drawn(const struct dalcs_session *session, const char *name, size_t at) {
    double value;
    const char *found = dalcs_session_drawn(session, at, &value);
    for (size_t k = 0; found != NULL && strcmp(found, name) != 0; k++) {
        found = dalcs_session_drawn(session, k, &value);
    }
    return found != NULL ? value : (double)NAN;
}

/* The sentence of the first error since message `first`, else the status in words. */
static void find_reason(const struct dalcs_session *session, size_t first, enum dalcs_status status,
                        const char **reason, size_t *length) {
    enum dalcs_level level;
    const char *said = dalcs_status_text(status);
    for (size_t k = first; k < dalcs_session_n_messages(session); k++) {
        const char *text = dalcs_session_message(session, k, &level);
        if (level == DALCS_LEVEL_ERROR) {
            said = text;
            break;
        }
    }
    *reason = dalcs_diag_sentence(said, length);
}

/* session: NULL: it crashed, and nothing is known of the step. */
static void write_values(const struct crew *crew, const struct dalcs_session *session, size_t step,
                         struct dalcs_csv_cells *cells, FILE *line, double *values) {
    const struct dalcs_session *whole = crew->pool->session;
    const char *name;
    double value;
    write_begin(crew->pool, step, cells);
    fputc(' ', line);
    for (size_t k = 0; (name = dalcs_session_step_parameter(whole, step, k, &value)) != NULL; k++) {
        fprintf(line, " %*.6g", dalcs_variant_width(name), value);
    }
    for (size_t k = 0; (name = dalcs_session_drawn(whole, k, &value)) != NULL; k++) {
        dalcs_csv_number(cells, session != NULL ? drawn(session, name, k) : (double)NAN);
    }
    for (size_t k = 0; (name = dalcs_session_measure_name(whole, k)) != NULL; k++) {
        value = values[k] = session != NULL ? measured(session, name, k) : (double)NAN;
        dalcs_csv_number(cells, value);
        fprintf(line, " %*.6g", dalcs_variant_width(name), value);
    }
}

static void write_warnings(const struct dalcs_session *session, size_t first, FILE *out) {
    enum dalcs_level level;
    for (size_t k = first; session != NULL && k < dalcs_session_n_messages(session); k++) {
        const char *text = dalcs_session_message(session, k, &level);
        if (level == DALCS_LEVEL_WARNING) {
            fwrite(text, 1, strlen(text) + 1, out);
        }
    }
    fputc('\0', out);
}

static void finish_variant(struct dalcs_variant *v) {
    free(v->row);
    free(v->line);
    free(v->warnings);
    free(v->value);
    *v = (struct dalcs_variant){0};
}

/* What the step gave, with a reason, "" where it went well. */
static enum dalcs_status write_variant(const struct crew *crew, const struct dalcs_session *session,
                                       size_t step, size_t first, const char *reason, size_t length,
                                       struct dalcs_variant *v) {
    size_t size[3];
    FILE *row = open_memstream(&v->row, &size[0]);
    FILE *line = open_memstream(&v->line, &size[1]);
    FILE *warnings = open_memstream(&v->warnings, &size[2]);
    v->value = dalcs_alloc(crew->pool->n_measures, sizeof *v->value);
    if (row != NULL && line != NULL && warnings != NULL && v->value != NULL) {
        struct dalcs_csv_cells cells = {.out = row, .decimal = crew->pool->decimal};
        write_values(crew, session, step, &cells, line, v->value);
        dalcs_csv_text(&cells, reason, length);
        dalcs_csv_end(&cells);
        fprintf(line, "%s%.*s", length > 0 ? "  " : "", (int)length, reason);
        write_warnings(session, first, warnings);
        v->failed = length > 0;
    }
    bool complete = row != NULL && line != NULL && warnings != NULL && v->value != NULL;
    FILE *const file[] = {row, line, warnings};
    for (size_t k = 0; k < sizeof file / sizeof file[0]; k++) {
        complete = (file[k] == NULL || fclose(file[k]) == 0) && complete;
    }
    if (!complete) {
        finish_variant(v);
    }
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

/* ---- Threads --------------------------------------------------------------------------------- */

struct worker {
    struct crew *crew;
    struct dalcs_session *session; /* NULL: a new one is due */
    size_t n_run;                  /* of it */
};

static enum dalcs_status open_session(struct worker *w) {
    const struct dalcs_arguments *arguments = w->crew->pool->arguments;
    if (w->session != NULL && w->n_run < MOST_OF_A_SESSION) {
        return DALCS_OK;
    }
    dalcs_session_destroy(w->session);
    w->session = NULL;
    w->n_run = 0;
    DALCS_TRY(dalcs_session_create(&w->session));
    DALCS_TRY(dalcs_settings_prepare(w->session, arguments));
    DALCS_TRY(dalcs_verb_read(w->session, arguments->netlist, arguments->dialect));
    return dalcs_settings_apply(w->session, arguments);
}

static enum dalcs_status run_step(struct worker *w, size_t step, struct dalcs_variant *v) {
    struct crew *crew = w->crew;
    DALCS_TRY(open_session(w));
    struct dalcs_run_options options = *crew->pool->options;
    options.only_step = step + 1;
    const struct dalcs_sink sink = {.user = crew, .begin = begin, .progress = progress};
    const size_t first = dalcs_session_n_messages(w->session);
    w->n_run++;
    const enum dalcs_status status = dalcs_session_run(w->session, &options, &sink);
    if (status == DALCS_E_CANCELLED) {
        return status;
    }
    const char *reason = "";
    size_t length = 0;
    if (status != DALCS_OK) {
        find_reason(w->session, first, status, &reason, &length);
    }
    DALCS_TRY(write_variant(crew, w->session, step, first, reason, length, v));
    w->n_run = status == DALCS_OK ? w->n_run : MOST_OF_A_SESSION;
    return DALCS_OK;
}

/* One that has crashed is not run again. */
static enum dalcs_status run_or_tell(struct worker *w, size_t step, struct dalcs_variant *v) {
    const int crash = dalcs_crashes_find(w->crew->pool->crashes, step);
    if (crash != 0) {
        char reason[96];
        snprintf(reason, sizeof reason, "the program crashed here: %s", strsignal(crash));
        return write_variant(w->crew, NULL, step, 0, reason, strlen(reason), v);
    }
    dalcs_crashes_begin(step);
    const enum dalcs_status status = run_step(w, step, v);
    dalcs_crashes_end();
    return status;
}

/* All that are done and next; under the lock. */
static void take_ready(struct crew *crew) {
    while (crew->status == DALCS_OK) {
        struct dalcs_variant *v = &crew->slot[crew->taken % crew->n_slots];
        if (v->row == NULL) {
            break;
        }
        crew->status = crew->pool->take(crew->pool->user, v);
        finish_variant(v);
        crew->taken++;
    }
    pthread_cond_broadcast(&crew->moved);
}

/* Behind the last one of those that a thread takes from `first` on. */
static size_t end_of_row(const struct crew *crew, size_t first) {
    const size_t stretch = first - first % MOST_IN_A_ROW + MOST_IN_A_ROW;
    size_t end = first + crew->in_a_row < stretch ? first + crew->in_a_row : stretch;
    return end < crew->pool->end ? end : crew->pool->end;
}

static void *work(void *user) {
    struct worker w = {.crew = user};
    struct crew *crew = w.crew;
    dalcs_crashes_enter_thread();
    pthread_mutex_lock(&crew->lock);
    for (;;) {
        while (crew->status == DALCS_OK && crew->next < crew->pool->end &&
               crew->next >= crew->taken + crew->n_slots) {
            pthread_cond_wait(&crew->moved, &crew->lock);
        }
        if (crew->status != DALCS_OK || crew->next >= crew->pool->end) {
            break;
        }
        const size_t first = crew->next;
        crew->next = end_of_row(crew, first);
        const size_t end = crew->next;
        for (size_t step = first; step < end && crew->status == DALCS_OK; step++) {
            pthread_mutex_unlock(&crew->lock);
            struct dalcs_variant v = {0};
            enum dalcs_status status = look(crew);
            status = status == DALCS_OK ? run_or_tell(&w, step, &v) : status;
            pthread_mutex_lock(&crew->lock);
            crew->slot[step % crew->n_slots] = v;
            crew->status = crew->status == DALCS_OK ? status : crew->status;
            take_ready(crew);
        }
    }
    pthread_mutex_unlock(&crew->lock);
    dalcs_crashes_leave_thread();
    dalcs_session_destroy(w.session);
    return NULL;
}

static size_t count_threads(const struct dalcs_variants_pool *pool) {
    const size_t n = dalcs_settings_threads(pool->arguments);
    const size_t steps = pool->end - pool->first;
    return n < steps ? n : steps;
}

/* As many as leave work for all; one, unless there is an orbit to start from. */
static size_t count_in_a_row(const struct dalcs_variants_pool *pool, size_t n_threads) {
    const size_t share = (pool->end - pool->first) / (2 * n_threads);
    const bool pays = dalcs_session_request(pool->session).periodic;
    return !pays || share < 1 ? 1 : share < MOST_IN_A_ROW ? share : MOST_IN_A_ROW;
}

enum dalcs_status dalcs_variants_pool_run(const struct dalcs_variants_pool *pool) {
    const size_t n = count_threads(pool);
    struct crew crew = {.pool = pool,
                        .lock = PTHREAD_MUTEX_INITIALIZER,
                        .moved = PTHREAD_COND_INITIALIZER,
                        .next = pool->first,
                        .taken = pool->first,
                        .n_slots = AHEAD * (n + 1),
                        .in_a_row = count_in_a_row(pool, n)};
    pthread_t *thread = dalcs_alloc(n, sizeof *thread);
    crew.slot = dalcs_alloc(crew.n_slots, sizeof *crew.slot);
    size_t n_started = 0;
    if (thread != NULL && crew.slot != NULL) {
        while (n_started + 1 < n && pthread_create(&thread[n_started], NULL, work, &crew) == 0) {
            n_started++;
        }
        work(&crew); /* this thread, too */
        for (size_t k = 0; k < n_started; k++) {
            pthread_join(thread[k], NULL);
        }
    } else {
        crew.status = DALCS_E_NOMEM;
    }
    for (size_t k = 0; crew.slot != NULL && k < crew.n_slots; k++) {
        finish_variant(&crew.slot[k]);
    }
    free(thread);
    free(crew.slot);
    return crew.status;
}

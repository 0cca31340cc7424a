/* receive.c - a sink that fills plots and calls the callbacks of the program. */
#include "library.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

/* ---- Progress ------------------------------------------------------------------------------------- */

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void send_status(struct ng_library *l, const char *text) {
    char copy[64];
    ng_send_status *send = l->tell.status;
    if (send != NULL) {
        snprintf(copy, sizeof copy, "%s", text);
        send(copy, l->talk.id, l->talk.user);
    }
}

static enum dalcs_status progress(void *user, double time, double stop) {
    static const double often = 0.15; /* s; as ngspice */
    struct ng_library *l = user;
    const double at = l->tell.status != NULL ? now() : 0.0;
    if (at > l->told + often && stop > 0.0) {
        char text[64];
        l->told = at;
        snprintf(text, sizeof text, "%s: %.1f%%",
                 ng_plots_current(&l->plots)->analysis == DALCS_TRANSIENT ? "tran" : "sweep",
                 100.0 * time / stop);
        send_status(l, text);
    }
    return ng_background_pause(&l->background);
}

static void after_run(void *user, struct dalcs_session *session, enum dalcs_status status) {
    struct ng_library *l = user;
    const struct dalcs_report *report = dalcs_session_report(session);
    const char *out = "%-20s=  %.9e";
    for (size_t k = 0; status == DALCS_OK && report != NULL && k < report->n_measurements; k++) {
        const struct dalcs_measurement *m = &report->measurement[k];
        fprintf(l->talk.out, m->found ? out : "%-20s=  failed", m->name, m->value);
        for (int i = 0; m->found && i < m->n_details; i++) {
            fprintf(l->talk.out, " %s=  %.9e", m->detail[i].name, m->detail[i].value);
        }
        fputc('\n', l->talk.out);
    }
    send_status(l, "--ready--");
}

/* ---- A plot begins -------------------------------------------------------------------------------- */

static void forget_sent(struct ng_sent_row *sent) {
    free(sent->value);
    free(sent->pointer);
    *sent = (struct ng_sent_row){0};
}

/* The structure that SendData gets for each row. */
static enum dalcs_status prepare_rows(struct ng_library *l, const struct ng_plot *plot) {
    struct ng_sent_row *sent = &l->sent;
    forget_sent(sent);
    sent->value = dalcs_alloc(plot->n, sizeof *sent->value);
    sent->pointer = dalcs_alloc(plot->n, sizeof(struct ng_value *));
    if (sent->value == NULL || sent->pointer == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < plot->n; k++) {
        sent->pointer[k] = &sent->value[k];
        sent->value[k] = (struct ng_value){.name = plot->vector[k]->name,
                                           .is_scale = plot->has_scale && k == 0,
                                           .is_complex = plot->vector[k]->is_complex};
    }
    sent->row = (struct ng_row){.n = (int)plot->n, .value = sent->pointer};
    return DALCS_OK;
}

static enum dalcs_status announce(struct ng_library *l, struct ng_plot *plot) {
    struct ng_announced *vector = dalcs_alloc(plot->n, sizeof *vector);
    struct ng_announced **pointer = dalcs_alloc(plot->n, sizeof(struct ng_announced *));
    const enum dalcs_status status = vector != NULL && pointer != NULL ? DALCS_OK : DALCS_E_NOMEM;
    for (size_t k = 0; status == DALCS_OK && k < plot->n; k++) {
        pointer[k] = &vector[k];
        vector[k] = (struct ng_announced){.number = (int)k,
                                          .name = plot->vector[k]->name,
                                          .is_real = !plot->vector[k]->is_complex,
                                          .vector = plot->vector[k],
                                          .scale = plot->has_scale ? plot->vector[0] : NULL};
    }
    ng_send_init_data *send = l->tell.init_data;
    if (status == DALCS_OK && send != NULL) {
        char kind[64];
        snprintf(kind, sizeof kind, "%s", plot->kind);
        send(&(struct ng_announcement){.name = kind,
                                       .title = plot->title,
                                       .date = plot->date,
                                       .type = plot->type,
                                       .n = (int)plot->n,
                                       .vector = pointer},
             l->talk.id, l->talk.user);
    }
    free(vector);
    free(pointer);
    return status;
}

static enum dalcs_status begin(void *user, const struct dalcs_plot *about) {
    struct ng_library *l = user;
    DALCS_TRY(ng_plots_begin(&l->plots, about));
    struct ng_plot *plot = ng_plots_current(&l->plots);
    const struct dalcs_request asked = dalcs_session_request(l->host.session);
    plot->grid = about->analysis == DALCS_TRANSIENT
                     ? (struct dalcs_grid){asked.start, asked.step, asked.stop}
                     : (struct dalcs_grid){0};
    if (l->tell.data != NULL) {
        DALCS_TRY(prepare_rows(l, plot));
    }
    return l->tell.init_data != NULL ? announce(l, plot) : DALCS_OK;
}

/* ---- Rows ------------------------------------------------------------------------------------------ */

static void send_row(struct ng_library *l, double scale, const double *value) {
    const struct ng_plot *plot = ng_plots_current(&l->plots);
    const size_t first = plot->has_scale ? 1 : 0;
    for (size_t k = 0; k < plot->n; k++) {
        struct ng_value *v = &l->sent.value[k];
        const bool is_scale = k < first;
        v->re = is_scale ? scale : *value++;
        v->im = !is_scale && v->is_complex ? *value++ : 0.0;
    }
    ng_send_data *send = l->tell.data;
    if (send != NULL) {
        send(&l->sent.row, l->sent.row.n, l->talk.id, l->talk.user);
    }
    l->sent.row.index++;
}

static enum dalcs_status rows(void *user, size_t n, const double *time, const double *value) {
    struct ng_library *l = user;
    DALCS_TRY(ng_plots_add_rows(&l->plots, n, time, value));
    return ng_background_pause(&l->background);
}

static enum dalcs_status row(void *user, double scale, const double *value) {
    struct ng_library *l = user;
    DALCS_TRY(ng_plots_add_rows(&l->plots, 1, &scale, value));
    if (l->tell.data != NULL) {
        send_row(l, scale, value);
    }
    return ng_background_pause(&l->background);
}

void ng_receive_open(struct ng_library *l) {
    l->sink = (struct dalcs_sink){.user = l,
                                  .begin = begin,
                                  .row = row,
                                  .progress = progress,
                                  .rows = l->tell.data == NULL ? rows : NULL};
    l->host.after_run = after_run;
}

void ng_receive_close(struct ng_library *l) {
    forget_sent(&l->sent);
}

/* run_command.c - tran, op, dc, ac, run, and what all of them shall save. */
#include "names.h"
#include "script_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void dalcs_script_name_plot(struct dalcs_script *script) {
    const struct dalcs_script_host *host = script->host;
    struct dalcs_plot_vectors *plot = script->vectors.current;
    if (host->name_of_plot != NULL && plot != NULL) {
        snprintf(plot->type, sizeof plot->type, "%.31s", host->name_of_plot(host->user));
    }
}

static enum dalcs_status begin(void *user, const struct dalcs_plot *plot) {
    struct dalcs_script *script = user;
    const struct dalcs_sink *sink = script->host->sink;
    enum dalcs_status status = dalcs_vectors_begin(&script->vectors, plot);
    script->n_signals = plot->n_signals;
    status = status == DALCS_OK && sink->begin != NULL ? sink->begin(sink->user, plot) : status;
    if (status == DALCS_OK) {
        dalcs_script_name_plot(script);
    }
    return status;
}

static enum dalcs_status row(void *user, double time, const double *value) {
    struct dalcs_script *script = user;
    const struct dalcs_sink *sink = script->host->sink;
    enum dalcs_status status = dalcs_vectors_row(&script->vectors, time, value);
    return status == DALCS_OK && sink->row != NULL ? sink->row(sink->user, time, value) : status;
}

static enum dalcs_status rows(void *user, size_t n, const double *time, const double *value) {
    struct dalcs_script *script = user;
    const struct dalcs_sink *sink = script->host->sink;
    enum dalcs_status status = DALCS_OK;
    for (size_t k = 0; k < n && status == DALCS_OK; k++) {
        status = dalcs_vectors_row(&script->vectors, time[k], value + k * script->n_signals);
    }
    return status == DALCS_OK ? sink->rows(sink->user, n, time, value) : status;
}

static enum dalcs_status end(void *user) {
    const struct dalcs_script *script = user;
    const struct dalcs_sink *sink = script->host->sink;
    return sink->end != NULL ? sink->end(sink->user) : DALCS_OK;
}

static enum dalcs_status progress(void *user, double time, double stop) {
    const struct dalcs_script *script = user;
    const struct dalcs_sink *sink = script->host->sink;
    return sink->progress != NULL ? sink->progress(sink->user, time, stop) : DALCS_OK;
}

enum dalcs_status dalcs_script_add_card(struct dalcs_script *script,
                                        const struct dalcs_statement *s, const char *word,
                                        const char *rest) {
    enum dalcs_status status = dalcs_grow(&script->card, &script->card_capacity,
                                          script->n_cards + 1, sizeof *script->card);
    const char *text = dalcs_arena_printf(&script->kept, "%s %s", word, rest);
    if (status != DALCS_OK || text == NULL) {
        return DALCS_E_NOMEM;
    }
    script->card[script->n_cards++] = (struct dalcs_extra_card){s->line, text};
    return DALCS_OK;
}

static enum dalcs_status keep_number(struct dalcs_script *script, const char *name, double number) {
    double complex value = number;
    return dalcs_vectors_let(
        &script->vectors, name,
        &(struct dalcs_vector){.name = "", .unit = DALCS_UNIT_NONE, .n = 1, .value = &value});
}

/* ngspice's vectors of a Fourier analysis: fourier11 has frequencies, then magnitudes, then phases. */
static enum dalcs_status keep_fourier(struct dalcs_script *script, size_t number,
                                      const struct dalcs_fourier *f) {
    char name[2][32];
    const size_t n = f->n_harmonics;
    struct dalcs_vector v = {.name = "", .unit = DALCS_UNIT_NONE, .n = 3 * n};
    v.value = dalcs_arena_alloc(&script->arena, v.n, sizeof *v.value);
    if (v.value == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        v.value[k] = f->frequency * (double)k;
        v.value[n + k] = f->magnitude[k];
        v.value[2 * n + k] = f->phase[k];
    }
    snprintf(name[0], sizeof name[0], "fourier1%zu", number);
    snprintf(name[1], sizeof name[1], "thd1%zu", number);
    DALCS_TRY(dalcs_vectors_let(&script->vectors, name[0], &v));
    return isfinite(f->thd) ? keep_number(script, name[1], 100.0 * f->thd) : DALCS_OK;
}

/* As in ngspice, what was measured is a vector of the run. */
static enum dalcs_status keep_measured(struct dalcs_script *script) {
    const struct dalcs_report *report = dalcs_session_report(script->host->session);
    for (size_t k = 0; report != NULL && k < report->n_measurements; k++) {
        const struct dalcs_measurement *m = &report->measurement[k];
        if (m->found) {
            DALCS_TRY(keep_number(script, m->name, m->value));
        }
    }
    for (size_t k = 0; report != NULL && k < report->n_fourier; k++) {
        DALCS_TRY(keep_fourier(script, k + 1, &report->fourier[k]));
    }
    return DALCS_OK;
}

/* The sink of a run. */
static struct dalcs_sink sink_of(struct dalcs_script *script) {
    return (struct dalcs_sink){.user = script,
                               .begin = begin,
                               .row = row,
                               .end = end,
                               .progress = progress,
                               .rows = script->host->sink->rows != NULL ? rows : NULL};
}

/* What follows a run while the session has its report. */
static enum dalcs_status end_run(struct dalcs_script *script, enum dalcs_status status) {
    const struct dalcs_script_host *host = script->host;
    if (host->after_run != NULL) {
        host->after_run(host->user, host->session, status);
    }
    return status == DALCS_OK ? keep_measured(script) : status;
}

static enum dalcs_status run_session(struct dalcs_script *script) {
    const struct dalcs_script_host *host = script->host;
    const struct dalcs_sink sink = sink_of(script);
    return end_run(script, dalcs_session_run_cards(host->session, script->card, script->n_cards,
                                                   host->options, &sink));
}

/* The netlist's analyses, those of a kind that it has already one of last. Measurements are of the first. */
static enum dalcs_status run_netlist(struct dalcs_script *script, size_t n_kept) {
    const struct dalcs_script_host *host = script->host;
    const struct dalcs_sink sink = sink_of(script);
    const size_t n = dalcs_session_n_second_analyses(host->session);
    DALCS_TRY(run_session(script));
    for (size_t k = 0; k < n; k++) {
        DALCS_TRY(end_run(script, dalcs_session_run_second(host->session, k, script->card, n_kept,
                                                           host->options, &sink)));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_script_run_analysis(struct dalcs_script *script, size_t index) {
    const struct dalcs_statement *s = &script->statements.statement[index];
    const size_t n_kept = script->n_cards;
    const char *rest;
    enum dalcs_status status = dalcs_script_expand(script, s, &rest);
    if (strcmp(s->word, "run") != 0) {
        status = status == DALCS_OK ? dalcs_script_add_card(script, s, s->word, rest) : status;
    } else if (status == DALCS_OK && !script->has_cards) {
        return dalcs_script_refuse(script, s, "add a line before .control such as: .tran 10u 20m",
                                   "run: the netlist has no analysis");
    }
    status = status == DALCS_OK ? dalcs_script_add_measurements(script, index + 1) : status;
    script->has_run = true;
    if (status == DALCS_OK) {
        const bool is_netlist = strcmp(s->word, "run") == 0;
        status = is_netlist ? run_netlist(script, n_kept) : run_session(script);
    }
    script->n_cards = n_kept;
    return status;
}

enum dalcs_status dalcs_script_run_cards(struct dalcs_script *script) {
    enum dalcs_status status =
        script->has_cards ? dalcs_script_add_measurements(script, 0) : DALCS_OK;
    status = status == DALCS_OK && script->has_cards ? run_netlist(script, 0) : status;
    script->n_cards = 0;
    return status;
}

/* `save @r1[i] v(out)`: other names for what .save calls i(r1). */
enum dalcs_status dalcs_script_save(struct dalcs_script *script, const struct dalcs_statement *s) {
    const char *rest;
    enum dalcs_status status = dalcs_script_expand_low(script, s, &rest);
    if (status != DALCS_OK) {
        return status;
    }
    if (s->word[0] == 'o') {
        return dalcs_script_add_card(script, s, "options", rest);
    }
    const char *text = "";
    for (const char *word; text != NULL && (word = dalcs_script_word(script, &rest)) != NULL;) {
        const int n = (int)dalcs_names_current_of(word);
        text = n > 0 ? dalcs_arena_printf(&script->arena, "%s i(%.*s)", text, n, word + 1)
                     : dalcs_arena_printf(&script->arena, "%s %s", text, word);
    }
    return text != NULL ? dalcs_script_add_card(script, s, "save", text) : DALCS_E_NOMEM;
}

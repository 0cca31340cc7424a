/* nonunique.c - what is not determined, in words and in the report. */
#include "session_internal.h"

#include <math.h>
#include <stdlib.h>

/* Signals in a message, those of them with intervals, and in a note; signals in the report. */
enum { MOST_NAMED = 12, MOST_TOLD = 3, MOST_NOTED = 1, MOST_REPORTED = 1000 };

/* Messages of each kind: what is so by design, as in each MOSFET, is said once. */
static const int MOST_MESSAGES[] = {
    [DALCS_OPEN_CURRENTS] = 50, [DALCS_OPEN_VOLTAGES] = 3, [DALCS_SHUNTED_SWITCHES] = 1};

static const char *unit_of(const struct dalcs_run *r, int output) {
    return r->s->network.output[output].is_current ? "A" : "V";
}

/* "i(d1) may be anything from 0 A to 0.005 A, and 0.0025 A is taken" */
static const char *say_interval(struct dalcs_run *r, const struct dalcs_open_signal *s,
                                bool anything) {
    struct dalcs_arena *arena = &r->s->arena;
    const char *name = r->signals.name[s->output];
    const char *unit = unit_of(r, s->output);
    if (isinf(s->lower) && isinf(s->upper)) {
        return dalcs_arena_printf(arena, "%s may be anything, and %.6g %s is taken", name, s->value,
                                  unit);
    }
    if (isinf(s->lower) || isinf(s->upper)) {
        return dalcs_arena_printf(arena, "%s may be %.6g %s or %s, and %.6g %s is taken", name,
                                  isinf(s->lower) ? s->upper : s->lower, unit,
                                  isinf(s->lower) ? "less" : "more", s->value, unit);
    }
    return dalcs_arena_printf(arena, "%s may be %s %.6g %s %s %.6g %s, and %.6g %s is taken", name,
                              anything ? "anything from" : "between", s->lower, unit,
                              anything ? "to" : "and", s->upper, unit, s->value, unit);
}

static const char *say_intervals(struct dalcs_run *r, const struct dalcs_finding *f) {
    const char *text = "";
    const int most = f->kind == DALCS_OPEN_CURRENTS ? MOST_TOLD : MOST_NOTED;
    for (int k = 0; k < f->n_signals && k < most && text != NULL; k++) {
        const char *one = say_interval(r, &f->signal[k], f->n_answers == 0);
        text = one == NULL ? NULL : dalcs_arena_printf(&r->s->arena, "%s; %s", text, one);
    }
    return text;
}

static const char *list_signals(struct dalcs_run *r, const struct dalcs_finding *f) {
    const char *list = "";
    for (int k = 0; k < f->n_signals && k < MOST_NAMED && list != NULL; k++) {
        bool is_last = k + 1 == f->n_signals;
        list = dalcs_arena_printf(&r->s->arena, "%s%s%s", list,
                                  k == 0    ? ""
                                  : is_last ? " and "
                                            : ", ",
                                  r->signals.name[f->signal[k].output]);
    }
    int more = f->n_signals - MOST_NAMED;
    return more <= 0 || list == NULL
               ? list
               : dalcs_arena_printf(&r->s->arena, "%s and %d more", list, more);
}

static enum dalcs_status say(struct dalcs_run *r, const struct dalcs_finding *f) {
    struct dalcs_session *s = r->s;
    const char *when = f->at_operating_point
                           ? "at the operating point"
                           : dalcs_arena_printf(&s->arena, "from t = %.9g s on", f->time);
    const char *signals = list_signals(r, f);
    const char *intervals = f->has_intervals ? say_intervals(r, f) : "";
    if (when == NULL || signals == NULL || intervals == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_diag_add(&s->diag, f->kind == DALCS_OPEN_CURRENTS ? DALCS_WARNING : DALCS_NOTE,
                   f->device >= 0 ? &s->circuit.device[f->device].where : NULL, f->hint,
                   "%s %s %s not determined: %s%s%s", when, signals,
                   f->n_signals == 1 ? "is" : "are", f->brief != NULL ? f->brief : f->because,
                   intervals, f->has_intervals && f->has_diodes ? " (least norm)" : "");
    return DALCS_OK;
}

/* The entry of a signal: a voltage between two parts may be told of twice. NULL: the report is full. */
static enum dalcs_status entry_of(struct dalcs_session *s, const char *name,
                                  struct dalcs_nonunique **entry) {
    *entry = NULL;
    for (size_t k = 0; k < s->results.n_nonunique; k++) {
        if (s->results.nonunique[k].signal == name) {
            *entry = &s->results.nonunique[k];
            return DALCS_OK;
        }
    }
    if (s->results.n_nonunique < MOST_REPORTED) {
        DALCS_TRY(dalcs_grow(&s->results.nonunique, &s->results.nonunique_capacity,
                             s->results.n_nonunique + 1, sizeof(*s->results.nonunique)));
        *entry = &s->results.nonunique[s->results.n_nonunique++];
    }
    return DALCS_OK;
}

static enum dalcs_status keep(struct dalcs_run *r, const struct dalcs_finding *f,
                              const char *because) {
    struct dalcs_session *s = r->s;
    for (int k = 0; k < f->n_signals && f->has_intervals; k++) {
        const struct dalcs_open_signal *signal = &f->signal[k];
        struct dalcs_nonunique *entry;
        DALCS_TRY(entry_of(s, r->signals.name[signal->output], &entry));
        if (entry == NULL) {
            r->nonunique.n_unreported++;
            continue;
        }
        *entry = (struct dalcs_nonunique){.signal = r->signals.name[signal->output],
                                          .time = f->time,
                                          .lower = signal->lower,
                                          .upper = signal->upper,
                                          .value = signal->value,
                                          .because = because};
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_nonunique_found(void *run, const struct dalcs_finding *finding) {
    struct dalcs_run *r = run;
    const char *because = dalcs_arena_printf(&r->s->arena, "%s", finding->because);
    if (because == NULL) {
        return DALCS_E_NOMEM;
    }
    if (r->nonunique.n_told[finding->kind] < MOST_MESSAGES[finding->kind]) {
        r->nonunique.n_told[finding->kind]++;
        DALCS_TRY(say(r, finding));
    } else {
        r->nonunique.n_untold[finding->kind] += finding->n_signals;
    }
    return keep(r, finding, because);
}

void dalcs_nonunique_count_rest(struct dalcs_run *r) {
    static const char *const like[] = {
        [DALCS_OPEN_CURRENTS] = "",
        [DALCS_OPEN_VOLTAGES] = ", voltages between elements that block",
        [DALCS_SHUNTED_SWITCHES] = ", currents that a switch shares with a diode across it"};
    for (int kind = 0; kind < DALCS_FINDING_KINDS; kind++) {
        if (r->nonunique.n_untold[kind] > 0) {
            dalcs_diag_add(&r->s->diag, kind == DALCS_OPEN_CURRENTS ? DALCS_WARNING : DALCS_NOTE,
                           NULL, NULL, "%ld more signal%s not determined%s; the report lists %s%d",
                           r->nonunique.n_untold[kind],
                           r->nonunique.n_untold[kind] == 1 ? " is" : "s are", like[kind],
                           r->nonunique.n_unreported > 0 ? "the first " : "",
                           (int)r->s->results.n_nonunique);
        }
    }
}

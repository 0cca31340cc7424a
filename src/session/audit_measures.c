/* audit_measures.c - what a stretch adds to .meas and .four: what is asked when.
 *
 * Of each stretch one measurement is asked at one time: no value is beyond the extreme that is known, and a level that has
 * been passed has been counted. That costs a value of a formula. What a stretch adds is checked from the waveform where a
 * measurement begins, where its window begins or ends, and where the budget or --audit full says so. */
#include "audit_measures_asked.h"

#include "claims.h"

#include <stdlib.h>

/* Instructions, about: of a stretch and a measurement, of its signals. */
static const double item_work = 800.0, signal_work = 500.0;

/* The share of that which checks may cost. */
static const double share = 0.03;

/* Stretches in which each measurement is asked at one time; later one of them is, which is drawn. */
enum { FIRST_STRETCHES = 256 };

/* ---- Windows ------------------------------------------------------------------------------------- */

bool audit_measures_find_window(const struct dalcs_measuring *m, const struct dalcs_measured *item,
                                double *from, double *to) {
    const struct dalcs_instant *trig = &item->instant[0];
    const struct dalcs_instant *targ = &item->instant[1];
    *from = fmax(m->stretch.from, fmax(m->start, item->from));
    *to = fmin(m->stretch.to, fmin(m->stop, item->to));
    if (trig->card->kind != DALCS_INSTANT_NONE) {
        *from = trig->found ? fmax(*from, trig->time) : INFINITY;
        *to = targ->found ? fmin(*to, targ->time) : *to;
    }
    return *from < *to && !item->has_no_value;
}

static bool is_inside(const struct dalcs_stretch *s, double t) {
    return s->from < t && t < s->to;
}

bool audit_measures_is_of(const struct dalcs_measuring *m, const struct dalcs_measured *item) {
    return item->card->analysis == m->analysis && item->card->kind != DALCS_MEASURE_PARAM;
}

/* ---- Before a stretch ---------------------------------------------------------------------------- */

bool audit_measures_is_full(const struct dalcs_audit_measures *a) {
    return a->run->run->options->audit == DALCS_AUDIT_FULL;
}

static void earn(struct dalcs_audit_measures *a, const struct dalcs_measuring *m) {
    a->credit += share * (signal_work * m->stretch.n_signals + item_work * m->n);
}

/* Is what the budget allows enough for one more look? */
static bool may_look(struct dalcs_audit_measures *a) {
    if (audit_measures_is_full(a)) {
        return true;
    }
    if (a->credit < a->threshold) {
        return false;
    }
    a->threshold = 40.0 * AUDIT_STATE_WORK * dalcs_audit_run_chance(a->run);
    return true;
}

static void begin_item(struct dalcs_audit_measures *a, const struct dalcs_measuring *m, int k,
                       bool may) {
    const struct dalcs_measured *item = &m->item[k];
    const struct dalcs_stretch *s = &m->stretch;
    struct audit_item *own = &a->item[k];
    double from, to;
    own->looks = false;
    if (audit_measures_is_of(m, item) && item->card->kind <= DALCS_MEASURE_MAX_AT) {
        const bool has_trig = item->card->instant[0].kind != DALCS_INSTANT_NONE;
        const bool is_edge = is_inside(s, item->from) || is_inside(s, item->to);
        own->looks =
            (has_trig || audit_measures_find_window(m, item, &from, &to)) &&
            (audit_measures_is_full(a) || !own->was_looked || is_edge || (may && k == a->drawn));
    }
    if (own->looks) {
        a->before[k] = *item;
    }
}

/* Is it asked at one time in this stretch? */
static bool is_asked(const struct dalcs_audit_measures *a, int k) {
    return k == a->drawn || a->n_stretches <= FIRST_STRETCHES;
}

static void begin_line(struct dalcs_audit_measures *a, const struct dalcs_measuring *m, int k,
                       bool may) {
    const struct dalcs_harmonics *h = &m->harmonics[k];
    const struct dalcs_stretch *s = &m->stretch;
    struct audit_line *own = &a->line[k];
    own->looks =
        h->from < s->to && s->from < h->to && (may || !own->was_looked || is_inside(s, h->from));
    if (own->looks) {
        own->line = (int)(dalcs_audit_run_chance(a->run) * (h->card->n_harmonics + 1));
        own->cosine = h->cosine[own->line];
        own->sine = h->sine[own->line];
    }
}

static void begin(void *user, const struct dalcs_measuring *m, int k) {
    struct dalcs_audit_measures *a = user;
    dalcs_audit_forget_asked(a->run->audit);
    earn(a, m);
    const bool may = may_look(a);
    a->drawn = k >= 0 ? k : (int)(dalcs_audit_run_chance(a->run) * m->n);
    a->n_stretches++;
    for (int j = 0; j < m->n; j++) {
        if (k >= 0 ? j == k : !m->item[j].card->is_late) {
            begin_item(a, m, j, may);
        }
        for (int i = 0; i < 2 && is_asked(a, j); i++) {
            a->item[j].n_now[i] = m->item[j].instant[i].n;
        }
    }
    for (int j = 0; k < 0 && j < m->n_harmonics; j++) {
        begin_line(a, m, j, may);
    }
}

/* ---- Harmonics ------------------------------------------------------------------------------------ */

static void end(void *user, const struct dalcs_measuring *m, int k) {
    struct dalcs_audit_measures *a = user;
    for (int j = 0; j < m->n; j++) {
        if ((k >= 0 ? j == k : !m->item[j].card->is_late) && audit_measures_is_of(m, &m->item[j])) {
            if (a->item[j].looks) {
                audit_measures_check_item(a, m, j);
            }
            audit_measures_check_instants(a, m, j);
            if (is_asked(a, j)) {
                audit_measures_ask_once(a, m, j);
            }
        }
    }
    for (int j = 0; k < 0 && j < m->n_harmonics; j++) {
        if (a->line[j].looks) {
            audit_measures_check_line(a, m, j);
        }
    }
}

/* ---- Start and end ------------------------------------------------------------------------------- */

enum dalcs_status dalcs_audit_measures_start(struct dalcs_audit_measures *a,
                                             struct dalcs_audit_run *run,
                                             struct dalcs_measuring *m) {
    *a = (struct dalcs_audit_measures){0};
    if (run == NULL || run->audit == NULL) {
        return DALCS_OK;
    }
    a->run = run;
    a->watch = (struct dalcs_measuring_watch){a, begin, end};
    a->item = dalcs_alloc((size_t)m->n, sizeof(*a->item));
    a->before = dalcs_alloc((size_t)m->n, sizeof(*a->before));
    a->line = dalcs_alloc((size_t)m->n_harmonics, sizeof(*a->line));
    if (a->item == NULL || a->before == NULL || a->line == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < m->n; k++) {
        a->item[k].reads = audit_measures_reads_all(run, &m->item[k].card->formula);
        a->item[k].told[0] = a->item[k].told[1] = -1.0;
    }
    for (int k = 0; k < m->n_harmonics; k++) {
        a->line[k].reads = audit_measures_reads_all(run, &m->harmonics[k].card->formula);
    }
    m->watch = &a->watch;
    return DALCS_OK;
}

void dalcs_audit_measures_finish(struct dalcs_audit_measures *a) {
    free(a->item);
    free(a->before);
    free(a->line);
    *a = (struct dalcs_audit_measures){0};
}

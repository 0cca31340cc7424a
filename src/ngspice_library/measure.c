/* measure.c - meas after a run.
 *
 * Measurements are made on the solution itself, which is gone when the run is over; a row may lie far from the peak
 * that is asked for. So the run is done again, with the values of then: it gives the same solution to the bit. */
#include "library.h"

#include "lower_case.h"

#include <stdlib.h>
#include <string.h>

/* Of "tran vmax MAX v(out)". */
static bool analysis_of(const char *rest, enum dalcs_analysis *analysis) {
    static const struct {
        const char *word;
        enum dalcs_analysis analysis;
    } known[] = {{"tran", DALCS_TRANSIENT},
                 {"ac", DALCS_AC},
                 {"dc", DALCS_DC_SWEEP},
                 {"op", DALCS_OPERATING_POINT}};

    bool found = false;
    char word[16];
    rest += strspn(rest, " \t");
    snprintf(word, sizeof word, "%.*s", (int)strcspn(rest, " \t"), rest);
    dalcs_lower_text(word);
    for (size_t k = 0; k < sizeof known / sizeof known[0] && !found; k++) {
        found = strcmp(known[k].word, word) == 0;
        *analysis = known[k].analysis;
    }
    return found;
}

struct repetition {
    struct ng_library *library;
    struct dalcs_session *session;
    bool is_measured;
};

/* The last one is the one that was asked for. */
static void take(void *user, struct dalcs_session *session, enum dalcs_status status) {
    struct repetition *r = user;
    const struct dalcs_report *report = dalcs_session_report(session);
    if (status != DALCS_OK || report == NULL || report->n_measurements == 0) {
        return;
    }
    struct ng_library *l = r->library;
    const struct dalcs_measurement *m = &report->measurement[report->n_measurements - 1];
    r->is_measured = m->found;
    if (!m->found) {
        ng_talk_fail(&l->talk, "meas %s failed: %s", m->name, m->failure);
        return;
    }
    const double value = m->value;
    fprintf(l->talk.out, "%-20s=  %.9e", m->name, value);
    for (int i = 0; i < m->n_details; i++) {
        fprintf(l->talk.out, " %s=  %.9e", m->detail[i].name, m->detail[i].value);
    }
    fputc('\n', l->talk.out);
    if (ng_plots_set(&l->plots, ng_plots_current(&l->plots), m->name, DALCS_UNIT_NONE, false, 1,
                     &value) != DALCS_OK) {
        r->is_measured = false;
    }
}

static enum dalcs_status forward_progress(void *user, double time, double stop) {
    const struct repetition *r = user;
    (void)time;
    (void)stop;
    return ng_background_pause(&r->library->background);
}

static enum dalcs_status repeat(struct repetition *r, const char *text) {
    struct ng_library *l = r->library;
    const char *name = l->circuit->name;
    DALCS_TRY(dalcs_session_create(&r->session));
    enum dalcs_status status = dalcs_session_read_text(r->session, name, text, strlen(text));
    size_t n_told = dalcs_session_n_messages(r->session); /* they were told when it was sent */
    FILE *unheard = fopen("/dev/null", "w");
    if (status == DALCS_OK && unheard != NULL) {
        const struct dalcs_sink sink = {.user = r, .progress = forward_progress};
        const struct dalcs_script_host host = {.session = r->session,
                                               .options = &l->options,
                                               .sink = &sink,
                                               .out = unheard,
                                               .user = r,
                                               .after_run = take};
        status = dalcs_script_run(&host);
    }
    if (unheard != NULL) {
        fclose(unheard);
    }
    if (!r->is_measured) {
        (void)ng_talk_messages(&l->talk, r->session, &n_told);
    }
    dalcs_session_destroy(r->session);
    return status;
}

enum dalcs_status ng_measure(void *user, const char *rest) {
    struct ng_library *l = user;
    enum dalcs_analysis analysis = DALCS_TRANSIENT;
    l->fails = true; /* told below */
    if (!analysis_of(rest, &analysis)) {
        ng_talk_fail(&l->talk, "meas: its first word must be tran, ac, dc or op");
        return DALCS_E_NETLIST;
    }
    DALCS_TRY(ng_take_vectors(l));
    char *text = ng_circuit_repetition(l->circuit, analysis, rest);
    if (text == NULL) {
        ng_talk_fail(&l->talk, "meas: there was no such analysis");
        return DALCS_E_NETLIST;
    }
    struct repetition r = {.library = l};
    enum dalcs_status status = repeat(&r, text);
    free(text);
    if (status == DALCS_OK && !r.is_measured) {
        status = DALCS_E_NETLIST;
    }
    l->fails = status != DALCS_OK;
    return status == DALCS_OK ? ng_lend_vectors(l) : status;
}

/* engine.c - what a page of a lesson calls: a netlist in, waveforms and texts out.
 *
 * One circuit at a time, which belongs to the page's only thread: so what was made last is kept here, and not by
 * JavaScript, which frees nothing. */
#include "dalcs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <emscripten.h>

static struct dalcs_session *session;
static struct dalcs_tables *tables;
static char *text; /* what the last call that makes one has made */

/* The netlist, and what is wrong with it in engine_messages(). 0: it can be run. */
EMSCRIPTEN_KEEPALIVE int engine_read(const char *netlist) {
    dalcs_tables_destroy(tables);
    tables = NULL;
    dalcs_session_destroy(session);
    if (dalcs_session_create(&session) != DALCS_OK) {
        return DALCS_E_NOMEM;
    }
    return dalcs_session_read_text(session, "netlist", netlist, strlen(netlist));
}

/* The status of the run, which is 0 where all went well. method may be "": that of the netlist. */
EMSCRIPTEN_KEEPALIVE int engine_run(const char *method, double step) {
    struct dalcs_run_options options = dalcs_run_options_default();
    options.record = true;
    options.method = method[0] == '\0' ? NULL : method;
    options.step = step;
    return dalcs_session_run_tables(session, &options, NULL, NULL, &tables);
}

/* ---- The last table of the run: that of .tran, where there is one ---- */

static const struct dalcs_row_table *table(void) {
    size_t n = tables == NULL ? 0 : dalcs_tables_count(tables);
    return n == 0 ? NULL : dalcs_tables_get(tables, n - 1);
}

EMSCRIPTEN_KEEPALIVE int engine_n_rows(void) {
    return table() == NULL ? 0 : (int)table()->n_rows;
}

EMSCRIPTEN_KEEPALIVE int engine_n_signals(void) {
    return table() == NULL ? 0 : (int)table()->plot.n_signals;
}

EMSCRIPTEN_KEEPALIVE const char *engine_signal(int index) {
    return table()->plot.name[index];
}

EMSCRIPTEN_KEEPALIVE const double *engine_scale(void) {
    return table()->scale;
}

/* Row after row. */
EMSCRIPTEN_KEEPALIVE const double *engine_values(void) {
    return table()->value;
}

/* ---- Texts, which live until the next of them ---- */

static const char *kept(const char *start, size_t length) {
    char *more = realloc(text, length + 1);
    if (more == NULL) {
        return "";
    }
    text = more;
    memmove(text, start, length);
    text[length] = '\0';
    return text;
}

EMSCRIPTEN_KEEPALIVE const char *engine_messages(void) {
    size_t length = 0;
    char *all = NULL;
    FILE *file = open_memstream(&all, &length);
    for (size_t k = 0; file != NULL && k < dalcs_session_n_messages(session); k++) {
        fprintf(file, "%s\n", dalcs_session_message(session, k, NULL));
    }
    if (file != NULL) {
        fclose(file);
    }
    const char *answer = kept(all == NULL ? "" : all, length);
    free(all);
    return answer;
}

EMSCRIPTEN_KEEPALIVE const char *engine_report(void) {
    const char *json = "";
    return dalcs_session_report_json(session, &json) == DALCS_OK ? json : "{}";
}

EMSCRIPTEN_KEEPALIVE const char *engine_check(void) {
    const char *json = "";
    return dalcs_session_check_json(session, 0.0, &json) == DALCS_OK ? json : "{}";
}

static enum dalcs_status take(void *user, const char *suffix, const char *start, size_t length) {
    (void)suffix;
    *(const char **)user = kept(start, length);
    return DALCS_OK;
}

EMSCRIPTEN_KEEPALIVE const char *engine_equations(void) {
    const char *answer = "";
    const struct dalcs_equations_options options = {
        .format = DALCS_EQUATIONS_TEXT, .stem = "netlist", .user = &answer, .file = take};
    return dalcs_session_equations(session, &options) == DALCS_OK ? answer : "";
}

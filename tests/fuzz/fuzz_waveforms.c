/* fuzz_waveforms.c - libFuzzer target: any bytes as a file of waveforms, and the same bytes as a list
 * of signals of it.
 *
 * Beside not crashing, what is read must be whole: names and dimensions of all columns, rows that fit
 * the bytes they came from, runs that follow one another. It is then held to the laws of a circuit. */
#include "selection.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool condition) {
    if (!condition) {
        abort();
    }
}

static enum dalcs_status count_row(void *user, double at, const double *value) {
    size_t *n = user;
    require(!isnan(at));
    (void)value;
    ++*n;
    return DALCS_OK;
}

static void check_selection(const struct dalcs_waveforms *w, const char *const *group, size_t n,
                            struct dalcs_diag *diag) {
    struct dalcs_selection s;
    size_t n_rows = 0;
    if (dalcs_selection_make(&s, w, group, n, NAN, NAN, diag) != DALCS_OK) {
        require(s.arena.head == NULL && diag->n > 0);
        return;
    }
    for (int p = 0; p < s.n_panels; p++) {
        require(s.panel[p].n <= DALCS_FIGURE_MAX_CURVES);
        for (int k = 0; k < s.panel[p].n; k++) {
            require(s.panel[p].signal[k] < s.n);
        }
    }
    struct dalcs_conduction c = {0};
    require(dalcs_selection_each_row(&s, count_row, &n_rows) == DALCS_OK);
    require(n_rows <= w->n_rows + 2);
    require(dalcs_selection_add_conduction(&s, &c) == DALCS_OK);
    dalcs_conduction_finish(&c);
    dalcs_selection_finish(&s);
}

static void check_waveforms(struct dalcs_waveforms *w, size_t size, struct dalcs_diag *diag) {
    size_t first = 0, end = 0;
    require(w->n_columns > 0 && w->plot >= 1 && w->plot <= w->n_plots);
    require(w->n_rows <= size && w->n_columns <= 2 * size);
    for (size_t c = 0; c < w->n_columns; c++) {
        require(w->name[c] && w->name[c][0]);
    }
    size_t n = dalcs_waveforms_find_run(w, 1, &first, &end);
    require((n == 0) == (w->n_rows == 0) && first <= end && end <= w->n_rows);
    dalcs_waveforms_keep_rows(w, first, end);
    check_selection(w, NULL, 0, diag);
}

/* The file as one of a circuit that has some of everything. */
static void check_audit(const struct dalcs_waveforms *w) {
    static const char netlist[] =
        "fuzz\nV1 a 0 PULSE(0 1 0 0 0 1 2)\nR1 a b 1\nL1 b c 1\nL2 c 0 2\n"
        "K1 L1 L2 0.5\nC1 c 0 1\nD1 c d\nC2 d 0 1\nS1 d 0 a 0 sw\n"
        "B1 e 0 V=limit(v(c), -1, 1)\nF1 e 0 V1 2\nR2 d f 0\nR3 f 0 1\n"
        ".model sw SW(Vt=0.5 Vh=0.1)\n.tran 1 10 uic\n";
    struct dalcs_session *session = NULL;
    const struct dalcs_table_audit *audit = NULL;
    double *precision = calloc(2 * w->n_columns, sizeof *precision);
    require(precision != NULL && dalcs_session_create(&session) == DALCS_OK);
    require(dalcs_session_read_text(session, "fuzz", netlist, strlen(netlist)) == DALCS_OK);
    const size_t n_messages = dalcs_session_n_messages(session);
    for (size_t c = 0; c < w->n_columns; c++) {
        precision[c] = w->precision[c].relative;
        precision[w->n_columns + c] = w->precision[c].absolute;
        require(precision[c] >= 0.0 && precision[w->n_columns + c] >= 0.0);
    }
    const struct dalcs_wave_table table = {w->n_columns, w->n_rows, w->name,
                                           w->value,     precision, precision + w->n_columns};
    const struct dalcs_table_audit_options options = {0};
    if (dalcs_session_audit_table(session, &table, &options, &audit) == DALCS_OK) {
        require(audit->n_rows == w->n_rows && audit->n_broken <= audit->n_laws);
        for (size_t k = 0; k < audit->n_laws; k++) {
            require(audit->law[k].defect >= 0.0 && audit->law[k].n_checked > 0);
        }
    } else {
        require(audit == NULL && dalcs_session_n_messages(session) > n_messages);
    }
    dalcs_session_destroy(session);
    free(precision);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct dalcs_diag diag = {0};
    struct dalcs_waveforms w;
    char *text = malloc(size + 1);
    require(text != NULL);
    memcpy(text, data, size);
    text[size] = '\0';
    enum dalcs_status status = dalcs_waveforms_read_text(&w, "fuzz", text, size, 0, &diag);
    require((status == DALCS_OK) == (diag.n_errors == 0));
    if (status == DALCS_OK) {
        const char *const group[] = {strlen(text) > 200 ? text + strlen(text) - 200 : text};
        check_waveforms(&w, size, &diag);
        check_audit(&w);
        check_selection(&w, group, 1, &diag);
    } else {
        require(w.value == NULL && w.arena.head == NULL);
    }
    dalcs_waveforms_finish(&w);
    dalcs_diag_finish(&diag);
    free(text);
    return 0;
}

/* fuzz_waveforms.c - libFuzzer target: any bytes as a file of waveforms, and the same bytes as a list
 * of signals of it.
 *
 * Beside not crashing, what is read must be whole: names and dimensions of all columns, rows that fit
 * the bytes they came from, runs that follow one another. */
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
        check_selection(&w, group, 1, &diag);
    } else {
        require(w.value == NULL && w.arena.head == NULL);
    }
    dalcs_waveforms_finish(&w);
    dalcs_diag_finish(&diag);
    free(text);
    return 0;
}

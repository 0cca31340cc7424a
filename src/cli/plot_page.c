/* plot_page.c - see plot_drawing.h. */
#include "plot_drawing.h"

#include "page.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum dalcs_status dalcs_drawing_select(struct dalcs_drawing *drawing,
                                       const struct dalcs_waveforms *waveforms,
                                       struct dalcs_selection *selection) {
    const struct dalcs_plot_arguments *arguments = drawing->arguments;
    const bool is_chosen = drawing->response[0] != NULL;
    DALCS_TRY(dalcs_selection_make(
        selection, waveforms, is_chosen ? drawing->response : arguments->group,
        is_chosen ? 2 : arguments->n_groups, arguments->from, arguments->to, &drawing->diag));
    selection->continues = is_chosen;
    return DALCS_OK;
}

enum dalcs_status dalcs_drawing_refuse_output(const struct dalcs_drawing *drawing, int error) {
    dalcs_cli_error(drawing->cli, "cannot write '%s': %s", drawing->arguments->output,
                    strerror(error));
    return DALCS_E_IO;
}

static void finish_runs(const struct dalcs_drawing *drawing, struct dalcs_page_run *run) {
    for (size_t k = 0; run != NULL && k + 1 < drawing->runs.n; k++) {
        dalcs_selection_finish(&run[k].selection);
        dalcs_conduction_finish(&run[k].conduction);
    }
    free(run);
}

/* The same signals of the other runs; *run is the caller's to finish, whatever the status. */
static enum dalcs_status select_runs(struct dalcs_drawing *drawing, struct dalcs_page_run **run) {
    const struct dalcs_plot_arguments *arguments = drawing->arguments;
    const struct dalcs_runs *runs = &drawing->runs;
    enum dalcs_status status = DALCS_OK;
    if (runs->n == 0) {
        return DALCS_OK;
    }
    *run = dalcs_alloc(runs->n - 1, sizeof(**run));
    if (*run == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k + 1 < runs->n && status == DALCS_OK; k++) {
        struct dalcs_page_run *r = &(*run)[k];
        status = dalcs_drawing_select(drawing, &runs->waveforms[k + 1], &r->selection);
        if (status == DALCS_OK && !arguments->no_bars) {
            status = dalcs_selection_add_conduction(&r->selection, &r->conduction);
        }
    }
    return status;
}

enum dalcs_status dalcs_drawing_write_page(struct dalcs_drawing *drawing) {
    const struct dalcs_plot_arguments *arguments = drawing->arguments;
    static const struct dalcs_conduction none;
    struct dalcs_atomic_file file = {0};
    if (!dalcs_page_is_available()) {
        dalcs_diag_add(&drawing->diag, DALCS_ERROR, NULL,
                       "install it (on Debian: apt-get install libjs-dygraphs) and build again",
                       "cannot write '%s': this dalcs was built without the library dygraphs",
                       arguments->output);
        return DALCS_E_OPTION;
    }
    struct dalcs_page_run *run = NULL;
    enum dalcs_status status = select_runs(drawing, &run);
    const struct dalcs_page_runs runs = {drawing->runs.n, run, drawing->runs.label};
    const struct dalcs_page page = {.selection = &drawing->selection,
                                    .conduction = arguments->no_bars ? &none : &drawing->conduction,
                                    .runs = &runs,
                                    .lines = &drawing->lines,
                                    .title = drawing->title + strspn(drawing->title, "* "),
                                    .theme = arguments->theme,
                                    .marks = arguments->marks};
    if (status == DALCS_OK) {
        status = dalcs_atomic_file_open(&file, arguments->output);
    }
    if (status == DALCS_OK) {
        status = dalcs_page_write(file.stream, &page, &drawing->diag);
    }
    if (status == DALCS_OK && ferror(file.stream)) {
        int error = errno != 0 ? errno : EIO;
        dalcs_atomic_file_discard(&file);
        file.error = error;
        status = DALCS_E_IO;
    }
    if (status == DALCS_OK) {
        status = dalcs_atomic_file_commit(&file);
    }
    if (file.error != 0) {
        status = dalcs_drawing_refuse_output(drawing, file.error);
    }
    dalcs_atomic_file_discard(&file);
    finish_runs(drawing, run);
    return status;
}

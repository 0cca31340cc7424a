/* run_sink.c - where the rows of a run go: to its files, tables, measurements and charts. */
#include "run_state.h"

#include "row_volume.h"

static enum dalcs_status check_interrupt(const struct dalcs_run *run) {
    return *run->cli->interrupted ? DALCS_E_CANCELLED : DALCS_OK;
}

static enum dalcs_status begin(void *user, const struct dalcs_plot *plot) {
    struct dalcs_run *run = user;
    run->is_timeless = run->progress.counts =
        plot->analysis != DALCS_TRANSIENT && plot->analysis != DALCS_PERIODIC;
    if (plot->analysis == DALCS_TRANSIENT && plot->step == 0 && run->n_rows > 0.0) {
        DALCS_TRY(dalcs_row_volume_tell(run->cli, &run->outputs, plot, run->n_rows, run->quiet));
    }
    enum dalcs_status status = dalcs_measures_file_plot(&run->measures, run->session, plot);
    if (status == DALCS_OK) {
        status = dalcs_print_table_begin(&run->printed, run->session, plot);
    }
    if (run->is_collected) {
        dalcs_bifurcation_chart_begin(&run->bifurcation, plot);
    }
    return status != DALCS_OK ? status : dalcs_outputs_begin(&run->outputs, plot);
}

static enum dalcs_status rows(void *user, size_t n, const double *time, const double *value) {
    struct dalcs_run *run = user;
    run->time = time[n - 1];
    for (size_t k = 0; k < n && run->printed.out != NULL; k++) {
        const double *of_row = value + k * run->printed.plot->n_signals;
        DALCS_TRY(dalcs_print_table_row(&run->printed, time[k], of_row));
    }
    for (size_t k = 0; k < n && run->is_collected; k++) {
        DALCS_TRY(dalcs_bifurcation_chart_row(&run->bifurcation,
                                              value + k * run->bifurcation.plot->n_signals));
    }
    DALCS_TRY(dalcs_outputs_rows(&run->outputs, n, time, value));
    return check_interrupt(run);
}

static enum dalcs_status row(void *user, double time, const double *value) {
    return rows(user, 1, &time, value);
}

static enum dalcs_status end(void *user) {
    struct dalcs_run *run = user;
    dalcs_print_table_end(&run->printed);
    return dalcs_outputs_end(&run->outputs);
}

static enum dalcs_status progress(void *user, double time, double stop) {
    struct dalcs_run *run = user;
    run->time = run->progress.counts ? run->time : time;
    dalcs_progress_update(&run->progress, time, stop, dalcs_session_n_events(run->session));
    return check_interrupt(run);
}

struct dalcs_sink dalcs_run_sink(struct dalcs_run *run) {
    return (struct dalcs_sink){
        .user = run, .begin = begin, .row = row, .end = end, .progress = progress, .rows = rows};
}

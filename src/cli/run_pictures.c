/* run_pictures.c - what a run draws besides its waveforms. */
#include "run_state.h"

#include "losses_chart.h"
#include "multipliers_chart.h"
#include "plot.h"
#include "table.h"

/* The orbit, or the response: of the first file that can be read again. */
static enum dalcs_status draw_orbit(const struct dalcs_cli *cli,
                                    const struct dalcs_arguments *arguments,
                                    const struct dalcs_report *report) {
    for (size_t k = 0; k < arguments->files.n_outputs; k++) {
        const char *file = arguments->files.output[k];
        if (!arguments->bode.is_asked || dalcs_table_find_format(file) == &dalcs_raw_format) {
            return dalcs_cli_draw_file(cli, file, arguments->files.plot, report, arguments->quiet);
        }
    }
    dalcs_cli_error(cli, "--plot draws a .raw file: write one with -o besides");
    return DALCS_E_OPTION;
}

static enum dalcs_status draw_multipliers(const struct dalcs_cli *cli,
                                          const struct dalcs_arguments *arguments,
                                          const struct dalcs_report *report) {
    char message[DALCS_GNUPLOT_MESSAGE];
    const char *path = arguments->steady.multipliers_plot;
    const enum dalcs_status status = dalcs_multipliers_chart_draw(report, path, message);
    if (status != DALCS_OK) {
        dalcs_cli_error(cli, "cannot draw '%s': %s", path, message);
    } else if (!arguments->quiet) {
        fprintf(cli->out, "  wrote     %s\n", path);
    }
    return status;
}

static enum dalcs_status draw_bifurcation(struct dalcs_run *run,
                                          const struct dalcs_arguments *arguments) {
    char message[DALCS_GNUPLOT_MESSAGE];
    const char *path = arguments->steady.bifurcation;
    const enum dalcs_status status = dalcs_bifurcation_chart_draw(&run->bifurcation, path, message);
    if (status != DALCS_OK) {
        dalcs_cli_error(run->cli, "cannot draw '%s': %s", path, message);
    } else if (!arguments->quiet) {
        fprintf(run->cli->out, "  wrote     %s\n", path);
    }
    return status;
}

/* Of the first run that has any. */
static enum dalcs_status draw_losses(const struct dalcs_cli *cli,
                                     const struct dalcs_arguments *arguments,
                                     const struct dalcs_report *report) {
    char message[DALCS_GNUPLOT_MESSAGE] = "there is no .tran and no .pss";
    enum dalcs_status status = DALCS_E_IO;
    if (report->n_losses > 0) {
        status = dalcs_losses_chart_draw(&report->losses[0], report->title, arguments->losses.plot,
                                         message);
    }
    if (status != DALCS_OK) {
        dalcs_cli_error(cli, "cannot draw '%s': %s", arguments->losses.plot, message);
    } else if (!arguments->quiet) {
        fprintf(cli->out, "  wrote     %s\n", arguments->losses.plot);
    }
    return status;
}

enum dalcs_status dalcs_run_draw(struct dalcs_run *run, const struct dalcs_arguments *arguments,
                                 const struct dalcs_report *report, bool has_files) {
    enum dalcs_status status = DALCS_OK;
    if (arguments->losses.plot != NULL) {
        status = draw_losses(run->cli, arguments, report);
    }
    if (status == DALCS_OK && has_files && run->is_collected) {
        status = draw_bifurcation(run, arguments);
    }
    if (status == DALCS_OK && has_files && arguments->steady.multipliers_plot != NULL) {
        status = draw_multipliers(run->cli, arguments, report);
    }
    if (status == DALCS_OK && has_files && arguments->files.plot != NULL &&
        (arguments->steady.is_asked || arguments->bode.is_asked || arguments->envelope.is_asked)) {
        status = draw_orbit(run->cli, arguments, report);
    }
    return status;
}

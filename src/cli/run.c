/* run.c - `dalcs run`: read the netlist, run it, stream the results, say what happened. */
#include "run.h"

#include "arguments.h"
#include "bifurcation_chart.h"
#include "bode_lines.h"
#include "envelope_lines.h"
#include "losses_chart.h"
#include "losses_text.h"
#include "measurements.h"
#include "measures_file.h"
#include "multipliers_chart.h"
#include "outputs.h"
#include "paths.h"
#include "plot.h"
#include "print_table.h"
#include "progress.h"
#include "quantity.h"
#include "row_volume.h"
#include "run_help.h"
#include "script.h"
#include "sensitivity_lines.h"
#include "settings.h"
#include "steady_lines.h"
#include "summary.h"
#include "times.h"
#include "variants.h"
#include "verb.h"
#include "worst_case_lines.h"

#include <math.h>
#include <string.h>

/* Events and jumps kept where no report and no figure wants them; the summary shows a few. */
enum { SHOWN_EVENTS = 100 };

/* The state behind the sink. */
struct run {
    const struct dalcs_cli *cli;
    const struct dalcs_session *session; /* which runs */
    struct dalcs_outputs outputs;
    struct dalcs_measures_file measures;
    struct dalcs_print_table printed;
    struct dalcs_progress progress;
    double time;     /* s, how far the run has come */
    bool has_script; /* a .control block says what is run */
    double n_rows;   /* of .tran in each step at least; 0: not known */
    bool quiet;
    bool is_collected;
    struct dalcs_bifurcation_chart bifurcation;
};

static const char help[] =
    "usage: dalcs run FILE [options]\n"
    "\n"
    "Runs the .op, .dc, .ac and .tran of a SPICE netlist, for each .step. Diodes and switches are\n"
    "ideal unless the netlist says otherwise. FILE may also be a system given by its matrices: "
    "'dalcs\n"
    "equations --help', or -, the standard input.\n"
    "\n" DALCS_RUN_OPTIONS "      --tran 'STEP STOP'\n"
    "                      in place of what stands on .tran: '1u 5m uic'\n"
    "      --tstop T       end at T; the rest of .tran stays\n"
    "      --losses[=FROM:TO]\n"
    "                      print what each element takes on average from one time to another, "
    "the\n"
    "                      efficiency, power factors and THD (default: the window of .losses, "
    "else\n"
    "                      all of the run)\n"
    "      --losses-plot FILE\n"
    "                      draw what each element loses as bars, .svg, .png or "
    ".pdf\n" DALCS_LAST_OPTIONS "\n"
    "Ctrl-C, SIGTERM and a full disk end a run early: its rows so far are then in out.partial.csv\n"
    "(for -o out.csv), and an out.csv of an earlier run stays as it is.\n"
    "\n"
    "examples:\n"
    "  dalcs run bridge.cir\n"
    "  dalcs run bridge.cir -o bridge.csv --plot bridge.svg\n"
    "  dalcs run bridge.cir --tol 1e-9 --report bridge.json -q\n"
    "  dalcs run bridge.cir --method euler --step 1u\n"
    "  dalcs run bridge.cir --set r1=220 -o none --measures r220.csv\n"
    "\n"
    "exit status: 0 ok, 1 the run failed, 2 usage, 3 error in the netlist, 4 input/output\n";

/* ---- The sink ------------------------------------------------------------------------------- */

static enum dalcs_status check_interrupt(const struct run *run) {
    return *run->cli->interrupted ? DALCS_E_CANCELLED : DALCS_OK;
}

static enum dalcs_status begin(void *user, const struct dalcs_plot *plot) {
    struct run *run = user;
    run->progress.counts = plot->analysis != DALCS_TRANSIENT && plot->analysis != DALCS_PERIODIC;
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
    struct run *run = user;
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
    struct run *run = user;
    dalcs_print_table_end(&run->printed);
    return dalcs_outputs_end(&run->outputs);
}

static enum dalcs_status progress(void *user, double time, double stop) {
    struct run *run = user;
    run->time = run->progress.counts ? run->time : time;
    dalcs_progress_update(&run->progress, time, stop, dalcs_session_n_events(run->session));
    return check_interrupt(run);
}

/* ---- Before the run ------------------------------------------------------------------------- */

/* What was asked for on the command line and cannot apply to this netlist. */
static void warn_unused(const struct dalcs_cli *cli, const struct dalcs_arguments *arguments,
                        const struct dalcs_request *request, enum dalcs_analysis main) {
    const struct {
        const char *name;
        bool given;
    } option[] = {{"--tol", arguments->tolerance > 0.0},
                  {"--stages", arguments->stages > 0},
                  {"--step", arguments->step > 0.0},
                  {"--compress", arguments->compress > 0.0},
                  {"--fill", arguments->fill > 0.0},
                  {"--curve", arguments->curve != NULL},
                  {"--at", dalcs_arguments_have_times(arguments)},
                  {"--plot", arguments->plot != NULL},
                  {"--energy", arguments->energy},
                  {"--losses", arguments->losses}};

    for (size_t i = 0; i < sizeof option / sizeof option[0]; i++) {
        const bool is_plot = arguments->plot != NULL && strcmp(option[i].name, "--plot") == 0;
        const bool is_of_steps = i < 3; /* which the search for an orbit takes, too */
        if (is_plot && (arguments->steady || arguments->bode || arguments->envelope)) {
            continue; /* it draws the file that is written */
        } else if (option[i].given && arguments->bode && !is_of_steps) {
            fprintf(cli->err, "dalcs: warning: %s applies to waveforms: it has no effect\n",
                    option[i].name);
        } else if (option[i].given && !arguments->bode && !(is_of_steps && request->periodic) &&
                   (is_plot ? !request->transient
                            : main != DALCS_TRANSIENT && main != DALCS_PERIODIC)) {
            fprintf(cli->err, "dalcs: warning: the netlist has no .tran: %s has no effect\n",
                    option[i].name);
        }
    }
}

/* The one that a file with room for one result holds. */
static enum dalcs_analysis main_analysis(const struct dalcs_request *request,
                                         const struct dalcs_arguments *arguments) {
    return arguments->steady                           ? DALCS_PERIODIC
           : arguments->bode                           ? DALCS_AC
           : arguments->envelope || request->transient ? DALCS_TRANSIENT
           : request->ac                               ? DALCS_AC
           : request->periodic                         ? DALCS_PERIODIC
           : request->dc_sweep                         ? DALCS_DC_SWEEP
                                                       : DALCS_OPERATING_POINT;
}

/* ---- The run -------------------------------------------------------------------------------- */

/* All is there that there is: of .step perhaps some have failed, and others have not. */
static bool is_whole(const struct dalcs_report *report, enum dalcs_status status) {
    bool is = status == DALCS_OK;
    if (report != NULL && report->n_failed_steps > 0) {
        is = (status > DALCS_OK || status == DALCS_E_NETLIST) &&
             report->n_failed_steps < report->n_steps;
    }
    for (size_t k = 0; report != NULL && k < report->n_failed_steps && is; k++) {
        is = report->failed_step[k].status != DALCS_REFUTED; /* rows of that one are wrong */
    }
    return is;
}

static void write_summary(const struct run *run, const struct dalcs_arguments *arguments,
                          const struct dalcs_report *report, enum dalcs_status status) {
    FILE *out = run->cli->out;
    if (arguments->quiet || !report || (status != DALCS_OK && run->outputs.n_rows == 0)) {
        return;
    }
    dalcs_summary_write_run(out, report);
    dalcs_envelope_lines_write(out, report);
    dalcs_steady_lines_write(out, report);
    dalcs_bode_lines_write(out, report);
    if (status != DALCS_OK && !is_whole(report, status)) {
        char text[DALCS_QUANTITY_SIZE];
        fprintf(out, "  stopped   at %s: %s\n", dalcs_quantity_write(text, run->time, "s", 6),
                dalcs_status_text(status));
    }
    dalcs_summary_write_sides(out, report);

    static const enum dalcs_analysis shown[] = {DALCS_OPERATING_POINT, DALCS_DC_SWEEP, DALCS_AC,
                                                DALCS_PERIODIC, DALCS_TRANSIENT};

    for (size_t i = 0; i < DALCS_N_ANALYSES; i++) {
        const struct dalcs_plot *plot = run->outputs.measure[shown[i]].plot;
        const bool is_envelope = report->envelope.present && shown[i] == DALCS_TRANSIENT;
        if (is_envelope && plot != NULL && plot->n_steps > 1) {
            continue; /* rows at the beginnings of periods have no averages of them */
        }
        if (is_envelope) {
            dalcs_summary_write_ends(out, &run->outputs.measure[shown[i]], arguments->all_signals);
        } else if (plot != NULL && plot->n_steps > 1) {
            dalcs_step_lines_write(out, &run->outputs.steps, report, shown[i]);
        } else {
            dalcs_summary_write_signals(out, &run->outputs.measure[shown[i]],
                                        arguments->all_signals);
        }
    }
    dalcs_summary_write_jumps(out, report);
    if (arguments->energy) {
        dalcs_summary_write_energy(out, report);
    }
    for (size_t k = 0; k < report->n_losses; k++) {
        dalcs_losses_text_write(out, &report->losses[k]);
    }
    if (!run->has_script) {
        dalcs_measurements_write(out, report);
    }
    dalcs_sensitivity_lines_write(out, report);
    dalcs_worst_case_lines_write(out, report);
    fputc('\n', out);
}

/* What a run of a script has measured: the next one has its own. */
static void tell_measured(void *user, struct dalcs_session *session, enum dalcs_status status) {
    const struct run *run = user;
    const struct dalcs_report *report = dalcs_session_report(session);
    if (status == DALCS_OK && report != NULL) {
        dalcs_measurements_write(run->cli->out, report);
    }
}

/* Tables are on the grid, as ngspice's are. */
static double fill_of(const struct dalcs_arguments *arguments) {
    bool prints_tables = arguments->batch && arguments->n_outputs == 0;
    return prints_tables ? (double)INFINITY : arguments->fill;
}

/* The orbit, or the response: of the first file that can be read again. */
static enum dalcs_status draw_orbit(const struct dalcs_cli *cli,
                                    const struct dalcs_arguments *arguments,
                                    const struct dalcs_report *report) {
    for (size_t k = 0; k < arguments->n_outputs; k++) {
        const char *file = arguments->output[k];
        if (!arguments->bode || dalcs_table_find_format(file) == &dalcs_raw_format) {
            return dalcs_cli_draw_file(cli, file, arguments->plot, report, arguments->quiet);
        }
    }
    dalcs_cli_error(cli, "--plot draws a .raw file: write one with -o besides");
    return DALCS_E_OPTION;
}

static enum dalcs_status draw_multipliers(const struct dalcs_cli *cli,
                                          const struct dalcs_arguments *arguments,
                                          const struct dalcs_report *report) {
    char message[DALCS_GNUPLOT_MESSAGE];
    const char *path = arguments->multipliers_plot;
    const enum dalcs_status status = dalcs_multipliers_chart_draw(report, path, message);
    if (status != DALCS_OK) {
        dalcs_cli_error(cli, "cannot draw '%s': %s", path, message);
    } else if (!arguments->quiet) {
        fprintf(cli->out, "  wrote     %s\n", path);
    }
    return status;
}

static enum dalcs_status draw_bifurcation(struct run *run,
                                          const struct dalcs_arguments *arguments) {
    char message[DALCS_GNUPLOT_MESSAGE];
    const char *path = arguments->bifurcation;
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
        status = dalcs_losses_chart_draw(&report->losses[0], report->title, arguments->losses_plot,
                                         message);
    }
    if (status != DALCS_OK) {
        dalcs_cli_error(cli, "cannot draw '%s': %s", arguments->losses_plot, message);
    } else if (!arguments->quiet) {
        fprintf(cli->out, "  wrote     %s\n", arguments->losses_plot);
    }
    return status;
}

/* Does nobody look at a row? Measurements do not: they have the solution itself. A script may write them. */
static bool needs_no_rows(const struct run *run, const struct dalcs_arguments *arguments) {
    return arguments->no_waveforms && arguments->quiet && run->outputs.n_tables == 0 &&
           run->outputs.report_path == NULL && arguments->plot == NULL &&
           !dalcs_arguments_have_times(arguments) && run->printed.out == NULL && !run->has_script;
}

static void leave_rows_out(struct dalcs_run_options *options) {
    dalcs_run_options_set_times(options, NULL, 0);
    options->fill = options->compress = 0.0;
    options->curve = NULL;
}

static struct dalcs_run_options options_of(const struct run *run,
                                           const struct dalcs_arguments *arguments,
                                           const struct dalcs_times *times) {
    struct dalcs_run_options options = dalcs_run_options_default();
    options.method = arguments->method;
    options.tolerance = arguments->tolerance;
    options.stages = arguments->stages;
    options.step = arguments->step;
    options.compress = arguments->compress;
    options.fill = fill_of(arguments);
    options.curve = arguments->curve;
    options.at = times->time;
    options.n_at = times->n;
    options.dump_path = arguments->dump;
    options.record = arguments->report || arguments->plot || !arguments->quiet;
    if (!arguments->report && !arguments->plot) {
        options.max_events = SHOWN_EVENTS;
    }
    options.audit = arguments->audit;
    options.only_step = arguments->only;
    options.workers = dalcs_settings_threads(arguments);
    options.steady = arguments->steady;
    options.samples = (int)arguments->samples;
    options.settle = (int)arguments->settle;
    options.period = arguments->period;
    options.envelope = arguments->envelope;
    options.envelope_stop = arguments->stop;
    options.envelope_at = arguments->show;
    options.n_envelope_at = arguments->n_show;
    options.bode = arguments->bode;
    options.bode_from = arguments->bode_from;
    options.bode_to = arguments->bode_to;
    options.bode_points = (int)arguments->bode_points;
    options.loop = arguments->loop;
    options.loop_is_loaded = arguments->loop_is_loaded;
    options.sideband = (int)arguments->sideband;
    options.energy = arguments->report || arguments->energy;
    if (needs_no_rows(run, arguments)) {
        leave_rows_out(&options);
    }
    return options;
}

/* Runs a session that has read its netlist and ends all files. */
static enum dalcs_status run_session(struct run *run, struct dalcs_session *session,
                                     const struct dalcs_arguments *arguments,
                                     const struct dalcs_times *times, size_t *n_written) {
    const struct dalcs_run_options options = options_of(run, arguments, times);
    const struct dalcs_sink sink = {
        .user = run, .begin = begin, .row = row, .end = end, .progress = progress, .rows = rows};
    run->session = session;
    dalcs_progress_init(&run->progress, run->cli->err_is_terminal ? run->cli->err : NULL);
    const struct dalcs_script_host host = {.session = session,
                                           .options = &options,
                                           .sink = &sink,
                                           .out = run->cli->out,
                                           .user = run,
                                           .after_run = tell_measured};
    enum dalcs_status status =
        run->has_script ? dalcs_script_run(&host) : dalcs_session_run(session, &options, &sink);
    dalcs_progress_finish(&run->progress);
    dalcs_print_table_finish(&run->printed);

    size_t n_before = *n_written;
    dalcs_cli_write_messages(run->cli, session, n_written, arguments->quiet);
    if (status == DALCS_E_CANCELLED) {
        char text[DALCS_QUANTITY_SIZE];
        fprintf(run->cli->err, "dalcs: interrupted at t = %s, after %zu row%s\n",
                dalcs_quantity_write(text, run->time, "s", 6), run->outputs.n_rows,
                run->outputs.n_rows == 1 ? "" : "s");
    } else if (status != DALCS_OK && status != DALCS_E_IO && *n_written == n_before) {
        dalcs_cli_error(run->cli, "%s", dalcs_status_text(status));
    }
    if (status == DALCS_OK) {
        status = dalcs_outputs_audit(&run->outputs, run->cli);
    }
    const struct dalcs_report *report = dalcs_session_report(session);
    write_summary(run, arguments, report, status);
    const bool whole = is_whole(report, status);
    enum dalcs_status files = dalcs_outputs_close(
        &run->outputs, run->cli, arguments->quiet ? NULL : run->cli->out, report, status, whole);
    if (status == DALCS_OK && arguments->losses_plot != NULL) {
        status = draw_losses(run->cli, arguments, report);
    }
    if (status == DALCS_OK && files == DALCS_OK && run->is_collected) {
        status = draw_bifurcation(run, arguments);
    }
    if (status == DALCS_OK && files == DALCS_OK && arguments->multipliers_plot != NULL) {
        status = draw_multipliers(run->cli, arguments, report);
    }
    if (status == DALCS_OK && files == DALCS_OK && arguments->plot != NULL &&
        (arguments->steady || arguments->bode || arguments->envelope)) {
        status = draw_orbit(run->cli, arguments, report);
    }
    const enum dalcs_status measures =
        dalcs_measures_file_close(&run->measures, run->cli, arguments, report, whole);
    files = files == DALCS_OK ? measures : files;
    if (status == DALCS_OK && report != NULL) {
        status = dalcs_worst_case_tell_failed(run->cli, report);
    }
    return status == DALCS_OK ? files : status;
}

/* Several threads, so that nothing but the table is written. */
static enum dalcs_status run_variants(const struct dalcs_cli *cli,
                                      const struct dalcs_arguments *arguments,
                                      const struct dalcs_session *session) {
    const struct run run = {.cli = cli};
    const struct dalcs_times times = {0};
    struct dalcs_run_options options = options_of(&run, arguments, &times);
    leave_rows_out(&options);
    options.record = false;
    options.dump_path = NULL;
    options.workers = 1; /* of each of the threads */
    return dalcs_variants_run(cli, arguments, session, &options);
}

static enum dalcs_status run_netlist(const struct dalcs_cli *cli,
                                     const struct dalcs_arguments *arguments,
                                     struct dalcs_session *session) {
    size_t n_written = 0;
    enum dalcs_status status = DALCS_OK;
    if (arguments->losses || arguments->losses_plot != NULL) {
        status = dalcs_session_ask_losses(session, arguments->losses_from, arguments->losses_to);
    }
    if (status == DALCS_OK && (arguments->steady || arguments->envelope)) {
        status = dalcs_session_ask_steady(session);
    }
    if (status == DALCS_OK && arguments->bode) {
        status = dalcs_session_ask_response(session);
    }
    if (status == DALCS_OK && arguments->sensitivity) {
        status = dalcs_session_ask_sensitivities(session);
    }
    status = status != DALCS_OK ? status : dalcs_settings_prepare(session, arguments);
    status = status != DALCS_OK ? status
                                : dalcs_verb_read(session, arguments->netlist, arguments->dialect);
    status = status != DALCS_OK ? status : dalcs_settings_apply(session, arguments);
    dalcs_cli_write_messages(cli, session, &n_written, arguments->quiet);
    if (status != DALCS_OK) {
        if (n_written == 0) {
            dalcs_cli_error(cli, "%s: %s", arguments->netlist, dalcs_status_text(status));
        }
        return status;
    }
    const struct dalcs_request request = dalcs_session_request(session);
    enum dalcs_analysis main = main_analysis(&request, arguments);
    struct run run = {.cli = cli, .is_collected = arguments->bifurcation != NULL};
    status = dalcs_script_look(session, &run.has_script, &main);
    if (status != DALCS_OK) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(status));
        return status;
    }
    DALCS_TRY(dalcs_settings_check_script(cli, session, arguments));
    bool is_table;
    DALCS_TRY(dalcs_variants_ask(cli, arguments, session, run.has_script, &is_table));
    if (is_table) {
        return run_variants(cli, arguments, session);
    }
    warn_unused(cli, arguments, &request, main);
    struct dalcs_times times = {0};
    DALCS_TRY(
        dalcs_times_read(&times, cli, arguments, request.transient ? request.stop : INFINITY));
    if (arguments->batch && arguments->n_outputs == 0 &&
        (request.n_prints > 0 || !request.transient)) {
        run.printed.out = cli->out;
    }
    run.n_rows = run.has_script ? 0.0 : dalcs_row_volume_count(arguments, &request, times.n);
    run.quiet = arguments->quiet;
    bool at = times.n > 0;
    status = dalcs_outputs_init(&run.outputs, arguments, request.ascii, main,
                                at ? times.time[0] : request.start,
                                at ? times.time[times.n - 1] : request.stop);
    if (status == DALCS_OK) {
        status = dalcs_measures_file_open(&run.measures, cli, arguments->measures);
    }
    if (status == DALCS_OK) {
        status = run_session(&run, session, arguments, &times, &n_written);
    } else if (status != DALCS_E_IO) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(status));
    }
    dalcs_outputs_finish(&run.outputs);
    dalcs_bifurcation_chart_finish(&run.bifurcation);
    dalcs_times_finish(&times);
    return status;
}

enum dalcs_status dalcs_cli_run_arguments(const struct dalcs_cli *cli,
                                          const struct dalcs_arguments *arguments) {
    struct dalcs_session *session = NULL;
    enum dalcs_status status = dalcs_session_create(&session);
    if (status == DALCS_OK) {
        status = run_netlist(cli, arguments, session);
    } else {
        dalcs_cli_error(cli, "%s", dalcs_status_text(status));
    }
    dalcs_session_destroy(session);
    return status;
}

/* What is for people goes elsewhere then. */
static bool uses_standard_output(const struct dalcs_arguments *arguments) {
    bool uses = dalcs_is_standard_output(arguments->measures) ||
                dalcs_is_standard_output(arguments->report);
    for (size_t k = 0; k < arguments->n_outputs; k++) {
        uses = uses || dalcs_is_standard_output(arguments->output[k]);
    }
    return uses;
}

enum dalcs_exit dalcs_cli_run(const struct dalcs_cli *cli, int argc, char **argv) {
    struct dalcs_arguments arguments;
    struct dalcs_cli other = *cli;
    enum dalcs_status status = dalcs_arguments_parse(&arguments, cli, argc, argv);
    if (status != DALCS_OK) {
        return dalcs_cli_exit(status);
    }
    if (arguments.help) {
        fputs(arguments.steady     ? dalcs_steady_help
              : arguments.bode     ? dalcs_bode_help
              : arguments.envelope ? dalcs_envelope_help
                                   : help,
              cli->out);
    } else {
        status = dalcs_paths_check(cli, &arguments);
    }
    if (status == DALCS_OK && !arguments.help) {
        other.out = uses_standard_output(&arguments) ? cli->err : cli->out;
        status = dalcs_cli_run_arguments(&other, &arguments);
    }
    dalcs_arguments_finish(&arguments);
    return dalcs_cli_exit(status);
}

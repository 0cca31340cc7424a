/* run.c - `dalcs run`: read the netlist, run it, stream the results, say what happened. */
#include "run.h"
#include "run_state.h"

#include "bode_lines.h"
#include "envelope_lines.h"
#include "paths.h"
#include "quantity.h"
#include "row_volume.h"
#include "run_help.h"
#include "script.h"
#include "settings.h"
#include "steady_lines.h"
#include "unused_options.h"
#include "variants.h"
#include "verb.h"
#include "worst_case_lines.h"

#include <math.h>
#include <string.h>

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

/* ---- Before the run ------------------------------------------------------------------------- */

/* The one that a file with room for one result holds. */
static enum dalcs_analysis main_analysis(const struct dalcs_request *request,
                                         const struct dalcs_arguments *arguments) {
    return arguments->steady.is_asked                           ? DALCS_PERIODIC
           : arguments->bode.is_asked                           ? DALCS_AC
           : arguments->envelope.is_asked || request->transient ? DALCS_TRANSIENT
           : request->ac                                        ? DALCS_AC
           : request->periodic                                  ? DALCS_PERIODIC
           : request->dc_sweep                                  ? DALCS_DC_SWEEP
           : request->transfer                                  ? DALCS_TRANSFER
                                                                : DALCS_OPERATING_POINT;
}

/* ---- The run -------------------------------------------------------------------------------- */

static void set_running(const struct dalcs_cli *cli, struct dalcs_session *session) {
    if (cli->running != NULL) {
        *cli->running = session;
    }
    if (session != NULL && *cli->interrupted) {
        dalcs_session_cancel(session); /* by a signal that came before */
    }
}

/* Runs a session that has read its netlist and ends all files. */
static enum dalcs_status run_session(struct dalcs_run *run, struct dalcs_session *session,
                                     const struct dalcs_arguments *arguments,
                                     const struct dalcs_times *times, size_t *n_written) {
    const struct dalcs_run_options options = dalcs_run_options_of(run, arguments, times);
    const struct dalcs_sink sink = dalcs_run_sink(run);
    run->session = session;
    dalcs_progress_init(&run->progress, run->cli->err_is_terminal ? run->cli->err : NULL);
    const struct dalcs_script_host host = {.session = session,
                                           .options = &options,
                                           .sink = &sink,
                                           .out = run->cli->out,
                                           .user = run,
                                           .set = arguments->batch.variable,
                                           .n_set = arguments->batch.n_variables,
                                           .after_run = dalcs_run_tell_measured};
    set_running(run->cli, session);
    enum dalcs_status status =
        run->has_script ? dalcs_script_run(&host) : dalcs_session_run(session, &options, &sink);
    set_running(run->cli, NULL);
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
    dalcs_run_tell(run, arguments, report, status);
    const bool whole = dalcs_run_is_whole(report, status);
    enum dalcs_status files = dalcs_outputs_close(
        &run->outputs, run->cli, arguments->quiet ? NULL : run->cli->out, report, status, whole);
    if (status == DALCS_OK) {
        status = dalcs_run_draw(run, arguments, report, files == DALCS_OK);
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
    const struct dalcs_run run = {.cli = cli};
    const struct dalcs_times times = {0};
    struct dalcs_run_options options = dalcs_run_options_of(&run, arguments, &times);
    dalcs_run_leave_rows_out(&options);
    options.record = false;
    options.dump_path = NULL;
    options.workers = 1; /* of each of the threads */
    return dalcs_variants_run(cli, arguments, session, &options);
}

/* Reads the netlist, with what the command line asks for besides. */
static enum dalcs_status read_netlist(const struct dalcs_arguments *arguments,
                                      struct dalcs_session *session) {
    enum dalcs_status status = DALCS_OK;
    if (arguments->losses.is_asked || arguments->losses.plot != NULL) {
        status = dalcs_session_ask_losses(session, arguments->losses.from, arguments->losses.to);
    }
    if (status == DALCS_OK && (arguments->steady.is_asked || arguments->envelope.is_asked)) {
        status = dalcs_session_ask_steady(session);
    }
    if (status == DALCS_OK && arguments->bode.is_asked) {
        status = dalcs_session_ask_response(session);
    }
    if (status == DALCS_OK && arguments->steady.sensitivity) {
        status = dalcs_session_ask_sensitivities(session);
    }
    status = status != DALCS_OK ? status : dalcs_settings_prepare(session, arguments);
    status = status != DALCS_OK ? status
                                : dalcs_verb_read(session, arguments->netlist, arguments->dialect);
    status = status != DALCS_OK ? status : dalcs_settings_apply(session, arguments);
    return status;
}

/* Opens the files of a run, runs it and closes them. */
static enum dalcs_status run_into_files(struct dalcs_run *run, struct dalcs_session *session,
                                        const struct dalcs_arguments *arguments,
                                        enum dalcs_analysis main, size_t *n_written) {
    const struct dalcs_cli *cli = run->cli;
    const struct dalcs_request request = dalcs_session_request(session);
    struct dalcs_times times = {0};
    DALCS_TRY(
        dalcs_times_read(&times, cli, arguments, request.transient ? request.stop : INFINITY));
    if (arguments->batch.is_asked && arguments->files.n_outputs == 0 &&
        (request.n_prints > 0 || !request.transient)) {
        run->printed.out = cli->out;
    }
    run->n_rows = run->has_script ? 0.0 : dalcs_row_volume_count(arguments, &request, times.n);
    run->quiet = arguments->quiet;
    const bool at = times.n > 0;
    enum dalcs_status status = dalcs_outputs_init(&run->outputs, arguments, request.ascii, main,
                                                  at ? times.time[0] : request.start,
                                                  at ? times.time[times.n - 1] : request.stop);
    if (status == DALCS_OK) {
        status = dalcs_measures_file_open(&run->measures, cli, arguments->files.measures);
    }
    if (status == DALCS_OK) {
        status = run_session(run, session, arguments, &times, n_written);
    } else if (status != DALCS_E_IO) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(status));
    }
    dalcs_outputs_finish(&run->outputs);
    dalcs_bifurcation_chart_finish(&run->bifurcation);
    dalcs_times_finish(&times);
    return status;
}

static enum dalcs_status run_netlist(const struct dalcs_cli *cli,
                                     const struct dalcs_arguments *arguments,
                                     struct dalcs_session *session) {
    size_t n_written = 0;
    enum dalcs_status status = read_netlist(arguments, session);
    dalcs_cli_write_messages(cli, session, &n_written, arguments->quiet);
    if (status != DALCS_OK) {
        if (n_written == 0) {
            dalcs_cli_error(cli, "%s: %s", arguments->netlist, dalcs_status_text(status));
        }
        return status;
    }
    const struct dalcs_request request = dalcs_session_request(session);
    enum dalcs_analysis main = main_analysis(&request, arguments);
    struct dalcs_run run = {.cli = cli, .is_collected = arguments->steady.bifurcation != NULL};
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
    dalcs_unused_options_warn(cli, arguments, session, main);
    return run_into_files(&run, session, arguments, main, &n_written);
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
    bool uses = dalcs_is_standard_output(arguments->files.measures) ||
                dalcs_is_standard_output(arguments->files.report);
    for (size_t k = 0; k < arguments->files.n_outputs; k++) {
        uses = uses || dalcs_is_standard_output(arguments->files.output[k]);
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
        fputs(arguments.steady.is_asked     ? dalcs_steady_help
              : arguments.bode.is_asked     ? dalcs_bode_help
              : arguments.envelope.is_asked ? dalcs_envelope_help
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

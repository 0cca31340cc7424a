/* run_summary.c - what a run says at its end. */
#include "run_state.h"

#include "bode_lines.h"
#include "envelope_lines.h"
#include "losses_text.h"
#include "measurements.h"
#include "quantity.h"
#include "sensitivity_lines.h"
#include "steady_lines.h"
#include "step_lines.h"
#include "summary.h"
#include "worst_case_lines.h"

bool dalcs_run_is_whole(const struct dalcs_report *report, enum dalcs_status status) {
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

/* Where a run ended that did not come to its end. */
static void tell_stop(const struct dalcs_run *run, enum dalcs_status status) {
    FILE *out = run->cli->out;
    char text[DALCS_QUANTITY_SIZE];
    if (run->is_timeless) { /* its rows have no time */
        fprintf(out, "  stopped   after %zu row%s: %s\n", run->outputs.n_rows,
                run->outputs.n_rows == 1 ? "" : "s", dalcs_status_text(status));
    } else {
        fprintf(out, "  stopped   at %s: %s\n", dalcs_quantity_write(text, run->time, "s", 6),
                dalcs_status_text(status));
    }
}

/* The signals of each analysis, or what became of them from step to step. */
static void tell_analyses(const struct dalcs_run *run, const struct dalcs_arguments *arguments,
                          const struct dalcs_report *report) {
    FILE *out = run->cli->out;

    static const enum dalcs_analysis shown[] = {DALCS_OPERATING_POINT, DALCS_TRANSFER,
                                                DALCS_DC_SWEEP,        DALCS_AC,
                                                DALCS_PERIODIC,        DALCS_TRANSIENT};

    for (size_t i = 0; i < DALCS_N_ANALYSES; i++) {
        const struct dalcs_plot *plot = run->outputs.measure[shown[i]].plot;
        const bool is_envelope = report->envelope.present && shown[i] == DALCS_TRANSIENT;
        if (is_envelope && plot != NULL && plot->n_steps > 1) {
            continue; /* rows at the beginnings of periods have no averages of them */
        }
        if (is_envelope) {
            dalcs_summary_write_ends(out, &run->outputs.measure[shown[i]],
                                     arguments->files.all_signals);
        } else if (plot != NULL && plot->n_steps > 1) {
            dalcs_step_lines_write(out, &run->outputs.steps, report, shown[i]);
        } else {
            dalcs_summary_write_signals(out, &run->outputs.measure[shown[i]], report,
                                        arguments->files.all_signals);
        }
    }
}

void dalcs_run_tell(const struct dalcs_run *run, const struct dalcs_arguments *arguments,
                    const struct dalcs_report *report, enum dalcs_status status) {
    FILE *out = run->cli->out;
    if (arguments->quiet || !report || (status != DALCS_OK && run->outputs.n_rows == 0)) {
        return;
    }
    dalcs_summary_write_run(out, report);
    dalcs_envelope_lines_write(out, report);
    const struct dalcs_plot *orbits = run->outputs.measure[DALCS_PERIODIC].plot;
    dalcs_steady_lines_write(out, report, orbits != NULL && orbits->n_steps > 1);
    dalcs_bode_lines_write(out, report);
    if (status != DALCS_OK && !dalcs_run_is_whole(report, status)) {
        tell_stop(run, status);
    }
    dalcs_summary_write_sides(out, report);

    tell_analyses(run, arguments, report);
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
void dalcs_run_tell_measured(void *user, struct dalcs_session *session, enum dalcs_status status) {
    const struct dalcs_run *run = user;
    const struct dalcs_report *report = dalcs_session_report(session);
    if (status == DALCS_OK && report != NULL) {
        dalcs_measurements_write(run->cli->out, report);
    }
}

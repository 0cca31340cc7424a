/* run_options.c - the options of a run on the command line. */
#include "run_state.h"

#include "settings.h"

#include <math.h>

/* Events and jumps that are kept without a report and a figure; the summary shows a few. */
enum { SHOWN_EVENTS = 100 };

/* Tables are on the grid, as ngspice's are. */
static double fill_of(const struct dalcs_arguments *arguments) {
    bool prints_tables = arguments->batch && arguments->n_outputs == 0;
    return prints_tables ? (double)INFINITY : arguments->fill;
}

/* Are rows not needed? Measurements use the solution itself. A script may write rows. */
static bool needs_no_rows(const struct dalcs_run *run, const struct dalcs_arguments *arguments) {
    return arguments->no_waveforms && arguments->quiet && run->outputs.n_tables == 0 &&
           run->outputs.report_path == NULL && arguments->plot == NULL &&
           !dalcs_arguments_have_times(arguments) && run->printed.out == NULL && !run->has_script;
}

void dalcs_run_leave_rows_out(struct dalcs_run_options *options) {
    dalcs_run_options_set_times(options, NULL, 0);
    options->fill = options->compress = 0.0;
    options->curve = NULL;
}

struct dalcs_run_options dalcs_run_options_of(const struct dalcs_run *run,
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
        dalcs_run_leave_rows_out(&options);
    }
    return options;
}

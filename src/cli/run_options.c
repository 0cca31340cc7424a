/* run_options.c - the options of a run on the command line. */
#include "run_state.h"

#include "settings.h"

#include <math.h>

/* Events and jumps that are kept without a report and a figure; the summary shows a few. */
enum { SHOWN_EVENTS = 100 };

/* Tables are on the grid, as ngspice's are. */
static double fill_of(const struct dalcs_arguments *arguments) {
    bool prints_tables = arguments->batch.is_asked && arguments->files.n_outputs == 0;
    return prints_tables ? (double)INFINITY : arguments->rows.fill;
}

/* Are rows not needed? Measurements use the solution itself. A script may write rows. */
static bool needs_no_rows(const struct dalcs_run *run, const struct dalcs_arguments *arguments) {
    return arguments->files.no_waveforms && arguments->quiet && run->outputs.n_tables == 0 &&
           run->outputs.report_path == NULL && arguments->files.plot == NULL &&
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
    options.method = arguments->method.name;
    options.tolerance = arguments->method.tolerance;
    options.stages = arguments->method.stages;
    options.step = arguments->method.step;
    options.compress = arguments->rows.compress;
    options.fill = fill_of(arguments);
    options.curve = arguments->rows.curve;
    options.at = times->time;
    options.n_at = times->n;
    options.dump_path = arguments->files.dump;
    options.record = arguments->files.report || arguments->files.plot || !arguments->quiet;
    if (!arguments->files.report && !arguments->files.plot) {
        options.max_events = SHOWN_EVENTS;
    }
    options.audit = arguments->audit;
    options.only_step = arguments->variants.only;
    options.workers = dalcs_settings_threads(arguments);
    options.steady = arguments->steady.is_asked;
    options.samples = (int)arguments->steady.samples;
    options.settle = (int)arguments->steady.settle;
    options.period = arguments->steady.period;
    options.envelope = arguments->envelope.is_asked;
    options.envelope_stop = arguments->envelope.stop;
    options.envelope_at = arguments->envelope.show;
    options.n_envelope_at = arguments->envelope.n_show;
    options.bode = arguments->bode.is_asked;
    options.bode_from = arguments->bode.from;
    options.bode_to = arguments->bode.to;
    options.bode_points = (int)arguments->bode.points;
    options.loop = arguments->bode.loop;
    options.loop_is_loaded = arguments->bode.loop_is_loaded;
    options.sideband = (int)arguments->bode.sideband;
    options.energy = arguments->files.report || arguments->energy;
    if (needs_no_rows(run, arguments)) {
        dalcs_run_leave_rows_out(&options);
    }
    return options;
}

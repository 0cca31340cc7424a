/* unused_options.c - what the command line asks for and this run cannot give. */
#include "unused_options.h"

#include <math.h>
#include <string.h>
#include <strings.h>

/* What needs an analysis that is not there. */
static void warn_of_analyses(const struct dalcs_cli *cli, const struct dalcs_arguments *arguments,
                             const struct dalcs_request *request, enum dalcs_analysis main) {
    const struct {
        const char *name;
        bool given;
    } option[] = {{"--tol", arguments->method.tolerance > 0.0},
                  {"--stages", arguments->method.stages > 0},
                  {"--step", arguments->method.step > 0.0},
                  {"--compress", arguments->rows.compress > 0.0},
                  {"--fill", arguments->rows.fill > 0.0},
                  {"--curve", arguments->rows.curve != NULL},
                  {"--at", dalcs_arguments_have_times(arguments)},
                  {"--plot", arguments->files.plot != NULL},
                  {"--energy", arguments->energy},
                  {"--losses", arguments->losses.is_asked}};

    for (size_t i = 0; i < sizeof option / sizeof option[0]; i++) {
        const bool is_plot = arguments->files.plot != NULL && strcmp(option[i].name, "--plot") == 0;
        const bool is_of_steps = i < 3; /* which the search for an orbit takes, too */
        if (is_plot && (arguments->steady.is_asked || arguments->bode.is_asked ||
                        arguments->envelope.is_asked)) {
            continue; /* it draws the file that is written */
        } else if (option[i].given && arguments->bode.is_asked && !is_of_steps) {
            fprintf(cli->err, "dalcs: warning: %s applies to waveforms: it has no effect\n",
                    option[i].name);
        } else if (option[i].given && !arguments->bode.is_asked &&
                   !(is_of_steps && request->periodic) &&
                   (is_plot ? !request->transient
                            : main != DALCS_TRANSIENT && main != DALCS_PERIODIC)) {
            fprintf(cli->err, "dalcs: warning: the netlist has no .tran: %s has no effect\n",
                    option[i].name);
        }
    }
}

static bool writes_raw(const struct dalcs_arguments *arguments) {
    for (size_t k = 0; k < arguments->files.n_outputs; k++) {
        const char *dot = strrchr(arguments->files.output[k], '.');
        if (dot != NULL && strcasecmp(dot, ".raw") == 0) {
            return true;
        }
    }
    return false;
}

/* What other options, or the netlist's cards, leave without a meaning. */
static void warn_of_others(const struct dalcs_cli *cli, const struct dalcs_arguments *arguments,
                           const struct dalcs_session *session,
                           const struct dalcs_request *request) {
    const bool has_raw = writes_raw(arguments);
    const bool has_many = request->n_steps > 1 && arguments->variants.only == 0;
    const bool adds_rows = !isinf(arguments->rows.fill) && !dalcs_arguments_have_times(arguments);

    const struct {
        const char *name, *reason;
        bool given;
    } option[] = {
        {"--ascii", "no raw file is written", arguments->files.ascii && !has_raw},
        {"--split-steps", "no raw file is written", arguments->files.split_steps && !has_raw},
        {"--split-steps", "there is one run, and no step of .step",
         arguments->files.split_steps && has_raw && !has_many},
        {"--curve", "no rows are added", arguments->rows.curve != NULL && !adds_rows},
        {"--energy", "an envelope leaves periods out",
         arguments->energy && arguments->envelope.is_asked},
        {"--measures", "the netlist has no .meas",
         arguments->files.measures != NULL && !has_many &&
             dalcs_session_measure_name(session, 0) == NULL},
    };

    for (size_t k = 0; k < sizeof option / sizeof option[0]; k++) {
        if (option[k].given) {
            fprintf(cli->err, "dalcs: warning: %s: %s has no effect\n", option[k].reason,
                    option[k].name);
        }
    }
}

void dalcs_unused_options_warn(const struct dalcs_cli *cli, const struct dalcs_arguments *arguments,
                               const struct dalcs_session *session, enum dalcs_analysis main) {
    const struct dalcs_request request = dalcs_session_request(session);
    warn_of_analyses(cli, arguments, &request, main);
    if (!arguments->batch
             .is_asked) { /* whose options are ngspice's, and mean what they mean there */
        warn_of_others(cli, arguments, session, &request);
    }
}

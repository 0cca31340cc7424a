/* arguments.c - reads options with getopt_long, then sets the others to their defaults. */
#include "argument_values.h"

#include "memory.h"
#include "verb.h"

#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    METHOD = 256,
    DIALECT,
    TOL,
    STAGES,
    STEP,
    FILL,
    CURVE,
    COMPRESS,
    AT,
    TRAN,
    TSTOP,
    REPORT,
    PLOT,
    DUMP,
    ALL_SIGNALS,
    ENERGY,
    LOSSES,
    LOSSES_PLOT,
    ASCII,
    SPLIT_STEPS,
    AUDIT,
    PERIOD,
    STOP,
    SHOW,
    FROM,
    TO,
    POINTS,
    SENSITIVITY,
    MULTIPLIERS_PLOT,
    BIFURCATION,
    SAMPLES,
    SETTLE,
    LOOP,
    INJECTION,
    SIDEBAND,
    SET,
    MEASURES,
    SHARD,
    RESUME,
    JOBS,
    SEED,
    ONLY
};

static const struct option option[] = {
    {"output", required_argument, NULL, 'o'},
    {"method", required_argument, NULL, METHOD},
    {"dialect", required_argument, NULL, DIALECT},
    {"tol", required_argument, NULL, TOL},
    {"stages", required_argument, NULL, STAGES},
    {"step", required_argument, NULL, STEP},
    {"fill", required_argument, NULL, FILL},
    {"curve", required_argument, NULL, CURVE},
    {"compress", required_argument, NULL, COMPRESS},
    {"at", required_argument, NULL, AT},
    {"tran", required_argument, NULL, TRAN},
    {"tstop", required_argument, NULL, TSTOP},
    {"report", required_argument, NULL, REPORT},
    {"plot", required_argument, NULL, PLOT},
    {"dump", required_argument, NULL, DUMP},
    {"all-signals", no_argument, NULL, ALL_SIGNALS},
    {"energy", no_argument, NULL, ENERGY},
    {"losses", optional_argument, NULL, LOSSES},
    {"losses-plot", required_argument, NULL, LOSSES_PLOT},
    {"audit", required_argument, NULL, AUDIT},
    {"ascii", no_argument, NULL, ASCII},
    {"split-steps", no_argument, NULL, SPLIT_STEPS},
    {"period", required_argument, NULL, PERIOD},
    {"stop", required_argument, NULL, STOP},
    {"show", required_argument, NULL, SHOW},
    {"from", required_argument, NULL, FROM},
    {"to", required_argument, NULL, TO},
    {"points", required_argument, NULL, POINTS},
    {"sensitivity", no_argument, NULL, SENSITIVITY},
    {"bifurcation", required_argument, NULL, BIFURCATION},
    {"samples", required_argument, NULL, SAMPLES},
    {"settle", required_argument, NULL, SETTLE},
    {"multipliers-plot", required_argument, NULL, MULTIPLIERS_PLOT},
    {"loop", required_argument, NULL, LOOP},
    {"injection", required_argument, NULL, INJECTION},
    {"sideband", required_argument, NULL, SIDEBAND},
    {"set", required_argument, NULL, SET},
    {"measures", required_argument, NULL, MEASURES},
    {"shard", required_argument, NULL, SHARD},
    {"resume", no_argument, NULL, RESUME},
    {"jobs", required_argument, NULL, JOBS},
    {"seed", required_argument, NULL, SEED},
    {"only", required_argument, NULL, ONLY},
    {"quiet", no_argument, NULL, 'q'},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

static enum dalcs_status parse_sideband(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli, const char *text) {
    if (dalcs_parse_number(text, &arguments->bode.sideband) != DALCS_OK ||
        !(fabs(arguments->bode.sideband) <= DALCS_MOST_SIDEBAND) ||
        arguments->bode.sideband != rint(arguments->bode.sideband)) {
        dalcs_cli_error(cli, "--sideband: '%s' is no whole number, at most %d of them away", text,
                        (int)DALCS_MOST_SIDEBAND);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status parse_injection(struct dalcs_arguments *arguments,
                                         const struct dalcs_cli *cli, const char *text) {
    arguments->bode.loop_is_loaded = strcmp(text, "both") == 0;
    if (!arguments->bode.loop_is_loaded && strcmp(text, "voltage") != 0) {
        dalcs_cli_error(cli, "--injection: '%s' is neither voltage nor both", text);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

/* The options of `dalcs bode` alone. */
static enum dalcs_status take_bode(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                                   int code) {
    if (!arguments->bode.is_asked) {
        int k = 0;
        while (option[k].val != code) {
            k++;
        }
        dalcs_cli_error(cli, "--%s is an option of 'dalcs bode'", option[k].name);
        return DALCS_E_OPTION;
    }
    switch (code) {
    case FROM:
        return dalcs_verb_take_positive(cli, "--from", optarg, &arguments->bode.from);
    case TO:
        return dalcs_verb_take_positive(cli, "--to", optarg, &arguments->bode.to);
    case POINTS:
        return dalcs_verb_take_count(cli, "--points", optarg, &arguments->bode.points);
    case LOOP:
        arguments->bode.loop = optarg;
        return DALCS_OK;
    case INJECTION:
        return parse_injection(arguments, cli, optarg);
    default:
        return parse_sideband(arguments, cli, optarg);
    }
}

static const char *verb_of(const struct dalcs_arguments *arguments) {
    return arguments->steady.is_asked     ? "steady"
           : arguments->bode.is_asked     ? "bode"
           : arguments->envelope.is_asked ? "envelope"
                                          : "run";
}

static enum dalcs_status take(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                              int code, char **argv) {
    switch (code) {
    case 'o':
        return dalcs_argument_output(arguments, cli, optarg);
    case METHOD:
        return dalcs_argument_method(arguments, cli, optarg);
    case DIALECT:
        return dalcs_verb_take_dialect(cli, optarg, &arguments->dialect);
    case TOL:
        return dalcs_argument_tolerance(arguments, cli, optarg);
    case STAGES:
        return dalcs_argument_stages(arguments, cli, optarg);
    case STEP:
        return dalcs_argument_step(arguments, cli, optarg);
    case FILL:
        return dalcs_argument_fill(arguments, cli, optarg);
    case CURVE:
        return dalcs_argument_curve(arguments, cli, optarg);
    case COMPRESS:
        return dalcs_argument_compress(arguments, cli, optarg);
    case AT:
        return dalcs_argument_at(arguments, cli, optarg);
    case TRAN:
    case TSTOP:
        return dalcs_argument_transient(arguments, cli, code == TRAN, optarg);
    case REPORT:
        arguments->files.report = optarg;
        return DALCS_OK;
    case PLOT:
        return dalcs_argument_plot(arguments, cli, optarg);
    case DUMP:
        arguments->files.dump = optarg;
        return DALCS_OK;
    case ALL_SIGNALS:
        arguments->files.all_signals = true;
        return DALCS_OK;
    case ENERGY:
        arguments->energy = true;
        return DALCS_OK;
    case LOSSES:
        return dalcs_argument_losses(arguments, cli, optarg);
    case LOSSES_PLOT:
        return dalcs_argument_losses_plot(arguments, cli, optarg);
    case AUDIT:
        return dalcs_argument_audit(arguments, cli, optarg);
    case SET:
        return dalcs_argument_set(arguments, cli, optarg);
    case MEASURES:
        return dalcs_argument_measures(arguments, cli, optarg);
    case SHARD:
        return dalcs_argument_shard(arguments, cli, optarg);
    case RESUME:
        arguments->variants.resume = true;
        return DALCS_OK;
    case JOBS:
        return dalcs_verb_take_count(cli, "--jobs", optarg, &arguments->variants.jobs);
    case SEED:
        return dalcs_argument_seed(arguments, cli, optarg);
    case ONLY:
        return dalcs_verb_take_count(cli, "--only", optarg, &arguments->variants.only);
    case PERIOD:
        return dalcs_argument_period(arguments, cli, optarg);
    case STOP:
        return dalcs_argument_stop(arguments, cli, optarg);
    case SHOW:
        return dalcs_argument_show(arguments, cli, optarg);
    case SENSITIVITY:
        return dalcs_argument_sensitivity(arguments, cli);
    case BIFURCATION:
        return dalcs_argument_bifurcation(arguments, cli, optarg);
    case SAMPLES:
        return dalcs_argument_samples(arguments, cli, "--samples", optarg,
                                      &arguments->steady.samples);
    case SETTLE:
        return dalcs_argument_samples(arguments, cli, "--settle", optarg,
                                      &arguments->steady.settle);
    case MULTIPLIERS_PLOT:
        return dalcs_argument_multipliers_plot(arguments, cli, optarg);
    case FROM:
    case TO:
    case POINTS:
    case LOOP:
    case INJECTION:
    case SIDEBAND:
        return take_bode(arguments, cli, code);
    case ASCII:
        arguments->files.ascii = true;
        return DALCS_OK;
    case SPLIT_STEPS:
        arguments->files.split_steps = true;
        return DALCS_OK;
    case 'q':
        arguments->quiet = true;
        return DALCS_OK;
    case 'h':
        arguments->help = true;
        return DALCS_OK;
    default:
        return dalcs_verb_refuse(cli, verb_of(arguments), option, code, argv);
    }
}

static const char *base_of(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* "dir/bridge.cir" -> "dir/bridge" and the ending. */
static char *change_ending(const char *path, const char *ending) {
    const char *base = base_of(path);
    const char *dot = strrchr(base, '.');
    size_t stem = dot && dot != base ? (size_t)(dot - path) : strlen(path);
    char *name = dalcs_alloc(stem + strlen(ending) + 1, 1);
    if (name) {
        memcpy(name, path, stem);
        strcpy(name + stem, ending);
    }
    return name;
}

/* The raw file goes to the current folder, a failed step beside the first output. */
static enum dalcs_status add_defaults(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli) {
    const bool is_input = strcmp(arguments->netlist, "-") == 0;
    const char *base = is_input ? "stdin" : base_of(arguments->netlist);
    const bool has_default = arguments->files.n_outputs == 0 && !arguments->files.no_waveforms;
    if (has_default) {
        arguments->files.default_output = change_ending(base, ".raw");
        arguments->files.output[arguments->files.n_outputs++] = arguments->files.default_output;
    }
    const char *beside = arguments->files.n_outputs > 0 ? arguments->files.output[0] : base;
    if (!arguments->files.dump && beside) {
        arguments->files.default_dump = change_ending(beside, ".failed.dalcs");
        arguments->files.dump = arguments->files.default_dump;
    }
    if ((has_default && !arguments->files.default_output) || !arguments->files.dump) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(DALCS_E_NOMEM));
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_arguments_parse(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli, int argc, char **argv) {
    *arguments = (struct dalcs_arguments){.steady.is_asked = strcmp(argv[0], "steady") == 0,
                                          .bode.is_asked = strcmp(argv[0], "bode") == 0,
                                          .envelope.is_asked = strcmp(argv[0], "envelope") == 0,
                                          .variants.seed = NAN,
                                          .losses.from = NAN,
                                          .losses.to = INFINITY};
    arguments->files.output = dalcs_alloc((size_t)argc, sizeof *arguments->files.output);
    arguments->set = dalcs_alloc((size_t)argc, sizeof *arguments->set);
    if (!arguments->files.output || !arguments->set) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(DALCS_E_NOMEM));
        dalcs_arguments_finish(arguments);
        return DALCS_E_NOMEM;
    }
    enum dalcs_status status = DALCS_OK;
    optind = 0; /* glibc: start afresh */
    opterr = 0;
    for (int code; status == DALCS_OK && !arguments->help &&
                   (code = getopt_long(argc, argv, ":o:qh", option, NULL)) != -1;) {
        status = take(arguments, cli, code, argv);
    }
    if (status == DALCS_OK && !arguments->help && dalcs_arguments_have_times(arguments) &&
        arguments->rows.compress > 0.0) {
        dalcs_cli_error(cli,
                        "--compress leaves rows out, --at prints each of its times: choose one");
        status = DALCS_E_OPTION;
    }
    if (status == DALCS_OK && !arguments->help && dalcs_arguments_have_times(arguments) &&
        arguments->rows.fill > 0.0) {
        dalcs_cli_error(cli, "--fill adds rows, --at prints only its own times: choose one");
        status = DALCS_E_OPTION;
    }
    if (status == DALCS_OK && !arguments->help && arguments->steady.samples > 0 &&
        (arguments->files.plot || arguments->steady.multipliers_plot)) {
        dalcs_cli_error(cli, "--bifurcation and --samples draw many orbits: leave out --plot and "
                             "--multipliers-plot");
        status = DALCS_E_OPTION;
    }
    if (status == DALCS_OK && !arguments->help) {
        status = dalcs_verb_take_netlist(cli, verb_of(arguments), argc, argv, &arguments->netlist);
        status = status == DALCS_OK ? add_defaults(arguments, cli) : status;
    }
    if (status != DALCS_OK) {
        dalcs_arguments_finish(arguments);
    }
    return status;
}

void dalcs_arguments_finish(struct dalcs_arguments *arguments) {
    free(arguments->files.output);
    free(arguments->set);
    free(arguments->batch.variable);
    free(arguments->envelope.show);
    free(arguments->rows.times);
    free(arguments->files.default_output);
    free(arguments->files.default_dump);
    *arguments = (struct dalcs_arguments){0};
}

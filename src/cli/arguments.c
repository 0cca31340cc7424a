/* arguments.c - getopt_long, then checks that need no file: formats by name, numbers. */
#include "arguments.h"

#include "figure.h"
#include "memory.h"
#include "settings.h"
#include "table.h"
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
    SET,
    MEASURES
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
    {"set", required_argument, NULL, SET},
    {"measures", required_argument, NULL, MEASURES},
    {"quiet", no_argument, NULL, 'q'},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

static enum dalcs_status add_output(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                                    const char *path) {
    if (strcmp(path, "none") == 0) {
        arguments->no_waveforms = true;
        return DALCS_OK;
    }
    if (!dalcs_table_find_format(path)) {
        dalcs_cli_error(cli, "cannot tell the format of '%s': name it .csv or .raw", path);
        return DALCS_E_OPTION;
    }
    arguments->output[arguments->n_outputs++] = path;
    return DALCS_OK;
}

static enum dalcs_status parse_method(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *text) {
    size_t n = 0;
    for (; dalcs_method_name(n); n++) {
        if (strcmp(dalcs_method_name(n), text) == 0) {
            arguments->method = text;
            return DALCS_OK;
        }
    }
    fprintf(cli->err, "dalcs: error: --method: unknown method '%s'; the methods are:", text);
    for (size_t i = 0; i < n; i++) {
        fprintf(cli->err, " %s", dalcs_method_name(i));
    }
    fputc('\n', cli->err);
    return DALCS_E_OPTION;
}

static enum dalcs_status parse_number(const struct dalcs_cli *cli, const char *name,
                                      const char *text, double *value) {
    if (dalcs_parse_number(text, value) != DALCS_OK) {
        dalcs_cli_error(cli, "%s: '%s' is not a number; write 1u or 1e-6", name, text);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status parse_tolerance(struct dalcs_arguments *arguments,
                                         const struct dalcs_cli *cli, const char *text) {
    DALCS_TRY(parse_number(cli, "--tol", text, &arguments->tolerance));
    if (arguments->tolerance < DALCS_TOLERANCE_MIN || arguments->tolerance > DALCS_TOLERANCE_MAX) {
        dalcs_cli_error(cli, "--tol: '%s' does not lie between %g and %g", text,
                        DALCS_TOLERANCE_MIN, DALCS_TOLERANCE_MAX);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status parse_stages(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *text) {
    double value = 0.0;
    if (dalcs_parse_number(text, &value) != DALCS_OK || !DALCS_HAS_STAGES(value)) {
        dalcs_cli_error(cli, "--stages: '%s' is none of 1, 3, 5, 7, 9", text);
        return DALCS_E_OPTION;
    }
    arguments->stages = (int)value;
    return DALCS_OK;
}

static enum dalcs_status parse_step(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                                    const char *text) {
    DALCS_TRY(parse_number(cli, "--step", text, &arguments->step));
    if (!(arguments->step > 0.0)) {
        dalcs_cli_error(cli, "--step: '%s' must be greater than 0", text);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

/* Of a largest value; or_none: what else there is, "" or ", or none". */
static enum dalcs_status parse_part(const struct dalcs_cli *cli, const char *name, const char *text,
                                    const char *or_none, double *value) {
    DALCS_TRY(parse_number(cli, name, text, value));
    if (!(*value > 0.0 && *value < 1.0)) {
        dalcs_cli_error(cli, "%s: '%s' must be greater than 0 and less than 1%s", name, text,
                        or_none);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status parse_fill(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                                    const char *text) {
    if (strcmp(text, "none") == 0) {
        arguments->fill = INFINITY;
        return DALCS_OK;
    }
    return parse_part(cli, "--fill", text, ", or none", &arguments->fill);
}

static enum dalcs_status parse_curve(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                                     const char *text) {
    if (strcmp(text, "cubics") != 0 && strcmp(text, "lines") != 0) {
        dalcs_cli_error(cli, "--curve: '%s' is neither cubics nor lines", text);
        return DALCS_E_OPTION;
    }
    arguments->curve = text;
    return DALCS_OK;
}

static enum dalcs_status parse_audit(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                                     const char *text) {
    static const char *const name[] = {"sample", "full", "off"};
    for (int k = 0; k < 3; k++) {
        if (strcmp(text, name[k]) == 0) {
            arguments->audit = (enum dalcs_audit_mode)k;
            return DALCS_OK;
        }
    }
    dalcs_cli_error(cli, "--audit: '%s' is none of sample, full and off", text);
    return DALCS_E_OPTION;
}

static enum dalcs_status parse_period(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *text) {
    if (!arguments->steady) {
        dalcs_cli_error(cli, "--period is one of 'dalcs steady'");
        return DALCS_E_OPTION;
    }
    return dalcs_verb_take_positive(cli, "--period", text, &arguments->period);
}

/* FROM:TO, either of which may be left out; NULL: the netlist's window. */
static enum dalcs_status parse_losses(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *text) {
    if (arguments->steady) {
        dalcs_cli_error(cli, "--losses is one of 'dalcs run'");
        return DALCS_E_OPTION;
    }
    arguments->losses = true;
    arguments->losses_from = text == NULL ? (double)NAN : 0.0;
    arguments->losses_to = INFINITY;
    if (text == NULL) {
        return DALCS_OK;
    }
    const char *colon = strchr(text, ':');
    char from[64];
    if (colon == NULL || (size_t)(colon - text) >= sizeof from) {
        dalcs_cli_error(cli, "--losses: '%s' is not FROM:TO; write 10m:20m", text);
        return DALCS_E_OPTION;
    }
    memcpy(from, text, (size_t)(colon - text));
    from[colon - text] = '\0';
    if (from[0] != '\0') {
        DALCS_TRY(parse_number(cli, "--losses", from, &arguments->losses_from));
    }
    if (colon[1] != '\0') {
        DALCS_TRY(parse_number(cli, "--losses", colon + 1, &arguments->losses_to));
    }
    if (!(arguments->losses_from >= 0.0 && arguments->losses_from < arguments->losses_to)) {
        dalcs_cli_error(cli, "--losses: '%s' does not begin at 0 or later and before it ends",
                        text);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status parse_losses_plot(struct dalcs_arguments *arguments,
                                           const struct dalcs_cli *cli, const char *path) {
    if (arguments->steady) {
        dalcs_cli_error(cli, "--losses-plot is one of 'dalcs run'");
        return DALCS_E_OPTION;
    }
    arguments->losses_plot = path;
    if (!dalcs_figure_can_write(path)) {
        dalcs_cli_error(
            cli, "--losses-plot: cannot tell the format of '%s': name it .svg, .png or .pdf", path);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status check_measures(const struct dalcs_cli *cli, const char *path) {
    if (dalcs_table_find_format(path) != &dalcs_csv_format) {
        dalcs_cli_error(cli, "--measures: '%s' is no name of a table: name it .csv", path);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status take(struct dalcs_arguments *arguments, const struct dalcs_cli *cli,
                              int code, char **argv) {
    switch (code) {
    case 'o':
        return add_output(arguments, cli, optarg);
    case METHOD:
        return parse_method(arguments, cli, optarg);
    case DIALECT:
        return dalcs_verb_take_dialect(cli, optarg, &arguments->dialect);
    case TOL:
        return parse_tolerance(arguments, cli, optarg);
    case STAGES:
        return parse_stages(arguments, cli, optarg);
    case STEP:
        return parse_step(arguments, cli, optarg);
    case FILL:
        return parse_fill(arguments, cli, optarg);
    case CURVE:
        return parse_curve(arguments, cli, optarg);
    case COMPRESS:
        return parse_part(cli, "--compress", optarg, "", &arguments->compress);
    case AT:
        arguments->at = optarg;
        return DALCS_OK;
    case REPORT:
        arguments->report = optarg;
        return DALCS_OK;
    case PLOT:
        arguments->plot = optarg;
        if (!dalcs_figure_can_write(optarg)) {
            dalcs_cli_error(
                cli, "--plot: cannot tell the format of '%s': name it .svg, .png or .pdf", optarg);
            return DALCS_E_OPTION;
        }
        return DALCS_OK;
    case DUMP:
        arguments->dump = optarg;
        return DALCS_OK;
    case ALL_SIGNALS:
        arguments->all_signals = true;
        return DALCS_OK;
    case ENERGY:
        arguments->energy = true;
        return DALCS_OK;
    case LOSSES:
        return parse_losses(arguments, cli, optarg);
    case LOSSES_PLOT:
        return parse_losses_plot(arguments, cli, optarg);
    case AUDIT:
        return parse_audit(arguments, cli, optarg);
    case SET:
        arguments->set[arguments->n_set++] = optarg;
        return dalcs_settings_check(cli, optarg);
    case MEASURES:
        arguments->measures = optarg;
        return check_measures(cli, optarg);
    case PERIOD:
        return parse_period(arguments, cli, optarg);
    case ASCII:
        arguments->ascii = true;
        return DALCS_OK;
    case SPLIT_STEPS:
        arguments->split_steps = true;
        return DALCS_OK;
    case 'q':
        arguments->quiet = true;
        return DALCS_OK;
    case 'h':
        arguments->help = true;
        return DALCS_OK;
    default:
        return dalcs_verb_refuse(cli, arguments->steady ? "steady" : "run", option, code, argv);
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
    const bool has_default = arguments->n_outputs == 0 && !arguments->no_waveforms;
    if (has_default) {
        arguments->default_output = change_ending(base, ".raw");
        arguments->output[arguments->n_outputs++] = arguments->default_output;
    }
    const char *beside = arguments->n_outputs > 0 ? arguments->output[0] : base;
    if (!arguments->dump && beside) {
        arguments->default_dump = change_ending(beside, ".failed.dalcs");
        arguments->dump = arguments->default_dump;
    }
    if ((has_default && !arguments->default_output) || !arguments->dump) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(DALCS_E_NOMEM));
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_arguments_parse(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli, int argc, char **argv) {
    *arguments = (struct dalcs_arguments){
        .steady = strcmp(argv[0], "steady") == 0, .losses_from = NAN, .losses_to = INFINITY};
    arguments->output = dalcs_alloc((size_t)argc, sizeof *arguments->output);
    arguments->set = dalcs_alloc((size_t)argc, sizeof *arguments->set);
    if (!arguments->output || !arguments->set) {
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
    if (status == DALCS_OK && !arguments->help && arguments->at && arguments->compress > 0.0) {
        dalcs_cli_error(cli,
                        "--compress leaves rows out, --at asks for each of its own: choose one");
        status = DALCS_E_OPTION;
    }
    if (status == DALCS_OK && !arguments->help && arguments->at && arguments->fill > 0.0) {
        dalcs_cli_error(cli, "--fill adds rows, --at asks for its own alone: choose one");
        status = DALCS_E_OPTION;
    }
    if (status == DALCS_OK && !arguments->help) {
        status = dalcs_verb_take_netlist(cli, arguments->steady ? "steady" : "run", argc, argv,
                                         &arguments->netlist);
        status = status == DALCS_OK ? add_defaults(arguments, cli) : status;
    }
    if (status != DALCS_OK) {
        dalcs_arguments_finish(arguments);
    }
    return status;
}

void dalcs_arguments_finish(struct dalcs_arguments *arguments) {
    free(arguments->output);
    free(arguments->set);
    free(arguments->default_output);
    free(arguments->default_dump);
    *arguments = (struct dalcs_arguments){0};
}

/* arguments.c - reads the command line, then sets what was not asked for to its defaults. */
#include "arguments.h"

#include "argument_options.h"
#include "memory.h"
#include "verb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* Options that exclude one another. */
static enum dalcs_status check_together(const struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli) {
    if (arguments->files.no_waveforms && arguments->files.n_outputs > 0) {
        dalcs_cli_error(cli, "-o none writes no file, -o %s writes one: choose one",
                        arguments->files.output[0]);
        return DALCS_E_OPTION;
    }
    if (dalcs_arguments_have_times(arguments) && arguments->rows.compress > 0.0) {
        dalcs_cli_error(cli,
                        "--compress leaves rows out, --at prints each of its times: choose one");
        return DALCS_E_OPTION;
    }
    if (dalcs_arguments_have_times(arguments) && arguments->rows.fill > 0.0) {
        dalcs_cli_error(cli, "--fill adds rows, --at prints only its own times: choose one");
        return DALCS_E_OPTION;
    }
    if (arguments->steady.samples > 0 &&
        (arguments->files.plot || arguments->steady.multipliers_plot)) {
        dalcs_cli_error(cli, "--bifurcation and --samples draw many orbits: leave out --plot and "
                             "--multipliers-plot");
        return DALCS_E_OPTION;
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
    enum dalcs_status status = dalcs_arguments_read_options(arguments, cli, argc, argv);
    if (status == DALCS_OK && !arguments->help) {
        status = check_together(arguments, cli);
    }
    if (status == DALCS_OK && !arguments->help) {
        status = dalcs_verb_take_netlist(cli, dalcs_arguments_verb(arguments), argc, argv,
                                         &arguments->netlist);
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

/* argument_steady.c - what stands behind the options of `dalcs steady` alone. */
#include "argument_values.h"

#include "figure.h"
#include "status.h"
#include "verb.h"

/* Samples, where no others are asked for, and periods before them. */
enum { SAMPLES = 64, SETTLE = 256, MOST_SAMPLES = 1000000 };

static enum dalcs_status take_samples(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli) {
    if (!arguments->steady.is_asked) {
        dalcs_cli_error(cli, "--bifurcation, --samples and --settle are options of 'dalcs steady'");
        return DALCS_E_OPTION;
    }
    arguments->steady.samples = arguments->steady.samples > 0 ? arguments->steady.samples : SAMPLES;
    arguments->steady.settle = arguments->steady.settle > 0 ? arguments->steady.settle : SETTLE;
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_bifurcation(struct dalcs_arguments *arguments,
                                             const struct dalcs_cli *cli, const char *path) {
    arguments->steady.bifurcation = path;
    if (!dalcs_figure_can_write(path) && !dalcs_argument_is_page(path)) {
        dalcs_cli_error(
            cli, "--bifurcation: unknown format of '%s': name it .svg, .png, .pdf or .html", path);
        return DALCS_E_OPTION;
    }
    return take_samples(arguments, cli);
}

static enum dalcs_status take_periods(struct dalcs_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *name,
                                      const char *text, size_t *count) {
    DALCS_TRY(dalcs_verb_take_count(cli, name, text, count));
    if (*count > MOST_SAMPLES) {
        dalcs_cli_error(cli, "%s: more than %d periods", name, (int)MOST_SAMPLES);
        return DALCS_E_OPTION;
    }
    return take_samples(arguments, cli);
}

enum dalcs_status dalcs_argument_samples(struct dalcs_arguments *arguments,
                                         const struct dalcs_cli *cli, const char *text) {
    return take_periods(arguments, cli, "--samples", text, &arguments->steady.samples);
}

enum dalcs_status dalcs_argument_settle(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli, const char *text) {
    return take_periods(arguments, cli, "--settle", text, &arguments->steady.settle);
}

enum dalcs_status dalcs_argument_multipliers_plot(struct dalcs_arguments *arguments,
                                                  const struct dalcs_cli *cli, const char *path) {
    arguments->steady.multipliers_plot = path;
    if (!arguments->steady.is_asked) {
        dalcs_cli_error(cli, "--multipliers-plot is an option of 'dalcs steady'");
        return DALCS_E_OPTION;
    }
    if (!dalcs_figure_can_write(path) && !dalcs_argument_is_page(path)) {
        dalcs_cli_error(
            cli, "--multipliers-plot: unknown format of '%s': name it .svg, .png, .pdf or .html",
            path);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_argument_sensitivity(struct dalcs_arguments *arguments,
                                             const struct dalcs_cli *cli, const char *text) {
    (void)text;
    arguments->steady.sensitivity = true;
    if (!arguments->steady.is_asked) {
        dalcs_cli_error(cli, "--sensitivity is an option of 'dalcs steady'");
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

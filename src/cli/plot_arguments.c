/* plot_arguments.c - getopt_long, then checks that need no file. */
#include "plot_arguments.h"

#include "figure.h"
#include "memory.h"
#include "verb.h"

#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum {
    FROM = 256,
    TO,
    SPECTRUM,
    HISTOGRAM,
    TORNADO,
    FAMILY,
    REPORT,
    EVENTS,
    NO_BARS,
    THEME,
    PLOT,
    RUN,
    WIDTH
};

static const struct option option[] = {{"signals", required_argument, NULL, 's'},
                                       {"from", required_argument, NULL, FROM},
                                       {"to", required_argument, NULL, TO},
                                       {"spectrum", required_argument, NULL, SPECTRUM},
                                       {"output", required_argument, NULL, 'o'},
                                       {"report", required_argument, NULL, REPORT},
                                       {"events", no_argument, NULL, EVENTS},
                                       {"no-bars", no_argument, NULL, NO_BARS},
                                       {"theme", required_argument, NULL, THEME},
                                       {"plot", required_argument, NULL, PLOT},
                                       {"run", required_argument, NULL, RUN},
                                       {"width", required_argument, NULL, WIDTH},
                                       {"quiet", no_argument, NULL, 'q'},
                                       {"histogram", no_argument, NULL, HISTOGRAM},
                                       {"tornado", optional_argument, NULL, TORNADO},
                                       {"family", optional_argument, NULL, FAMILY},
                                       {"help", no_argument, NULL, 'h'},
                                       {NULL, 0, NULL, 0}};

static enum dalcs_status parse_number(const struct dalcs_cli *cli, const char *name,
                                      const char *text, double *value) {
    if (dalcs_parse_number(text, value) != DALCS_OK || !isfinite(*value)) {
        dalcs_cli_error(cli, "%s: '%s' is not a number; write 1m or 1e-3", name, text);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status parse_output(struct dalcs_plot_arguments *arguments,
                                      const struct dalcs_cli *cli, const char *path) {
    const char *dot = strrchr(path, '.');
    if (arguments->output != NULL) {
        dalcs_cli_error(cli, "one picture at a time: -o '%s' and -o '%s'", arguments->output, path);
        return DALCS_E_OPTION;
    }
    arguments->output = path;
    arguments->is_page = dot && (strcasecmp(dot, ".html") == 0 || strcasecmp(dot, ".htm") == 0);
    if (!arguments->is_page && !dalcs_figure_can_write(path)) {
        dalcs_cli_error(cli, "unknown format of '%s': name it .svg, .png, .pdf or .html", path);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status take_width(struct dalcs_plot_arguments *arguments,
                                    const struct dalcs_cli *cli, const char *text) {
    DALCS_TRY(dalcs_verb_take_count(cli, "--width", text, &arguments->width));
    if (arguments->width < DALCS_FIGURE_LEAST_WIDTH || arguments->width > DALCS_FIGURE_MOST_WIDTH) {
        dalcs_cli_error(cli, "--width: '%s' is not from %d to %d pixels", text,
                        DALCS_FIGURE_LEAST_WIDTH, DALCS_FIGURE_MOST_WIDTH);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status take_theme(struct dalcs_plot_arguments *arguments,
                                    const struct dalcs_cli *cli, const char *text) {
    arguments->theme = dalcs_theme_find(text);
    if (!arguments->theme) {
        dalcs_cli_error(cli, "--theme: '%s' is not light, dark or print", text);
        return DALCS_E_OPTION;
    }
    arguments->has_theme = true;
    return DALCS_OK;
}

static enum dalcs_status take(struct dalcs_plot_arguments *arguments, const struct dalcs_cli *cli,
                              int code, char **argv) {
    switch (code) {
    case 's':
        arguments->group[arguments->n_groups++] = optarg;
        return DALCS_OK;
    case FROM:
        return parse_number(cli, "--from", optarg, &arguments->from);
    case TO:
        return parse_number(cli, "--to", optarg, &arguments->to);
    case SPECTRUM:
        return dalcs_verb_take_positive(cli, "--spectrum", optarg, &arguments->spectrum);
    case HISTOGRAM:
        arguments->histogram = true;
        return DALCS_OK;
    case TORNADO:
    case FAMILY:
        *(code == TORNADO ? &arguments->tornado : &arguments->family) = optarg ? optarg : "";
        return DALCS_OK;
    case 'o':
        return parse_output(arguments, cli, optarg);
    case REPORT:
        arguments->report = optarg;
        return DALCS_OK;
    case EVENTS:
        arguments->marks = true;
        return DALCS_OK;
    case NO_BARS:
        arguments->no_bars = true;
        return DALCS_OK;
    case THEME:
        return take_theme(arguments, cli, optarg);
    case PLOT:
        return dalcs_verb_take_count(cli, "--plot", optarg, &arguments->plot);
    case RUN:
        return dalcs_verb_take_count(cli, "--run", optarg, &arguments->run);
    case WIDTH:
        return take_width(arguments, cli, optarg);
    case 'q':
        arguments->quiet = true;
        return DALCS_OK;
    case 'h':
        arguments->help = true;
        return DALCS_OK;
    default:
        return dalcs_verb_refuse(cli, "plot", option, code, argv);
    }
}

/* One chart is drawn, and it may not be over time. */
static enum dalcs_status check_charts(const struct dalcs_cli *cli,
                                      const struct dalcs_plot_arguments *arguments) {
    const struct {
        const char *name;
        bool given, has_time;
    } chart[] = {{"spectrum", arguments->spectrum > 0.0, false},
                 {"histogram", arguments->histogram, false},
                 {"tornado", arguments->tornado != NULL, false},
                 {"family", arguments->family != NULL, true}};

    const char *first = NULL;
    for (size_t k = 0; k < sizeof chart / sizeof chart[0]; k++) {
        if (!chart[k].given) {
            continue;
        }
        if (first != NULL) {
            dalcs_cli_error(cli, "--%s or --%s, not both", first, chart[k].name);
            return DALCS_E_OPTION;
        }
        if (arguments->report != NULL || arguments->marks) {
            dalcs_cli_error(cli, "--%s is not %s: leave out --report and --events", chart[k].name,
                            chart[k].has_time ? "of one run" : "over time");
            return DALCS_E_OPTION;
        }
        first = chart[k].name;
    }
    return DALCS_OK;
}

/* Pages have the width of their window, and other charts that of what they hold. */
static enum dalcs_status check_width(const struct dalcs_cli *cli,
                                     const struct dalcs_plot_arguments *arguments) {
    if (arguments->width == 0) {
        return DALCS_OK;
    }
    if (arguments->output == NULL || arguments->is_page || arguments->tornado != NULL ||
        arguments->family != NULL) {
        dalcs_cli_error(cli, "--width is for pictures of waveforms, spectra and histograms: give "
                             "-o a name that ends in .svg, .png or .pdf");
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_plot_arguments_parse(struct dalcs_plot_arguments *arguments,
                                             const struct dalcs_cli *cli, int argc, char **argv) {
    *arguments = (struct dalcs_plot_arguments){.from = NAN, .to = NAN, .theme = &dalcs_theme_light};
    arguments->group = dalcs_alloc((size_t)argc, sizeof *arguments->group);
    if (!arguments->group) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(DALCS_E_NOMEM));
        return DALCS_E_NOMEM;
    }
    optind = 0; /* glibc: start afresh */
    enum dalcs_status status = DALCS_OK;
    for (int code = 0; status == DALCS_OK && !arguments->help;) {
        code = getopt_long(argc, argv, ":s:o:qh", option, NULL);
        if (code < 0) {
            break;
        }
        status = take(arguments, cli, code, argv);
    }
    if (status == DALCS_OK && !arguments->help && optind + 1 != argc) {
        if (optind == argc) {
            dalcs_cli_error(cli, "no file given; see 'dalcs plot --help'");
        } else {
            dalcs_verb_one_too_many(cli, "plot", argv[argc - 1]);
        }
        status = DALCS_E_OPTION;
    }
    if (status == DALCS_OK && !arguments->help) {
        status = check_charts(cli, arguments);
    }
    if (status == DALCS_OK && !arguments->help) {
        status = check_width(cli, arguments);
    }
    if (status == DALCS_OK && !arguments->help && arguments->has_theme &&
        arguments->output == NULL) {
        dalcs_cli_error(cli, "--theme is for pictures and pages: give -o a name that ends in .svg, "
                             ".png, .pdf or .html");
        status = DALCS_E_OPTION;
    }
    if (status == DALCS_OK && arguments->is_page && arguments->theme == &dalcs_theme_print) {
        dalcs_cli_error(cli, "--theme print is for pictures: a page is light or dark");
        status = DALCS_E_OPTION;
    }
    if (status != DALCS_OK) {
        dalcs_plot_arguments_finish(arguments);
        return status;
    }
    arguments->file = arguments->help ? NULL : argv[optind];
    return DALCS_OK;
}

void dalcs_plot_arguments_finish(struct dalcs_plot_arguments *arguments) {
    free(arguments->group);
    arguments->group = NULL;
}

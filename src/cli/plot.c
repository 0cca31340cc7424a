/* plot.c - `dalcs plot`: read a file of waveforms, choose, draw. */
#include "plot.h"

#include "decibels.h"
#include "histogram.h"
#include "plot_charts.h"
#include "plot_drawing.h"
#include "report_reader.h"
#include "spectrum.h"
#include "text_plot.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

static const char help[] =
    "usage: dalcs plot FILE [options]\n"
    "\n"
    "Draws the waveforms of a .raw or .csv file, of dalcs or of another SPICE: a panel for each\n"
    "unit, and below them when diodes and switches conduct. Without -o it draws on the terminal.\n"
    "FILE may be -, the standard input.\n"
    "\n"
    "  -o, --output FILE   what is drawn, by its name: .svg, .png or .pdf with gnuplot, .html for\n"
    "                      a page with zoom, cursors and a list of the signals\n"
    "  -s, --signals LIST  signals and expressions of them, separated by commas:\n"
    "                      'v(out),v(a,b)' 'v(out)*i(r1)' 'db(v(out))'; may be repeated: each\n"
    "                      list gets panels of its own (default: all, outputs first)\n"
    "      --from T, --to T  the range of the time axis, SPICE suffixes allowed: 1m\n"
    "      --spectrum F    amplitudes over frequency up to F Hz, of the range from --from to "
    "--to:\n"
    "                      take whole periods\n"
    "      --histogram     how often each value of one signal occurs, of a table with a row a run\n"
    "      --tornado[=A,B] how far one result moves with each value: of a table that .wcase wrote, "
    "or\n"
    "                      of any other one with the columns A and B for values\n"
    "      --family[=A]    one signal of all runs of .step over each other, coloured by A\n"
    "      --report FILE   take the events from what dalcs run --report wrote, or the margins "
    "from\n"
    "                      what dalcs bode --loop --report wrote; without it\n"
    "                      conduction is read off the currents i(d1), i(s1) in FILE\n"
    "      --events        mark events and jumps with lines\n"
    "      --no-bars       leave out when diodes and switches conduct\n"
    "      --theme NAME    light (default), dark, or print: greys and patterns\n"
    "      --width N       in pixels, of a PDF in hundredths of an inch (default: 1200): the text\n"
    "                      keeps its size, so 600 to 800 is for a column of a page\n"
    "      --plot N        which plot of a .raw file with several (default: the last with rows)\n"
    "      --run N         which run of a sweep, where the axis starts again (default: 1)\n"
    "  -q, --quiet         print nothing but warnings and errors\n"
    "  -h, --help          this text\n"
    "\n"
    "examples:\n"
    "  dalcs plot buck.raw\n"
    "  dalcs plot buck.raw -s 'v(sw),v(out)' -s 'i(l1)' --from 0.9m -o buck.svg\n"
    "  dalcs plot buck.raw --report buck.json --events --from 0.97m -o buck.png\n"
    "  dalcs plot buck.raw -o buck.html\n"
    "\n"
    "exit status: 0 ok, 2 usage, or the file holds no such waveforms, 4 input/output\n";

static void write_messages(struct dalcs_drawing *drawing) {
    for (; drawing->n_written < drawing->diag.n; drawing->n_written++) {
        const struct dalcs_diagnostic *item = &drawing->diag.item[drawing->n_written];
        if (item->severity != DALCS_NOTE || !drawing->arguments->quiet) {
            fprintf(drawing->cli->err, "dalcs: %s\n", item->text);
        }
    }
}

/* ---- The file ------------------------------------------------------------------------------- */

/* Where a sweep or several starts follow one another, one of them. */
static enum dalcs_status choose_run(struct dalcs_drawing *drawing) {
    struct dalcs_waveforms *waveforms = &drawing->waveforms;
    size_t first = 0, end = 0, run = drawing->arguments->run > 0 ? drawing->arguments->run : 1;
    size_t n = dalcs_waveforms_find_run(waveforms, run, &first, &end);
    if (waveforms->n_rows > 0 && run > n) {
        dalcs_diag_add(&drawing->diag, DALCS_ERROR, NULL, NULL,
                       "'%s' has %zu run%s: there is no run %zu", drawing->arguments->file, n,
                       n == 1 ? "" : "s", run);
        return DALCS_E_OPTION;
    }
    if (drawing->arguments->is_page && drawing->arguments->run == 0 &&
        !drawing->arguments->report && !(drawing->arguments->spectrum > 0.0)) {
        DALCS_TRY(dalcs_runs_find(&drawing->runs, waveforms));
    }
    if (n > 1 && drawing->arguments->run == 0 && drawing->runs.n == 0) {
        dalcs_diag_add(&drawing->diag, DALCS_NOTE, NULL, NULL,
                       "%s starts again: this is the first of %zu runs; --run N draws another",
                       waveforms->name[0], n);
    }
    dalcs_waveforms_keep_rows(waveforms, first, end);
    return DALCS_OK;
}

/* The selection becomes one of the table that is made of it. */
static enum dalcs_status remake(struct dalcs_drawing *drawing) {
    const struct dalcs_plot_arguments *arguments = drawing->arguments;
    struct dalcs_selection of_made;
    DALCS_TRY(arguments->histogram
                  ? dalcs_histogram_make(&drawing->made, &drawing->selection, &drawing->diag)
                  : dalcs_spectrum_make(&drawing->made, &drawing->selection, arguments->spectrum,
                                        &drawing->diag));
    DALCS_TRY(dalcs_selection_make(&of_made, &drawing->made, NULL, 0, NAN, NAN, &drawing->diag));
    dalcs_selection_finish(&drawing->selection);
    drawing->selection = of_made;
    if (arguments->histogram) {
        drawing->selection.panel[0].quantity = "number of runs";
    }
    return DALCS_OK;
}

/* What is known beside the file. */
static enum dalcs_status read_report(struct dalcs_drawing *drawing) {
    const char *report = drawing->arguments->report;
    if (drawing->run) {
        DALCS_TRY(dalcs_conduction_add_report(&drawing->conduction, drawing->run));
        return dalcs_margin_lines_add_report(&drawing->lines, drawing->run);
    }
    if (report) {
        DALCS_TRY(dalcs_report_reader_read(report, &drawing->conduction, &drawing->diag));
        DALCS_TRY(dalcs_report_reader_margins(report, &drawing->lines, &drawing->diag));
    }
    return DALCS_OK;
}

/* Without signals of the caller's choice, the gain of a loop with its margins, or a response. group: both NULL, neither of them. */
static enum dalcs_status choose_response(struct dalcs_drawing *drawing, const char *group[2]) {
    const bool is_response =
        drawing->waveforms.complex_values || (drawing->run && drawing->run->response.present);
    group[0] = group[1] = NULL;
    return drawing->arguments->n_groups == 0 && (drawing->lines.loop || is_response)
               ? dalcs_decibels_choose(&drawing->waveforms, drawing->lines.loop,
                                       &drawing->lines.arena, group)
               : DALCS_OK;
}

static enum dalcs_status select_signals(struct dalcs_drawing *drawing) {
    DALCS_TRY(choose_response(drawing, drawing->response));
    const bool is_chosen = drawing->response[0] != NULL;
    if (!is_chosen || !drawing->lines.loop) {
        drawing->lines.n = 0;
    }
    DALCS_TRY(dalcs_drawing_select(drawing, &drawing->waveforms, &drawing->selection));
    if (drawing->waveforms
            .complex_values) { /* events are of the orbit, and the axis of frequencies */
        dalcs_conduction_finish(&drawing->conduction);
    }
    return DALCS_OK;
}

static enum dalcs_status read_file(struct dalcs_drawing *drawing) {
    const struct dalcs_plot_arguments *arguments = drawing->arguments;
    struct dalcs_waveforms *waveforms = &drawing->waveforms;
    DALCS_TRY(
        dalcs_waveforms_read_file(waveforms, arguments->file, arguments->plot, &drawing->diag));
    if (waveforms->n_plots > 1 && arguments->plot == 0) {
        dalcs_diag_add(&drawing->diag, DALCS_NOTE, NULL, NULL,
                       "this is plot %zu of %zu, %s; --plot N draws another", waveforms->plot,
                       waveforms->n_plots, waveforms->plot_name);
    }
    if (arguments->n_groups == 0 && waveforms->n_columns > 1 &&
        strncmp(waveforms->name[1], "re(", 3) == 0) {
        dalcs_diag_add(&drawing->diag, DALCS_NOTE, NULL, NULL,
                       "these are real and imaginary parts; from a .raw file, levels in dB and "
                       "phases are drawn");
    }
    DALCS_TRY(choose_run(drawing));
    drawing->title = dalcs_plot_title(waveforms, arguments->file);
    if (arguments->spectrum > 0.0 || arguments->histogram) {
        DALCS_TRY(dalcs_selection_make(&drawing->selection, waveforms, arguments->group,
                                       arguments->n_groups, arguments->from, arguments->to,
                                       &drawing->diag));
        return remake(drawing);
    }
    DALCS_TRY(read_report(drawing));
    DALCS_TRY(select_signals(drawing));
    return dalcs_selection_add_conduction(&drawing->selection, &drawing->conduction);
}

/* ---- Drawing -------------------------------------------------------------------------------- */

static enum dalcs_status add_row(void *user, double at, const double *value) {
    dalcs_figure_row(user, at, value);
    return DALCS_OK;
}

static enum dalcs_status compose(struct dalcs_drawing *drawing, struct dalcs_figure *figure) {
    const struct dalcs_selection *selection = &drawing->selection;
    const struct dalcs_plot_arguments *arguments = drawing->arguments;
    dalcs_figure_init(figure, arguments->output, selection->start, selection->stop);
    figure->axis = selection->axis;
    figure->theme = arguments->theme;
    figure->width = arguments->width > 0 ? (int)arguments->width : DALCS_FIGURE_WIDTH;
    figure->conduction = &drawing->conduction;
    figure->bars = !arguments->no_bars;
    figure->marks = arguments->marks;
    figure->line = drawing->lines.line;
    figure->n_lines = drawing->lines.n;
    DALCS_TRY(dalcs_figure_begin_panels(figure, drawing->title, selection->name, selection->panel,
                                        selection->n_panels));
    return dalcs_selection_each_row(selection, add_row, figure);
}

static enum dalcs_status draw_picture(struct dalcs_drawing *drawing) {
    struct dalcs_figure figure;
    enum dalcs_status status = compose(drawing, &figure);
    if (status == DALCS_OK) {
        status = dalcs_figure_draw(&figure, NULL, NULL);
    }
    if (figure.message[0]) {
        dalcs_cli_error(drawing->cli, "cannot draw '%s': %s", figure.path, figure.message);
    } else if (figure.file.error != 0) {
        status = dalcs_drawing_refuse_output(drawing, figure.file.error);
    }
    dalcs_figure_finish(&figure);
    return status;
}

static int terminal_width(FILE *stream) {
    struct winsize size;
    const char *columns = getenv("COLUMNS");
    if (columns && atoi(columns) > 0) {
        return atoi(columns);
    }
    bool known = ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : 80;
}

/* Does the terminal show Unicode, by the locale? */
static bool shows_unicode(void) {
    static const char *const variable[] = {"LC_ALL", "LC_CTYPE", "LANG"};
    for (size_t i = 0; i < sizeof variable / sizeof variable[0]; i++) {
        const char *value = getenv(variable[i]);
        if (value && *value) {
            return strstr(value, "UTF-8") || strstr(value, "utf8") || strstr(value, "UTF8");
        }
    }
    return false;
}

static enum dalcs_status draw_text(struct dalcs_drawing *drawing) {
    FILE *out = drawing->cli->out;
    bool colors = isatty(fileno(out)) == 1 && !getenv("NO_COLOR");
    const struct dalcs_text_plot_options options = {terminal_width(out), shows_unicode(), colors};
    struct dalcs_figure figure;
    enum dalcs_status status = compose(drawing, &figure);
    if (status == DALCS_OK) {
        status = dalcs_text_plot_write(out, &figure, &options);
    }
    dalcs_figure_finish(&figure);
    return status;
}

/* The output must not take the place of what was read. */
static enum dalcs_status check_paths(const struct dalcs_cli *cli,
                                     const struct dalcs_plot_arguments *arguments) {
    const char *const input[] = {arguments->file, arguments->report};
    struct stat a, b;
    for (size_t i = 0; i < 2 && arguments->output; i++) {
        if (input[i] && stat(input[i], &a) == 0 && stat(arguments->output, &b) == 0 &&
            a.st_dev == b.st_dev && a.st_ino == b.st_ino) {
            dalcs_cli_error(cli, "'%s' is the input: give another name with -o", arguments->output);
            return DALCS_E_OPTION;
        }
    }
    return DALCS_OK;
}

static enum dalcs_status draw_checked(struct dalcs_drawing *drawing) {
    const struct dalcs_plot_arguments *arguments = drawing->arguments;
    if (arguments->tornado != NULL || arguments->family != NULL) {
        return dalcs_plot_chart_draw(drawing->cli, arguments, terminal_width(drawing->cli->out),
                                     &drawing->diag);
    }
    DALCS_TRY(read_file(drawing));
    write_messages(drawing);
    return !arguments->output   ? draw_text(drawing)
           : arguments->is_page ? dalcs_drawing_write_page(drawing)
                                : draw_picture(drawing);
}

static enum dalcs_status draw(const struct dalcs_cli *cli,
                              const struct dalcs_plot_arguments *arguments,
                              const struct dalcs_report *run) {
    struct dalcs_drawing drawing = {.cli = cli, .arguments = arguments, .run = run};
    enum dalcs_status status = check_paths(cli, arguments);
    if (status == DALCS_OK) {
        status = draw_checked(&drawing);
        write_messages(&drawing);
        if (status == DALCS_E_NOMEM || drawing.diag.out_of_memory) {
            dalcs_cli_error(cli, "%s", dalcs_status_text(DALCS_E_NOMEM));
        }
    }
    if (status == DALCS_OK && arguments->output && !arguments->quiet) {
        fprintf(cli->out, "wrote %s\n", arguments->output);
    }
    dalcs_margin_lines_finish(&drawing.lines);
    dalcs_conduction_finish(&drawing.conduction);
    dalcs_selection_finish(&drawing.selection);
    dalcs_runs_finish(&drawing.runs);
    dalcs_waveforms_finish(&drawing.made);
    dalcs_waveforms_finish(&drawing.waveforms);
    dalcs_diag_finish(&drawing.diag);
    return status;
}

enum dalcs_status dalcs_cli_draw_file(const struct dalcs_cli *cli, const char *file,
                                      const char *output, const struct dalcs_report *report,
                                      bool quiet) {
    const char *dot = strrchr(output, '.');
    const struct dalcs_plot_arguments arguments = {.file = file,
                                                   .output = output,
                                                   .is_page = strcasecmp(dot, ".html") == 0 ||
                                                              strcasecmp(dot, ".htm") == 0,
                                                   .from = NAN,
                                                   .to = NAN,
                                                   .theme = &dalcs_theme_light,
                                                   .quiet = true};
    DALCS_TRY(draw(cli, &arguments, report));
    if (!quiet) {
        fprintf(cli->out, "  wrote     %s\n", output);
    }
    return DALCS_OK;
}

enum dalcs_exit dalcs_cli_plot(const struct dalcs_cli *cli, int argc, char **argv) {
    struct dalcs_plot_arguments arguments;
    enum dalcs_status status = dalcs_plot_arguments_parse(&arguments, cli, argc, argv);
    if (status != DALCS_OK) {
        return dalcs_cli_exit(status);
    }
    if (arguments.help) {
        fputs(help, cli->out);
    } else {
        status = draw(cli, &arguments, NULL);
    }
    dalcs_plot_arguments_finish(&arguments);
    return dalcs_cli_exit(status);
}

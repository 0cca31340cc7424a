/* plot_charts.c - `dalcs plot --tornado` and `--family`. */
#include "plot_charts.h"

#include "family.h"
#include "tornado.h"

#include <string.h>

const char *dalcs_plot_title(const struct dalcs_waveforms *waveforms, const char *file) {
    const char *slash = strrchr(file, '/');
    return waveforms->title[strspn(waveforms->title, "* ")] != '\0' ? waveforms->title
           : slash != NULL                                          ? slash + 1
                                                                    : file;
}

static enum dalcs_status tell_failure(const struct dalcs_cli *cli, enum dalcs_status status,
                                      const char *path, const char *message) {
    if (status != DALCS_OK) {
        dalcs_cli_error(cli, "cannot draw '%s': %s", path, message);
    }
    return status;
}

static enum dalcs_status draw_tornado(const struct dalcs_cli *cli,
                                      const struct dalcs_plot_arguments *arguments, int width,
                                      struct dalcs_waveforms *waveforms, struct dalcs_diag *diag) {
    struct dalcs_tornado tornado = {.title = dalcs_plot_title(waveforms, arguments->file),
                                    .theme = arguments->theme};
    char message[DALCS_GNUPLOT_MESSAGE];
    if (arguments->n_groups != 1) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, "choose it with -s",
                       "a tornado chart shows one column of the table");
        return DALCS_E_OPTION;
    }
    DALCS_TRY(dalcs_tornado_make(&tornado, waveforms, arguments->group[0],
                                 arguments->tornado[0] != '\0' ? arguments->tornado : NULL, diag));
    if (arguments->output == NULL) {
        dalcs_tornado_text_write(cli->out, &tornado, width);
        return DALCS_OK;
    }
    return tell_failure(cli, dalcs_tornado_chart_draw(&tornado, arguments->output, message),
                        arguments->output, message);
}

static enum dalcs_status draw_family(const struct dalcs_cli *cli,
                                     const struct dalcs_plot_arguments *arguments,
                                     struct dalcs_waveforms *waveforms, struct dalcs_diag *diag) {
    struct dalcs_family family = {.title = dalcs_plot_title(waveforms, arguments->file),
                                  .theme = arguments->theme};
    char message[DALCS_GNUPLOT_MESSAGE];
    if (arguments->output == NULL) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL,
                       "give -o a name that ends in .svg, .png, .pdf or .html",
                       "a family of curves is not drawn as text");
        return DALCS_E_OPTION;
    }
    DALCS_TRY(dalcs_family_make(&family, waveforms, arguments->group, arguments->n_groups,
                                arguments->from, arguments->to, arguments->family, diag));
    const enum dalcs_status status =
        tell_failure(cli, dalcs_family_chart_draw(&family, arguments->output, message),
                     arguments->output, message);
    dalcs_family_finish(&family);
    return status;
}

enum dalcs_status dalcs_plot_chart_draw(const struct dalcs_cli *cli,
                                        const struct dalcs_plot_arguments *arguments, int width,
                                        struct dalcs_diag *diag) {
    struct dalcs_waveforms waveforms;
    const bool is_tornado = arguments->tornado != NULL;
    enum dalcs_status status =
        dalcs_waveforms_read_file(&waveforms, arguments->file, arguments->plot, diag);
    if (status != DALCS_OK) {
        return status;
    }
    status = is_tornado ? draw_tornado(cli, arguments, width, &waveforms, diag)
                        : draw_family(cli, arguments, &waveforms, diag);
    dalcs_waveforms_finish(&waveforms);
    return status;
}

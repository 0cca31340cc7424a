/* chart_script.c - the beginning and the end of a chart's script. */
#include "chart_script.h"

#include "gnuplot_page.h"

#include <errno.h>
#include <string.h>
#include <strings.h>

enum { INCH = 100 };

void dalcs_chart_script_begin(FILE *script, const char *path, int wide, int tall,
                              const struct dalcs_theme *theme, const char *title) {
    const char *dot = strrchr(path, '.');
    const char *looks = "font 'DejaVu Sans,12' noenhanced rounded background";
    fputs("set encoding utf8\n", script);
    if (strcasecmp(dot, ".pdf") == 0) {
        fprintf(script, "set terminal pdfcairo size %gin,%gin %s '%s'\n", (double)wide / INCH,
                (double)tall / INCH, looks, theme->background);
    } else {
        fprintf(script, "set terminal %s size %d,%d %s '%s'\n",
                strcasecmp(dot, ".svg") == 0 ? "svg" : "pngcairo", wide, tall, looks,
                theme->background);
    }
    fputs("set title ", script);
    dalcs_gnuplot_write_quoted(script, title + strspn(title, "* "), wide / 11);
    fprintf(script,
            " textcolor rgb '%s'\nset border 3 lc rgb '%s'\nset grid lc rgb '%s' lt 1\n"
            "set tics nomirror out scale 0.5 textcolor rgb '%s'\nset key textcolor rgb '%s'\n",
            theme->text, theme->border, theme->grid, theme->text, theme->text);
}

enum dalcs_status dalcs_chart_script_draw(FILE *script, const char *path,
                                          char message[DALCS_GNUPLOT_MESSAGE]) {
    struct dalcs_atomic_file file = {0};
    message[0] = '\0';
    enum dalcs_status status = dalcs_atomic_file_open(&file, path);
    status = status == DALCS_OK ? dalcs_gnuplot_run(script, &file, message) : status;
    status = status == DALCS_OK ? dalcs_atomic_file_commit(&file) : status;
    if (status != DALCS_OK && message[0] == '\0') {
        snprintf(message, DALCS_GNUPLOT_MESSAGE, "%s",
                 strerror(file.error != 0 ? file.error : errno));
    }
    dalcs_atomic_file_discard(&file);
    return status;
}

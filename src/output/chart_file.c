/* chart_file.c - runs gnuplot; a page has its picture in itself, and loads nothing. */
#include "chart_file.h"

#include "gnuplot_page.h"

#include <errno.h>
#include <string.h>
#include <strings.h>

enum { INCH = 100 };

static bool ends_in(const char *path, const char *ending) {
    const char *dot = strrchr(path, '.');
    return dot != NULL && strcasecmp(dot, ending) == 0;
}

bool dalcs_chart_is_page(const char *path) {
    return ends_in(path, ".html") || ends_in(path, ".htm");
}

void dalcs_chart_write_terminal(FILE *script, const char *path, const struct dalcs_theme *theme,
                                int width, int height) {
    const char *looks = "font 'DejaVu Sans,12' noenhanced rounded background";
    const char *background = theme->background;
    if (ends_in(path, ".pdf")) {
        fprintf(script, "set terminal pdfcairo size %gin,%gin %s '%s'\n", (double)width / INCH,
                (double)height / INCH, looks, background);
    } else {
        fprintf(script, "set terminal %s size %d,%d %s '%s'\n",
                ends_in(path, ".png") ? "pngcairo" : "svg", width, height, looks, background);
    }
}

void dalcs_chart_begin_script(FILE *script, const char *path, const struct dalcs_theme *theme,
                              int width, int height, const char *title) {
    fputs("set encoding utf8\n", script);
    dalcs_chart_write_terminal(script, path, theme, width, height);
    fputs("set title ", script);
    dalcs_gnuplot_write_quoted(script, title + strspn(title, "* "), width / 11);
    fprintf(script,
            " textcolor rgb '%s'\nset border 3 lc rgb '%s'\nset grid lc rgb '%s' lt 1\n"
            "set tics nomirror out scale 0.5 textcolor rgb '%s'\nset key textcolor rgb '%s'\n",
            theme->text, theme->border, theme->grid, theme->text, theme->text);
}

static enum dalcs_status wrap(FILE *picture, const char *title, FILE *page) {
    char part[4096];
    bool begun = false;
    fprintf(page,
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
            "<title>%s</title></head><body>\n",
            title);
    rewind(picture);
    while (fgets(part, sizeof part, picture) != NULL) {
        begun = begun || strncmp(part, "<svg", 4) == 0;
        if (begun) {
            fputs(part, page);
        }
    }
    fputs("</body></html>\n", page);
    return begun && !ferror(picture) && !ferror(page) ? DALCS_OK : DALCS_E_IO;
}

/* By a picture in a temporary file. */
static enum dalcs_status draw_page(FILE *script, const char *title, struct dalcs_atomic_file *file,
                                   char *message) {
    struct dalcs_atomic_file picture = {.stream = tmpfile()};
    if (picture.stream == NULL) {
        return DALCS_E_IO;
    }
    enum dalcs_status status = dalcs_gnuplot_run(script, &picture, message);
    status = status == DALCS_OK ? wrap(picture.stream, title, file->stream) : status;
    fclose(picture.stream);
    return status;
}

enum dalcs_status dalcs_chart_draw(void (*write)(FILE *script, const void *chart, const char *path),
                                   const void *chart, const char *path, const char *title,
                                   char message[DALCS_GNUPLOT_MESSAGE]) {
    struct dalcs_atomic_file file = {0};
    FILE *script = tmpfile();
    enum dalcs_status status = DALCS_E_IO;
    message[0] = '\0';
    if (script != NULL) {
        write(script, chart, path);
        status = dalcs_atomic_file_open(&file, path);
        if (status == DALCS_OK) {
            status = dalcs_chart_is_page(path) ? draw_page(script, title, &file, message)
                                               : dalcs_gnuplot_run(script, &file, message);
        }
        status = status == DALCS_OK ? dalcs_atomic_file_commit(&file) : status;
    }
    if (status != DALCS_OK && message[0] == '\0') {
        snprintf(message, DALCS_GNUPLOT_MESSAGE, "%s",
                 strerror(file.error != 0 ? file.error : errno));
    }
    dalcs_atomic_file_discard(&file);
    if (script != NULL) {
        fclose(script);
    }
    return status;
}

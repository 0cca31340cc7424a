/* chart.c - a script in a temporary file, gnuplot on it, its SVG onto the page. */
#include "chart.h"

#include "process.h"
#include "utf8.h"

#include <errno.h>
#include <string.h>

const char *const dalcs_chart_colour[DALCS_CHART_COLOURS] = {
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a52a3", "#5f6368",
};

FILE *dalcs_chart_begin(const char *name, int width, int height) {
    FILE *script = tmpfile();
    if (script) {
        fprintf(script,
                "set encoding utf8\n"
                "set terminal svg name '%s' size %d,%d font 'DejaVu Sans,13' noenhanced rounded "
                "background 'white'\n",
                name, width, height);
        fputs("set border 3 lc rgb '#80868b' lw 1\n"
              "set grid xtics ytics lc rgb '#e3e6ea' lw 1 lt 1\n"
              "set tics nomirror out scale 0.5 textcolor rgb '#3c4043'\n"
              "set key outside right top Left reverse samplen 1.8 spacing 1.25 "
              "textcolor rgb '#202124'\n",
              script);
    }
    return script;
}

void dalcs_chart_write_quoted(FILE *script, const char *text) {
    fputc('\'', script);
    for (const char *c = text; *c;) {
        size_t length = dalcs_utf8_length(c);
        if (length == 0 || (unsigned char)*c < 0x20) {
            fputc('?', script);
        } else {
            fwrite("'", 1, *c == '\'' ? 1 : 0, script);
            fwrite(c, 1, length, script);
        }
        c += length > 0 ? length : 1;
    }
    fputc('\'', script);
}

/* From <svg on: what comes before belongs to a file of its own. */
static void copy_picture(FILE *picture, FILE *page) {
    char line[4096];
    bool inside = false;
    rewind(picture);
    while (fgets(line, sizeof line, picture)) {
        inside = inside || strncmp(line, "<svg", 4) == 0;
        if (inside) {
            fputs(line, page);
        }
    }
}

/* The last line that says something. */
static void explain(FILE *errors, char message[256]) {
    char line[200], last[sizeof line] = "no reason given";
    rewind(errors);
    while (fgets(line, sizeof line, errors)) {
        line[strcspn(line, "\n")] = '\0';
        if (line[strspn(line, " ^\t")] != '\0') {
            memcpy(last, line, sizeof last);
        }
    }
    snprintf(message, 256, "gnuplot failed: %s", last);
}

enum dalcs_status dalcs_chart_end(FILE *script, FILE *page, char message[256]) {
    static const char *const argument[] = {"gnuplot", "-d", "-", NULL};
    FILE *picture = tmpfile(), *errors = tmpfile();
    enum dalcs_status status = DALCS_E_IO;
    if (!picture || !errors || fflush(script) != 0 || fseek(script, 0, SEEK_SET) != 0) {
        snprintf(message, 256, "cannot write a temporary file: %s", strerror(errno));
    } else {
        struct dalcs_process gnuplot = {
            .argument = argument, .input = script, .output = picture, .errors = errors};
        status = dalcs_process_run(&gnuplot);
        if (gnuplot.is_missing) {
            snprintf(message, 256,
                     "gnuplot is not installed (on Debian: apt-get install gnuplot-nox)");
        } else if (status != DALCS_OK) {
            snprintf(message, 256, "cannot run gnuplot: %s", strerror(errno));
        } else if (gnuplot.exit_status != 0) {
            explain(errors, message);
            status = DALCS_E_IO;
        } else {
            copy_picture(picture, page);
        }
    }
    fclose(script);
    if (picture) {
        fclose(picture);
    }
    if (errors) {
        fclose(errors);
    }
    return status;
}

/* times.c - output times: of a file, one a line, and of the command line. */
#include "times.h"

#include "memory.h"
#include "quantity.h"
#include "text_file.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define ROUNDING 1e-9 /* a time this little after the end is meant to be the end */

static const char blank[] = " \t\r\n";

static enum dalcs_status add_line(struct dalcs_times *times, size_t *capacity,
                                  const struct dalcs_cli *cli, const char *path, double stop,
                                  long line, char *text) {
    text += strspn(text, blank);
    text[strcspn(text, blank)] = '\0'; /* the first word: the rest may be other columns */
    if (*text == '\0' || *text == '#' || *text == '*') {
        return DALCS_OK;
    }
    double time = 0.0;
    if (dalcs_parse_number(text, &time) != DALCS_OK || time < 0.0) {
        dalcs_cli_error(cli, "%s:%ld: '%s' is not a time", path, line, text);
        return DALCS_E_OPTION;
    }
    if (time > stop && time <= stop * (1.0 + ROUNDING)) {
        time = stop;
    }
    if (time > stop) {
        dalcs_cli_error(cli, "%s:%ld: '%s' comes after the end of the run", path, line, text);
        return DALCS_E_OPTION;
    }
    if (times->n > 0 && time <= times->time[times->n - 1]) {
        dalcs_cli_error(cli, "%s:%ld: '%s' does not come after the time before it", path, line,
                        text);
        return DALCS_E_OPTION;
    }
    enum dalcs_status status =
        dalcs_grow(&times->time, capacity, times->n + 1, sizeof *times->time);
    if (status != DALCS_OK) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(status));
        return status;
    }
    times->time[times->n++] = time;
    return DALCS_OK;
}

/* Of a text that ends with a NUL. */
static enum dalcs_status read_lines(struct dalcs_times *times, size_t *capacity,
                                    const struct dalcs_cli *cli, const char *path, double stop,
                                    char *text) {
    enum dalcs_status status = DALCS_OK;
    for (long line = 1; status == DALCS_OK && text != NULL; line++) {
        char *begin = strsep(&text, "\n");
        status = add_line(times, capacity, cli, path, stop, line, begin);
    }
    return status;
}

/* One time a line up to `stop`. */
static enum dalcs_status read_file(struct dalcs_times *times, size_t *capacity,
                                   const struct dalcs_cli *cli, const char *path, double stop) {
    struct dalcs_diag said = {0};
    char *text = NULL;
    size_t length = 0;
    enum dalcs_status status = dalcs_text_file_read(path, SIZE_MAX, &text, &length, NULL, &said);
    for (size_t k = 0; k < said.n; k++) {
        fprintf(cli->err, "dalcs: %s\n", said.item[k].text);
    }
    dalcs_diag_finish(&said);
    char *ended = status == DALCS_OK ? realloc(text, length + 1) : NULL;
    if (ended == NULL) {
        free(text);
        return status == DALCS_OK ? DALCS_E_NOMEM : status;
    }
    ended[length] = '\0';
    dalcs_text_end_lines(ended, length);
    status = read_lines(times, capacity, cli, path, stop, ended);
    if (status == DALCS_OK && times->n == 0) {
        dalcs_cli_error(cli, "'%s' holds no times", path);
        status = DALCS_E_OPTION;
    }
    free(ended);
    return status;
}

static int compare(const void *left, const void *right) {
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* Those of the command line, which may come in any order, to those of the file. */
static enum dalcs_status add_list(struct dalcs_times *times, size_t *capacity,
                                  const struct dalcs_cli *cli,
                                  const struct dalcs_arguments *arguments, double stop) {
    if (dalcs_grow(&times->time, capacity, times->n + arguments->rows.n_times,
                   sizeof *times->time) != DALCS_OK) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(DALCS_E_NOMEM));
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < arguments->rows.n_times; k++) {
        const double time = arguments->rows.times[k];
        if (time > stop * (1.0 + ROUNDING)) {
            char text[2][DALCS_QUANTITY_SIZE];
            dalcs_cli_error(cli, "--at: %s comes after the end of the run, %s",
                            dalcs_quantity_write(text[0], time, "s", 9),
                            dalcs_quantity_write(text[1], stop, "s", 9));
            return DALCS_E_OPTION;
        }
        times->time[times->n++] = time > stop ? stop : time;
    }
    qsort(times->time, times->n, sizeof *times->time, compare);
    size_t n = 1;
    for (size_t k = 1; k < times->n; k++) {
        if (times->time[k] > times->time[n - 1]) {
            times->time[n++] = times->time[k];
        }
    }
    times->n = n;
    return DALCS_OK;
}

enum dalcs_status dalcs_times_read(struct dalcs_times *times, const struct dalcs_cli *cli,
                                   const struct dalcs_arguments *arguments, double stop) {
    *times = (struct dalcs_times){0};
    enum dalcs_status status = DALCS_OK;
    size_t capacity = 0;
    if (arguments->rows.at != NULL) {
        status = read_file(times, &capacity, cli, arguments->rows.at, stop);
    }
    if (status == DALCS_OK && arguments->rows.n_times > 0) {
        status = add_list(times, &capacity, cli, arguments, stop);
    }
    if (status != DALCS_OK) {
        dalcs_times_finish(times);
    }
    return status;
}

void dalcs_times_finish(struct dalcs_times *times) {
    free(times->time);
    *times = (struct dalcs_times){0};
}

/* table_audit.c - a signal of the summary's table added up again, and a row of each file read again. */
#include "table_audit.h"

#include "memory.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Sums of so many rows that each are rounded twice go this far apart, at most as a random walk does; of the largest value. */
static const double apart = 16.0 * DBL_EPSILON;

/* Bytes of a file at a time; a line of a header or a table is taken in pieces. */
enum { PIECE = 1 << 14 };

/* ---- Rows ---------------------------------------------------------------------------------------- */

static double draw(struct dalcs_table_audit_sums *a) {
    a->seed = a->seed * 6364136223846793005u + 1442695040888963407u; /* Knuth, TAOCP 2, 3.3.4 */
    return (double)(a->seed >> 11) * 0x1p-53;
}

enum dalcs_status dalcs_table_audit_begin(struct dalcs_table_audit_sums *a,
                                          const struct dalcs_plot *plot) {
    const uint64_t seed = a->seed;
    dalcs_table_audit_finish(a);
    if (plot->n_signals == 0 ||
        (plot->analysis != DALCS_TRANSIENT && plot->analysis != DALCS_PERIODIC)) {
        return DALCS_OK;
    }
    a->seed = seed;
    a->plot = plot;
    a->signal = (size_t)(draw(a) * (double)plot->n_signals);
    a->row = dalcs_alloc(1 + plot->n_signals, sizeof(double));
    return a->row != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* Simpson's rule, which is exact for squares of lines. */
static void add(struct dalcs_table_audit_sums *a, double time, double value) {
    const double length = time - a->time;
    const double middle = 0.5 * (a->value + value);
    a->mean += length * middle;
    a->square += length / 6.0 * (a->value * a->value + 4.0 * middle * middle + value * value);
    a->least = value < a->least ? value : a->least;
    a->most = value > a->most ? value : a->most;
}

void dalcs_table_audit_row(struct dalcs_table_audit_sums *a, double time, const double *value) {
    if (a->plot == NULL) {
        return;
    }
    const double of = value[a->signal];
    if (a->n_rows == 0) {
        a->first = time;
        a->least = a->most = of;
    } else {
        add(a, time, of);
    }
    a->time = time;
    a->value = of;
    a->n_rows++;
    if (draw(a) * (double)a->n_rows < 1.0) { /* each row is as likely to be kept */
        a->kept = a->n_rows - 1;
        a->row[0] = time;
        memcpy(a->row + 1, value, a->plot->n_signals * sizeof(double));
    }
}

void dalcs_table_audit_finish(struct dalcs_table_audit_sums *a) {
    free(a->row);
    *a = (struct dalcs_table_audit_sums){0};
}

/* ---- The summary's table ------------------------------------------------------------------------- */

/* A name says what it is of: v(...) or i(...). */
static bool has_its_unit(const struct dalcs_plot *plot, size_t signal) {
    const char *name = plot->name[signal];
    const bool is_said = (name[0] == 'v' || name[0] == 'i') && name[1] == '(';
    return !is_said || plot->unit[signal] == DALCS_UNIT_NONE ||
           plot->unit[signal] == (name[0] == 'v' ? DALCS_VOLT : DALCS_AMPERE);
}

enum dalcs_status dalcs_table_audit_summary(const struct dalcs_table_audit_sums *a,
                                            const struct dalcs_measure *measure,
                                            const struct dalcs_cli *cli) {
    if (a->plot == NULL || a->n_rows == 0 || measure->plot != a->plot) {
        return DALCS_OK;
    }
    const struct dalcs_measure_signal *s = &measure->signal[a->signal];
    const double length = a->time - a->first;
    const double largest = fmax(fabs(a->least), fabs(a->most));
    const double off = apart * sqrt((double)a->n_rows) * largest;
    const double mean = length > 0.0 ? a->mean / length : a->value;
    const double square = length > 0.0 ? a->square / length : a->value * a->value;
    const double rms = dalcs_measure_rms(measure, a->signal);
    const char *const what =
        s->min != a->least                                                 ? "the minimum"
        : s->max != a->most                                                ? "the maximum"
        : s->final != a->value                                             ? "the final value"
        : fabs(dalcs_measure_average(measure, a->signal) - mean) > off     ? "the average"
        : !(rms >= 0.0 && fabs(rms * rms - square) <= 2.0 * off * largest) ? "the rms value"
        : !has_its_unit(a->plot, a->signal)                                ? "the unit"
                                                                           : NULL;
    if (what == NULL) {
        return DALCS_OK;
    }
    dalcs_cli_error(cli,
                    "the summary seems wrong: the audit finds another number for %s of %s; please "
                    "report this netlist",
                    what, a->plot->name[a->signal]);
    return DALCS_E_INTERNAL;
}

/* ---- Files --------------------------------------------------------------------------------------- */

/* Behind the n-th end of a line; false: there are not so many. */
static bool skip_lines(FILE *file, size_t n) {
    char piece[PIECE];
    while (n > 0 && fgets(piece, sizeof piece, file) != NULL) {
        n -= strchr(piece, '\n') != NULL ? 1 : 0;
    }
    return n == 0;
}

static bool read_csv(const struct dalcs_table_audit_sums *a, FILE *file, double *row) {
    bool reads = skip_lines(file, 1 + a->kept);
    for (size_t k = 0; k <= a->plot->n_signals && reads; k++) {
        reads = fscanf(file, k > 0 ? ",%lf" : "%lf", &row[k]) == 1;
    }
    return reads;
}

static bool read_raw(const struct dalcs_table_audit_sums *a, FILE *file, double *row) {
    const size_t width = (1 + a->plot->n_signals) * sizeof(double);
    char piece[PIECE];
    bool is_there = false;
    while (!is_there && fgets(piece, sizeof piece, file) != NULL) {
        is_there = strcmp(piece, "Binary:\n") == 0;
    }
    return is_there && fseeko(file, (off_t)(a->kept * width), SEEK_CUR) == 0 &&
           fread(row, width, 1, file) == 1;
}

enum dalcs_status dalcs_table_audit_file(const struct dalcs_table_audit_sums *a,
                                         const struct dalcs_table_format *format, const char *path,
                                         const struct dalcs_cli *cli) {
    struct stat is;
    const bool is_known = format == &dalcs_csv_format || format == &dalcs_raw_format;
    if (a->plot == NULL || a->n_rows == 0 || !is_known || a->plot->n_steps > 1 ||
        dalcs_is_standard_output(path) || stat(path, &is) != 0 || !S_ISREG(is.st_mode)) {
        return DALCS_OK;
    }
    const size_t n = 1 + a->plot->n_signals;
    double *row = dalcs_alloc(n, sizeof(double));
    FILE *file = fopen(path, "rb");
    bool is_right = true;
    if (file != NULL && row != NULL) {
        is_right = format == &dalcs_csv_format ? read_csv(a, file, row) : read_raw(a, file, row);
        for (size_t k = 0; k < n && is_right; k++) {
            is_right = row[k] == a->row[k];
        }
    }
    if (file != NULL) {
        fclose(file);
    }
    free(row);
    if (is_right) {
        return DALCS_OK;
    }
    dalcs_cli_error(
        cli,
        "'%s' seems wrong: the audit finds another row %zu than was computed at t = %.9g s; "
        "please report this netlist",
        path, a->kept + 1, a->row[0]);
    return DALCS_E_INTERNAL;
}

/* table_audit.c - rows of the summary's table added up again, and a row of each file read again. */
#include "table_audit.h"

#include "congruential.h"
#include "memory.h"
#include "rounding.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Rows are looked at again after so many, on an average: a look takes some 40 instructions a row, a row 20 and more for each
 * signal that it has. */
static const double rows_between = 4000.0;

/* ... but for the first looks, which are so many rows apart; at least so many rows are looked at together. */
enum { FIRST_LOOKS = 6, ROWS_APART = 60, LEAST_ROWS = 2 };

/* Bytes of a file at a time; a line of a header or a table is taken in pieces. */
enum { PIECE = 1 << 14 };

/* ---- Rows ---------------------------------------------------------------------------------------- */

static double draw(struct dalcs_table_audit_sums *a) {
    return dalcs_congruential_chance(&a->seed);
}

enum dalcs_status dalcs_table_audit_begin(struct dalcs_table_audit_sums *a,
                                          const struct dalcs_plot *plot) {
    const uint64_t seed = a->seed;
    const bool is_full = a->is_full;
    dalcs_table_audit_finish(a);
    if (plot->n_signals == 0 ||
        (plot->analysis != DALCS_TRANSIENT && plot->analysis != DALCS_PERIODIC)) {
        return DALCS_OK;
    }
    a->seed = seed;
    a->is_full = is_full;
    a->plot = plot;
    a->row = dalcs_alloc(1 + plot->n_signals, sizeof(double));
    return a->row != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

static bool looks(const struct dalcs_table_audit_sums *a) {
    return a->wrong == NULL && (a->is_full || a->n_rows >= a->next_look);
}

void dalcs_table_audit_before(struct dalcs_table_audit_sums *a,
                              const struct dalcs_measure *measure) {
    if (a->plot != NULL && looks(a)) {
        a->signal = (size_t)(draw(a) * (double)a->plot->n_signals);
        a->before = dalcs_measure_of(measure, a->signal);
        a->time = measure->last_time;
    }
}

/* Rows are added up by Simpson's rule, which is exact for squares of lines. */
static const char *compare(const struct dalcs_table_audit_sums *a,
                           const struct dalcs_measure_signal *now, size_t n, const double *time,
                           const double *value) {
    const struct dalcs_measure_signal *then = &a->before;
    const bool is_first = a->n_rows == 0;
    double last = is_first ? value[a->signal] : then->final;
    double t = is_first ? time[0] : a->time;
    double least = is_first ? last : then->min, most = is_first ? last : then->max;
    double sum = 0.0, square = 0.0;
    const double begin = t;
    for (size_t k = 0; k < n; k++) {
        const double v = value[k * a->plot->n_signals + a->signal];
        const double middle = 0.5 * (last + v);
        sum += (time[k] - t) * middle;
        square += (time[k] - t) / 6.0 * (last * last + 4.0 * middle * middle + v * v);
        least = v < least ? v : least;
        most = v > most ? v : most;
        last = v;
        t = time[k];
    }
    const double largest = fmax(fabs(least), fabs(most));
    /* the waves that have not come yet are of 1e-200 V: their products are as coarse as numbers get */
    const double off =
        dalcs_sum_rounded * ((double)n * largest * (t - begin) + fabs(now->integral)) + DBL_MIN;
    const double off_square = dalcs_sum_rounded * ((double)n * largest * largest * (t - begin) +
                                                   fabs(now->square_integral)) +
                              DBL_MIN;
    if (!isfinite(now->square_integral) || !isfinite(square) || !isfinite(sum)) {
        return a->wrong; /* beyond all numbers */
    }
    return now->min != least                                      ? "the minimum"
           : now->max != most                                     ? "the maximum"
           : now->final != last                                   ? "the final value"
           : !(fabs(now->integral - then->integral - sum) <= off) ? "the average"
           : !(fabs(now->square_integral - then->square_integral - square) <= off_square)
               ? "the rms value"
               : a->wrong;
}

void dalcs_table_audit_after(struct dalcs_table_audit_sums *a, const struct dalcs_measure *measure,
                             size_t n, const double *time, const double *value) {
    const size_t width = a->plot != NULL ? a->plot->n_signals : 0;
    if (width == 0 || n == 0) {
        return;
    }
    if (a->n_rows == 0) {
        a->first = time[0];
    }
    if (measure != NULL && looks(a)) {
        const struct dalcs_measure_signal now = dalcs_measure_of(measure, a->signal);
        a->wrong = compare(a, &now, n, time, value);
        a->n_looks += n >= LEAST_ROWS ? 1 : 0;
        a->next_look =
            a->n_rows + n +
            (n < LEAST_ROWS ? 0
                            : (size_t)(2.0 * draw(a) *
                                       (a->n_looks < FIRST_LOOKS ? ROWS_APART : rows_between)));
    }
    a->n_rows += n;
    while (a->n_rows >
           a->next_kept) { /* each row is as likely to be kept (K.-H. Li, ACM TOMS 20, 1994) */
        const size_t k = a->next_kept - (a->n_rows - n);
        a->kept = a->next_kept;
        a->row[0] = time[k];
        memcpy(a->row + 1, value + k * width, width * sizeof(double));
        a->next_kept = 1 + (size_t)((double)(a->kept + 1) / (1.0 - draw(a)));
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

/* What is told of its sums. */
static const char *told_wrong(const struct dalcs_table_audit_sums *a,
                              const struct dalcs_measure *measure) {
    const struct dalcs_measure_signal s = dalcs_measure_of(measure, a->signal);
    const double length = measure->last_time - a->first;
    const double mean = dalcs_measure_average(measure, a->signal);
    const double rms = dalcs_measure_rms(measure, a->signal);
    if (!has_its_unit(a->plot, a->signal)) {
        return "the unit";
    }
    if (!isfinite(s.integral) || !isfinite(s.square_integral / length)) {
        return NULL; /* beyond all numbers */
    }
    if (!(length > 0.0)) {
        return mean != s.final ? "the average" : NULL;
    }
    return !(fabs(mean * length - s.integral) <= dalcs_sum_rounded * fabs(s.integral) + DBL_MIN)
               ? "the average"
           : !(rms >= 0.0 && fabs(rms * rms * length - s.square_integral) <=
                                 dalcs_sum_rounded * s.square_integral + DBL_MIN)
               ? "the rms value"
               : NULL;
}

enum dalcs_status dalcs_table_audit_summary(const struct dalcs_table_audit_sums *a,
                                            const struct dalcs_measure *measure,
                                            const struct dalcs_cli *cli) {
    if (a->plot == NULL || a->n_rows == 0 || measure->plot != a->plot) {
        return DALCS_OK;
    }
    const char *what = a->wrong != NULL ? a->wrong : told_wrong(a, measure);
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

/* A sum of so many bytes of 0 or 1 is a byte: compilers add sixteen or more at a time. */
enum { BLOCK = 128 };

static size_t count_ends(const char piece[PIECE]) {
    size_t n = 0;
    for (int begin = 0; begin < PIECE; begin += BLOCK) {
        unsigned char in_block = 0;
        for (int k = 0; k < BLOCK; k++) {
            in_block = (unsigned char)(in_block + (piece[begin + k] == '\n'));
        }
        n += in_block;
    }
    return n;
}

/* How far behind the n-th end of a line is; 0: there are not so many. */
static size_t find_end(const char *piece, size_t length, size_t n) {
    const char *at = piece, *const end = piece + length;
    for (; n > 0 && at != NULL; n--) {
        at = memchr(at, '\n', (size_t)(end - at));
        at = at != NULL ? at + 1 : NULL;
    }
    return at != NULL ? (size_t)(at - piece) : 0;
}

/* Behind the n-th end of a line from here; false: there are not so many. To read each line on its own takes more
 * instructions than all that the audit does while the run goes on. */
static bool skip_lines(FILE *file, size_t n) {
    char piece[PIECE];
    const off_t begin = ftello(file);
    off_t skipped = 0;
    size_t length = 0;
    while (n > 0 && (length = fread(piece, 1, sizeof piece, file)) == sizeof piece) {
        const size_t ends = count_ends(piece);
        if (ends >= n) {
            break;
        }
        n -= ends;
        skipped += (off_t)length;
    }
    const size_t rest = n > 0 ? find_end(piece, length, n) : 0;
    return (n == 0 || rest > 0) && fseeko(file, begin + skipped + (off_t)rest, SEEK_SET) == 0;
}

static bool read_csv(const struct dalcs_table_audit_sums *a, FILE *file, double *row) {
    bool reads = skip_lines(file, 1 + a->kept);
    for (size_t k = 0; k <= a->plot->n_signals && reads; k++) {
        reads = fscanf(file, k > 0 ? ",%lf" : "%lf", &row[k]) == 1;
    }
    return reads;
}

/* Behind the header, whose last line it is. */
static bool find_line(FILE *file, const char *line) {
    char piece[PIECE];
    bool is_there = false;
    while (!is_there && fgets(piece, sizeof piece, file) != NULL) {
        is_there = strcmp(piece, line) == 0;
    }
    return is_there;
}

/* A row is its number and a value on each line, and an empty line. */
static bool read_raw_ascii(const struct dalcs_table_audit_sums *a, FILE *file, double *row) {
    const size_t n = 1 + a->plot->n_signals;
    size_t number = 0;
    bool reads = find_line(file, "Values:\n") && skip_lines(file, a->kept * (n + 1)) &&
                 fscanf(file, "%zu", &number) == 1 && number == a->kept;
    for (size_t k = 0; k < n && reads; k++) {
        reads = fscanf(file, "%lf", &row[k]) == 1;
    }
    return reads;
}

static bool read_raw(const struct dalcs_table_audit_sums *a, FILE *file, double *row) {
    const size_t width = (1 + a->plot->n_signals) * sizeof(double);
    return find_line(file, "Binary:\n") && fseeko(file, (off_t)(a->kept * width), SEEK_CUR) == 0 &&
           fread(row, width, 1, file) == 1;
}

enum dalcs_status dalcs_table_audit_file(const struct dalcs_table_audit_sums *a,
                                         const struct dalcs_table_format *format, const char *path,
                                         const struct dalcs_cli *cli) {
    struct stat is;
    const bool is_known = format == &dalcs_csv_format || format == &dalcs_raw_format ||
                          format == &dalcs_raw_ascii_format;
    if (a->plot == NULL || a->n_rows == 0 || !is_known || a->plot->n_parameters > 0 ||
        dalcs_is_standard_output(path) || stat(path, &is) != 0 || !S_ISREG(is.st_mode)) {
        return DALCS_OK;
    }
    const size_t n = 1 + a->plot->n_signals;
    double *row = dalcs_alloc(n, sizeof(double));
    FILE *file = fopen(path, "rb");
    bool is_right = true;
    if (file != NULL && row != NULL) {
        is_right = format == &dalcs_csv_format         ? read_csv(a, file, row)
                   : format == &dalcs_raw_ascii_format ? read_raw_ascii(a, file, row)
                                                       : read_raw(a, file, row);
        for (size_t k = 0; k < n && is_right; k++) {
            /* a formula that divides by 0 has no value in both */
            is_right = row[k] == a->row[k] || (isnan(row[k]) && isnan(a->row[k]));
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

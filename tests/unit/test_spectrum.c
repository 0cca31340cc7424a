/* Spectra against Fourier series by hand: of edges, ramps and rows at odd distances, over part of a file. */
#include "run_tests.h"
#include "spectrum.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* The spectrum of a table as CSV, in *spectrum. */
static enum dalcs_status spectrum_of(const char *text, double from, double to, double highest,
                                     struct dalcs_waveforms *spectrum) {
    struct dalcs_diag diag = {0};
    struct dalcs_waveforms waveforms = {0};
    struct dalcs_selection selection = {0};
    enum dalcs_status status =
        dalcs_waveforms_read_text(&waveforms, "a.csv", text, strlen(text), 0, &diag);
    ck_assert_int_eq(status, DALCS_OK);
    status = dalcs_selection_make(&selection, &waveforms, NULL, 0, from, to, &diag);
    ck_assert_int_eq(status, DALCS_OK);
    status = dalcs_spectrum_make(spectrum, &selection, highest, &diag);
    dalcs_selection_finish(&selection);
    dalcs_waveforms_finish(&waveforms);
    dalcs_diag_finish(&diag);
    return status;
}

/* The amplitude of line k: the middle one of its three rows. */
static double line(const struct dalcs_waveforms *spectrum, size_t k, size_t column,
                   double frequency) {
    const double *row = spectrum->value + (k == 0 ? 0 : 3 * k) * spectrum->n_columns;
    ck_assert_double_eq_tol(row[0], frequency, 1e-12 * (1.0 + frequency));
    return row[column];
}

START_TEST(test_square_and_ramp) {
    struct dalcs_waveforms s = {0};
    const char text[] = "time,v(a),v(b)\n0,1,0\n0.5,1,0.5\n0.5,-1,0.5\n1,-1,1\n1,1,0\n1.5,1,0.5\n"
                        "1.5,-1,0.5\n2,-1,1\n";
    ck_assert_int_eq(spectrum_of(text, (double)NAN, (double)NAN, 10.0, &s), DALCS_OK);
    ck_assert_str_eq(s.name[0], "frequency");
    ck_assert_str_eq(s.name[2], "v(b)");
    ck_assert_int_eq(s.dimension[0].second, -1);
    ck_assert_double_eq_tol(line(&s, 0, 1, 0.0), 0.0, 1e-15);
    ck_assert_double_eq_tol(line(&s, 0, 2, 0.0), 0.5, 1e-15);
    for (size_t k = 1; k <= 20; k++) {
        const double harmonic = 0.5 * (double)k; /* two periods: every second line is one */
        const bool is_odd = k % 2 == 0 && (k / 2) % 2 == 1;
        ck_assert_double_eq_tol(line(&s, k, 1, harmonic), is_odd ? 4.0 / (pi * harmonic) : 0.0,
                                1e-13);
        ck_assert_double_eq_tol(line(&s, k, 2, harmonic), k % 2 == 0 ? 1.0 / (pi * harmonic) : 0.0,
                                1e-13);
    }
    dalcs_waveforms_finish(&s);
}

END_TEST

/* A triangle whose rows are at odd places, from 1 to 3 of 0 to 4: interpolated at both ends. */
START_TEST(test_part_of_a_file) {
    struct dalcs_waveforms s = {0};
    const char text[] =
        "time,i(l1)\n0,0\n0.5,0.5\n0.9,0.9\n1.5,1.5\n2,2\n2.01,1.99\n3.9,0.1\n4,0\n";
    ck_assert_int_eq(spectrum_of(text, 1.0, 3.0, 5.0, &s), DALCS_OK);
    ck_assert_double_eq_tol(line(&s, 0, 1, 0.0), 1.5, 1e-15);
    for (size_t k = 1; k <= 10; k++) {
        const double harmonic = pi * (double)k;
        ck_assert_double_eq_tol(line(&s, k, 1, 0.5 * (double)k),
                                k % 2 == 1 ? 4.0 / (harmonic * harmonic) : 0.0, 1e-14);
    }
    dalcs_waveforms_finish(&s);
}

END_TEST

/* 30 000 rows of a sine: what straight lines between rows leave of it, and no line beside it. */
START_TEST(test_many_rows) {
    enum { N_ROWS = 30000, PERIODS = 37, N_LINES = 100 };
    struct dalcs_waveforms s = {0};
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    fputs("time,v(a)\n", out);
    for (int k = 0; k <= N_ROWS; k++) {
        fprintf(out, "%.17g,%.17g\n", 1e-3 * k / N_ROWS, 3.0 * sin(2 * pi * PERIODS * k / N_ROWS));
    }
    fclose(out);
    ck_assert_int_eq(spectrum_of(text, (double)NAN, (double)NAN, 1e3 * N_LINES, &s), DALCS_OK);
    const double half = pi * PERIODS / N_ROWS;
    for (size_t k = 0; k <= N_LINES; k++) {
        const double wanted = k == PERIODS ? 3.0 * pow(sin(half) / half, 2.0) : 0.0;
        ck_assert_double_eq_tol(line(&s, k, 1, 1e3 * (double)k), wanted, 1e-9);
    }
    dalcs_waveforms_finish(&s);
    free(text);
}

END_TEST

START_TEST(test_refusals) {
    struct dalcs_waveforms s = {0};
    const char text[] = "time,v(a)\n0,0\n1,1\n";
    ck_assert_int_eq(spectrum_of(text, (double)NAN, (double)NAN, 0.5, &s), DALCS_E_OPTION);
    ck_assert_int_eq(spectrum_of(text, (double)NAN, (double)NAN, 3e4, &s), DALCS_E_OPTION);
    const char sweep[] = "v1,v(a)\n0,0\n1,1\n";
    ck_assert_int_eq(spectrum_of(sweep, (double)NAN, (double)NAN, 5.0, &s), DALCS_E_OPTION);
}

END_TEST

RUN_TESTS("spectrum", test_square_and_ramp, test_part_of_a_file, test_many_rows, test_refusals)

/* test_decimal.c - 17 digits are printf's, whatever the locale. */
#include "decimal.h"
#include "sample_plot.h"

#include <locale.h>
#include <math.h>

static struct dalcs_decimal decimal;

static void check_text(double value, const char *expected) {
    char text[DALCS_DECIMAL_SIZE];
    size_t length = dalcs_decimal_write(&decimal, value, text);
    ck_assert_str_eq(text, expected);
    ck_assert_uint_eq(length, strlen(expected));
}

START_TEST(test_known_values) {
    dalcs_decimal_init(&decimal);
    check_text(0.0, "0");
    check_text(-0.0, "-0");
    check_text(1.0, "1");
    check_text(-1234.5, "-1234.5");
    check_text(0.1, "0.10000000000000001");
    check_text(1e-4, "0.0001");
    check_text(1e-5, "1.0000000000000001e-05");
    check_text(1e16, "10000000000000000");
    check_text(1e17, "1e+17");
    check_text(0.99999999999999994, "0.99999999999999989");
    check_text(5e-324, "4.9406564584124654e-324");
    check_text(1.7976931348623157e308, "1.7976931348623157e+308");
    check_text(INFINITY, "inf");
    check_text(-INFINITY, "-inf");
    check_text(NAN, "nan");
    check_text(-NAN, "nan");
}

END_TEST

/* 2^-k has ties and long runs of nines and zeros; the random bits have everything else. */
START_TEST(test_equals_printf) {
    dalcs_decimal_init(&decimal);
    uint64_t state = 20240229;
    for (long i = 0; i < 300000; i++) {
        state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        uint64_t bits = state ^ state >> 29;
        double value = 0.0;
        memcpy(&value, &bits, sizeof value);
        value = i % 3 == 1   ? ldexp((double)(bits % 1000), -(int)(bits >> 60) * 4)
                : i % 3 == 2 ? (double)(bits % 2000000) / 1000.0
                             : value;
        char expected[64];
        snprintf(expected, sizeof expected, isnan(value) ? "nan" : "%.17g", value);
        check_text(value, expected);
    }
}

END_TEST

/* Next to a power of ten the digits may round up to one more. */
START_TEST(test_powers_of_ten) {
    dalcs_decimal_init(&decimal);
    for (int k = -323; k <= 308; k++) {
        char text[64];
        snprintf(text, sizeof text, "1e%d", k);
        double value = strtod(text, NULL);
        for (int side = -1; side <= 1; side++) {
            double near = side == 0 ? value : nextafter(value, side * INFINITY);
            snprintf(text, sizeof text, "%.17g", near);
            check_text(near, text);
        }
    }
}

END_TEST

START_TEST(test_ignores_the_locale) {
    static const char *const candidate[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR"};
    for (size_t i = 0; i < 4; i++) {
        setlocale(LC_NUMERIC, candidate[i]);
    }
    dalcs_decimal_init(&decimal);
    for (int k = -300; k <= 300; k++) {
        char text[DALCS_DECIMAL_SIZE];
        double value = 1.0 / 3.0 * pow(10.0, k);
        dalcs_decimal_write(&decimal, value, text);
        setlocale(LC_NUMERIC, "C");
        ck_assert_double_eq(strtod(text, NULL), value);
    }
}

END_TEST

RUN_SUITE("decimal", test_known_values, test_equals_printf, test_powers_of_ten,
          test_ignores_the_locale)

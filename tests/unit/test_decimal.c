/* test_decimal.c - the fewest of printf's digits that are read back exactly, whatever the locale. */
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
    check_text(0.1, "0.1");
    check_text(0.30000000000000004, "0.30000000000000004");
    check_text(2e-5, "2e-05");
    check_text(1e-4, "0.0001");
    check_text(1e-5, "1e-05");
    check_text(1e16, "10000000000000000");
    check_text(1e17, "1e+17");
    check_text(0.99999999999999994, "0.9999999999999999");
    check_text(5e-324, "4.94065645841247e-324");
    check_text(1.7976931348623157e308, "1.7976931348623157e+308");
    check_text(INFINITY, "inf");
    check_text(-INFINITY, "-inf");
    check_text(NAN, "nan");
    check_text(-NAN, "nan");
}

END_TEST

/* The digits of a number's text, without zeros at either end. */
static void take_digits(const char *text, char digit[64]) {
    size_t n = 0;
    for (; *text != '\0' && *text != 'e'; text++) {
        if (*text >= '0' && *text <= '9' && (n > 0 || *text != '0')) {
            digit[n++] = *text;
        }
    }
    while (n > 0 && digit[n - 1] == '0') {
        n--;
    }
    digit[n] = '\0';
}

/* The digits that printf gives with the least precision from 15 on that is read back as the value. */
static void check_shortest(double value) {
    char text[64], wanted[64], found[64];
    int n = 15;
    do {
        snprintf(text, sizeof text, "%.*e", n - 1, value);
    } while (n++ < 17 && strtod(text, NULL) != value);
    take_digits(text, wanted);
    dalcs_decimal_write(&decimal, value, text);
    take_digits(text, found);
    ck_assert_str_eq(found, wanted);
    ck_assert(memcmp(&(double){strtod(text, NULL)}, &value, sizeof value) == 0);
}

/* 2^-k has ties and long runs of nines and zeros; the random bits have everything else. */
START_TEST(test_digits_are_those_of_printf) {
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
        if (isfinite(value)) {
            check_shortest(value);
        }
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
            check_shortest(near);
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

RUN_SUITE("decimal", test_known_values, test_digits_are_those_of_printf, test_powers_of_ten,
          test_ignores_the_locale)

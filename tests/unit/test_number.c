/* test_number.c - SPICE numbers, to the last bit. */
#include "number.h"

#include "run_tests.h"

#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void check_value(const char *text, double wanted) {
    struct dalcs_number number;
    ck_assert_msg(dalcs_number_parse(text, &number) == DALCS_NUMBER_OK, "%s", text);
    ck_assert_msg(memcmp(&number.value, &wanted, sizeof wanted) == 0, "%s is %.17g, not %.17g",
                  text, number.value, wanted);
}

static void check_refused(const char *text, enum dalcs_number_status wanted) {
    struct dalcs_number number;
    ck_assert_msg(dalcs_number_parse(text, &number) == wanted, "%s", text);
}

START_TEST(test_values) {
    check_value("0", 0.0);
    check_value("-0", -0.0);
    check_value("+5", 5.0);
    check_value("5.", 5.0);
    check_value(".5", 0.5);
    check_value("-2.385e-3", -2.385e-3);
    check_value("1E3", 1e3);
    check_value("1e+3k", 1e6);
    check_value("0.000000000000000000001", 1e-21);
    check_value("1000000000000000000000000", 1e24);
    check_value("4.9406564584124654e-324", 4.9406564584124654e-324);
    check_value("1.7976931348623157e308", 1.7976931348623157e308);
}

END_TEST

START_TEST(test_suffixes) {
    check_value("1t", 1e12);
    check_value("2.5G", 2.5e9);
    check_value("1Meg", 1e6);
    check_value("1MEGohm", 1e6);
    check_value("4.7k", 4700);
    check_value("10kOhm", 1e4);
    check_value("1M", 1e-3);
    check_value("1MHz", 1e-3);
    check_value("3.3u", 3.3e-6);
    check_value("3.3\xC2\xB5", 3.3e-6);
    check_value("3.3\xCE\xBC"
                "F",
                3.3e-6);
    check_value("10k\xCE\xA9", 1e4); /* ohm sign */
    check_value("100n", 100e-9);
    check_value("22pF", 22e-12);
    check_value("1F", 1e-15);
    check_value("7a", 7); /* amperes */
    check_value("-2A", -2);
    check_value("2e-3Amp", 2e-3);
    check_value("10mA", 10e-3);
    check_value("7aF", 7e-18);
    check_value("5V", 5.0);
    check_value("50Hz", 50.0);
    check_value("1mil", 25.4e-6);
    check_value("1e3eV", 1e3);
}

END_TEST

/* Every suffix equals the exponent it stands for, correctly rounded, which multiplying is not. */
START_TEST(test_rounding) {
    static const struct {
        const char *suffix;
        int power;
    } table[] = {{"t", 12}, {"g", 9},  {"meg", 6}, {"k", 3},   {"m", -3},
                 {"u", -6}, {"n", -9}, {"p", -12}, {"f", -15}, {"aF", -18}};

    uint64_t state = 2385;
    int multiplying_differs = 0;
    const int n_values = of_cases(100000, 5000);
    for (int k = 0; k < n_values; k++) {
        state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        const unsigned whole = (unsigned)(state >> 40) % 1000;
        const unsigned part = (unsigned)(state >> 20) % 1000000;
        const size_t s = (size_t)(state >> 33) % (sizeof table / sizeof table[0]);
        char text[64];
        char plain[64];
        snprintf(text, sizeof text, "%u.%06u%s", whole, part, table[s].suffix);
        snprintf(plain, sizeof plain, "%u.%06ue%d", whole, part, table[s].power);
        check_value(text, strtod(plain, NULL));
        snprintf(plain, sizeof plain, "%u.%06u", whole, part);
        multiplying_differs += strtod(plain, NULL) * pow(10, table[s].power) != strtod(text, NULL);
    }
    ck_assert_int_gt(multiplying_differs, n_values / 100);
}

END_TEST

/* The decision of a tie may lie behind hundreds of digits. */
START_TEST(test_many_digits) {
    char text[4000];
    /* 2^53 + 1 lies between two doubles; a last digit breaks the tie. */
    snprintf(text, sizeof text, "9007199254740993.%01500d", 0);
    check_value(text, 9007199254740992.0);
    text[strlen(text) - 1] = '1';
    check_value(text, 9007199254740994.0);
    snprintf(text, sizeof text, "0.%0500d1e501", 0);
    check_value(text, 1.0);
    snprintf(text, sizeof text, "1%0900d", 0);
    check_refused(text, DALCS_NUMBER_OVERFLOW);
    snprintf(text, sizeof text, "1%0900de-900k", 0);
    check_value(text, 1000.0);
}

END_TEST

static void check_value_as(const char *text, enum dalcs_dialect_name dialect, double wanted) {
    struct dalcs_number number;
    ck_assert_msg(dalcs_number_parse_as(text, dialect, &number) == DALCS_NUMBER_OK, "%s", text);
    ck_assert_msg(number.value == wanted, "%s is %.17g, not %.17g", text, number.value, wanted);
}

START_TEST(test_dialects) {
    static const char *const refused[] = {"4.7k2", "1e3k5", "1mil5", "1a5", "4k7k7", "4q7"};
    struct dalcs_number number;
    check_value_as("4k7", DALCS_DIALECT_LTSPICE, 4700);
    check_value_as("-6K34ohm", DALCS_DIALECT_LTSPICE, -6340);
    check_value_as("2R2", DALCS_DIALECT_LTSPICE, 2.2);
    check_value_as("5v0", DALCS_DIALECT_LTSPICE, 5);
    check_value_as("1meg5", DALCS_DIALECT_LTSPICE, 1.5e6);
    check_value_as("1u5", DALCS_DIALECT_LTSPICE, 1.5e-6);
    check_value_as("0\xC2\xB5"
                   "47F",
                   DALCS_DIALECT_LTSPICE, 0.47e-6);
    check_value_as("4.7k", DALCS_DIALECT_LTSPICE, 4700);
    check_value_as("2r", DALCS_DIALECT_LTSPICE, 2);
    check_value_as("1x", DALCS_DIALECT_LTSPICE, 1);
    for (size_t k = 0; k < sizeof refused / sizeof refused[0]; k++) {
        ck_assert_msg(dalcs_number_parse_as(refused[k], DALCS_DIALECT_LTSPICE, &number) ==
                          DALCS_NUMBER_RKM,
                      "%s", refused[k]);
    }
    check_value_as("2.5x", DALCS_DIALECT_XYCE, 2.5e6);
    check_value_as("1e-3XOhm", DALCS_DIALECT_XYCE, 1e3);
    check_value_as("2.5x", DALCS_DIALECT_NGSPICE, 2.5);
    ck_assert_int_eq(dalcs_number_parse_as("4k7", DALCS_DIALECT_XYCE, &number), DALCS_NUMBER_RKM);
    ck_assert_int_eq(dalcs_number_parse_as("4k7", DALCS_DIALECT_NGSPICE, &number),
                     DALCS_NUMBER_RKM);
}

END_TEST

START_TEST(test_refusals) {
    static const char *const malformed[] = {"",    "-",    "+",   ".",     "abc", "1..5", "1.2.3",
                                            "1e",  "1e+",  "1,5", "k",     "--1", "1-",   "1k-",
                                            "0x#", "1k.5", "e5",  "10u*2", "1%",  "inf",  "nan"};
    for (size_t k = 0; k < sizeof malformed / sizeof malformed[0]; k++) {
        check_refused(malformed[k], DALCS_NUMBER_MALFORMED);
    }
    check_refused("4k7", DALCS_NUMBER_RKM);
    check_refused("2R2", DALCS_NUMBER_RKM);
    check_refused("1meg5", DALCS_NUMBER_RKM);
    check_refused("0x10", DALCS_NUMBER_RKM);
    check_refused("1e999", DALCS_NUMBER_OVERFLOW);
    check_refused("-1e300t", DALCS_NUMBER_OVERFLOW);
    check_refused("1e99999999999999999999999999999999999", DALCS_NUMBER_OVERFLOW);
    check_refused("1e-400", DALCS_NUMBER_UNDERFLOW);
    check_refused("1e-99999999999999999999999999999999999", DALCS_NUMBER_UNDERFLOW);
    check_value("0e999999999999999999999999", 0.0);
}

END_TEST

START_TEST(test_parts) {
    struct dalcs_number number;
    ck_assert_int_eq(dalcs_number_parse("-1.5e2Megohm", &number), DALCS_NUMBER_OK);
    ck_assert_int_eq(number.suffix, 'x');
    ck_assert_int_eq(number.digits, 6);
    ck_assert_int_eq(number.tail, 9);
    ck_assert_int_eq(dalcs_number_parse("5", &number), DALCS_NUMBER_OK);
    ck_assert_int_eq(number.suffix, 0);
    ck_assert_int_eq(number.digits, 1);
    ck_assert_int_eq(number.tail, 1);
}

END_TEST

START_TEST(test_ignores_the_locale) {
    static const char *const candidate[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR"};
    for (size_t k = 0; k < sizeof candidate / sizeof candidate[0]; k++) {
        setlocale(LC_NUMERIC, candidate[k]);
    }
    check_value("1.5k", 1500);
    check_refused("1,5", DALCS_NUMBER_MALFORMED);
}

END_TEST

RUN_TESTS("number", test_values, test_suffixes, test_rounding, test_many_digits, test_dialects,
          test_refusals, test_parts, test_ignores_the_locale)

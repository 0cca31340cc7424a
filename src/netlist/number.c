/* number.c - SPICE numbers to doubles, correctly rounded.
 *
 * The digits are copied without their decimal point and the suffix becomes part of the exponent, so
 * that strtod reads "4700e-1" for 4.7e2: one rounding, and no decimal point for a locale to mistake.
 * `mil` (25.4e-6) is the one suffix that multiplies. */
#include "number.h"

#include "lower_case.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Enough digits to round any decimal number correctly (767 decide a double); of those beyond only
 * whether one is not 0 matters. */
enum { MAX_DIGITS = 800 };

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/* A letter of a unit: ASCII, or any part of a UTF-8 character such as the ohm sign. */
static bool is_unit_letter(char c) {
    return (dalcs_lower(c) >= 'a' && dalcs_lower(c) <= 'z') || (unsigned char)c >= 0x80;
}

static bool starts_with(const char *text, const char *prefix) {
    while (*prefix != '\0' && dalcs_lower(*text) == *prefix) {
        text++;
        prefix++;
    }
    return *prefix == '\0';
}

/* 2A, 2Amp and 2 amperes are not atto; 2aF is. */
static bool is_ampere(const char *text) {
    return dalcs_lower(text[0]) == 'a' && (!is_unit_letter(text[1]) || starts_with(text, "amp"));
}

/* The suffix at text: its length, its letter in *suffix and its power of ten in *power. */
static int read_suffix(const char *text, char *suffix, int *power) {
    static const struct {
        const char *text;
        char suffix;
        int power;
    } table[] = {
        /* The longer spellings first. */
        {"meg", 'x', 6},       {"mil", 'i', 0}, {"t", 't', 12},  {"g", 'g', 9},
        {"k", 'k', 3},         {"m", 'm', -3},  {"u", 'u', -6},  {"n", 'n', -9},
        {"p", 'p', -12},       {"f", 'f', -15}, {"a", 'a', -18}, {"\xC2\xB5", 'u', -6},
        {"\xCE\xBC", 'u', -6}, /* the micro sign and the Greek mu */
    };

    const size_t n = *text == '\0' || is_ampere(text) ? 0 : sizeof table / sizeof table[0];
    for (size_t k = 0; k < n; k++) {
        if (dalcs_lower(*text) == table[k].text[0] && starts_with(text, table[k].text)) {
            *suffix = table[k].suffix;
            *power = table[k].power;
            return (int)strlen(table[k].text);
        }
    }
    *suffix = 0;
    *power = 0;
    return 0;
}

/* The significant digits of a mantissa, as text, and the power of ten of its last digit. */
struct mantissa {
    char digit[MAX_DIGITS + 1];
    int n;
    long long power;
    bool sticky; /* a digit beyond MAX_DIGITS is not 0 */
};

static void add_digit(struct mantissa *m, char c, bool after_point) {
    if (m->n == 0 && c == '0') {
        m->power -= after_point; /* a leading zero only moves the point */
        return;
    }
    if (m->n < MAX_DIGITS) {
        m->digit[m->n++] = c;
        m->power -= after_point;
        return;
    }
    m->sticky = m->sticky || c != '0';
    m->power += !after_point;
}

/* Reads digits with at most one point; the first byte after them, or NULL when there is no digit or
 * a second point follows. */
static const char *read_mantissa(const char *p, struct mantissa *m) {
    bool any = false;
    bool after_point = false;
    for (;; p++) {
        if (is_digit(*p)) {
            any = true;
            add_digit(m, *p, after_point);
        } else if (*p == '.' && !after_point) {
            after_point = true;
        } else {
            break;
        }
    }
    return any && *p != '.' ? p : NULL;
}

/* Reads e[+-]digits when it is there and saturates far outside any double. */
static const char *read_exponent(const char *p, long long *exponent) {
    const char *q = p + 1;
    if (dalcs_lower(*p) != 'e') {
        return p;
    }
    const bool negative = *q == '-';
    q += *q == '-' || *q == '+';
    if (!is_digit(*q)) {
        return p;
    }
    for (; is_digit(*q); q++) {
        if (*exponent < 1000000000000LL) {
            *exponent = *exponent * 10 + (*q - '0');
        }
    }
    *exponent = negative ? -*exponent : *exponent;
    return q;
}

/* Integers and powers of ten up to these are exact in a double, so that one multiplication or division
 * rounds once (Clinger, PLDI 1990). */
enum { EXACT_DIGITS = 15, EXACT_POWER = 22 };

static double convert_short(const struct mantissa *m, int power) {
    static const double ten[EXACT_POWER + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    double whole = 0.0;
    for (int k = 0; k < m->n; k++) {
        whole = whole * 10.0 + (m->digit[k] - '0');
    }
    return power < 0 ? whole / ten[-power] : whole * ten[power];
}

/* LTspice's 4k7, 2R2: the suffix at p stands for the point. Reads the digits behind it; the first byte
 * after them, or p when this is something else. */
static const char *read_rkm(const char *p, struct dalcs_number *number, struct mantissa *m,
                            int *power) {
    const bool is_plain = dalcs_lower(*p) == 'r' || dalcs_lower(*p) == 'v';
    const char *q = is_plain ? p + 1 : p + read_suffix(p, &number->suffix, power);
    if (q == p || !is_digit(*q) || number->suffix == 'i' || number->suffix == 'a') {
        return p;
    }
    number->suffix = is_plain ? 0 : number->suffix;
    number->is_special = true;
    for (; is_digit(*q); q++) {
        add_digit(m, *q, true);
    }
    return q;
}

static double convert(const struct mantissa *m, long long power, bool negative) {
    char buffer[MAX_DIGITS + 40];
    if (m->n == 0) {
        return negative ? -0.0 : 0.0;
    }
    if (m->n <= EXACT_DIGITS && power >= -EXACT_POWER && power <= EXACT_POWER) {
        double value = convert_short(m, (int)power);
        return negative ? -value : value;
    }
    power = power > 1000000 ? 1000000 : power < -1000000 ? -1000000 : power;
    /* One more digit replaces all digits that were cut off: rounding depends only on whether they are 0. */
    snprintf(buffer, sizeof buffer, "%s%.*s%se%lld", negative ? "-" : "", m->n, m->digit,
             m->sticky ? "1" : "", m->sticky ? power - 1 : power);
    return strtod(buffer, NULL);
}

/* Of a value that was read: is it in range? */
static enum dalcs_number_status finish_value(struct dalcs_number *result,
                                             const struct mantissa *m) {
    if (result->suffix == 'i') {
        result->value *= 25.4e-6;
    }
    if (isinf(result->value)) {
        return DALCS_NUMBER_OVERFLOW;
    }
    if (result->value == 0 && m->n > 0) {
        return DALCS_NUMBER_UNDERFLOW;
    }
    return DALCS_NUMBER_OK;
}

/* What scales a number, behind its digits and its exponent; may_be_rkm: they are such that LTspice's 4k7 may follow. */
static const char *read_scale(const char *p, enum dalcs_dialect_name dialect, bool may_be_rkm,
                              struct dalcs_number *result, struct mantissa *m, int *suffix_power) {
    if (dialect == DALCS_DIALECT_LTSPICE && may_be_rkm) {
        p = read_rkm(p, result, m, suffix_power);
    } else if (dialect == DALCS_DIALECT_XYCE && dalcs_lower(*p) == 'x') {
        result->suffix = 'x';
        result->is_special = true;
        *suffix_power = 6;
        p++;
    }
    if (!result->is_special) {
        p += read_suffix(p, &result->suffix, suffix_power);
    }
    return p;
}

enum dalcs_number_status dalcs_number_parse_as(const char *text, enum dalcs_dialect_name dialect,
                                               struct dalcs_number *number) {
    const char *p = text;
    const bool negative = *p == '-';
    p += *p == '-' || *p == '+';

    struct mantissa m;
    m.n = 0;
    m.power = 0;
    m.sticky = false;
    const char *digits = p;
    p = read_mantissa(p, &m);
    if (p == NULL) {
        return DALCS_NUMBER_MALFORMED;
    }
    const bool is_whole = memchr(digits, '.', (size_t)(p - digits)) == NULL;
    const char *mantissa_end = p;
    long long exponent = 0;
    p = read_exponent(p, &exponent);
    if (p - text > INT_MAX / 2) {
        return DALCS_NUMBER_MALFORMED;
    }
    struct dalcs_number result = {.digits = (int)(p - text)};

    int suffix_power = 0;
    const char *suffix = p;
    p = read_scale(p, dialect, is_whole && p == mantissa_end, &result, &m, &suffix_power);
    result.tail = (int)(p - text);
    while (is_unit_letter(*p)) {
        p++;
    }
    if (is_digit(*p)) {
        return DALCS_NUMBER_RKM;
    }
    if (*p != '\0' || (dalcs_lower(*suffix) == 'e' && suffix[1] == '\0')) {
        return DALCS_NUMBER_MALFORMED;
    }

    result.value = convert(&m, m.power + exponent + suffix_power, negative);
    const enum dalcs_number_status status = finish_value(&result, &m);
    if (status == DALCS_NUMBER_OK) {
        *number = result;
    }
    return status;
}

enum dalcs_number_status dalcs_number_parse(const char *text, struct dalcs_number *number) {
    return dalcs_number_parse_as(text, DALCS_DIALECT_UNKNOWN, number);
}

/* decimal.c - doubles as the shortest decimals that are read back as the same double.
 *
 * value * 10^k is formed as one 64 x 64 -> 128 bit product with a truncated power of ten; its top
 * bits are the 17 digits, the rest decides the rounding. The error of the power is below one unit
 * of the upper word, so all but about 1 % of the values are decided there; the others go through
 * printf, which is exact. Of a double 17 digits are always enough, and 15 wherever fewer are: the nearest
 * decimal of 15 digits, then that of 16, is taken where it lies within half a unit of the double's last place,
 * from which all is rounded to it. */
#include "decimal.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define N_DIGITS 17
#define TEN_16   UINT64_C(10000000000000000)
#define TEN_17   UINT64_C(100000000000000000)

enum { N_LIMBS = 6 };

/* limb[0] is the most significant; the top bit is kept at bit 31 of limb[0] or below. */
static void normalise(uint32_t limb[N_LIMBS], int *exponent) {
    while (!(limb[0] & UINT32_C(0x80000000))) {
        for (int i = 0; i < N_LIMBS; i++) {
            limb[i] = limb[i] << 1 | (i + 1 < N_LIMBS ? limb[i + 1] >> 31 : 0);
        }
        --*exponent;
    }
}

static void shift_right(uint32_t limb[N_LIMBS], int bits, int *exponent) {
    for (int i = N_LIMBS - 1; i >= 0; i--) {
        limb[i] = limb[i] >> bits | (i > 0 ? limb[i - 1] << (32 - bits) : 0);
    }
    *exponent += bits;
}

static void multiply_by_ten(uint32_t limb[N_LIMBS], int *exponent) {
    shift_right(limb, 4, exponent);
    uint64_t carry = 0;
    for (int i = N_LIMBS - 1; i >= 0; i--) {
        carry += (uint64_t)limb[i] * 10;
        limb[i] = (uint32_t)carry;
        carry >>= 32;
    }
    normalise(limb, exponent);
}

static void divide_by_ten(uint32_t limb[N_LIMBS], int *exponent) {
    uint64_t rest = 0;
    for (int i = 0; i < N_LIMBS; i++) {
        rest = rest << 32 | limb[i];
        limb[i] = (uint32_t)(rest / 10);
        rest %= 10;
    }
    normalise(limb, exponent);
}

/* 192 bits carry the 340 steps with no visible error in the first 64. */
void dalcs_decimal_init(struct dalcs_decimal *decimal) {
    for (int direction = -1; direction <= 1; direction += 2) {
        uint32_t limb[N_LIMBS] = {UINT32_C(0x80000000)};
        int exponent = -63; /* of the first 64 bits read as an integer */
        int last = direction < 0 ? DALCS_DECIMAL_MIN_POWER : DALCS_DECIMAL_MAX_POWER;
        for (int power = 0;; power += direction) {
            int slot = power - DALCS_DECIMAL_MIN_POWER;
            decimal->significand[slot] = (uint64_t)limb[0] << 32 | limb[1];
            decimal->exponent[slot] = (int16_t)exponent;
            if (power == last) {
                break;
            }
            if (direction > 0) {
                multiply_by_ten(limb, &exponent);
            } else {
                divide_by_ten(limb, &exponent);
            }
        }
    }
}

static uint64_t multiply_high(uint64_t a, uint64_t b) {
    uint64_t a_low = a & UINT32_MAX, a_high = a >> 32, b_low = b & UINT32_MAX, b_high = b >> 32;
    uint64_t middle = a_high * b_low + (a_low * b_low >> 32);
    uint64_t cross = a_low * b_high + (middle & UINT32_MAX);
    return a_high * b_high + (middle >> 32) + (cross >> 32);
}

enum rounding { KEEPS, LOSES, UNDECIDED };

/* high / 2^shift, which is up to two units of high too small, and half the distance to the next double, above and
 * below: of a power of two they differ. */
struct scaled {
    uint64_t high, above, below;
    int shift;
};

/* Rounds to the nearest multiple of `unit`. KEEPS: what is there is read back as the same double. UNDECIDED: two
 * multiples may be as near, or two doubles. */
static inline enum rounding round_to(uint64_t unit, const struct scaled *s, uint64_t *digits) {
    const uint64_t high = s->high;
    const int shift = s->shift;
    const uint64_t mask = (UINT64_C(1) << shift) - 1, fraction = high & mask;
    const uint64_t whole = high >> shift, rest = whole % unit;
    const uint64_t nearest = whole - rest + (2 * rest >= unit ? unit : 0);
    const uint64_t scaled = nearest << shift;
    const uint64_t distance = scaled > high ? scaled - high : high - scaled;
    const uint64_t half = scaled > high ? s->above : s->below;
    if (distance > half + 4) {
        return LOSES;
    }
    *digits = nearest;
    const bool is_tie =
        (2 * rest == unit && fraction == 0) || (2 * (rest + 1) == unit && fraction + 2 > mask);
    return is_tie || distance + 4 > half ? UNDECIDED : KEEPS;
}

/* value = digits * 10^(power - 16) rounded; false when the product has too few digits to decide. value is positive and
 * normal. */
static bool find_digits_fast(const struct dalcs_decimal *decimal, double value, uint64_t *digits,
                             int *power) {
    uint64_t bits = 0;
    memcpy(&bits, &value, sizeof bits);
    const uint64_t mantissa = UINT64_C(1) << 63 | bits << 11;
    const int binary = (int)(bits >> 52) - (DBL_MAX_EXP - 1) - 63; /* value = mantissa * 2^binary */
    *power = (int)floor((binary + 63) * 0.30102999566398120);
    for (;; ++*power) {
        int slot = N_DIGITS - 1 - *power - DALCS_DECIMAL_MIN_POWER;
        uint64_t high = multiply_high(mantissa, decimal->significand[slot]);
        int shift = -(binary + decimal->exponent[slot]) - 64;
        uint64_t whole = high >> shift;
        if (whole >= TEN_17) {
            continue; /* the logarithm was one too low */
        }
        const uint64_t half = decimal->significand[slot] >> 54; /* of the last of 53 bits */
        const bool is_power = mantissa == UINT64_C(1) << 63;
        const struct scaled scaled = {high, half, is_power ? half / 2 : half, shift};
        enum rounding rounding = round_to(100, &scaled, digits);
        if (rounding == LOSES) {
            rounding = round_to(10, &scaled, digits);
        }
        if (rounding == LOSES) {
            const uint64_t fraction = high & ((UINT64_C(1) << shift) - 1);
            const uint64_t middle = UINT64_C(1) << (shift - 1);
            /* the true fraction lies in [fraction, fraction + 2) */
            rounding = fraction + 2 > middle && fraction <= middle ? UNDECIDED : KEEPS;
            *digits = whole + (fraction > middle ? 1 : 0);
        }
        if (*digits == TEN_17) {
            *digits = TEN_16;
            ++*power;
        }
        return rounding == KEEPS;
    }
}

static void find_digits_exactly(double value, uint64_t *digits, int *power) {
    char text[64];
    int n = N_DIGITS - 2;
    do {
        snprintf(text, sizeof text, "%.*e", n - 1, value);
    } while (n++ < N_DIGITS && strtod(text, NULL) != value);
    *digits = 0;
    const char *c = text;
    int n_read = 0;
    for (; *c != 'e'; c++) {
        if (*c >= '0' && *c <= '9') { /* skips the decimal point, however it is spelt */
            *digits = *digits * 10 + (uint64_t)(*c - '0');
            n_read++;
        }
    }
    for (; n_read < N_DIGITS; n_read++) {
        *digits *= 10;
    }
    *power = atoi(c + 1);
}

/* Two halves at once: each digit waits for the division that gave the one before it. */
static void spell(uint64_t digits, char digit[N_DIGITS]) {
    enum { HALF = N_DIGITS / 2, TEN_8 = 100000000 };

    uint32_t upper = (uint32_t)(digits / TEN_8);
    uint32_t lower = (uint32_t)(digits % TEN_8);
    for (int i = HALF; i > 0; i--) {
        digit[i] = (char)('0' + upper % 10);
        digit[i + HALF] = (char)('0' + lower % 10);
        upper /= 10;
        lower /= 10;
    }
    digit[0] = (char)('0' + upper);
}

static size_t write_scientific(char *text, const char *digit, int n, int power) {
    char *c = text;
    *c++ = digit[0];
    if (n > 1) {
        *c++ = '.';
        memcpy(c, digit + 1, (size_t)n - 1);
        c += n - 1;
    }
    const int size = abs(power);
    *c++ = 'e';
    *c++ = power < 0 ? '-' : '+';
    if (size >= 100) {
        *c++ = (char)('0' + size / 100);
    }
    *c++ = (char)('0' + size / 10 % 10);
    *c++ = (char)('0' + size % 10);
    return (size_t)(c - text);
}

static size_t write_fixed(char *text, const char *digit, int n, int power) {
    char *c = text;
    if (power < 0) {
        memcpy(c, "0.000", 5);
        c += 1 - power;
        memcpy(c, digit, (size_t)n);
        return (size_t)(c + n - text);
    }
    int n_whole = power + 1;
    int n_copied = n < n_whole ? n : n_whole;
    memcpy(c, digit, (size_t)n_copied);
    memset(c + n_copied, '0', (size_t)(n_whole - n_copied));
    c += n_whole;
    if (n > n_whole) {
        *c++ = '.';
        memcpy(c, digit + n_whole, (size_t)(n - n_whole));
        c += n - n_whole;
    }
    return (size_t)(c - text);
}

static size_t write_word(char *text, const char *word) {
    const size_t length = strlen(word);
    memcpy(text, word, length + 1);
    return length;
}

size_t dalcs_decimal_write(const struct dalcs_decimal *decimal, double value,
                           char text[DALCS_DECIMAL_SIZE]) {
    char *c = text;
    if (isnan(value)) {
        return write_word(text, "nan");
    }
    if (signbit(value)) {
        *c++ = '-';
        value = -value;
    }
    if (value == 0.0 || isinf(value)) {
        return (size_t)(c - text) + write_word(c, value == 0.0 ? "0" : "inf");
    }
    uint64_t digits = 0;
    int power = 0;
    if (value < DBL_MIN || !find_digits_fast(decimal, value, &digits, &power)) {
        find_digits_exactly(value, &digits, &power);
    }
    char digit[N_DIGITS];
    spell(digits, digit);
    int n = N_DIGITS;
    while (n > 1 && digit[n - 1] == '0') {
        n--;
    }
    bool scientific = power < -4 || power >= N_DIGITS;
    c += scientific ? write_scientific(c, digit, n, power) : write_fixed(c, digit, n, power);
    *c = '\0';
    return (size_t)(c - text);
}

/* decimal.h - doubles as the shortest text that is read back as the same double, fast and whatever the locale. */
#ifndef DALCS_DECIMAL_H
#define DALCS_DECIMAL_H

#include <stddef.h>
#include <stdint.h>

enum { DALCS_DECIMAL_MIN_POWER = -292, DALCS_DECIMAL_MAX_POWER = 341, DALCS_DECIMAL_SIZE = 32 };

/* Powers of ten: 10^k = significand * 2^exponent, the significand's top bit set. */
struct dalcs_decimal {
    uint64_t significand[DALCS_DECIMAL_MAX_POWER - DALCS_DECIMAL_MIN_POWER + 1];
    int16_t exponent[DALCS_DECIMAL_MAX_POWER - DALCS_DECIMAL_MIN_POWER + 1];
};

void dalcs_decimal_init(struct dalcs_decimal *decimal);

/* Writes what printf("%.Ng") gives in the C locale with N = 15, 16 or 17, the first that is read back exactly; a nan has no sign. Returns the length. */
size_t dalcs_decimal_write(const struct dalcs_decimal *decimal, double value,
                           char text[DALCS_DECIMAL_SIZE]);

#endif

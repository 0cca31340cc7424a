/* quantity.h - numbers for people: "12.35 mV", "20 us". */
#ifndef DALCS_QUANTITY_H
#define DALCS_QUANTITY_H

#include <stddef.h>

enum { DALCS_QUANTITY_SIZE = 32 };

/* The power of 1000 whose prefix suits `value`: 1e-3 for 0.012; 1 for 0, inf and nan. */
double dalcs_quantity_scale(double value);

/* "m" for 1e-3, "" for 1; micro is "u". */
const char *dalcs_quantity_prefix(double scale);

/* `digits` significant digits, trailing zeros dropped: "4 V", "-12.5 mA". */
const char *dalcs_quantity_write(char text[DALCS_QUANTITY_SIZE], double value, const char *unit,
                                 int digits);

/* The same with all zeros and one blank more where there is no prefix, so that a right-aligned
 * column lines up: "4.000  V", "-12.50 mA". */
const char *dalcs_quantity_write_column(char text[DALCS_QUANTITY_SIZE], double value,
                                        const char *unit, int digits);

#endif

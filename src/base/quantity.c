/* quantity.c - engineering notation with SI prefixes. Outside 1e-18 to 1e15 it falls back to
 * powers of ten. */
#include "quantity.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

static const char prefix_text[][2] = {"a", "f", "p", "n", "u", "m", "", "k", "M", "G", "T"};

enum { N_PREFIXES = sizeof prefix_text / sizeof prefix_text[0], NO_PREFIX = 6 };

/* Index into prefix_text; < 0 or >= N_PREFIXES where there is none. */
static int find_prefix(double value) {
    if (value == 0.0 || !isfinite(value)) {
        return NO_PREFIX;
    }
    /* The tiny factor keeps 1e-3, which may lie below its own power of ten, from being 1000 u. */
    double thousands = floor(log10(fabs(value) * (1.0 + 1e-12)) / 3.0);
    return (int)thousands + NO_PREFIX;
}

static double prefix_scale(int index) {
    return pow(10.0, 3.0 * (index - NO_PREFIX));
}

double dalcs_quantity_scale(double value) {
    int index = find_prefix(value);
    index = index < 0 ? 0 : index;
    return prefix_scale(index >= N_PREFIXES ? N_PREFIXES - 1 : index);
}

const char *dalcs_quantity_prefix(double scale) {
    int index = find_prefix(scale);
    return index < 0 || index >= N_PREFIXES ? "" : prefix_text[index];
}

static const char *write(char *text, double value, const char *unit, int digits, bool column) {
    int index = find_prefix(value);
    if (index < 0 || index >= N_PREFIXES || !isfinite(value)) {
        snprintf(text, DALCS_QUANTITY_SIZE, column ? "%.*g  %s" : "%.*g %s", digits, value, unit);
        return text;
    }
    double mantissa = value / prefix_scale(index);
    double limit = 1000.0 - 0.5 * pow(10.0, 3.0 - digits);
    if (fabs(mantissa) >= limit && index + 1 < N_PREFIXES) { /* 999.96 at four digits is 1.000 k */
        mantissa = value / prefix_scale(++index);
    }
    const char *prefix = prefix_text[index];
    if (!column) {
        snprintf(text, DALCS_QUANTITY_SIZE, "%.*g %s%s", digits, mantissa, prefix, unit);
        return text;
    }
    int n_whole = fabs(mantissa) < 9.9995 ? 1 : fabs(mantissa) < 99.995 ? 2 : 3;
    snprintf(text, DALCS_QUANTITY_SIZE, "%.*f %s%s%s", digits > n_whole ? digits - n_whole : 0,
             mantissa, *prefix ? "" : " ", prefix, unit);
    return text;
}

const char *dalcs_quantity_write(char text[DALCS_QUANTITY_SIZE], double value, const char *unit,
                                 int digits) {
    return write(text, value, unit, digits, false);
}

const char *dalcs_quantity_write_column(char text[DALCS_QUANTITY_SIZE], double value,
                                        const char *unit, int digits) {
    return write(text, value, unit, digits, true);
}

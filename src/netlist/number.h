/* number.h - SPICE numbers: 4.7k, 10uF, 1Meg, 1e-3, 2.5mil. */
#ifndef DALCS_NUMBER_H
#define DALCS_NUMBER_H

#include "dialect.h"

enum dalcs_number_status {
    DALCS_NUMBER_OK,
    DALCS_NUMBER_MALFORMED, /* not a number */
    DALCS_NUMBER_RKM,       /* 4k7: a digit after the suffix, elsewhere than in LTspice */
    DALCS_NUMBER_OVERFLOW,  /* larger than any double */
    DALCS_NUMBER_UNDERFLOW  /* smaller than any double, but not 0 */
};

/* The suffix after the digits, for warnings about suffixes that are often meant otherwise. */
struct dalcs_number {
    double value;
    char suffix;     /* 't' 'g' 'x' (meg) 'k' 'i' (mil) 'm' 'u' 'n' 'p' 'f' 'a', or 0 */
    bool is_special; /* 4k7 of LTspice, 1x of Xyce */
    int digits;      /* bytes up to the suffix: sign, digits, point and exponent */
    int tail;        /* byte where the ignored unit starts; the length when there is none */
};

/* Reads all of `text` (any case, NUL-terminated). The value is the double nearest to the decimal
 * number written, suffix included: 100n is 100e-9, not 100 times a rounded 1e-9. Independent of the
 * locale. Letters after the suffix are a unit and ignored. `number` is set when the result is OK. */
enum dalcs_number_status dalcs_number_parse(const char *text, struct dalcs_number *number);

/* The same in a dialect: LTspice's 4k7 is 4.7k and 2R2 is 2.2, Xyce's 1x is 1Meg. */
enum dalcs_number_status dalcs_number_parse_as(const char *text, enum dalcs_dialect_name dialect,
                                               struct dalcs_number *number);

#endif

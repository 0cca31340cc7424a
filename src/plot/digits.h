/* digits.h - how many digits the numbers of a text have, and what they may be off by for that. */
#ifndef DALCS_DIGITS_H
#define DALCS_DIGITS_H

#include <stdbool.h>
#include <stddef.h>

/* A number x is as good as relative |x| + absolute. */
struct dalcs_precision {
    double relative, absolute;
};

/* Of the numbers of one column. Zero-initialise. */
struct dalcs_digits {
    int most;              /* significant digits of a number, the largest count */
    int decimals;          /* behind the point, plus 1; 0: no number yet */
    bool is_fixed, varies; /* without exponents; not all have so many decimals */
};

/* The number that is the text [from, to), blanks before it. */
void dalcs_digits_note(struct dalcs_digits *digits, const char *from, const char *to);

/* Half a unit in the last place. Where all numbers but those of the axis, column 0, have as many decimals, and no
 * exponents, they were written with a fixed point. Else zeros at the end may have been left away, so that the
 * longest number of the table shows how many digits there were. The axis is judged on its own. Columns without
 * digits are left alone. */
void dalcs_digits_judge(const struct dalcs_digits *digits, size_t n_columns,
                        struct dalcs_precision *precision);

#endif

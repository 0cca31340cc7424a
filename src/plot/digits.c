/* digits.c - digits of numbers in a text. */
#include "digits.h"

#include <ctype.h>
#include <math.h>

void dalcs_digits_note(struct dalcs_digits *digits, const char *from, const char *to) {
    int significant = 0, decimals = 0;
    bool behind_point = false, has_digit = false, has_exponent = false;
    for (; from < to && !has_exponent; from++) {
        const bool is_digit = isdigit((unsigned char)*from) != 0;
        has_digit = has_digit || is_digit;
        significant += is_digit && (significant > 0 || *from != '0') ? 1 : 0;
        decimals += is_digit && behind_point ? 1 : 0;
        behind_point = behind_point || *from == '.';
        has_exponent = *from == 'e' || *from == 'E';
    }
    if (!has_digit) {
        return;
    }
    const bool is_first = digits->decimals == 0;
    digits->is_fixed = (is_first || digits->is_fixed) && !has_exponent;
    digits->varies = digits->varies || (!is_first && digits->decimals != decimals + 1);
    digits->decimals = decimals + 1;
    digits->most = significant > digits->most ? significant : digits->most;
}

static double unit_of(int most) {
    return most > 0 ? 0.5 * pow(10.0, 1 - most) : 0.0;
}

void dalcs_digits_judge(const struct dalcs_digits *digits, size_t n_columns,
                        struct dalcs_precision *precision) {
    int most = 0;
    for (size_t c = 1; c < n_columns; c++) {
        most = digits[c].most > most ? digits[c].most : most;
    }
    for (size_t c = 0; c < n_columns; c++) {
        const struct dalcs_digits *d = &digits[c];
        if (d->decimals > 1 && d->is_fixed && !d->varies) {
            precision[c].absolute = 0.5 * pow(10.0, 1 - d->decimals);
        } else if (d->decimals > 0) {
            precision[c].relative = unit_of(c == 0 ? d->most : most);
        }
    }
}

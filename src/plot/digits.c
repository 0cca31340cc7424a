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

/* Of the columns [first, end), taken together. */
static struct dalcs_digits join(const struct dalcs_digits *digits, size_t first, size_t end) {
    struct dalcs_digits all = digits[first];
    for (size_t c = first; c < end; c++) {
        all.most = digits[c].most > all.most ? digits[c].most : all.most;
        all.varies = all.varies || digits[c].varies || digits[c].decimals != all.decimals;
        all.is_fixed = all.is_fixed && digits[c].is_fixed;
    }
    return all;
}

static struct dalcs_precision precision_of(struct dalcs_digits d) {
    struct dalcs_precision p = {0};
    if (d.decimals > 1 && d.is_fixed && !d.varies) {
        p.absolute = 0.5 * pow(10.0, 1 - d.decimals);
    } else if (d.most > 0) {
        p.relative = 0.5 * pow(10.0, 1 - d.most);
    }
    return p;
}

void dalcs_digits_judge(const struct dalcs_digits *digits, size_t n_columns,
                        struct dalcs_precision *precision) {
    const size_t part[] = {0, 1, n_columns};
    for (size_t k = 0; k < 2; k++) {
        for (size_t c = part[k]; c < part[k + 1]; c++) {
            if (digits[c].decimals > 0) {
                precision[c] = precision_of(join(digits, part[k], part[k + 1]));
            }
        }
    }
}

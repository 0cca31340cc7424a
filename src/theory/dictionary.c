/* dictionary.c - exchanges of basic variables, and the constraints that are hidden behind them.
 *
 * Ranks decide what is exchanged, and circuits have 1e-12 beside 1e6. So each element carries the
 * size of what its rounding came from, and is 0 when it is below 1e-11 of that: this does not depend
 * on units. */
#include "dictionary.h"

#include <math.h>

static const double noise = 1e-11;

/* a -= by, where by has rounding errors of the size given. */
static void subtract(struct dalcs_dictionary *d, int i, int j, double by, double size) {
    double *a = dalcs_at(&d->a, i, j);
    double *s = dalcs_at(&d->size, i, j);
    *a -= by;
    *s = fmax(*s, fmax(fabs(by), size));
    if (fabs(*a) <= noise * *s) {
        *a = 0.0;
    }
}

static void swap_variables(struct dalcs_dictionary *d, int r, int c) {
    struct dalcs_variable v = d->row[r];
    d->row[r] = d->column[c];
    d->column[c] = v;
    double scale = d->row_scale[r];
    d->row_scale[r] = 1.0 / d->column_scale[c];
    d->column_scale[c] = 1.0 / scale;
}

/* Row r: basic = pivot column + rest, solved for the variable of column c. */
static void exchange(struct dalcs_dictionary *d, int r, int c) {
    const double pivot = *dalcs_at(&d->a, r, c);
    const double pivot_error = *dalcs_at(&d->size, r, c) / fabs(pivot);
    for (int j = 0; j < d->n_columns; j++) {
        double *u = dalcs_at(&d->a, r, j);
        double *s = dalcs_at(&d->size, r, j);
        if (j != c && *u != 0.0) {
            *u = -*u / pivot;
            *s = fmax(*s / fabs(pivot), fabs(*u) * pivot_error);
        }
    }
    for (int j = 0; j < d->n_columns; j++) {
        const double u = *dalcs_at(&d->a, r, j);
        if (j == c || u == 0.0) {
            continue;
        }
        const double u_size = *dalcs_at(&d->size, r, j);
        for (int i = 0; i < d->n_rows; i++) {
            const double l = *dalcs_at(&d->a, i, c);
            if (i != r && l != 0.0) {
                subtract(d, i, j, -l * u,
                         fmax(fabs(l) * u_size, fabs(u) * *dalcs_at(&d->size, i, c)));
            }
        }
    }
    for (int i = 0; i < d->n_rows; i++) {
        double *l = dalcs_at(&d->a, i, c);
        if (i != r && *l != 0.0) {
            *l /= pivot;
            double *s = dalcs_at(&d->size, i, c);
            *s = fmax(*s / fabs(pivot), fabs(*l) * pivot_error);
        }
    }
    *dalcs_at(&d->a, r, c) = 1.0 / pivot;
    *dalcs_at(&d->size, r, c) = pivot_error / fabs(pivot);
    swap_variables(d, r, c);
    if (d->column[c].kind == DALCS_VARIABLE_ZERO) {
        d->column[c].kind = DALCS_VARIABLE_GONE;
        for (int i = 0; i < d->n_rows; i++) {
            *dalcs_at(&d->a, i, c) = 0.0;
        }
    }
}

/* The largest element of the rows and columns of a kind; false when all are 0. */
static bool find_pivot(const struct dalcs_dictionary *d, enum dalcs_variable_kind row,
                       enum dalcs_variable_kind column, int *r, int *c) {
    double best = 0.0;
    for (int j = 0; j < d->n_columns; j++) {
        for (int i = 0; d->column[j].kind == column && i < d->n_rows; i++) {
            double value = d->row[i].kind == row ? fabs(*dalcs_at(&d->a, i, j)) : 0.0;
            if (value > best) {
                best = value;
                *r = i;
                *c = j;
            }
        }
    }
    return best > 0.0;
}

/* A row without algebraic unknowns tells one variable of a pair; the other then tells an unknown that
 * is left. */
static bool swap_pair(struct dalcs_dictionary *d) {
    double best = 0.0;
    int at[4] = {0, 0, 0, 0};
    for (int c = 0; c < d->n_columns; c++) {
        if (!dalcs_variable_is_of_pair(d->column[c].kind)) {
            continue;
        }
        int r = 0;
        while (
            !(dalcs_variable_is_of_pair(d->row[r].kind) && d->row[r].index == d->column[c].index)) {
            r++;
        }
        double first = 0.0;
        double second = 0.0;
        int zero = 0;
        int unknown = 0;
        for (int i = 0; i < d->n_rows; i++) {
            double value =
                d->row[i].kind == DALCS_VARIABLE_ZERO ? fabs(*dalcs_at(&d->a, i, c)) : 0.0;
            zero = value > first ? i : zero;
            first = fmax(first, value);
        }
        for (int j = 0; j < d->n_columns; j++) {
            double value =
                d->column[j].kind == DALCS_VARIABLE_ALGEBRAIC ? fabs(*dalcs_at(&d->a, r, j)) : 0.0;
            unknown = value > second ? j : unknown;
            second = fmax(second, value);
        }
        if (first * second > best) {
            best = first * second;
            at[0] = zero;
            at[1] = c;
            at[2] = r;
            at[3] = unknown;
        }
    }
    if (best > 0.0) {
        exchange(d, at[0], at[1]);
        exchange(d, at[2], at[3]);
    }
    return best > 0.0;
}

/* Row r is x_c = (a combination of states and inputs): its derivative takes the place of the row of
 * x_c'. False when it has derivatives of inputs already. */
static bool differentiate(struct dalcs_dictionary *d, int r) {
    int state = d->row[r].index;
    int own = 0;
    while (!(d->row[own].kind == DALCS_VARIABLE_DERIVATIVE && d->row[own].index == state)) {
        own++;
    }
    for (int j = 0; j < d->n_columns; j++) {
        if (d->column[j].kind == DALCS_VARIABLE_INPUT_DERIVATIVE && *dalcs_at(&d->a, r, j) != 0.0) {
            return false;
        }
    }
    const double unit = d->row_scale[r];
    for (int j = 0; j < d->n_columns; j++) {
        const double g = *dalcs_at(&d->a, r, j) / (unit * d->column_scale[j]);
        if (g == 0.0) {
            continue;
        }
        for (int i = 0; i < d->n_rows; i++) {
            if (d->column[j].kind == DALCS_VARIABLE_STATE &&
                d->row[i].kind == DALCS_VARIABLE_DERIVATIVE &&
                d->row[i].index == d->column[j].index) {
                double factor = g * d->row_scale[own] / d->row_scale[i];
                for (int q = 0; q < d->n_columns; q++) {
                    subtract(d, own, q, factor * *dalcs_at(&d->a, i, q),
                             fabs(factor) * *dalcs_at(&d->size, i, q));
                }
            }
        }
        for (int q = 0; d->column[j].kind == DALCS_VARIABLE_INPUT && q < d->n_columns; q++) {
            if (d->column[q].kind == DALCS_VARIABLE_INPUT_DERIVATIVE &&
                d->column[q].index == d->column[j].index) {
                double by = g * d->row_scale[own] * d->column_scale[q];
                subtract(d, own, q, by, fabs(by));
            }
        }
    }
    d->row[own] = (struct dalcs_variable){DALCS_VARIABLE_ZERO, 0};
    return true;
}

/* A row of states and inputs alone. */
static bool use_constraint(struct dalcs_dictionary *d, int *steps, const char **obstacle) {
    int r = 0;
    int c = 0;
    for (int i = 0; i < d->n_rows; i++) {
        bool has_pair = false;
        for (int j = 0; d->row[i].kind == DALCS_VARIABLE_ZERO && j < d->n_columns; j++) {
            has_pair = has_pair || (dalcs_variable_is_of_pair(d->column[j].kind) &&
                                    *dalcs_at(&d->a, i, j) != 0.0);
        }
        if (has_pair) {
            *obstacle = "an equation ties diodes to each other that no other unknown completes";
            return false;
        }
    }
    if (!find_pivot(d, DALCS_VARIABLE_ZERO, DALCS_VARIABLE_STATE, &r, &c)) {
        for (int i = 0; i < d->n_rows; i++) {
            d->row[i].kind = d->row[i].kind == DALCS_VARIABLE_ZERO
                                 ? DALCS_VARIABLE_GONE
                                 : d->row[i].kind; /* says it twice */
        }
        return true;
    }
    exchange(d, r, c);
    if (!differentiate(d, r)) {
        *obstacle = "the second derivative of a source would be needed";
        return false;
    }
    ++*steps;
    return true;
}

const char *dalcs_dictionary_reduce(struct dalcs_dictionary *d, int *steps) {
    const char *obstacle = NULL;
    for (;;) {
        int r = 0;
        int c = 0;
        bool is_left = false;
        while (find_pivot(d, DALCS_VARIABLE_ZERO, DALCS_VARIABLE_ALGEBRAIC, &r, &c)) {
            exchange(d, r, c);
        }
        for (int i = 0; i < d->n_rows; i++) {
            is_left = is_left || d->row[i].kind == DALCS_VARIABLE_ZERO;
        }
        if (!is_left) {
            break;
        }
        if (!swap_pair(d) && !use_constraint(d, steps, &obstacle)) {
            return obstacle;
        }
    }
    for (int j = 0; j < d->n_columns; j++) {
        for (int i = 0; i < d->n_rows; i++) {
            bool counts = d->row[i].kind == DALCS_VARIABLE_DERIVATIVE ||
                          dalcs_variable_is_of_pair(d->row[i].kind);
            if (d->column[j].kind == DALCS_VARIABLE_ALGEBRAIC && counts &&
                *dalcs_at(&d->a, i, j) != 0.0) {
                return "fewer equations than unknowns determine the diodes";
            }
        }
    }
    return NULL;
}

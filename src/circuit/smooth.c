/* smooth.c - values and derivatives of smooth functions of one and two arguments. */
#include "smooth.h"

#include "exponentials.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* Names that formulas have for them, the first one that is written. */
static const struct {
    const char *name;
    int n;
    enum dalcs_smooth_kind kind;
} NAMES[] = {
    {"*", 2, DALCS_SMOOTH_PRODUCT},
    {"/", 2, DALCS_SMOOTH_QUOTIENT},
    {"pow", 2, DALCS_SMOOTH_POWER},
    {"pwr", 2, DALCS_SMOOTH_MAGNITUDE_POWER},
    {"pwrs", 2, DALCS_SMOOTH_SIGNED_POWER},
    {"hypot", 2, DALCS_SMOOTH_HYPOT},
    {"atan2", 2, DALCS_SMOOTH_ATAN2},
    {"exp", 1, DALCS_SMOOTH_EXP},
    {"ln", 1, DALCS_SMOOTH_LOG},
    {"log", 1, DALCS_SMOOTH_LOG},
    {"log10", 1, DALCS_SMOOTH_LOG10},
    {"sqrt", 1, DALCS_SMOOTH_SQRT},
    {"cbrt", 1, DALCS_SMOOTH_CBRT},
    {"sqr", 1, DALCS_SMOOTH_SQUARE},
    {"square", 1, DALCS_SMOOTH_SQUARE},
    {"sin", 1, DALCS_SMOOTH_SIN},
    {"cos", 1, DALCS_SMOOTH_COS},
    {"tan", 1, DALCS_SMOOTH_TAN},
    {"asin", 1, DALCS_SMOOTH_ASIN},
    {"arcsin", 1, DALCS_SMOOTH_ASIN},
    {"acos", 1, DALCS_SMOOTH_ACOS},
    {"arccos", 1, DALCS_SMOOTH_ACOS},
    {"atan", 1, DALCS_SMOOTH_ATAN},
    {"arctan", 1, DALCS_SMOOTH_ATAN},
    {"sinh", 1, DALCS_SMOOTH_SINH},
    {"cosh", 1, DALCS_SMOOTH_COSH},
    {"tanh", 1, DALCS_SMOOTH_TANH},
    {"asinh", 1, DALCS_SMOOTH_ASINH},
    {"acosh", 1, DALCS_SMOOTH_ACOSH},
    {"atanh", 1, DALCS_SMOOTH_ATANH},
    {"logistic", 1, DALCS_SMOOTH_LOGISTIC},
    {"softplus", 1, DALCS_SMOOTH_SOFTPLUS},
    {"bernoulli", 1, DALCS_SMOOTH_BERNOULLI},
};

enum { N_NAMES = sizeof NAMES / sizeof NAMES[0] };

bool dalcs_smooth_find(const char *name, int n, enum dalcs_smooth_kind *kind) {
    bool found = false;
    for (int k = 0; k < N_NAMES && !found; k++) {
        found = NAMES[k].n == n && strcmp(NAMES[k].name, name) == 0;
        *kind = found ? NAMES[k].kind : *kind;
    }
    return found;
}

const char *dalcs_smooth_name(enum dalcs_smooth_kind kind) {
    const char *name = NULL;
    for (int k = 0; k < N_NAMES && name == NULL; k++) {
        name = NAMES[k].kind == kind ? NAMES[k].name : NULL;
    }
    return name;
}

/* 0/0 is 0, as in ngspice: where all sources are 0, at most operating points, so is what they make. */
static bool is_nothing(double x, double y) {
    return x == 0 && y == 0;
}

static double of_two(enum dalcs_smooth_kind kind, double x, double y) {
    switch (kind) {
    case DALCS_SMOOTH_PRODUCT:
        return x * y;
    case DALCS_SMOOTH_QUOTIENT:
        return is_nothing(x, y) ? 0 : x / y;
    case DALCS_SMOOTH_POWER:
        return pow(x, y);
    case DALCS_SMOOTH_MAGNITUDE_POWER:
        return pow(fabs(x), y);
    case DALCS_SMOOTH_SIGNED_POWER:
        return copysign(pow(fabs(x), y), x);
    case DALCS_SMOOTH_HYPOT:
        return hypot(x, y);
    default:
        return atan2(x, y);
    }
}

static double of_exponentials(enum dalcs_smooth_kind kind, double x) {
    return kind == DALCS_SMOOTH_LOGISTIC   ? dalcs_logistic(x)
           : kind == DALCS_SMOOTH_SOFTPLUS ? dalcs_softplus(x)
                                           : dalcs_bernoulli(x);
}

static double slope_of_exponentials(enum dalcs_smooth_kind kind, double x) {
    return kind == DALCS_SMOOTH_LOGISTIC   ? dalcs_logistic(x) * dalcs_logistic(-x)
           : kind == DALCS_SMOOTH_SOFTPLUS ? dalcs_logistic(x)
                                           : dalcs_bernoulli_slope(x);
}

double dalcs_smooth_value(enum dalcs_smooth_kind kind, const double *x) {
    switch (kind) {
    case DALCS_SMOOTH_EXP:
        return exp(x[0]);
    case DALCS_SMOOTH_LOG:
        return log(x[0]);
    case DALCS_SMOOTH_LOG10:
        return log10(x[0]);
    case DALCS_SMOOTH_SQRT:
        return sqrt(x[0]);
    case DALCS_SMOOTH_CBRT:
        return cbrt(x[0]);
    case DALCS_SMOOTH_SQUARE:
        return x[0] * x[0];
    case DALCS_SMOOTH_SIN:
        return sin(x[0]);
    case DALCS_SMOOTH_COS:
        return cos(x[0]);
    case DALCS_SMOOTH_TAN:
        return tan(x[0]);
    case DALCS_SMOOTH_ASIN:
        return asin(x[0]);
    case DALCS_SMOOTH_ACOS:
        return acos(x[0]);
    case DALCS_SMOOTH_ATAN:
        return atan(x[0]);
    case DALCS_SMOOTH_SINH:
        return sinh(x[0]);
    case DALCS_SMOOTH_COSH:
        return cosh(x[0]);
    case DALCS_SMOOTH_TANH:
        return tanh(x[0]);
    case DALCS_SMOOTH_ASINH:
        return asinh(x[0]);
    case DALCS_SMOOTH_ACOSH:
        return acosh(x[0]);
    case DALCS_SMOOTH_ATANH:
        return atanh(x[0]);
    default:
        return kind >= DALCS_SMOOTH_LOGISTIC ? of_exponentials(kind, x[0])
                                             : of_two(kind, x[0], x[1]);
    }
}

/* Where its values begin and end. */
static void find_domain(enum dalcs_smooth_kind kind, double exponent, double *low, double *high) {
    *low = -(double)INFINITY;
    *high = (double)INFINITY;
    switch (kind) {
    case DALCS_SMOOTH_SQRT:
        *low = 0.0;
        break;
    case DALCS_SMOOTH_POWER:
        *low = exponent > 0.0 && floor(exponent) != exponent ? 0.0 : *low;
        break;
    case DALCS_SMOOTH_ASIN:
    case DALCS_SMOOTH_ACOS:
        *low = -1.0;
        *high = 1.0;
        break;
    case DALCS_SMOOTH_ACOSH:
        *low = 1.0;
        break;
    default:
        break;
    }
}

double dalcs_smooth_held(enum dalcs_smooth_kind kind, const double *x, double slack) {
    double low;
    double high;
    find_domain(kind, x[1], &low, &high);
    if (kind == DALCS_SMOOTH_QUOTIENT && x[1] == 0.0) {
        low = high = 0.0; /* rounding over 0 is 0/0 */
    }
    const double held = x[0] < low ? low : x[0] > high ? high : x[0];
    return fabs(x[0] - held) <= slack ? held : x[0];
}

double dalcs_smooth_variation(enum dalcs_smooth_kind kind, const double *x, int j, double off) {
    const double here = dalcs_smooth_value(kind, x);
    double most = 0.0;
    for (int side = -1; side <= 1; side += 2) {
        double moved[2] = {x[0], x[1]};
        moved[j] += side * off;
        const double differs = fabs(dalcs_smooth_value(kind, moved) - here);
        most = isfinite(differs) && differs > most ? differs : most;
    }
    return most;
}

/* x^y by y; a power whose exponent is a number has no use for it. */
static double by_exponent(double power, double x) {
    return power == 0.0 ? 0.0 : power * log(x);
}

static void gradient_of_two(enum dalcs_smooth_kind kind, double x, double y, double *gradient) {
    const double length = hypot(x, y);
    switch (kind) {
    case DALCS_SMOOTH_PRODUCT:
        gradient[0] = y;
        gradient[1] = x;
        break;
    case DALCS_SMOOTH_QUOTIENT:
        gradient[0] = is_nothing(x, y) ? 0 : 1.0 / y;
        gradient[1] = is_nothing(x, y) ? 0 : -x / y / y;
        break;
    case DALCS_SMOOTH_POWER:
        gradient[0] = y * pow(x, y - 1.0);
        gradient[1] = by_exponent(pow(x, y), x);
        break;
    case DALCS_SMOOTH_MAGNITUDE_POWER:
        gradient[0] = copysign(y * pow(fabs(x), y - 1.0), x * y);
        gradient[1] = by_exponent(pow(fabs(x), y), fabs(x));
        break;
    case DALCS_SMOOTH_SIGNED_POWER:
        gradient[0] = y * pow(fabs(x), y - 1.0);
        gradient[1] = by_exponent(copysign(pow(fabs(x), y), x), fabs(x));
        break;
    case DALCS_SMOOTH_HYPOT: /* at the tip of the cone 0 is between the slopes of all directions */
        gradient[0] = length > 0.0 ? x / length : 0.0;
        gradient[1] = length > 0.0 ? y / length : 0.0;
        break;
    default:
        gradient[0] = y / length / length;
        gradient[1] = -x / length / length;
        break;
    }
}

static double derivative(enum dalcs_smooth_kind kind, double x) {
    switch (kind) {
    case DALCS_SMOOTH_EXP:
        return exp(x);
    case DALCS_SMOOTH_LOG:
        return 1.0 / x;
    case DALCS_SMOOTH_LOG10:
        return 1.0 / (x * log(10.0));
    case DALCS_SMOOTH_SQRT:
        return 0.5 / sqrt(x);
    case DALCS_SMOOTH_CBRT:
        return 1.0 / (3.0 * cbrt(x) * cbrt(x));
    case DALCS_SMOOTH_SQUARE:
        return 2.0 * x;
    case DALCS_SMOOTH_SIN:
        return cos(x);
    case DALCS_SMOOTH_COS:
        return -sin(x);
    case DALCS_SMOOTH_TAN:
        return 1.0 + tan(x) * tan(x);
    case DALCS_SMOOTH_ASIN:
        return 1.0 / sqrt((1.0 - x) * (1.0 + x));
    case DALCS_SMOOTH_ACOS:
        return -1.0 / sqrt((1.0 - x) * (1.0 + x));
    case DALCS_SMOOTH_ATAN:
        return 1.0 / (1.0 + x * x);
    case DALCS_SMOOTH_SINH:
        return cosh(x);
    case DALCS_SMOOTH_COSH:
        return sinh(x);
    case DALCS_SMOOTH_TANH:
        return 1.0 / (cosh(x) * cosh(x));
    case DALCS_SMOOTH_ASINH:
        return 1.0 / hypot(1.0, x);
    case DALCS_SMOOTH_ACOSH:
        return 1.0 / sqrt((x - 1.0) * (x + 1.0));
    default:
        return kind == DALCS_SMOOTH_ATANH ? 1.0 / ((1.0 - x) * (1.0 + x))
                                          : slope_of_exponentials(kind, x);
    }
}

void dalcs_smooth_gradient(enum dalcs_smooth_kind kind, const double *x, double *gradient) {
    if (kind < DALCS_SMOOTH_EXP) {
        gradient_of_two(kind, x[0], x[1], gradient);
    } else {
        gradient[0] = derivative(kind, x[0]);
        gradient[1] = 0.0;
    }
}

double dalcs_smooth_tangent_point(enum dalcs_smooth_kind kind, double from, double to) {
    const bool is_even = kind == DALCS_SMOOTH_SINH || kind == DALCS_SMOOTH_COSH;
    const double size = is_even ? fabs(to) : to;
    const double base = fmax(is_even ? fabs(from) : from, 0.0);
    if ((kind != DALCS_SMOOTH_EXP && !is_even) || !(size > base + 1.0)) {
        return to;
    }
    return copysign(base + log1p(size - base), to);
}

void dalcs_smooth_nominal_gradient(enum dalcs_smooth_kind kind, const double *number,
                                   const bool *is_number, double *gradient) {
    const bool is_narrow = kind == DALCS_SMOOTH_ASIN || kind == DALCS_SMOOTH_ACOS ||
                           kind == DALCS_SMOOTH_ATANH || kind == DALCS_SMOOTH_EXP;
    const double usual = kind == DALCS_SMOOTH_ACOSH ? 2.0 : is_narrow ? 0.5 : 1.0;
    double x[2];
    for (int k = 0; k < 2; k++) {
        x[k] = is_number[k] ? number[k] : usual;
    }
    dalcs_smooth_gradient(kind, x, gradient);
    for (int k = 0; k < 2; k++) {
        gradient[k] = is_number[k] || !isfinite(gradient[k]) ? 0.0 : gradient[k];
    }
}

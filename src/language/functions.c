/* functions.c - the functions and constants that expressions have.
 *
 * Where dialects differ, what they agree on is taken and the rest is left out; doc/netlist.md lists
 * the differences. A result that is not finite is reported by the caller. */
#include "exponentials.h"
#include "expression.h"

#include <math.h>
#include <string.h>

/* Of a table: a measured waveform has thousands of points. */
enum { MOST_ARGUMENTS = 2000001 };

static double square(double x) {
    return x * x;
}

static double sign(double x) {
    return (double)((x > 0) - (x < 0));
}

static double step(double x) {
    return x > 0 ? 1 : 0;
}

static double is_zero(double x) {
    return x == 0 ? 1 : 0;
}

static double is_not_zero(double x) {
    return x != 0 ? 1 : 0;
}

static double is_below(double x) {
    return x < 0 ? 1 : 0;
}

static double is_not_below(double x) {
    return x >= 0 ? 1 : 0;
}

static double is_not_above(double x) {
    return x <= 0 ? 1 : 0;
}

static double ramp(double x) {
    return x > 0 ? x : 0;
}

static double buffer(double x) {
    return x > 0.5 ? 1 : 0;
}

static double invert(double x) {
    return x > 0.5 ? 0 : 1;
}

/* The magnitude to a power, as pwr() in every dialect. */
static double magnitude_power(double x, double y) {
    return pow(fabs(x), y);
}

static double signed_power(double x, double y) {
    return copysign(pow(fabs(x), y), x);
}

static double least(const double *x, int n) {
    double value = x[0];
    for (int k = 1; k < n; k++) {
        value = x[k] < value ? x[k] : value;
    }
    return value;
}

static double largest(const double *x, int n) {
    double value = x[0];
    for (int k = 1; k < n; k++) {
        value = x[k] > value ? x[k] : value;
    }
    return value;
}

/* limit(x, a, b): x between a and b, in either order. */
static double limit(const double *x, int n) {
    (void)n;
    const double low = x[1] < x[2] ? x[1] : x[2];
    const double high = x[1] < x[2] ? x[2] : x[1];
    return x[0] < low ? low : x[0] > high ? high : x[0];
}

/* table(x, x1, y1, x2, y2, ...): straight lines, constant outside. NAN: the x do not ascend. */
static double table(const double *x, int n) {
    const double *point = x + 1;
    const int n_points = (n - 1) / 2;
    for (int k = 1; k < n_points; k++) {
        if (!(point[2 * k] > point[2 * k - 2])) {
            return (double)NAN;
        }
    }
    if (n % 2 == 0 || n_points == 0) {
        return (double)NAN;
    }
    if (x[0] <= point[0]) {
        return point[1];
    }
    for (int k = 1; k < n_points; k++) {
        const double *a = point + 2 * k - 2;
        if (x[0] <= a[2]) {
            return a[1] + (a[3] - a[1]) * ((x[0] - a[0]) / (a[2] - a[0]));
        }
    }
    return point[2 * n_points - 1];
}

/* The same, but the first and the last line go on, as ngspice's pwl() does. */
static double lines(const double *x, int n) {
    const double *point = x + 1;
    const int n_points = (n - 1) / 2;
    const double inside = table(x, n);
    if (isnan(inside) || n_points == 1 || (x[0] >= point[0] && x[0] <= point[2 * n_points - 2])) {
        return inside;
    }
    const double *a = x[0] < point[0] ? point : point + 2 * n_points - 4;
    return a[1] + (a[3] - a[1]) * ((x[0] - a[0]) / (a[2] - a[0]));
}

static double clip(double x) {
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

/* A function of the C library that a table names is searched for whenever the program starts; one that is
 * called, when it is called first. */
#define CALL(f)                                                                                    \
    static double call_##f(double x) {                                                             \
        return f(x);                                                                               \
    }
#define CALL_OF_TWO(f)                                                                             \
    static double call_##f(double x, double y) {                                                   \
        return f(x, y);                                                                            \
    }
CALL(sin)
CALL(cos)
CALL(tan)
CALL(asin)
CALL(acos)
CALL(atan)
CALL(sinh)
CALL(cosh)
CALL(tanh)
CALL(asinh)
CALL(acosh)
CALL(atanh)
CALL(sqrt)
CALL(cbrt)
CALL(exp)
CALL(log)
CALL(log10)
CALL(fabs)
CALL(trunc)
CALL(floor)
CALL(ceil)
CALL(rint)
CALL(round)
CALL(dalcs_logistic)
CALL(dalcs_softplus)
CALL(dalcs_bernoulli)
CALL_OF_TWO(atan2)
CALL_OF_TWO(hypot)
CALL_OF_TWO(fmod)
CALL_OF_TWO(pow)

static const struct dalcs_function FUNCTIONS[] = {
    {"sin", 1, 1, call_sin, NULL, NULL},
    {"cos", 1, 1, call_cos, NULL, NULL},
    {"tan", 1, 1, call_tan, NULL, NULL},
    {"asin", 1, 1, call_asin, NULL, NULL},
    {"acos", 1, 1, call_acos, NULL, NULL},
    {"atan", 1, 1, call_atan, NULL, NULL},
    {"arcsin", 1, 1, call_asin, NULL, NULL},
    {"arccos", 1, 1, call_acos, NULL, NULL},
    {"arctan", 1, 1, call_atan, NULL, NULL},
    {"atan2", 2, 2, NULL, call_atan2, NULL},
    {"sinh", 1, 1, call_sinh, NULL, NULL},
    {"cosh", 1, 1, call_cosh, NULL, NULL},
    {"tanh", 1, 1, call_tanh, NULL, NULL},
    {"asinh", 1, 1, call_asinh, NULL, NULL},
    {"acosh", 1, 1, call_acosh, NULL, NULL},
    {"atanh", 1, 1, call_atanh, NULL, NULL},
    {"logistic", 1, 1, call_dalcs_logistic, NULL, NULL},
    {"softplus", 1, 1, call_dalcs_softplus, NULL, NULL},
    {"bernoulli", 1, 1, call_dalcs_bernoulli, NULL, NULL},
    {"sqrt", 1, 1, call_sqrt, NULL, NULL},
    {"sqr", 1, 1, square, NULL, NULL},
    {"square", 1, 1, square, NULL, NULL},
    {"cbrt", 1, 1, call_cbrt, NULL, NULL},
    {"hypot", 2, 2, NULL, call_hypot, NULL},
    {"exp", 1, 1, call_exp, NULL, NULL},
    {"ln", 1, 1, call_log, NULL, NULL},
    {"log", 1, 1, call_log, NULL, NULL},
    {"log10", 1, 1, call_log10, NULL, NULL},
    {"abs", 1, 1, call_fabs, NULL, NULL},
    {"sgn", 1, 1, sign, NULL, NULL},
    {"int", 1, 1, call_trunc, NULL, NULL},
    {"floor", 1, 1, call_floor, NULL, NULL},
    {"ceil", 1, 1, call_ceil, NULL, NULL},
    {"nint", 1, 1, call_rint, NULL, NULL},
    {"round", 1, 1, call_round, NULL, NULL},
    {"fmod", 2, 2, NULL, call_fmod, NULL},
    {"mod", 2, 2, NULL, call_fmod, NULL},
    {"pow", 2, 2, NULL, call_pow, NULL},
    {"pwr", 2, 2, NULL, magnitude_power, NULL},
    {"pwrs", 2, 2, NULL, signed_power, NULL},
    {"min", 1, 1000, NULL, NULL, least},
    {"max", 1, 1000, NULL, NULL, largest},
    {"limit", 3, 3, NULL, NULL, limit},
    {"u", 1, 1, step, NULL, NULL},
    {"stp", 1, 1, step, NULL, NULL},
    {"gt0", 1, 1, step, NULL, NULL},
    {"lt0", 1, 1, is_below, NULL, NULL},
    {"ge0", 1, 1, is_not_below, NULL, NULL},
    {"le0", 1, 1, is_not_above, NULL, NULL},
    {"eq0", 1, 1, is_zero, NULL, NULL},
    {"ne0", 1, 1, is_not_zero, NULL, NULL},
    {"uramp", 1, 1, ramp, NULL, NULL},
    {"u2", 1, 1, clip, NULL, NULL},
    {"buf", 1, 1, buffer, NULL, NULL},
    {"inv", 1, 1, invert, NULL, NULL},
    {"table", 3, MOST_ARGUMENTS, NULL, NULL, table},
    {"tbl", 3, MOST_ARGUMENTS, NULL, NULL, table},
    {"pwl", 3, MOST_ARGUMENTS, NULL, NULL, lines},
    {"if", 3, 3, NULL, NULL, NULL}, /* these two jump */
    {"ternary_fcn", 3, 3, NULL, NULL, NULL},
};

enum { N_FUNCTIONS = sizeof FUNCTIONS / sizeof FUNCTIONS[0] };

const struct dalcs_function *dalcs_function_find(const char *name,
                                                 enum dalcs_dialect_name dialect) {
    const bool is_log10 = dialect == DALCS_DIALECT_XYCE && strcmp(name, "log") == 0;
    name = is_log10 ? "log10" : name;
    for (int k = 0; k < N_FUNCTIONS; k++) {
        if (strcmp(FUNCTIONS[k].name, name) == 0) {
            return &FUNCTIONS[k];
        }
    }
    return NULL;
}

const char *dalcs_function_nearest(const char *name) {
    const char *names[N_FUNCTIONS];
    for (int k = 0; k < N_FUNCTIONS; k++) {
        names[k] = FUNCTIONS[k].name;
    }
    return dalcs_names_nearest_of(names, N_FUNCTIONS, name);
}

const char *dalcs_function_refusal(const char *name) {
    static const char *const random[] = {"random", "rnd", "white"};
    static const char *const signal[] = {"v", "i", "ddt", "idt", "sdt", "idtmod", "delay", "time"};
    for (size_t k = 0; k < sizeof random / sizeof random[0]; k++) {
        if (strcmp(name, random[k]) == 0) {
            return "flat(x) draws a value between -x and x, once a run";
        }
    }
    for (size_t k = 0; k < sizeof signal / sizeof signal[0]; k++) {
        if (strcmp(name, signal[k]) == 0) {
            return "an expression here is a number that is known before the run";
        }
    }
    return NULL;
}

bool dalcs_function_is_delay(const char *name) {
    return strcmp(name, "delay") == 0 || strcmp(name, "absdelay") == 0;
}

bool dalcs_function_is_noise(const char *name) {
    return strcmp(name, "rand") == 0 || strcmp(name, "random") == 0 || strcmp(name, "white") == 0;
}

bool dalcs_function_remembers(const char *name, int *least, int *most) {
    const bool is_derivative = strcmp(name, "ddt") == 0;
    const bool wraps = strcmp(name, "idtmod") == 0;
    *least = 1;
    *most = is_derivative ? 1 : wraps ? 4 : 3;
    return is_derivative || wraps || strcmp(name, "idt") == 0 || strcmp(name, "sdt") == 0;
}

bool dalcs_constant_find(const char *name, double *value) {
    static const struct {
        const char *name;
        double value;
    } constants[] = {
        {"pi", 3.14159265358979323846},
        {"e", 2.71828182845904523536},
        {"temper", 27}, /* degrees: ideal elements do not warm up */
        {"temp", 27},
        {"true", 1},
        {"false", 0},
        {"boltz", 1.380649e-23}, /* SI 2019, exact */
        {"echarge", 1.602176634e-19},
        {"planck", 6.62607015e-34},
        {"kelvin", -273.15},
    };

    for (size_t k = 0; k < sizeof constants / sizeof constants[0]; k++) {
        if (strcmp(constants[k].name, name) == 0) {
            *value = constants[k].value;
            return true;
        }
    }
    return false;
}

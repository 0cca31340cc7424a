/* smooth.h - smooth functions of node voltages: products, quotients, powers, exponentials and the like.
 *
 * A formula that is not piecewise linear is taken apart: each product or function in it is a source of its own whose
 * voltage is f(x[0], x[1]) of the voltages of nodes, and the formula reads that. Between its values at the nodes of a
 * step the engine takes such a source for a given function of time; Newton's method makes it agree with what it
 * reads. */
#ifndef DALCS_SMOOTH_H
#define DALCS_SMOOTH_H

#include <stdbool.h>

enum dalcs_smooth_kind {
    DALCS_SMOOTH_PRODUCT,
    DALCS_SMOOTH_QUOTIENT,
    DALCS_SMOOTH_POWER,           /* x^y */
    DALCS_SMOOTH_MAGNITUDE_POWER, /* |x|^y */
    DALCS_SMOOTH_SIGNED_POWER,    /* |x|^y with the sign of x */
    DALCS_SMOOTH_HYPOT,
    DALCS_SMOOTH_ATAN2,
    DALCS_SMOOTH_EXP,
    DALCS_SMOOTH_LOG,
    DALCS_SMOOTH_LOG10,
    DALCS_SMOOTH_SQRT,
    DALCS_SMOOTH_CBRT,
    DALCS_SMOOTH_SQUARE,
    DALCS_SMOOTH_SIN,
    DALCS_SMOOTH_COS,
    DALCS_SMOOTH_TAN,
    DALCS_SMOOTH_ASIN,
    DALCS_SMOOTH_ACOS,
    DALCS_SMOOTH_ATAN,
    DALCS_SMOOTH_SINH,
    DALCS_SMOOTH_COSH,
    DALCS_SMOOTH_TANH,
    DALCS_SMOOTH_ASINH,
    DALCS_SMOOTH_ACOSH,
    DALCS_SMOOTH_ATANH,
    DALCS_SMOOTH_LOGISTIC,  /* 1/(1 + exp(-x)) */
    DALCS_SMOOTH_SOFTPLUS,  /* ln(1 + exp(x)) */
    DALCS_SMOOTH_BERNOULLI, /* x/(exp(x) - 1) */
};

struct dalcs_smooth {
    enum dalcs_smooth_kind kind;
    int n;            /* arguments, 1 or 2 */
    int node[2];      /* whose voltage an argument is; -1: a number */
    double number[2]; /* that number */
    int source[2]; /* the device that puts an argument out at its node for this alone; -1: none */
    bool is_of_storage; /* it says what flux or charge is */
    double start[2];    /* then its arguments at the start */
};

/* The function of this name with n arguments; false: it is no smooth one. */
bool dalcs_smooth_find(const char *name, int n, enum dalcs_smooth_kind *kind);

/* How it is written. */
const char *dalcs_smooth_name(enum dalcs_smooth_kind kind);

/* f(x[0], x[1]) and its derivatives; not finite where it has none. */
double dalcs_smooth_value(enum dalcs_smooth_kind kind, const double *x);
void dalcs_smooth_gradient(enum dalcs_smooth_kind kind, const double *x, double *gradient);

/* The first argument, or the end of the function's domain where that is no more than `slack` away from it: rounding, or an
 * error that is allowed, makes of a root of 0 none of a number below. */
double dalcs_smooth_held(enum dalcs_smooth_kind kind, const double *x, double slack);

/* How far f is from f(x) where argument j is off by no more than `off`, one way or the other; near an end of its domain, where
 * a root is steep, that is far less than the tangent says. */
double dalcs_smooth_variation(enum dalcs_smooth_kind kind, const double *x, int j, double off);

/* Where Newton's method takes a function's tangent next, on the way from one argument to another: an exponential above 1
 * grows e-fold with each unit, and its tangent says nothing of what is more than one above. */
double dalcs_smooth_tangent_point(enum dalcs_smooth_kind kind, double from, double to);

/* The gradient at an argument of no importance, where it is neither 0 nor infinite: as well as any before more is known. */
void dalcs_smooth_nominal_gradient(enum dalcs_smooth_kind kind, const double *number,
                                   const bool *is_number, double *gradient);

#endif

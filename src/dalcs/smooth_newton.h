/* smooth_newton.h - Newton's method for the sources of a system that are smooth functions of columns.
 *
 * Each is f(x) = g x + phi, of which g x is in the equations: between two such sources in series a node is held by the
 * conductances that they have, and with these as given currents by none. At each of some points (one instant, or the
 * nodes of a step) the answer is affine in phi, which is to be f - g x of what is read there. With S the derivatives of x
 * by phi and F = f - g x, a step is
 *     delta - F'(a) S delta = F(a) + F'(a) (x - a) - phi,
 * a the points of the tangents, which are x but where an exponential is far from it (SPICE's limits of junctions, Nagel
 * 1975, in the function's own unit). */
#ifndef DALCS_SMOOTH_NEWTON_H
#define DALCS_SMOOTH_NEWTON_H

#include "smooth_inner.h"
#include "system.h"

struct dalcs_smooth_newton {
    const struct dalcs_system *system;
    int n_points;
    int n;          /* n_points * system->n_smooth values, point by point */
    double share;   /* functions count this much: 1, but on the way there from 0 */
    double *phi;    /* [n] */
    double *before; /* [n] phi one step ago */
    double (*x)[2]; /* [n] arguments that were read */
    double (*terms)
        [2]; /* [n] V: what they are made of, or the largest voltage that was read beside them */
    double volt;          /* the largest that was read at any point since the beginning */
    double (*tangent)[2]; /* [n] where tangents are */
    double (*other)[2];   /* [3][n_smooth] arguments elsewhere, for who asks what is between */
    double *slope;        /* [n][2][n] S */

    struct {
        double *matrix;     /* [n][n] */
        double *step;       /* [n] */
        double *correction; /* [n] */
        int *pivot;         /* [n] */
    } work;

    bool limits;    /* a tangent is elsewhere than its argument */
    bool is_damped; /* tangents are at arguments, and steps that lead away are halved */
    int n_steps;    /* since the beginning */
    int halved;     /* times that the last step was halved, or the beginning was moved */

    struct {
        bool is_refused; /* the rest of the circuit has no answer for the values that were tried */
        bool at_pole;    /* what divides in the worst one passes 0 */
        int worst;       /* of the system's smooth inputs, the one that agrees least */
        double
            defect; /* of the last check: over the terms of each function alone, in the tolerance */
        double defect_before; /* of the one before */
    } outcome;
    struct dalcs_smooth_inner inner;
};

/* The source of value q. */
static inline const struct dalcs_smooth_input *
dalcs_smooth_newton_input(const struct dalcs_smooth_newton *newton, int q) {
    return &newton->system->smooth[q % newton->system->n_smooth];
}

enum dalcs_status dalcs_smooth_newton_setup(struct dalcs_smooth_newton *newton,
                                            const struct dalcs_system *system, int n_points,
                                            struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* Tangents start anew, at these arguments x[n_smooth][2] at all points. */
void dalcs_smooth_newton_begin(struct dalcs_smooth_newton *newton, const double (*x)[2]);

/* Lines were changed: what phi does to the arguments is not known any more, and excuses none of them. */
void dalcs_smooth_newton_forget(struct dalcs_smooth_newton *newton);

/* Arguments, what parts of formulas among them are made of (NULL: nobody knows), and the largest V and A so far. */
struct dalcs_smooth_seen {
    const double (*x)[2], (*terms)[2]; /* [n_smooth] */
    double largest[2];
};

/* Lines g that are those of the tangents at what was seen, as far as these are finite, where one differs from the present
 * one by a factor beyond ten, or rounding of the present one hides a function that is something beside scale[2], the largest
 * V and A: what was solved with the others is to be forgotten, phi[n_smooth] is those that go with x. */
bool dalcs_smooth_retangent(const struct dalcs_system *system, const struct dalcs_smooth_seen *seen,
                            const double *scale, double *phi);

/* Lines as good as any before anything is known: of all functions, or of those that start on one, which say what flux
 * and charge are: for a given flux the current is in nothing but these. Those are the tangents where they begin, and x and
 * phi become what they are there. */
void dalcs_smooth_nominal_tangents(const struct dalcs_system *system);
void dalcs_smooth_starting_tangents(const struct dalcs_system *system, double (*x)[2], double *phi);
bool dalcs_smooth_starts_on_lines(const struct dalcs_system *system);

/* All lines times a factor, and phi that go with x then. */
void dalcs_smooth_scale_tangents(const struct dalcs_system *system, double factor,
                                 const double (*x)[2], double *phi);

/* None: the equations are as they are written. */
void dalcs_smooth_drop_tangents(const struct dalcs_system *system);

/* Arguments at a point from its columns y[n_columns], as they are with functions that only functions read at their values. */
void dalcs_smooth_newton_read(struct dalcs_smooth_newton *newton, int point, const double *y);

/* f - g x of one source. */
double dalcs_smooth_rest(const struct dalcs_smooth_input *of, const double *x);

/* What rounding of the function, which is `value` there, and of its arguments makes of it: exp(x) near 0 is 1, which no
 * argument of 0 rounds. */
double dalcs_smooth_rounding(const struct dalcs_smooth_input *of, double value, const double *x);

/* ... what that of its arguments leaves, where a share of the function is taken. */
double dalcs_smooth_share_rounding(const struct dalcs_smooth_input *of, double share,
                                   const double *x);

/* The same without its line: what is left where the line is as steep as the function. */
double dalcs_smooth_function_rounding(const struct dalcs_smooth_input *of, const double *x);

/* What argument j of value q is made of: the numbers of a step are solved for together, and each is known to the rounding
 * of the largest, and of what the given values make of it. */
double dalcs_smooth_newton_terms(const struct dalcs_smooth_newton *newton, int q, int j);

/* The arguments x[n_smooth][2] in columns y[n_columns]. */
void dalcs_smooth_arguments(const struct dalcs_system *system, const double *y, double (*x)[2]);

/* Do all values agree with what was read, to `tolerance`, arguments being what they are to the rounding of their terms? *is_done: and another step would not make them agree any better. */
bool dalcs_smooth_newton_agrees(struct dalcs_smooth_newton *newton, double tolerance,
                                bool *is_done);

/* What the answer for value q may be off by as its line is rounded, where its own tangent is rounded far less; else 0. */
double dalcs_smooth_newton_excused(const struct dalcs_smooth_newton *newton, int q);

/* The value of a source that was tried last, its line included. */
double dalcs_smooth_newton_tried(const struct dalcs_smooth_newton *newton, int q);

/* Can anything be done with what was read? If not, the last step was too long, and is halved; before the first one,
 * functions that have a value are given it, until those that read them have one: false where that was done too often.
 * *repeats: it was; the arguments are to be read again. */
bool dalcs_smooth_newton_is_finite(struct dalcs_smooth_newton *newton, bool *repeats);

/* Has the last step led away, where steps are damped? It is halved then, and the arguments are to be read again. What
 * rounding excuses of a value, beside `tolerance`, says nothing of that. */
bool dalcs_smooth_newton_overshoots(struct dalcs_smooth_newton *newton, double tolerance);

/* No value of source `worst` agrees, for it has none at these arguments. */
void dalcs_smooth_newton_blame_pole(struct dalcs_smooth_newton *newton, int worst, const double *x);

/* Factors of 1 - f'(x) S in newton->matrix, for changes of phi; false: there are none. */
bool dalcs_smooth_newton_factor(struct dalcs_smooth_newton *newton);

/* change[n] of phi, where x changes by dx[n][2] beside what phi does to it. */
void dalcs_smooth_newton_vary(const struct dalcs_smooth_newton *newton, const double (*dx)[2],
                              double *change);

/* The next phi by way of newton->slope; false: there is none. */
bool dalcs_smooth_newton_step(struct dalcs_smooth_newton *newton);

#endif

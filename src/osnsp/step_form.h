/* step_form.h - the OSNSP of one step size, condensed.
 *
 * With sigma = 1/h, implicit Euler turns the DALCS into (Brogliato 2022, eq. (3.1))
 *     (sigma P - A) (x+, z+, lambda+) = sigma P x_k + E s,       w = C (x+, z+, lambda+) + F s.
 * Eliminating x+ (eq. (3.2)) one state at a time, each through the row it is paired with (a
 * capacitor by x = v(a) - v(b), a coil by its branch equation), leaves
 *     K y = R u,   y = (z+, lambda+),  u = (x_k, s),
 * rows and columns in paired order: the first n rows are equations, row n + d gives the w of pair d,
 *     w_d = K_(n+d) y - R_(n+d) u.
 * This is the nodal companion circuit, found by elimination and not by device formulas, so that any
 * DALCS goes the same way. sigma = 0 is the operating point: capacitors open, coils short. */
#ifndef DALCS_STEP_FORM_H
#define DALCS_STEP_FORM_H

#include "system.h"

struct dalcs_step_form {
    double sigma; /* 1/s */
    int n;        /* equations and unknowns besides the pairs */
    int n_pairs;
    int n_u;            /* n_x + n_inputs */
    int *column_of;     /* [n] the system's column of an unknown: all z first, then kept x */
    struct dalcs_csr K; /* [n + n_pairs][n + n_pairs], transposed: row c lists column c, scaled */
    struct dalcs_csr W; /* [n_pairs][n + n_pairs] the last n_pairs rows of K, scaled, by rows */
    struct dalcs_csr R; /* [n + n_pairs][n_u], rows scaled */
    double *scale;      /* [n + n_pairs] powers of 2: y = scale * scaled y */
    double *row_scale;  /* [n + n_pairs] powers of 2 that rows of K and R were multiplied with */
    double pair_conductance;                    /* S: the typical scale * row_scale of a pair */
    double least_conductance, most_conductance; /* S, of the whole system */

    double volt_in_amperes,
        ampere_in_volts; /* how far the scale of one unit reaches into the other */

    enum {
        DALCS_UNKNOWN,
        DALCS_UNIQUE,
        DALCS_MANY
    } answers; /* can there be more than one? ties.c */

    struct {
        struct dalcs_csr X; /* [n_x][n_columns] x+ = X (0, z+, lambda+) + Xu u; kept x: identity */
        struct dalcs_csr Xu;
        int *ends; /* [n_x][2] columns whose difference is x+, -1 where it is more than that */
    } state;

    struct {
        int n; /* rows of the system that recovering x+ does not satisfy by definition */
        int *row;
        struct dalcs_csr form; /* [n] those rows over (sigma (x+ - x_k), y, s) side by side */
        double *volts;   /* [n_equations] sum of |coefficients| on voltages, sigma P included */
        double *amperes; /* [n_equations] the same on currents */
    } checks;

    struct dalcs_arena arena; /* vectors */
};

/* Condenses the system at sigma. On failure *form is zeroed. */
enum dalcs_status dalcs_step_form_build(struct dalcs_step_form *form,
                                        const struct dalcs_system *system,
                                        double sigma) DALCS_MUST_CHECK;

/* What it holds. */
size_t dalcs_step_form_bytes(const struct dalcs_step_form *form);

void dalcs_step_form_finish(struct dalcs_step_form *form);

#endif

/* equations.h - a network written down: for machines (a system file, JSON, Matrix Market) and for people
 * (text, LaTeX); as the DALCS (2.1), as the LCS that is left when z is eliminated, or as the one-step
 * problem (3.2) of Brogliato, SIAM J. Control Optim. 60(4), 2022. */
#ifndef DALCS_EQUATIONS_H
#define DALCS_EQUATIONS_H

#include "network.h"

#include <stdio.h>

/* What is written: a circuit, or the one of no devices that a system file has, and its network. */
struct dalcs_equations {
    const struct dalcs_circuit *circuit;
    const struct dalcs_network *network;
    const struct dalcs_network *jump[2]; /* by enum dalcs_impulse_kind; NULL: none */
    const bool *jumps_are_covered;       /* [n_systems] by these, NULL: none */
    const struct dalcs_network *held;    /* for the start of a .tran with .ic; NULL: none */
};

/* Files of one set: the first has no suffix, a matrix ".A_I.mtx". */
struct dalcs_equations_files {
    void *user;
    enum dalcs_status (*file)(void *user, const char *suffix, const char *text, size_t length);
    const char *stem; /* what the files' names begin with, where one names another */
};

/* A number as it is read back to the bit, with a point whatever the locale. */
void dalcs_write_number(FILE *f, double value);

/* ---- write_system.c ------------------------------------------------------------------------- */

enum dalcs_machine_format { DALCS_AS_CARDS, DALCS_AS_JSON, DALCS_AS_MATRIX_MARKET };

enum dalcs_status
dalcs_equations_write_system(const struct dalcs_equations *equations,
                             enum dalcs_machine_format format,
                             const struct dalcs_equations_files *files) DALCS_MUST_CHECK;

/* The source function behind `input NAME`. */
void dalcs_write_stimulus(FILE *f, const struct dalcs_stimulus *s);

/* A name as one word of a card, in quotes where it needs them. */
void dalcs_write_name(FILE *f, const char *name);

/* ---- write_text.c --------------------------------------------------------------------------- */

/* Every equation on a line of its own, with the names of elements; LaTeX that compiles as it is. */
void dalcs_equations_write_text(FILE *f, const struct dalcs_equations *equations);
void dalcs_equations_write_latex(FILE *f, const struct dalcs_equations *equations);

/* ---- reduce.c ------------------------------------------------------------------------------- */

/* *reduced becomes the network with z eliminated from each system whose B_II is regular, and where that is
 * all of them *because is NULL; else *because (in arena) says which system keeps its z, and why. */
enum dalcs_status dalcs_equations_reduce(const struct dalcs_network *network,
                                         struct dalcs_network *reduced, struct dalcs_arena *arena,
                                         const char **because) DALCS_MUST_CHECK;

/* ---- one_step.c ----------------------------------------------------------------------------- */

/* lambda's problem of a step, w = M lambda + q(x_k, s): dense, row by row. */
struct dalcs_one_step {
    const struct dalcs_system *system;
    double sigma;
    double *M;        /* [n_pairs][n_pairs] */
    double *of_x;     /* [n_pairs][n_x] */
    double *of_s;     /* [n_pairs][n_inputs] */
    bool is_singular; /* x and z are not functions of lambda: nothing else is filled */
};

enum dalcs_status dalcs_one_step_of(struct dalcs_one_step *step, const struct dalcs_system *system,
                                    double h) DALCS_MUST_CHECK;
void dalcs_one_step_finish(struct dalcs_one_step *step);

void dalcs_one_step_write_text(FILE *f, const struct dalcs_one_step *step);
void dalcs_one_step_begin_latex(FILE *f, const struct dalcs_circuit *circuit);
void dalcs_one_step_write_latex(FILE *f, const struct dalcs_circuit *circuit,
                                const struct dalcs_one_step *step);
void dalcs_one_step_write_json(FILE *f, const struct dalcs_one_step *step);

/* As Matrix Market: M, Qx and Qs in files of their own, named by `part` where that is not 0. */
enum dalcs_status
dalcs_one_step_write_market(const struct dalcs_one_step *step, int part,
                            const struct dalcs_equations_files *files) DALCS_MUST_CHECK;

#endif

/* brogliato_case.h - a system that the assumptions of Brogliato 2022 are checked of. Private to this folder. */
#ifndef DALCS_BROGLIATO_CASE_H
#define DALCS_BROGLIATO_CASE_H

#include "brogliato.h"
#include "passivity.h"
#include "step_blocks.h"

#define DALCS_BROGLIATO(what) "Brogliato 2022, " what

struct dalcs_brogliato_case {
    struct dalcs_findings *f;
    const struct dalcs_blocks *b;
    double h;
    struct dalcs_brogliato *found;
    const char **z_name; /* [p] */
    struct dalcs_quadruple model, step;
    struct dalcs_passive_quadruple passive_model, passive_step;
};

/* `id` of assumption 2 or 3 (all pairs), 7 or 9 (those of the zero block). */
enum dalcs_status dalcs_brogliato_check_coupling(struct dalcs_brogliato_case *c, const char *id,
                                                 const char *source, const char *text,
                                                 const struct dalcs_quadruple *q,
                                                 const bool *is_member, bool *holds,
                                                 struct dalcs_matrix *X);

/* What is known of the passivity of a quadruple, for one that `holds` where it is passive. */
enum dalcs_answer dalcs_brogliato_passive(const struct dalcs_passive_quadruple *p, bool holds);

/* Item 3: the set S of (4.6) is {0} when -At is positive definite in the metric of X. */
enum dalcs_status dalcs_brogliato_433(struct dalcs_brogliato_case *c, bool coupled,
                                      const struct dalcs_matrix *X);

/* Proposition 4.3. */
enum dalcs_status dalcs_brogliato_43(struct dalcs_brogliato_case *c);

/* Propositions 4.4 (q of the step) and 4.8 (q of the model). */
enum dalcs_status dalcs_brogliato_blocks(struct dalcs_brogliato_case *c, bool of_step, bool *blocks,
                                         bool *coupled, bool *monotone, double *strength);

/* Im(C_II2) meets K2 - C_I2 x - F2 for all x and sources when C_II2 has full row rank. */
enum dalcs_status dalcs_brogliato_qualification(struct dalcs_brogliato_case *c);

/* Proposition 4.7. */
enum dalcs_status dalcs_brogliato_47(struct dalcs_brogliato_case *c, bool D_is_zero, bool coupled,
                                     const struct dalcs_matrix *X);

/* Finds what the algebraic variables are called. */
enum dalcs_status dalcs_brogliato_name_algebraic(struct dalcs_brogliato_case *c);

#endif

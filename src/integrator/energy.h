/* energy.h - the ledger of a run: where the energy came from and where it went.
 *
 *     sources = resistors + diodes + jumps + stored change + method
 *
 * holds up to rounding for both methods, whatever the step. In a step of implicit Euler Tellegen's
 * theorem at its end gives it with method = 1/2 |dx|^2 in the metric of the storage; where the step
 * crosses a jump, that is what the jump dissipates. For Radau IIA it holds for the polynomials through
 * the stages (stage_rule.h), method being what the states miss them by, 1/2 |x_0 - x~(0)|^2 over a whole
 * step: algebraic stability (Hairer and Wanner, Solving ODEs II, sec. IV.12). What the integrator moves
 * states by without a jump, where it puts them back on what a mode allows, counts as method too.
 *
 * Kept only when asked for. */
#ifndef DALCS_ENERGY_H
#define DALCS_ENERGY_H

#include "radau.h"

struct dalcs_energy_part {
    const struct dalcs_system *system;
    int n_terms, n_stepped;        /* the first n_stepped need steps, sources decide the others */
    struct dalcs_power_term *term; /* [n_terms] */
    double stored_at_start;        /* J */
    double lost;                   /* J, in the jumps that the next step of euler crosses */
    double largest[2]; /* V, A: physical scales of the steps of euler, and of what sources drive */
    double *half;      /* [n_x] of the diagonal of the storage */
    bool is_coupled;   /* the storage has entries off its diagonal */
    double *defect;    /* [n_x] work: how far states are off */
};

struct dalcs_energy {
    double account[DALCS_N_POWER_ACCOUNTS]; /* J */
    double jumps, stored_change, method;    /* J */
    double missed;   /* J, of radau's polynomials and moves: the magnitudes that are in method */
    double turnover; /* J, the sum of all that was moved, whatever its sign */
    double rounding; /* J, what certificates leave open: a balance of this size means nothing */
    bool is_euler;
    int n_parts;
    struct dalcs_energy_part *part;
};

/* For the components of `e`, which go with radau or, where that is NULL, with implicit Euler. */
enum dalcs_status dalcs_energy_setup(struct dalcs_energy *energy, const struct dalcs_euler *e,
                                     const struct dalcs_radau *radau) DALCS_MUST_CHECK;

void dalcs_energy_finish(struct dalcs_energy *energy);

/* Component k starts from x[n_x], before any jump at t = 0. */
void dalcs_energy_start(struct dalcs_energy *energy, int k, const double *x);

/* Component k made a step of implicit Euler of length h from x[n_x] to y[n_columns], with the inputs
 * at its end. */
void dalcs_energy_step(struct dalcs_energy *energy, int k, const double *x, const double *y,
                       const double *inputs, double h);

/* The answers on both sides of a switch that slides, and the part of the time for which each holds. */
struct dalcs_energy_sides {
    const double *y[2];
    double weight[2];
};

/* times_h / h times such a step of length h from x to y, their mean: its powers, which are means of those on either
 * side, no products of means. Returns what one of them stores, and loses by implicit Euler. */
double dalcs_energy_sliding_step(struct dalcs_energy *energy, int k, const double *x,
                                 const double *y, const struct dalcs_energy_sides *sides,
                                 const double *inputs, double times_h);

/* A segment from x to y that is a sum of such steps, which take so much. */
void dalcs_energy_slide(struct dalcs_energy *energy, int k, const double *x, const double *y,
                        double taken);

/* The answer of a step of component k has these scales. */
void dalcs_energy_scale(struct dalcs_energy *energy, int k,
                        const struct dalcs_certificate *certificate);

/* A part's present segment has been passed through from the state start[n_x] to part->x. */
void dalcs_energy_segment(struct dalcs_energy *energy, const struct dalcs_radau_part *part,
                          const double *start);

/* States of a part change from part->x to after[n_x] without a jump. */
void dalcs_energy_move(struct dalcs_energy *energy, const struct dalcs_radau_part *part,
                       const double *after);

/* A jump that is reported. What the sources gave in it is taken to be what it cost. */
void dalcs_energy_jump(struct dalcs_energy *energy, const struct dalcs_euler_jump *jump);

/* At the end of the run: the last segments, what needed no steps, the stored energy. */
enum dalcs_status dalcs_energy_close(struct dalcs_energy *energy, struct dalcs_euler *e,
                                     struct dalcs_radau *radau) DALCS_MUST_CHECK;

/* J: what the sources gave less where it went. */
double dalcs_energy_balance(const struct dalcs_energy *energy);

/* J: a balance that is more than rounding, or else what radau missed where that is more than its
 * tolerance explains; 0 when all is well. radau: NULL with implicit Euler. */
double dalcs_energy_unexplained(const struct dalcs_energy *energy, const struct dalcs_radau *radau);

#endif

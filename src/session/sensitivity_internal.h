/* sensitivity_internal.h - shared by the files of .sens. */
#ifndef DALCS_SENSITIVITY_INTERNAL_H
#define DALCS_SENSITIVITY_INTERNAL_H

#include "sensitivity.h"

/* Values of the circuits that differences are of: the netlist's, and by h and 2h more and less. */
enum { AT_VALUE, PLUS, MINUS, PLUS_TWO, MINUS_TWO, N_ORBITS };

struct dalcs_sensitivities {
    struct dalcs_steady *st; /* the orbit at the netlist's values, with M */
    struct dalcs_run *run;
    struct dalcs_run_options options;
    uint64_t signature; /* of that orbit */
    size_t n_results;
    struct dalcs_sensitivity_result *result; /* [n_results] the session's */
    double *value[N_ORBITS];                 /* [n_results] */
    double *image[N_ORBITS]; /* [n_x] where a period leads to; of AT_VALUE that is the start */
    double *step;            /* [n_x] work */
    struct looked *looked;   /* [n_results] of the value in hand */
    bool may_differ;         /* the modes of orbits with another value */
    struct dalcs_orbit_point beside; /* work */
    struct dalcs_arena arena;
};

/* ---- sensitivity_circuit.c: one circuit with another value ------------------------------------- */

/* A session of the circuit with the override; to be finished, whatever this returns. */
enum dalcs_status dalcs_sensitivity_build(struct dalcs_sensitivities *s,
                                          const struct dalcs_override *override, size_t n,
                                          struct dalcs_session *other) DALCS_MUST_CHECK;

/* Runs what is asked for. *same: that succeeds, and the modes follow each other as on s's orbit. Errors alone are
 * returned, of a circuit with another value no more than those that end everything. */
enum dalcs_status dalcs_sensitivity_run(struct dalcs_sensitivities *s, struct dalcs_session *other,
                                        struct dalcs_steady_near *near,
                                        bool *same) DALCS_MUST_CHECK;

/* What it has measured into s->value[which]; *same: as much as s's orbit. */
void dalcs_sensitivity_take(struct dalcs_sensitivities *s, const struct dalcs_session *other,
                            int which, bool *same);

/* ---- sensitivity_tangent.c ----------------------------------------------------------------------- */

/* s->value[] of the four circuits that differ by h and 2h in the item, along the tangent of the orbit. *same: their
 * modes follow each other as on it. */
enum dalcs_status dalcs_sensitivity_along_tangent(struct dalcs_sensitivities *s,
                                                  const struct dalcs_sweep *item, double by,
                                                  bool *same) DALCS_MUST_CHECK;

/* The distance of the circuit from the value, in units of h. */
double dalcs_sensitivity_place(int which);

#endif

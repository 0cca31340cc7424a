/* stages.h - the stage equations of one system in a given mode and step length, solved.
 *
 * In a fixed mode a step is linear in the state and in the coefficients of the sources: what comes
 * out are all columns, the other side of every pair, and the voltages that move switches, at the
 * start and at the stages, with estimates of the error. For small systems the whole is one dense
 * matrix; for large ones it is solved on one real and (s-1)/2 complex factorisations.
 *
 * A mode whose matrix is singular (floating voltages, currents in loops of diodes) is solved where
 * its equations agree, with the least-norm choice of what they leave open; where they do not agree,
 * the clash says by how much. */
#ifndef DALCS_STAGES_H
#define DALCS_STAGES_H

#include "collocation.h"
#include "excitation.h"

#include <stdint.h>
#include <suitesparse/klu.h>

struct dalcs_stage_entry;
struct dalcs_stage_plan;
struct dalcs_stage_workshop;

/* The layout of an answer. Node k of the step starts at k * stride: the columns, then the
 * watched voltages. Behind the nodes is a stage at the start, if the method has one. In the place of lambda_d an open pair has its w_d. */
struct dalcs_stage_layout {
    int stride;
    int n_nodes; /* s + 1 */
    int drift;   /* [n_x] how far the states miss a solution of order s at the start */
    int ripple; /* [n_columns] what sources do between the nodes; only if the excitation is curved */
    int n_fixed; /* all of the above; the clashes of a singular mode follow */
};

/* Entries by (mode, h), and what makes new ones. */
struct dalcs_stage_cache {
    size_t bytes, most_bytes;
    struct dalcs_stage_entry *entries, *newest, *oldest;
    struct dalcs_stage_entry *newest_base; /* entries with factors that others may use */
    int update_trust;                      /* updates that served against those that did not */
    uint64_t *key;                         /* [n_words + 1] */
    long factorizations, cache_hits;
    klu_common klu, klu_complex;
};

struct dalcs_stages {
    const struct dalcs_system *system;
    const int *block_of; /* [n_columns] partition.h; NULL: all are one. To be set after the setup */
    const struct dalcs_excitation *excitation;
    const struct dalcs_collocation *method;
    struct dalcs_stage_layout layout;
    int n_currents; /* branch currents without memory */
    int n_levered,
        *levered; /* [n_levered] their columns, then those of voltages that resistors make of coils; where
                     sources are controlled, of all */
    int n_watched;
    int *watched; /* [n_watched] pairs: switches that follow a voltage, or a source along a curve */
    int n_in;     /* n_x + 1 + functions: (x_0, 1, coefficients) */
    int n_words;
    struct dalcs_stage_cache cache;
    int dense_limit;
    double rcond_min;
    double
        unseen; /* rounding, over what it is in, that the error allowed hides; 0: as little as can be */
    long n_briefs;                         /* so far (stage_brief.h) */
    struct dalcs_stage_plan *plan;         /* what sparse factors share; NULL until there are any */
    struct dalcs_stage_workshop *workshop; /* what makes dense maps; NULL until there are any */
};

struct dalcs_stage_limits {
    int dense_limit;   /* unknowns up to which a step is a dense map */
    double rcond_min;  /* of factors */
    size_t most_bytes; /* of all entries */
};

enum dalcs_status dalcs_stages_setup(struct dalcs_stages *stages, const struct dalcs_system *system,
                                     const struct dalcs_excitation *excitation,
                                     const struct dalcs_collocation *method,
                                     const struct dalcs_stage_limits *limits) DALCS_MUST_CHECK;

void dalcs_stages_finish(struct dalcs_stages *stages);

/* The values of the system's equations have changed: no entry is valid any more. */
void dalcs_stages_forget(struct dalcs_stages *stages);

/* The entry of (mode[n_words], h), prepared now if it is new. Older ones make room, it is valid until
 * the next call. */
enum dalcs_status dalcs_stages_get(struct dalcs_stages *stages, const uint64_t *mode, double h,
                                   struct dalcs_stage_entry **entry) DALCS_MUST_CHECK;

/* It, if it is there already; else NULL. */
struct dalcs_stage_entry *dalcs_stages_find(struct dalcs_stages *stages, const uint64_t *mode,
                                            double h);

/* in[n_in] to out[n_fixed + n_clashes]. */
enum dalcs_status dalcs_stages_apply(struct dalcs_stages *stages, struct dalcs_stage_entry *entry,
                                     const double *in, double *out) DALCS_MUST_CHECK;

/* Both at once. An entry on the factors of a mode nearby that serve badly is given its own. */
enum dalcs_status dalcs_stages_step(struct dalcs_stages *stages, const uint64_t *mode, double h,
                                    const double *in, double *out,
                                    struct dalcs_stage_entry **entry) DALCS_MUST_CHECK;

/* Makes what has no memory agree with the states where an answer on factors begins: it goes with states that are off there by
 * a part of their drift. Then it agrees wherever the polynomials of both are evaluated, for equations without derivatives
 * are linear. Where an event is looked for that matters: what is a part of 1e-11 of a coil's current may be volts of a
 * diode that opens. Maps have more stages. */
void dalcs_stages_settle(const struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                         double *out);

/* drift[n_levered], A and V: what goes with the drift of the states of stages->levered, in the step that was applied
 * last. */
void dalcs_stages_drift_of_currents(struct dalcs_stages *stages,
                                    const struct dalcs_stage_entry *entry, const double *in,
                                    double *drift);

/* As dalcs_stage_spread, of drift[k] by an entry with a map. */
double dalcs_stage_spread_of_current(const struct dalcs_stages *stages,
                                     const struct dalcs_stage_entry *entry, int k, const double *in,
                                     const double *scale);

/* The jump of state x on entry to the mode, from an entry with a map; NAN: not known. */
double dalcs_stage_shift(const struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                         int x, const double *in);

/* For who watches the drift of currents: 0 until it was set. */
int *dalcs_stage_note(struct dalcs_stage_entry *entry);

/* Keeps an entry valid, whatever else is asked for, until it is released as often. */
void dalcs_stages_hold(struct dalcs_stage_entry *entry);
void dalcs_stages_release(struct dalcs_stages *stages, struct dalcs_stage_entry *entry);

/* Where the circuit is, y[n_columns] in the layout of an answer, in this mode: on factors the steps to
 * come are solved for what changes from there. */
void dalcs_stages_stay_near(struct dalcs_stages *stages, const uint64_t *mode, const double *y);

int dalcs_stage_n_clashes(const struct dalcs_stage_entry *entry);

/* Are clashes what rows miss that were given up, instead of what sources disagree by? */
bool dalcs_stage_gives_rows_up(const struct dalcs_stage_entry *entry);

/* stage_miss.c: what the terms of such a row add up to where its columns are as large as size[n_columns], in the unit of its
 * clash k at this node, by an entry without a map. */
double dalcs_stage_clash_size(const struct dalcs_stages *stages,
                              const struct dalcs_stage_entry *entry, int k, int node,
                              const double *in, const double *size);

/* Room for any answer: a mode has no more null vectors than columns, each with a clash at every stage; in whole eights. */
static inline size_t dalcs_stages_room(const struct dalcs_stages *stages) {
    const size_t n_columns = (size_t)dalcs_system_n_columns(stages->system);
    return (size_t)stages->layout.n_fixed + (size_t)stages->method->s * n_columns + 8;
}

/* The rounding of the answer over that of an answer from a dense map. */
double dalcs_stage_rounding(const struct dalcs_stage_entry *entry);

/* Is every state free in this mode? false: no, or not known, as on factors. */
bool dalcs_stage_frees_states(const struct dalcs_stage_entry *entry);

/* [2 n_equations] units in which the columns are in balance with each other, then their inverses. */
const double *dalcs_stage_natural_units(const struct dalcs_stage_entry *entry);

bool dalcs_stage_has_map(const struct dalcs_stage_entry *entry);

/* Has every entry one, whatever its mode? */
static inline bool dalcs_stages_have_maps(const struct dalcs_stages *stages) {
    return dalcs_system_n_columns(stages->system) <= stages->dense_limit;
}

/* What errors in the states and sources, each the same part of them, may make of element `row` of an
 * answer, over that part, by an entry with a map; a state is at least scale[n_x]. */
double dalcs_stage_spread(const struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                          int row, const double *in, const double *scale);

/* Largest residual of the stage equations over the size of their terms. Equations without derivatives hold to rounding, even if
 * it is rounding of large conductances, unless a mode is singular and the states contradict it, which takes a circuit that
 * is not passive. */
double dalcs_stage_residual(const struct dalcs_stage_entry *entry);

#endif

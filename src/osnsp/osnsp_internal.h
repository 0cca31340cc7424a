/* osnsp_internal.h - what the files of src/osnsp share. */
#ifndef DALCS_OSNSP_INTERNAL_H
#define DALCS_OSNSP_INTERNAL_H

#include "osnsp.h"
#include "whole.h"

#include <string.h>

#define HASH_NONFATAL_OOM 1
#include <uthash.h>

/* Its equations as they stand, or with the weights of the proximal method. */
enum dalcs_mode_kind { DALCS_PLAIN, DALCS_WEIGHTED };

/* A mode at a step size: its factors, and for a small recurring one the map from u to y. */
struct dalcs_mode_entry {
    UT_hash_handle hh;
    struct dalcs_mode_entry *newer, *older;
    uint64_t *key; /* mode words, then form id and kind; behind the entry, as `on` is */
    bool singular; /* no factors: remembered so that it is not tried again */
    int n_on;
    int *on; /* [n_on] ascending */
    struct dalcs_lu lu;
    int *row_of, *column_of; /* [lu.n] plain factors: row of R, column of y, in pivot order */
    double *scale_of;        /* [lu.n]; behind it the two */
    struct dalcs_whole *
        whole; /* of a singular mode that was asked for its factors with choices: these; else NULL */
    bool answers;        /* they gave a certified answer once */
    bool is_too_open;    /* or there are none, as it leaves more open than is chosen among */
    double *map;         /* see step_map.h; NULL until the mode has recurred */
    uint64_t tie;        /* which ties of this mode were looked at last; 0: none yet */
    bool tie_has_choice; /* they leave a choice */
    int n_uses;
    size_t bytes;
};

/* ---- osnsp.c ------------------------------------------------------------------------------- */

/* As dalcs_osnsp_answer() and dalcs_osnsp_solve() with given sources, in whatever answer is come to. */
enum dalcs_status dalcs_osnsp_answer_given(struct dalcs_osnsp *p, double sigma, const double *u,
                                           double *y) DALCS_MUST_CHECK;
enum dalcs_status dalcs_osnsp_solve_given(struct dalcs_osnsp *p, double sigma, const double *u,
                                          double *y) DALCS_MUST_CHECK;

/* ---- mode_cache.c -------------------------------------------------------------------------- */

/* The form of sigma, condensed now if it is new; it becomes p->cache.form[0]. */
enum dalcs_status dalcs_forms_get(struct dalcs_osnsp *p, double sigma) DALCS_MUST_CHECK;

/* The entry of (p->mode, p->cache.form[0], kind), factored now if it is new; entry->singular is no
 * failure. Older entries make room, never this one. */
enum dalcs_status dalcs_modes_get(struct dalcs_osnsp *p, enum dalcs_mode_kind kind,
                                  struct dalcs_mode_entry **entry) DALCS_MUST_CHECK;

/* Counts the bytes of a map that was just added to the entry. */
void dalcs_modes_grew(struct dalcs_osnsp *p, struct dalcs_mode_entry *entry, size_t bytes);

void dalcs_modes_finish(struct dalcs_osnsp *p);

/* ---- mode_factors.c ------------------------------------------------------------------------ */

/* Of p->mode in p->cache.form[0], into the entry. */
enum dalcs_status dalcs_modes_factor_plain(struct dalcs_osnsp *p,
                                           struct dalcs_mode_entry *entry) DALCS_MUST_CHECK;

/* With so many entries, which are for the caller to set, as are the starts behind the first. All is in the block that starts
 * at x. */
enum dalcs_status dalcs_columns_alloc(struct dalcs_columns *a, int n,
                                      size_t n_entries) DALCS_MUST_CHECK;

void dalcs_columns_finish(struct dalcs_columns *a);

/* Analyses that are there, and the place for others. */
struct dalcs_lu_patterns *dalcs_modes_patterns(struct dalcs_osnsp *p);

/* Factors of a small matrix by columns of which little will be asked. DALCS_SINGULAR: it is not small, or more has to be
 * known of it than plain elimination tells. */
enum dalcs_status dalcs_modes_factor_small(const struct dalcs_osnsp *p, struct dalcs_lu *lu,
                                           const struct dalcs_columns *a,
                                           double apart) DALCS_MUST_CHECK;

/* ---- smooth.c ------------------------------------------------------------------------------ */

enum dalcs_status dalcs_osnsp_smooth_setup(struct dalcs_osnsp *p) DALCS_MUST_CHECK;
void dalcs_osnsp_smooth_finish(const struct dalcs_osnsp *p);

/* As dalcs_osnsp_solve(), where `solve` does with given sources. */
typedef enum dalcs_status given_solve(struct dalcs_osnsp *p, double sigma, const double *u,
                                      double *y);
enum dalcs_status dalcs_osnsp_solve_smooth(struct dalcs_osnsp *p, double sigma, const double *u,
                                           double *y, given_solve *solve) DALCS_MUST_CHECK;

/* ---- certificate.c ------------------------------------------------------------------------- */

/* Recovers x+ in y from z+ and lambda+, evaluates every row of the system and every pair, fills p->w,
 * p->certificate (equations and complementarity) and the list of pairs with a wrong sign. The
 * reference of a floating island that has to carry current makes *sources_clash true. */
void dalcs_certificate_evaluate(struct dalcs_osnsp *p, const double *u, double *y,
                                bool *sources_clash);

/* The same of an answer that was solved for its states as well, which recovering them would undo. */
void dalcs_certificate_evaluate_with_states(struct dalcs_osnsp *p, const double *u, double *y,
                                            bool *sources_clash);

/* With its states, or, where they do not hold, with those that its other values give. */
void dalcs_certificate_evaluate_either(struct dalcs_osnsp *p, const double *u, double *y,
                                       bool *sources_clash);

/* Was the answer evaluated last one? */
static inline bool dalcs_certificate_holds(const struct dalcs_osnsp *p, bool sources_clash) {
    return p->signs.n_violating == 0 && !sources_clash &&
           p->certificate.worst <= p->options.certificate_tolerance;
}

/* Do all pairs hold in an answer that was accepted, where these inputs u drive the circuit? */
bool dalcs_certificate_pairs_hold(struct dalcs_osnsp *p, const double *u, const double *y);

/* The same of the equations alone, within what is_answer() of osnsp.c allows: a sign that is more wrong hides them. */
bool dalcs_certificate_equations_hold(struct dalcs_osnsp *p, const double *u, double *y);

/* Of the answer evaluated last: is each wrong sign of a diode rounding beside what is next to that very diode?
 * The certificate measures it by the largest voltage and current anywhere, beside which a true one may be small. */
bool dalcs_certificate_signs_hold(const struct dalcs_osnsp *p, const double *u, const double *y);

/* ---- proximal.c ---------------------------------------------------------------------------- */

enum dalcs_status dalcs_proximal_solve(struct dalcs_osnsp *p, const double *u,
                                       double *y) DALCS_MUST_CHECK;

/* p->work.right = R u, and the centre is that of diodes without current and without voltage, which are as far from
 * their knees as these from 0. */
void dalcs_proximal_begin(struct dalcs_osnsp *p, const double *u);

/* Factors the regularised matrix of p->mode; the columns are all n + n_pairs. */
enum dalcs_status dalcs_proximal_factor(struct dalcs_osnsp *p,
                                        struct dalcs_mode_entry *entry) DALCS_MUST_CHECK;

/* The same from p->mode on by block pivoting over regularised modes. */
enum dalcs_status dalcs_proximal_pivot(struct dalcs_osnsp *p, const double *u,
                                       bool *mode_changed) DALCS_MUST_CHECK;

/* Of these weights: eps/G of a closed pair and eps G of an open one, and of an unknown, in
 * balanced units. */
void dalcs_proximal_weights(const struct dalcs_osnsp *p, int pair, double *on, double *off);
double dalcs_proximal_unknown_weight(const struct dalcs_osnsp *p);

/* 1/G of a pair with these weights, ohm: what eps is times of where it is closed. */
double dalcs_proximal_resistance(const struct dalcs_osnsp *p, int pair);

/* w of a pair in balanced units, from p->work.scaled and p->work.right. */
double dalcs_proximal_scaled_w(const struct dalcs_osnsp *p, int pair);

/* The least push of a centre, in balanced units, that a sign tells beside the largest unknown of p->work.scaled. */
double dalcs_proximal_least_push(const struct dalcs_osnsp *p);

/* ---- interior.c ---------------------------------------------------------------------------- */

/* The same as dalcs_scattering_mode of monotone systems, in sparse factors and for any number of pairs, but near the
 * mode rather than it. DALCS_SINGULAR: a factorisation failed, the mode is as it was. */
enum dalcs_status dalcs_interior_mode(struct dalcs_osnsp *p) DALCS_MUST_CHECK;

/* ---- scattering.c -------------------------------------------------------------------------- */

/* p->mode becomes that of the regularised problem around (centre, centre_w), with eps in the place of the proximal weight:
 * all diodes are decided at once, from no mode in particular. DALCS_NOT_CONVERGED: one where the search ended;
 * DALCS_SINGULAR: there was none, or there are too many pairs, and the mode is as it was. */
enum dalcs_status dalcs_scattering_mode(struct dalcs_osnsp *p, const double *u,
                                        double eps) DALCS_MUST_CHECK;

/* Any answer, not the one of least norm, where pivoting ends without one: from the mode that Lemke's method finds with
 * weights that are no more than rounding. */
enum dalcs_status dalcs_scattering_solve(struct dalcs_osnsp *p, const double *u,
                                         double *y) DALCS_MUST_CHECK;

/* ---- enumerate.c --------------------------------------------------------------------------- */

/* Every mode of a small system's diodes. DALCS_INFEASIBLE: none fits; DALCS_NOT_CONVERGED: there are too many. */
enum dalcs_status dalcs_enumerate(struct dalcs_osnsp *p, const double *u,
                                  double *y) DALCS_MUST_CHECK;

/* ---- open_mode.c --------------------------------------------------------------------------- */

/* From y, the answer of p->mode that was evaluated last: where the mode is singular, that of least norm. DALCS_OK:
 * certified; DALCS_NOT_CONVERGED: no answer of the mode has the right signs. */
enum dalcs_status dalcs_open_mode_solve(struct dalcs_osnsp *p, const double *u,
                                        double *y) DALCS_MUST_CHECK;

/* ---- exact.c ------------------------------------------------------------------------------- */

/* Solves and evaluates in the mode of `whole`. */
enum dalcs_status dalcs_exact_evaluate(struct dalcs_osnsp *p, struct dalcs_whole *whole,
                                       const double *u, double *y,
                                       bool *sources_clash) DALCS_MUST_CHECK;

/* In p->mode, singular or not, evaluated. DALCS_SINGULAR: it leaves too much open. */
enum dalcs_status dalcs_exact_try_mode(struct dalcs_osnsp *p, const double *u, double *y,
                                       bool *sources_clash) DALCS_MUST_CHECK;

/* The same on the equations as they stand, with states that are not recovered from voltages: whatever the signs are. */
enum dalcs_status dalcs_exact_keep_states(struct dalcs_osnsp *p, const double *u, double *y,
                                          bool *sources_clash) DALCS_MUST_CHECK;

/* From p->mode on by block principal pivoting, at most `limit` changes, each mode answered with all the
 * digits that it has and, where it is singular, with the least norm. DALCS_OK: certified; DALCS_SINGULAR: a mode leaves
 * too much open. */
enum dalcs_status dalcs_exact_pivot(struct dalcs_osnsp *p, const double *u, double *y,
                                    int limit) DALCS_MUST_CHECK;

/* Of the mode where a regularised problem ends, without weights: in a singular one the answer of least norm that has the
 * right signs, which is what the iterates converge to; in a regular one, or one at most `limit` changes away, the only one. */
enum dalcs_status dalcs_exact_least_norm(struct dalcs_osnsp *p, const double *u, double *y,
                                         int limit) DALCS_MUST_CHECK;

/* ---- choices.c ----------------------------------------------------------------------------- */

/* Vectors that are open, in `choice`, become the equations that choose among them. error[n_columns]: how far off an entry of
 * any of them may be. */
enum dalcs_status dalcs_choices_make(struct dalcs_whole *whole,
                                     const double *error) DALCS_MUST_CHECK;

/* ---- ties.c -------------------------------------------------------------------------------- */

/* Makes a certified answer y of a regular mode with ties the least-norm one if there are several. */
enum dalcs_status dalcs_ties_settle(struct dalcs_osnsp *p, const double *u,
                                    double *y) DALCS_MUST_CHECK;

/* Names the set of tied pairs, never 0. */
uint64_t dalcs_ties_name(const struct dalcs_osnsp *p);

/* ---- basis.c ------------------------------------------------------------------------------- */

/* The certified answer y of a singular mode, with ties, in a regular mode that it belongs to, if there is one. */
enum dalcs_status dalcs_basis_prefer(struct dalcs_osnsp *p, const double *u,
                                     double *y) DALCS_MUST_CHECK;

/* ---- step_map.c ---------------------------------------------------------------------------- */

bool dalcs_step_map_pays(const struct dalcs_osnsp *p);

enum dalcs_status dalcs_step_map_build(struct dalcs_osnsp *p,
                                       struct dalcs_mode_entry *entry) DALCS_MUST_CHECK;

/* y's z and lambda from u. */
void dalcs_step_map_apply(const struct dalcs_osnsp *p, const struct dalcs_mode_entry *entry,
                          const double *u, double *y);

/* ---- witness.c ----------------------------------------------------------------------------- */

/* Names an element, once. */
void dalcs_witness_add(struct dalcs_witness *w, const char *name);

/* Is the displacement p->work.step_now of the proximal iteration a ray? Then p->witness names it. */
bool dalcs_witness_from_ray(struct dalcs_osnsp *p);

/* The current sources that feed a floating island. */
void dalcs_witness_from_clash(struct dalcs_osnsp *p);

/* Every pair of a system that no mode fits. */
void dalcs_witness_from_modes(struct dalcs_osnsp *p);

/* The weight of an equation in the witness's ray: of the column that it is paired with; where a row sums the KCL of a
 * tree of capacitors, others of the tree are relative to its root. */
double dalcs_witness_weight(const struct dalcs_witness *w, const struct dalcs_system *s, int row);

/* Of weights v[dalcs_claim_n_rows()] that refute a passive problem (farkas.h): they are a ray. */
void dalcs_witness_from_passive_weights(struct dalcs_osnsp *p, const double *v);

/* Of a problem of which several cases are refuted, into p->weighed: its pairs. */
void dalcs_witness_from_cases(struct dalcs_osnsp *p);

/* What it names becomes what p->witness names; the ray is not copied. */
void dalcs_witness_copy(struct dalcs_osnsp *p, const struct dalcs_witness *from);

/* Names something where the others found no name. */
void dalcs_witness_complete(struct dalcs_osnsp *p);

/* ---- witness_weights.c --------------------------------------------------------------------- */

/* p->weighed, of weights v[dalcs_claim_n_rows()] that refute a problem: whose equations and signs they are. */
void dalcs_witness_from_weights(struct dalcs_osnsp *p, const double *v);

/* ---- osnsp.c ------------------------------------------------------------------------------- */

/* Solves and evaluates in p->mode. DALCS_SINGULAR: the mode is so and has not been answered yet. */
enum dalcs_status dalcs_osnsp_try_mode(struct dalcs_osnsp *p, const double *u, double *y,
                                       bool *sources_clash) DALCS_MUST_CHECK;

static inline void dalcs_osnsp_flip(struct dalcs_osnsp *p, int pair) {
    p->mode[pair / 64] ^= (uint64_t)1 << (pair % 64);
}

/* What has a wrong sign changes sides: all of it, or the largest index alone (Murty; the list ascends). */
static inline void dalcs_osnsp_flip_violating(struct dalcs_osnsp *p, bool all) {
    for (int k = all ? 0 : p->signs.n_violating - 1; k < p->signs.n_violating; k++) {
        dalcs_osnsp_flip(p, p->signs.violating[k]);
    }
}

/* Is p->mode one that single pivots have passed, of which `n_single` is the next? What they do depends on the mode
 * alone, so that they would pass it for ever. Compared with the mode of the last power of 2 (R. P. Brent, BIT 20, 1980),
 * which meets a round of any length. */
static inline bool dalcs_osnsp_goes_round(struct dalcs_osnsp *p, int n_single) {
    size_t bytes = (size_t)p->n_words * sizeof(*p->mode);
    bool is_met = n_single > 1 && memcmp(p->mode, p->work.met_mode, bytes) == 0;
    if ((n_single & (n_single - 1)) == 0) {
        memcpy(p->work.met_mode, p->mode, bytes);
    }
    return is_met;
}

/* Of one block pivoting. */
struct dalcs_pivoting {
    int fewest; /* wrong signs so far */
    int patience, n_single;
};

/* Rounds without fewer wrong signs before pivots become single (Judice and Pires 1994). */
enum { DALCS_PATIENCE = 10 };

static inline struct dalcs_pivoting dalcs_pivoting_begin(const struct dalcs_osnsp *p) {
    return (struct dalcs_pivoting){.fewest = p->system->n_pairs + 1, .patience = DALCS_PATIENCE};
}

/* Counts one change of the mode. true: it is to be a single one. */
static inline bool dalcs_pivoting_stalls(struct dalcs_osnsp *p, struct dalcs_pivoting *pivoting) {
    p->counters.pivots++;
    if (p->signs.n_violating < pivoting->fewest) {
        *pivoting =
            (struct dalcs_pivoting){.fewest = p->signs.n_violating, .patience = DALCS_PATIENCE};
    } else {
        pivoting->patience--;
    }
    return pivoting->patience <= 0;
}

/* p->work.scaled to y's z and lambda. */
void dalcs_osnsp_unscale(const struct dalcs_osnsp *p, double *y);

/* p->work.scaled from y: the inverse, exact because scales are powers of 2. */
void dalcs_osnsp_scale(struct dalcs_osnsp *p, const double *y);

#endif

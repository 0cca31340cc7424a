/* osnsp.h - the one-step nonsmooth problem of one system: solve it, prove it, remember it.
 *
 * Given sigma = 1/h, the state x_k and the inputs s(t_{k+1}), find (x+, z+, lambda+) and w with
 *     sigma P (x+ - x_k) = A_I (x+, z+, lambda+) + E_I s,   0 = A_II (x+, z+, lambda+) + E_II s,
 *     0 <= lambda+ _|_ w >= 0            (Brogliato 2022, eq. (3.1), sources at t_{k+1}).
 *
 * In a mode (the set of pairs with w = 0, the others have lambda = 0) this is one linear system. It
 * is solved in the last mode; where signs are wrong, block principal pivoting (Judice and Pires
 * 1994) with a least-index fallback (Murty 1974) changes the mode. Each (mode, sigma) keeps its
 * factors in a bounded cache. A singular mode is found with small weights, which make the problem one of
 * exactly one solution, and answered without them: what it leaves open has the least norm. Whatever the
 * way, an answer is accepted only with a certificate recomputed from the system's own matrices. */
#ifndef DALCS_OSNSP_H
#define DALCS_OSNSP_H

#include "lu_patterns.h"
#include "partition.h"
#include "step_form.h"

#include <stdatomic.h>
#include <stdint.h>

struct dalcs_osnsp_options {
    double certificate_tolerance; /* accepted residual over its physical scale */
    double proximal_weight;       /* eps of regularised problems */
    double rcond_min;             /* below this a balanced mode matrix counts as singular */
    int max_outer;                /* proximal iterations */
    int max_pivots;               /* mode changes per solve, on top of twice the number of pairs */
    size_t cache_bytes;           /* factors and maps kept */
    int dense_limit;              /* unknowns up to which recurring modes use a dense map */
    struct dalcs_lu_patterns
        *patterns; /* of modes, which outlive the problem; NULL: it has its own */
    const atomic_bool
        *is_cancelled; /* from then on problems end with DALCS_E_CANCELLED; NULL: never */
};

/* Those of a run. */
struct dalcs_osnsp_options dalcs_osnsp_options_of(const struct dalcs_run_options *run);

struct dalcs_osnsp_counters {
    long solved, pivots, factorizations, cache_hits, singular;
    long enumerated; /* unknowns of all modes that were tried one after the other (enumerate.c) */
};

/* How good an answer is. */
struct dalcs_certificate {
    double worst; /* largest residual over its physical scale: KCL, branch equations, signs and
                     complementarity */
    int where;    /* row of the system; n_equations + d for pair d; -1: none */
    double volt, ampere; /* the physical scale: the largest of the answer and of what drives it */
};

/* Why there is no answer: a direction along which nothing resists and sources push, reduced to
 * elements (Farkas' alternative; Heemels, Schumacher and Weiland 1999, sec. 6). */
struct dalcs_witness {
    enum dalcs_witness_kind {
        DALCS_WITNESS_LOOP,      /* currents around voltage sources, diodes, closed switches */
        DALCS_WITNESS_CUTSET,    /* voltages across current sources, diodes, open switches */
        DALCS_WITNESS_MODE,      /* no mode of a system that is not passive fits */
        DALCS_WITNESS_EQUATIONS, /* weights of these equations and signs refute them, not passive */
        DALCS_WITNESS_DERIVATIVE /* the states would need more than an impulse to jump */
    } kind;

    int n_elements, capacity;
    const char **element; /* borrowed names */
    bool has_ray;
    double *ray; /* [n_columns] the direction */
};

struct dalcs_mode_entry;
struct dalcs_ordered_blocks;
struct dalcs_smooth_newton;

/* Step sizes remembered, at most: those of which somebody goes through all again and again, in one order, have to stay all at
 * once. Slides do so (slide_try.c). */
enum { DALCS_MOST_FORMS = 128 };

/* Condensed forms by sigma, and factors by (mode, sigma). */
struct dalcs_mode_cache {
    klu_common klu;
    struct dalcs_lu_patterns patterns; /* of modes, where the options have none */
    struct dalcs_step_form **form;     /* most recently used first */
    int n_forms;
    uint32_t *form_id; /* [n_forms] */
    uint32_t next_form_id;
    struct dalcs_mode_entry *entries; /* uthash */
    struct dalcs_mode_entry *newest, *oldest;
    size_t entry_bytes, form_bytes;
    int *
        matched_row; /* [n_matched] of the columns (equations, pairs) in the large modes so far, or -1;
                         NULL without any */
    int n_matched;
};

/* What is listed of the system once. */
struct dalcs_osnsp_lists {
    int *column_rows_p,
        *column_rows; /* rows of A that hold a current or lambda; none of other columns */
    int n_references; /* columns that must vanish, and their rows */
    int *reference, *reference_row;
    int n_runs; /* columns of one unit side by side */

    struct dalcs_unit_run {
        int begin, end;
        bool is_current;
    } * run;

    int n_drives;

    struct dalcs_drive { /* a source or a diode's threshold, part of the physical scale */
        int input;       /* in u */
        bool is_current;
        double coefficient;
    } * drive;

    bool *is_diode; /* [n_pairs] */
    int *w_ends;    /* [n_pairs][2] columns whose difference is w; -1 where w is more than that */
};

/* Of the answer that was evaluated last. */
struct dalcs_osnsp_signs {
    int *violating; /* [n_pairs] */
    int n_violating;
    bool *tied; /* [n_pairs] diodes with lambda = 0 = w, up to rounding */
    int n_tied;
};

/* How answers are looked for; all but the first are set by the caller. */
struct dalcs_osnsp_asks {
    bool insists; /* modes of small pivots are tried, too: nothing else has found an answer */
    long most_enumerated; /* unknowns of modes that may be tried one after the other; 0: of all */
    bool
        refines; /* each answer of a regular mode is refined once, for small currents next to large ones, which the
                     certificate does not bound */
    bool
        is_passing; /* forms and modes serve a problem or two, so that small ones are factored in the least time; steps
                        of implicit Euler go on with the digits of KLU's order */
    bool
        keeps_states; /* states that more than voltages of nodes gives are as in the answer, not recovered */
};

/* smooth.c */
struct dalcs_osnsp_smooth {
    struct dalcs_smooth_newton *newton; /* NULL: the system has no smooth sources */
    double *given;                      /* [n_x + n_inputs] inputs with their values */
    double *other;                      /* [n_columns] an answer beside another */
    int n_tangents;                     /* times that their lines in the equations were changed */
    long may_enumerate; /* up to which counters.enumerated may grow in this problem */
    long answered_at;   /* counters.enumerated behind the last problem that had an answer */
    double largest[2];  /* V, A: of all answers so far, but of parts of formulas */
    double *reached;    /* [n_smooth] values that agreed last on the way to an operating point */
    double (*reached_x)[2]; /* [n_smooth] ... and arguments */
    uint64_t *mode;         /* [n_words] in which the slopes are */
};

/* latches.c: jumps of formulas */
struct dalcs_osnsp_latches {
    int n;
    int *jump;        /* [n] first pairs of them */
    uint64_t *before; /* [n_words] the mode before a problem */
    uint64_t *last;   /* [n_words] that of the last answer */
    uint64_t
        *mode; /* [n_words] with kept_y, w and tied: of an answer that others are tried beside */
    double *kept_y, *w; /* [n_columns], [n_pairs] */
    bool *tied;         /* [n_pairs] */
    double *y;          /* [n_columns] of these others */
    uint64_t *met;      /* [n_words] one of their modes */
    bool
        is_known; /* the last mode in which none of those between their sides holds itself is in `rests` */
    uint64_t *rests;   /* [n_words] */
    double sigma;      /* and its step */
    int n_led;         /* of them in `rests`: they are led (latch_led.c) */
    int n_leading;     /* ... and lead, whether others are led or not */
    bool are_compared; /* that is known */
    bool are_read;     /* what reads these stands otherwise on their two sides (led_readers.c) */

    enum dalcs_latch_role {
        DALCS_LATCH_FREE,
        DALCS_LATCH_LEADS,
        DALCS_LATCH_LEADS_AGAINST, /* it is above where those that lead are below */
        DALCS_LATCH_LED
    } *
        role; /* [n] there */
};

/* What has no meaning between two problems. */
struct dalcs_osnsp_work {
    double *difference;  /* [n_x + n_columns + n_inputs] (sigma (x+ - x_k), y, s) being checked */
    uint64_t *tied_mode; /* [n_words] */
    double *tied_answer; /* [n_columns] */
    double *mapped;      /* [n + n_pairs, padded to 8] what a map gave */
    double *right;       /* [n + n_pairs] scaled R u */
    double *scaled;      /* [n + n_pairs] scaled y */
    double *rhs;         /* [n + n_pairs] in mode order */
    double *residual;    /* [n + n_pairs] of the condensed rows, scaled */
    double *centre;      /* [n + n_pairs] proximal centre, scaled */
    double *centre_w;    /* [n_pairs] */
    double *step_before, *step_now; /* [n + 2 n_pairs] displacements of the proximal iteration */
    uint64_t *key;                  /* [n_words + 1] */
    uint64_t *regularised_mode;     /* [n_words] where the proximal method stands */
    uint64_t *met_mode;             /* [n_words] one that single pivots passed */
    int *row, *row_seen; /* [n_x + n_z] rows of a search, and in which search they were seen */
    int searches;
};

struct dalcs_osnsp {
    const struct dalcs_system *system;
    struct dalcs_osnsp_options options;
    struct dalcs_partition partition;
    struct dalcs_ordered_blocks
        *blocks; /* of this partition; NULL: not asked for yet, or there is one block */
    struct dalcs_osnsp_smooth smooth;
    struct dalcs_osnsp_latches latches;
    int n_words;
    uint64_t *mode; /* [n_words] bit d: w_d = 0 */
    double *w;      /* [n_pairs] of the last answer */
    struct dalcs_certificate certificate;
    struct dalcs_osnsp_counters counters;
    struct dalcs_witness witness;
    struct dalcs_witness
        weighed;     /* of a system that is not passive: by verified weights, 0 names without any */
    bool least_norm; /* the last answer is the least-norm one of several */

    struct dalcs_osnsp_asks asks;
    struct dalcs_osnsp_signs signs;
    struct dalcs_mode_cache cache;
    struct dalcs_osnsp_lists lists;
    struct dalcs_osnsp_work work;
    struct dalcs_arena arena; /* what has the same size during the run */
};

/* Allocates everything; the system must outlive it. On failure *p is zeroed. */
enum dalcs_status dalcs_osnsp_setup(struct dalcs_osnsp *p, const struct dalcs_system *system,
                                    const struct dalcs_osnsp_options *options) DALCS_MUST_CHECK;

static inline bool dalcs_osnsp_is_cancelled(const struct dalcs_osnsp *p) {
    return p->options.is_cancelled != NULL && atomic_load(p->options.is_cancelled);
}

/* Solves at sigma (1/s; 0: operating point). u[n_x + n_inputs] = (x_k, s), in which those of smooth sources have no
 * meaning: Newton's method finds them, from the last ones on. On DALCS_OK y[n_columns] =
 * (x+, z+, lambda+), with p->w, p->mode and p->certificate. DALCS_INFEASIBLE: see p->witness.
 * DALCS_NOT_CONVERGED: nothing could be certified. Switches are commanded: their bits in p->mode are
 * input. Allocates only for a (mode, sigma) not in the cache. */
enum dalcs_status dalcs_osnsp_solve(struct dalcs_osnsp *p, double sigma, const double *u,
                                    double *y) DALCS_MUST_CHECK;

/* The answer in p->mode behind such a call, whatever the signs of pairs are; p->signs has those that are wrong. Not
 * DALCS_OK: the mode has none, or none was found in it for smooth sources. */
enum dalcs_status dalcs_osnsp_answer(struct dalcs_osnsp *p, const double *u,
                                     double *y) DALCS_MUST_CHECK;

/* Behind dalcs_osnsp_solve() at sigma: are jumps between their sides led, so that the answer is none of comparators that have a
 * small delay? */
bool dalcs_osnsp_has_led(const struct dalcs_osnsp *p);

/* Are there jumps between their sides that others might follow? */
bool dalcs_osnsp_has_leading(const struct dalcs_osnsp *p);

static inline bool dalcs_latch_leads(enum dalcs_latch_role role) {
    return role == DALCS_LATCH_LEADS || role == DALCS_LATCH_LEADS_AGAINST;
}

/* Then: the answer where those that lead are on the sides that p->mode has them on, and those that are led go where it has them.
 * *found: there is one. */
enum dalcs_status dalcs_osnsp_answer_led(struct dalcs_osnsp *p, double sigma, const double *u,
                                         double *y, bool *found) DALCS_MUST_CHECK;

/* The lines of smooth sources become those of their tangents at the arguments that newton->x holds, where one differs by
 * a factor beyond ten from what it is, or where rounding of a line hides a function that is something beside the largest
 * of y[n_columns] (NULL: not looked at). Then all that was factored is forgotten. */
bool dalcs_osnsp_retangent(struct dalcs_osnsp *p, const double *y);

/* After an answer y to u that may be one of several: p->signs.tied becomes all diodes whose current and
 * voltage no more than rounding tells from 0, and scale the size of what rounding is measured by (V, A).
 * The certificate is stricter: it asks by how much a pivot's sign may be wrong. */
void dalcs_osnsp_find_ties(struct dalcs_osnsp *p, const double *u, const double *y,
                           double scale[2]);

/* Lists different answers at sigma, one for each regular mode that has one, without what regular modes
 * share: answer[most][n_columns], *n of them. Switches stay as commanded. For few diodes: every mode is
 * factored. p->mode stays; p->w and the certificate are those of the last mode tried. */
enum dalcs_status dalcs_osnsp_list_answers(struct dalcs_osnsp *p, double sigma, const double *u,
                                           int most, double *answer, int *n) DALCS_MUST_CHECK;

/* Is each part of the problem monotone that is not given by what acts on it? Then it is solvable iff feasible. */
static inline bool dalcs_osnsp_is_monotone(const struct dalcs_osnsp *p) {
    return p->partition.all_monotone;
}

/* Does this element read a quantity that depends on what it does? */
bool dalcs_osnsp_acts_on_what_it_reads(const struct dalcs_osnsp *p, const char *element);

/* Is it known of the circuit that no answer of it is one of several, whatever is tied? */
static inline bool dalcs_osnsp_is_unique(const struct dalcs_osnsp *p) {
    return p->cache.n_forms > 0 && p->cache.form[0]->answers == DALCS_UNIQUE;
}

/* May the last answer be one of several? Costs nothing where it is not. */
static inline bool dalcs_osnsp_is_open(const struct dalcs_osnsp *p) {
    return p->least_norm || (p->signs.n_tied > 0 && !dalcs_osnsp_is_unique(p));
}

static inline bool dalcs_osnsp_is_on(const struct dalcs_osnsp *p, int pair) {
    return dalcs_mode_has(p->mode, pair);
}

static inline void dalcs_osnsp_command(struct dalcs_osnsp *p, int pair, bool on) {
    uint64_t bit = (uint64_t)1 << (pair % 64);
    p->mode[pair / 64] = on ? p->mode[pair / 64] | bit : p->mode[pair / 64] & ~bit;
}

/* p->witness becomes the states that run away the farther the shorter a step from x[n_x] is, as y1 and
 * y2[n_columns] show. */
void dalcs_osnsp_blame_states(struct dalcs_osnsp *p, const double *x, const double *y1,
                              const double *y2);

/* After DALCS_INFEASIBLE: what these inputs[n_inputs] alone do along the witness's ray, which is 0 for inputs that may
 * have an answer; 0 where there is no ray. */
double dalcs_osnsp_along_ray(const struct dalcs_osnsp *p, const double *inputs);

void dalcs_osnsp_finish(struct dalcs_osnsp *p);

#endif

/* proximal.c - the mode of the least-norm answer by proximal points (Rockafellar 1976) of the monotone
 * mixed LCP: each problem adds small weights around the last answer,
 *     closed pair:  w + (eps/G) (lambda - lambda') = 0      (a series resistance with memory)
 *     open pair:    lambda + (eps G) (w - w') = 0           (a leak with memory)
 *     unknown z_i:  + mu eps (z_i - z_i')                   on the balanced diagonal,
 * has exactly one solution with a nonsingular matrix, and the iterates converge to a solution of the
 * problem itself: the weights vanish with the differences. From diodes without current and without
 * voltage that is, as eps -> 0, the least-norm one, the limit of equal small r_on and g_off: the mode that the
 * weights lead to is answered without them (exact.c). If there is no solution, the differences
 * converge to a ray that says why (Pazy 1971): see witness.c. */
#include "osnsp_internal.h"

#include "magnitudes.h"
#include "rounding.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Mode changes allowed from a regularised answer to a regular mode's. */
enum { REGULAR_ATTEMPTS = 8 };

/* Of equal diodes, as the answer has to be the least-norm one in amperes and volts. */
static double ratio_of(const struct dalcs_osnsp *p, int pair) {
    const struct dalcs_step_form *f = p->cache.form[0];
    double g = f->scale[f->n + pair] * f->row_scale[f->n + pair]; /* A over V, balanced */
    return fmin(fmax(g / f->pair_conductance, dalcs_small), 1.0 / dalcs_small);
}

static double on_weight(const struct dalcs_osnsp *p, int pair) {
    return p->options.proximal_weight * ratio_of(p, pair);
}

static double off_weight(const struct dalcs_osnsp *p, int pair) {
    return p->options.proximal_weight / ratio_of(p, pair);
}

void dalcs_proximal_weights(const struct dalcs_osnsp *p, int pair, double *on, double *off) {
    *on = on_weight(p, pair);
    *off = off_weight(p, pair);
}

/* Unknowns are held far more weakly than pairs, so that diodes decide what is not determined. */
double dalcs_proximal_unknown_weight(const struct dalcs_osnsp *p) {
    return dalcs_small * p->options.proximal_weight;
}

double dalcs_proximal_resistance(const struct dalcs_osnsp *p, int pair) {
    const struct dalcs_step_form *f = p->cache.form[0];
    return ratio_of(p, pair) / (f->scale[f->n + pair] * f->row_scale[f->n + pair]);
}

double dalcs_proximal_scaled_w(const struct dalcs_osnsp *p, int pair) {
    const struct dalcs_step_form *f = p->cache.form[0];
    double w = -p->work.right[f->n + pair];
    for (int k = f->W.p[pair]; k < f->W.p[pair + 1]; k++) {
        w += f->W.x[k] * p->work.scaled[f->W.j[k]];
    }
    return w;
}

enum dalcs_status dalcs_proximal_factor(struct dalcs_osnsp *p, struct dalcs_mode_entry *entry) {
    const struct dalcs_step_form *f = p->cache.form[0];
    int n = f->n + f->n_pairs;
    struct dalcs_columns a;
    DALCS_TRY(dalcs_columns_alloc(&a, n, (size_t)f->K.p[n] + (size_t)n));
    int out = 0;
    for (int c = 0; c < n; c++) {
        double diagonal = dalcs_proximal_unknown_weight(p);
        if (c >= f->n) {
            int d = c - f->n;
            diagonal = dalcs_osnsp_is_on(p, d) ? on_weight(p, d) : 1.0;
        }
        bool seen = false;
        for (int k = f->K.p[c]; k < f->K.p[c + 1]; k++) {
            int r = f->K.j[k];
            double value = f->K.x[k];
            if (r >= f->n && !dalcs_osnsp_is_on(p, r - f->n)) {
                value *= off_weight(p, r - f->n);
            }
            seen = seen || r == c;
            a.i[out] = r;
            a.x[out++] = r == c ? value + diagonal : value;
        }
        if (!seen) {
            a.i[out] = c;
            a.x[out++] = diagonal;
        }
        a.p[c + 1] = out;
    }
    /* The weights make it nonsingular; only an exact zero pivot is refused. */
    enum dalcs_status status = dalcs_modes_factor_small(p, &entry->lu, &a, 0.0);
    if (status > DALCS_OK) {
        dalcs_lu_keep_diagonal(&p->cache.klu, true);
        status = dalcs_lu_factor_again(&entry->lu, dalcs_modes_patterns(p), &p->cache.klu, &a, 0.0);
        dalcs_lu_keep_diagonal(&p->cache.klu, false);
    }
    dalcs_columns_finish(&a);
    return status;
}

/* Solves one regularised problem around (centre, centre_w) in the mode of entry, into p->work.scaled. */
static void step_in_mode(struct dalcs_osnsp *p, const struct dalcs_mode_entry *entry) {
    const struct dalcs_step_form *f = p->cache.form[0];
    for (int i = 0; i < f->n; i++) {
        p->work.scaled[i] = p->work.right[i] + dalcs_proximal_unknown_weight(p) * p->work.centre[i];
    }
    for (int d = 0; d < f->n_pairs; d++) {
        double right = p->work.right[f->n + d];
        p->work.scaled[f->n + d] = dalcs_osnsp_is_on(p, d)
                                       ? right + on_weight(p, d) * p->work.centre[f->n + d]
                                       : off_weight(p, d) * (right + p->work.centre_w[d]);
    }
    dalcs_lu_solve(&entry->lu, p->work.scaled);
}

static double largest_unknown(const struct dalcs_osnsp *p) {
    const struct dalcs_step_form *f = p->cache.form[0];
    double largest = 0.0;
    for (int i = 0; i < f->n + f->n_pairs; i++) {
        largest = fmax(largest, fabs(p->work.scaled[i]));
    }
    return largest;
}

/* What moves a centre is seen to do so beyond the tolerance of signs. */
double dalcs_proximal_least_push(const struct dalcs_osnsp *p) {
    return dalcs_beyond * dalcs_answer_rounded * largest_unknown(p) / p->options.proximal_weight;
}

/* The pairs whose regularised sign is wrong: closed with lambda + eps G (w - w') < 0, open with
 * w + eps/G (lambda - lambda') < 0. */
static void find_violations(struct dalcs_osnsp *p) {
    const struct dalcs_step_form *f = p->cache.form[0];
    double largest = largest_unknown(p);
    p->signs.n_violating = 0;
    for (int d = 0; d < f->n_pairs; d++) {
        if (!p->lists.is_diode[d]) {
            continue;
        }
        double w = dalcs_proximal_scaled_w(p, d);
        double lambda = p->work.scaled[f->n + d];
        double sign = dalcs_osnsp_is_on(p, d)
                          ? lambda + off_weight(p, d) * (w - p->work.centre_w[d])
                          : w + on_weight(p, d) * (lambda - p->work.centre[f->n + d]);
        if (sign < -dalcs_answer_rounded * largest) {
            p->signs.violating[p->signs.n_violating++] = d;
        }
    }
}

/* Block pivoting of one regularised problem from p->mode; single pivots where that gets nowhere, if
 * it may. *stalled: it got nowhere, and may not. */
static enum dalcs_status pivot(struct dalcs_osnsp *p, bool singly, bool *mode_changed,
                               bool *stalled) {
    struct dalcs_pivoting pivoting = dalcs_pivoting_begin(p);
    int limit = p->options.max_pivots + 2 * p->system->n_pairs;
    *stalled = false;
    for (int round = 0; round <= limit; round++) {
        struct dalcs_mode_entry *e;
        DALCS_TRY(dalcs_modes_get(p, DALCS_WEIGHTED, &e));
        if (e->singular) {
            return DALCS_NOT_CONVERGED;
        }
        step_in_mode(p, e);
        find_violations(p);
        if (p->signs.n_violating == 0) {
            return DALCS_OK;
        }
        *mode_changed = true;
        bool stalls = dalcs_pivoting_stalls(p, &pivoting);
        if (stalls && !singly) {
            *stalled = true;
            return DALCS_OK;
        }
        if (stalls && dalcs_osnsp_goes_round(p, ++pivoting.n_single)) {
            break;
        }
        dalcs_osnsp_flip_violating(p, !stalls);
    }
    return DALCS_NOT_CONVERGED;
}

/* One regularised problem around the centre, from p->mode. Its matrix is a P-matrix when the system is
 * monotone: it has one solution, and the least-index fallback ends it. Before that, where block
 * pivoting stalls, Lemke's method finds its mode, of many pairs an interior-point method. */
enum dalcs_status dalcs_proximal_pivot(struct dalcs_osnsp *p, const double *u, bool *mode_changed) {
    bool stalled;
    *mode_changed = false;
    DALCS_TRY(pivot(p, !p->system->monotone, mode_changed, &stalled));
    if (!stalled) {
        return DALCS_OK;
    }
    enum dalcs_status status = dalcs_scattering_mode(p, u, p->options.proximal_weight);
    if (status == DALCS_SINGULAR) {
        status = dalcs_interior_mode(p);
    }
    return status < DALCS_OK ? status : pivot(p, true, mode_changed, &stalled);
}

/* Moves the centre to the answer; returns the size of the displacement, how much it differs from the
 * one before, and the size of the centre. */
static double move_centre(struct dalcs_osnsp *p, double *change, double *way) {
    const struct dalcs_step_form *f = p->cache.form[0];
    int n = f->n + f->n_pairs;
    double size = 0.0;
    double *swap = p->work.step_before;
    p->work.step_before = p->work.step_now;
    p->work.step_now = swap;
    *change = 0.0;
    *way = 0.0;
    for (int i = 0; i < n + f->n_pairs; i++) {
        double *centre = i < n ? &p->work.centre[i] : &p->work.centre_w[i - n];
        double now = i < n ? p->work.scaled[i] : dalcs_proximal_scaled_w(p, i - n);
        p->work.step_now[i] = now - *centre;
        *centre = now;
        size = fmax(size, fabs(p->work.step_now[i]));
        *way = fmax(*way, fabs(now));
        *change = fmax(*change, fabs(p->work.step_now[i] - p->work.step_before[i]));
    }
    return size;
}

/* In balanced units no regular matrix makes of what drives it more than 1/eps of it. Iterates that have run so far away
 * satisfy all equations to rounding, which hides what drives them. */
static bool is_driven(const struct dalcs_osnsp *p) {
    const struct dalcs_step_form *f = p->cache.form[0];
    double drive = 0.0;
    for (int i = 0; i < f->n + f->n_pairs; i++) {
        drive = fmax(drive, fabs(p->work.right[i]));
    }
    return drive >= DBL_EPSILON * largest_unknown(p);
}

/* Evaluates p->work.scaled as the answer y; true: it is certified. *sources_clash: a reference of a floating island would
 * have to carry current. */
static bool is_certified(struct dalcs_osnsp *p, const double *u, double *y, bool *sources_clash) {
    double *lambda = y + dalcs_system_n_equations(p->system);
    const bool counts = is_driven(p);
    dalcs_osnsp_unscale(p, y);
    for (int d = 0; d < p->system->n_pairs; d++) {
        lambda[d] = dalcs_osnsp_is_on(p, d) ? lambda[d] : 0.0;
    }
    dalcs_certificate_evaluate(p, u, y, sources_clash);
    return counts && dalcs_certificate_holds(p, *sources_clash);
}

static void restart(struct dalcs_osnsp *p) {
    const struct dalcs_step_form *f = p->cache.form[0];
    memset(p->work.centre, 0, (size_t)(f->n + f->n_pairs) * sizeof(double));
    for (int d = 0; d < f->n_pairs; d++) {
        p->work.centre_w[d] = f->row_scale[f->n + d] * dalcs_system_knee(p->system, d);
    }
    memset(p->work.step_now, 0, (size_t)(f->n + 2 * f->n_pairs) * sizeof(double));
}

void dalcs_proximal_begin(struct dalcs_osnsp *p, const double *u) {
    dalcs_csr_multiply(&p->cache.form[0]->R, u, p->work.right);
    restart(p);
}

/* A mode that leaves more open than exact.c chooses among is answered by the iterates, as is one whose digits do not
 * do for a certificate; not by those that are still running. */
enum dalcs_status dalcs_proximal_solve(struct dalcs_osnsp *p, const double *u, double *y) {
    bool is_open = false;
    dalcs_proximal_begin(p, u);
    for (int outer = 0; outer < p->options.max_outer; outer++) {
        bool mode_changed;
        DALCS_TRY(dalcs_proximal_pivot(p, u, &mode_changed));
        if (outer == 0 || mode_changed) {
            struct dalcs_mode_entry *plain;
            DALCS_TRY(dalcs_modes_get(p, DALCS_PLAIN, &plain));
            enum dalcs_status status =
                dalcs_exact_least_norm(p, u, y, plain->singular ? 0 : REGULAR_ATTEMPTS);
            if (status <= DALCS_OK) {
                return status;
            }
            is_open = status == DALCS_SINGULAR;
            dalcs_csr_multiply(&p->cache.form[0]->R, u, p->work.right);
            struct dalcs_mode_entry *e;
            DALCS_TRY(dalcs_modes_get(p, DALCS_WEIGHTED, &e));
            step_in_mode(p, e);
        }
        bool sources_clash;
        double change;
        double way;
        double size = move_centre(p, &change, &way);
        p->least_norm = true;
        if (is_certified(p, u, y, &sources_clash) && (is_open || size <= dalcs_slight * way)) {
            return DALCS_OK;
        }
        /* Displacements that hardly differ are a ray, if they are also a part of the way gone so far that only running
         * away can be. */
        if (outer >= 2 && !mode_changed && size > dalcs_slight * way &&
            change <= dalcs_small * size && dalcs_witness_from_ray(p)) {
            return DALCS_INFEASIBLE;
        }
        if (sources_clash && outer >= 2) {
            dalcs_witness_from_clash(p);
            return DALCS_INFEASIBLE;
        }
    }
    return DALCS_NOT_CONVERGED;
}

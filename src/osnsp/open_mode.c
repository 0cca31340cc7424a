/* open_mode.c - of all answers that a singular mode leaves open, the one of least norm that has the right signs.
 *
 * They are y + sum t_k n_k. With directions n_k that are orthonormal to the diodes, sum G w^2 + lambda^2 / G, it has the
 * least |t| with V t + b >= 0, where b are the signs of y, the answer of least norm of all: least distance programming,
 * which non-negative least squares decide (C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, 1974, ch. 23).
 * What the reference of an island carries must be 0 as well: a source that reads the island may drive it, by as much as
 * is open. Where the circuit is passive the proximal iterates come to it; elsewhere every mode is tried. */
#include "least_norm.h"
#include "nonnegative.h"
#include "osnsp_internal.h"
#include "rounding.h"
#include "whole.h"

#include <math.h>

struct open_mode {
    const struct dalcs_osnsp *p;
    const struct dalcs_whole *whole;
    size_t n_columns, n_pairs, n_parts; /* parts: of pairs, then of references */
    int n;                              /* directions that these see */
    double *direction;                  /* [n_choices][n_columns] */
    double *part;                       /* [n_choices][n_parts] V, by columns */
    double *size;                       /* [n_choices] V, of which their rounding is */
    double *sign;                       /* [n_parts] b */
    struct dalcs_arena arena;
};

/* lambda of closed diodes and w of open ones, of an answer or of a direction, and currents of references, in units of
 * one conductance. What no diode sees stays of least norm in the switches. */
static void look_at_parts(const struct open_mode *m, const double *y, bool is_answer,
                          double *part) {
    const struct dalcs_system *s = m->p->system;
    double root = sqrt(m->p->cache.form[0]->pair_conductance);
    for (int d = 0; d < s->n_pairs; d++) {
        double lambda = y[m->n_columns - m->n_pairs + (size_t)d];
        double w = is_answer ? m->p->w[d] : dalcs_csr_row_dot(&s->C, d, y);
        double of_diode = dalcs_osnsp_is_on(m->p, d) ? lambda / root : w * root;
        part[d] = m->p->lists.is_diode[d] ? of_diode : 0.0;
    }
    for (int k = 0; k < m->p->lists.n_references; k++) {
        part[s->n_pairs + k] = y[m->p->lists.reference[k]] / root;
    }
}

static double product(const double *a, const double *b, size_t n) {
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

static void add(double *a, double factor, const double *b, size_t n) {
    for (size_t i = 0; i < n; i++) {
        a[i] += factor * b[i];
    }
}

/* The largest element of a direction, in the same units: what its parts are known by. */
static double size_of(const struct open_mode *m, const double *direction) {
    double root = sqrt(m->p->cache.form[0]->pair_conductance);
    double largest = 0.0;
    for (size_t c = 0; c < m->n_columns; c++) {
        double size = fabs(direction[c]);
        largest = fmax(largest, m->p->system->column_is_current[c] ? size / root : size * root);
    }
    return largest;
}

/* Those that the parts see come first, orthogonal to each other and of length 1 to the parts. */
static void find_directions(struct open_mode *m) {
    struct dalcs_least_norm open = {.n = m->whole->n_choices,
                                    .n_columns = (int)m->n_columns,
                                    .n_parts = (int)m->n_parts,
                                    .vector = m->direction,
                                    .part = m->part,
                                    .size = m->size};
    for (int k = 0; k < open.n; k++) {
        double *direction = dalcs_least_norm_vector(&open, k);
        dalcs_whole_direction(m->whole, k, direction);
        look_at_parts(m, direction, false, dalcs_least_norm_part(&open, k));
        m->size[k] = size_of(m, direction);
    }
    m->n = dalcs_least_norm_separate(&open);
    for (int k = 0; k < m->n; k++) {
        double *part = dalcs_least_norm_part(&open, k);
        double norm = sqrt(product(part, part, m->n_parts));
        add(part, 1.0 / norm - 1.0, part, m->n_parts);
        add(dalcs_least_norm_vector(&open, k), 1.0 / norm - 1.0, dalcs_least_norm_vector(&open, k),
            m->n_columns);
    }
}

/* How wrong a part is: a negative sign, or any current of a reference. */
static double wrong_by(const struct open_mode *m, size_t part) {
    double sign = m->sign[part];
    return part >= m->n_pairs ? fabs(sign) : m->p->lists.is_diode[part] ? -sign : 0.0;
}

/* Least |t| with V t >= -b: of |E q - f| with E = (V'; -b') and f = (0, ..., 0, 1), q >= 0, free for what must be 0, the
 * rest r = f - E q is 0 where there is none, and else t = -r / r_last. As r is perpendicular to E q, r_last = |r|^2, but
 * for rounding, which is all that is left of r where that is not so, and where r is no more than rounding of f. The unit is
 * what is most wrong. */
static enum dalcs_status move(struct open_mode *m, double *y) {
    struct dalcs_nonnegative least;
    DALCS_TRY(dalcs_nonnegative_setup(&least, &m->arena, m->n + 1, (int)m->n_parts));
    double unit = 0.0;
    int n = 0;
    for (size_t i = 0; i < m->n_parts; i++) {
        unit = fmax(unit, wrong_by(m, i));
    }
    for (size_t i = 0; i < m->n_parts && unit > 0.0; i++) {
        if (i < m->n_pairs && !m->p->lists.is_diode[i]) {
            continue;
        }
        double *column = least.a + (size_t)n * (size_t)least.m;
        for (int k = 0; k < m->n; k++) {
            column[k] = m->part[(size_t)k * m->n_parts + i];
        }
        column[m->n] = -m->sign[i] / unit;
        least.is_free[n++] = i >= m->n_pairs;
    }
    least.b[m->n] = 1.0;
    dalcs_nonnegative_solve(&least, n);
    const double last = least.rest[m->n];
    const double square = product(least.rest, least.rest, (size_t)least.m);
    const bool is_rounding =
        !(last > 0.0 && 2.0 * square > last) || square <= dalcs_sum_rounded * dalcs_sum_rounded;
    for (int k = 0; k < m->n && !is_rounding; k++) {
        double t = -unit * least.rest[k] / last;
        add(y, t, m->direction + (size_t)k * m->n_columns, m->n_columns);
    }
    return DALCS_OK;
}

static enum dalcs_status allocate(struct open_mode *m) {
    size_t n_choices = (size_t)m->whole->n_choices;
    m->n_columns = (size_t)dalcs_system_n_columns(m->p->system);
    m->n_pairs = (size_t)m->p->system->n_pairs;
    m->n_parts = m->n_pairs + (size_t)m->p->lists.n_references;
    m->direction = dalcs_arena_alloc(&m->arena, n_choices * m->n_columns, sizeof(double));
    m->part = dalcs_arena_alloc(&m->arena, n_choices * m->n_parts, sizeof(double));
    m->size = dalcs_arena_alloc(&m->arena, n_choices, sizeof(double));
    m->sign = dalcs_arena_alloc(&m->arena, m->n_parts, sizeof(double));
    bool complete = m->direction != NULL && m->part != NULL && m->size != NULL && m->sign != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

enum dalcs_status dalcs_open_mode_solve(struct dalcs_osnsp *p, const double *u, double *y) {
    struct dalcs_mode_entry *entry;
    DALCS_TRY(dalcs_modes_get(p, DALCS_PLAIN, &entry));
    if (!entry->singular || entry->whole == NULL) {
        return DALCS_NOT_CONVERGED;
    }
    struct open_mode m = {.p = p, .whole = entry->whole};
    enum dalcs_status status = allocate(&m);
    if (status == DALCS_OK) {
        look_at_parts(&m, y, true, m.sign);
        find_directions(&m);
        status = move(&m, y);
        dalcs_whole_refine(m.whole, u, y);
    }
    dalcs_arena_finish(&m.arena);
    if (status != DALCS_OK) {
        return status;
    }
    bool sources_clash;
    dalcs_certificate_evaluate_with_states(p, u, y, &sources_clash);
    p->least_norm = true;
    return dalcs_certificate_holds(p, sources_clash) ? DALCS_OK : DALCS_NOT_CONVERGED;
}

/* scattering.c - the pairs' own problem: what the rest of the circuit reflects of what they send.
 *
 * With a line w + R lambda = t in the place of each pair, whatever the pairs are, nothing is an open circuit or a
 * short, and one factorisation gives lambda as t has it. In waves a = lambda sqrt(R), b = w / sqrt(R) that is
 * a - b = S (a + b) + h with the scattering matrix S, which has |S| <= 1 exactly where the circuit takes in power
 * (V. Belevitch, Classical Network Theory, 1968). What is left is a linear complementarity problem of the pairs alone
 * (lemke.h). Small weights make it one of exactly one solution:
 *     w + eps R (lambda - lambda') = 0 or lambda + eps / R (w - w') = 0. */
#include "lemke.h"
#include "osnsp_internal.h"

#include <float.h>
#include <math.h>

/* Changes of the mode from one that is right but for rounding. */
enum { MOST_CHANGES = 60 };

/* Pairs up to which 2 n^3 operations of the tableau are no more than the some 40 sparse factorisations of the interior
 * method, each of some 1000 operations a pair. */
enum { MOST_PAIRS = 128 };

struct scattering {
    struct dalcs_osnsp *p;
    int n;
    double *resistance; /* [n] ohm */
    double *root;       /* [n] its square root */
    double *line;       /* [n] */
    double *nothing;    /* [n_u] no state, no source */
    double *y;          /* [n_columns] */
    struct dalcs_whole whole;
    struct dalcs_lemke lemke;
    struct dalcs_arena arena;
};

static void finish(struct scattering *s) {
    dalcs_whole_finish(&s->whole);
    dalcs_lemke_finish(&s->lemke);
    dalcs_arena_finish(&s->arena);
}

static enum dalcs_status setup(struct scattering *s, struct dalcs_osnsp *p) {
    const struct dalcs_step_form *f = p->cache.form[0];
    *s = (struct scattering){.p = p, .n = f->n_pairs};
    size_t n = (size_t)s->n;
    s->resistance = dalcs_arena_alloc(&s->arena, n, sizeof(double));
    s->root = dalcs_arena_alloc(&s->arena, n, sizeof(double));
    s->line = dalcs_arena_alloc(&s->arena, n, sizeof(double));
    s->nothing = dalcs_arena_alloc(&s->arena, (size_t)f->n_u, sizeof(double));
    s->y = dalcs_arena_alloc(&s->arena, (size_t)dalcs_system_n_columns(p->system), sizeof(double));
    if (s->resistance == NULL || s->root == NULL || s->line == NULL || s->nothing == NULL ||
        s->y == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int d = 0; d < s->n; d++) {
        s->resistance[d] = dalcs_proximal_resistance(p, d);
        s->root[d] = sqrt(s->resistance[d]);
    }
    DALCS_TRY(dalcs_whole_factor(&s->whole, p, s->resistance));
    return dalcs_lemke_setup(&s->lemke, s->n);
}

/* a of each pair, which the lines or the sources bring about. */
static void find_waves(struct scattering *s, const double *u) {
    dalcs_whole_solve(&s->whole, u, s->line, s->y);
    double *lambda = s->y + dalcs_system_n_equations(s->p->system);
    for (int d = 0; d < s->n; d++) {
        lambda[d] *= s->root[d];
    }
}

static void fill(struct scattering *s, const double *u, double eps) {
    const struct dalcs_osnsp *p = s->p;
    const struct dalcs_step_form *f = p->cache.form[0];
    size_t n = (size_t)s->n;
    double less = (1.0 - eps) / (1.0 + eps);
    const double *a = s->y + dalcs_system_n_equations(p->system);
    find_waves(s, u);
    for (int d = 0; d < s->n; d++) {
        double a_centre = p->work.centre[f->n + d] * f->scale[f->n + d] * s->root[d];
        double b_centre = p->work.centre_w[d] / (f->row_scale[f->n + d] * s->root[d]);
        s->lemke.h[d] += (1.0 - eps) * 2.0 * a[d] + eps * (a_centre - b_centre);
        s->lemke.law[d] = p->lists.is_diode[d]      ? DALCS_LEMKE_EITHER
                          : dalcs_osnsp_is_on(p, d) ? DALCS_LEMKE_A_FREE
                                                    : DALCS_LEMKE_B_FREE;
    }
    for (int k = 0; k < s->n; k++) {
        double sent = eps * (p->work.centre[f->n + k] * f->scale[f->n + k] * s->root[k] +
                             p->work.centre_w[k] / (f->row_scale[f->n + k] * s->root[k]));
        s->line[k] = s->root[k];
        find_waves(s, s->nothing);
        s->line[k] = 0.0;
        for (int d = 0; d < s->n; d++) {
            double S = less * (2.0 * a[d] - (d == k ? 1.0 : 0.0));
            s->lemke.S[(size_t)d * n + (size_t)k] = S;
            s->lemke.h[d] += S * sent;
        }
    }
}

enum dalcs_status dalcs_scattering_mode(struct dalcs_osnsp *p, const double *u, double eps) {
    struct scattering s;
    if (p->system->n_pairs > MOST_PAIRS) {
        return DALCS_SINGULAR;
    }
    enum dalcs_status status = setup(&s, p);
    if (status == DALCS_OK) {
        fill(&s, u, eps);
        status = dalcs_lemke_solve(&s.lemke, p->options.max_pivots + 2 * s.n);
    }
    for (int d = 0; d < s.n && status >= DALCS_OK && status != DALCS_SINGULAR; d++) {
        if (p->lists.is_diode[d]) {
            dalcs_osnsp_command(p, d, s.lemke.is_a[d]);
        }
    }
    finish(&s);
    return status;
}

enum dalcs_status dalcs_scattering_solve(struct dalcs_osnsp *p, const double *u, double *y) {
    dalcs_proximal_begin(p, u);
    const enum dalcs_status status = dalcs_scattering_mode(p, u, DBL_EPSILON);
    return status == DALCS_OK || status == DALCS_NOT_CONVERGED
               ? dalcs_exact_pivot(p, u, y, MOST_CHANGES)
               : status;
}

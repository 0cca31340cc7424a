/* interior.c - the mode of a regularised problem where pivoting gets nowhere: a primal-dual
 * interior-point method (Wright, Primal-Dual Interior-Point Methods, 1997; predictor and corrector of
 * Mehrotra, SIAM J. Optim. 2, 1992).
 *
 * With s1 = w + (eps/G) (lambda - lambda') and s2 = lambda + eps G (w - w') a pair is closed where
 * s1 = 0 < s2 and open where s1 > 0 = s2. Newton's method follows the path s1 s2 = mu to mu = 0, on
 * which all pairs decide together: a few tens of factorisations, however many pairs there are, where
 * pivots one by one may be as many as modes. In a Newton step each diode is a resistor. */
#include "osnsp_internal.h"

#include "magnitudes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Steps at most, and in a row with hardly a smaller mu: where s1 and s2 are both 0, rounding ends it. */
enum { MOST_STEPS = 100, STUCK = 3 };

/* Of each pair. */
struct of_pairs {
    double *on, *off;      /* [n_pairs] weights */
    double *s1, *s2;       /* [n_pairs] */
    double *d1, *d2;       /* [n_pairs] their steps */
    double *rest1, *rest2; /* [n_pairs] what their definitions are off by */
    double *a, *b;         /* [n_pairs] row of a pair: a w + b lambda */
};

struct interior {
    struct dalcs_osnsp *p;
    int n, n_pairs;
    klu_symbolic *symbolic;
    klu_numeric *kept;
    int *start, *row;
    double *value;
    struct dalcs_lu lu;
    struct of_pairs of;
    double *y, *dy; /* [n + n_pairs] balanced */
    double *rest;   /* [n] of the equations */
};

static void finish(struct interior *m) {
    dalcs_lu_finish(&m->lu);
    dalcs_lu_drop(&m->kept, false, &m->p->cache.klu);
    if (m->symbolic != NULL) {
        klu_free_symbolic(&m->symbolic, &m->p->cache.klu);
    }
    free(m->start);
    free(m->row);
    free(m->value);
    free(m->of.on);
    free(m->y);
}

/* The pattern of K and its diagonal. */
static void fill_pattern(struct interior *m) {
    const struct dalcs_csr *K = &m->p->cache.form[0]->K;
    int out = 0;
    for (int c = 0; c < m->n + m->n_pairs; c++) {
        bool seen = false;
        for (int k = K->p[c]; k < K->p[c + 1]; k++) {
            seen = seen || K->j[k] == c;
            m->row[out++] = K->j[k];
        }
        if (!seen) {
            m->row[out++] = c;
        }
        m->start[c + 1] = out;
    }
}

static enum dalcs_status setup(struct interior *m, struct dalcs_osnsp *p) {
    const struct dalcs_step_form *f = p->cache.form[0];
    *m = (struct interior){.p = p, .n = f->n, .n_pairs = f->n_pairs};
    size_t n_pairs = (size_t)f->n_pairs;
    size_t order = (size_t)(f->n + f->n_pairs);
    size_t capacity = (size_t)f->K.p[order] + order;
    m->start = dalcs_alloc(order + 1, sizeof(*m->start));
    m->row = dalcs_alloc(capacity, sizeof(*m->row));
    m->value = dalcs_alloc(capacity, sizeof(*m->value));
    m->of.on = dalcs_alloc(10 * n_pairs, sizeof(double));
    m->y = dalcs_alloc(2 * order + (size_t)f->n, sizeof(double));
    if (m->start == NULL || m->row == NULL || m->value == NULL || m->of.on == NULL ||
        m->y == NULL) {
        finish(m);
        return DALCS_E_NOMEM;
    }
    double **part[] = {&m->of.off,   &m->of.s1,    &m->of.s2, &m->of.d1, &m->of.d2,
                       &m->of.rest1, &m->of.rest2, &m->of.a,  &m->of.b};
    for (size_t k = 0; k < sizeof(part) / sizeof(*part); k++) {
        *part[k] = m->of.on + (k + 1) * n_pairs;
    }
    m->dy = m->y + order;
    m->rest = m->dy + order;
    for (int d = 0; d < f->n_pairs; d++) {
        dalcs_proximal_weights(p, d, &m->of.on[d], &m->of.off[d]);
    }
    fill_pattern(m);
    dalcs_lu_keep_diagonal(&p->cache.klu, true);
    enum dalcs_status status =
        dalcs_lu_analyze(&m->symbolic, &p->cache.klu,
                         &(struct dalcs_columns){.n = (int)order, .p = m->start, .i = m->row});
    dalcs_lu_keep_diagonal(&p->cache.klu, false);
    if (status != DALCS_OK) {
        finish(m);
    }
    return status;
}

static bool is_diode(const struct interior *m, int d) {
    return m->p->lists.is_diode[d];
}

/* Factors the equations with the rows a w + b lambda of the pairs. */
static enum dalcs_status factor(struct interior *m) {
    const struct dalcs_csr *K = &m->p->cache.form[0]->K;
    double unknown_weight = dalcs_proximal_unknown_weight(m->p);
    for (int c = 0; c < m->n + m->n_pairs; c++) {
        double diagonal = c < m->n ? unknown_weight : m->of.b[c - m->n];
        int out = m->start[c];
        bool seen = false;
        for (int k = K->p[c]; k < K->p[c + 1]; k++) {
            int r = K->j[k];
            double x = K->x[k] * (r < m->n ? 1.0 : m->of.a[r - m->n]);
            seen = seen || r == c;
            m->value[out++] = r == c ? x + diagonal : x;
        }
        if (!seen) {
            m->value[out] = diagonal;
        }
    }
    dalcs_lu_finish(&m->lu);
    m->p->counters.factorizations++;
    const struct dalcs_columns a = {
        .n = m->n + m->n_pairs, .p = m->start, .i = m->row, .x = m->value};
    return dalcs_lu_factor_analyzed(&m->lu, &m->p->cache.klu, m->symbolic, &m->kept, &a, 0.0);
}

static double voltage_of(const struct interior *m, int d, const double *y) {
    const struct dalcs_csr *W = &m->p->cache.form[0]->W;
    double w = 0.0;
    for (int k = W->p[d]; k < W->p[d + 1]; k++) {
        w += W->x[k] * y[W->j[k]];
    }
    return w;
}

/* What the equations and the definitions of s1 and s2 are off by; the largest over its terms. */
static double find_rests(struct interior *m) {
    const struct dalcs_osnsp *p = m->p;
    const struct dalcs_csr *K = &p->cache.form[0]->K;
    double unknown_weight = dalcs_proximal_unknown_weight(p);
    double size = 0.0;
    double worst = 0.0;
    for (int i = 0; i < m->n; i++) {
        m->rest[i] = p->work.right[i] + unknown_weight * (p->work.centre[i] - m->y[i]);
        size = fmax(size, fabs(p->work.right[i]));
    }
    for (int c = 0; c < m->n + m->n_pairs; c++) {
        for (int k = K->p[c]; k < K->p[c + 1]; k++) {
            if (K->j[k] < m->n) {
                m->rest[K->j[k]] -= K->x[k] * m->y[c];
                size = fmax(size, fabs(K->x[k] * m->y[c]));
            }
        }
    }
    for (int i = 0; i < m->n; i++) {
        worst = fmax(worst, fabs(m->rest[i]));
    }
    for (int d = 0; d < m->n_pairs; d++) {
        double w = voltage_of(m, d, m->y) - p->work.right[m->n + d];
        double lambda = m->y[m->n + d];
        m->of.rest1[d] = w + m->of.on[d] * (lambda - p->work.centre[m->n + d]) - m->of.s1[d];
        m->of.rest2[d] = lambda + m->of.off[d] * (w - p->work.centre_w[d]) - m->of.s2[d];
        if (is_diode(m, d)) {
            worst = fmax(worst, fmax(fabs(m->of.rest1[d]), fabs(m->of.rest2[d])));
            size = fmax(size, fmax(m->of.s1[d], m->of.s2[d]));
        }
    }
    return size > 0.0 ? worst / size : 0.0;
}

/* The step that takes each product s1 s2 to mu less the product of the steps at hand, if those
 * count, into dy, d1 and d2. */
static void find_step(struct interior *m, double mu, bool corrects) {
    memcpy(m->dy, m->rest, (size_t)m->n * sizeof(double));
    for (int d = 0; d < m->n_pairs; d++) {
        double *right = &m->dy[m->n + d];
        if (!is_diode(m, d)) {
            *right = dalcs_osnsp_is_on(m->p, d) ? -m->of.rest1[d] : -m->of.rest2[d];
            continue;
        }
        double s1 = m->of.s1[d];
        double s2 = m->of.s2[d];
        double product = mu - s1 * s2 - (corrects ? m->of.d1[d] * m->of.d2[d] : 0.0);
        *right = (product - s2 * m->of.rest1[d] - s1 * m->of.rest2[d]) / (s1 + s2);
    }
    dalcs_lu_solve(&m->lu, m->dy);
    for (int d = 0; d < m->n_pairs; d++) {
        double dw = voltage_of(m, d, m->dy);
        double dlambda = m->dy[m->n + d];
        m->of.d1[d] = dw + m->of.on[d] * dlambda + m->of.rest1[d];
        m->of.d2[d] = dlambda + m->of.off[d] * dw + m->of.rest2[d];
    }
}

static void set_rows(struct interior *m) {
    for (int d = 0; d < m->n_pairs; d++) {
        if (is_diode(m, d)) {
            double sum = m->of.s1[d] + m->of.s2[d];
            m->of.a[d] = (m->of.s2[d] + m->of.s1[d] * m->of.off[d]) / sum;
            m->of.b[d] = (m->of.s1[d] + m->of.s2[d] * m->of.on[d]) / sum;
        } else {
            bool is_on = dalcs_osnsp_is_on(m->p, d);
            m->of.a[d] = is_on ? 1.0 : m->of.off[d];
            m->of.b[d] = is_on ? m->of.on[d] : 1.0;
        }
    }
}

/* The longest step, up to 1, that leaves all s1 and s2 positive: slightly less than to the boundary. */
static double longest_step(const struct interior *m) {
    double longest = INFINITY;
    for (int d = 0; d < m->n_pairs; d++) {
        if (is_diode(m, d)) {
            longest = m->of.d1[d] < 0.0 ? fmin(longest, -m->of.s1[d] / m->of.d1[d]) : longest;
            longest = m->of.d2[d] < 0.0 ? fmin(longest, -m->of.s2[d] / m->of.d2[d]) : longest;
        }
    }
    return fmin(1.0, (1.0 - dalcs_slight) * longest);
}

/* The mean of s1 s2 after a part of the step at hand. */
static double mean_product(const struct interior *m, double part) {
    double sum = 0.0;
    int n = 0;
    for (int d = 0; d < m->n_pairs; d++) {
        if (is_diode(m, d)) {
            sum += (m->of.s1[d] + part * m->of.d1[d]) * (m->of.s2[d] + part * m->of.d2[d]);
            n++;
        }
    }
    return n > 0 ? sum / n : 0.0;
}

/* Every diode a resistor first; from there s1 and s2 are shifted well inside (Mehrotra). */
static enum dalcs_status find_start(struct interior *m) {
    for (int d = 0; d < m->n_pairs; d++) {
        m->of.s1[d] = 1.0;
        m->of.s2[d] = 1.0;
    }
    (void)find_rests(m);
    for (int d = 0; d < m->n_pairs; d++) {
        m->of.rest1[d] += is_diode(m, d) ? 1.0 : 0.0;
        m->of.rest2[d] += is_diode(m, d) ? 1.0 : 0.0;
        m->of.s1[d] = is_diode(m, d) ? 0.5 : 0.0;
        m->of.s2[d] = is_diode(m, d) ? 0.5 : 0.0;
    }
    set_rows(m);
    DALCS_TRY(factor(m));
    find_step(m, 0.25, false);
    double least1 = 0.0, least2 = 0.0, sum1 = 0.0, sum2 = 0.0, product = 0.0;
    for (int i = 0; i < m->n + m->n_pairs; i++) {
        m->y[i] += m->dy[i];
    }
    for (int d = 0; d < m->n_pairs; d++) {
        least1 = fmin(least1, m->of.d1[d]);
        least2 = fmin(least2, m->of.d2[d]);
    }
    for (int d = 0; d < m->n_pairs; d++) {
        m->of.s1[d] = m->of.d1[d] - 1.5 * least1;
        m->of.s2[d] = m->of.d2[d] - 1.5 * least2;
        sum1 += m->of.s1[d];
        sum2 += m->of.s2[d];
        product += m->of.s1[d] * m->of.s2[d];
    }
    double shift1 = sum2 > 0.0 ? 0.5 * product / sum2 : 0.0;
    double shift2 = sum1 > 0.0 ? 0.5 * product / sum1 : 0.0;
    for (int d = 0; d < m->n_pairs; d++) {
        m->of.s1[d] += shift1 > 0.0 ? shift1 : 1.0;
        m->of.s2[d] += shift2 > 0.0 ? shift2 : 1.0;
    }
    return DALCS_OK;
}

/* A pair has decided when one of s1 and s2 is nothing beside the other. */
static bool all_decided(const struct interior *m) {
    bool all = true;
    for (int d = 0; d < m->n_pairs && all; d++) {
        all = !is_diode(m, d) ||
              fmin(m->of.s1[d], m->of.s2[d]) < dalcs_alike * fmax(m->of.s1[d], m->of.s2[d]);
    }
    return all;
}

static enum dalcs_status follow_path(struct interior *m) {
    DALCS_TRY(find_start(m));
    memset(m->of.d1, 0, (size_t)m->n_pairs * sizeof(double));
    memset(m->of.d2, 0, (size_t)m->n_pairs * sizeof(double));
    double mu = mean_product(m, 0.0);
    int stuck = 0;
    for (int step = 0; step < MOST_STEPS && mu > 0.0 && stuck < STUCK; step++) {
        if (find_rests(m) <= dalcs_alike && all_decided(m)) {
            break;
        }
        set_rows(m);
        DALCS_TRY(factor(m));
        find_step(m, 0.0, false);
        double after = mean_product(m, longest_step(m));
        find_step(m, mu * pow(fmax(after, 0.0) / mu, 3.0), true);
        double part = longest_step(m);
        for (int i = 0; i < m->n + m->n_pairs; i++) {
            m->y[i] += part * m->dy[i];
        }
        for (int d = 0; d < m->n_pairs; d++) {
            m->of.s1[d] += part * m->of.d1[d];
            m->of.s2[d] += part * m->of.d2[d];
            m->of.d1[d] = 0.0;
            m->of.d2[d] = 0.0;
        }
        double before = mu;
        mu = mean_product(m, 0.0);
        stuck = mu > (1.0 - dalcs_slight) * before ? stuck + 1 : 0;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_interior_mode(struct dalcs_osnsp *p) {
    struct interior m;
    DALCS_TRY(setup(&m, p));
    enum dalcs_status status = follow_path(&m);
    for (int d = 0; d < m.n_pairs && status == DALCS_OK; d++) {
        if (is_diode(&m, d)) {
            dalcs_osnsp_command(p, d, m.of.s2[d] > m.of.s1[d]);
        }
    }
    finish(&m);
    return status;
}

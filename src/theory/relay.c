/* relay.c - finds boxes among the pairs, and checks the conditions on G of the theorems on relays. */
#include "relay.h"

#include "coupling.h"
#include "lure.h"
#include "passivity.h"

#include <math.h>

#define HSW99 "Heemels, Schumacher and Weiland 1999, "
#define BG13  "Brogliato and Goeleven 2013, "

/* Equal to rounding, over their size. */
static const double tolerance = 1e-9;

enum { MOST_PAIRS = 14 };

struct search {
    struct dalcs_findings *f;
    const struct dalcs_lcs *l;
    struct dalcs_lcs g; /* the same with w in the place of u where two y have a constant sum */
    bool *is_lid;       /* [m] the second pair of a box */
    bool *is_box;       /* [m] the first */
};

/* The constant of y_i; NAN when a source is in it. */
static double constant_of(const struct dalcs_lcs *l, const double *F, int stride) {
    const struct dalcs_system *s = l->blocks->system;
    double constant = 0.0;
    for (int j = 0; j < 2 * l->k; j++) {
        double value = F[(size_t)j * (size_t)stride];
        bool is_constant = j < l->k && s->input_element[j] == NULL;
        if (value != 0.0 && !is_constant) {
            return NAN;
        }
        constant += value;
    }
    return constant;
}

/* Is row j of y the constant over -c u_i, and is u_j in row i alone? */
static bool is_lid_of(const struct dalcs_lcs *g, int j, int i) {
    bool is = *dalcs_at(&g->D, j, i) < 0.0 && *dalcs_at(&g->D, i, j) > 0.0 &&
              constant_of(g, &g->F.a[j], g->m) > 0.0;
    for (int k = 0; is && k < g->n; k++) {
        is = *dalcs_at(&g->C, j, k) == 0.0 && *dalcs_at(&g->B, k, j) == 0.0;
    }
    for (int k = 0; is && k < g->m; k++) {
        is = k == i || (*dalcs_at(&g->D, j, k) == 0.0 && *dalcs_at(&g->D, k, j) == 0.0);
    }
    return is;
}

static bool cancel(double a, double b) {
    return fabs(a + b) <= tolerance * (fabs(a) + fabs(b));
}

/* Do y_i + y_j and the effect of u_i and u_j cancel but for a constant? */
static bool are_opposite(const struct dalcs_lcs *l, int i, int j) {
    bool are = *dalcs_at(&l->D, i, i) != 0.0;
    for (int k = 0; are && k < l->n; k++) {
        are = cancel(*dalcs_at(&l->C, i, k), *dalcs_at(&l->C, j, k)) &&
              cancel(*dalcs_at(&l->B, k, i), *dalcs_at(&l->B, k, j));
    }
    for (int k = 0; are && k < l->m; k++) {
        are = cancel(*dalcs_at(&l->D, i, k), *dalcs_at(&l->D, j, k)) &&
              cancel(*dalcs_at(&l->D, k, i), *dalcs_at(&l->D, k, j));
    }
    double sum = 0.0;
    for (int k = 0; are && k < 2 * l->k; k++) {
        double first = *dalcs_at(&l->F, i, k);
        double second = *dalcs_at(&l->F, j, k);
        bool is_constant = k < l->k && l->blocks->system->input_element[k] == NULL;
        are = is_constant || cancel(first, second);
        sum += is_constant ? first + second : 0.0;
    }
    return are && sum > 0.0;
}

/* Element (row, column) of [A B; C D]. */
static double *element(const struct dalcs_lcs *g, int row, int column) {
    const struct dalcs_matrix *m = row < g->n      ? column < g->n ? &g->A : &g->B
                                   : column < g->n ? &g->C
                                                   : &g->D;
    return dalcs_at(m, row < g->n ? row : row - g->n, column < g->n ? column : column - g->n);
}

/* u_i and y_i change places; u_j, the opposite of u_i, then is in row i alone. */
static void exchange(struct dalcs_lcs *g, int i, int j) {
    const int size = g->n + g->m;
    const int p = g->n + i;
    const double pivot = *element(g, p, p);
    for (int r = 0; r < size; r++) {
        const double factor = *element(g, r, p) / pivot;
        for (int c = 0; r != p && factor != 0.0 && c < size; c++) {
            if (c != p) {
                double *a = element(g, r, c);
                double by = factor * *element(g, p, c);
                *a = cancel(*a, -by) ? 0.0 : *a - by;
            }
        }
        for (int k = 0; r != p && r >= g->n && k < 2 * g->k; k++) {
            double *a = dalcs_at(&g->F, r - g->n, k);
            double by = factor * *dalcs_at(&g->F, i, k);
            *a = cancel(*a, -by) ? 0.0 : *a - by;
        }
        *element(g, r, p) = r == p ? 1.0 / pivot : factor;
    }
    for (int c = 0; c < size; c++) {
        *element(g, p, c) /= c == p ? 1.0 : -pivot;
    }
    *element(g, g->n + j, p) = -1.0; /* y_j = H - y_i, to the last bit */
    for (int k = 0; k < 2 * g->k; k++) {
        *dalcs_at(&g->F, i, k) /= -pivot;
    }
}

static enum dalcs_status find_boxes(struct search *s) {
    const struct dalcs_lcs *l = s->l;
    struct dalcs_arena *work = s->f->work;
    s->g = *l;
    s->is_lid = dalcs_arena_alloc(work, (size_t)l->m + 1, sizeof(bool));
    s->is_box = dalcs_arena_alloc(work, (size_t)l->m + 1, sizeof(bool));
    if (s->is_lid == NULL || s->is_box == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_matrix_copy(&s->g.A, work, &l->A));
    DALCS_TRY(dalcs_matrix_copy(&s->g.B, work, &l->B));
    DALCS_TRY(dalcs_matrix_copy(&s->g.C, work, &l->C));
    DALCS_TRY(dalcs_matrix_copy(&s->g.D, work, &l->D));
    DALCS_TRY(dalcs_matrix_copy(&s->g.F, work, &l->F));
    for (int i = 0; i < l->m; i++) {
        for (int j = 0; j < l->m && !s->is_box[i] && !s->is_lid[i]; j++) {
            if (j == i || s->is_box[j] || s->is_lid[j]) {
                continue;
            }
            if (are_opposite(&s->g, i, j)) {
                exchange(&s->g, i, j);
            }
            if (is_lid_of(&s->g, j, i)) {
                s->is_box[i] = s->is_lid[j] = true;
            }
        }
    }
    return DALCS_OK;
}

/* G's quadruple: all pairs but the lids. */
static enum dalcs_status reduce(const struct search *s, struct dalcs_lcs *G) {
    struct dalcs_arena *work = s->f->work;
    const struct dalcs_lcs *g = &s->g;
    int n = 0;
    int *index = dalcs_arena_alloc(work, (size_t)g->m + 1, sizeof(int));
    int *state = dalcs_arena_alloc(work, (size_t)g->n + 1, sizeof(int));
    if (index == NULL || state == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < g->n; i++) {
        state[i] = i;
    }
    for (int i = 0; i < g->m; i++) {
        if (!s->is_lid[i]) {
            index[n++] = i;
        }
    }
    *G = *g;
    G->m = n;
    DALCS_TRY(dalcs_matrix_part(&G->B, work, &g->B, g->n, state, n, index));
    DALCS_TRY(dalcs_matrix_part(&G->C, work, &g->C, n, index, g->n, state));
    return dalcs_matrix_part(&G->D, work, &g->D, n, index, n, index);
}

/* The least principal minor of G beyond the speeds at which one may vanish. */
static enum dalcs_status check_minors(struct search *s, const struct dalcs_lcs *G,
                                      const struct dalcs_modes *modes, struct dalcs_relays *found) {
    struct dalcs_arena *work = s->f->work;
    struct dalcs_matrix M;
    double norm = dalcs_matrix_largest(&G->A);
    double fastest = modes->is_checked ? modes->fastest.value[0] : 0.0;
    double sigma = fastest > 0.0 ? 2.0 * fastest : norm > 0.0 ? norm : 1.0;
    double least = INFINITY;
    double *room = dalcs_arena_alloc(work, (size_t)G->m * (size_t)G->m + 1, sizeof(*room));
    bool is_known = modes->is_checked && G->m <= MOST_PAIRS;
    if (room == NULL) {
        return DALCS_E_NOMEM;
    }
    if (is_known) {
        enum dalcs_status status = dalcs_step_matrix(G, sigma, &M, work);
        is_known = status == DALCS_OK;
        if (status != DALCS_OK && status != DALCS_SINGULAR) {
            return status;
        }
    }
    for (uint32_t on = 1; is_known && on < (uint32_t)1 << G->m; on++) {
        least = fmin(least, dalcs_scaled_minor(&M, on, room));
    }
    found->is_P = is_known && least > 0.0;
    return is_known
               ? dalcs_findings_condition(
                     s->f, "relay-P", HSW99 "theorems 6.7 to 6.9",
                     "G(s) of relays, each one multiplier in a box, a P-matrix for all large s",
                     dalcs_answer_of(found->is_P),
                     "the least principal minor at s = %.4g is %.3g (scaled)", sigma, least)
               : dalcs_findings_condition(
                     s->f, "relay-P", HSW99 "theorems 6.7 to 6.9",
                     "G(s) of relays, each one multiplier in a box, a P-matrix for all large s",
                     DALCS_NOT_CHECKED, "too many modes, or passive by its elements");
}

static enum dalcs_status check_coupling(struct search *s, const struct dalcs_lcs *G,
                                        struct dalcs_relays *found) {
    struct dalcs_matrix P;
    const char *why;
    double least;
    bool holds;
    DALCS_TRY(dalcs_coupling_find(&P, &holds, &why, &G->B, &G->C, s->f->work));
    DALCS_TRY(dalcs_symmetric_part_least(&G->D, &least, s->f->work));
    found->is_coupled = holds && least > -dalcs_definite;
    DALCS_TRY(dalcs_findings_condition(
        s->f, "relay-K1", BG13 "section 6.2", "P B = C' and D + D' >= 0 of relays alone",
        dalcs_answer_of(found->is_coupled && found->is_all), "%s",
        !holds               ? why
        : !found->is_coupled ? "D + D' has a negative eigenvalue"
        : !found->is_all     ? "there are other pairs"
                         : "P = C'(CB)^+ C + a projector; any one-sided Lipschitz constant of A "
                           "will do"));
    return found->is_coupled ? dalcs_lure_metric_witness(s->f, s->l, &P, false) : DALCS_OK;
}

enum dalcs_status dalcs_relay_check(struct dalcs_findings *f, const struct dalcs_lcs *lcs,
                                    const struct dalcs_modes *modes, struct dalcs_relays *found) {
    struct search s = {.f = f, .l = lcs};
    struct dalcs_lcs G;
    int n_others = 0;
    *found = (struct dalcs_relays){0};
    DALCS_TRY(find_boxes(&s));
    for (int i = 0; i < lcs->m; i++) {
        found->n += s.is_box[i] ? 1 : 0;
        n_others += s.is_box[i] || s.is_lid[i] ? 0 : 1;
    }
    found->is_all = n_others == 0;
    if (found->n == 0) {
        return DALCS_OK;
    }
    DALCS_TRY(reduce(&s, &G));
    DALCS_TRY(check_minors(&s, &G, modes, found));
    return check_coupling(&s, &G, found);
}

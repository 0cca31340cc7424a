/* stage_update.c - low-rank updates of the stage matrices.
 *
 * M0 is the balanced matrix of a mode that is factored, the base, at one of the eigenvalues. A pair
 * that closes borders it with an unknown, its lambda with column b of M, and with row c, its w. One
 * that opens leaves its row to a slack, its w, and gets the row lambda = 0:
 *     [M0 U] [y ]   [r]       U: columns b and unit columns,
 *     [V  W] [nu] = [t]       V: rows c and unit rows.
 * With G = M0^-1 U, which belongs to the base, a solution is one of the base and a few dot products:
 *     S nu = V M0^-1 r - t,    y = M0^-1 r - G nu,    S = V G - W
 * (Sherman and Morrison, Woodbury; W. W. Hager, Updating the inverse of a matrix, SIAM Review 31(2),
 * 1989).
 *
 * The unknowns nu belong to the answer: currents of what has closed, voltages of what has opened.
 * What is subtracted is thus no larger than the answer times G, in balanced units, and as long as G
 * is moderate no digits cancel that factors of the mode itself would keep. */
#include "stage_update.h"

#include "extended.h"
#include "magnitudes.h"
#include "rounding.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* So many bases are looked at, the latest first. */
enum { MOST_BASES = 64 };

/* No more updates are tried in a system where most of them were refused for lack of digits. */
enum { SERVED = 1, REFUSED = -2, MOST_TRUST = 2 * DALCS_STAGE_FIRST_TRUST };

/* What a factorisation costs, in changes worked into a step. */
enum { WORTH_FACTORING = 200 };

bool dalcs_stage_update_can_be_base(const struct dalcs_stage_entry *entry) {
    const struct dalcs_stage_factors *f = entry->factors;
    return f != NULL && f->update == NULL && f->singular.n == 0;
}

bool dalcs_stage_is_update(const struct dalcs_stage_entry *entry) {
    return entry->factors != NULL && entry->factors->update != NULL;
}

bool dalcs_stage_update_is_doubtful(const struct dalcs_stages *stages,
                                    const struct dalcs_stage_entry *entry) {
    if (!dalcs_stage_is_update(entry)) {
        return false;
    }
    /* An estimate of the base's, or rounding in any case, or what nobody sees. */
    double of_base = dalcs_beyond * entry->factors->update->base->residual;
    /* half of what an answer may be off by: it is reported as rounding, and the base has the other half */
    double let_be = fmin(stages->unseen, 0.5 * dalcs_answer_rounded);
    return !(entry->residual <= fmax(of_base, fmax(dalcs_sum_rounded, let_be)));
}

void dalcs_stage_update_check(struct dalcs_stages *stages, struct dalcs_stage_entry *entry,
                              const double *in, const double *out) {
    double miss = dalcs_stage_factors_miss(stages, entry, in, out);
    entry->residual = miss > entry->residual || miss != miss ? miss : entry->residual;
    if (dalcs_stage_update_is_doubtful(stages, entry)) {
        stages->cache.update_trust += REFUSED;
    }
}

bool dalcs_stage_update_is_spent(const struct dalcs_stages *stages,
                                 struct dalcs_stage_entry *entry) {
    if (!dalcs_stage_is_update(entry)) {
        return false;
    }
    entry->spent += entry->factors->update->n_changes;
    return entry->spent > WORTH_FACTORING || dalcs_stage_update_is_doubtful(stages, entry);
}

static int count_changes(const struct dalcs_stages *stages, const struct dalcs_stage_entry *a,
                         const struct dalcs_stage_entry *b) {
    int n = 0;
    for (int i = 0; i < stages->n_words; i++) {
        n += __builtin_popcountll(a->mode[i] ^ b->mode[i]);
    }
    return n;
}

/* The latest of the nearest bases of the entry's step length, NULL: none is near enough. */
static struct dalcs_stage_entry *choose_base(const struct dalcs_stages *stages,
                                             const struct dalcs_stage_entry *entry) {
    struct dalcs_stage_entry *chosen = NULL;
    int least = DALCS_STAGE_MOST_CHANGES + 1;
    struct dalcs_stage_entry *b = stages->cache.newest_base;
    for (int k = 0; k < MOST_BASES && b != NULL && least > 0; k++, b = b->as_base.older) {
        int n = b->h == entry->h ? count_changes(stages, b, entry) : least;
        if (n < least) {
            least = n;
            chosen = b;
        }
    }
    return chosen;
}

/* Element (i, j) of V G. */
static double product(const struct dalcs_stage_update *u, int i, int j, int system, int part) {
    const struct dalcs_stage_change *c = u->change[i];
    const struct dalcs_stage_response *g = &u->change[j]->response[system];
    const int *position = u->base->factors->order[system].position;
    int stride = system > 0 ? 2 : 1;
    if (i >= u->n_closed) {
        return dalcs_stage_response_element(g, c->lambda_at[system], stride, part);
    }
    double sum = 0.0;
    for (int k = 0; k < c->n_terms; k++) {
        sum += c->value[k] * dalcs_stage_response_element(g, position[c->unknown[k]], stride, part);
    }
    return sum;
}

/* The derivative of w of pair i by lambda of pair j, balanced; both close. */
static double direct(const struct dalcs_system *s, const struct dalcs_stage_change *i,
                     const struct dalcs_stage_change *j) {
    int column = dalcs_system_n_equations(s) + j->pair;
    for (int k = s->C.p[i->pair]; k < s->C.p[i->pair + 1]; k++) {
        if (s->C.j[k] == column) {
            return s->C.x[k] * i->row_scale * j->column_scale;
        }
    }
    return 0.0;
}

/* The inverse of S of one system; *pivot: the smallest, over the elements of its column of G. */
static enum dalcs_status invert(const struct dalcs_system *s, struct dalcs_stage_update *u,
                                int system, double *pivot) {
    int k = u->n_changes;
    size_t n = (size_t)k * (size_t)k;
    bool is_complex = system > 0;
    long double *re = dalcs_alloc(2 * n, sizeof(*re)); /* [k][2 k] S and the identity */
    long double *im = dalcs_alloc(2 * n, sizeof(*im));
    u->inverse[system] = dalcs_alloc(is_complex ? 2 * n : n, sizeof(**u->inverse));
    if (re == NULL || im == NULL || u->inverse[system] == NULL) {
        free(re);
        free(im);
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < k; i++) {
        for (int j = 0; j < k; j++) {
            const struct dalcs_stage_change *of = u->change[j];
            double at_once = i < u->n_closed && j < u->n_closed ? direct(s, u->change[i], of) : 0.0;
            re[i * 2 * k + j] = (product(u, i, j, system, 0) - at_once) / of->largest;
            im[i * 2 * k + j] = is_complex ? product(u, i, j, system, 1) / of->largest : 0.0;
        }
        re[i * 2 * k + k + i] = 1.0L;
    }
    *pivot = (double)dalcs_extended_solve(k, k, re, is_complex ? im : NULL);
    for (int i = 0; i < k; i++) {
        for (int j = 0; j < k; j++) {
            u->inverse[system][i * k + j] = re[i * 2 * k + k + j] / u->change[i]->largest;
            if (is_complex) {
                u->inverse[system][n + (size_t)(i * k + j)] =
                    im[i * 2 * k + k + j] / u->change[i]->largest;
            }
        }
    }
    free(re);
    free(im);
    return DALCS_OK;
}

/* Lists the changes and inverts S; *good: its digits can be trusted. */
static enum dalcs_status prepare(struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                                 const struct dalcs_stage_factors *f, bool *good) {
    struct dalcs_stage_update *u = f->update;
    *good = true;
    for (int closes = 1; closes >= 0; closes--) {
        for (int d = 0; d < stages->system->n_pairs && *good; d++) {
            bool is_on = dalcs_stage_is_on(entry, d);
            if (is_on == dalcs_stage_is_on(u->base, d) || is_on != (closes == 1)) {
                continue;
            }
            DALCS_TRY(dalcs_stage_change_get(stages, u->base, d, &u->change[u->n_changes]));
            *good = !u->change[u->n_changes++]->refused;
            u->n_closed += closes;
        }
    }
    for (int q = 0; q < f->n_systems && *good; q++) {
        double pivot;
        DALCS_TRY(invert(stages->system, u, q, &pivot));
        *good = pivot >= dalcs_alike; /* over what it comes from; else the mode may be singular */
    }
    return DALCS_OK;
}

/* Where lambdas of the entry's pairs are. */
static enum dalcs_status place_pairs(const struct dalcs_stage_entry *entry,
                                     struct dalcs_stage_factors *f) {
    const struct dalcs_stage_update *u = f->update;
    const struct dalcs_stage_factors *base = u->base->factors;
    int n_equations = f->n - f->n_pairs;
    f->pair_scale = dalcs_alloc((size_t)f->n_pairs, sizeof(double));
    if (f->pair_scale == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int q = 0; q < f->n_systems; q++) {
        int *of_pair = dalcs_alloc((size_t)f->n_pairs, sizeof(int));
        f->order[q].of_pair = of_pair;
        if (of_pair == NULL) {
            return DALCS_E_NOMEM;
        }
        int at = 0;
        int closed = 0;
        for (int k = 0; k < f->n_pairs; k++) {
            int d = entry->on[k];
            if (closed < u->n_closed && u->change[closed]->pair == d) {
                f->pair_scale[k] = u->change[closed]->column_scale;
                of_pair[k] = base->order[q].n + closed++;
                continue;
            }
            while (base->pair[at] != d) {
                at++;
            }
            f->pair_scale[k] = base->pair_scale[at];
            of_pair[k] = base->order[q].position[n_equations + at];
        }
    }
    return DALCS_OK;
}

/* The entry's factors are the base's. */
static void borrow(struct dalcs_stage_factors *f, const struct dalcs_stage_entry *entry,
                   struct dalcs_stage_entry *base) {
    struct dalcs_stage_update *u = f->update;
    *f = *base->factors;
    f->update = u;
    f->change = NULL;
    f->pair_scale = NULL;
    f->n = entry->n;
    f->n_pairs = entry->n_on;
    f->pair = entry->on;
    for (int q = 0; q < f->n_systems; q++) {
        f->order[q].of_pair = NULL;
    }
    u->base = base;
    base->as_base.n_holders++;
}

enum dalcs_status dalcs_stage_update_build(struct dalcs_stages *stages,
                                           struct dalcs_stage_entry *entry) {
    struct dalcs_stage_entry *base =
        stages->cache.update_trust > 0 ? choose_base(stages, entry) : NULL;
    if (base == NULL) {
        return DALCS_OK;
    }
    struct dalcs_stage_factors *f = dalcs_alloc(1, sizeof(*f));
    struct dalcs_stage_update *u = dalcs_alloc(1, sizeof(*u));
    if (f == NULL || u == NULL) {
        free(f);
        free(u);
        return DALCS_E_NOMEM;
    }
    f->update = u;
    borrow(f, entry, base);
    entry->factors = f;
    memcpy(entry->natural, base->natural,
           (size_t)dalcs_system_n_equations(stages->system) * sizeof(double));
    bool good;
    enum dalcs_status status = prepare(stages, entry, f, &good);
    if (status == DALCS_OK && good) {
        status = place_pairs(entry, f);
    }
    entry->residual = base->residual;
    stages->cache.update_trust += good ? SERVED : REFUSED;
    stages->cache.update_trust =
        stages->cache.update_trust < MOST_TRUST ? stages->cache.update_trust : MOST_TRUST;
    if (status != DALCS_OK || !good) {
        dalcs_stage_factors_destroy(stages, f);
        entry->factors = NULL;
    }
    return status;
}

size_t dalcs_stage_update_bytes(const struct dalcs_stage_factors *f) {
    size_t k = (size_t)f->update->n_changes;
    size_t parts = (size_t)(2 * f->n_systems - 1);
    return sizeof(*f) + sizeof(*f->update) + k * k * parts * sizeof(long double) +
           (size_t)f->n_pairs * ((size_t)f->n_systems * sizeof(int) + sizeof(double));
}

void dalcs_stage_update_destroy(struct dalcs_stages *stages, struct dalcs_stage_factors *f) {
    for (int q = 0; q < f->n_systems; q++) {
        free(f->update->inverse[q]);
        free(f->order[q].of_pair);
    }
    free(f->pair_scale);
    dalcs_stages_release(stages, f->update->base);
    free(f->update);
}

/* ---- Its solutions --------------------------------------------------------------------------- */

/* choices.c - equations that take, of what a mode leaves open, the answer of least norm (least_norm.h): of the diodes, of
 * the switches where no diode sees it, and of the unknowns, balanced, where no pair does. */
#include "least_norm.h"
#include "osnsp_internal.h"
#include "whole.h"

#include <math.h>
#include <string.h>

struct choices {
    const struct dalcs_whole *whole;
    const struct dalcs_system *s;
    size_t n_columns, n_pairs;
    const double *error; /* [n_columns] */
    double root;         /* of a conductance in S: pairs all have one norm */
};

static double *vector_of(const struct choices *c, int k) {
    return c->whole->choice + (size_t)k * c->n_columns;
}

static double *voltages_of(const struct choices *c, int k) {
    return c->whole->choice_w + (size_t)k * c->n_pairs;
}

/* May it have current? */
static bool is_closed(const struct choices *c, int d) {
    return c->whole->place[c->n_columns - c->n_pairs + (size_t)d] >= 0;
}

/* That of an entry which is as rounded as this one is. */
static double size_of(const struct choices *c, const double *vector, size_t column) {
    return fabs(vector[column]) + c->error[column] / dalcs_least_norm_rounding((int)c->n_columns);
}

/* What pairs of one kind have in a vector: lambda of closed ones, w of open ones. Returns the norm of its terms' sizes. */
static double find_parts(const struct choices *c, enum dalcs_pair_kind kind, const double *vector,
                         double *part) {
    const size_t first = c->n_columns - c->n_pairs;
    const struct dalcs_csr *C = &c->s->C;
    double square = 0.0;
    for (int d = 0; d < c->s->n_pairs; d++) {
        const struct dalcs_pair *pair = &c->s->pair[d];
        bool counts = pair->kind == kind && !pair->is_left_out[is_closed(c, d)];
        const bool has_current = counts && is_closed(c, d);
        const size_t of = first + (size_t)d;
        double sum = has_current ? vector[of] / c->root : 0.0;
        double size = has_current ? size_of(c, vector, of) / c->root : 0.0;
        for (int i = C->p[d]; counts && !is_closed(c, d) && i < C->p[d + 1]; i++) {
            const double by = c->root * C->x[i];
            sum += by * vector[C->j[i]];
            size += fabs(by) * size_of(c, vector, (size_t)C->j[i]);
        }
        part[d] = sum;
        square += size * size;
    }
    return sqrt(square);
}

/* The product with a vector that pairs see, as coefficients of the unknowns and of w - knee. */
static void weigh_by_pairs(const struct choices *c, int k) {
    const struct dalcs_csr *C = &c->s->C;
    double *vector = vector_of(c, k);
    double *part = voltages_of(c, k);
    memset(vector, 0, c->n_columns * sizeof(*vector));
    for (int d = 0; d < c->s->n_pairs; d++) {
        if (is_closed(c, d)) {
            vector[c->n_columns - c->n_pairs + (size_t)d] = part[d] / c->root;
            part[d] = 0.0;
            continue;
        }
        part[d] *= c->root;
        for (int i = C->p[d]; i < C->p[d + 1]; i++) {
            vector[C->j[i]] += part[d] * C->x[i];
        }
    }
}

/* That with another one: in the unknowns that condensing keeps, if it has any. */
static void weigh_by_unknowns(const struct choices *c, int k) {
    const struct dalcs_step_form *f = c->whole->p->cache.form[0];
    double *vector = vector_of(c, k);
    bool has_any = false;
    memset(voltages_of(c, k), 0, c->n_pairs * sizeof(double));
    memset(vector + (c->n_columns - c->n_pairs), 0, c->n_pairs * sizeof(double));
    for (int i = 0; i < f->n; i++) {
        has_any = has_any || vector[f->column_of[i]] != 0.0;
    }
    for (size_t j = 0; has_any && j < (size_t)c->s->n_x; j++) {
        bool is_kept = false;
        for (int i = c->s->n_z; i < f->n; i++) {
            is_kept = is_kept || f->column_of[i] == (int)j;
        }
        vector[j] = is_kept ? vector[j] : 0.0;
    }
    for (int i = 0; i < f->n; i++) {
        vector[f->column_of[i]] /= f->scale[i] * f->row_scale[i];
    }
}

static void normalise(const struct choices *c, int k) {
    double most = 0.0;
    for (size_t j = 0; j < c->n_columns; j++) {
        most = fmax(most, fabs(vector_of(c, k)[j]));
    }
    for (size_t j = 0; j < c->n_columns; j++) {
        vector_of(c, k)[j] /= most;
    }
    for (size_t d = 0; d < c->n_pairs; d++) {
        voltages_of(c, k)[d] /= most;
    }
}

/* Of the vectors from `first` on, those that pairs of one kind see; returns the first that they do not. */
static int choose_in_kind(const struct choices *c, enum dalcs_pair_kind kind, double *size,
                          int first) {
    struct dalcs_least_norm open = {.n = c->whole->n_choices - first,
                                    .n_columns = (int)c->n_columns,
                                    .n_parts = (int)c->n_pairs,
                                    .vector = vector_of(c, first),
                                    .part = voltages_of(c, first),
                                    .size = size};
    for (int k = 0; k < open.n; k++) {
        size[k] = find_parts(c, kind, vector_of(c, first + k), voltages_of(c, first + k));
    }
    int n_seen = dalcs_least_norm_separate(&open);
    for (int k = first; k < first + n_seen; k++) {
        weigh_by_pairs(c, k);
    }
    return first + n_seen;
}

enum dalcs_status dalcs_choices_make(struct dalcs_whole *whole, const double *error) {
    const struct dalcs_system *s = whole->p->system;
    struct choices c = {.whole = whole,
                        .s = s,
                        .n_columns = (size_t)dalcs_system_n_columns(s),
                        .n_pairs = (size_t)s->n_pairs,
                        .error = error,
                        .root = sqrt(whole->p->cache.form[0]->pair_conductance)};
    double *size = dalcs_arena_alloc(&whole->arena, (size_t)whole->n_choices, sizeof(double));
    if (size == NULL) {
        return DALCS_E_NOMEM;
    }
    int n_seen = choose_in_kind(&c, DALCS_PAIR_DIODE, size, 0);
    n_seen = choose_in_kind(&c, DALCS_PAIR_SWITCH, size, n_seen);
    for (int k = 0; k < whole->n_choices; k++) {
        if (k >= n_seen) {
            weigh_by_unknowns(&c, k);
        }
        normalise(&c, k);
    }
    return DALCS_OK;
}

/* stage_change.c - columns of G = M0^-1 U, found when they are first asked for (see stage_update.c). */
#include "stage_change.h"

#include "extremes.h"
#include "magnitudes.h"
#include "rounding.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Runs of G that are not this far apart are one. */
enum { GAP = 8 };

static int compare_pairs(const void *a, const void *b) {
    return *(const int *)a - *(const int *)b;
}

int dalcs_stage_unknown(const struct dalcs_stage_factors *f, int column) {
    int n_equations = f->n - f->n_pairs;
    if (column < n_equations) {
        return column;
    }
    int d = column - n_equations;
    const int *at = bsearch(&d, f->pair, (size_t)f->n_pairs, sizeof(int), compare_pairs);
    return at != NULL ? n_equations + (int)(at - f->pair) : -1;
}

/* w of a pair that closes as a balanced row. */
static enum dalcs_status list_terms(const struct dalcs_system *s,
                                    const struct dalcs_stage_factors *f,
                                    struct dalcs_stage_change *c) {
    int n_equations = f->n - f->n_pairs;
    int first = s->C.p[c->pair];
    int end = s->C.p[c->pair + 1];
    c->unknown = dalcs_alloc((size_t)(end - first), sizeof(int));
    c->value = dalcs_alloc((size_t)(end - first), sizeof(double));
    if (c->unknown == NULL || c->value == NULL) {
        return DALCS_E_NOMEM;
    }
    double largest = 0.0;
    for (int k = first; k < end; k++) {
        int u = dalcs_stage_unknown(f, s->C.j[k]);
        if (u < 0) {
            continue;
        }
        double scale = u < n_equations ? f->column_scale[u] : f->pair_scale[u - n_equations];
        c->unknown[c->n_terms] = u;
        c->value[c->n_terms] = s->C.x[k] * scale;
        largest = fmax(largest, fabs(c->value[c->n_terms++]));
    }
    c->row_scale = dalcs_stage_matrix_scale(largest);
    for (int k = 0; k < c->n_terms; k++) {
        c->value[k] *= c->row_scale;
    }
    return DALCS_OK;
}

static double largest_of(const double *v, int n) {
    double largest = 0.0;
    for (int k = 0; k < n; k++) {
        largest = dalcs_larger(fabs(v[k]), largest);
    }
    return largest;
}

/* lu[system].work = the column of U. */
static void load_change(const struct dalcs_stage_plan *plan, const struct dalcs_stage_factors *f,
                        int system, bool closes, struct dalcs_stage_change *c) {
    const struct dalcs_stage_order *o = &f->order[system];
    int n_equations = f->n - f->n_pairs;
    int stride = system > 0 ? 2 : 1;
    double *work = f->lu[system].work;
    memset(work, 0, (size_t)(o->n * stride) * sizeof(double));
    if (!closes) {
        while (o->row_of[c->row_at[system]] != n_equations + c->pair) {
            c->row_at[system]++;
        }
        work[c->row_at[system] * stride] = 1.0;
        c->lambda_at[system] = o->position[dalcs_stage_unknown(f, n_equations + c->pair)];
        return;
    }
    memset(plan->work.rhs, 0, (size_t)plan->n_rows * sizeof(double));
    int column = n_equations + c->pair;
    for (int k = plan->base.p[column]; k < plan->base.p[column + 1]; k++) {
        plan->work.rhs[plan->base.j[k]] = plan->base.x[k];
    }
    double largest = 0.0;
    for (int i = 0; i < o->n; i++) {
        largest = dalcs_larger(largest, fabs(o->scale[i] * plan->work.rhs[o->row_of[i]]));
    }
    c->column_scale = dalcs_stage_matrix_scale(largest);
    for (int i = 0; i < o->n; i++) {
        work[i * stride] = c->column_scale * o->scale[i] * plan->work.rhs[o->row_of[i]];
    }
}

/* Lists the runs of v[n] with numbers above `least`; first and end may be NULL. */
static int list_runs(const double *v, int n, int stride, double least, int *first, int *end) {
    int n_runs = 0;
    int last = -GAP - 1; /* position of the last one */
    for (int i = 0; i < n; i++) {
        double size = fabs(v[i * stride]);
        size += stride > 1 ? fabs(v[i * stride + 1]) : 0.0;
        if (!(size > least)) {
            continue;
        }
        if (i - last > GAP) {
            if (first != NULL) {
                first[n_runs] = i;
            }
            n_runs++;
        }
        last = i;
        if (end != NULL) {
            end[n_runs - 1] = i + 1;
        }
    }
    return n_runs;
}

static enum dalcs_status keep_response(struct dalcs_stage_change *c, int system, const double *v,
                                       int n, double largest) {
    struct dalcs_stage_response *g = &c->response[system];
    int stride = system > 0 ? 2 : 1;
    double least = dalcs_sum_rounded * dalcs_sum_rounded * largest; /* rounding of rounding */
    g->n_runs = list_runs(v, n, stride, least, NULL, NULL);
    g->first = dalcs_alloc((size_t)g->n_runs, sizeof(int));
    g->end = dalcs_alloc((size_t)g->n_runs, sizeof(int));
    if (g->first == NULL || g->end == NULL) {
        return DALCS_E_NOMEM;
    }
    (void)list_runs(v, n, stride, least, g->first, g->end);
    size_t total = 0;
    for (int k = 0; k < g->n_runs; k++) {
        total += (size_t)((g->end[k] - g->first[k]) * stride);
    }
    g->value = dalcs_alloc(total, sizeof(double));
    if (g->value == NULL) {
        return DALCS_E_NOMEM;
    }
    double *to = g->value;
    for (int k = 0; k < g->n_runs; k++) {
        size_t length = (size_t)((g->end[k] - g->first[k]) * stride);
        memcpy(to, v + g->first[k] * stride, length * sizeof(double));
        to += length;
    }
    c->bytes += total * sizeof(double) + (size_t)g->n_runs * 2 * sizeof(int);
    return DALCS_OK;
}

static enum dalcs_status solve_change(const struct dalcs_stage_plan *plan,
                                      const struct dalcs_stage_factors *f, bool closes,
                                      struct dalcs_stage_change *c) {
    /* An element of G beyond this lets so many digits cancel, where none can be spared. */
    double allowed = fmax(dalcs_beyond, plan->stages->unseen / DBL_EPSILON);
    for (int q = 0; q < f->n_systems; q++) {
        load_change(plan, f, q, closes, c);
        if (q > 0) {
            dalcs_lu_solve_ordered_complex(&f->lu[q]);
        } else {
            dalcs_lu_solve_ordered(&f->lu[q]);
        }
        double largest = largest_of(f->lu[q].work, f->lu[q].n * (q > 0 ? 2 : 1));
        c->largest = fmax(c->largest, largest);
        if (!(largest <= allowed)) {
            c->refused = true;
            return DALCS_OK;
        }
        DALCS_TRY(keep_response(c, q, f->lu[q].work, f->lu[q].n, largest));
    }
    return DALCS_OK;
}

static void change_destroy(struct dalcs_stage_change *c) {
    if (c == NULL) {
        return;
    }
    for (int q = 0; q < DALCS_STAGE_SYSTEMS; q++) {
        free(c->response[q].first);
        free(c->response[q].end);
        free(c->response[q].value);
    }
    free(c->unknown);
    free(c->value);
    free(c);
}

void dalcs_stage_changes_destroy(const struct dalcs_stages *stages,
                                 struct dalcs_stage_change **change) {
    for (int d = 0; change != NULL && d < stages->system->n_pairs; d++) {
        change_destroy(change[d]);
    }
    free(change);
}

static void count_bytes(struct dalcs_stages *stages, struct dalcs_stage_entry *e, size_t bytes) {
    e->bytes += bytes;
    stages->cache.bytes += bytes;
}

enum dalcs_status dalcs_stage_change_get(struct dalcs_stages *stages,
                                         struct dalcs_stage_entry *base, int d,
                                         struct dalcs_stage_change **change) {
    struct dalcs_stage_factors *f = base->factors;
    size_t n_pairs = (size_t)stages->system->n_pairs;
    if (f->change == NULL) {
        f->change = dalcs_alloc(n_pairs, sizeof(*f->change));
        if (f->change == NULL) {
            return DALCS_E_NOMEM;
        }
        count_bytes(stages, base, n_pairs * sizeof(*f->change));
    }
    if (f->change[d] == NULL) {
        struct dalcs_stage_change *c = dalcs_alloc(1, sizeof(*c));
        if (c == NULL) {
            return DALCS_E_NOMEM;
        }
        c->pair = d;
        bool closes = !dalcs_stage_is_on(base, d);
        enum dalcs_status status = closes ? list_terms(stages->system, f, c) : DALCS_OK;
        if (status == DALCS_OK) {
            status = solve_change(stages->plan, f, closes, c);
        }
        if (status != DALCS_OK) {
            change_destroy(c);
            return status;
        }
        f->change[d] = c;
        c->bytes += sizeof(*c) + (size_t)c->n_terms * (sizeof(int) + sizeof(double));
        count_bytes(stages, base, c->bytes);
    }
    *change = f->change[d];
    return DALCS_OK;
}

double dalcs_stage_response_element(const struct dalcs_stage_response *g, int at, int stride,
                                    int part) {
    const double *value = g->value;
    for (int k = 0; k < g->n_runs && at >= g->first[k]; k++) {
        if (at < g->end[k]) {
            return value[(at - g->first[k]) * stride + part];
        }
        value += (g->end[k] - g->first[k]) * stride;
    }
    return 0.0;
}

void dalcs_stage_response_subtract(const struct dalcs_stage_response *g, double nu,
                                   double *restrict work) {
    const double *restrict value = g->value;
    for (int k = 0; k < g->n_runs; k++) {
        for (int i = g->first[k]; i < g->end[k]; i++) {
            work[i] -= nu * *value++;
        }
    }
}

void dalcs_stage_response_subtract_complex(const struct dalcs_stage_response *g, double re,
                                           double im, double *restrict work) {
    const double *restrict value = g->value;
    for (int k = 0; k < g->n_runs; k++) {
        for (int i = g->first[k]; i < g->end[k]; i++, value += 2) {
            work[2 * i] -= re * value[0] - im * value[1];
            work[2 * i + 1] -= re * value[1] + im * value[0];
        }
    }
}

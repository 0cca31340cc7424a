/* stage_map.c - a step of a small system in one mode as one dense matrix.
 *
 * Unknowns are the increments of the states over x_0, z, and lambda of the closed pairs. For each
 * eigenvalue mu the matrix is
 *     S = [mu/h P - A; C_on],     right-hand sides [A; -C_on] x_0 + [E; -F_on] s,
 * balanced by powers of 2 and solved in extended precision. Columns of the map are combinations of the few
 * solutions for unit states and unit inputs. */
#include "dense_map.h"
#include "extended.h"
#include "stages_internal.h"

#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A pivot smaller than this (balanced) asks for a rank decision; kept ones are above 1e-7, those of
 * singular modes below 1e-15. */
static const double doubtful_pivot = 1e-9;
static const double rank_tolerance = 1e-12;

/* What a null vector does to a diode, beside its largest entry, is rounding up to this: currents around a
 * loop of sources are nothing to diodes. */
static const double null_rounding = 1e-10;

enum { BALANCING_ROUNDS = 3 };

struct builder {
    const struct dalcs_stages *stages;
    struct dalcs_stage_entry *entry;
    const struct dalcs_system *system;
    int n, n_x, n_rhs;
    double *row_scale, *column_scale; /* [n] */
    double *base;                     /* [n][n] balanced S without P */
    double *P;                        /* [n_x][n_x] balanced */
    double *rhs;                      /* [n][n_rhs] balanced: unit states, constants, unit waves */
    double *S;                        /* [n][n] the real one, balanced */
    long double *re, *im;             /* [n][n + n_rhs] a system by rows, then its solutions */
    long double *real;                /* [n_rhs][n] solutions of the real one */
    long double *pair_re[DALCS_MAX_CONJUGATES]; /* [n_rhs][n] of the complex ones */
    long double *pair_im[DALCS_MAX_CONJUGATES];
    int nullity;
    double *left, *right; /* [n][nullity] null vectors, balanced */
    double *choice;       /* [nullity][n_pairs] what the other sides of pairs add of them */
    double *node;         /* [s + 1][n] the answer at the nodes */
    long double *exact;   /* [s + 1][n] the same before rounding */
    double *guard;        /* [n_pairs] */
    double *drift;        /* [n] */
    long double *defect;  /* [n] the same before rounding */
    struct dalcs_arena arena;
};

static double *reals(struct builder *b, int n) {
    return dalcs_arena_alloc(&b->arena, (size_t)(n > 0 ? n : 1), sizeof(double));
}

static long double *extendeds(struct builder *b, int n) {
    return dalcs_arena_alloc(&b->arena, (size_t)(n > 0 ? n : 1), sizeof(long double));
}

static bool allocate(struct builder *b) {
    b->row_scale = reals(b, b->n);
    b->column_scale = reals(b, b->n);
    b->base = reals(b, b->n * b->n);
    b->P = reals(b, b->n_x * b->n_x);
    b->rhs = reals(b, b->n * b->n_rhs);
    b->S = reals(b, b->n * b->n);
    b->re = extendeds(b, b->n * (b->n + b->n_rhs));
    b->im = extendeds(b, b->n * (b->n + b->n_rhs));
    b->real = extendeds(b, b->n * b->n_rhs);
    b->node = reals(b, b->n * b->stages->layout.n_nodes);
    b->exact = extendeds(b, b->n * b->stages->layout.n_nodes);
    b->defect = extendeds(b, b->n);
    b->guard = reals(b, b->system->n_pairs);
    b->drift = reals(b, b->n);
    bool complete = b->row_scale != NULL && b->column_scale != NULL && b->base != NULL &&
                    b->P != NULL && b->rhs != NULL && b->S != NULL && b->real != NULL &&
                    b->re != NULL && b->im != NULL && b->node != NULL && b->guard != NULL &&
                    b->drift != NULL && b->exact != NULL && b->defect != NULL;
    for (int p = 0; p < b->stages->method->n_pairs; p++) {
        b->pair_re[p] = extendeds(b, b->n * b->n_rhs);
        b->pair_im[p] = extendeds(b, b->n * b->n_rhs);
        complete = complete && b->pair_re[p] != NULL && b->pair_im[p] != NULL;
    }
    return complete;
}

/* Column of a system's column in the unknowns; -1 for an open pair. */
static void place_columns(const struct builder *b, int *place) {
    int n_equations = dalcs_system_n_equations(b->system);
    for (int c = 0; c < n_equations; c++) {
        place[c] = c;
    }
    for (int d = 0; d < b->system->n_pairs; d++) {
        place[n_equations + d] = -1;
    }
    for (int k = 0; k < b->entry->n_on; k++) {
        place[n_equations + b->entry->on[k]] = n_equations + k;
    }
}

/* Adds sign * row of a matrix to a row of the base and, for its states, to the right-hand sides with
 * the opposite sign. */
static void add_row(const struct builder *b, const struct dalcs_csr *a, int from, int to,
                    const int *place, double sign) {
    for (int k = a->p[from]; k < a->p[from + 1]; k++) {
        int column = place[a->j[k]];
        if (column < 0) {
            continue;
        }
        b->base[column * b->n + to] += sign * a->x[k];
        if (column < b->n_x) {
            b->rhs[column * b->n + to] -= sign * a->x[k];
        }
    }
}

/* Right-hand side column of an input that varies; the constants share one. */
static int column_of_input(const struct builder *b, int input) {
    const struct dalcs_excitation *e = b->stages->excitation;
    for (int w = 0; w < e->n_waves; w++) {
        if (e->wave[w].input == input) {
            return b->n_x + 1 + w;
        }
    }
    return -1;
}

static void add_inputs(const struct builder *b, const struct dalcs_csr *a, int from, int to,
                       double sign) {
    for (int k = a->p[from]; k < a->p[from + 1]; k++) {
        int wave = column_of_input(b, a->j[k]);
        if (wave >= 0) {
            b->rhs[wave * b->n + to] += sign * a->x[k];
        } else {
            b->rhs[b->n_x * b->n + to] += sign * a->x[k] * b->stages->excitation->constant[a->j[k]];
        }
    }
}

static bool fill(struct builder *b) {
    const struct dalcs_system *s = b->system;
    int n_equations = dalcs_system_n_equations(s);
    int *place =
        dalcs_arena_alloc(&b->arena, (size_t)dalcs_system_n_columns(s) + 1, sizeof(*place));
    if (place == NULL) {
        return false;
    }
    place_columns(b, place);
    for (int r = 0; r < n_equations; r++) {
        add_row(b, &s->A, r, r, place, -1.0);
        add_inputs(b, &s->E, r, r, 1.0);
    }
    for (int k = 0; k < b->entry->n_on; k++) {
        add_row(b, &s->C, b->entry->on[k], n_equations + k, place, 1.0);
        add_inputs(b, &s->F, b->entry->on[k], n_equations + k, -1.0);
    }
    for (int i = 0; i < b->n_x; i++) {
        for (int k = s->P.p[i]; k < s->P.p[i + 1]; k++) {
            b->P[s->P.j[k] * b->n_x + i] = s->P.x[k];
        }
    }
    return true;
}

static double power_of_2(double largest) {
    int exponent;
    (void)frexp(largest, &exponent);
    return largest > 0.0 && isfinite(largest) ? ldexp(1.0, -exponent) : 1.0;
}

/* Rows and columns of |S| at the real eigenvalue get a largest entry near 1. */
static void balance(struct builder *b) {
    int n = b->n;
    double sigma = b->stages->method->lambda / b->entry->h;
    for (int i = 0; i < n; i++) {
        b->row_scale[i] = 1.0;
        b->column_scale[i] = 1.0;
    }
    memcpy(b->S, b->base, (size_t)n * (size_t)n * sizeof(double));
    for (int j = 0; j < b->n_x; j++) {
        for (int i = 0; i < b->n_x; i++) {
            b->S[j * n + i] += sigma * b->P[j * b->n_x + i];
        }
    }
    for (int round = 0; round < BALANCING_ROUNDS; round++) {
        for (int i = 0; i < n; i++) {
            double largest = 0.0;
            for (int j = 0; j < n; j++) {
                largest = fmax(largest, fabs(b->S[j * n + i]) * b->column_scale[j]);
            }
            b->row_scale[i] = power_of_2(largest);
        }
        for (int j = 0; j < n; j++) {
            double largest = 0.0;
            for (int i = 0; i < n; i++) {
                largest = fmax(largest, fabs(b->S[j * n + i]) * b->row_scale[i]);
            }
            b->column_scale[j] = power_of_2(largest);
        }
    }
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            double scale = b->row_scale[i] * b->column_scale[j];
            b->base[j * n + i] *= scale;
            b->S[j * n + i] *= scale;
            if (j < b->n_x && i < b->n_x) {
                b->P[j * b->n_x + i] *= scale;
            }
        }
    }
    memcpy(b->entry->natural, b->column_scale,
           (size_t)dalcs_system_n_equations(b->system) * sizeof(double));
    for (int j = 0; j < b->n_rhs; j++) {
        for (int i = 0; i < n; i++) {
            b->rhs[j * n + i] *= b->row_scale[i];
        }
    }
}

/* Null vectors of S from a rank-revealing QR. They have no state in them, so they belong to every
 * eigenvalue and step. */
static enum dalcs_status find_null_space(struct builder *b, const double *S) {
    int n = b->n;
    double *qr = reals(b, n * n);
    double *tau = reals(b, n);
    lapack_int *order = dalcs_arena_alloc(&b->arena, (size_t)n, sizeof(*order));
    if (qr == NULL || tau == NULL || order == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(qr, S, (size_t)n * (size_t)n * sizeof(double));
    if (LAPACKE_dgeqp3(LAPACK_COL_MAJOR, n, n, qr, n, order, tau) != 0) {
        return DALCS_E_NOMEM;
    }
    int rank = 0;
    while (rank < n && fabs(qr[rank * n + rank]) > rank_tolerance * fabs(qr[0])) {
        rank++;
    }
    b->nullity = n - rank;
    if (b->nullity == 0) {
        return DALCS_OK;
    }
    b->left = reals(b, n * b->nullity);
    b->right = reals(b, n * b->nullity);
    if (b->left == NULL || b->right == NULL) {
        return DALCS_E_NOMEM;
    }
    if (rank > 0) {
        (void)LAPACKE_dtrtrs(LAPACK_COL_MAJOR, 'U', 'N', 'N', rank, b->nullity, qr, n,
                             qr + rank * n, n);
    }
    for (int k = 0; k < b->nullity; k++) {
        double *v = b->right + k * n;
        for (int i = 0; i < rank; i++) {
            v[order[i] - 1] = -qr[(rank + k) * n + i];
        }
        v[order[rank + k] - 1] = 1.0;
        for (int x = 0; x < b->n_x; x++) {
            v[x] = 0.0;
        }
    }
    if (LAPACKE_dorgqr(LAPACK_COL_MAJOR, n, n, n, qr, n, tau) != 0) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < b->nullity; k++) {
        for (int i = 0; i < n; i++) {
            b->left[k * n + i] = i < b->n_x ? 0.0 : qr[(rank + k) * n + i];
        }
    }
    return DALCS_OK;
}

/* With left right^T added, S is regular and its solutions, where there are any, are those of S that
 * have nothing of the null vectors. */
static double border(const struct builder *b, int i, int j) {
    double sum = 0.0;
    for (int k = 0; k < b->nullity; k++) {
        sum += b->left[k * b->n + i] * b->right[k * b->n + j];
    }
    return sum;
}

/* The system at sigma, with its right-hand sides. */
static void fill_system(const struct builder *b, long double re, long double im) {
    int n = b->n;
    int width = n + b->n_rhs;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < width; j++) {
            long double value = j < n ? b->base[j * n + i] : b->rhs[(j - n) * n + i];
            long double imaginary = 0.0L;
            if (i < b->n_x && j < b->n_x) {
                value += re * b->P[j * b->n_x + i];
                imaginary = im * b->P[j * b->n_x + i];
            }
            if (b->nullity > 0 && j < n) {
                value += border(b, i, j);
            }
            b->re[i * width + j] = value;
            b->im[i * width + j] = imaginary;
        }
    }
}

static void take_solutions(const struct builder *b, const long double *from, long double *to) {
    for (int j = 0; j < b->n_rhs; j++) {
        for (int i = 0; i < b->n; i++) {
            to[j * b->n + i] = from[i * (b->n + b->n_rhs) + b->n + j];
        }
    }
}

static enum dalcs_status solve_real(struct builder *b) {
    long double sigma = b->stages->method->exact_lambda / b->entry->h;
    fill_system(b, sigma, 0.0L);
    long double pivot = dalcs_extended_solve(b->n, b->n_rhs, b->re, NULL);
    if (pivot < doubtful_pivot) {
        DALCS_TRY(find_null_space(b, b->S));
        fill_system(b, sigma, 0.0L);
        pivot = dalcs_extended_solve(b->n, b->n_rhs, b->re, NULL);
    }
    take_solutions(b, b->re, b->real);
    return pivot > 0.0L ? DALCS_OK : DALCS_SINGULAR;
}

static enum dalcs_status solve_pair(struct builder *b, int p) {
    long double complex sigma = b->stages->method->exact_mu[p] / b->entry->h;
    fill_system(b, creall(sigma), cimagl(sigma));
    long double pivot = dalcs_extended_solve(b->n, b->n_rhs, b->re, b->im);
    take_solutions(b, b->re, b->pair_re[p]);
    take_solutions(b, b->im, b->pair_im[p]);
    return pivot > 0.0L ? DALCS_OK : DALCS_SINGULAR;
}

/* The other side of pair d: lambda where it is closed, w where it is open, from unknowns and from the
 * share of the source column (wave < 0: none) at this node. */
static double other_side(const struct builder *b, int d, const double *y, int rhs_column,
                         double share) {
    const struct dalcs_system *s = b->system;
    int n_equations = dalcs_system_n_equations(s);
    double w = 0.0;
    for (int k = s->C.p[d]; k < s->C.p[d + 1]; k++) {
        int c = s->C.j[k];
        if (c < n_equations) {
            w += s->C.x[k] * y[c];
        } else {
            for (int on = 0; on < b->entry->n_on; on++) {
                w += b->entry->on[on] == c - n_equations ? s->C.x[k] * y[n_equations + on] : 0.0;
            }
        }
    }
    for (int k = s->F.p[d]; k < s->F.p[d + 1]; k++) {
        int wave = column_of_input(b, s->F.j[k]);
        if (wave == rhs_column && wave >= 0) {
            w += s->F.x[k] * share;
        } else if (wave < 0 && rhs_column == b->n_x) {
            w += s->F.x[k] * share * b->stages->excitation->constant[s->F.j[k]];
        }
    }
    return w;
}

static void find_guards(const struct builder *b, const double *y, int rhs_column, double share) {
    int n_equations = dalcs_system_n_equations(b->system);
    for (int d = 0; d < b->system->n_pairs; d++) {
        b->guard[d] = 0.0;
        if (!dalcs_stage_is_on(b->entry, d) && b->system->pair[d].kind == DALCS_PAIR_DIODE) {
            b->guard[d] = other_side(b, d, y, rhs_column, share);
        }
    }
    for (int k = 0; k < b->entry->n_on; k++) {
        b->guard[b->entry->on[k]] = y[n_equations + k];
    }
}

/* choice = - pseudoinverse of the guards of the null vectors: adding choice * guards of them makes the
 * diodes' lambda and w as small as possible. Diodes only: a switch's current is a wire's. */
static enum dalcs_status prepare_choice(struct builder *b) {
    int n_pairs = b->system->n_pairs;
    int rows = n_pairs > b->nullity ? n_pairs : b->nullity;
    if (b->nullity == 0 || n_pairs == 0) {
        return DALCS_OK;
    }
    double *guards = reals(b, n_pairs * b->nullity);
    double *identity = reals(b, rows * n_pairs);
    double *singular = reals(b, b->nullity + n_pairs);
    b->choice = reals(b, b->nullity * n_pairs);
    if (guards == NULL || identity == NULL || singular == NULL || b->choice == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < b->nullity; k++) {
        double largest = 0.0;
        for (int i = 0; i < b->n; i++) {
            b->right[k * b->n + i] *= b->column_scale[i];
            largest = fmax(largest, fabs(b->right[k * b->n + i]));
        }
        for (int i = 0; i < b->n; i++) {
            b->right[k * b->n + i] /= largest;
        }
        find_guards(b, b->right + k * b->n, -1, 0.0);
        for (int d = 0; d < n_pairs; d++) {
            guards[k * n_pairs + d] = fabs(b->guard[d]) > null_rounding ? b->guard[d] : 0.0;
        }
    }
    for (int d = 0; d < n_pairs; d++) {
        identity[d * rows + d] = 1.0;
    }
    lapack_int rank;
    if (LAPACKE_dgelss(LAPACK_COL_MAJOR, n_pairs, b->nullity, n_pairs, guards, n_pairs, identity,
                       rows, singular, 1e-10, &rank) != 0) {
        return DALCS_E_NOMEM;
    }
    for (int d = 0; d < n_pairs; d++) {
        for (int k = 0; k < b->nullity; k++) {
            b->choice[k * n_pairs + d] = -identity[d * rows + k];
        }
    }
    return DALCS_OK;
}

static void choose(const struct builder *b, double *y, int rhs_column, double share) {
    find_guards(b, y, rhs_column, share);
    for (int k = 0; k < b->nullity && b->choice != NULL; k++) {
        double amount = 0.0;
        for (int d = 0; d < b->system->n_pairs; d++) {
            amount += b->choice[k * b->system->n_pairs + d] * b->guard[d];
        }
        for (int i = 0; i < b->n; i++) {
            y[i] += amount * b->right[k * b->n + i];
        }
    }
    if (b->nullity > 0) {
        find_guards(b, y, rhs_column, share);
    }
}

/* Unknowns y to the columns of the system, b->guard in the place of lambda. */
static void put_columns(const struct builder *b, const double *y, double *out) {
    int n_equations = dalcs_system_n_equations(b->system);
    memcpy(out, y, (size_t)n_equations * sizeof(double));
    memcpy(out + n_equations, b->guard, (size_t)b->system->n_pairs * sizeof(double));
}

/* A watched voltage from columns and the share of a source. */
static double watched_voltage(const struct builder *b, int d, const double *columns, int rhs_column,
                              double share) {
    const struct dalcs_system *s = b->system;
    int n_equations = dalcs_system_n_equations(s);
    double v = 0.0;
    if (!s->pair[d].is_direct) {
        for (int k = s->control.p[d]; k < s->control.p[d + 1]; k++) {
            int c = s->control.j[k];
            bool open = c >= n_equations && !dalcs_stage_is_on(b->entry, c - n_equations);
            v += open ? 0.0 : s->control.x[k] * columns[c];
        }
        return v;
    }
    for (int k = s->direct_control.p[d]; k < s->direct_control.p[d + 1]; k++) {
        int wave = column_of_input(b, s->direct_control.j[k]);
        if (wave >= 0 && wave == rhs_column) {
            v += s->direct_control.x[k] * share;
        } else if (wave < 0 && rhs_column == b->n_x) {
            v += s->direct_control.x[k] * b->stages->excitation->constant[s->direct_control.j[k]];
        }
    }
    return v;
}

/* One column of the map: the answer to in[column] = 1. share[s + 1] and test_share are the values of
 * the source there; for a state they are 0. */
static void fill_column(struct builder *b, int column, int rhs_column, const double *share,
                        double test_share, double *out) {
    const struct dalcs_collocation *m = b->stages->method;
    const struct dalcs_stage_layout *l = &b->stages->layout;
    const struct dalcs_system *s = b->system;
    int n = b->n;
    int n_equations = dalcs_system_n_equations(s);
    bool is_state = column < b->n_x;
    long double weight = is_state ? 1.0L : 0.0L;
    long double complex pair_weight[DALCS_MAX_CONJUGATES];
    for (int q = 0; q < m->s; q++) {
        weight += m->exact_from[q] * share[q + 1];
    }
    for (int p = 0; p < m->n_pairs; p++) {
        pair_weight[p] = is_state ? 1.0L : 0.0L;
        for (int q = 0; q < m->s; q++) {
            pair_weight[p] += m->exact_from_pair[p][q] * share[q + 1];
        }
    }
    const long double *real = b->real + rhs_column * n;
    for (int i = 1; i <= m->s; i++) {
        long double *y = b->exact + i * n;
        long double real_factor = m->exact_to[i - 1] * weight;
        long double re[DALCS_MAX_CONJUGATES];
        long double im[DALCS_MAX_CONJUGATES];
        for (int p = 0; p < m->n_pairs; p++) {
            long double complex factor = m->exact_to_pair[i - 1][p] * pair_weight[p];
            re[p] = 2.0L * creall(factor);
            im[p] = 2.0L * cimagl(factor);
        }
        for (int r = 0; r < n; r++) {
            int at = rhs_column * n + r;
            long double sum = real_factor * real[r];
            for (int p = 0; p < m->n_pairs; p++) {
                sum += re[p] * b->pair_re[p][at] - im[p] * b->pair_im[p][at];
            }
            y[r] = sum * b->column_scale[r] + (is_state && r == column ? 1.0L : 0.0L);
        }
    }
    /* How far the polynomial through the stages alone misses the start, and what the filter makes
     * of it. */
    long double source_drift = share[0];
    for (int i = 1; i <= m->s; i++) {
        source_drift -= m->exact_back[i - 1] * share[i];
    }
    long double *start = b->exact;
    for (int r = 0; r < n; r++) {
        start[r] = 0.0L;
        for (int i = 1; i <= m->s; i++) {
            start[r] += m->exact_back[i - 1] * b->exact[i * n + r];
        }
        b->defect[r] = is_state ? 0.0L : real[r] * source_drift;
    }
    for (int x = 0; x < b->n_x; x++) {
        long double missed = (x == column ? 1.0L : 0.0L) - start[x];
        for (int r = 0; r < n && missed != 0.0L; r++) {
            b->defect[r] += b->real[x * n + r] * missed;
        }
        start[x] = x == column ? 1.0L : 0.0L;
    }
    for (int r = 0; r < n; r++) {
        b->defect[r] *= b->column_scale[r];
        b->drift[r] = (double)b->defect[r];
        start[r] += r < b->n_x ? 0.0L : b->defect[r];
    }
    /* What was added goes with states that are off by the defect: take that back as well. */
    for (int x = 0; x < b->n_x; x++) {
        for (int r = b->n_x; r < n; r++) {
            start[r] -= b->real[x * n + r] * b->column_scale[r] * b->defect[x];
        }
    }
    for (int i = 0; i < (m->s + 1) * n; i++) {
        b->node[i] = (double)b->exact[i];
    }
    for (int k = 0; k <= m->s; k++) {
        double *columns = out + k * l->stride;
        choose(b, b->node + k * n, rhs_column, is_state ? 0.0 : share[k]);
        put_columns(b, b->node + k * n, columns);
        for (int i = 0; i < b->stages->n_watched; i++) {
            columns[dalcs_system_n_columns(s) + i] = watched_voltage(
                b, b->stages->watched[i], columns, rhs_column, is_state ? 0.0 : share[k]);
        }
    }
    memcpy(out + l->drift, b->drift, (size_t)b->n_x * sizeof(double));
    if (b->stages->excitation->is_curved && !is_state) {
        double missed = test_share;
        for (int k = 0; k <= m->s; k++) {
            missed -= m->test[k] * share[k];
        }
        for (int r = 0; r < n; r++) {
            b->drift[r] = (double)real[r] * b->column_scale[r] * missed * m->test_factor;
        }
        find_guards(b, b->drift, rhs_column, missed);
        put_columns(b, b->drift, out + l->ripple);
    }
    for (int k = 0; k < b->nullity; k++) {
        double clash = 0.0;
        for (int i = n_equations - s->n_z; i < n && !is_state; i++) {
            clash += b->left[k * n + i] * b->rhs[rhs_column * n + i];
        }
        for (int i = 1; i <= m->s; i++) {
            out[l->n_fixed + k * m->s + i - 1] = clash * share[i];
        }
    }
}

/* How well the rounded answer at the last stage satisfies the equations without derivatives, in
 * balanced units. In a singular mode sources may disagree, which is for the clashes to tell. */
static void check_column(struct builder *b, int column, int rhs_column, double share) {
    const double *y = b->node + b->stages->method->s * b->n;
    bool is_state = column < b->n_x;
    /* what a state of 1 is in balanced units: where it stays as it is all else is rounding of that */
    double largest = is_state ? 1.0 / b->column_scale[column] : 0.0;
    double worst = 0.0;
    for (int r = b->n_x; r < b->n && (b->nullity == 0 || is_state); r++) {
        double drive = b->rhs[rhs_column * b->n + r];
        double residual = -drive * (is_state ? 1.0 : share);
        largest = fmax(largest, fabs(drive)); /* a sine may be near 0 just there */
        for (int c = 0; c < b->n; c++) {
            double increment = y[c] - (is_state && c == column ? 1.0 : 0.0);
            double term = b->base[c * b->n + r] * increment / b->column_scale[c];
            residual += term;
            largest = fmax(largest, fabs(term));
        }
        worst = fmax(worst, fabs(residual));
    }
    b->entry->residual = fmax(b->entry->residual, largest > 0.0 ? worst / largest : 0.0);
}

static void fill_map(struct builder *b) {
    const struct dalcs_excitation *e = b->stages->excitation;
    const struct dalcs_collocation *m = b->stages->method;
    double share[DALCS_MAX_NODES] = {0.0};
    double *out = b->entry->map;
    for (int x = 0; x < b->n_x; x++, out += b->entry->rows) {
        fill_column(b, x, x, share, 0.0, out);
        check_column(b, x, x, 0.0);
    }
    for (int k = 0; k <= m->s; k++) {
        share[k] = 1.0;
    }
    fill_column(b, b->n_x, b->n_x, share, 1.0, out);
    check_column(b, b->n_x, b->n_x, 1.0);
    out += b->entry->rows;
    for (int f = 0; f < e->n_functions; f++, out += b->entry->rows) {
        const struct dalcs_excitation_function *function = &e->function[f];
        for (int k = 0; k <= m->s; k++) {
            share[k] = dalcs_excitation_function_at(function, b->entry->h, m->node[k]);
        }
        int rhs_column = column_of_input(b, function->input);
        fill_column(b, b->n_x + 1 + f, rhs_column, share,
                    dalcs_excitation_function_at(function, b->entry->h, m->test_node), out);
        check_column(b, b->n_x + 1 + f, rhs_column, share[m->s]);
    }
}

static enum dalcs_status build(struct builder *b) {
    if (!allocate(b) || !fill(b)) {
        return DALCS_E_NOMEM;
    }
    balance(b);
    if (b->n > 0) {
        DALCS_TRY(solve_real(b));
        for (int p = 0; p < b->stages->method->n_pairs; p++) {
            DALCS_TRY(solve_pair(b, p));
        }
        DALCS_TRY(prepare_choice(b));
    }
    struct dalcs_stage_entry *e = b->entry;
    e->n_clashes = b->nullity * b->stages->method->s;
    e->rows = dalcs_dense_map_rows(b->stages->layout.n_fixed + e->n_clashes);
    e->map = dalcs_dense_map_alloc(e->rows, b->stages->n_in);
    if (e->map == NULL) {
        return DALCS_E_NOMEM;
    }
    e->bytes += (size_t)e->rows * (size_t)b->stages->n_in * sizeof(double);
    fill_map(b);
    return DALCS_OK;
}

enum dalcs_status dalcs_stage_map_build(struct dalcs_stages *stages,
                                        struct dalcs_stage_entry *entry) {
    struct builder b = {.stages = stages,
                        .entry = entry,
                        .system = stages->system,
                        .n = entry->n,
                        .n_x = stages->system->n_x,
                        .n_rhs = stages->system->n_x + 1 + stages->excitation->n_waves};
    enum dalcs_status status = build(&b);
    dalcs_arena_finish(&b.arena);
    return status;
}

void dalcs_stage_map_apply(const struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                           const double *in, double *out) {
    dalcs_dense_map_apply(entry->rows, stages->n_in, entry->map, in, out);
}

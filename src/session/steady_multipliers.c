/* steady_multipliers.c - the eigenvalues of the monodromy matrix, and the state that has most of each eigenvector. */
#include "steady.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Smaller than this beside 1 is none: nothing of it is left after one period. */
static const double vanishes = 1e-12;

/* "q(a1)": of the memory of gates. */
static const char *name_of_number(struct dalcs_steady *st, int number) {
    static const char *const what[] = {
        [DALCS_NUMBER_PIN] = "q", [DALCS_NUMBER_TAKEN] = "sample", [DALCS_NUMBER_PULSE] = "pulse"};
    int gate;
    const enum dalcs_logic_number kind = dalcs_logic_number_kind(&st->layout.memory, number, &gate);
    return kind == DALCS_NUMBER_DUE
               ? "an edge on its way"
               : dalcs_arena_printf(&st->run->s->arena, "%s(%s)", what[kind],
                                    st->run->s->circuit.control.gate[gate].name);
}

const char *dalcs_steady_name(struct dalcs_steady *st, int state) {
    const struct dalcs_network *n = &st->run->s->network;
    int k = 0;
    if (state >= st->layout.n_states) {
        return name_of_number(st, state - st->layout.n_states);
    }
    while (state >= st->layout.first[k + 1]) {
        k++;
    }
    const struct dalcs_system *s = &n->system[k];
    const int x = state - st->layout.first[k];
    for (int i = 0; i < n->n_states; i++) { /* a capacitor or coil, whose state it is */
        const struct dalcs_probe *p = &n->state[i].probe;
        if (p->system == k && p->n_terms == 1 && p->n_inputs == 0 && p->term[0].index == x) {
            return dalcs_arena_printf(&st->run->s->arena, "%s(%s)",
                                      n->state[i].is_current ? "i" : "v", n->state[i].element);
        }
    }
    return s->column[x].element;
}

static int compare_size(const void *one, const void *other) {
    const struct dalcs_floquet *a = one;
    const struct dalcs_floquet *b = other;
    double difference = hypot(b->re, b->im) - hypot(a->re, a->im);
    if (fabs(difference) <= dalcs_steady_near_one) { /* conjugates stay together */
        difference = b->im - a->im;
    }
    return difference > 0.0 ? 1 : difference < 0.0 ? -1 : 0;
}

/* The state that has most of an eigenvector, by its energy. */
static int largest_entry(const struct dalcs_steady *st, int first, int n, const double *re,
                         const double *im) {
    int largest = 0;
    double most = -1.0;
    for (int x = 0; x < n; x++) {
        double size = hypot(re[x], im != NULL ? im[x] : 0.0) /
                      (st->scale[first + x] > 0.0 ? st->scale[first + x] : 1.0);
        largest = size > most ? x : largest;
        most = fmax(most, size);
    }
    return first + largest;
}

static enum dalcs_status multipliers_of(struct dalcs_steady *st, int system,
                                        struct dalcs_floquet *multiplier, size_t *n_all,
                                        struct dalcs_arena *arena) {
    const int first = st->layout.first[system];
    const int n = st->layout.first[system + 1] - first;
    const size_t square = (size_t)n * (size_t)n;
    double *A = dalcs_arena_alloc(arena, square, sizeof(double));
    double *vector = dalcs_arena_alloc(arena, square, sizeof(double));
    double *value = dalcs_arena_alloc(arena, 2 * (size_t)n, sizeof(double));
    if (A == NULL || vector == NULL || value == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(A, st->pass.M + st->layout.first_of_M[system], square * sizeof(double));
    if (n == 0) {
        return DALCS_OK;
    }
    const int failed =
        LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'V', n, A, n, value, value + n, NULL, 1, vector, n);
    if (failed != 0) {
        return failed == LAPACK_WORK_MEMORY_ERROR ? DALCS_E_NOMEM : DALCS_NOT_CONVERGED;
    }
    for (int k = 0; k < n; k++) {
        const double *v = vector + (size_t)k * (size_t)n;
        const double im = value[n + k];
        int state = im == 0.0  ? largest_entry(st, first, n, v, NULL)
                    : im > 0.0 ? largest_entry(st, first, n, v, v + n)
                               : largest_entry(st, first, n, v - n, v);
        multiplier[(*n_all)++] =
            (struct dalcs_floquet){.re = value[k], .im = im, .state = dalcs_steady_name(st, state)};
    }
    return DALCS_OK;
}

size_t dalcs_steady_count_lasting(const struct dalcs_floquet *m, size_t n) {
    size_t lasting = 0;
    while (lasting < n && hypot(m[lasting].re, m[lasting].im) > vanishes) {
        lasting++;
    }
    return lasting;
}

double dalcs_steady_take_out_flow(struct dalcs_floquet *m, size_t *n) {
    size_t flow = 0;
    for (size_t k = 1; k < *n; k++) {
        if (hypot(m[k].re - 1.0, m[k].im) < hypot(m[flow].re - 1.0, m[flow].im)) {
            flow = k;
        }
    }
    if (*n == 0) {
        return 0.0;
    }
    const double is = m[flow].re;
    memmove(m + flow, m + flow + 1, (*n - flow - 1) * sizeof(*m));
    --*n;
    return is;
}

enum dalcs_status dalcs_steady_find_multipliers(struct dalcs_steady *st,
                                                struct dalcs_floquet **found, size_t *n) {
    struct dalcs_arena work = {0};
    struct dalcs_floquet *m =
        dalcs_arena_alloc(&st->run->s->arena, (size_t)st->layout.n_x + 1, sizeof(*m));
    enum dalcs_status status = m != NULL ? DALCS_OK : DALCS_E_NOMEM;
    *n = 0;
    for (int k = 0; k < st->layout.n_systems && status == DALCS_OK; k++) {
        status = multipliers_of(st, k, m, n, &work);
    }
    dalcs_arena_finish(&work);
    DALCS_TRY(status);
    qsort(m, *n, sizeof(*m), compare_size);
    *found = m;
    return DALCS_OK;
}

double dalcs_steady_largest_multiplier(struct dalcs_steady *st) {
    struct dalcs_floquet *m;
    size_t n;
    if (dalcs_steady_find_multipliers(st, &m, &n) != DALCS_OK) {
        return 0.0;
    }
    if (st->own.is_free) {
        (void)dalcs_steady_take_out_flow(m, &n);
    }
    return n > 0 ? hypot(m[0].re, m[0].im) : 0.0;
}

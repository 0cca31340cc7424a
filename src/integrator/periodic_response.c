/* periodic_response.c - small signals through the pieces of a period. */
#include "periodic_response.h"
#include "pi.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

/* ---- Integrals of polynomials times exp(-j kappa theta) ------------------------------------------ */

/* j[n] = spherical Bessel functions j_k(x), by Miller's recurrence downward where x is small against n, else upward
 * (Abramowitz and Stegun, 10.5). */
static void spherical_bessel(int n, double x, double *j) {
    enum { AHEAD = 40 };

    const double first = fabs(x) < 1e-8 ? 1.0 : sin(x) / x;
    if (x > n) {
        double before = cos(x) / x; /* j_-1 */
        j[0] = first;
        for (int k = 0; k + 1 < n; k++) {
            j[k + 1] = (2 * k + 1) / x * j[k] - before;
            before = j[k];
        }
        return;
    }
    if (x < 1e-30) {
        for (int k = 0; k < n; k++) {
            j[k] = k == 0 ? 1.0 : 0.0;
        }
        return;
    }
    double above = 0.0;
    double now = 1e-300;
    for (int k = n + AHEAD; k >= 0; k--) {
        if (k < n) {
            j[k] = now;
        }
        double below = (2 * k + 1) / x * now - above;
        above = now;
        now = below;
        if (fabs(now) > 1e200) { /* what is above then counts for nothing, unless it is asked for */
            now *= 1e-200;
            above *= 1e-200;
            for (int i = k < n ? k : n; i < n; i++) {
                j[i] *= 1e-200;
            }
        }
    }
    /* j_0 may be 0 where j_1 is not */
    double j1 = x < 1e-2 ? x / 3.0 * (1.0 - x * x / 10.0) : (sin(x) / x - cos(x)) / x;
    double scale = fabs(first) >= fabs(j1) || n < 2 ? first / j[0] : j1 / j[1];
    for (int k = 0; k < n; k++) {
        j[k] *= scale;
    }
}

/* weight[n_nodes] such that the integral over theta of a quantity times exp(-j kappa theta) is the sum of weight *
 * value at node. */
static void mean_weights(const struct dalcs_periodic_flow *flow, double kappa,
                         double complex *weight) {
    static const double complex minus_j[4] = {1.0, -I, -1.0, I};
    const int n = flow->stages.layout.n_nodes;
    const double half = 0.5 * fabs(kappa);
    double j[DALCS_MAX_NODES];
    double complex moment[DALCS_MAX_NODES];
    spherical_bessel(n, half, j);
    for (int k = 0; k < n; k++) {
        moment[k] = minus_j[k % 4] * cexp(-I * half) * j[k];
        moment[k] = kappa < 0.0 ? conj(moment[k]) : moment[k];
    }
    for (int i = 0; i < n; i++) {
        weight[i] = 0.0;
        for (int k = 0; k < n; k++) {
            weight[i] += flow->legendre[k][i] * moment[k];
        }
    }
}

/* ---- Maps at a frequency ------------------------------------------------------------------------- */

/* What sources make of an answer row by row, from states of 0 and at the phase 0 where a piece begins. */
static void find_driven(const struct dalcs_periodic_response *r, struct dalcs_flow_map *map,
                        double w) {
    const struct dalcs_periodic_flow *flow = r->flow;
    const size_t size = dalcs_periodic_flow_size(flow);
    double complex coefficient[DALCS_MAX_NODES];
    dalcs_periodic_flow_drive(flow, w * map->h, coefficient);
    for (size_t i = 0; i < size; i++) {
        map->driven[i] = 0.0;
    }
    for (int k = 0; k < flow->stages.layout.n_nodes && flow->excitation.n_functions > 0; k++) {
        const double complex *drive = map->drive + (size_t)k * size;
        for (size_t i = 0; i < size; i++) {
            map->driven[i] += coefficient[k] * drive[i];
        }
    }
}

/* In the place of an open pair's current is its w, which is none of it. */
static bool is_open(const struct dalcs_flow_map *map, const struct dalcs_system *s, int column) {
    const int pair = column - dalcs_system_n_equations(s);
    return pair >= 0 && !dalcs_mode_has(map->mode, pair);
}

static void find_means(const struct dalcs_periodic_response *r, struct dalcs_flow_map *map,
                       double w) {
    const struct dalcs_periodic_flow *flow = r->flow;
    const int n = flow->stages.layout.n_nodes;
    const int stride = flow->stages.layout.stride;
    double complex weight[DALCS_MAX_NODES];
    mean_weights(flow, w * map->h, weight);
    for (int k = 0; k <= flow->n_x; k++) {
        const double *state = map->state + (size_t)k * dalcs_periodic_flow_size(flow);
        double complex *mean = map->mean + (size_t)k * (size_t)r->n_read;
        for (int m = 0; m < r->n_read; m++) {
            double complex sum = 0.0;
            for (int i = 0; i < n && !is_open(map, flow->system, r->read[m]); i++) {
                const int at = i * stride + r->read[m];
                sum += weight[i] * (k < flow->n_x ? state[at] : map->driven[at]);
            }
            mean[m] = sum;
        }
    }
}

/* ---- Through the period -------------------------------------------------------------------------- */

static void begin_piece(struct dalcs_periodic_response *r, const struct dalcs_flow_piece *piece,
                        double complex phase) {
    const int n_x = r->flow->n_x;
    for (int x = 0; x < n_x; x++) {
        double complex sum = piece->start->by_source[x] * phase;
        for (int k = 0; k < n_x; k++) {
            sum += piece->start->P[k * n_x + x] * r->now[k];
        }
        r->next[x] = sum;
    }
    memcpy(r->now, r->next, (size_t)n_x * sizeof *r->now);
}

/* One row where the piece ends. */
static double complex at_end(const struct dalcs_periodic_response *r,
                             const struct dalcs_flow_map *map, double complex phase, int row) {
    const struct dalcs_periodic_flow *flow = r->flow;
    const struct dalcs_stage_layout *l = &flow->stages.layout;
    const size_t at = (size_t)(l->n_nodes - 1) * (size_t)l->stride + (size_t)row;
    double complex sum = phase * map->driven[at];
    for (int k = 0; k < flow->n_x; k++) {
        sum += r->now[k] * map->state[(size_t)k * dalcs_periodic_flow_size(flow) + at];
    }
    return sum;
}

/* y += what the piece has of them, with the phase that they are taken at where it begins. */
static void add_means(struct dalcs_periodic_response *r, const struct dalcs_flow_map *map,
                      double complex phase, double complex taken) {
    const int n_x = r->flow->n_x;
    const double complex part = taken * (map->h / r->flow->period);
    for (int k = 0; k <= n_x; k++) {
        const double complex factor = part * (k < n_x ? r->now[k] : phase);
        const double complex *mean = map->mean + (size_t)k * (size_t)r->n_read;
        for (int m = 0; m < r->n_read; m++) {
            r->y[r->read[m]] += factor * mean[m];
        }
    }
}

static double complex turn(double w, double t) {
    return cexp(I * fmod(w * t, dalcs_two_pi));
}

/* From r->now at the start to what it is at the end of the period. means: r->y grows, with everything at w + of. */
static void go_through(struct dalcs_periodic_response *r, double w, double other, bool means) {
    const struct dalcs_periodic_flow *flow = r->flow;
    const int n_x = flow->n_x;
    for (int p = 0; p < flow->n; p++) {
        const struct dalcs_flow_piece *piece = &flow->piece[p];
        struct dalcs_flow_map *map = piece->map;
        const double complex phase = turn(w, piece->t);
        if (map->stamp != r->stamp) {
            find_driven(r, map, w);
            find_means(r, map, other);
            map->stamp = r->stamp;
        }
        if (piece->start != NULL) {
            begin_piece(r, piece, phase);
        }
        if (means) {
            add_means(r, map, phase, conj(turn(other, piece->t)));
        }
        const struct dalcs_orbit_span *end = piece->end;
        double complex dt = 0.0;
        if (end != NULL) {
            dt = end->row >= 0 ? -at_end(r, map, phase, end->row) / end->rate
                               : (end->moved[0] + I * end->moved[1]) * turn(w, end->to);
        }
        for (int x = 0; x < n_x; x++) {
            r->next[x] = at_end(r, map, phase, x) + (end != NULL ? dt * end->df[x] : 0.0);
        }
        memcpy(r->now, r->next, (size_t)n_x * sizeof *r->now);
        for (int m = 0; m < r->n_read && means && end != NULL; m++) {
            r->y[r->read[m]] +=
                dt * end->dy[r->read[m]] * conj(turn(other, end->to)) / flow->period;
        }
    }
}

static enum dalcs_status solve(struct dalcs_periodic_response *r, double w) {
    const int n = r->flow->n_x;
    const double complex turned = turn(w, r->flow->period);
    for (int k = 0; k < n * n; k++) {
        r->A[k] = (k % n == k / n ? turned : 0.0) - r->flow->M[k];
    }
    memcpy(r->d, r->now, (size_t)n * sizeof *r->d);
    const int failed =
        n == 0 ? 0 : LAPACKE_zgesv(LAPACK_COL_MAJOR, n, 1, r->A, n, r->pivot, r->d, n);
    return failed == 0                          ? DALCS_OK
           : failed == LAPACK_WORK_MEMORY_ERROR ? DALCS_E_NOMEM
                                                : DALCS_SINGULAR;
}

enum dalcs_status dalcs_periodic_response_at(struct dalcs_periodic_response *r, double w,
                                             int sideband) {
    const size_t n_x = (size_t)r->flow->n_x;
    const double other = w + sideband * dalcs_two_pi / r->flow->period;
    r->stamp++;
    for (int m = 0; m < r->n_read; m++) {
        r->y[r->read[m]] = 0.0;
    }
    for (size_t x = 0; x < n_x; x++) {
        r->now[x] = 0.0;
    }
    go_through(r, w, other, false);
    DALCS_TRY(solve(r, w));
    memcpy(r->now, r->d, n_x * sizeof *r->now);
    go_through(r, w, other, true);
    return DALCS_OK;
}

/* ---- Set up -------------------------------------------------------------------------------------- */

enum dalcs_status dalcs_periodic_response_setup(struct dalcs_periodic_response *r,
                                                struct dalcs_periodic_flow *flow,
                                                const bool *is_read) {
    const int n_columns = dalcs_system_n_columns(flow->system);
    const size_t n_x = (size_t)flow->n_x;
    *r = (struct dalcs_periodic_response){.flow = flow};
    r->read = dalcs_arena_alloc(&r->arena, (size_t)n_columns, sizeof(int));
    r->y = dalcs_arena_alloc(&r->arena, (size_t)n_columns, sizeof *r->y);
    r->d = dalcs_arena_alloc(&r->arena, n_x, sizeof *r->d);
    r->now = dalcs_arena_alloc(&r->arena, n_x, sizeof *r->now);
    r->next = dalcs_arena_alloc(&r->arena, n_x, sizeof *r->next);
    r->A = dalcs_arena_alloc(&r->arena, n_x * n_x, sizeof *r->A);
    r->pivot = dalcs_arena_alloc(&r->arena, n_x, sizeof(int));
    bool complete = r->read != NULL && r->y != NULL && r->d != NULL && r->now != NULL &&
                    r->next != NULL && r->A != NULL && r->pivot != NULL;
    for (int c = 0; c < n_columns && complete; c++) {
        if (is_read[c]) {
            r->read[r->n_read++] = c;
        }
    }
    for (struct dalcs_flow_map *map = flow->map; map != NULL && complete; map = map->next) {
        map->mean = dalcs_arena_alloc(&r->arena, (n_x + 1) * (size_t)r->n_read, sizeof *map->mean);
        complete = map->mean != NULL;
    }
    if (!complete) {
        dalcs_periodic_response_finish(r);
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

void dalcs_periodic_response_finish(struct dalcs_periodic_response *r) {
    dalcs_arena_finish(&r->arena);
    *r = (struct dalcs_periodic_response){0};
}

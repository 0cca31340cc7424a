/* periodic_response.c - small signals through the pieces of a period. */
#include "periodic_response.h"
#include "periodic_rest.h"
#include "pi.h"
#include "polynomial_means.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

/* Frequencies at which small signals are looked for at diodes that rest. What such a signal makes of a guard is analytic in the
 * frequency: it is 0 at all of them, or at single ones. */
enum { LOOKS = 2 };

/* ---- Maps at a frequency ------------------------------------------------------------------------- */

/* What sources make of an answer row by row, from states of 0 and at the phase 0 where a piece begins. */
static void find_driven(const struct dalcs_periodic_response *r, struct dalcs_flow_map *map,
                        double w) {
    const struct dalcs_periodic_flow *flow = r->flow;
    const size_t size = dalcs_periodic_flow_size(flow);
    double complex coefficient[DALCS_MOST_DRIVES];
    dalcs_periodic_flow_drive(flow, w * map->h, coefficient);
    const size_t n = (size_t)flow->kept.n;
    const size_t n_asked = (size_t)(r->listener.passed != NULL ? flow->kept.n : flow->kept.n_asked);
    for (size_t first = 0; first < size; first += n) {
        for (size_t i = first; i < first + n_asked; i++) {
            map->driven[i] = 0.0;
        }
    }
    for (int k = 0; k < flow->drive.n_turns * flow->stages.layout.n_nodes; k++) {
        const double *drive = map->drive + (size_t)k * size;
        for (size_t first = 0; first < size; first += n) {
            for (size_t i = first; i < first + n_asked; i++) {
                map->driven[i] += coefficient[k] * drive[i];
            }
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
    double complex weight[DALCS_MAX_NODES];
    dalcs_mean_weights(flow, w * map->h, weight);
    const int n_columns = flow->n_columns;
    for (int k = 0; k <= n_columns; k++) {
        const double *state = map->state + (size_t)k * dalcs_periodic_flow_size(flow);
        double complex *mean = map->mean + (size_t)k * (size_t)r->n_read;
        for (int m = 0; m < r->n_read; m++) {
            double complex sum = 0.0;
            for (int i = 0; i < n && !is_open(map, flow->system, r->read[m]); i++) {
                const size_t at = dalcs_periodic_flow_at(flow, i, r->read[m]);
                sum += weight[i] * (k < n_columns ? state[at] : map->driven[at]);
            }
            mean[m] = sum;
        }
    }
}

/* ---- Through the period -------------------------------------------------------------------------- */

static void begin_with(struct dalcs_periodic_response *r, const struct dalcs_flow_start *start,
                       double complex phase) {
    const int n_x = r->flow->n_x;
    for (int x = 0; x < n_x; x++) {
        double complex sum = start->by_source[x] * phase;
        for (int k = 0; k < r->flow->n_columns; k++) {
            sum += start->P[k * n_x + x] * r->now[k];
        }
        r->next[x] = sum;
    }
    memcpy(r->now, r->next, (size_t)n_x * sizeof *r->now);
}

/* late: s, by which the event before it is. */
static void begin_piece(struct dalcs_periodic_response *r, const struct dalcs_flow_piece *piece,
                        double complex phase, double complex late) {
    const int n_x = r->flow->n_x;
    for (int x = 0; x < n_x && piece->behind != NULL; x++) {
        r->now[x] += late * piece->behind[x];
    }
    if (piece->jump != NULL) {
        begin_with(r, piece->jump, phase);
    }
    for (int x = 0; x < n_x && piece->behind != NULL; x++) {
        r->now[x] -= late * piece->behind[x];
    }
    if (piece->start != NULL) {
        begin_with(r, piece->start, phase);
    }
}

/* One row where the piece ends. */
static double complex at_end(const struct dalcs_periodic_response *r,
                             const struct dalcs_flow_map *map, double complex phase, int row) {
    const struct dalcs_periodic_flow *flow = r->flow;
    const size_t at = dalcs_periodic_flow_at(flow, flow->stages.layout.n_nodes - 1, row);
    double complex sum = phase * map->driven[at];
    for (int k = 0; k < flow->n_columns; k++) {
        sum += r->now[k] * map->state[(size_t)k * dalcs_periodic_flow_size(flow) + at];
    }
    return sum;
}

/* y += what the piece has of them, with the phase that they are taken at where it begins. */
static void add_means(struct dalcs_periodic_response *r, const struct dalcs_flow_map *map,
                      double complex phase, double complex taken) {
    const int n_columns = r->flow->n_columns;
    const double complex part = taken * (map->h / r->flow->period);
    for (int k = 0; k <= n_columns; k++) {
        const double complex factor = part * (k < n_columns ? r->now[k] : phase);
        const double complex *mean = map->mean + (size_t)k * (size_t)r->n_read;
        for (int m = 0; m < r->n_read; m++) {
            r->y[r->read[m]] += factor * mean[m];
        }
    }
}

static double complex turn(double w, double t) {
    return cexp(I * fmod(w * t, dalcs_two_pi));
}

/* Where a piece ends, for gates. */
struct end {
    const struct dalcs_periodic_response *r;
    const struct dalcs_flow_map *map;
    double complex phase; /* where it begins */
};

static double complex row_at_end(void *user, int row) {
    const struct end *end = user;
    return at_end(end->r, end->map, end->phase, row);
}

/* How the event at the end of a piece is late. */
static double complex find_dt(struct dalcs_periodic_response *r,
                              const struct dalcs_flow_piece *piece, double complex phase,
                              double w) {
    const struct dalcs_orbit_span *end = piece->end;
    double complex dt = end->row >= 0
                            ? -at_end(r, piece->map, phase, end->row) / end->rate
                            : r->drive * dalcs_periodic_flow_moved(r->flow, end) * turn(w, end->to);
    if (end->gates != NULL) {
        struct end of = {r, piece->map, phase};
        const struct dalcs_piece_end there = {&of, row_at_end, r->drive * turn(w, end->to)};
        dalcs_periodic_gates_meet(&r->gates, end, &there, r->now + r->flow->n_x, &dt);
    }
    return dt;
}

/* The numbers of gates at the end of the period. */
static void end_gates(struct dalcs_periodic_response *r, double w) {
    const struct dalcs_periodic_flow *flow = r->flow;
    const struct dalcs_flow_piece *last = &flow->pieces.piece[flow->pieces.n - 1];
    struct end of = {r, last->map, r->drive * turn(w, last->t)};
    const struct dalcs_piece_end there = {&of, row_at_end, r->drive * turn(w, flow->period)};
    dalcs_periodic_gates_end(&r->gates, &there, r->now + flow->n_x);
}

/* Of diodes that come near to their other side the one that the smallest signal takes there counts. */
static void look_near(struct dalcs_periodic_response *r, const struct dalcs_flow_piece *piece,
                      double complex phase) {
    double reach;
    const struct dalcs_orbit_low *low = dalcs_periodic_near_look(r, piece, phase, &reach);
    if (low != NULL && (r->near.low == NULL || reach < r->near.reach)) {
        r->near.low = low;
        r->near.reach = reach;
    }
}

/* From r->now at the start to what it is at the end of the period. means: r->y grows, with everything at w + of. */
static void go_through(struct dalcs_periodic_response *r, double w, double other, bool means) {
    const struct dalcs_periodic_flow *flow = r->flow;
    const int n_x = flow->n_x;
    double complex dt = 0.0;
    if (r->gates.log != NULL) {
        dalcs_periodic_gates_begin(&r->gates, r->now + n_x);
    }
    for (int p = 0; p < flow->pieces.n; p++) {
        const struct dalcs_flow_piece *piece = &flow->pieces.piece[p];
        struct dalcs_flow_map *map = piece->map;
        const double complex phase = r->drive * turn(w, piece->t);
        if (map->stamp != r->stamp) {
            find_driven(r, map, w);
            find_means(r, map, other);
            map->stamp = r->stamp;
        }
        begin_piece(r, piece, phase, dt);
        if (means) {
            add_means(r, map, phase, conj(turn(other, piece->t)));
        }
        if (means && r->stamp <= r->last_look && r->resting == NULL) {
            r->resting = dalcs_periodic_rest_look(r, piece, phase);
        }
        if (means && r->stamp <= r->last_look) {
            look_near(r, piece, phase);
        }
        const struct dalcs_orbit_span *end = piece->end;
        dt = end != NULL ? find_dt(r, piece, phase, w) : 0.0;
        if (means && r->listener.passed != NULL) {
            const struct dalcs_piece_passed passed = {piece, r->now, phase, dt};
            r->listener.passed(r->listener.user, &passed);
        }
        if (p == flow->pieces.n - 1 && r->gates.log != NULL) {
            end_gates(r, w);
        }
        for (int x = 0; x < n_x; x++) {
            r->next[x] = at_end(r, map, phase, x) + (end != NULL ? dt * end->df[x] : 0.0);
        }
        memcpy(r->now, r->next, (size_t)n_x * sizeof *r->now);
        if (end != NULL && end->gates != NULL) {
            dalcs_periodic_gates_pass(&r->gates, end, dt, r->now + n_x);
        }
        for (int m = 0; m < r->n_read && means && end != NULL; m++) {
            r->y[r->read[m]] +=
                dt * end->dy[r->read[m]] * conj(turn(other, end->to)) / flow->period;
        }
    }
}

/* What a period begins with, or ends with: states, outputs, and the other numbers of gates. */
static double complex *number_at(struct dalcs_periodic_response *r, int k) {
    return k < r->flow->n_columns ? &r->now[k] : &r->gates.number[k - r->flow->n_columns];
}

/* Column after column: gates let a small change go from any part to any other. */
static void find_M(struct dalcs_periodic_response *r) {
    r->drive = 0.0;
    r->stamp++;
    for (int column = 0; column < r->n_all; column++) {
        for (int k = 0; k < r->n_all; k++) {
            *number_at(r, k) = k == column ? 1.0 : 0.0;
        }
        go_through(r, 0.0, 0.0, false);
        for (int k = 0; k < r->n_all; k++) {
            r->M[(size_t)column * (size_t)r->n_all + (size_t)k] = creal(*number_at(r, k));
        }
    }
    r->drive = 1.0;
}

static enum dalcs_status solve(struct dalcs_periodic_response *r, double w) {
    const int n = r->n_all;
    const double complex turned = turn(w, r->flow->period);
    for (int k = 0; k < n * n; k++) {
        r->A[k] = (k % n == k / n ? turned : 0.0) - r->M[k];
    }
    for (int k = 0; k < n; k++) {
        r->d[k] = *number_at(r, k);
    }
    const int failed =
        n == 0 ? 0 : LAPACKE_zgesv(LAPACK_COL_MAJOR, n, 1, r->A, n, r->pivot, r->d, n);
    return failed == 0                          ? DALCS_OK
           : failed == LAPACK_WORK_MEMORY_ERROR ? DALCS_E_NOMEM
                                                : DALCS_SINGULAR;
}

enum dalcs_status dalcs_periodic_response_at(struct dalcs_periodic_response *r, double w,
                                             int sideband) {
    const double other = w + sideband * dalcs_two_pi / r->flow->period;
    r->stamp++;
    for (int m = 0; m < r->n_read; m++) {
        r->y[r->read[m]] = 0.0;
    }
    for (int k = 0; k < r->n_all; k++) {
        *number_at(r, k) = 0.0;
    }
    go_through(r, w, other, false);
    DALCS_TRY(solve(r, w));
    for (int k = 0; k < r->n_all; k++) {
        *number_at(r, k) = r->d[k];
    }
    go_through(r, w, other, true);
    return DALCS_OK;
}

/* ---- Set up -------------------------------------------------------------------------------------- */

enum dalcs_status dalcs_periodic_response_setup(struct dalcs_periodic_response *r,
                                                struct dalcs_periodic_flow *flow,
                                                const bool *is_read) {
    const int n_columns = dalcs_system_n_columns(flow->system);
    const struct dalcs_orbit_gates *gates = flow->orbit->log->gates;
    const size_t n_states = (size_t)flow->n_columns;
    *r = (struct dalcs_periodic_response){.flow = flow, .drive = 1.0};
    r->n_all = flow->n_x + (gates != NULL ? gates->memory->n_numbers : 0);
    const size_t n_all = (size_t)r->n_all;
    r->read = dalcs_arena_alloc(&r->arena, (size_t)n_columns, sizeof(int));
    r->y = dalcs_arena_alloc(&r->arena, (size_t)n_columns, sizeof *r->y);
    r->d = dalcs_arena_alloc(&r->arena, n_all, sizeof *r->d);
    r->now = dalcs_arena_alloc(&r->arena, n_states, sizeof *r->now);
    r->next = dalcs_arena_alloc(&r->arena, n_states, sizeof *r->next);
    r->A = dalcs_arena_alloc(&r->arena, n_all * n_all, sizeof *r->A);
    r->M = gates != NULL ? dalcs_arena_alloc(&r->arena, n_all * n_all, sizeof *r->M) : flow->M;
    r->pivot = dalcs_arena_alloc(&r->arena, n_all, sizeof(int));
    bool complete = r->M != NULL && r->read != NULL && r->y != NULL && r->d != NULL &&
                    r->now != NULL && r->next != NULL && r->A != NULL && r->pivot != NULL;
    for (int c = 0; c < n_columns && complete; c++) {
        if (is_read[c]) {
            r->read[r->n_read++] = c;
        }
    }
    for (int p = 0; p < flow->pieces.n && complete; p++) {
        struct dalcs_flow_map *map = flow->pieces.piece[p].map;
        if (map->mean == NULL) {
            map->mean =
                dalcs_arena_alloc(&r->arena, (n_states + 1) * (size_t)r->n_read, sizeof *map->mean);
            map->driven =
                dalcs_arena_alloc(&r->arena, dalcs_periodic_flow_size(flow), sizeof *map->driven);
            complete = map->mean != NULL && map->driven != NULL;
        }
    }
    complete = complete && (gates == NULL ||
                            dalcs_periodic_gates_setup(&r->gates, &r->arena, flow) == DALCS_OK);
    if (!complete) {
        dalcs_periodic_response_finish(r);
        return DALCS_E_NOMEM;
    }
    if (gates != NULL) {
        find_M(r);
    }
    r->last_look = r->stamp + LOOKS;
    return DALCS_OK;
}

void dalcs_periodic_response_finish(struct dalcs_periodic_response *r) {
    dalcs_arena_finish(&r->arena);
    *r = (struct dalcs_periodic_response){0};
}

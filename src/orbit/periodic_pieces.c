/* periodic_pieces.c - spans of one mode cut into pieces that polynomials of a step can carry. */
#include "periodic_flow.h"

#include "magnitudes.h"

#include <math.h>

/* Last Legendre coefficients are resolved where they are nothing beside what they are of (dalcs_alike): integrals of products
 * of two such polynomials, which means over a period are, see the square of what is missing.
 *
 * A piece is at least this part of its span: what is still rough there has died away behind it, for the steps are
 * L-stable. Where it has not after so many pieces the polynomials do not carry it, and a span would take 2^40 of them. */
enum { MOST_HALVINGS = 40, MOST_ROUGH = 256 };

/* What goes through the pieces as they are made: what starts from unit states, and with the fastest signal. */
struct probe {
    struct dalcs_periodic_flow *flow;
    int n; /* n_x, the fastest signal, and outputs of gates, each off by 1 V all the time */
    double complex *column;  /* [n][n_x] */
    double complex *after;   /* likewise, behind a piece that is tried */
    double *size;            /* [n] the largest so far, in the units of energies */
    double complex *dt;      /* [n] s */
    double complex *at_node; /* [n_nodes] of one state */
    double complex drive[DALCS_MOST_DRIVES];
};

static double complex driven(const struct probe *p, const struct dalcs_flow_map *map, double t,
                             size_t at) {
    const struct dalcs_periodic_flow *flow = p->flow;
    const size_t size = dalcs_periodic_flow_size(flow);
    double complex sum = 0.0;
    for (int k = 0; k < flow->drive.n_turns * flow->stages.layout.n_nodes; k++) {
        sum += p->drive[k] * map->drive[(size_t)k * size + at];
    }
    return sum * cexp(I * flow->fastest * t);
}

/* Row `row` at node i of probe k through a piece that begins at t. */
static double complex row_at(const struct probe *p, const struct dalcs_flow_map *map, double t,
                             int k, int node, int row) {
    const struct dalcs_periodic_flow *flow = p->flow;
    const size_t size = dalcs_periodic_flow_size(flow);
    const size_t at = dalcs_periodic_flow_at(flow, node, row);
    double complex sum = k == flow->n_x  ? driven(p, map, t, at)
                         : k > flow->n_x ? map->state[(size_t)(k - 1) * size + at]
                                         : 0.0;
    for (int x = 0; x < flow->n_x; x++) {
        sum += p->column[k * flow->n_x + x] * map->state[(size_t)x * size + at];
    }
    return sum;
}

/* The last two coefficients of all states of probe k, in the units of energies; its end into p->after. */
static double find_tail(struct probe *p, const struct dalcs_flow_map *map, double t, int k,
                        double *size) {
    const struct dalcs_periodic_flow *flow = p->flow;
    const int n = flow->stages.layout.n_nodes;
    double tail = 0.0;
    double most = 0.0;
    for (int x = 0; x < flow->n_x; x++) {
        double complex last[2] = {0.0, 0.0};
        double largest = 0.0;
        for (int i = 0; i < n; i++) {
            p->at_node[i] = row_at(p, map, t, k, i, x);
            largest = fmax(largest, cabs(p->at_node[i]));
            last[0] += flow->legendre[n - 1][i] * p->at_node[i];
            last[1] += flow->legendre[n - 2][i] * p->at_node[i];
        }
        p->after[k * flow->n_x + x] = p->at_node[n - 1];
        double unit = flow->unit[x];
        tail = fmax(tail, unit * fmax(cabs(last[0]), cabs(last[1])));
        most = fmax(most, unit * largest);
    }
    *size = fmax(p->size[k], most);
    return tail;
}

/* What rounding leaves in the last coefficients of probe k, in the units of energies. */
static double noise_of(const struct probe *p, const struct dalcs_flow_map *map, int k) {
    const struct dalcs_periodic_flow *flow = p->flow;
    const int n = flow->stages.layout.n_nodes;
    double noise = k > flow->n_x ? map->noise[k - 1] : 0.0;
    double sum[2] = {0.0, 0.0};
    for (int x = 0; x < flow->n_x; x++) {
        noise += cabs(p->column[k * flow->n_x + x]) * map->noise[x];
    }
    for (int i = 0; i < n; i++) {
        sum[0] += fabs(flow->legendre[n - 1][i]);
        sum[1] += fabs(flow->legendre[n - 2][i]);
    }
    return noise * fmax(sum[0], sum[1]);
}

/* Does the piece carry all of them? *tail: the worst, over their sizes; *seen: the same beyond rounding, which no shorter
 * piece makes less. */
static void try_piece(struct probe *p, const struct dalcs_flow_map *map, double t, double *tail,
                      double *seen) {
    const struct dalcs_periodic_flow *flow = p->flow;
    const int n = flow->stages.layout.n_nodes;
    dalcs_periodic_flow_drive(flow, flow->fastest * map->h, p->drive);
    *tail = *seen = fmax(cabs(p->drive[n - 1]), cabs(p->drive[n - 2]));
    for (int k = 0; k < p->n; k++) {
        double size;
        const double of = find_tail(p, map, t, k, &size);
        const double rounding = k < flow->n_x    ? 0.0
                                : k == flow->n_x ? map->rounding[flow->n_columns]
                                                 : map->rounding[k - 1];
        size = fmax(size, rounding / dalcs_alike);
        *tail = of > 0.0 ? fmax(*tail, of / size) : *tail;
        const bool is_rounding = of > dalcs_alike * size && of <= noise_of(p, map, k);
        *seen = of > 0.0 && !is_rounding ? fmax(*seen, of / size) : *seen;
    }
}

static void accept(struct probe *p) {
    const struct dalcs_periodic_flow *flow = p->flow;
    const int n_x = flow->n_x;
    for (int k = 0; k < p->n; k++) {
        for (int x = 0; x < n_x; x++) {
            p->column[k * n_x + x] = p->after[k * n_x + x];
            p->size[k] = fmax(p->size[k], flow->unit[x] * cabs(p->after[k * n_x + x]));
        }
    }
}

static enum dalcs_status add_piece(struct dalcs_periodic_flow *flow, struct dalcs_flow_map *map,
                                   double t) {
    DALCS_TRY(dalcs_periodic_flow_keep(flow, map));
    DALCS_TRY(dalcs_grow(&flow->pieces.piece, &flow->pieces.capacity, (size_t)flow->pieces.n + 1,
                         sizeof *flow->pieces.piece));
    flow->pieces.piece[flow->pieces.n++] = (struct dalcs_flow_piece){.map = map, .t = t};
    return DALCS_OK;
}

/* How the time of what happens at the end of the piece moves. */
static void find_dt(struct probe *p, const struct dalcs_orbit_span *span,
                    const struct dalcs_flow_map *map, double t) {
    const int end = p->flow->stages.layout.n_nodes - 1;
    const double complex moved =
        dalcs_periodic_flow_moved(p->flow, span) * cexp(I * p->flow->fastest * span->to);
    for (int k = 0; k < p->n; k++) {
        p->dt[k] = k == p->flow->n_x ? moved : 0.0;
        if (span->row >= 0) {
            p->dt[k] = -row_at(p, map, t, k, end, span->row) / span->rate;
        }
    }
}

static void end_span(struct probe *p, const struct dalcs_orbit_span *span) {
    const int n_x = p->flow->n_x;
    for (int k = 0; k < p->n; k++) {
        for (int x = 0; x < n_x; x++) {
            p->column[k * n_x + x] += p->dt[k] * span->df[x];
        }
    }
}

/* One of length h that is tried from t on. */
struct piece {
    struct dalcs_flow_map *map;
    double t;
    double tail; /* of the worst probe, over its size */
    double seen; /* the same beyond rounding */
};

static enum dalcs_status look_at(struct probe *p, const struct dalcs_orbit_span *span, double t,
                                 double h, struct piece *piece) {
    piece->t = t;
    DALCS_TRY(dalcs_periodic_flow_map(p->flow, span, t, h, &piece->map));
    try_piece(p, piece->map, t, &piece->tail, &piece->seen);
    return DALCS_OK;
}

/* Is the piece as good as any from there on? What is too much of it may be rounding: half the length takes 2^-(s - 1) of
 * the last coefficients, and makes more of what rounding has left in them. Half of these digits tell one from the other. */
static enum dalcs_status is_good(struct probe *p, const struct dalcs_orbit_span *span, double h,
                                 struct piece *piece, bool *is) {
    *is = piece->tail <= dalcs_alike;
    if (*is || piece->seen > dalcs_alike) {
        return DALCS_OK;
    }
    struct piece half;
    DALCS_TRY(look_at(p, span, piece->t, 0.5 * h, &half));
    *is = half.tail >= ldexp(piece->tail, -(p->flow->stages.method->s - 1) / 2);
    return *is ? look_at(p, span, piece->t, h, piece) : DALCS_OK;
}

/* Halves and doubles of the span, each at a multiple of its own length. */
static enum dalcs_status cut_span(struct probe *p, const struct dalcs_orbit_span *span) {
    struct dalcs_periodic_flow *flow = p->flow;
    const double length = span->to - span->from;
    int level = 0;
    int n_rough = 0;
    uint64_t at = 0; /* of 2^MOST_HALVINGS */
    while (at < (uint64_t)1 << MOST_HALVINGS) {
        const double t = span->from + ldexp((double)at, -MOST_HALVINGS) * length;
        const double h = ldexp(length, -level);
        struct piece piece;
        bool is;
        DALCS_TRY(look_at(p, span, t, h, &piece));
        DALCS_TRY(is_good(p, span, h, &piece, &is));
        if (!is && level < MOST_HALVINGS) {
            level++;
            continue;
        }
        n_rough += piece.tail > dalcs_alike ? 1 : 0;
        if (n_rough > MOST_ROUGH) {
            return DALCS_NOT_CONVERGED;
        }
        flow->worst = fmax(flow->worst, piece.tail);
        DALCS_TRY(add_piece(flow, piece.map, t));
        find_dt(p, span, piece.map, t);
        accept(p);
        at += (uint64_t)1 << (MOST_HALVINGS - level);
        /* twice the length takes 2^s times the coefficients, and is tried where it can begin */
        bool aligned = level > 0 && (at & ((uint64_t)1 << (MOST_HALVINGS - level))) == 0;
        level -= aligned && ldexp(piece.seen, flow->stages.method->s - 1) <= dalcs_alike ? 1 : 0;
    }
    return DALCS_OK;
}

static void begin_span(struct probe *p, const struct dalcs_flow_start *start, double t) {
    const struct dalcs_periodic_flow *flow = p->flow;
    const int n_x = flow->n_x;
    for (int k = 0; k < p->n && start != NULL; k++) {
        for (int x = 0; x < n_x; x++) {
            double complex sum = k == n_x  ? start->by_source[x] * cexp(I * flow->fastest * t)
                                 : k > n_x ? start->P[(k - 1) * n_x + x]
                                           : 0.0;
            for (int i = 0; i < n_x; i++) {
                sum += start->P[i * n_x + x] * p->column[k * n_x + i];
            }
            p->after[k * n_x + x] = sum;
        }
    }
    if (start != NULL) {
        accept(p);
    }
}

/* An event that moves the jump lets f- go on before it, and takes f+ away behind it; its span's end had both. */
static void pass_jump(struct probe *p, const struct dalcs_flow_start *start,
                      const struct dalcs_orbit_span *span) {
    const int n_x = p->flow->n_x;
    for (int side = 0; side < 2; side++) {
        for (int k = 0; k < p->n && span->behind != NULL; k++) {
            for (int x = 0; x < n_x; x++) {
                const double complex moved = p->dt[k] * span->behind[x];
                p->column[k * n_x + x] += side == 0 ? moved : -moved;
            }
        }
        begin_span(p, side == 0 ? start : NULL, span->from);
    }
}

static enum dalcs_status find_jump(struct dalcs_periodic_flow *flow,
                                   const struct dalcs_orbit_span *span,
                                   const struct dalcs_flow_start **start) {
    struct dalcs_orbit_span with_impulses = *span;
    with_impulses.mode = span->jump;
    *start = NULL;
    return span->jump != NULL ? dalcs_periodic_flow_start(flow, &with_impulses, start) : DALCS_OK;
}

static enum dalcs_status cut_period(struct probe *p) {
    struct dalcs_periodic_flow *flow = p->flow;
    const struct dalcs_orbit_part *orbit = flow->orbit;
    const struct dalcs_orbit_span *before = NULL;
    for (int k = 0; k < orbit->n; k++) {
        const struct dalcs_orbit_span *span = &orbit->span[k];
        const struct dalcs_flow_start *start = NULL;
        const struct dalcs_flow_start *jump;
        if (!(span->to > span->from)) {
            continue;
        }
        DALCS_TRY(flow->asked.go_on(flow->asked.user));
        DALCS_TRY(find_jump(flow, span, &jump));
        if (flow->smooth == NULL || before == NULL || span->jump != NULL ||
            !dalcs_mode_is(before->mode, span->mode, flow->stages.n_words)) {
            DALCS_TRY(dalcs_periodic_flow_start(flow, span, &start));
        }
        before = span;
        if (jump != NULL) {
            pass_jump(p, jump, span);
        }
        begin_span(p, start, span->from);
        const int first = flow->pieces.n;
        DALCS_TRY(cut_span(p, span));
        for (int m = first; m < flow->pieces.n; m++) {
            flow->pieces.piece[m].resting = span->resting;
        }
        flow->pieces.piece[first].start = start;
        flow->pieces.piece[first].jump = jump;
        flow->pieces.piece[first].behind = jump != NULL ? span->behind : NULL;
        if (span->df != NULL) {
            flow->pieces.piece[flow->pieces.n - 1].end = span;
            end_span(p, span);
        }
    }
    return DALCS_OK;
}

/* ---- Set up -------------------------------------------------------------------------------------- */

static enum dalcs_status probe_setup(struct probe *p, struct dalcs_periodic_flow *flow,
                                     struct dalcs_arena *arena) {
    const size_t n_x = (size_t)flow->n_x;
    const size_t n = (size_t)flow->n_columns + 1;
    *p = (struct probe){.flow = flow, .n = flow->n_columns + 1};
    p->column = dalcs_arena_alloc(arena, n * n_x, sizeof(double complex));
    p->after = dalcs_arena_alloc(arena, n * n_x, sizeof(double complex));
    p->size = dalcs_arena_alloc(arena, n, sizeof(double));
    p->dt = dalcs_arena_alloc(arena, n, sizeof(double complex));
    p->at_node = dalcs_arena_alloc(arena, DALCS_MAX_NODES, sizeof(double complex));
    if (p->column == NULL || p->after == NULL || p->size == NULL || p->dt == NULL ||
        p->at_node == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n_x; k++) {
        p->column[k * n_x + k] = 1.0;
        p->size[k] = flow->unit[k];
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_periodic_pieces_make(struct dalcs_periodic_flow *flow) {
    struct dalcs_arena arena = {0};
    struct probe p;
    enum dalcs_status status = probe_setup(&p, flow, &arena);
    status = status == DALCS_OK ? cut_period(&p) : status;
    for (int k = 0; k < flow->n_x * flow->n_x && status == DALCS_OK; k++) {
        flow->M[k] = creal(p.column[k]);
    }
    dalcs_arena_finish(&arena);
    return status;
}

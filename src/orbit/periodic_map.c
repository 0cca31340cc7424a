/* periodic_map.c - a step of one mode as a map of what it begins with, and of the small signals. */
#include "periodic_flow.h"

#include "periodic_smooth.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- Rows ---------------------------------------------------------------------------------------- */

static void take_row(struct dalcs_periodic_flow *flow, int row) {
    if (flow->kept.place[row] < 0) {
        flow->kept.place[row] = flow->kept.n;
        flow->kept.row[flow->kept.n++] = row;
    }
}

static void take_probe(struct dalcs_periodic_flow *flow, const struct dalcs_probe *probe) {
    for (int m = 0; probe->system >= 0 && m < probe->n_terms; m++) {
        take_row(flow, probe->term[m].index);
    }
}

enum dalcs_status dalcs_periodic_flow_rows(struct dalcs_periodic_flow *flow) {
    const int n = flow->stages.layout.stride;
    const struct dalcs_orbit_part *orbit = flow->orbit;
    const struct dalcs_orbit_gates *gates = orbit->log->gates;
    flow->kept.place = dalcs_arena_alloc(&flow->arena, (size_t)n, sizeof(int));
    flow->kept.row = dalcs_arena_alloc(&flow->arena, (size_t)n, sizeof(int));
    if (flow->kept.place == NULL || flow->kept.row == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int row = 0; row < n; row++) {
        flow->kept.place[row] = -1;
    }
    for (int x = 0; x < flow->n_x; x++) {
        take_row(flow, x);
    }
    for (int k = 0; k < orbit->n; k++) {
        if (orbit->span[k].row >= 0) {
            take_row(flow, orbit->span[k].row);
        }
    }
    for (int k = 0; gates != NULL && k < gates->memory->n_taken; k++) {
        const struct dalcs_output *out = dalcs_logic_read_by(gates->memory, gates->network, k);
        take_probe(flow, &out->plus);
        take_probe(flow, &out->minus);
    }
    for (int c = 0; c < dalcs_system_n_columns(flow->system); c++) {
        if (flow->asked.is_read[c] || orbit->rest.any || orbit->near.n > 0) {
            take_row(flow, c);
        }
    }
    flow->kept.n_asked = flow->kept.n;
    for (int c = 0; c < dalcs_system_n_columns(flow->system) && flow->asked.keeps_all; c++) {
        take_row(flow, c);
    }
    return DALCS_OK;
}

/* Those of an answer. */
static void put_rows(const struct dalcs_periodic_flow *flow, const double *out, double *to) {
    for (int node = 0; node <= flow->stages.method->n_stages; node++) {
        const double *from = out + node * flow->stages.layout.stride;
        for (int k = 0; k < flow->kept.n; k++) {
            *to++ = from[flow->kept.row[k]];
        }
    }
}

/* ---- Rounding ------------------------------------------------------------------------------------ */

/* What rounding leaves in states that sources drive, in the units of energies: of P x' = A y that of the sums over y,
 * which cancel where a voltage source holds a capacitor. */
static double rounding_of(const struct dalcs_periodic_flow *flow, const double *out, double h) {
    const struct dalcs_csr *A = &flow->system->A;
    const int n_nodes = flow->stages.layout.n_nodes;
    double most = 0.0;
    for (int x = 0; x < flow->n_x; x++) {
        for (int node = 0; node < n_nodes; node++) {
            const double *y = out + node * flow->stages.layout.stride;
            double terms = 0.0;
            for (int m = A->p[x]; m < A->p[x + 1]; m++) {
                terms += fabs(A->x[m] * y[A->j[m]]);
            }
            most = fmax(most, terms / flow->unit[x]);
        }
    }
    return DBL_EPSILON * n_nodes * h * most;
}

/* What an equation without derivatives and sources is off by, the most at a node. It holds at each node, so that this is
 * what rounding has left in what it reads. */
static double find_miss(const struct dalcs_periodic_flow *flow, const struct dalcs_flow_map *map,
                        const double *out, int row) {
    const struct dalcs_csr *A = &flow->system->A;
    const int n_equations = dalcs_system_n_equations(flow->system);
    double most = 0.0;
    for (int node = 1; node < flow->stages.layout.n_nodes; node++) {
        const double *y = out + node * flow->stages.layout.stride;
        double miss = 0.0;
        for (int m = A->p[row]; m < A->p[row + 1]; m++) {
            const int pair = A->j[m] - n_equations;
            miss += pair < 0 || dalcs_mode_has(map->mode, pair) ? A->x[m] * y[A->j[m]] : 0.0;
        }
        most = fmax(most, fabs(miss));
    }
    return most;
}

/* What rounding leaves in the states of an answer, in the units of energies, as the equations tell that are to give
 * them. Small beside large voltages that all nodes of a part have in common, it does not fall with the length of a step. */
static double noise_of(const struct dalcs_periodic_flow *flow, const struct dalcs_flow_map *map,
                       const double *out) {
    const struct dalcs_csr *A = &flow->system->A;
    const struct dalcs_csr *E = &flow->system->E;
    double most = 0.0;
    for (int r = flow->n_x; r < dalcs_system_n_equations(flow->system); r++) {
        double miss = -1.0;
        for (int m = A->p[r]; m < A->p[r + 1] && E->p[r] == E->p[r + 1]; m++) {
            if (A->j[m] < flow->n_x) {
                miss = miss < 0.0 ? find_miss(flow, map, out, r) : miss;
                most = fmax(most, flow->unit[A->j[m]] * miss / fabs(A->x[m]));
            }
        }
    }
    return most;
}

/* ---- Maps ---------------------------------------------------------------------------------------- */

void dalcs_periodic_flow_drive(const struct dalcs_periodic_flow *flow, double kappa,
                               double complex *coefficient) {
    const int n = flow->stages.layout.n_nodes;
    double complex value[DALCS_MAX_NODES];
    for (int i = 0; i < n; i++) {
        value[i] = cexp(I * kappa * flow->stages.method->node[i]);
    }
    for (int k = 0; k < n; k++) {
        double complex sum = 0.0;
        for (int i = 0; i < n; i++) {
            sum += flow->legendre[k][i] * value[i];
        }
        for (int q = 0; q < flow->drive.n_turns; q++) {
            coefficient[q * n + k] = flow->drive.turn[q] * sum;
        }
    }
}

/* The answer to in[column] = 1 into flow->work.out. */
static enum dalcs_status ask(struct dalcs_periodic_flow *flow, struct dalcs_stage_entry *entry,
                             int column) {
    memset(flow->work.in, 0, (size_t)flow->stages.n_in * sizeof(double));
    flow->work.in[column] = 1.0;
    DALCS_TRY(dalcs_stages_apply(&flow->stages, entry, flow->work.in, flow->work.out));
    if (flow->smooth != NULL) {
        dalcs_flow_smooth_vary(flow, flow->work.out);
    }
    return DALCS_OK;
}

/* Of the states and of outputs of gates. */
static enum dalcs_status fill_states(struct dalcs_periodic_flow *flow,
                                     struct dalcs_stage_entry *entry, struct dalcs_flow_map *map) {
    const size_t size = dalcs_periodic_flow_size(flow);
    const bool is_told = flow->smooth == NULL && dalcs_stage_n_clashes(entry) == 0;
    for (int k = 0; k < flow->n_columns; k++) {
        const int function = k < flow->n_x ? -1 : flow->drive.pin[k - flow->n_x];
        if (k >= flow->n_x && function < 0) {
            continue;
        }
        DALCS_TRY(ask(flow, entry, k < flow->n_x ? k : flow->n_x + 1 + function));
        put_rows(flow, flow->work.out, map->state + (size_t)k * size);
        map->noise[k] = is_told ? noise_of(flow, map, flow->work.out) : 0.0;
        map->rounding[k] = k < flow->n_x ? 0.0 : rounding_of(flow, flow->work.out, map->h);
    }
    return DALCS_OK;
}

static enum dalcs_status fill_drive(struct dalcs_periodic_flow *flow,
                                    struct dalcs_stage_entry *entry, struct dalcs_flow_map *map) {
    const size_t size = dalcs_periodic_flow_size(flow);
    const int n_nodes = flow->stages.layout.n_nodes;
    double *rounding = &map->rounding[flow->n_columns];
    memset(map->drive, 0, (size_t)(flow->drive.n_turns * n_nodes) * size * sizeof *map->drive);
    *rounding = 0.0;
    for (int f = 0; f < flow->drive.n; f++) {
        const struct dalcs_excitation_function *function = &flow->excitation.function[f];
        const double complex source = flow->drive.source[function->input];
        DALCS_TRY(ask(flow, entry, flow->n_x + 1 + f));
        put_rows(flow, flow->work.out, flow->work.rows);
        for (int q = 0; q < flow->drive.n_turns; q++) {
            const double part = creal(source * conj(flow->drive.turn[q]));
            double *drive = map->drive + (size_t)(q * n_nodes + function->degree) * size;
            for (size_t i = 0; i < size; i++) {
                drive[i] += part * flow->work.rows[i];
            }
        }
        *rounding +=
            function->degree == 0 ? cabs(source) * rounding_of(flow, flow->work.out, map->h) : 0.0;
    }
    return DALCS_OK;
}

static struct dalcs_flow_map *find_map(const struct dalcs_periodic_flow *flow, const uint64_t *mode,
                                       double t, double h) {
    const double key[2] = {h, flow->smooth != NULL ? t : 0.0};
    struct dalcs_flow_map *map;
    HASH_FIND(hh, flow->made.map, key, sizeof key, map);
    while (map != NULL && !dalcs_mode_is(map->mode, mode, flow->stages.n_words)) {
        map = map->alike;
    }
    return map;
}

/* One that no piece has, to be filled. */
static struct dalcs_flow_map *spare_map(struct dalcs_periodic_flow *flow) {
    const size_t size = dalcs_periodic_flow_size(flow);
    const size_t n_columns = (size_t)flow->n_columns;
    struct dalcs_flow_map *map = flow->made.spare;
    if (map != NULL) {
        return map;
    }
    map = dalcs_arena_alloc(&flow->arena, 1, sizeof *map);
    if (map == NULL) {
        return NULL;
    }
    map->state = dalcs_arena_alloc(&flow->arena, n_columns * size, sizeof(double));
    map->drive = dalcs_arena_alloc(
        &flow->arena, (size_t)(flow->drive.n_turns * flow->stages.layout.n_nodes) * size,
        sizeof(double));
    map->noise = dalcs_arena_alloc(&flow->arena, n_columns + 1, sizeof(double));
    map->rounding = dalcs_arena_alloc(&flow->arena, n_columns + 1, sizeof(double));
    const bool complete =
        map->state != NULL && map->drive != NULL && map->noise != NULL && map->rounding != NULL;
    flow->made.spare = complete ? map : NULL;
    return flow->made.spare;
}

enum dalcs_status dalcs_periodic_flow_map(struct dalcs_periodic_flow *flow,
                                          const struct dalcs_orbit_span *span, double t, double h,
                                          struct dalcs_flow_map **found) {
    *found = find_map(flow, span->mode, t, h);
    if (*found != NULL) {
        return DALCS_OK;
    }
    struct dalcs_flow_map *map = spare_map(flow);
    struct dalcs_stage_entry *entry;
    if (map == NULL) {
        return DALCS_E_NOMEM;
    }
    const bool is_there = map->mode != NULL && map->key[0] == h &&
                          (flow->smooth == NULL || map->key[1] == t) &&
                          dalcs_mode_is(map->mode, span->mode, flow->stages.n_words);
    if (!is_there) {
        map->mode = NULL;
        DALCS_TRY(dalcs_stages_get(&flow->stages, span->mode, h, &entry));
        if (flow->smooth != NULL) {
            DALCS_TRY(dalcs_flow_smooth_begin(flow, entry, span, t, h));
        }
        map->mode = span->mode;
        map->h = map->key[0] = h;
        map->key[1] = flow->smooth != NULL ? t : 0.0;
        DALCS_TRY(fill_states(flow, entry, map));
        DALCS_TRY(fill_drive(flow, entry, map));
    }
    *found = map;
    return DALCS_OK;
}

enum dalcs_status dalcs_periodic_flow_keep(struct dalcs_periodic_flow *flow,
                                           struct dalcs_flow_map *map) {
    if (map != flow->made.spare) {
        return DALCS_OK;
    }
    flow->made.spare = NULL;
    map->stamp = -1;
    struct dalcs_flow_map *first;
    HASH_FIND(hh, flow->made.map, map->key, sizeof map->key, first);
    if (first != NULL) {
        map->alike = first->alike;
        first->alike = map;
        return DALCS_OK;
    }
    HASH_ADD(hh, flow->made.map, key, sizeof map->key, map);
    return map->hh.tbl != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

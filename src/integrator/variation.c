/* variation.c - V through segments and events. */
#include "variation.h"

#include "guard_values.h"
#include "quads.h"
#include "recurrence.h"
#include "smooth_step.h"
#include "step_error.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

/* ---- Derivatives --------------------------------------------------------------------------------- */

/* weight[s + 1] such that the derivative by theta of a quantity is the sum of weight * value at node. */
static void derivative_weights(const struct dalcs_collocation *c, double theta, double *weight) {
    for (int k = 0; k <= c->s; k++) {
        weight[k] = 0.0;
        for (int j = 0; j <= c->s; j++) {
            double product = j == k ? 0.0 : 1.0 / (c->node[k] - c->node[j]);
            for (int m = 0; m <= c->s && j != k; m++) {
                product *=
                    m == j || m == k ? 1.0 : (theta - c->node[m]) / (c->node[k] - c->node[m]);
            }
            weight[k] += product;
        }
    }
}

/* f[n_x] = x' of the columns y in the layout of an answer, at tau into the present segment. */
static void find_derivative(struct dalcs_variation_part *v, double *y, double tau, double *f) {
    const struct dalcs_system *s = v->part->component->system;
    const struct dalcs_osnsp *p = &v->part->component->osnsp;
    for (int d = 0; d < s->n_pairs; d++) { /* in the place of an open pair's current is its w */
        y[dalcs_system_n_equations(s) + d] *= dalcs_osnsp_is_on(p, d) ? 1.0 : 0.0;
    }
    dalcs_excitation_inputs(&v->part->excitation, v->part->segment.t, tau, v->inputs);
    for (int x = 0; x < s->n_x; x++) {
        f[x] = dalcs_csr_row_dot(&s->A, x, y) + dalcs_csr_row_dot(&s->E, x, v->inputs);
    }
    (void)LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'N', v->n_x, 1, v->P, v->n_x, v->pivot, f, v->n_x);
}

/* ---- Segments ------------------------------------------------------------------------------------ */

/* The modes that follow each other tell two runs apart. Returns whether this is another one than before. */
static bool sign_mode(struct dalcs_variation_part *v) {
    const struct dalcs_osnsp *p = &v->part->component->osnsp;
    uint64_t mode = 0;
    for (int k = 0; k < p->n_words; k++) {
        mode = (mode ^ p->mode[k]) * 0x9e3779b97f4a7c15u;
        mode ^= mode >> 29;
    }
    bool is_new = mode != v->last_mode;
    if (is_new) {
        v->signature = (v->signature ^ mode) * 0xff51afd7ed558ccdu;
        v->signature ^= v->signature >> 31;
        v->last_mode = mode;
    }
    return is_new;
}

/* What the event before has done, now that f+ is known: V += (f- - f+) dt. */
static void pass_event(struct dalcs_variation_part *v) {
    if (!v->pending) {
        return;
    }
    v->pending = false;
    const int stride = v->part->stages.layout.stride;
    memcpy(v->y, v->part->segment.out, (size_t)stride * sizeof(double));
    find_derivative(v, v->y, 0.0, v->after);
    for (int k = 0; k < v->n_x; k++) {
        for (int x = 0; x < v->n_x; x++) {
            v->v[k * v->n_x + x] += (v->before[x] - v->after[x]) * v->guard[k];
        }
    }
}

/* The row of a guard in an answer. */
static int row_of(const struct dalcs_radau_part *part, int guard) {
    const struct dalcs_system *s = part->component->system;
    return guard < s->n_pairs ? dalcs_system_n_equations(s) + guard
                              : dalcs_system_n_columns(s) + guard - s->n_pairs;
}

static double weigh(const struct dalcs_stage_layout *l, const double *weight, const double *out,
                    int row) {
    double sum = 0.0;
    for (int k = 0; k < l->n_nodes; k++) {
        sum += weight[k] * out[k * l->stride + row];
    }
    return sum;
}

static double size_of(const struct dalcs_variation_part *v, const double *x, const double *less) {
    double size = 0.0;
    for (int i = 0; i < v->n_x; i++) {
        double at = v->unit[i] * (x[i] - (less != NULL ? less[i] : 0.0));
        size += at * at;
    }
    return sqrt(size);
}

/* What a new mode does not allow the column to be is taken out of it: where the polynomial through the stages starts,
 * which do not see that part. Of an allowed one it differs by the step's error, which leaves the column as it is. */
static bool project(struct dalcs_variation_part *v, double *column) {
    const struct dalcs_collocation *c = v->part->stages.method;
    const int stride = v->part->stages.layout.stride;
    for (int x = 0; x < v->n_x; x++) {
        v->in[x] = 0.0;
        for (int i = 0; i < c->s; i++) {
            v->in[x] += c->back[i] * v->out[(i + 1) * stride + x];
        }
    }
    return size_of(v, v->in, column) > sqrt(v->part->tolerance) * size_of(v, column, NULL);
}

/* The step for v->in, which holds states alone. */
static enum dalcs_status apply(struct dalcs_variation_part *v, struct dalcs_stage_entry *entry) {
    struct dalcs_stages *stages = &v->part->stages;
    const size_t n_sources = (size_t)(stages->n_in - v->n_x);
    memset(v->in + v->n_x, 0, n_sources * sizeof(double));
    DALCS_TRY(dalcs_stages_apply(stages, entry, v->in, v->out));
    if (v->part->smooth == NULL) {
        return DALCS_OK;
    }
    dalcs_smooth_step_vary(v->part, v->out, v->in);
    return dalcs_stages_apply(stages, entry, v->in, v->out);
}

/* V at the end of the segment; v->guard = how the guard `row` (-1: none) moves there. */
static enum dalcs_status pass_segment(struct dalcs_variation_part *v, int row, bool is_new) {
    struct dalcs_radau_part *part = v->part;
    struct dalcs_stages *stages = &part->stages;
    struct dalcs_stage_entry *entry;
    double weight[DALCS_MAX_NODES];
    DALCS_TRY(dalcs_stages_get(stages, part->component->osnsp.mode, part->segment.h, &entry));
    dalcs_collocation_weights(stages->method, part->segment.end, weight);
    memset(v->in, 0, (size_t)stages->n_in * sizeof(double));
    if (part->smooth != NULL) {
        DALCS_TRY(dalcs_smooth_step_vary_begin(part, entry));
    }
    for (int k = 0; k < v->n_x; k++) {
        double *column = v->v + k * v->n_x;
        memcpy(v->in, column, (size_t)v->n_x * sizeof(double));
        DALCS_TRY(apply(v, entry));
        if (is_new && project(v, column)) {
            DALCS_TRY(apply(v, entry));
        }
        for (int x = 0; x < v->n_x; x++) {
            column[x] = weigh(&stages->layout, weight, v->out, x);
        }
        v->guard[k] = row >= 0 ? weigh(&stages->layout, weight, v->out, row) : 0.0;
    }
    return DALCS_OK;
}

/* f- and dt of the event that ends the segment. */
static void meet_event(struct dalcs_variation_part *v, int row) {
    const struct dalcs_radau_part *part = v->part;
    double weight[DALCS_MAX_NODES];
    derivative_weights(part->stages.method, part->segment.end, weight);
    double rate = weigh(&part->stages.layout, weight, part->segment.out, row) / part->segment.h;
    if (rate == 0.0) {
        v->is_exact = false; /* it only touches its threshold */
        return;
    }
    for (int k = 0; k < v->n_x; k++) {
        v->guard[k] *= -1.0 / rate;
    }
    dalcs_step_values(part, part->segment.end, v->y);
    find_derivative(v, v->y, part->segment.end * part->segment.h, v->before);
    v->pending = true;
}

static void segment(void *user, const struct dalcs_radau_part *present, const double *start) {
    struct dalcs_variation *variation = user;
    struct dalcs_variation_part *v = &variation->part[present->index];
    (void)start;
    bool is_new = sign_mode(v);
    if (v->n_x == 0 || variation->status < DALCS_OK) {
        return;
    }
    dalcs_recurrence_complete(v->part);
    const struct dalcs_part_guards *g = &present->guards;
    bool ends_at_event = !present->segment.by_euler && g->n_crossed > 0;
    int row = ends_at_event ? row_of(present, g->crossed[0]) : -1;
    v->is_exact = v->is_exact && !present->segment.by_euler;
    pass_event(v);
    enum dalcs_status status = pass_segment(v, row, is_new);
    if (status != DALCS_OK) {
        v->is_exact = false;
        variation->status = status < DALCS_OK ? status : variation->status;
    } else if (ends_at_event) {
        meet_event(v, row);
    }
}

/* ---- What else is told, and is not needed -------------------------------------------------------- */

static void start(void *user, int k, const double *x) {
    (void)user;
    (void)k;
    (void)x;
}

static void scale(void *user, int k, const struct dalcs_certificate *certificate) {
    (void)user;
    (void)k;
    (void)certificate;
}

static void step(void *user, int k, const double *x, const double *y, const double *inputs,
                 double h) {
    (void)user;
    (void)k;
    (void)x;
    (void)y;
    (void)inputs;
    (void)h;
}

static void jump(void *user, const struct dalcs_euler_jump *of) {
    (void)user;
    (void)of;
}

static void move(void *user, int k, const double *x, const double *after) {
    (void)user;
    (void)k;
    (void)x;
    (void)after;
}

static double sliding_step(void *user, int k, const double *x, const double *y,
                           const struct dalcs_observed_sides *sides, const double *inputs,
                           double times_h) {
    struct dalcs_variation *variation = user;
    variation->part[k].is_exact = false;
    (void)x;
    (void)y;
    (void)sides;
    (void)inputs;
    (void)times_h;
    return 0.0;
}

static void slide(void *user, int k, const double *x, const double *y, double taken) {
    struct dalcs_variation *variation = user;
    variation->part[k].is_exact = false;
    (void)x;
    (void)y;
    (void)taken;
}

static void hold(void *user) {
    (void)user;
}

struct dalcs_observer dalcs_variation_observer(struct dalcs_variation *variation) {
    return (struct dalcs_observer){.user = variation,
                                   .start = start,
                                   .scale = scale,
                                   .step = step,
                                   .jump = jump,
                                   .move = move,
                                   .segment = segment,
                                   .sliding_step = sliding_step,
                                   .slide = slide,
                                   .hold = hold,
                                   .take_back = hold};
}

/* ---- Set up -------------------------------------------------------------------------------------- */

/* And in which units energies are alike. */
static enum dalcs_status factor_P(struct dalcs_variation_part *v, const struct dalcs_system *s) {
    for (int r = 0; r < s->n_x; r++) {
        for (int k = s->P.p[r]; k < s->P.p[r + 1]; k++) {
            v->P[s->P.j[k] * s->n_x + r] += s->P.x[k];
        }
    }
    for (int x = 0; x < s->n_x; x++) {
        v->unit[x] = 1.0;
        for (int k = s->storage.p[x]; k < s->storage.p[x + 1]; k++) {
            bool stores = s->storage.j[k] == x && s->storage.x[k] > 0.0;
            v->unit[x] = stores ? sqrt(s->storage.x[k]) : v->unit[x];
        }
    }
    int failed =
        s->n_x == 0 ? 0 : LAPACKE_dgetrf(LAPACK_COL_MAJOR, s->n_x, s->n_x, v->P, s->n_x, v->pivot);
    return failed == 0 ? DALCS_OK : DALCS_SINGULAR;
}

static enum dalcs_status part_setup(struct dalcs_arena *arena, struct dalcs_variation_part *v,
                                    struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const size_t n = (size_t)s->n_x;
    const size_t n_columns = (size_t)dalcs_system_n_columns(s);
    size_t n_out = (size_t)l->n_fixed + (size_t)part->stages.method->s * n_columns + 8;
    v->part = part;
    v->n_x = part->kind == DALCS_PART_STEPPED ? s->n_x : 0;
    v->is_exact = true;
    v->v = dalcs_arena_alloc(arena, n * n, sizeof(double));
    v->P = dalcs_arena_alloc(arena, n * n, sizeof(double));
    v->pivot = dalcs_arena_alloc(arena, n, sizeof(int));
    v->in = dalcs_arena_alloc(arena, (size_t)part->stages.n_in, sizeof(double));
    v->out = dalcs_arena_alloc(arena, n_out, sizeof(double));
    v->unit = dalcs_arena_alloc(arena, n, sizeof(double));
    v->guard = dalcs_arena_alloc(arena, n, sizeof(double));
    v->before = dalcs_arena_alloc(arena, n, sizeof(double));
    v->after = dalcs_arena_alloc(arena, n, sizeof(double));
    v->inputs = dalcs_arena_alloc(arena, (size_t)s->n_inputs, sizeof(double));
    v->y = dalcs_arena_alloc(arena, (size_t)dalcs_quads_of(l->stride), sizeof(double));
    if (v->v == NULL || v->P == NULL || v->pivot == NULL || v->in == NULL || v->out == NULL ||
        v->guard == NULL || v->unit == NULL || v->before == NULL || v->after == NULL ||
        v->inputs == NULL || v->y == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        v->v[k * n + k] = 1.0;
    }
    return factor_P(v, s);
}

enum dalcs_status dalcs_variation_setup(struct dalcs_variation *variation,
                                        struct dalcs_radau *radau) {
    *variation = (struct dalcs_variation){.radau = radau, .n_parts = radau->n_parts};
    variation->part =
        dalcs_arena_alloc(&variation->arena, (size_t)radau->n_parts, sizeof(*variation->part));
    enum dalcs_status status = variation->part != NULL ? DALCS_OK : DALCS_E_NOMEM;
    for (int k = 0; k < radau->n_parts && status == DALCS_OK; k++) {
        status = part_setup(&variation->arena, &variation->part[k], &radau->part[k]);
    }
    if (status != DALCS_OK) {
        dalcs_variation_finish(variation);
    }
    return status;
}

void dalcs_variation_finish(struct dalcs_variation *variation) {
    dalcs_arena_finish(&variation->arena);
    *variation = (struct dalcs_variation){0};
}

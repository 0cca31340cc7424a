/* variation.c - V through segments and events. */
#include "variation.h"

#include "quads.h"
#include "recurrence.h"
#include "restart.h"
#include "segments_observer.h"
#include "smooth_step.h"
#include "step_error.h"
#include "variation_columns.h"
#include "variation_rank.h"

#include <math.h>
#include <string.h>

/* ---- Segments ------------------------------------------------------------------------------------ */

/* Two runs differ where their modes follow each other in another order. Returns whether this mode is another one. */
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

/* V += f dt of the event. */
static void shift(struct dalcs_variation_part *v, const double *f) {
    for (int k = 0; k < v->n_columns; k++) {
        for (int x = 0; x < v->n_x; x++) {
            v->v[k * v->n_x + x] += f[x] * v->guard[k];
        }
    }
}

/* What the event before has done, now that f+ is known: V += (f- - f+) dt. */
static void pass_event(struct dalcs_variation_part *v) {
    if (!v->pending) {
        return;
    }
    v->pending = false;
    const int stride = v->part->stages.layout.stride;
    memcpy(v->y, v->part->segment.out, (size_t)stride * sizeof(double));
    dalcs_orbit_rates_of(&v->rates, v->y, 0.0, v->after);
    for (int x = 0; x < v->n_x; x++) {
        v->before[x] -= v->after[x];
    }
    shift(v, v->before);
}

static double size_of(const struct dalcs_variation_part *v, const double *x, const double *less) {
    double size = 0.0;
    for (int i = 0; i < v->n_x; i++) {
        double at = v->rates.unit[i] * (x[i] - (less != NULL ? less[i] : 0.0));
        size += at * at;
    }
    return sqrt(size);
}

/* Where the polynomial through the stages of v->out starts. */
static void find_start(const struct dalcs_variation_part *v, double *start) {
    const struct dalcs_collocation *c = v->part->stages.method;
    const int stride = v->part->stages.layout.stride;
    for (int x = 0; x < v->n_x; x++) {
        start[x] = 0.0;
        for (int i = 0; i < c->n_stages; i++) {
            start[x] += c->back[i] * v->out[(i + 1) * stride + x];
        }
    }
}

/* What a new mode does not allow the column to be is taken out of it: where the polynomial through the stages starts,
 * which do not see that part. Of an allowed one it differs by the step's error, which leaves the column as it is. */
static bool project(struct dalcs_variation_part *v, double *column) {
    const struct dalcs_collocation *c = v->part->stages.method;
    const int stride = v->part->stages.layout.stride;
    find_start(v, v->in);
    double size = size_of(v, column, NULL);
    if (v->gates != NULL) { /* an output that is off may drive it from 0 */
        size = fmax(size, size_of(v, v->out + c->s * stride, NULL));
    }
    return size_of(v, v->in, column) > sqrt(v->part->tolerance) * size;
}

/* The step for v->in, which holds the states of column k. */
static enum dalcs_status apply(struct dalcs_variation_part *v, struct dalcs_stage_entry *entry,
                               int k) {
    struct dalcs_stages *stages = &v->part->stages;
    const size_t n_sources = (size_t)(stages->n_in - v->n_x);
    memset(v->in + v->n_x, 0, n_sources * sizeof(double));
    if (v->gates != NULL) {
        dalcs_gate_variation_drive(v->gates, k, v->in);
    }
    DALCS_TRY(dalcs_stages_apply(stages, entry, v->in, v->out));
    if (v->part->smooth == NULL) {
        return DALCS_OK;
    }
    dalcs_smooth_step_vary(v->part, v->out, v->in);
    return dalcs_stages_apply(stages, entry, v->in, v->out);
}

/* Where the states of the impulses are held: what a diode conducts for an instant alone, and is open behind, takes out of V
 * what nothing behind the jump shows. The mode is that of the first micro-step; in it the polynomial through the stages
 * starts where the states come to (Heemels, Schumacher and Weiland 1999, sec. 4). An event that moves the jump adds f- dt
 * before it, and takes f+ dt away behind it. */
static enum dalcs_status pass_jump(const struct dalcs_radau *radau,
                                   struct dalcs_variation_part *v) {
    struct dalcs_stage_entry *entry;
    v->jumped = false;
    DALCS_TRY(dalcs_stages_get(&v->part->stages, v->jump_mode,
                               dalcs_radau_micro_length(radau, v->part, 0), &entry));
    if (v->pending) {
        shift(v, v->before);
        memset(v->before, 0, (size_t)v->n_x * sizeof(double));
    }
    if (dalcs_variation_shares(v, entry)) {
        dalcs_variation_project_columns(v, entry);
        return DALCS_OK;
    }
    for (int k = 0; k < v->n_columns; k++) {
        double *column = v->v + k * v->n_x;
        memset(v->in, 0, (size_t)v->part->stages.n_in * sizeof(double));
        memcpy(v->in, column, (size_t)v->n_x * sizeof(double));
        DALCS_TRY(dalcs_stages_apply(&v->part->stages, entry, v->in, v->out));
        find_start(v, column);
    }
    return DALCS_OK;
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
    if (dalcs_variation_shares(v, entry)) {
        if (!dalcs_variation_pass_rank(v, entry, weight, row, is_new)) {
            dalcs_variation_pass_columns(v, entry, weight, row, is_new);
        }
        return DALCS_OK;
    }
    for (int k = 0; k < v->n_columns; k++) {
        double *column = v->v + k * v->n_x;
        memcpy(v->in, column, (size_t)v->n_x * sizeof(double));
        DALCS_TRY(apply(v, entry, k));
        if (is_new && project(v, column)) {
            DALCS_TRY(apply(v, entry, k));
        }
        for (int x = 0; x < v->n_x; x++) {
            column[x] = dalcs_orbit_weigh(&stages->layout, weight, v->out, x);
        }
        v->guard[k] = row >= 0 ? dalcs_orbit_weigh(&stages->layout, weight, v->out, row) : 0.0;
        if (v->gates != NULL) {
            dalcs_gate_variation_read(v->gates, k, weight, v->out);
        }
    }
    return DALCS_OK;
}

/* f where the run begins, and where it ends. */
static void note_flow(struct dalcs_variation_part *v, double stop) {
    const struct dalcs_radau_part *part = v->part;
    if (!v->begun) {
        memcpy(v->y, part->segment.out, (size_t)part->stages.layout.stride * sizeof(double));
        dalcs_orbit_rates_of(&v->rates, v->y, 0.0, v->first);
        v->begun = true;
    }
    if (part->segment.t_end >= stop) {
        dalcs_step_values(part, part->segment.end, v->y);
        dalcs_orbit_rates_of(&v->rates, v->y, part->segment.end * part->segment.h, v->last);
    }
}

/* f- where the segment ends. */
static void find_before(struct dalcs_variation_part *v) {
    const struct dalcs_radau_part *part = v->part;
    dalcs_step_values(part, part->segment.end, v->y);
    dalcs_orbit_rates_of(&v->rates, v->y, part->segment.end * part->segment.h, v->before);
}

/* f- and dt of the event that ends the segment. */
static void meet_event(struct dalcs_variation_part *v, int row) {
    const struct dalcs_radau_part *part = v->part;
    double rate = dalcs_orbit_guard_rate(part, row);
    if (rate == 0.0) {
        v->is_exact = false; /* it only touches its threshold */
        return;
    }
    for (int k = 0; k < v->n_columns; k++) {
        v->guard[k] *= -1.0 / rate;
    }
    if (!isfinite(v->moved)) {
        v->moved = part->segment.t_end;
        memcpy(v->moves, v->guard, (size_t)v->n_columns * sizeof(double));
    }
    find_before(v);
    v->pending = true;
}

/* Commands along the outputs of gates, and what gates may do where the segment ends. */
static void meet_gates(struct dalcs_variation_part *v) {
    bool moves;
    if (!v->pending) {
        find_before(v);
    }
    const bool is_known = v->pending;
    dalcs_gate_variation_end(v->gates, &moves);
    v->pending = is_known || moves;
}

/* The jump that was told last, if it is in another mode than what follows it. */
static bool pass_jump_before(struct dalcs_variation *variation, struct dalcs_variation_part *v,
                             const uint64_t *mode) {
    if (!v->jumped || dalcs_mode_is(v->jump_mode, mode, v->part->stages.n_words)) {
        v->jumped = false;
        return false;
    }
    const enum dalcs_status status = pass_jump(variation->radau, v);
    v->is_exact = v->is_exact && status == DALCS_OK;
    variation->status = status < DALCS_OK ? status : variation->status;
    return status == DALCS_OK;
}

/* The mode of a jump counts where it is not that of the segment behind it, which takes out as much. */
static void jump(void *user, const struct dalcs_euler_jump *told) {
    struct dalcs_variation *variation = user;
    struct dalcs_variation_part *v = &variation->part[told->system];
    if (v->n_columns == 0 || variation->status < DALCS_OK) {
        return;
    }
    pass_jump_before(variation, v, v->part->work.mode_first);
    memcpy(v->jump_mode, v->part->work.mode_first,
           (size_t)v->part->stages.n_words * sizeof(*v->jump_mode));
    v->jumped = true;
}

static void segment(void *user, const struct dalcs_radau_part *present, const double *start) {
    struct dalcs_variation *variation = user;
    struct dalcs_variation_part *v = &variation->part[present->index];
    (void)start;
    bool is_new = sign_mode(v);
    if (v->n_columns == 0 || variation->status < DALCS_OK) {
        return;
    }
    dalcs_recurrence_complete(v->part);
    const struct dalcs_part_guards *g = &present->guards;
    bool ends_at_event = !present->segment.by_euler && g->n_crossed > 0;
    int row = ends_at_event ? dalcs_orbit_guard_row(present, g->crossed[0]) : -1;
    v->is_exact = v->is_exact && !present->segment.by_euler;
    is_new = pass_jump_before(variation, v, present->component->osnsp.mode) || is_new;
    pass_event(v);
    note_flow(v, variation->radau->options.stop);
    if (v->gates != NULL) {
        dalcs_gate_variation_begin(v->gates);
    }
    enum dalcs_status status = pass_segment(v, row, is_new || v->gates != NULL);
    if (status != DALCS_OK) {
        v->is_exact = false;
        variation->status = status < DALCS_OK ? status : variation->status;
        return;
    }
    if (ends_at_event) {
        meet_event(v, row);
    }
    if (v->gates != NULL) {
        meet_gates(v);
    }
}

/* ---- What implicit Euler makes is not exact --------------------------------------------------------- */

static void try_by_euler(void *user, int k) {
    struct dalcs_variation *variation = user;
    variation->part[k].is_exact = false;
}

struct dalcs_observer dalcs_variation_observer(struct dalcs_variation *variation) {
    struct dalcs_observer observer = dalcs_segments_observer(variation, segment);
    observer.jump = jump;
    observer.try_by_euler = try_by_euler;
    return observer;
}

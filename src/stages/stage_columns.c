/* stage_columns.c - four differences of states through a step on sparse factors: stage_factors.c has the equations. */
#include "stage_columns.h"

#include "columns_solve.h"
#include "stage_update.h"
#include "wide_vectors.h"

#include <string.h>

/* A guard as a sum of columns of the system. */
struct guard {
    int n;
    int one;          /* of a sum of one */
    const int *index; /* [n] */
    const double *coefficient;
};

/* One step. */
struct walk {
    const struct dalcs_stages *stages;
    const struct dalcs_stage_entry *entry;
    struct dalcs_stage_columns *c;
    struct guard guard;
    dalcs_four *rhs;                                               /* [n_rows] */
    dalcs_four *solved;                                            /* [2 (n_rows + spare)] */
    dalcs_four *missed;                                            /* [n_x] */
    double end[DALCS_SOLUTION_PARTS], begin[DALCS_SOLUTION_PARTS]; /* of states, from parts */
};

size_t dalcs_stage_columns_room(const struct dalcs_system *s) {
    const size_t n_rows = (size_t)dalcs_system_n_columns(s);
    return n_rows + 2 * (n_rows + DALCS_LU_SPARE) + (size_t)s->n_x;
}

bool dalcs_stage_columns_can(const struct dalcs_stage_entry *entry) {
    return entry->map == NULL && entry->factors->singular.n == 0;
}

/* ---- Guards -------------------------------------------------------------------------------------- */

static struct guard guard_of(const struct dalcs_stages *stages,
                             const struct dalcs_stage_entry *entry, int row) {
    static const double once = 1.0;
    const struct dalcs_system *s = stages->system;
    const int n_equations = dalcs_system_n_equations(s);
    const int watched = row - dalcs_system_n_columns(s);
    const int pair = watched >= 0 ? stages->watched[watched] : row - n_equations;
    if (row < 0) {
        return (struct guard){0};
    }
    if (watched < 0 && (dalcs_stage_is_on(entry, pair) || s->pair[pair].kind != DALCS_PAIR_DIODE)) {
        return (struct guard){.n = 1, .one = row, .coefficient = &once};
    }
    const struct dalcs_csr *a = watched >= 0 ? &s->control : &s->C;
    const int first = a->p[pair];
    return (struct guard){
        .n = a->p[pair + 1] - first, .index = a->j + first, .coefficient = a->x + first};
}

static int guard_column(const struct guard *g, int k) {
    return g->index != NULL ? g->index[k] : g->one;
}

/* Where the k-th of the guard's unknowns is in w->solved, of a part, and its scale; NULL: it is none, or not one of the
 * states, or of the unknowns without memory, that are asked for. */
static dalcs_four *place_in_guard(const struct walk *w, int system, int part, bool states, int k,
                                  double *scale) {
    const struct dalcs_stage_factors *f = w->entry->factors;
    const int u = dalcs_stage_unknown(f, guard_column(&w->guard, k));
    if (u < 0 || (u < w->stages->system->n_x) != states) {
        return NULL;
    }
    const int pair = u - (f->n - f->n_pairs);
    const struct dalcs_stage_order *o = &f->order[system];
    const int at = pair >= 0 ? o->of_pair[pair] : o->position[u];
    *scale = pair >= 0 ? f->pair_scale[pair] : f->column_scale[u];
    return &w->solved[at * (system > 0 ? 2 : 1) + part];
}

/* c->guard += sum of the guard's unknowns without memory, or of its states, in w->solved, of a part. */
static void add_to_guard(const struct walk *w, int system, int part, bool states, double factor) {
    double scale;
    for (int k = 0; k < w->guard.n; k++) {
        const dalcs_four *at = place_in_guard(w, system, part, states, k, &scale);
        if (at != NULL) {
            w->c->guard += w->guard.coefficient[k] * factor * scale * *at;
        }
    }
}

/* ---- Steps --------------------------------------------------------------------------------------- */

static void set_weights(struct walk *w) {
    const struct dalcs_stage_plan *plan = w->stages->plan;
    const struct dalcs_collocation *m = w->stages->method;
    for (int q = 0; q < plan->n_parts; q++) {
        w->end[q] = 0.0;
        w->begin[q] = plan->to[0][q];
        for (int i = 0; i < m->s; i++) {
            w->end[q] += w->c->weight[i + 1] * plan->to[i + 1][q];
        }
    }
}

/* The states, their differences at nodes being what parts of them make: parts `first` and behind, of one system. */
DALCS_TWICE(void, put_states, (const struct walk *w, int system, int first), (w, system, first)) {
    const struct dalcs_stage_factors *f = w->entry->factors;
    const double *to_start = w->stages->plan->to[0];
    const int n_parts = system > 0 ? 2 : 1;
    for (int x = 0; x < w->stages->system->n_x; x++) {
        const double scale = f->column_scale[x];
        for (int part = 0; part < n_parts; part++) {
            const dalcs_four *z = &w->solved[f->order[system].position[x] * n_parts + part];
            const double end = scale * w->end[first + part];
            const double begin = scale * w->begin[first + part];
            const double start = scale * to_start[first + part];
            w->c->end[x] += end * *z;
            w->c->begin[x] += begin * *z;
            w->missed[x] -= start * *z;
        }
    }
}

static void put_guard(const struct walk *w, int system, int first) {
    const double *to_start = w->stages->plan->to[0];
    for (int part = 0; part < (system > 0 ? 2 : 1); part++) {
        const double end = w->end[first + part];
        add_to_guard(w, system, part, true, end);
        add_to_guard(w, system, part, false, end + w->c->weight[0] * to_start[first + part]);
    }
}

DALCS_TWICE(void, find_drive, (const struct walk *w, const dalcs_four *states), (w, states)) {
    const struct dalcs_csr *a = &w->stages->plan->drive_of_states;
    for (int r = 0; r < a->n_rows; r++) {
        dalcs_four sum = {0.0};
        for (int k = a->p[r]; k < a->p[r + 1]; k++) {
            sum += a->x[k] * states[a->j[k]];
        }
        w->rhs[r] = sum;
    }
}

static void solve(const struct walk *w, int system, const dalcs_four *states) {
    find_drive(w, states);
    dalcs_columns_solve(w->entry->factors, system, w->rhs, w->solved);
}

/* What of the guard at the start is corrected for what the states miss there, as in dalcs_stage_factors_apply. */
static void correct_start(const struct walk *w) {
    const struct dalcs_stage_factors *f = w->entry->factors;
    const double weight = w->c->weight[0];
    solve(w, 0, w->missed);
    add_to_guard(w, 0, 0, false, weight);
    for (int x = 0; x < w->stages->system->n_x; x++) {
        w->missed[x] = -f->column_scale[x] * w->solved[f->order[0].position[x]];
    }
    solve(w, 0, w->missed);
    add_to_guard(w, 0, 0, false, weight);
}

static void begin(const struct walk *w) {
    struct dalcs_stage_columns *c = w->c;
    const size_t n_x = (size_t)w->stages->system->n_x;
    memcpy(c->end, c->states, n_x * sizeof *c->end);
    memcpy(c->begin, c->states, n_x * sizeof *c->begin);
    memset(w->missed, 0, n_x * sizeof *w->missed);
    memset(&c->guard, 0, sizeof c->guard);
    for (int k = 0; k < w->guard.n; k++) {
        const int u = guard_column(&w->guard, k);
        if (u < (int)n_x) {
            c->guard += w->guard.coefficient[k] * c->states[u];
        }
    }
}

static struct walk walk_of(const struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                           struct dalcs_stage_columns *c) {
    const int n_rows = stages->plan->n_rows;
    struct walk w = {.stages = stages,
                     .entry = entry,
                     .c = c,
                     .guard = guard_of(stages, entry, c->row),
                     .rhs = c->work,
                     .solved = c->work + n_rows,
                     .missed = c->work + n_rows + 2 * (n_rows + DALCS_LU_SPARE)};
    set_weights(&w);
    return w;
}

/* Does the guard read what the states miss at the start? */
static bool reads_start(const struct walk *w) {
    return w->guard.n > 0 && w->c->weight[0] != 0.0;
}

static int first_part(int system) {
    return system > 0 ? 2 * system - 1 : 0;
}

void dalcs_stage_columns_apply(const struct dalcs_stages *stages,
                               const struct dalcs_stage_entry *entry,
                               struct dalcs_stage_columns *c) {
    const struct walk w = walk_of(stages, entry, c);
    begin(&w);
    find_drive(&w, c->states);
    for (int q = 0; q < entry->factors->n_systems; q++) {
        dalcs_columns_solve(entry->factors, q, w.rhs, w.solved);
        put_states(&w, q, first_part(q));
        put_guard(&w, q, first_part(q));
    }
    if (reads_start(&w)) {
        correct_start(&w);
    }
}

/* ---- Transposed ---------------------------------------------------------------------------------------- */

/* w->solved += c->guard times what add_to_guard reads. */
static void take_of_guard(const struct walk *w, int system, int part, bool states, double factor) {
    double scale;
    for (int k = 0; k < w->guard.n; k++) {
        dalcs_four *at = place_in_guard(w, system, part, states, k, &scale);
        if (at != NULL) {
            *at += w->guard.coefficient[k] * factor * scale * w->c->guard;
        }
    }
}

static void clear_solved(const struct walk *w) {
    memset(w->solved, 0,
           2 * (size_t)(w->stages->plan->n_rows + DALCS_LU_SPARE) * sizeof *w->solved);
}

/* states += the transposed drive of w->rhs. */
DALCS_TWICE(void, drive_back, (const struct walk *w, dalcs_four *states), (w, states)) {
    const struct dalcs_csr *a = &w->stages->plan->drive_of_states;
    for (int r = 0; r < a->n_rows; r++) {
        for (int k = a->p[r]; k < a->p[r + 1]; k++) {
            states[a->j[k]] += a->x[k] * w->rhs[r];
        }
    }
}

static void clear_rhs(const struct walk *w) {
    memset(w->rhs, 0, (size_t)w->stages->plan->n_rows * sizeof *w->rhs);
}

/* w->missed = how the guard depends on it. */
static void correct_start_back(const struct walk *w) {
    const struct dalcs_stage_factors *f = w->entry->factors;
    const int n_x = w->stages->system->n_x;
    const double weight = w->c->weight[0];
    for (int pass = 0; pass < 2; pass++) {
        clear_solved(w);
        take_of_guard(w, 0, 0, false, weight);
        for (int x = 0; x < n_x && pass > 0; x++) {
            w->solved[f->order[0].position[x]] -= f->column_scale[x] * w->missed[x];
        }
        clear_rhs(w);
        dalcs_columns_solve_back(f, 0, w->solved, w->rhs);
        memset(w->missed, 0, (size_t)n_x * sizeof *w->missed);
        drive_back(w, w->missed);
    }
}

/* w->solved = how what is asked depends on the answer of a system. */
static void ask_of_states(const struct walk *w, int system, int first) {
    const struct dalcs_stage_factors *f = w->entry->factors;
    const double *to_start = w->stages->plan->to[0];
    const int n_parts = system > 0 ? 2 : 1;
    clear_solved(w);
    for (int part = 0; part < n_parts; part++) {
        const double end = w->end[first + part];
        const double start = to_start[first + part];
        for (int x = 0; x < w->stages->system->n_x; x++) {
            w->solved[f->order[system].position[x] * n_parts + part] =
                f->column_scale[x] * (end * w->c->end[x] - start * w->missed[x]);
        }
        take_of_guard(w, system, part, true, end);
        take_of_guard(w, system, part, false, end + w->c->weight[0] * start);
    }
}

void dalcs_stage_columns_apply_back(const struct dalcs_stages *stages,
                                    const struct dalcs_stage_entry *entry,
                                    struct dalcs_stage_columns *c) {
    const struct walk w = walk_of(stages, entry, c);
    const int n_x = stages->system->n_x;
    memset(w.missed, 0, (size_t)n_x * sizeof *w.missed);
    if (reads_start(&w)) {
        correct_start_back(&w);
    }
    memcpy(c->states, c->end, (size_t)n_x * sizeof *c->states);
    for (int k = 0; k < w.guard.n; k++) {
        const int u = guard_column(&w.guard, k);
        if (u < n_x) {
            c->states[u] += w.guard.coefficient[k] * c->guard;
        }
    }
    clear_rhs(&w);
    for (int q = 0; q < entry->factors->n_systems; q++) {
        ask_of_states(&w, q, first_part(q));
        dalcs_columns_solve_back(entry->factors, q, w.solved, w.rhs);
    }
    drive_back(&w, c->states);
}

/* variation_columns.c - columns of V through a segment, four at once. */
#include "variation_columns.h"

#include "variation_rank.h"

#include <math.h>
#include <string.h>

enum dalcs_status dalcs_variation_columns_setup(struct dalcs_variation_part *v,
                                                struct dalcs_arena *arena) {
    struct dalcs_stages *stages = &v->part->stages;
    const size_t n_x = (size_t)v->n_x + 1;
    if (dalcs_stages_have_maps(stages)) {
        return DALCS_OK;
    }
    const size_t room = dalcs_stage_columns_room(stages->system);
    dalcs_four *storage = dalcs_arena_alloc(arena, 3 * n_x + room, sizeof *storage);
    if (storage == NULL) {
        return DALCS_E_NOMEM;
    }
    v->four = (struct dalcs_stage_columns){.states = storage,
                                           .end = storage + n_x,
                                           .begin = storage + 2 * n_x,
                                           .work = storage + 3 * n_x};
    return dalcs_variation_rank_setup(v, arena);
}

bool dalcs_variation_shares(const struct dalcs_variation_part *v,
                            const struct dalcs_stage_entry *entry) {
    return v->four.work != NULL && v->part->smooth == NULL && v->gates == NULL &&
           dalcs_stage_columns_can(entry);
}

/* Columns from `first` on to `four`; those behind the last are 0. */
static void load(struct dalcs_variation_part *v, int first) {
    for (int l = 0; l < DALCS_COLUMNS; l++) {
        const bool is_there = first + l < v->n_columns;
        const double *column = v->v + (size_t)(is_there ? first + l : 0) * (size_t)v->n_x;
        for (int x = 0; x < v->n_x; x++) {
            v->four.states[x][l] = is_there ? column[x] : 0.0;
        }
    }
}

static void unload(struct dalcs_variation_part *v, int first) {
    for (int l = 0; l < DALCS_COLUMNS && first + l < v->n_columns; l++) {
        double *column = v->v + (size_t)(first + l) * (size_t)v->n_x;
        for (int x = 0; x < v->n_x; x++) {
            column[x] = v->four.end[x][l];
        }
    }
}

static void unload_guard(struct dalcs_variation_part *v, int first) {
    for (int l = 0; l < DALCS_COLUMNS && first + l < v->n_columns; l++) {
        v->guard[first + l] = v->four.guard[l];
    }
}

/* What a new mode does not allow is taken out of the four, as variation.c does with a column. Is there any? */
static bool project(struct dalcs_variation_part *v) {
    struct dalcs_stage_columns *c = &v->four;
    bool any = false;
    for (int l = 0; l < DALCS_COLUMNS; l++) {
        double size = 0.0;
        double off = 0.0;
        for (int x = 0; x < v->n_x; x++) {
            const double at = v->rates.unit[x] * c->states[x][l];
            const double moved = v->rates.unit[x] * (c->begin[x][l] - c->states[x][l]);
            size += at * at;
            off += moved * moved;
        }
        const bool is = sqrt(off) > sqrt(v->part->tolerance) * sqrt(size);
        for (int x = 0; x < v->n_x && is; x++) {
            c->states[x][l] = c->begin[x][l];
        }
        any = any || is;
    }
    return any;
}

void dalcs_variation_pass_columns(struct dalcs_variation_part *v,
                                  const struct dalcs_stage_entry *entry, const double *weight,
                                  int row, bool is_new) {
    v->four.weight = weight;
    v->four.row = row;
    for (int k = 0; k < v->n_columns; k += DALCS_COLUMNS) {
        load(v, k);
        dalcs_stage_columns_apply(&v->part->stages, entry, &v->four);
        if (is_new && project(v)) {
            dalcs_stage_columns_apply(&v->part->stages, entry, &v->four);
        }
        unload(v, k);
        unload_guard(v, k);
    }
}

void dalcs_variation_project_columns(struct dalcs_variation_part *v,
                                     const struct dalcs_stage_entry *entry) {
    const double weight[DALCS_MAX_NODES] = {0.0};
    v->four.weight = weight;
    v->four.row = -1;
    for (int k = 0; k < v->n_columns; k += DALCS_COLUMNS) {
        load(v, k);
        dalcs_stage_columns_apply(&v->part->stages, entry, &v->four);
        memcpy(v->four.end, v->four.begin, (size_t)v->n_x * sizeof *v->four.end);
        unload(v, k);
    }
}

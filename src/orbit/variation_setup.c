/* variation_setup.c - room for V of all parts, and for what gates add to it. */
#include "variation.h"

#include "quads.h"
#include "variation_columns.h"

#include <math.h>

static enum dalcs_status part_setup(struct dalcs_arena *arena, struct dalcs_variation_part *v,
                                    struct dalcs_radau_part *part, int n_numbers,
                                    bool modes_alone) {
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const size_t n = (size_t)s->n_x;
    const size_t n_all = n + (size_t)n_numbers;
    const size_t n_out = dalcs_stages_room(&part->stages);
    v->part = part;
    v->n_x = part->kind == DALCS_PART_STEPPED && !modes_alone ? s->n_x : 0;
    v->n_columns = part->kind == DALCS_PART_STEPPED && !modes_alone ? v->n_x + n_numbers : 0;
    v->is_exact = true;
    v->moved = INFINITY;
    if (modes_alone) {
        return DALCS_OK;
    }
    v->v = dalcs_arena_alloc(arena, n_all * n, sizeof(double));
    v->in = dalcs_arena_alloc(arena, (size_t)part->stages.n_in, sizeof(double));
    v->out = dalcs_arena_alloc(arena, n_out, sizeof(double));
    v->guard = dalcs_arena_alloc(arena, n_all, sizeof(double));
    v->before = dalcs_arena_alloc(arena, n, sizeof(double));
    v->after = dalcs_arena_alloc(arena, n, sizeof(double));
    v->first = dalcs_arena_alloc(arena, n, sizeof(double));
    v->last = dalcs_arena_alloc(arena, n, sizeof(double));
    v->moves = dalcs_arena_alloc(arena, n_all, sizeof(double));
    v->y = dalcs_arena_alloc(arena, (size_t)dalcs_quads_of(l->stride), sizeof(double));
    v->jump_mode =
        dalcs_arena_alloc(arena, (size_t)part->stages.n_words + 1, sizeof(*v->jump_mode));
    if (v->v == NULL || v->in == NULL || v->out == NULL || v->guard == NULL || v->before == NULL ||
        v->after == NULL || v->first == NULL || v->last == NULL || v->moves == NULL ||
        v->y == NULL || v->jump_mode == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        v->v[k * n + k] = 1.0;
    }
    DALCS_TRY(dalcs_variation_columns_setup(v, arena));
    return dalcs_orbit_rates_setup(&v->rates, arena, part);
}

static enum dalcs_status gates_setup(struct dalcs_variation *variation,
                                     struct dalcs_logic_run *logic,
                                     const struct dalcs_logic_memory *memory) {
    struct dalcs_variation_part *v = &variation->part[0];
    struct dalcs_gate_variation *g = dalcs_arena_alloc(&variation->arena, 1, sizeof *g);
    if (g == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_gate_variation_setup(g, &variation->arena, variation->radau, logic, memory));
    g->event.dt = v->guard;
    g->event.pending = &v->pending;
    g->event.is_exact = &v->is_exact;
    g->event.rates = &v->rates;
    variation->gates = v->gates = g;
    return DALCS_OK;
}

enum dalcs_status dalcs_variation_setup(struct dalcs_variation *variation,
                                        struct dalcs_radau *radau, struct dalcs_logic_run *logic,
                                        const struct dalcs_logic_memory *memory, bool modes_alone) {
    *variation = (struct dalcs_variation){.radau = radau, .n_parts = radau->n_parts};
    variation->part =
        dalcs_arena_alloc(&variation->arena, (size_t)radau->n_parts, sizeof(*variation->part));
    enum dalcs_status status = variation->part != NULL ? DALCS_OK : DALCS_E_NOMEM;
    for (int k = 0; k < radau->n_parts && status == DALCS_OK; k++) {
        status = part_setup(&variation->arena, &variation->part[k], &radau->part[k],
                            memory->n_numbers, modes_alone);
    }
    if (status == DALCS_OK && logic->circuit != NULL && !modes_alone) {
        status = gates_setup(variation, logic, memory);
    }
    if (status != DALCS_OK) {
        dalcs_variation_finish(variation);
    }
    return status;
}

void dalcs_variation_finish(struct dalcs_variation *variation) {
    if (variation->gates != NULL) {
        dalcs_gate_variation_finish(variation->gates);
    }
    dalcs_arena_finish(&variation->arena);
    *variation = (struct dalcs_variation){0};
}

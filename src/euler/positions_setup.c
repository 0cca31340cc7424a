/* positions_setup.c - which switches have a control that reads the circuit, and room for where they may stand. */
#include "observer.h"
#include "positions.h"

#include <stdlib.h>

static bool allocate_sides(struct dalcs_positions *p, struct dalcs_arena *arena) {
    const struct dalcs_system *s = p->osnsp->system;
    const size_t n_turning = (size_t)p->n + (size_t)p->n_jumps;
    struct dalcs_slide_sides *sides = &p->sides;
    sides->kin = dalcs_arena_alloc(arena, n_turning, sizeof(int));
    sides->group = dalcs_arena_alloc(arena, n_turning, sizeof(int));
    sides->is_other = dalcs_arena_alloc(arena, n_turning, sizeof(bool));
    sides->y = dalcs_arena_alloc(arena, DALCS_MOST_SIDES * (size_t)dalcs_system_n_columns(s),
                                 sizeof(double));
    sides->off = dalcs_arena_alloc(
        arena, 2 * ((size_t)dalcs_system_n_columns(s) + (size_t)s->n_pairs), sizeof(double));
    sides->w_of_y = dalcs_arena_alloc(arena, (size_t)s->n_pairs, sizeof(double));
    sides->w = dalcs_arena_alloc(arena, DALCS_MOST_SIDES * (size_t)s->n_pairs, sizeof(double));
    sides->mode =
        dalcs_arena_alloc(arena, DALCS_MOST_SIDES * (size_t)p->osnsp->n_words, sizeof(uint64_t));
    sides->conducted = dalcs_arena_alloc(arena, (size_t)p->osnsp->n_words, sizeof(uint64_t));
    sides->standing = dalcs_arena_alloc(arena, n_turning, sizeof(int));
    sides->leading = dalcs_arena_alloc(arena, n_turning, sizeof(bool));
    return sides->kin != NULL && sides->is_other != NULL && sides->group != NULL &&
           sides->y != NULL && sides->w != NULL && sides->w_of_y != NULL && sides->off != NULL &&
           sides->mode != NULL && sides->conducted != NULL && sides->leading != NULL &&
           sides->standing != NULL;
}

enum dalcs_status dalcs_positions_setup(struct dalcs_positions *p, struct dalcs_osnsp *osnsp,
                                        struct dalcs_arena *arena) {
    const struct dalcs_system *s = osnsp->system;
    size_t n_words = (size_t)osnsp->n_words;
    *p = (struct dalcs_positions){.osnsp = osnsp, .settled = true};
    for (int d = 0; d < s->n_pairs; d++) {
        p->n += s->pair[d].kind == DALCS_PAIR_SWITCH && !s->pair[d].is_direct ? 1 : 0;
    }
    for (int d = 0; d < s->n_pairs; d++) {
        p->n_jumps += s->pair[d].is_jump ? 1 : 0;
    }
    if (!dalcs_positions_may_slide(p)) {
        p->n_jumps = 0;
        return DALCS_OK;
    }
    const size_t n_turning = (size_t)p->n + (size_t)p->n_jumps;
    p->jump = dalcs_arena_alloc(arena, (size_t)p->n_jumps, sizeof(int));
    p->gap = dalcs_arena_alloc(arena, n_turning, sizeof(double));
    p->follows = dalcs_arena_alloc(arena, n_turning, sizeof(bool));
    p->is_compared = dalcs_arena_alloc(arena, n_turning, sizeof(bool));
    p->leads = dalcs_arena_alloc(arena, n_turning, sizeof(bool));
    p->pair = dalcs_arena_alloc(arena, (size_t)p->n, sizeof(int));
    p->slack = dalcs_arena_alloc(arena, n_turning, sizeof(double));
    p->mask = dalcs_arena_alloc(arena, n_words, sizeof(uint64_t));
    p->first = dalcs_arena_alloc(arena, n_words, sizeof(uint64_t));
    p->present = dalcs_arena_alloc(arena, n_words, sizeof(uint64_t));
    p->mark = dalcs_arena_alloc(arena, n_words, sizeof(uint64_t));
    p->turned = dalcs_arena_alloc(arena, n_words, sizeof(uint64_t));
    p->other = dalcs_arena_alloc(arena, n_words, sizeof(uint64_t));
    p->other_y = dalcs_arena_alloc(arena, (size_t)dalcs_system_n_columns(s), sizeof(double));
    p->other_w = dalcs_arena_alloc(arena, (size_t)s->n_pairs, sizeof(double));
    if (p->pair == NULL || p->slack == NULL || p->mask == NULL || p->first == NULL ||
        p->present == NULL || p->mark == NULL || p->turned == NULL || p->other == NULL ||
        p->other_y == NULL || p->other_w == NULL || p->jump == NULL || p->gap == NULL ||
        p->follows == NULL || p->is_compared == NULL || p->leads == NULL ||
        !allocate_sides(p, arena)) {
        return DALCS_E_NOMEM;
    }
    for (int d = 0, i = 0, k = 0; d < s->n_pairs; d++) {
        if (s->pair[d].is_jump) {
            p->jump[k++] = d;
        }
        if (s->pair[d].kind == DALCS_PAIR_SWITCH && !s->pair[d].is_direct) {
            p->pair[i++] = d;
            p->mask[d / 64] |= (uint64_t)1 << (d % 64);
        }
    }
    return DALCS_OK;
}

void dalcs_positions_finish(struct dalcs_positions *p) {
    free(p->tried.mode);
    *p = (struct dalcs_positions){0};
}

/* steady_setup.c - the order of states, switches and the memory of gates in one vector, and memory for the search. */
#include "steady.h"

bool dalcs_steady_make_point(struct dalcs_steady *st, struct dalcs_orbit_point *point) {
    point->layout = &st->layout;
    point->x = dalcs_arena_alloc(&st->arena, (size_t)st->layout.n_x + 1, sizeof(double));
    point->closed = dalcs_arena_alloc(&st->arena, (size_t)st->layout.n_pairs + 1, sizeof(bool));
    return point->x != NULL && point->closed != NULL;
}

enum dalcs_status dalcs_steady_setup(struct dalcs_steady *st, struct dalcs_run *r, double period) {
    const struct dalcs_network *network = &r->s->network;
    const size_t n = (size_t)network->n_systems + 1;
    *st = (struct dalcs_steady){.run = r, .period = period};
    struct dalcs_steady_layout *l = &st->layout;
    DALCS_TRY(dalcs_logic_memory_setup(&l->memory, &st->arena, &r->s->circuit, period));
    DALCS_TRY(dalcs_stage_store_setup(&st->store, network->n_systems));
    r->store = &st->store;
    l->n_systems = network->n_systems;
    l->first = dalcs_arena_alloc(&st->arena, n, sizeof(*l->first));
    l->first_pair = dalcs_arena_alloc(&st->arena, n, sizeof(*l->first_pair));
    l->first_of_M = dalcs_arena_alloc(&st->arena, n, sizeof(*l->first_of_M));
    bool complete = l->first != NULL && l->first_pair != NULL && l->first_of_M != NULL;
    for (int k = 0; k < l->n_systems && complete; k++) {
        const struct dalcs_system *s = &network->system[k];
        const int n_x = s->n_x + l->memory.n_numbers; /* with numbers there is one system */
        l->first[k + 1] = l->first[k] + n_x;
        l->first_pair[k + 1] = l->first_pair[k] + s->n_pairs;
        l->first_of_M[k + 1] = l->first_of_M[k] + (size_t)n_x * (size_t)n_x;
        l->n_x = l->first[k + 1];
        l->n_pairs = l->first_pair[k + 1];
    }
    l->n_states = l->n_x - l->memory.n_numbers;
    l->n_switches = l->n_pairs;
    l->n_pairs += l->memory.n_bits;
    if (complete) {
        const size_t n_x = (size_t)l->n_x + 1;
        st->pass.M = dalcs_arena_alloc(&st->arena, l->first_of_M[l->n_systems] + 1, sizeof(double));
        st->scale = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->step = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->base.M = dalcs_arena_alloc(&st->arena, l->first_of_M[l->n_systems] + 1, sizeof(double));
        st->base.scale = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->base.work = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->base.change = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->kept.drift = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->pass.first = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->pass.last = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->pass.phase = dalcs_arena_alloc(&st->arena, n_x, sizeof(double));
        st->found.state =
            dalcs_arena_alloc(&r->s->arena, (size_t)network->n_states + 1, sizeof(double));
        st->found.average =
            dalcs_arena_alloc(&st->arena, (size_t)network->n_outputs + 1, sizeof(double));
        st->found.rms =
            dalcs_arena_alloc(&st->arena, (size_t)network->n_outputs + 1, sizeof(double));
        st->kept.of = dalcs_arena_alloc(&st->arena, n_x, sizeof(*st->kept.of));
        complete = dalcs_steady_make_point(st, &st->at) && dalcs_steady_make_point(st, &st->then) &&
                   dalcs_steady_make_point(st, &st->base.at) &&
                   dalcs_steady_make_point(st, &st->base.then) && st->pass.M != NULL &&
                   st->base.M != NULL && st->base.work != NULL && st->base.change != NULL &&
                   st->pass.phase != NULL && st->pass.first != NULL && st->pass.last != NULL &&
                   st->scale != NULL && st->base.scale != NULL && st->step != NULL &&
                   st->kept.drift != NULL && st->found.state != NULL && st->found.average != NULL &&
                   st->found.rms != NULL && st->kept.of != NULL;
    }
    if (!complete) {
        dalcs_steady_finish(st);
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

void dalcs_steady_finish(struct dalcs_steady *st) {
    if (st->run != NULL) {
        st->run->store = NULL;
    }
    dalcs_stage_store_finish(&st->store);
    dalcs_arena_finish(&st->arena);
    *st = (struct dalcs_steady){0};
}

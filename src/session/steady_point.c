/* steady_point.c - points at the ends of periods: where a run starts, and where it has arrived. */
#include "steady.h"

#include "radau.h"

#include <math.h>
#include <string.h>

enum dalcs_status dalcs_steady_start(const struct dalcs_orbit_point *point, struct dalcs_euler *e,
                                     struct dalcs_radau *radau, struct dalcs_logic_run *logic) {
    const struct dalcs_steady_layout *l = point->layout;
    struct dalcs_arena arena = {0};
    double **initial = dalcs_arena_alloc(&arena, (size_t)e->n_components, sizeof(*initial));
    if (initial == NULL) {
        return DALCS_E_NOMEM;
    }
    double *x = point->x;
    const bool *closed = point->closed;
    for (int k = 0; k < e->n_components; k++) {
        struct dalcs_component *c = &e->component[k];
        initial[k] = x;
        x += c->system->n_x;
        for (int i = 0; i < c->switches.n; i++) {
            dalcs_osnsp_command(&c->osnsp, c->switches.pair[i], closed[c->switches.pair[i]]);
        }
        closed += c->system->n_pairs;
    }
    enum dalcs_status status = DALCS_OK;
    if (logic->circuit != NULL) {
        status = dalcs_logic_memory_restore(&l->memory, logic, point->x + l->n_states,
                                            point->closed + l->n_switches);
    }
    if (status == DALCS_OK) {
        dalcs_radau_start(radau, initial);
    }
    dalcs_arena_finish(&arena);
    return status;
}

enum dalcs_status dalcs_steady_read_gates(const struct dalcs_logic_run *logic, double t,
                                          struct dalcs_orbit_point *point) {
    const struct dalcs_steady_layout *l = point->layout;
    return logic->circuit == NULL
               ? DALCS_OK
               : dalcs_logic_memory_save(&l->memory, logic, t, point->x + l->n_states,
                                         point->closed + l->n_switches);
}

enum dalcs_status dalcs_steady_read(const struct dalcs_euler *e,
                                    const struct dalcs_logic_run *logic, double t,
                                    struct dalcs_orbit_point *point) {
    double *x = point->x;
    bool *closed = point->closed;
    for (int k = 0; k < e->n_components; k++) {
        const struct dalcs_component *c = &e->component[k];
        memcpy(x, c->y, (size_t)c->system->n_x * sizeof(double));
        for (int i = 0; i < c->switches.n; i++) {
            closed[c->switches.pair[i]] = dalcs_osnsp_is_on(&c->osnsp, c->switches.pair[i]);
        }
        x += c->system->n_x;
        closed += c->system->n_pairs;
    }
    return dalcs_steady_read_gates(logic, t, point);
}

void dalcs_steady_find_residual(struct dalcs_steady *st) {
    st->pass.residual = 0.0;
    for (int x = 0; x < st->layout.n_x; x++) {
        double off = fabs(st->then.x[x] - st->at.x[x]);
        st->pass.residual =
            off > 0.0 ? fmax(st->pass.residual, off / st->scale[x]) : st->pass.residual;
    }
}

void dalcs_steady_take(struct dalcs_steady *st) {
    struct dalcs_orbit_point point = st->at;
    st->at = st->then;
    st->then = point;
    st->has_point = true;
}

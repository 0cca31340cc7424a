/* twins.c - twins by the rows that give their reverse voltages. */
#include "twins.h"

#include "guards.h"
#include "tied.h"

static bool rows_are_equal(const struct dalcs_csr *a, int i, int k) {
    int length = a->p[i + 1] - a->p[i];
    bool equal = length == a->p[k + 1] - a->p[k];
    for (int e = 0; e < length && equal; e++) {
        equal = a->j[a->p[i] + e] == a->j[a->p[k] + e] && a->x[a->p[i] + e] == a->x[a->p[k] + e];
    }
    return equal;
}

/* A resistance of their own would share the current and is no such law. */
static bool are_twins(const struct dalcs_osnsp *p, int d, int e) {
    const struct dalcs_system *s = p->system;
    return p->is_diode[d] && p->is_diode[e] && rows_are_equal(&s->C, d, e) &&
           rows_are_equal(&s->F, d, e);
}

enum dalcs_status dalcs_twins_setup(struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    int n_pairs = p->system->n_pairs;
    if (!dalcs_osnsp_is_monotone(p) || n_pairs > DALCS_MANY_PAIRS) {
        return DALCS_OK;
    }
    part->guards.twin = dalcs_arena_alloc(&part->arena, (size_t)n_pairs, sizeof(int));
    if (part->guards.twin == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int d = 0; d < n_pairs; d++) {
        part->guards.twin[d] = 0;
        while (part->guards.twin[d] < d && !are_twins(p, part->guards.twin[d], d)) {
            part->guards.twin[d]++;
        }
        part->guards.n_twins += part->guards.twin[d] < d ? 1 : 0;
    }
    return DALCS_OK;
}

/* All twins of one, and itself. */
static void command(struct dalcs_radau_part *part, int pair, bool on) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    for (int d = part->guards.twin[pair]; d < p->system->n_pairs; d++) {
        if (part->guards.twin[d] == part->guards.twin[pair]) {
            dalcs_osnsp_command(p, d, on);
        }
    }
}

void dalcs_twins_flip(struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    dalcs_guards_flip(part);
    for (int k = 0; part->guards.n_twins > 0 && k < part->guards.n_crossed; k++) {
        int d = part->guards.crossed[k];
        if (d < p->system->n_pairs) {
            command(part, d, dalcs_osnsp_is_on(p, d));
        }
    }
}

static bool has_open_twin(const struct dalcs_radau_part *part, int pair) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    bool found = false;
    for (int d = part->guards.twin[pair]; d < p->system->n_pairs && !found; d++) {
        found = part->guards.twin[d] == part->guards.twin[pair] && !dalcs_osnsp_is_on(p, d);
    }
    return found;
}

bool dalcs_twins_close(struct dalcs_radau_part *part, const double *unit) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    bool found = false;
    for (int d = 0; part->guards.n_twins > 0 && d < p->system->n_pairs; d++) {
        if (p->is_diode[d] && dalcs_osnsp_is_on(p, d) && has_open_twin(part, d) &&
            !dalcs_tied_is(part, d, unit)) {
            command(part, d, true);
            found = true;
        }
    }
    return found;
}

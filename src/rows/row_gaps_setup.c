/* row_gaps_setup.c - what is looked at between two stops, listed once. */
#include "row_gaps_internal.h"

#include "extremes.h"
#include "radau_state.h"

#include <math.h>

static void make_basis(struct dalcs_row_basis *basis, const struct dalcs_collocation *c) {
    enum { FOURTH = 4 };

    for (int place = 0; place < DALCS_N_PLACES; place++) {
        double theta = (double)place / (DALCS_N_PLACES - 1);
        double derivative[FOURTH + 1] = {1.0};
        for (int k = 0; k <= c->s; k++) {
            basis->second[k][place] = derivative[2];
            basis->fourth[k][place] = derivative[FOURTH];
            for (int order = FOURTH; order >= 0; order--) {
                double below = order > 0 ? order * derivative[order - 1] : 0.0;
                derivative[order] = (theta - c->differences.node[k]) * derivative[order] + below;
            }
        }
    }
}

/* Of the parts before, one with the same stages lends its own. */
static bool give_basis(struct dalcs_row_gaps *gaps, int k) {
    const struct dalcs_radau_part *part = gaps->rows->radau->part;
    struct dalcs_row_gaps_part *to = &gaps->part[k];
    for (int other = 0; other < k && to->basis == NULL; other++) {
        bool is_same = part[other].stages.method == part[k].stages.method;
        to->basis = is_same ? gaps->part[other].basis : NULL;
    }
    if (to->basis == NULL) {
        struct dalcs_row_basis *made = dalcs_arena_alloc(&gaps->arena, 1, sizeof(*made));
        if (made == NULL) {
            return false;
        }
        make_basis(made, part[k].stages.method);
        to->basis = made;
    }
    return true;
}

/* If all signals of a unit are rounding beside the other unit, none of them bends. */
static void find_crosses(struct dalcs_row_gaps *gaps, const struct dalcs_radau_part *part) {
    const struct dalcs_rows_part *p = &gaps->rows->part[part->index];
    for (int i = 0; i < p->n_signals; i++) {
        int output = p->signal[i].output;
        if (output < gaps->n_outputs) {
            double *cross = &gaps->cross[output];
            *cross = dalcs_larger(*cross,
                                  part->scales.cross[dalcs_row_is_current(gaps, output) ? 1 : 0]);
        }
    }
}

static bool set_up_parts(struct dalcs_row_gaps *gaps) {
    const struct dalcs_rows *rows = gaps->rows;
    bool complete = true;
    for (int k = 0; complete && k < rows->radau->n_parts; k++) {
        struct dalcs_row_gaps_part *part = &gaps->part[k];
        if (rows->part[k].n_read == 0) { /* none is read, or it does not step */
            continue;
        }
        find_crosses(gaps, &rows->radau->part[k]);
        part->bend =
            dalcs_arena_alloc(&gaps->arena, (size_t)rows->part[k].n_read, sizeof(*part->bend));
        complete = part->bend != NULL && give_basis(gaps, k);
    }
    return complete;
}

static bool set_up_stimuli(struct dalcs_row_gaps *gaps, const struct dalcs_circuit *circuit) {
    size_t n = (size_t)circuit->n_stimuli;
    gaps->curved = dalcs_arena_alloc(&gaps->arena, n, sizeof(*gaps->curved));
    gaps->stimulus = dalcs_arena_alloc(&gaps->arena, n, sizeof(*gaps->stimulus));
    gaps->term = dalcs_arena_alloc(&gaps->arena, DALCS_STIMULUS_MOST_TERMS, sizeof(*gaps->term));
    if (gaps->curved == NULL || gaps->stimulus == NULL || gaps->term == NULL) {
        return false;
    }
    for (int i = 0; i < circuit->n_stimuli; i++) {
        if (dalcs_stimulus_n_terms(&circuit->stimulus[i]) > 0) {
            gaps->curved[gaps->n_curved++].stimulus = i;
        }
    }
    return true;
}

enum dalcs_status dalcs_row_gaps_setup(struct dalcs_row_gaps *gaps, struct dalcs_rows *rows,
                                       int n_outputs, double bound) {
    *gaps = (struct dalcs_row_gaps){.rows = rows, .n_outputs = n_outputs, .bound = bound};
    struct dalcs_arena *arena = &gaps->arena;
    size_t n_read = (size_t)rows->n_outputs;
    gaps->largest = dalcs_arena_alloc(arena, (size_t)n_outputs, sizeof(double));
    gaps->cross = dalcs_arena_alloc(arena, (size_t)n_outputs, sizeof(double));
    gaps->of_steps = dalcs_arena_alloc(arena, n_read, sizeof(*gaps->of_steps));
    gaps->of_sources = dalcs_arena_alloc(arena, n_read, sizeof(*gaps->of_sources));
    gaps->part = dalcs_arena_alloc(arena, (size_t)rows->radau->n_parts, sizeof(*gaps->part));
    bool complete = gaps->largest != NULL && gaps->cross != NULL && gaps->of_steps != NULL &&
                    gaps->of_sources != NULL && gaps->part != NULL && set_up_parts(gaps) &&
                    set_up_stimuli(gaps, rows->radau->base->circuit);
    if (!complete) {
        dalcs_row_gaps_finish(gaps);
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

void dalcs_row_gaps_finish(struct dalcs_row_gaps *gaps) {
    dalcs_arena_finish(&gaps->arena);
    *gaps = (struct dalcs_row_gaps){0};
}

/* front.c - signs, from column to column through rows and from pair to pair. */
#include "front.h"

#include "doubt.h"
#include "stage_plan.h"

#include <math.h>
#include <stdlib.h>

struct front {
    struct dalcs_radau_part *part;
    const struct dalcs_system *s;
    const struct dalcs_csr *M; /* columns of the stage equations: -A, then C, by rows */
    const double *end;         /* [n_columns] of the segment before */
    double nothing;            /* V */
    int *direction;            /* [n_equations] in which a voltage moves; 0: not reached */
    int *queue;                /* [n_equations] those that are reached */
    int n_queued;
};

static int sign_of(double value) {
    return (value > 0.0) - (value < 0.0);
}

/* Currents are passed over: what has voltages on both sides ties these by its own row. */
static void reach(struct front *f, int column, int direction) {
    if (!f->s->column_is_current[column] && fabs(f->end[column]) <= f->nothing && direction != 0 &&
        f->direction[column] == 0) {
        f->direction[column] = direction;
        f->queue[f->n_queued++] = column;
    }
}

/* The current of a pair that closes pushes the columns that its rows are paired with. */
static void feed(struct front *f, int pair) {
    int n_equations = dalcs_system_n_equations(f->s);
    int lambda = n_equations + pair;
    for (int k = f->M->p[lambda]; k < f->M->p[lambda + 1]; k++) {
        if (f->M->j[k] < n_equations) {
            reach(f, f->s->dual[f->M->j[k]], -sign_of(f->M->x[k]));
        }
    }
}

/* A blocking diode without voltage. */
static bool is_tied(const struct front *f, int pair) {
    return f->s->pair[pair].kind == DALCS_PAIR_DIODE &&
           !dalcs_osnsp_is_on(&f->part->component->osnsp, pair) &&
           fabs(f->end[dalcs_system_n_equations(f->s) + pair]) <= f->nothing;
}

/* The others in a row that a column pushes up: each moves so that its term balances the column's. */
static void push_row(struct front *f, int row, int push) {
    const struct dalcs_csr *A = &f->s->A;
    for (int k = A->p[row]; k < A->p[row + 1]; k++) {
        if (A->j[k] < dalcs_system_n_equations(f->s)) {
            reach(f, A->j[k], push * sign_of(A->x[k]));
        }
    }
}

/* Closes diodes whose w a column pulls down. */
static bool follow(struct front *f, int column) {
    int n_equations = dalcs_system_n_equations(f->s);
    bool found = false;
    for (int k = f->M->p[column]; k < f->M->p[column + 1]; k++) {
        int row = f->M->j[k];
        int push = f->direction[column] * sign_of(f->M->x[k]);
        if (row < n_equations) {
            push_row(f, row, push);
        } else if (push < 0 && is_tied(f, row - n_equations)) {
            dalcs_osnsp_command(&f->part->component->osnsp, row - n_equations, true);
            feed(f, row - n_equations);
            found = true;
        }
    }
    return found;
}

enum dalcs_status dalcs_front_close(struct dalcs_radau_part *part, bool *found) {
    const struct dalcs_system *s = part->component->system;
    *found = false;
    if (part->stages.plan == NULL) {
        return DALCS_OK;
    }
    const struct dalcs_stage_layout *l = &part->stages.layout;
    size_t n = (size_t)dalcs_system_n_equations(s);
    struct front f = {.part = part,
                      .s = s,
                      .M = &part->stages.plan->base,
                      .end = part->segment.out_before + (l->n_nodes - 1) * l->stride,
                      .nothing = dalcs_doubt_noise(part) * part->scales.unit[0],
                      .direction = dalcs_alloc(n, sizeof(int)),
                      .queue = dalcs_alloc(n, sizeof(int))};
    if (f.direction == NULL || f.queue == NULL) {
        free(f.direction);
        free(f.queue);
        return DALCS_E_NOMEM;
    }
    const uint64_t *held = part->memory.modes_before;
    for (int d = 0; d < s->n_pairs; d++) {
        bool was_open = !dalcs_mode_has(held, d);
        if (was_open && dalcs_osnsp_is_on(&part->component->osnsp, d)) {
            feed(&f, d);
        }
    }
    for (int k = 0; k < f.n_queued; k++) {
        *found = follow(&f, f.queue[k]) || *found;
    }
    free(f.direction);
    free(f.queue);
    return DALCS_OK;
}

/* stage_columns.h - what differences of the states become in a step on sparse factors, four of them at once.
 *
 * The derivative of a run by its states goes through each step column by column (variation.h). Columns share the
 * factors: four of them go through these together, which are read once, and side by side in vectors. It is the linear
 * part of dalcs_stages_apply, of what is asked for alone: states, and one guard. */
#ifndef DALCS_STAGE_COLUMNS_H
#define DALCS_STAGE_COLUMNS_H

#include "stages.h"

enum { DALCS_COLUMNS = 4 };

/* a value of each of four columns. */
typedef double dalcs_four __attribute__((vector_size(DALCS_COLUMNS * sizeof(double)), aligned(8)));

/* Of a step that ends at some time within its length. */
struct dalcs_stage_columns {
    const double *weight; /* [n_nodes] of the nodes there */
    int row;              /* of the guard, in the layout of an answer; -1: none */
    dalcs_four *states;   /* [n_x] at the start */
    dalcs_four *end;      /* [n_x] there */
    dalcs_four *begin;    /* [n_x] where the polynomial through the stages starts */
    dalcs_four guard;     /* there */
    dalcs_four *work;     /* [dalcs_stage_columns_room] */
};

/* Elements of `work`. */
size_t dalcs_stage_columns_room(const struct dalcs_system *system);

/* Has the entry regular factors, and no map? Else columns go one by one. */
bool dalcs_stage_columns_can(const struct dalcs_stage_entry *entry);

void dalcs_stage_columns_apply(const struct dalcs_stages *stages,
                               const struct dalcs_stage_entry *entry,
                               struct dalcs_stage_columns *columns);

/* The transposed: `states` become how the sum of `end` times what is in it, and of `guard` times what is in that, depends
 * on states at the start. `end` is lost. */
void dalcs_stage_columns_apply_back(const struct dalcs_stages *stages,
                                    const struct dalcs_stage_entry *entry,
                                    struct dalcs_stage_columns *columns);

#endif

/* elimination.h - the states of a one-step problem eliminated, each through the row it is paired with. */
#ifndef DALCS_ELIMINATION_H
#define DALCS_ELIMINATION_H

#include "system.h"

struct dalcs_elimination {
    const struct dalcs_system *s;
    int n_rows; /* equations, then pairs */
    int n_left; /* columns of the system; the right-hand side, (x_k, s), follows */

    struct dalcs_elimination_row {
        int n, capacity;
        int *column;
        double *value;
        bool has_moved; /* to a room of its own, that of value and column */
    } * row;            /* [n_rows] */

    struct dalcs_elimination_users {
        int n, capacity;
        int *row;
    } * users; /* [n_x] rows that hold an x column (or once did) */

    int *where;              /* [all columns] slot in the row being changed, else -1 */
    int *pivot_row;          /* [n_x], -1 if kept */
    bool *is_pivot;          /* [n_rows] */
    int *row_of_dual;        /* [n_equations] */
    struct dalcs_arena work; /* vectors, and what follows them up needs */
};

/* At sigma (1/s). *e needs dalcs_elimination_finish, whatever comes back. */
enum dalcs_status dalcs_elimination_run(struct dalcs_elimination *e,
                                        const struct dalcs_system *system,
                                        double sigma) DALCS_MUST_CHECK;

void dalcs_elimination_finish(struct dalcs_elimination *e);

/* The value in this column; NULL: the row has none. */
double *dalcs_elimination_find(const struct dalcs_elimination_row *row, int column);

#endif

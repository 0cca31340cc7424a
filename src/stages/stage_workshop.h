/* stage_workshop.h - a map in the making: the stage equations of a small system in one mode, solved for
 * unit states and unit inputs.
 *
 * Unknowns are the increments of the states over x_0, z, and lambda of the closed pairs. For each
 * eigenvalue mu the matrix is
 *     S = [mu/h P - A; C_on],     right-hand sides [A; -C_on] x_0 + [E; -F_on] s,
 * balanced by powers of 2 and solved in extended precision. */
#ifndef DALCS_STAGE_WORKSHOP_H
#define DALCS_STAGE_WORKSHOP_H

#include "extended_four.h"
#include "quads.h"
#include "stage_functions.h"
#include "stages_internal.h"

/* The equations without P's share, by columns, as they are and balanced. */
struct dalcs_workshop_equations {
    double *row_scale, *column_scale;         /* [n] */
    double *plain_base, *plain_P, *plain_rhs; /* base, P and rhs before they were balanced */
    int *nonzero_p, *nonzero_i;               /* by columns, where base or P have something */
    double *base;                             /* balanced S without P, of the nonzeros */
    double *P;                                /* [n_x][n_x] balanced */
    double *rhs;  /* [n_rhs][n] balanced: unit states, constants, unit waves */
    double *size; /* of the nonzeros of the real S, before they were balanced */
};

/* Unknowns that are solved for once (workshop_followers.c), and those that are solved for each eigenvalue. */
struct dalcs_workshop_kept {
    long double *whole; /* [n][n + n_rhs] S without P by rows, then followers as pivots */
    int n_kept, n_followers;
    int *kept, *kept_row;   /* [n_kept] unknowns and rows of the systems: states first */
    int *follower, *row_of; /* [n_followers]; [n] row of `whole` of an unknown that follows */
    int *owner;             /* [n] the follower of a row of `whole`, or -1 */
    double *whole_row_scale, *whole_column_scale; /* [n] in which it is */
    /* what followers take of the kept, by rows, each with a last entry for its drive */
    int *follows_p, *follows_j;
    struct dalcs_extended *follows_x;
};

/* What each right-hand side reaches (workshop_reach.c). */
struct dalcs_workshop_reach {
    bool *is_reached; /* [n_rhs][n] unknowns of a mode that leaves nothing open */
    int *column_of;   /* [n] the unknown that stands with a row */
    bool *seen;       /* [n] work */
    int *queue;       /* [n] work */
};

/* The systems of the eigenvalues and their solutions. */
struct dalcs_workshop_solved {
    long double *of_real; /* [n_kept][n_kept + n_rhs] the real system by rows, then its solutions */
    struct dalcs_extended_four *of_pairs; /* likewise, of the complex ones, */
    bool *filled;                         /* and where they have anything */
    struct dalcs_extended *part;          /* [n_rhs][n_kept][parts] the solutions, balanced */
    size_t room;                          /* for n unknowns, in whole quads */
    double *real;   /* [n_rhs][2][room] those of the real eigenvalue, of all unknowns */
    double *moment; /* [2][n_kept][n_kept + n_rhs, in whole quads] real systems of short steps */
    double *shift;  /* [n_rhs][n_x] how far the mode moves states at once */
};

/* Work of one column of a map (stage_column.c). */
struct dalcs_workshop_column {
    struct dalcs_extended_row *stage; /* [n_kept + 1] increments, and what these alone say of that
                                         at the start; behind them what drives the followers */
    double *lanes;                    /* [n][lanes] the answer */
    struct dalcs_extended *start; /* [n] what the stages alone say of the start, as increments */
    struct dalcs_extended
        *missed;      /* [n_x + 1] what they miss there, of the states and of a source */
    int *of_missed;   /* [n_x + 1] and in which rows of `real` that goes in */
    double *filtered; /* [2][room] what these make of it */
    struct dalcs_extended *defect;  /* [n_x] that of the states */
    struct dalcs_extended *lasting; /* [n_x] and what they make of that */
    double *guard;                  /* [n_pairs][lanes] */
    double *residual;               /* [n] */
    double *in;                     /* [n_in] of a map without constants */
};

/* What a singular mode leaves open (stage_choice.h). */
struct dalcs_workshop_open {
    int nullity;
    double *left;   /* [nullity][n] null vectors of the rows, balanced */
    double *choice; /* [nullity][n] balanced: what is asked instead, and */
    double *chosen; /* [nullity][n_rhs] what of the right-hand sides it is */
    int *given_up;  /* [nullity] or NULL: rows without a null vector, in whose places that is */
};

/* Kept from map to map; what a map needs apart from it is in the arena. */
struct dalcs_stage_workshop {
    const struct dalcs_stages *stages;
    const struct dalcs_system *system;
    struct dalcs_stage_entry *entry; /* the map in the making */
    int n, n_x, n_rhs;
    int *wave_column;   /* [n_inputs] right-hand side of an input that varies, else -1 */
    int *place;         /* [n_columns] in the unknowns; -1: an open pair */
    uint64_t *mode;     /* of the last map */
    bool is_known;      /* what was eliminated serves a map of this mode with another step length */
    bool has_constants; /* inputs that do not vary drive something: else maps lack their column */
    struct dalcs_workshop_equations eq;
    struct dalcs_workshop_reach reach;
    struct dalcs_workshop_kept kept;
    struct dalcs_workshop_solved solved;
    struct dalcs_workshop_open open;
    struct dalcs_workshop_column column;
    struct dalcs_stage_functions functions;
    struct dalcs_arena arena; /* of `open` */
    void *storage;            /* of all the others */
};

enum dalcs_status dalcs_stage_workshop_create(struct dalcs_stage_workshop **workshop,
                                              const struct dalcs_stages *stages) DALCS_MUST_CHECK;
void dalcs_stage_workshop_destroy(struct dalcs_stage_workshop *workshop);

/* The solutions for an entry's mode and step length, and the null vectors of a singular mode. */
enum dalcs_status dalcs_stage_workshop_solve(struct dalcs_stage_workshop *workshop,
                                             struct dalcs_stage_entry *entry) DALCS_MUST_CHECK;

/* What a right-hand side adds to follower f, balanced; the unknowns that are kept add
 * follows_x[k] y[follows_j[k]]. */
static inline long double dalcs_stage_workshop_drive(const struct dalcs_stage_workshop *b, int f,
                                                     int rhs_column) {
    return b->kept
        .whole[b->kept.row_of[b->kept.follower[f]] * (b->n + b->n_rhs) + b->n + rhs_column];
}

static inline double *dalcs_stage_workshop_reals(struct dalcs_arena *arena, int n) {
    return dalcs_arena_alloc(arena, (size_t)(n > 0 ? n : 1), sizeof(double));
}

void dalcs_workshop_fill(struct dalcs_stage_workshop *b);

/* Rows and columns of |S| at the real eigenvalue get a largest entry near 1. */
void dalcs_workshop_balance(struct dalcs_stage_workshop *b);

/* Which unknowns each right-hand side reaches in a mode. */
void dalcs_workshop_find_reach(struct dalcs_stage_workshop *b);

/* May a right-hand side move an unknown? Else the solution is 0 there. */
static inline bool dalcs_workshop_reaches(const struct dalcs_stage_workshop *b, int rhs_column,
                                          int unknown) {
    return b->open.nullity > 0 || b->reach.is_reached[rhs_column * b->n + unknown];
}

/* What the equations without derivatives say of an unknown without memory is the same for every
 * eigenvalue: those that they determine are solved for once. What is kept are the states and, where the
 * index is 2, what only derivatives determine. */
void dalcs_workshop_eliminate(struct dalcs_stage_workshop *b);

/* Brings what was eliminated for another step length to the present scales. All are powers of 2: no digit
 * is lost. */
void dalcs_workshop_rescale(struct dalcs_stage_workshop *b);

#endif

/* stage_update.h - a mode that differs by a few pairs from one that is factored, on its factors. */
#ifndef DALCS_STAGE_UPDATE_H
#define DALCS_STAGE_UPDATE_H

#include "stage_factors.h"

enum { DALCS_STAGE_MOST_CHANGES = DALCS_LU_SPARE, DALCS_STAGE_FIRST_TRUST = 8 };

/* A column of G in the order of the base: what is not nothing of it, in runs. */
struct dalcs_stage_response {
    int n_runs;
    int *first, *end; /* [n_runs] positions */
    double *value;    /* of all runs, one behind the other */
};

/* What a base knows of one of its pairs that changes: an open one closes, a closed one opens. */
struct dalcs_stage_change {
    int pair;
    bool refused;                   /* digits would cancel: nothing else is known */
    double row_scale, column_scale; /* of one that closes */
    int n_terms;                    /* of its w in unknowns of the base, balanced */
    int *unknown;
    double *value;
    int row_at[DALCS_STAGE_SYSTEMS]; /* positions of its row and its lambda, of one that opens */
    int lambda_at[DALCS_STAGE_SYSTEMS];
    struct dalcs_stage_response response[DALCS_STAGE_SYSTEMS];
    double largest; /* of all of them, in magnitude */
    size_t bytes;
};

/* The mode of an entry as changes of its base. */
struct dalcs_stage_update {
    struct dalcs_stage_entry *base; /* held until the update is destroyed */
    int n_closed, n_changes;
    struct dalcs_stage_change *change[DALCS_STAGE_MOST_CHANGES]; /* those that close first */
    long double
        *inverse[DALCS_STAGE_SYSTEMS]; /* [n_changes][n_changes] of S, then its imaginary part */
};

/* Has it factors that other entries may use? */
bool dalcs_stage_update_can_be_base(const struct dalcs_stage_entry *entry);

/* One more step on this entry; has it cost so much that it had better have factors of its own? */
bool dalcs_stage_update_is_spent(struct dalcs_stage_entry *entry);

/* entry->factors as an update of a base that is near, if there is one and it serves as well as
 * factors of the entry's own would; else they stay NULL. */
enum dalcs_status dalcs_stage_update_build(struct dalcs_stages *stages,
                                           struct dalcs_stage_entry *entry) DALCS_MUST_CHECK;

/* lu[system].work, loaded with a share of the waves, becomes the solution. */
void dalcs_stage_update_solve(const struct dalcs_stage_plan *plan,
                              const struct dalcs_stage_factors *f, int system, int share);

/* Bytes of the factors of an update, without its base. */
size_t dalcs_stage_update_bytes(const struct dalcs_stage_factors *f);

/* Frees what is an update's own and lets its base go. */
void dalcs_stage_update_destroy(struct dalcs_stages *stages, struct dalcs_stage_factors *f);

void dalcs_stage_changes_destroy(const struct dalcs_stages *stages,
                                 struct dalcs_stage_change **change);

#endif

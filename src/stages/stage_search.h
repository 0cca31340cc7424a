/* stage_search.h - what a search for the choices of a singular mode knows. Private to src/stages. */
#ifndef DALCS_STAGE_SEARCH_H
#define DALCS_STAGE_SEARCH_H

#include "stage_singular.h"

/* What a solution that is 0 on every right-hand side has in pairs of one kind. */
struct dalcs_stage_trace {
    int n;
    int *pair;
    double *value;
};

struct dalcs_stage_search {
    const struct dalcs_stage_plan *plan;
    const struct dalcs_system *system;
    const struct dalcs_stage_entry *entry;
    struct dalcs_arena arena;
    int *closed;                     /* [n_pairs] which of entry->on a closed pair is */
    int n_columns;                   /* without memory: z, then lambda of closed pairs */
    bool within_blocks;              /* of rows, what they read of other blocks does not count */
    int n_open;                      /* solutions */
    double *vector;                  /* [n_open][n_columns] */
    double *error;                   /* [n_columns] how far off an entry of any of them may be */
    struct dalcs_stage_trace *trace; /* [n_open] */
    double *of_pair;                 /* [n_pairs] work */
    struct dalcs_triplets choice, of_column, shore;
};

/* The place of column c of M among those from `first` on, which closed pairs follow closely; -1: none. */
int dalcs_stage_search_place(const struct dalcs_stage_search *s, int c, int first);

/* s->trace of all solutions, which are made orthogonal in them. */
enum dalcs_status dalcs_stage_traces_find(struct dalcs_stage_search *s) DALCS_MUST_CHECK;

/* The choice that is orthogonal to solution k in its pairs, or in all that it has where none sees it. */
enum dalcs_status dalcs_stage_traces_choose(struct dalcs_stage_search *s, int k) DALCS_MUST_CHECK;

#endif

/* stage_comparison.h - the stages of one network three times: by the dense map, on factors, and on updated factors. */
#ifndef STAGE_COMPARISON_H
#define STAGE_COMPARISON_H

#include "stage_columns.h"
#include "stage_update.h"

#include "build_network.h"

struct three_stages {
    struct text_network text;
    const struct dalcs_system *system;
    struct dalcs_excitation excitation;
    struct dalcs_stages dense;
    struct dalcs_stages sparse;  /* each mode has its own factors */
    struct dalcs_stages updated; /* some are updates of others */
    double near;                 /* the largest of what steps are solved from */
};

struct tally {
    int n_regular, n_singular, n_clashes;
    int n_closings, n_openings, n_several; /* updates by what changes */
    int n_free;                            /* entries that free the states */
    int n_columns;                         /* several at once, with a guard */
};

void setup_stages(struct three_stages *b, const char *netlist, int s, bool general);

void finish_stages(struct three_stages *b);

/* Two steps from anywhere. */
void check_steps(struct three_stages *b, struct dalcs_stages *stages, const uint64_t *mode,
                 double h, struct dalcs_stage_entry *dense, uint64_t *random, struct tally *tally);

void check_mode(struct three_stages *b, const uint64_t *mode, double h, uint64_t *random,
                struct tally *tally);

#endif

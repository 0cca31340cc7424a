/* variants_pool.h - the steps of .step in several threads, one session each; rows come in order. */
#ifndef DALCS_VARIANTS_POOL_H
#define DALCS_VARIANTS_POOL_H

#include "arguments.h"
#include "decimal.h"
#include "variants_crash.h"

/* What a step gave; texts are heap. */
struct dalcs_variant {
    char *row;      /* of the table, with its newline */
    char *line;     /* for people, without */
    char *warnings; /* one after the other, each with a NUL behind it, and one more at the end */
    double *value;  /* of the measurements; heap */
    bool failed;
};

struct dalcs_variants_pool {
    const struct dalcs_cli *cli;
    const struct dalcs_arguments *arguments;
    const struct dalcs_session *session; /* has read the netlist and does not run */
    const struct dalcs_run_options *options;
    const struct dalcs_decimal *decimal;
    const struct dalcs_crashes *crashes;
    size_t n_measures; /* of a step */
    size_t first, end; /* steps, from 0 on */
    /* Called for each step in its order, by one thread at a time. */
    enum dalcs_status (*take)(void *user, const struct dalcs_variant *variant);
    void *user;
};

/* Until all are taken, Ctrl-C was pressed (DALCS_E_CANCELLED), or take returned another status. */
enum dalcs_status dalcs_variants_pool_run(const struct dalcs_variants_pool *pool) DALCS_MUST_CHECK;

/* Cells of the values of --set and of step `step`; heap, NULL: out of memory. */
char *dalcs_variant_begin(const struct dalcs_variants_pool *pool, size_t step);

/* The width of the column with this name in the table on the terminal. */
int dalcs_variant_width(const char *name);

#endif

/* rows.h - outputs at many times at once, for rows and for measurements.
 *
 * Between two stops each component is on the polynomials of one step. What an output reads of it is added up at the
 * nodes, and the sum's polynomial, in Newton's form, is evaluated at four times in a vector. Whatever the
 * times beside it, a value has the same bits. */
#ifndef DALCS_ROWS_H
#define DALCS_ROWS_H

#include "quads.h"
#include "radau.h"

enum { DALCS_MOST_ROWS = 32, DALCS_ROW_GROUPS = DALCS_MOST_ROWS / 4, DALCS_ROW_MAPS = 8 };

/* Something at all times, which are taken by fours. */
typedef dalcs_quad dalcs_four __attribute__((aligned(8)));

union dalcs_row_values {
    double at[DALCS_MOST_ROWS];
    dalcs_four group[DALCS_ROW_GROUPS];
};

struct dalcs_rows_part {
    int n_signals;

    struct dalcs_row_signal {
        const struct dalcs_probe *probe;
        bool is_column; /* of the part, and all of the output */
        int output;     /* among those of the rows */
        double sign;
    } * signal; /* [n_signals] what outputs read of this part, those of an output in a row */

    int n_read;                  /* outputs that read this part */
    int map_rows;                /* the rows of a map of it */
    int offset[DALCS_MAX_NODES]; /* [s + 1] of the nodes in an answer, in Newton's order */

    /* The polynomials of a step that recurs are one map of its inputs, from its second time with rows on. */
    struct dalcs_row_map {
        long number;       /* of the step; 0: none yet (stage_brief.h) */
        double *map;       /* [rows][columns] by columns; NULL: asked for once */
    } map[DALCS_ROW_MAPS]; /* at the step's number modulo theirs */

    double *
        coefficient; /* [rows] Newton's, in DALCS_MAX_NODES, of one output after the other that reads this part */
    long number; /* of the segment that they are of; 0: none yet */

    /* Columns and inputs that sources decide have a place among the `source`s when they are read. */
    int *place; /* [n_columns + n_inputs], -1: none, below: bystander -2 - place */
    int n_sources;

    struct dalcs_row_source {
        bool is_bystander; /* or an input */
        int index;
        union dalcs_row_values value;
    } * source; /* [n_sources] the inputs that others need first, bystanders last */
};

struct dalcs_rows {
    struct dalcs_radau *radau; /* borrowed */
    int n_outputs;
    union dalcs_row_values *value; /* [n_outputs] */
    double *largest;               /* [n_outputs] at events */
    struct dalcs_rows_part *part;  /* [radau->n_parts] */
    int n_asked, *asked;           /* parts that are read or have to be solved */
    bool one_by_one;               /* one of them is */
    union dalcs_row_values time;   /* the last one again where its group is not full */
    union dalcs_row_values theta;  /* work: the same in the steps of one part */
    struct dalcs_arena arena;      /* what has the same size during the run */
};

/* output[n_outputs]: which of the network's. NULL: all of them, and parts without memory are solved though
 * nothing may read them, for they may have no solution. */
enum dalcs_status dalcs_rows_setup(struct dalcs_rows *rows, struct dalcs_radau *radau,
                                   const int *output, int n_outputs) DALCS_MUST_CHECK;

void dalcs_rows_finish(struct dalcs_rows *rows);

/* The outputs at time[n], n <= DALCS_MOST_ROWS, which lie in the present segments, into `value`: at the
 * first *n_done of them, at least one. */
enum dalcs_status dalcs_rows_fill(struct dalcs_rows *rows, const double *time, int n,
                                  enum dalcs_side side, int *n_done) DALCS_MUST_CHECK;

/* The polynomials in the present segment of a part that steps into `coefficient`, without what sources decide. */
enum dalcs_status dalcs_rows_find_polynomials(struct dalcs_rows *rows,
                                              struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* After the outputs on the right of an event: those that are no further from before[n_outputs], on its left,
 * than errors may take them become that. There a step begins, where its polynomials of currents, and of what else
 * has no memory, are least exact: what conducts from there on has a current that begins at 0, not below. */
void dalcs_rows_join(struct dalcs_rows *rows, const double *before);

#endif

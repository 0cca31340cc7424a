/* stamp.h - the small vocabulary in which devices write their equations. Private to src/dalcs. */
#ifndef DALCS_STAMP_H
#define DALCS_STAMP_H

#include "assemble.h"

struct stamps {
    struct dalcs_layout *layout;
    struct dalcs_system *s;
    struct dalcs_triplets P, A, E, C, F, storage, control, direct_control, reads;
    int n_smooth; /* sources of a smooth function */
    int n_tree;   /* capacitors in the forest: rows and columns 0..n_tree-1 of x */
    int next_x;   /* next x column (= row of I) after the forest's */
    int next_z;   /* next z column after the node voltages */
    int next_row; /* next row of II after KCL */
    int next_pair, next_input;
    double *initial;
};

int dalcs_stamp_node_column(const struct dalcs_layout *l, int node);

/* Adds to a matrix whose columns are the system's; ground (-1) vanishes. */
enum dalcs_status dalcs_stamp_add(struct dalcs_triplets *t, int row, int column,
                                  double value) DALCS_MUST_CHECK;

/* A current leaving `node`: coefficient * column. */
enum dalcs_status dalcs_stamp_leave(struct stamps *b, struct dalcs_triplets *t, int node,
                                    int column, double value) DALCS_MUST_CHECK;

/* A branch current through a device from its first to its second terminal. */
enum dalcs_status dalcs_stamp_branch_current(struct stamps *b, const struct dalcs_device *d,
                                             int column, double value) DALCS_MUST_CHECK;

/* row of t += value * (v(first) - v(second)) */
enum dalcs_status dalcs_stamp_add_voltage(struct stamps *b, struct dalcs_triplets *t, int row,
                                          int first, int second, double value) DALCS_MUST_CHECK;

/* The current gain * (v(c) - v(d)) leaving node a and entering node b. */
enum dalcs_status dalcs_stamp_transconductance(struct stamps *b, int first, int second, int plus,
                                               int minus, double gain) DALCS_MUST_CHECK;

/* Marks, for the system's `reads`, that `device` makes a row read a column; or the KCL of its two nodes a column, or
 * the voltage between two nodes. */
enum dalcs_status dalcs_stamp_reads(struct stamps *b, int device, int row,
                                    int column) DALCS_MUST_CHECK;
enum dalcs_status dalcs_stamp_reads_column(struct stamps *b, int device,
                                           int column) DALCS_MUST_CHECK;
enum dalcs_status dalcs_stamp_reads_voltage(struct stamps *b, int device, int plus,
                                            int minus) DALCS_MUST_CHECK;

enum dalcs_status dalcs_stamp_conductance(struct stamps *b, const struct dalcs_device *d,
                                          double g) DALCS_MUST_CHECK;

/* What makes up r together with roff in parallel. A model's r is below its roff; without one, roff is
 * infinite and this is r. */
double dalcs_stamp_series_part(double r, double roff);

int dalcs_stamp_new_input(struct stamps *b, int device);

/* A z column for the current of `device` and the row of II that is its branch equation. */
void dalcs_stamp_new_branch(struct stamps *b, int device, int *column, int *row);

/* An x column whose differential equation has a row of its own, with the same number. */
int dalcs_stamp_new_state(struct stamps *b, const char *name, bool is_current);

#endif

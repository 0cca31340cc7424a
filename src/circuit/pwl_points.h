/* pwl_points.h - the points of a PWL while its card is read. */
#ifndef DALCS_PWL_POINTS_H
#define DALCS_PWL_POINTS_H

#include "reader.h"
#include "stimulus.h"

/* The points so far. */
struct dalcs_pwl_points {
    struct dalcs_reader *reader;
    enum dalcs_quantity quantity;
    double *t, *v;
    size_t n, t_capacity, v_capacity;
    double time_scale, value_scale;
    bool is_in_block; /* between REPEAT and ENDREPEAT */
    bool is_closed;   /* a parenthesis was closed: a number after it is no point */
    bool has_forever; /* the last block repeats forever */
    bool is_relative; /* a note about times with + was made */
    size_t block;     /* the first point of the block being read */
    double from;      /* s, where that begins */
    double repeat_from;
    const struct dalcs_token *repeat; /* r= */
    double delay;
};

bool dalcs_pwl_add(struct dalcs_pwl_points *p, const struct dalcs_token *place, double t, double v);

/* After FILE=: appends the points that stand in the file. */
bool dalcs_pwl_read_file(struct dalcs_pwl_points *p);

bool dalcs_pwl_keep(struct dalcs_pwl_points *p, struct dalcs_stimulus *stimulus);

#endif

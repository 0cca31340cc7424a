/* row_gaps.h - how far apart rows may be for curves through them to be the waveforms.
 *
 * The straight line over a gap g leaves a waveform y by at most g^2/8 max|y''|, the cubic through four rows with
 * gaps of at most g by no more than 3/128 g^4 max|y''''| in the middle one (E. Isaacson and H. B. Keller, Analysis
 * of Numerical Methods, sec. 6.1). Between two stops both derivatives are known: of polynomials and of sources. */
#ifndef DALCS_ROW_GAPS_H
#define DALCS_ROW_GAPS_H

#include "rows.h"

/* The largest magnitudes of something, and of its second and fourth derivatives, per s^2 and per s^4. */
struct dalcs_bend {
    double size, second, fourth;
};

struct dalcs_row_gaps {
    struct dalcs_rows *rows; /* borrowed */
    int n_outputs;           /* the first of the rows' */
    double bound;            /* over the largest value of an output so far */
    double *largest;         /* [n_outputs] that */
    double *cross; /* [n_outputs] V per A or A per V: of the other unit, what is nothing here */
    struct dalcs_bend *of_steps,
        *of_sources; /* [rows->n_outputs] work: polynomials' and sources' share */
    int n_curved;

    struct dalcs_row_gaps_curve { /* a stimulus that is not straight between its edges */
        int stimulus;
        double from, to; /* s, where its bend stays what it was found to be at `from` */
    } * curved;

    struct dalcs_bend *stimulus; /* [n_stimuli] in the stretch at hand; 0 where it is straight */
    struct dalcs_stimulus_term *term; /* work */
    struct dalcs_bend algebraic;      /* of what is read of parts without memory, over its size */

    struct dalcs_row_gaps_part {
        const struct dalcs_row_basis *basis;
        long number;             /* of the segment that `bend` is of; 0: none yet */
        struct dalcs_bend *bend; /* [n_read] of the polynomials that outputs read, in their order */
    } * part;                    /* [n_parts] */

    double line, cubic; /* s, the longest gaps for either; may be INFINITY */
    struct dalcs_arena arena;
};

enum dalcs_status dalcs_row_gaps_setup(struct dalcs_row_gaps *gaps, struct dalcs_rows *rows,
                                       int n_outputs, double bound) DALCS_MUST_CHECK;

/* Accepts a zeroed one. */
void dalcs_row_gaps_finish(struct dalcs_row_gaps *gaps);

/* The rows' values at place 0 count for what is largest. */
void dalcs_row_gaps_note(struct dalcs_row_gaps *gaps);

/* Sets line and cubic for rows from one time to a later one, which both lie in the present segments. */
enum dalcs_status dalcs_row_gaps_look(struct dalcs_row_gaps *gaps, double from,
                                      double to) DALCS_MUST_CHECK;

#endif

/* side_means.h - means over the positions of a slide of what is no linear function of the columns: of products, of formulas.
 *
 * The columns of a sliding segment are means over time of the answers on all sides (sliding.h). A power is the mean of the
 * products on the sides, not the product of the means. At the nodes of a segment it is extrapolated as the columns are
 * (slide_try.c), from the answers of the same steps, and between them it is the polynomial through the nodes. */
#ifndef DALCS_SIDE_MEANS_H
#define DALCS_SIDE_MEANS_H

#include "radau.h"
#include "signal_formula.h"

struct dalcs_side_means {
    struct dalcs_radau *radau; /* borrowed, as `measured` is */
    const int *measured;       /* signals are indices here, which gives outputs of the network */
    int n, capacity;

    struct dalcs_side_mean {
        const struct dalcs_signal_formula *formula; /* NULL: the product of signals */
        int signal[2];
        bool is_square; /* of the formula, or else itself */
        int part;       /* that its signals read */
        int next;       /* of the same part; -1: the last one */
        double node[DALCS_MAX_NODES];
    } * mean; /* [n] heap */

    struct dalcs_side_means_part {
        int first;        /* of its means; -1: none */
        bool knows_start; /* its last try told what is at node 0 */
    } * part;             /* [radau->n_parts] heap */
};

/* Listens to the run's slides from then on; it must not move before it is finished. */
enum dalcs_status dalcs_side_means_setup(struct dalcs_side_means *means, struct dalcs_radau *radau,
                                         const int *measured) DALCS_MUST_CHECK;

/* Accepts a zeroed one. */
void dalcs_side_means_finish(struct dalcs_side_means *means);

/* *index: of one more mean, by which it is asked for; -1: its signals are not of one part. `mean` has formula, signal and
 * is_square. */
enum dalcs_status dalcs_side_means_add(struct dalcs_side_means *means,
                                       const struct dalcs_side_mean *mean,
                                       int *index) DALCS_MUST_CHECK;

/* Is the present segment of the part of a mean one of a slide? Else what the columns make of it is right. */
bool dalcs_side_means_slides(const struct dalcs_side_means *means, int index);

/* The same of any part that the formula reads. */
bool dalcs_side_means_formula_slides(const struct dalcs_side_means *means,
                                     const struct dalcs_signal_formula *formula);

/* And of any at all. */
bool dalcs_side_means_any_slides(const struct dalcs_side_means *means);

/* Of such a mean, at a time (s) of the segment. */
double dalcs_side_mean_at(const struct dalcs_side_means *means, int index, double time);

#endif

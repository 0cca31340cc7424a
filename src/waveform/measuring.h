/* measuring.h - the measurements of one analysis while it runs, exact on what it computes.
 *
 * The run hands over one stretch after the other, between events and edges; nothing is kept but sums,
 * extremes and the last crossing. What is asked for on the grid of the output has no influence. */
#ifndef DALCS_MEASURING_H
#define DALCS_MEASURING_H

#include "circuit.h"
#include "harmonics.h"
#include "instant.h"
#include "kept_stretches.h"
#include "side_means.h"

struct dalcs_measured {
    const struct dalcs_measure_card *card;
    struct dalcs_instant instant[2];
    double from, to;   /* the card's, or from earlier measurements */
    double begin, end; /* what the sums are over; end < begin: nothing yet */
    double integral, square;
    double least, least_at, most, most_at;
    double scale; /* largest magnitude so far */

    struct dalcs_measured_impulses {
        int n;
        double first; /* s, of the first one */
        double sum;   /* of their areas, which belong to an integral besides; NAN: one has none */
    } impulses;

    int mean; /* of its formula, or of the square of that, over the sides of a slide; -1: none */
    bool is_means; /* it is made of means over the sides of a slide, and not linear in them */
    bool has_value, has_no_value;
    bool waits; /* for the next stretch, which starts where it is to be evaluated */
    double value;
};

struct dalcs_measuring;

/* Who looks on, around each stretch: at all measurements that are not late, k < 0, or at one that is. */
struct dalcs_measuring_watch {
    void *user;
    void (*begin)(void *user, const struct dalcs_measuring *m, int k);
    void (*end)(void *user, const struct dalcs_measuring *m, int k);
};

struct dalcs_measuring {
    const struct dalcs_circuit *circuit;
    enum dalcs_measured_analysis analysis;
    double start, stop; /* what is measured, whatever cards say */
    double near;        /* s; an impulse that close to a window's end is there */
    bool is_euler;
    struct dalcs_stretch_rule rule;
    struct dalcs_stretch stretch; /* to be filled */
    double (*values)[DALCS_STRETCH_NODES];
    int n;
    struct dalcs_measured *item; /* [circuit->results.n_measures], those of other analyses unused */
    int n_harmonics;
    struct dalcs_harmonics *harmonics; /* one for each .four; in a .tran and a period */
    double *row, *row_imaginary; /* [n_signals] the last one; in time what was before a jump */
    double *
        impulse; /* [n_signals] to be filled: those at the start of a stretch; `row` with what changes there */
    struct dalcs_kept_stretches *kept; /* all of the run; NULL: no measurement is late */
    bool has_row;
    double row_at;
    const struct dalcs_measuring_watch *watch; /* borrowed; may be NULL */
    struct dalcs_side_means *sides;            /* borrowed; NULL: nothing slides */
};

/* Does the circuit have measurements in such an analysis? */
bool dalcs_measuring_is_wanted(const struct dalcs_circuit *circuit,
                               enum dalcs_measured_analysis analysis);

/* Is there one point alone: an operating point, or a sweep of one value? Then values, means and extremes are those there. */
bool dalcs_measuring_has_one_point(const struct dalcs_measuring *m);

/* From start to stop, in s or in the unit of what is swept. */
enum dalcs_status dalcs_measuring_setup(struct dalcs_measuring *m,
                                        const struct dalcs_circuit *circuit,
                                        enum dalcs_measured_analysis analysis, double start,
                                        double stop) DALCS_MUST_CHECK;
void dalcs_measuring_finish(struct dalcs_measuring *m);

/* Sums over slides are asked of these means from then on. */
enum dalcs_status dalcs_measuring_ask_sides(struct dalcs_measuring *m,
                                            struct dalcs_side_means *sides) DALCS_MUST_CHECK;

/* Is what the present stretch adds to the item's sums a mean over the sides of a slide? */
bool dalcs_measuring_adds_sides(const struct dalcs_measuring *m, const struct dalcs_measured *item);

/* What lies before this time counts for nothing; INFINITY: nothing is measured. */
double dalcs_measuring_begin(const struct dalcs_measuring *m);

/* m->stretch.value[circuit->n_measured] has been filled, at the nodes between from and to. Stretches
 * follow each other. has_impulses: m->impulse has been filled, too. */
void dalcs_measuring_stretch(struct dalcs_measuring *m, double from, double to, bool has_impulses);

/* Before the first stretch: value[n_measured] before an edge at t = 0. */
void dalcs_measuring_before_start(struct dalcs_measuring *m, const double *value);

/* A row of a sweep or an operating point: `at` is what is swept, not descending, in between straight
 * lines; re and, of an .ac, im hold the measured signals [circuit->n_measured]. */
void dalcs_measuring_row(struct dalcs_measuring *m, double at, const double *re, const double *im);

/* After the last: what was still waited for. */
enum dalcs_status dalcs_measuring_close(struct dalcs_measuring *m) DALCS_MUST_CHECK;

/* Measurement k, which is late, with result[circuit->results.n_measures] of those before it: goes through the
 * run again. False when a time has no value. */
bool dalcs_measuring_late(struct dalcs_measuring *m, int k, const double *result);

/* Are its rows at times? */
bool dalcs_measuring_has_time(enum dalcs_measured_analysis analysis);

#endif

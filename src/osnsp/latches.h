/* latches.h - jumps of formulas that hold each other on their sides keep them, as latches do. Private to src/osnsp. */
#ifndef DALCS_LATCHES_H
#define DALCS_LATCHES_H

#include "extremes.h"
#include "osnsp_internal.h"

/* Between their sides at once, and of these each of which acts on each: beyond that they are not looked at. */
enum { DALCS_MOST_LATCHES = 32, DALCS_MOST_IN_LOOP = 8 };

struct dalcs_latch_loops {
    int n;
    int of[DALCS_MOST_LATCHES]; /* first pairs of jumps that are between their sides */
    double adds[DALCS_MOST_LATCHES]
               [DALCS_MOST_LATCHES]; /* to the argument of the first, by the second */
};

/* Of those in `of`, in the mode p->mode, which hold themselves, as bits. p->mode, p->w and the certificate have no meaning behind
 * it. Not DALCS_OK: there is no answer with some of them on a side. */
enum dalcs_status dalcs_latch_loops_find(struct dalcs_osnsp *p, double sigma, const double *u,
                                         struct dalcs_latch_loops *of,
                                         uint32_t *holding) DALCS_MUST_CHECK;

/* What the outputs of those in `of` add to their arguments, into of->adds, in the mode p->mode. All are below behind it. */
enum dalcs_status dalcs_latch_find_additions(struct dalcs_osnsp *p, double sigma, const double *u,
                                             struct dalcs_latch_loops *of) DALCS_MUST_CHECK;

/* latch_led.c: which of those in `of` are led, of the answer kept, into p->latches. As dalcs_latch_loops_find(). */
enum dalcs_status dalcs_latch_led_find(struct dalcs_osnsp *p, double sigma, const double *u,
                                       const struct dalcs_latch_loops *of) DALCS_MUST_CHECK;

/* The argument of a jump, in y and p->w, by its first pair. */
double dalcs_latch_argument(const struct dalcs_osnsp *p, const double *y, int d);

/* What rounding may make of the argument of a jump in the last answer. */
static inline double dalcs_latch_noise(const struct dalcs_osnsp *p) {
    const double largest = dalcs_larger(p->certificate.volt, p->certificate.ampere);
    return p->options.certificate_tolerance * largest;
}

/* Puts a jump on a side. */
void dalcs_latch_put(struct dalcs_osnsp *p, int d, bool is_above);

enum dalcs_status dalcs_latches_setup(struct dalcs_osnsp *p) DALCS_MUST_CHECK;

/* As dalcs_osnsp_solve() with given sources, where none that holds itself is between its sides unless nothing else is found. */
enum dalcs_status dalcs_latches_solve(struct dalcs_osnsp *p, double sigma, const double *u,
                                      double *y) DALCS_MUST_CHECK;

#endif

/* harmonics.h - .four: Fourier's coefficients of the last periods of a run. */
#ifndef DALCS_HARMONICS_H
#define DALCS_HARMONICS_H

#include "measurement.h"
#include "side_means.h"
#include "stretch.h"

struct dalcs_harmonics {
    const struct dalcs_fourier_card *card;
    double frequency; /* Hz */
    double from, to;  /* s */
    double scale;
    double *cosine, *sine; /* [n_harmonics + 1] integrals over [from, to], over its length */
    bool has_no_value;
    int n_impulses; /* so many of its formula */
    int mean;       /* of the formula over the sides of a slide; -1: none */
    bool is_means;  /* it is made of means over the sides of a slide, and not linear in them */
};

/* For a run that ends at stop, in s; is_orbit: that is a period, whose multiple of its frequency next to the card's is
 * taken, over all of it. */
enum dalcs_status dalcs_harmonics_setup(struct dalcs_harmonics *h,
                                        const struct dalcs_fourier_card *card, double stop,
                                        bool is_orbit) DALCS_MUST_CHECK;
void dalcs_harmonics_finish(struct dalcs_harmonics *h);

/* sides: of its mean, where that slides; else NULL. */
void dalcs_harmonics_add(struct dalcs_harmonics *h, const struct dalcs_stretch *stretch,
                         const struct dalcs_side_means *sides);

/* Those at the start of the stretch, of [from, to); `near`: s, one that close to an end is there. */
void dalcs_harmonics_add_impulses(struct dalcs_harmonics *h, const struct dalcs_stretch *stretch,
                                  double near);

#endif

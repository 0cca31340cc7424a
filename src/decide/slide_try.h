/* slide_try.h - a segment of some length along a threshold. Private to slide.c. */
#ifndef DALCS_SLIDE_TRY_H
#define DALCS_SLIDE_TRY_H

#include "radau_state.h"

/* So many sequences: their weights add up to 92 times the rounding of one, and each more makes that three times as much. */
enum { DALCS_SLIDE_ORDER = 5 };

struct dalcs_slide_try {
    double h;                         /* s */
    double weight[DALCS_SLIDE_ORDER]; /* of the sequences in the values */
    double
        estimate[DALCS_SLIDE_ORDER]; /* and in those of an order less, without the first of them */
    double start[DALCS_MAX_NODES];   /* of the nodes behind the start, in the value at the start */
    double rounding;                 /* of a state at a node, over its unit's largest */
    double largest[2];               /* V, A: without states, of all sides */
    bool may_change;                 /* what slides along its threshold within the segment */
    bool begins;                     /* nothing has slid so far */
    bool slides;
    double held, fails; /* s, if not: up to where there was a mean, and where there was none */
    bool knows_start;   /* all columns there, and voltages of pairs */
    bool follows;       /* the segment before slid up to there, and nothing jumps between */
    double noise;       /* what rounding may make of the mean of both sides, over it */
    /* Errors over what is allowed; of pairs over that and noise, and without noise. */
    double states, pairs, bare;
    bool is_coarse; /* noise may hide an error of pairs */
};

/* One of length h (s), that is still to be tried. */
struct dalcs_slide_try dalcs_slide_try_of(const struct dalcs_collocation *method, double h);

/* Tries it: part->segment.out, and what conducts on either side in part->work.mode_first. */
enum dalcs_status dalcs_slide_attempt(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                      struct dalcs_slide_try *of) DALCS_MUST_CHECK;

/* slide_error.c: what a try that slides is off by, into it. At the start are all columns, if they are known. */
void dalcs_slide_find_errors(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                             struct dalcs_slide_try *of);

/* Which of what turns decides where a slide is, from micro-steps of length h/2 and h (sliding.h). */
enum dalcs_status dalcs_slide_find_leading(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                           double h) DALCS_MUST_CHECK;

/* Two micro-steps of length h along the threshold, into part->work.y1 and y2. *slides: there are two. */
enum dalcs_status dalcs_slide_micro_steps(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                          double h, bool *slides) DALCS_MUST_CHECK;

#endif

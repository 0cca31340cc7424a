/* reference.h - what errors are measured against: radau with seven stages and a tight tolerance,
 * confirmed with five stages and another one, at times away from where signals may jump. */
#ifndef DALCS_REFERENCE_H
#define DALCS_REFERENCE_H

#include "samples.h"

struct dalcs_reference {
    struct dalcs_session *session; /* borrowed */
    const volatile sig_atomic_t *interrupted;
    double start, stop;

    struct {
        size_t n;
        double *time; /* [n] where signals or their slopes may jump */
    } breaks;

    struct {
        size_t n;
        double *time;  /* [n] ascending, where states jump: impulses have no value there */
        double window; /* s */
    } jumps;

    struct {
        size_t n;
        double *at;        /* [n] s, ascending */
        bool *is_measured; /* [n] the others are for drawing, or near a break */
        size_t n_measured;
        double window; /* s; how far from any break and from both ends the measured ones are */
    } times;

    struct dalcs_samples samples;
    size_t n_signals;
    double *scale;     /* [n_signals] the largest |value|, but not less than 1 % of its unit's */
    bool *is_open;     /* [n_signals] the circuit does not determine it: nothing is measured */
    double *doubt;     /* [n_signals] how far the second answer is off, over the scale */
    size_t most_doubt; /* the signal with the largest */
    int stages, second_stages;
    double tolerance, second_tolerance;
};

/* Finds the breaks, and the jumps: two steps of the netlist around them nothing is measured. */
enum dalcs_status dalcs_reference_begin(struct dalcs_reference *reference,
                                        struct dalcs_session *session,
                                        const volatile sig_atomic_t *interrupted) DALCS_MUST_CHECK;

/* Times all over the run, and more of them from `view` on that are only drawn. */
enum dalcs_status dalcs_reference_spread(struct dalcs_reference *reference, double view,
                                         size_t n_view) DALCS_MUST_CHECK;

/* Multiples of `step`, at most a few thousand, that are at least `window` away from breaks. */
enum dalcs_status dalcs_reference_align(struct dalcs_reference *reference, double step,
                                        double window) DALCS_MUST_CHECK;

/* Both answers at these times. */
enum dalcs_status dalcs_reference_solve(struct dalcs_reference *reference) DALCS_MUST_CHECK;

/* The median time between breaks; the whole run where there are fewer than two. */
double dalcs_reference_median_gap(const struct dalcs_reference *reference);

/* Accepts a zeroed one. */
void dalcs_reference_finish(struct dalcs_reference *reference);

#endif

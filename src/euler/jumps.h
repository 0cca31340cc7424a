/* jumps.h - states just after a discontinuity, exactly: no step is taken for it.
 *
 * Of a passive component the state after a jump is the nearest to the one before, in the metric of the
 * stored energy, from which some mode can go on (Brogliato 2022, sec. 4; Heemels, Schumacher and
 * Weiland 1999, thm 6.14): the two problems of impulse_network.h, solved once for any number of
 * simultaneous jumps. Built when the first jump is met: most circuits never need it. */
#ifndef DALCS_JUMPS_H
#define DALCS_JUMPS_H

#include "impulse_network.h"
#include "osnsp.h"

struct dalcs_jumps {
    bool is_built;
    const struct dalcs_network *of;                         /* the circuit's */
    struct dalcs_impulse_network impulse[DALCS_N_IMPULSES]; /* of a circuit */
    const struct dalcs_network *network[DALCS_N_IMPULSES];  /* theirs, or those of a system file */
    int n_parts;
    struct dalcs_jump_part *part; /* systems of the two networks that hold states */
    int n_systems;
    int *first_part;  /* [n_systems] of the circuit's network: its first part, -1 without */
    bool *is_covered; /* [n_systems] passive, and with no dependent coils but transformers */
    bool **
        is_driven; /* [n_systems][n_x] states that sources which read act on; NULL: none is, or it is not passive */
};

/* All owned by the caller. */
struct dalcs_jump_answer {
    double *after;      /* [n_x] V, A */
    double *charge;     /* [n_pairs] C through the pair */
    double *flux;       /* [n_pairs] Wb across it */
    double source_work; /* J, delivered by the sources */
    bool is_covered;    /* jumps of this component are problems that can be put */
    bool is_known;      /* and solved; false: only what says so is filled */
    bool
        is_first; /* not known, but for the states that nothing which reads acts on, and their pairs */
    bool moves; /* some state jumps by more than rounding */
};

/* All that does not change from jump to jump, the first time. Tells of is_covered, too. */
enum dalcs_status dalcs_jumps_build(struct dalcs_jumps *jumps, const struct dalcs_circuit *circuit,
                                    const struct dalcs_network *network,
                                    const struct dalcs_osnsp_options *options) DALCS_MUST_CHECK;

/* The jump of system k of the network, once it is built, from x[n_x] with inputs[n_inputs] just after it;
 * mode[(n_pairs + 63) / 64] commands the switches and is a first guess for the diodes. Where sources that read act on
 * states the rest of the component, which is passive, jumps as if they were not there: answer->is_first, and what the
 * answer has of driven states and of other pairs stays as it was. */
enum dalcs_status dalcs_jumps_solve(const struct dalcs_jumps *jumps, int k, const uint64_t *mode,
                                    const double *x, const double *inputs,
                                    struct dalcs_jump_answer *answer) DALCS_MUST_CHECK;

/* Is the jump from x[n_x] to `limit`, as vanishing steps see it, the one to `after`? The limit is known
 * as well as the last of these steps, which led to `last`, is near to it. */
bool dalcs_jumps_agree(const struct dalcs_system *system, const double *x, const double *limit,
                       const double *last, const double *after);

void dalcs_jumps_finish(struct dalcs_jumps *jumps);

#endif

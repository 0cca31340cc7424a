/* steady_means.h - averages and rms of all signals of the network over a run, exact on its polynomials. */
#ifndef DALCS_STEADY_MEANS_H
#define DALCS_STEADY_MEANS_H

#include "edges_ahead.h"
#include "impulses.h"
#include "rows.h"
#include "stretch.h"

struct dalcs_steady_means {
    const struct dalcs_circuit *circuit;
    struct dalcs_rows rows;
    struct dalcs_stretch_rule rule;
    struct dalcs_edges_ahead edges; /* of all sources */
    double t, longest, next_edge;   /* s */
    double *sum, *square;           /* [n_outputs] integrals over the time from 0 to t */
    struct dalcs_impulses impulses; /* of the jumps at `impulses.time`, not in the sums yet */
    bool *has_impulse;              /* [n_outputs] its square has no integral */
};

/* Before the run starts: jumps are told of from then on. *m is zeroed. */
enum dalcs_status dalcs_steady_means_listen(struct dalcs_steady_means *m,
                                            const struct dalcs_circuit *circuit,
                                            const struct dalcs_network *network,
                                            struct dalcs_euler *engine,
                                            double near) DALCS_MUST_CHECK;

enum dalcs_status dalcs_steady_means_setup(struct dalcs_steady_means *m,
                                           const struct dalcs_circuit *circuit,
                                           const struct dalcs_network *network,
                                           struct dalcs_radau *radau) DALCS_MUST_CHECK;
void dalcs_steady_means_finish(struct dalcs_steady_means *m);

/* Up to t, where the present segments may end but none before. */
enum dalcs_status dalcs_steady_means_reach(struct dalcs_steady_means *m, double t) DALCS_MUST_CHECK;

/* At the end, of a run so long. The rms of what has an impulse is no number. */
double dalcs_steady_means_average(const struct dalcs_steady_means *m, int output, double duration);
double dalcs_steady_means_rms(const struct dalcs_steady_means *m, int output, double duration);

/* What is not in the sums yet. */
void dalcs_steady_means_close(struct dalcs_steady_means *m);

#endif

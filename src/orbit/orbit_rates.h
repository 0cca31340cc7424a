/* orbit_rates.h - derivatives by time along a run: of the states, from the equations; of a guard, from its polynomial. */
#ifndef DALCS_ORBIT_RATES_H
#define DALCS_ORBIT_RATES_H

#include "radau_state.h"

struct dalcs_orbit_rates {
    const struct dalcs_radau_part *part;
    int n_x;
    double *P; /* [n_x][n_x] factored */
    int *pivot;
    double *unit;   /* [n_x] square roots of what states store */
    double *inputs; /* work */
};

enum dalcs_status dalcs_orbit_rates_setup(struct dalcs_orbit_rates *rates,
                                          struct dalcs_arena *arena,
                                          const struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* f[n_x] = x' of the columns y in the layout of an answer, at tau into the present segment. Open pairs of y, in whose
 * place is their w, become 0. */
void dalcs_orbit_rates_of(const struct dalcs_orbit_rates *rates, double *y, double tau, double *f);

/* The row of a guard in an answer. */
int dalcs_orbit_guard_row(const struct dalcs_radau_part *part, int guard);

/* The derivative by time of a row, at theta in the present step. */
double dalcs_orbit_row_rate(const struct dalcs_radau_part *part, int row, double theta);

/* That of a guard where the present segment ends. */
double dalcs_orbit_guard_rate(const struct dalcs_radau_part *part, int row);

/* The place of a column among the bystanders of a part; -1: it is none. */
int dalcs_orbit_bystander(const struct dalcs_radau_part *part, int column);

/* The derivative by time of what a probe reads of the part, where the present segment begins, or ends; term: work. */
double dalcs_orbit_probe_rate(const struct dalcs_radau_part *part, const struct dalcs_probe *probe,
                              bool at_begin, struct dalcs_stimulus_term *term);

/* V/s: the slope of a source just before t, and from t on; term: work, as many as it has. */
double dalcs_slope_before(const struct dalcs_stimulus *s, double t,
                          struct dalcs_stimulus_term *term);
double dalcs_slope_behind(const struct dalcs_stimulus *s, double t,
                          struct dalcs_stimulus_term *term);

/* The sum of weight[n_nodes] * a row of an answer at the nodes. */
double dalcs_orbit_weigh(const struct dalcs_stage_layout *l, const double *weight,
                         const double *out, int row);

#endif

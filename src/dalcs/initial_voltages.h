/* initial_voltages.h - what .ic says of a capacitor's voltage: v(a)= of its ends, or v(a,b)= of both.
 *
 * Looked up by node, so that as many capacitors as conditions are no square of them. */
#ifndef DALCS_INITIAL_VOLTAGES_H
#define DALCS_INITIAL_VOLTAGES_H

#include "circuit.h"

/* All NULL without conditions. */
struct dalcs_initial_voltages {
    double *of_node; /* [n_nodes] V, by representative; 0 where nothing is said */
    int *first; /* [n_nodes] 2 k + e when the node is end e of condition k on two nodes, or -1 */
    int *next;  /* [2 n_initial_conditions] the next of the same node, ascending, or -1 */
};

/* node_of[n_nodes]: representatives after merging shorts. */
enum dalcs_status dalcs_initial_voltages_setup(struct dalcs_initial_voltages *v,
                                               const struct dalcs_circuit *circuit,
                                               const int *node_of) DALCS_MUST_CHECK;

/* Of node a against node b, both representatives. */
double dalcs_initial_voltages_between(const struct dalcs_initial_voltages *v,
                                      const struct dalcs_circuit *circuit, const int *node_of,
                                      int a, int b);

void dalcs_initial_voltages_finish(struct dalcs_initial_voltages *v);

#endif

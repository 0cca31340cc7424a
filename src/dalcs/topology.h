/* topology.h - what the graph of a circuit says before any number is written: which parts are
 * independent, which islands float, which capacitors form a forest. */
#ifndef DALCS_TOPOLOGY_H
#define DALCS_TOPOLOGY_H

#include "circuit.h"

struct dalcs_topology {
    int *node_of; /* [n_nodes] representative after merging the two ends of every short */
    int n_components;
    int *node_component;   /* [n_nodes], of representatives; -1 for ground */
    int *device_component; /* [n_devices], -1 for a device that leaves no equation */
    bool *is_reference;    /* [n_nodes] the node whose voltage is 0 by convention in an island that
                            nothing ties to ground: its first node in the netlist */
    int *reference_of;     /* [n_nodes] that node, for representatives; ground where tied to it */
    bool *in_forest;       /* [n_devices] capacitors: their current is eliminated */
    bool *has_current;     /* [n_devices] shorts and capacitors: their current is an unknown */
    bool *is_idle; /* [n_devices] V sources and shorts that close a loop of such elements whose
                              voltages agree: they carry no current by convention */
    int *
        potential_source; /* [n_nodes] V device between a node and one nearer to its root, or an E that such
                              nodes control; -1 for a root, for a node of no tree, and without switches */
    int *
        potential_root; /* [n_nodes] between nodes with one root sources alone fix the voltage; ground, or a
                              floating node at a source; -1 for a node of no tree, and without switches */
    int *forest_root; /* [n_nodes] root of the capacitor tree that a node is in; itself if none */
};

/* wants_current[n_devices]: a signal is i(device). */
enum dalcs_status dalcs_topology_build(struct dalcs_topology *topology,
                                       const struct dalcs_circuit *circuit,
                                       const bool *wants_current) DALCS_MUST_CHECK;

void dalcs_topology_finish(struct dalcs_topology *topology);

#endif

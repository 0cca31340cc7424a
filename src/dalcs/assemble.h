/* assemble.h - devices to equations, one component at a time. Private to src/dalcs. */
#ifndef DALCS_ASSEMBLE_H
#define DALCS_ASSEMBLE_H

#include "inductance.h"
#include "initial_voltages.h"
#include "network.h"
#include "topology.h"

/* Magnetically coupled coils. */
struct coil_group {
    int n;
    const int *device; /* [n] ascending, in the layout's grouped_coil */
    double *L;         /* [n][n] H */
    struct dalcs_inductance split;
};

/* Where everything of the circuit went; filled by assembling, read by the probes. */
struct dalcs_layout {
    const struct dalcs_circuit *circuit;
    const struct dalcs_network_options *options;
    struct dalcs_topology topology;
    int *node_column;    /* [n_nodes] z column of a representative's voltage, -1 for ground */
    int *kcl_row;        /* [n_nodes] */
    int *state_column;   /* [n_devices] x column of a capacitor or an independent coil, else -1 */
    int *current_column; /* [n_devices] column of the current where it is an unknown, else -1 */
    int *branch_row;     /* [n_devices] row of II of that current's branch equation */
    int *pair;           /* [n_devices] first pair of a diode or switch, else -1 */
    int *input;          /* [n_devices] input of a V or I source */
    int n_groups;
    struct coil_group *group;
    int *group_of; /* [n_devices], -1 for a coil on its own */
    int *grouped_coil;
    double
        most_conductance; /* S, of the part that is assembled: what conducts better is a branch */
    struct dalcs_initial_voltages initial_voltages;
    int *held_start, *held; /* [n_components + 1] conditions of .ic that each component holds, one
                               component's after the other's; NULL when none are held */
};

/* A component's devices and nodes, ascending. */
struct dalcs_members {
    int n_devices;
    const int *device;
    int n_nodes;
    const int *node;
};

/* Assembles a component into *system (zeroed on failure) and x(0-) into *initial (freed by the caller). Names are
 * borrowed from the circuit. */
enum dalcs_status dalcs_assemble_component(struct dalcs_layout *layout,
                                           const struct dalcs_members *members,
                                           struct dalcs_system *system,
                                           double **initial) DALCS_MUST_CHECK;

/* A resistor of the assembled part; its current is an unknown. */
bool dalcs_layout_is_branch(const struct dalcs_layout *layout, int device);

/* The current of coil `device` as columns and coefficients (at most 1 + coils of its group). Returns
 * their number. */
int dalcs_layout_coil_current(const struct dalcs_layout *layout, int device, int *column,
                              double *coefficient);

#endif

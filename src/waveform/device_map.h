/* device_map.h - the devices of a circuit that pairs and states belong to. */
#ifndef DALCS_DEVICE_MAP_H
#define DALCS_DEVICE_MAP_H

#include "circuit.h"
#include "network.h"

/* Zero-initialise. */
struct dalcs_device_map {
    int n_systems;
    int **of_pair; /* [n_systems][n_pairs] -1: of no device */
    int *of_state; /* [n_states] */
};

/* *map is zero-initialised; to finish it also after a failure. */
enum dalcs_status dalcs_device_map_setup(struct dalcs_device_map *map,
                                         const struct dalcs_circuit *circuit,
                                         const struct dalcs_network *network) DALCS_MUST_CHECK;
void dalcs_device_map_finish(struct dalcs_device_map *map);

#endif

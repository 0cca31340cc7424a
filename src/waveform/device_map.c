/* device_map.c - the devices of a circuit that pairs and states belong to. */
#include "device_map.h"

#include "memory.h"
#include "names.h"

#include <stdlib.h>

static enum dalcs_status fill(struct dalcs_device_map *map, const struct dalcs_circuit *c,
                              const struct dalcs_network *n, struct dalcs_names *names) {
    for (int k = 0; k < c->n_devices; k++) {
        DALCS_TRY(dalcs_names_add(names, c->device[k].name, k));
    }
    for (int i = 0; i < n->n_states; i++) {
        map->of_state[i] = dalcs_names_find(names, n->state[i].element);
    }
    for (int s = 0; s < n->n_systems; s++) {
        const struct dalcs_system *system = &n->system[s];
        map->of_pair[s] = dalcs_alloc((size_t)system->n_pairs, sizeof(int));
        if (map->of_pair[s] == NULL) {
            return DALCS_E_NOMEM;
        }
        for (int d = 0; d < system->n_pairs; d++) {
            const struct dalcs_pair *pair = &system->pair[d];
            map->of_pair[s][d] = pair->is_formula ? -1 : dalcs_names_find(names, pair->element);
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_device_map_setup(struct dalcs_device_map *map,
                                         const struct dalcs_circuit *circuit,
                                         const struct dalcs_network *network) {
    struct dalcs_names names = {0};
    map->n_systems = network->n_systems;
    map->of_pair = dalcs_alloc((size_t)network->n_systems, sizeof(*map->of_pair));
    map->of_state = dalcs_alloc((size_t)network->n_states, sizeof(int));
    if (map->of_pair == NULL || map->of_state == NULL) {
        return DALCS_E_NOMEM;
    }
    enum dalcs_status status = fill(map, circuit, network, &names);
    dalcs_names_finish(&names);
    return status;
}

void dalcs_device_map_finish(struct dalcs_device_map *map) {
    for (int s = 0; map->of_pair != NULL && s < map->n_systems; s++) {
        free(map->of_pair[s]);
    }
    free(map->of_pair);
    free(map->of_state);
    *map = (struct dalcs_device_map){0};
}

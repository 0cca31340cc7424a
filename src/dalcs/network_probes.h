/* network_probes.h - how outputs and states are read from the columns of a network. Private to src/dalcs. */
#ifndef DALCS_NETWORK_PROBES_H
#define DALCS_NETWORK_PROBES_H

#include "assemble.h"

enum dalcs_status dalcs_network_build_outputs(struct dalcs_network *network,
                                              const struct dalcs_layout *l) DALCS_MUST_CHECK;

enum dalcs_status dalcs_network_build_states(struct dalcs_network *network,
                                             const struct dalcs_layout *l) DALCS_MUST_CHECK;

#endif

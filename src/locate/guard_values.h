/* guard_values.h - guards as polynomials on the step: their values at its nodes, and in between. */
#ifndef DALCS_GUARD_VALUES_H
#define DALCS_GUARD_VALUES_H

#include "guard_scale.h"

/* A voltage that moves a switch, less its threshold, at a node. */
static inline double dalcs_guard_control_at(const struct dalcs_radau_part *part, int guard,
                                            int node) {
    const struct dalcs_system *s = part->component->system;
    int d = dalcs_guard_pair(part, guard);
    double v = part->segment.out[node * part->stages.layout.stride + dalcs_system_n_columns(s) +
                                 guard - s->n_pairs];
    const struct dalcs_osnsp *p = &part->component->osnsp;
    return dalcs_osnsp_is_on(p, d) ? v - dalcs_switch_opens_at(s, p->mode, d)
                                   : s->pair[d].turn_on - v;
}

/* Values at the nodes, with their stride; of a pair they are in the answer itself. */
static inline const double *dalcs_guard_values(const struct dalcs_radau_part *part, int guard,
                                               double *work, int *stride) {
    const struct dalcs_system *s = part->component->system;
    *stride = part->stages.layout.stride;
    if (guard < s->n_pairs) {
        return part->segment.out + dalcs_system_n_equations(s) + guard;
    }
    for (int k = 0; k < part->stages.layout.n_nodes; k++) {
        work[k] = dalcs_guard_control_at(part, guard, k);
    }
    *stride = 1;
    return work;
}

/* Between the nodes, at theta in steps. */
double dalcs_guard_value_at(const struct dalcs_radau_part *part, const double *value, int stride,
                            double theta);

/* Values at the nodes of a pair in the segment before, with their stride; NULL if they are not known or it
 * was on the other side. */
const double *dalcs_guard_values_before(const struct dalcs_radau_part *part, int pair);

/* Has it just changed sides, and rises from node to node, above what the rounding of a map would be? That of factors
 * may be larger, but does not. */
bool dalcs_guard_has_crossed(const struct dalcs_radau_part *part, int pair, const double *value,
                             int stride, const double *unit);

#endif

/* guard_values.c - what guards are between the nodes, and were before. */
#include "guard_values.h"

#include "doubt.h"
#include "extremes.h"

#include <math.h>

double dalcs_guard_value_at(const struct dalcs_radau_part *part, const double *value, int stride,
                            double theta) {
    double weight[DALCS_MAX_NODES];
    double sum = 0.0;
    dalcs_collocation_weights(part->stages.method, theta, weight);
    for (int k = 0; k < part->stages.layout.n_nodes; k++) {
        sum += weight[k] * value[k * stride];
    }
    return sum;
}

const double *dalcs_guard_values_before(const struct dalcs_radau_part *part, int pair) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    if (part->segment.by_euler || dalcs_guard_has_flipped(part, pair)) {
        return NULL;
    }
    return part->segment.out_before + dalcs_system_n_equations(p->system) + pair;
}

bool dalcs_guard_has_crossed(const struct dalcs_radau_part *part, int pair, const double *value,
                             int stride, const double *unit) {
    int last = part->stages.layout.n_nodes - 1;
    double least =
        dalcs_doubt_noise(part) / part->segment.rounding * dalcs_guard_scale(part, pair, unit);
    bool rises = part->guards.flipped &&
                 value[last * stride] > dalcs_larger(least, fabs(value[0])) &&
                 dalcs_guard_has_flipped(part, pair);
    for (int k = 1; k <= last && rises; k++) {
        rises = value[k * stride] > value[(k - 1) * stride];
    }
    return rises;
}

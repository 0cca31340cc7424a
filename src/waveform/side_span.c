/* side_span.c - the polynomial of a mean over the sides of a slide. */
#include "side_span.h"

void dalcs_side_means_span(const struct dalcs_side_means *means, int index,
                           const struct dalcs_stretch_rule *rule, double from, double to,
                           struct dalcs_span *span) {
    *span = (struct dalcs_span){.from = from, .to = to};
    for (int i = 0; i < DALCS_STRETCH_NODES; i++) {
        const double time = from + 0.5 * (1.0 + rule->node[i]) * (to - from);
        span->value[i] = dalcs_side_mean_at(means, index, time);
    }
    dalcs_stretch_expand(rule, span->value, span->coefficient);
}

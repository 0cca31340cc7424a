/* first_level.c - how long the first step of a mode is. */
#include "first_level.h"

#include "present.h"
#include "transition.h"

#include <math.h>

enum { MOST_PREFERRED = 2 }; /* rungs of the ladder, for the sake of factors */

/* Nothing conducts any more: sines no longer act on the states through diodes, and the states decay by themselves.
 * Where pulses or commands end steps that says nothing of their length, and fewer stages would use up what is allowed:
 * of a multiplier's voltages 0.4 of the tolerance instead of 0.01. */
static bool is_let_go(const struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    bool only_sines = part->stages.method->s == DALCS_MAX_STAGES &&
                      part->excitation.shortest_period < INFINITY &&
                      part->length.longest_needed == INFINITY && part->commands.n == 0;
    bool conducts = false;
    for (int d = 0; d < p->system->n_pairs && only_sines && !conducts; d++) {
        conducts = dalcs_osnsp_is_on(p, d);
    }
    return only_sines && !conducts;
}

int dalcs_first_level(struct dalcs_radau_part *part) {
    bool has_maps = part->segment.rounding == 1.0;
    int level = has_maps ? dalcs_transition_longest_level(part) : part->length.level;
    for (int k = 0; k <= MOST_PREFERRED; k++) {
        double h = dalcs_radau_ladder(part, level + k);
        if (dalcs_stages_find(&part->stages, part->component->osnsp.mode, h) != NULL) {
            return level + k;
        }
    }
    bool may_be_longer = has_maps && level == part->length.level &&
                         dalcs_radau_ladder(part, level - 1) <= part->length.longest;
    return may_be_longer && is_let_go(part) ? level - 1 : level;
}

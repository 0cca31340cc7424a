/* blocks.c - the first block of a step that is wrong, and the mode of those before it. */
#include "blocks.h"

#include "guard_scale.h"
#include "guard_values.h"
#include "step_error.h"
#include "tied.h"

#include <limits.h>
#include <math.h>

static int block_of(const struct dalcs_radau_part *part, int pair) {
    const int *block = part->stages.block_of;
    return block == NULL ? 0 : block[dalcs_system_n_equations(part->component->system) + pair];
}

int dalcs_blocks_first_crossed(const struct dalcs_radau_part *part) {
    int first = INT_MAX;
    for (int k = 0; k < part->guards.n_crossed; k++) {
        int block = block_of(part, dalcs_guard_pair(part, part->guards.crossed[k]));
        first = block < first ? block : first;
    }
    return first < INT_MAX ? first : 0;
}

/* Have all diodes of blocks before this one the right signs in the present step? */
static bool are_right_before(const struct dalcs_radau_part *part, int block, const double *unit) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    bool right = true;
    for (int d = 0; d < p->system->n_pairs && right; d++) {
        if (!p->lists.is_diode[d] || block_of(part, d) >= block) {
            continue;
        }
        double work[DALCS_MAX_NODES];
        int stride;
        const double *value = dalcs_guard_values(part, d, work, &stride);
        double least = -dalcs_tied_nothing(part, d, unit);
        for (int k = 0; k < part->stages.layout.n_nodes && right; k++) {
            right = value[k * stride] >= least;
        }
    }
    return right;
}

int dalcs_blocks_first_wrong(const struct dalcs_radau_part *part, const double *unit) {
    const int *block = part->stages.block_of;
    const double *drift = part->segment.out + part->stages.layout.drift;
    int first = INT_MAX;
    for (int x = 0; block != NULL && x < part->component->system->n_x; x++) {
        double allowed = part->inner_tolerance * dalcs_step_scale(part, x, unit);
        bool is_wrong = !(fabs(drift[x]) <= allowed);
        first = is_wrong && block[x] < first ? block[x] : first;
    }
    return first < INT_MAX && are_right_before(part, first, unit) ? first : 0;
}

/* No block from that one on in which a switch has moved is what it was, whatever moved it: what reads a circuit may control
 * a switch in it. */
static int before_moved(const struct dalcs_radau_part *part, int block, const uint64_t *mode) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    for (int d = 0; d < p->system->n_pairs; d++) {
        bool moved = !p->lists.is_diode[d] && dalcs_mode_has(mode, d) != dalcs_osnsp_is_on(p, d);
        block = moved && block_of(part, d) < block ? block_of(part, d) : block;
    }
    return block;
}

void dalcs_blocks_put_back(struct dalcs_radau_part *part, int block, const uint64_t *mode) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    const int first = block > 0 ? before_moved(part, block, mode) : 0;
    for (int d = 0; first > 0 && d < p->system->n_pairs; d++) {
        if (p->lists.is_diode[d] && block_of(part, d) < first) {
            dalcs_osnsp_command(p, d, dalcs_mode_has(mode, d));
        }
    }
}

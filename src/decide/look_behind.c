/* look_behind.c - where switches stand just behind an instant, before anything begins there.
 *
 * Sources have jumped, and gates that read the circuit are to decide about all that this changes at once. A segment that
 * began before they have decided might let a state jump that they keep. So two micro-steps are solved and forgotten: the
 * first holds the impulses of a jump, the second does not. */
#include "look_behind.h"

#include "micro_steps.h"
#include "restart.h"

#include <string.h>

static enum dalcs_status solve(struct dalcs_radau *r, struct dalcs_radau_part *part, double h) {
    dalcs_micro_positions(part, false);
    DALCS_TRY(dalcs_radau_implicit_step(r, part, h, h, part->x, part->work.y1));
    if (part->component->system->n_x == 0) {
        memcpy(part->work.y2, part->work.y1,
               (size_t)dalcs_system_n_columns(part->component->system) * sizeof(double));
        return DALCS_OK;
    }
    return dalcs_radau_implicit_step(r, part, h, 2.0 * h, part->work.y1, part->work.y2);
}

enum dalcs_status dalcs_look_behind(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                    uint64_t *mode) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    const size_t bytes = (size_t)p->n_words * sizeof(uint64_t);
    const bool slides = part->guards.slides;
    memcpy(part->work.mode_before, p->mode, bytes);
    part->guards.slides = false;
    enum dalcs_status status = solve(r, part, dalcs_radau_micro_length(r, part, 0));
    if (status == DALCS_OK && !part->guards.slides) {
        dalcs_micro_positions(part, true); /* those with hysteresis, too */
        (void)dalcs_positions_move_all_once(&part->component->positions, part->work.y2);
        memcpy(mode, p->mode, bytes);
    } else {
        memcpy(mode, part->work.mode_before, bytes);
    }
    memcpy(p->mode, part->work.mode_before, bytes);
    part->guards.slides = slides;
    return status < DALCS_OK ? status : DALCS_OK;
}

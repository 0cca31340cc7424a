/* open.c - segments in a mode that leaves something open: whom that concerns is told, once for each. */
#include "radau.h"
#include "segment.h"
#include "tied.h"

/* Calls on_open for the instant t of the part's segment. */
static enum dalcs_status tell_open_at(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                      double t, enum dalcs_side side, bool *vanishes) {
    struct dalcs_euler *e = r->base;
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_osnsp *p = &part->component->osnsp;
    DALCS_TRY(dalcs_radau_evaluate(r, t, side));
    for (int d = 0; d < s->n_pairs; d++) {
        double other = part->work.y1[dalcs_system_n_equations(s) + d];
        part->work.w1[d] = dalcs_osnsp_is_on(p, d) ? 0.0 : other;
        part->guards.tied[d] = dalcs_tied_is(part, d, part->scales.unit);
    }
    return e->listener.on_open(
        e->listener.open_user,
        &(struct dalcs_open_instant){.time = t,
                                     .engine = e,
                                     .system = part->index,
                                     .mode = p->mode,
                                     .w = part->work.w1,
                                     .tied = part->guards.tied,
                                     .scale = {part->scales.unit[0], part->scales.unit[1]}},
        vanishes);
}

/* At the start of such a segment or, where there is nothing to share yet, at its end; or in between: while a bridge
 * commutates, all its diodes conduct, from the first current that one takes over to the last that another gives up. */
enum dalcs_status dalcs_radau_tell_open(struct dalcs_radau *r) {
    for (int k = 0; k < r->n_parts; k++) {
        struct dalcs_radau_part *part = &r->part[k];
        bool vanishes = false;
        if (part->segment.open && r->base->listener.on_open != NULL) {
            DALCS_TRY(tell_open_at(r, part, part->segment.t, DALCS_RIGHT, &vanishes));
        }
        if (vanishes) {
            DALCS_TRY(tell_open_at(r, part, part->segment.t_end, DALCS_LEFT, &vanishes));
        }
        if (vanishes) {
            double middle = part->segment.t + 0.5 * (part->segment.t_end - part->segment.t);
            DALCS_TRY(tell_open_at(r, part, middle, DALCS_RIGHT, &vanishes));
        }
        part->segment.open = false;
    }
    return DALCS_OK;
}

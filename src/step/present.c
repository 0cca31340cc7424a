/* present.c - a part's present step: its input, its output, and its acceptance. */
#include "present.h"

#include "extremes.h"
#include "smooth_step.h"

double dalcs_radau_limit(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    return dalcs_smaller(dalcs_smaller(part->excitation.next_edge, part->commands.next),
                         r->options.stop);
}

void dalcs_segment_inputs(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    memcpy(part->segment.in, part->x, (size_t)s->n_x * sizeof(double));
    part->segment.in[s->n_x] = 1.0;
    dalcs_excitation_coefficients(&part->excitation, part->segment.t, part->segment.h,
                                  part->segment.in + s->n_x + 1);
}

enum dalcs_status dalcs_segment_solve(struct dalcs_radau_part *part,
                                      struct dalcs_stage_entry **entry) {
    if (part->smooth != NULL) {
        return dalcs_smooth_step_solve(part, entry);
    }
    dalcs_segment_inputs(part);
    DALCS_TRY(dalcs_stages_step(&part->stages, part->component->osnsp.mode, part->segment.h,
                                part->segment.in, part->segment.out, entry));
    part->segment.rounding = dalcs_stage_rounding(*entry);
    return DALCS_OK;
}

void dalcs_present_hold(struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    memcpy(part->memory.modes_before, p->mode, (size_t)p->n_words * sizeof(uint64_t));
}

void dalcs_segment_accept(struct dalcs_radau *r, struct dalcs_radau_part *part, double theta,
                          double residual) {
    part->segment.end = theta;
    part->segment.by_euler = false;
    if (part->smooth != NULL) {
        dalcs_smooth_step_note(part, theta);
    }
    if (theta * part->segment.h > 4.0 * part->length.fell_back) {
        part->length.tries = 0;
    }
    r->steps++;
    if (residual > r->worst_residual) {
        r->worst_residual = residual;
        r->worst_time = part->segment.t;
    }
    if (part->guards.fresh) {
        dalcs_present_hold(part);
        part->guards.fresh = false;
        part->guards.flipped = false;
    }
}

void dalcs_radau_go_after(const struct dalcs_radau *r, struct dalcs_radau_part *part) {
    const struct dalcs_observer *observer = r->base->listener.observer;
    if (observer != NULL) {
        observer->move(observer->user, part->index, part->x, part->work.after);
    }
    memcpy(part->x, part->work.after, (size_t)part->component->system->n_x * sizeof(double));
}

/* slide.c - a segment along the threshold of a switch that opens what closes it and closes what opens it.
 *
 * Filippov's mean of both sides (sliding.h), by steps of implicit Euler that are extrapolated: twice the answer of two
 * steps, less that of one twice as long, is off by the square of the step. */
#include "slide.h"

#include "guard_scale.h"
#include "restart.h"
#include "sliding.h"

#include <string.h>

/* At a threshold that a switch slides along the state is as exact as digits are. */
static void prepare_positions(struct dalcs_radau_part *part) {
    struct dalcs_positions *p = &part->component->positions;
    int n_pairs = part->component->system->n_pairs;
    p->keeps = false;
    for (int i = 0; i < p->n; i++) {
        p->slack[i] = dalcs_guard_most_rounding(part, n_pairs + i, part->scales.unit);
    }
}

/* A step of length h from state[n_x] to part->segment.t + tau into y, which counts so many times. */
struct counted_step {
    double h, tau, times;
    const double *state;
    double *y;
};

/* In the energies *taken. */
static enum dalcs_status mean_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                   const struct counted_step *step, double *taken, bool *slides) {
    struct dalcs_component *c = part->component;
    const struct dalcs_observer *observer = r->base->observer;
    *slides = false;
    enum dalcs_status status =
        dalcs_radau_implicit_step(r, part, step->h, step->tau, step->state, step->y);
    if (status != DALCS_OK || !c->positions.alternates) {
        return status < DALCS_OK ? status : DALCS_OK; /* without an answer it does not slide */
    }
    memcpy(c->scratch, step->y, (size_t)dalcs_system_n_columns(c->system) * sizeof(double));
    double weight = dalcs_sliding_mean(&c->positions, step->y);
    *slides = weight > 0.0;
    if (*slides && observer != NULL) {
        const struct dalcs_observed_sides sides = {.y = {c->scratch, c->positions.other_y},
                                                   .weight = {1.0 - weight, weight},
                                                   .time = step->times * step->h};
        observer->scale(observer->user, part->index, &c->osnsp.certificate);
        *taken +=
            step->times * observer->sliding_step(observer->user, part->index, step->state, step->y,
                                                 &sides, part->work.u + c->system->n_x);
    }
    return DALCS_OK;
}

static void extrapolate(double *fine, const double *coarse, int n) {
    for (int k = 0; k < n; k++) {
        fine[k] += fine[k] - coarse[k];
    }
}

/* One step, and two of half its length: part->work.y1 and the other side's values are extrapolated from them. */
static enum dalcs_status three_steps(struct dalcs_radau *r, struct dalcs_radau_part *part, double h,
                                     double *taken, bool *slides) {
    struct dalcs_component *c = part->component;
    const struct dalcs_system *s = c->system;
    DALCS_TRY(
        mean_step(r, part, &(struct counted_step){h, h, -1.0, part->x, c->probe_y}, taken, slides));
    memcpy(part->work.w1, c->osnsp.w, (size_t)s->n_pairs * sizeof(double));
    if (*slides) {
        DALCS_TRY(mean_step(r, part,
                            &(struct counted_step){0.5 * h, 0.5 * h, 2.0, part->x, part->work.y2},
                            taken, slides));
    }
    if (*slides) {
        DALCS_TRY(mean_step(r, part,
                            &(struct counted_step){0.5 * h, h, 2.0, part->work.y2, part->work.y1},
                            taken, slides));
    }
    if (*slides) {
        extrapolate(part->work.y1, c->probe_y, dalcs_system_n_columns(s));
        extrapolate(c->osnsp.w, part->work.w1, s->n_pairs);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_slide_step(struct dalcs_radau *r, struct dalcs_radau_part *part, double h,
                                   bool *slides) {
    struct dalcs_component *c = part->component;
    const struct dalcs_observer *observer = r->base->observer;
    double taken = 0.0;
    if (observer != NULL) {
        observer->hold(observer->user);
    }
    prepare_positions(part);
    enum dalcs_status status = three_steps(r, part, h, &taken, slides);
    part->guards.slides = false;
    if (!*slides) {
        if (observer != NULL) {
            observer->take_back(observer->user);
        }
        return status;
    }
    c->slid_steps++;
    bool is_same = dalcs_sliding_join(&c->positions);
    bool goes_on = is_same && part->segment.by_euler && part->segment.why == DALCS_END_OF_STEP;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    const double *last = part->segment.out_before + (l->n_nodes - 1) * l->stride;
    if (observer != NULL) {
        observer->slide(observer->user, part->index, part->x, part->work.y1, taken);
    }
    dalcs_radau_accept_euler(r, part, h, goes_on ? last : NULL);
    r->steps++;
    return DALCS_OK;
}

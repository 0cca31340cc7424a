/* sensitivity_tangent.c - what an orbit measures, along its tangent by a value.
 *
 * An orbit x = Phi(x, p) moves with p by x' = (1 - M)^-1 dPhi/dp, where dPhi/dp is that from the states as they are. With
 * states that move along the tangent, x + d x', and a value p + d, a period measures f(d), and f'(0) is the derivative of
 * what the orbit itself measures: the curvature of f has no influence. So no circuit's orbit is looked for, and no M made
 * but the one. */
#include "sensitivity_internal.h"
#include "steady_step.h"

#include <string.h>

/* All four circuits at a time: each is used twice. */
struct beside {
    struct dalcs_session circuit[N_ORBITS];
    double longer; /* s, of the period, by h */
};

static enum dalcs_status build_all(struct dalcs_sensitivities *s, const struct dalcs_sweep *item,
                                   double by, struct beside *b, bool *same) {
    *same = true;
    for (int k = PLUS; k < N_ORBITS && *same; k++) {
        struct dalcs_override override;
        (void)dalcs_override_of(item, item->start + dalcs_sensitivity_place(k) * by, &override);
        const enum dalcs_status status = dalcs_sensitivity_build(s, &override, 1, &b->circuit[k]);
        DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
        *same = status == DALCS_OK;
    }
    return DALCS_OK;
}

static enum dalcs_status find_images(struct dalcs_sensitivities *s, struct beside *b, bool *same) {
    for (int k = PLUS; k < N_ORBITS && *same; k++) {
        struct dalcs_steady_near near = {.asked = DALCS_NEAR_IMAGE,
                                         .point = s->st->at,
                                         .period = s->st->period,
                                         .image = s->image[k]};
        DALCS_TRY(dalcs_sensitivity_run(s, &b->circuit[k], &near, same));
    }
    return DALCS_OK;
}

/* h x' into s->step, small as the steps of Newton's method have to be. A quantity that each period leaves as it is stays what it is; where it grows with the value there is
 * no orbit beside this one. */
static enum dalcs_status find_tangent(struct dalcs_sensitivities *s, struct beside *b, bool *same) {
    struct dalcs_steady *st = s->st;
    const double *const *image = (const double *const *)s->image;
    for (int x = 0; x < st->layout.n_x; x++) {
        const double moved = (8.0 * (image[PLUS][x] - image[MINUS][x]) -
                              (image[PLUS_TWO][x] - image[MINUS_TWO][x])) /
                             12.0;
        st->then.x[x] = st->at.x[x] + moved;
    }
    const enum dalcs_status status = dalcs_steady_next_step(st);
    DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    *same = status == DALCS_OK && !st->kept.is_stuck;
    memcpy(s->step, st->step, (size_t)st->layout.n_x * sizeof(double));
    b->longer = st->own.longer;
    return DALCS_OK;
}

static enum dalcs_status measure_all(struct dalcs_sensitivities *s, struct beside *b, bool *same) {
    const struct dalcs_steady *st = s->st;
    for (int k = PLUS; k < N_ORBITS && *same; k++) {
        const double d = dalcs_sensitivity_place(k);
        dalcs_steady_copy_point(st, &s->beside, &st->at);
        for (int x = 0; x < st->layout.n_x; x++) {
            s->beside.x[x] += d * s->step[x];
        }
        struct dalcs_steady_near near = {
            .asked = DALCS_NEAR_MEASURE, .point = s->beside, .period = st->period + d * b->longer};
        DALCS_TRY(dalcs_sensitivity_run(s, &b->circuit[k], &near, same));
        dalcs_sensitivity_take(s, &b->circuit[k], k, same);
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_sensitivity_along_tangent(struct dalcs_sensitivities *s,
                                                  const struct dalcs_sweep *item, double by,
                                                  bool *same) {
    struct beside b = {0};
    enum dalcs_status status = build_all(s, item, by, &b, same);
    status = status == DALCS_OK && *same ? find_images(s, &b, same) : status;
    status = status == DALCS_OK && *same ? find_tangent(s, &b, same) : status;
    status = status == DALCS_OK && *same ? measure_all(s, &b, same) : status;
    for (int k = PLUS; k < N_ORBITS; k++) {
        dalcs_session_finish_other(&b.circuit[k]);
    }
    return status;
}

/* segments_observer.c - what is told, and is not needed. */
#include "segments_observer.h"

static void start(void *user, int k, const double *x) {
    (void)user;
    (void)k;
    (void)x;
}

static void scale(void *user, int k, const struct dalcs_certificate *certificate) {
    (void)user;
    (void)k;
    (void)certificate;
}

static void step(void *user, int k, const double *x, const double *y, const double *inputs,
                 double h) {
    (void)user;
    (void)k;
    (void)x;
    (void)y;
    (void)inputs;
    (void)h;
}

static void jump(void *user, const struct dalcs_euler_jump *of) {
    (void)user;
    (void)of;
}

static void move(void *user, int k, const double *x, const double *after) {
    (void)user;
    (void)k;
    (void)x;
    (void)after;
}

static void try_by_euler(void *user, int k) {
    (void)user;
    (void)k;
}

static void step_by_euler(void *user, int k, const double *x, const double *y,
                          const struct dalcs_observed_sides *sides, const double *inputs) {
    (void)user;
    (void)k;
    (void)x;
    (void)y;
    (void)sides;
    (void)inputs;
}

struct dalcs_observer dalcs_segments_observer(void *user, dalcs_segment_seen *segment) {
    return (struct dalcs_observer){.user = user,
                                   .start = start,
                                   .scale = scale,
                                   .step = step,
                                   .jump = jump,
                                   .move = move,
                                   .segment = segment,
                                   .try_by_euler = try_by_euler,
                                   .step_by_euler = step_by_euler};
}

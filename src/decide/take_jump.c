/* take_jump.c - a jump that is known becomes the state of its part, and is told. */
#include "take_jump.h"

#include "micro_steps.h"
#include "present.h"
#include "recurrence.h"
#include "restart.h"
#include "rounding.h"
#include "step_error.h"
#include "step_length.h"

#include <math.h>
#include <string.h>

bool dalcs_jump_is_told(const struct dalcs_radau *r, const struct dalcs_radau_part *part, int x) {
    const struct dalcs_euler *e = r->base;
    return e->jump.is_known || (e->jump.is_first && !e->jumps.is_driven[part->index][x]);
}

bool dalcs_jump_is_noticeable(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    const double *after = r->base->jump.after;
    double smallest = dalcs_micro_noticeable(part);
    bool noticeable = false;
    for (int x = 0; x < s->n_x && !noticeable; x++) {
        double scale = fmax(part->scales.unit[s->column_is_current[x]],
                            fmax(fabs(part->x[x]), fabs(after[x])));
        noticeable =
            dalcs_jump_is_told(r, part, x) && fabs(after[x] - part->x[x]) > smallest * scale;
    }
    return noticeable;
}

enum dalcs_status dalcs_find_jump(struct dalcs_radau *r, struct dalcs_radau_part *part, double h) {
    const struct dalcs_system *s = part->component->system;
    dalcs_micro_impulses(r, part, h);
    memcpy(part->work.u, part->x, (size_t)s->n_x * sizeof(double));
    dalcs_excitation_inputs(&part->excitation, part->segment.t, 0.0, part->work.u + s->n_x);
    return dalcs_euler_find_jump(r->base, part->index, part->work.u);
}

/* The change of each state that is not worth a word: what is left of it where it falls to 0, over its own scale, or
 * rounding. */
static void find_noise(const struct dalcs_radau_part *part, const double *after, double *noise) {
    const struct dalcs_system *s = part->component->system;
    double largest[2];
    dalcs_micro_largest(part, largest);
    dalcs_micro_raise_to_drives(part, largest);
    for (int x = 0; x < s->n_x; x++) {
        double own = fmax(dalcs_step_scale(part, x, part->scales.unit),
                          fmax(fabs(part->x[x]), fabs(after[x])));
        noise[x] = fmax(dalcs_answer_rounded * own,
                        dalcs_micro_rounding(part, s->column_is_current[x], largest));
    }
}

/* All columns at the end of the segment that ended at part->segment.t, into part->work.y2. */
static const double *columns_before(struct dalcs_radau_part *part) {
    dalcs_recurrence_complete_before(part);
    dalcs_radau_swap_out(part, &part->segment.out_before);
    dalcs_step_values(part, part->segment.end_before, part->work.y2);
    dalcs_radau_swap_out(part, &part->segment.out_before);
    return part->work.y2;
}

/* Has a coil a current in this component that is no state of it? Its coils are coupled perfectly. */
static bool has_tied_coils(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    const struct dalcs_network *n = r->base->network;
    bool has = false;
    for (int i = 0; i < n->n_states && !has; i++) {
        has = n->state[i].probe.system == part->index &&
              !dalcs_probe_is_known(&n->state[i].probe, part->component->system->n_x);
    }
    return has;
}

/* One far shorter than h in the place of that of length h, if there is one. */
static enum dalcs_status look_closer(struct dalcs_radau *r, struct dalcs_radau_part *part, double h,
                                     double *near) {
    const double closer = fmax(ldexp(h, -DALCS_FAR_SHORTER), dalcs_length_shortest(r));
    enum dalcs_status status =
        dalcs_radau_implicit_step(r, part, closer, closer, r->base->jump.after, part->work.y2);
    if (status == DALCS_OK) {
        memcpy(near, part->work.y2,
               (size_t)dalcs_system_n_columns(part->component->system) * sizeof(double));
    }
    return status < DALCS_OK ? status : DALCS_OK;
}

/* Implicit Euler on a decay goes by powers of 1 / (1 + h / tau): a cubic through four of them misses what is before the first
 * by the fourth power of h / tau. */
static const double back[] = {4.0, -6.0, 4.0, -1.0};

/* The columns after a micro-step of length h from the states behind a jump, into near; and on a cubic through that and three
 * more back to the instant. Where the mode does not go on through them these are the same. */
static enum dalcs_status look_back(struct dalcs_radau *r, struct dalcs_radau_part *part, double h,
                                   double *near, double *behind) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    const int n = dalcs_system_n_columns(p->system);
    double *next = part->work.y2;
    enum dalcs_status status = dalcs_radau_implicit_step(r, part, h, h, r->base->jump.after, near);
    if (status > DALCS_OK) {
        memcpy(near, next, (size_t)n * sizeof(double));
    }
    for (int c = 0; c < n && status >= DALCS_OK; c++) {
        behind[c] = back[0] * near[c];
    }
    bool goes_on = status == DALCS_OK;
    for (int k = 1; k < 4 && goes_on; k++) {
        status = dalcs_radau_implicit_step(r, part, h, (k + 1) * h, k == 1 ? near : next, next);
        goes_on = status == DALCS_OK && dalcs_mode_is(p->mode, part->work.mode_before, p->n_words);
        for (int c = 0; c < n && goes_on; c++) {
            behind[c] += back[k] * next[c];
        }
    }
    for (int c = 0; c < n && status >= DALCS_OK && !goes_on; c++) {
        behind[c] = near[c];
    }
    return status < DALCS_OK ? status : DALCS_OK;
}

/* The columns just behind a jump. What does not survive on the way back has not jumped, nor has what a far shorter step sees
 * no half of: a diode may open within h, and leave a current to its leak. The steps that found the jump do not serve: the
 * first of them has the impulses, and beside these a sign that is wrong may be rounding. part->work.y2, the second of those,
 * becomes what is before. NULL where nobody asks for them: at the start, and where all that is told is a state. */
static enum dalcs_status columns_behind(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                        double h, const double **before, double *behind) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    const size_t bytes = (size_t)p->n_words * sizeof(uint64_t);
    const bool slides = part->guards.slides;
    double *near = part->work.y1;
    *before = NULL;
    if (!(part->segment.t > 0.0) || !has_tied_coils(r, part)) {
        return DALCS_OK;
    }
    memcpy(part->work.mode_before, p->mode, bytes);
    DALCS_TRY(look_back(r, part, h, near, behind));
    memcpy(p->mode, part->work.mode_before, bytes);
    DALCS_TRY(look_closer(r, part, h, near));
    memcpy(p->mode, part->work.mode_before, bytes);
    part->guards.slides = slides;
    *before = columns_before(part);
    for (int c = 0; c < dalcs_system_n_columns(p->system); c++) {
        const double from = part->work.y2[c];
        const double jump = behind[c] - from;
        const double seen = near[c] - from;
        behind[c] =
            fabs(jump) > 0.5 * fabs(seen) && fabs(jump - seen) < fabs(seen) ? behind[c] : from;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_take_jump(struct dalcs_radau *r, struct dalcs_radau_part *part, double h) {
    struct dalcs_euler *e = r->base;
    const double *before;
    double *behind = part->component->scratch;
    e->t = part->segment.t;
    find_noise(part, e->jump.after, e->telling.noise);
    DALCS_TRY(columns_behind(r, part, h, &before, behind));
    DALCS_TRY(dalcs_euler_report_jump(e, part->index, part->segment.t, part->x, before, behind));
    memcpy(part->x, e->jump.after, (size_t)part->component->system->n_x * sizeof(double));
    part->segment.jumped = true;
    return DALCS_OK;
}

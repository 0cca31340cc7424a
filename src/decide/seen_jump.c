/* seen_jump.c - a jump that no problem without time tells: what sources that read act on. */
#include "seen_jump.h"

#include "magnitudes.h"
#include "micro_steps.h"
#include "present.h"
#include "projection.h"
#include "restart.h"
#include "step_error.h"
#include "step_length.h"
#include "take_jump.h"

#include <math.h>
#include <string.h>

/* part->work.after becomes the limit of what micro-steps of length h and h/2 see, `whole` of the former. Returns what may be
 * left of it, over what is allowed, where 1 is the tolerance of its scale. It is of second order, the square of what they
 * differ by over the jump; a small change that is no jump differs by half of itself. Behind pairs that end in two modes
 * there is no order: behind a gain rounding may hold a diode at its knee for the shorter ones. Nor is there where they differ
 * by more than *apart, what longer ones did, over what is allowed: that is rounding. */
static double extrapolate_lengths(const struct dalcs_radau_part *part, const double *whole,
                                  double *apart) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    const bool is_smooth = dalcs_mode_is(p->mode, part->work.mode_longer, p->n_words);
    double *after = part->work.after;
    double first_order = 0.0;
    double second_order = 0.0;
    for (int x = 0; x < part->component->system->n_x; x++) {
        double most = part->inner_tolerance * fmax(dalcs_step_scale(part, x, part->scales.unit),
                                                   fmax(fabs(part->x[x]), fabs(after[x])));
        double differ = after[x] - whole[x];
        after[x] += differ;
        double order = fabs(differ) / fmax(fabs(after[x] - part->x[x]), most);
        if (differ != 0.0) {
            first_order = fmax(first_order, fabs(differ) / most);
            second_order = fmax(second_order, fabs(differ) / most * order);
        }
    }
    const bool has_order = is_smooth && first_order <= *apart;
    *apart = first_order;
    return has_order ? second_order : first_order;
}

/* Of micro-steps of length h and h/2, with the sources as they are just behind the instant; where what acts has jumped
 * before, with sources that go on: what reads may read the current that they move through a capacitor. */
static enum dalcs_status see_jump(struct dalcs_radau *r, struct dalcs_radau_part *part, double h,
                                  bool *is_seen, double *apart, double *left) {
    double *whole = r->base->after;
    double goes_on = r->base->jump.is_first ? 1.0 : 0.0;
    bool noticeable;
    double closer;
    DALCS_TRY(dalcs_micro_pair(r, part, h, goes_on * h));
    (void)dalcs_micro_extrapolate(part, whole, &noticeable, &closer);
    memcpy(part->work.mode_longer, part->component->osnsp.mode,
           (size_t)part->component->osnsp.n_words * sizeof(uint64_t));
    h *= 0.5;
    DALCS_TRY(dalcs_micro_pair(r, part, h, goes_on * h));
    *is_seen = dalcs_micro_extrapolate(part, part->work.after, &noticeable, &closer);
    *left = extrapolate_lengths(part, whole, apart);
    return DALCS_OK;
}

/* The same from ever shorter ones, until they tell the jump; or else of the length *h that tells it best: what they see is
 * off by what moves meanwhile, and the shorter they are by what rounding of currents makes of coils, L eps i / h. */
static enum dalcs_status find_limit(struct dalcs_radau *r, struct dalcs_radau_part *part, double *h,
                                    bool *is_seen, bool *is_near) {
    double left = INFINITY;
    double least = INFINITY;
    double length = *h;
    double apart = INFINITY;
    enum dalcs_status status = see_jump(r, part, length, is_seen, &apart, &left);
    const enum dalcs_status first = status;
    while (status == DALCS_OK && left > 1.0 &&
           ldexp(length, -DALCS_FAR_SHORTER) >= dalcs_length_shortest(r)) {
        *h = left < least ? length : *h;
        least = fmin(left, least);
        length = ldexp(length, -DALCS_FAR_SHORTER);
        status = see_jump(r, part, length, is_seen, &apart, &left);
    }
    if (status == DALCS_OK && left < least) {
        *h = length;
    } else if (status >= DALCS_OK && first == DALCS_OK && *h != length) {
        status = see_jump(r, part, *h, is_seen, &apart, &left);
        left = least;
    }
    *is_near = status == DALCS_OK && left <= 1.0;
    return status;
}

/* Puts states that nothing which reads acts on where they jump to, as far as that is known. */
static void move_first(const struct dalcs_radau *r, struct dalcs_radau_part *part) {
    for (int x = 0; r->base->jump.is_first && x < part->component->system->n_x; x++) {
        part->x[x] = dalcs_jump_is_told(r, part, x) ? r->base->jump.after[x] : part->x[x];
    }
}

/* The limit where sources that read act on states. What jumps without them drives impulses, which they may read: what
 * they act on jumps by the area where it adds it up. Where it keeps the peak there is no limit; and where what moves is
 * an event's error, its impulse is none. Then the others are where they jump to before, and what is read is finite. */
static enum dalcs_status find_read_limit(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                         double *h, bool *is_seen, bool *is_near) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    const size_t bytes = (size_t)p->n_words * sizeof(uint64_t);
    if (r->base->jump.is_first && dalcs_jump_is_noticeable(r, part)) {
        const double longest = *h;
        memcpy(part->work.mode_before, p->mode, bytes);
        enum dalcs_status status = find_limit(r, part, h, is_seen, is_near);
        if (status < DALCS_OK || (status == DALCS_OK && *is_near)) {
            return status;
        }
        *h = longest;
        memcpy(p->mode, part->work.mode_before, bytes);
    }
    move_first(r, part);
    return find_limit(r, part, h, is_seen, is_near);
}

/* In the mode of the jump, that of the first micro-step, states are where the nodes of an accurate step begin. Micro-steps
 * know the voltage of coils that end in a star within L eps i / h: too far off for what follows it. States that agree with
 * them on two digits are put there. Where micro-steps do not tell the jump and the nodes see none, there is none. */
static enum dalcs_status place_on_nodes(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                        bool is_near) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    double *after = r->base->jump.after;
    const size_t bytes = (size_t)p->n_words * sizeof(*p->mode);
    enum dalcs_projection told;
    memcpy(part->work.mode_before, p->mode, bytes);
    memcpy(p->mode, part->work.mode_first, bytes);
    move_first(r, part);
    const struct dalcs_observer *observer = r->base->listener.observer;
    r->base->listener.observer = NULL; /* the whole jump is told, and nothing of this try */
    enum dalcs_status status = dalcs_projection_try(r, part, dalcs_radau_limit(r, part),
                                                    r->options.fixed_step > 0.0, true, &told);
    r->base->listener.observer = observer;
    const bool sees = status == DALCS_OK && told != DALCS_PROJECTION_BLIND;
    for (int x = 0; sees && x < p->system->n_x; x++) {
        double from = part->work.before[x];
        double scale = fmax(part->scales.unit[p->system->column_is_current[x]],
                            fmax(fabs(part->x[x]), fabs(from)));
        bool agrees = fabs(part->x[x] - after[x]) <= dalcs_slight * fabs(after[x] - from);
        bool stays = !is_near && fabs(part->x[x] - from) <= dalcs_micro_noticeable(part) * scale;
        after[x] = (agrees || stays) && !dalcs_jump_is_told(r, part, x) ? part->x[x] : after[x];
    }
    memcpy(p->mode, part->work.mode_before, bytes);
    return status < DALCS_OK ? status : DALCS_OK;
}

/* A jump that no problem without time tells is the limit of vanishing micro-steps (Heemels, Schumacher and Weiland 1999,
 * thm 4.1), with the sources as they are just behind it: where they fall at once, the state would follow them for a
 * while only. */
enum dalcs_status dalcs_take_seen_jump(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       double h) {
    const size_t bytes = (size_t)part->component->system->n_x * sizeof(double);
    bool is_seen;
    bool is_near;
    double last = h;
    memcpy(part->work.before, part->x, bytes);
    enum dalcs_status status = find_read_limit(r, part, &last, &is_seen, &is_near);
    memcpy(part->x, part->work.before, bytes);
    if (status == DALCS_OK && !is_seen && !r->base->jump.is_first) { /* it was a fast transient */
        return dalcs_micro_steps(r, part, last);
    }
    if (status == DALCS_OK) {
        DALCS_TRY(dalcs_find_jump(r, part, 0.5 * last));
        const bool asks_nodes = r->base->jump.is_first || !is_near;
        DALCS_TRY(asks_nodes ? place_on_nodes(r, part, is_near) : DALCS_OK);
        memcpy(part->x, part->work.before, bytes);
    }
    DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    move_first(r, part);
    status = dalcs_micro_steps(r, part, h); /* for the mode */
    memcpy(part->x, part->work.before, bytes);
    DALCS_TRY(status);
    return dalcs_take_jump(r, part, h);
}

/* restart.c - micro-steps of implicit Euler where a mode is not known or a state may jump.
 *
 * A first micro-step takes a state that the mode does not allow to one that it does (a jump, or the
 * interpolation error of an event); from there a second one sees how the circuit goes on. The jump is
 * the limit of vanishing steps, which for passive circuits is the projection in the energy norm
 * (Heemels, Schumacher and Weiland 1999; Brogliato 2022, sec. 4). */
#include "restart.h"

#include "magnitudes.h"
#include "micro_steps.h"
#include "present.h"
#include "rounding.h"
#include "seen_jump.h"
#include "step_length.h"
#include "take_jump.h"

#include <math.h>
#include <string.h>

/* Where a component is not passive, a state may jump although another one runs away, the farther the shorter the
 * micro-step: the derivative of an impulse. The rounding of an impulse over h runs away, too: of a capacitor in series with
 * an open switch the voltage is the difference of two that hold the same impulse. */
static enum dalcs_status check_limit(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     double h) {
    const struct dalcs_system *s = part->component->system;
    double *longer = r->base->after;
    double largest[2];
    double impulsive[2];
    bool jumps = false;
    bool runs_away = false;
    memcpy(longer, part->work.y1, (size_t)s->n_x * sizeof(double));
    DALCS_TRY(dalcs_micro_steps(r, part, ldexp(h, -DALCS_FAR_SHORTER)));
    dalcs_micro_largest(part, largest);
    dalcs_micro_raise(s, longer, s->n_x, largest);
    memcpy(impulsive, largest, sizeof(impulsive));
    dalcs_micro_raise(s, part->work.y1, dalcs_system_n_equations(s), impulsive);
    for (int x = 0; x < s->n_x; x++) {
        double before = fabs(longer[x] - part->x[x]);
        double now = fabs(part->work.y1[x] - part->x[x]);
        bool stays = fabs(part->work.y1[x] - longer[x]) < 0.5 * now;
        bool moves = now > dalcs_alike * largest[s->column_is_current[x]];
        jumps = jumps || (moves && stays);
        bool is_rounding = now <= dalcs_answer_rounded * impulsive[s->column_is_current[x]];
        runs_away = runs_away || (moves && !is_rounding && now > dalcs_beyond * before);
    }
    if (jumps && runs_away) {
        dalcs_osnsp_blame_states(&part->component->osnsp, part->x, longer, part->work.y1);
        memcpy(part->work.u, part->x, (size_t)s->n_x * sizeof(double));
        dalcs_excitation_inputs(&part->excitation, part->segment.t, 0.0, part->work.u + s->n_x);
        return dalcs_micro_fail(r, part, 1.0 / h, part->work.u, DALCS_INFEASIBLE);
    }
    return dalcs_micro_steps(r, part, h);
}

/* Are both micro-steps in one mode, and does it allow every state? Then none jumps, for a jump is the projection onto
 * what the mode allows (Heemels, Schumacher and Weiland 1999, sec. 4): what moves is faster than the micro-steps are. */
static enum dalcs_status find_freedom(struct dalcs_radau_part *part, bool *is_free) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    struct dalcs_stage_entry *entry;
    *is_free = false;
    if (!dalcs_stages_have_maps(&part->stages) ||
        !dalcs_mode_is(p->mode, part->work.mode_first, p->n_words)) {
        return DALCS_OK;
    }
    enum dalcs_status status = dalcs_stages_get(
        &part->stages, p->mode, dalcs_radau_ladder(part, part->length.level), &entry);
    *is_free = status == DALCS_OK && dalcs_stage_frees_states(entry);
    return status < DALCS_OK ? status : DALCS_OK;
}

/* The micro-steps of length h have seen the state move: part->x becomes the state after the jump,
 * exactly where that is known, and the jump is reported. What else they have seen is a transient
 * faster than they are: they get shorter, until they tell the mode before it, or, where time cannot be
 * told apart any more, it is over. *moves_little: they see it move on, by no more than an event's error. */
static enum dalcs_status settle_jump(struct dalcs_radau *r, struct dalcs_radau_part *part, double h,
                                     bool *moves_little) {
    const struct dalcs_euler *e = r->base;
    const struct dalcs_system *s = part->component->system;
    bool noticeable = true;
    bool moves = true;
    double closer;
    bool is_free;
    DALCS_TRY(find_freedom(part, &is_free));
    if (is_free) {
        *moves_little = false;
        return DALCS_OK;
    }
    if (!dalcs_osnsp_is_monotone(&part->component->osnsp)) {
        DALCS_TRY(check_limit(r, part, h));
    }
    while (moves && noticeable) {
        DALCS_TRY(dalcs_find_jump(r, part, h));
        if (!e->jump.is_covered) {
            return dalcs_take_seen_jump(r, part, h);
        }
        bool is_last = ldexp(h, -DALCS_FAR_SHORTER) < dalcs_length_shortest(r);
        bool is_whole = e->jump.is_known ? dalcs_jumps_agree(s, part->x, part->work.after,
                                                             part->work.y1, e->jump.after)
                                         : is_last;
        if (is_whole || (e->jump.is_known && dalcs_jump_is_noticeable(r, part))) {
            DALCS_TRY(dalcs_take_jump(r, part, h));
        }
        if (is_whole) {
            return DALCS_OK;
        }
        if (is_last) {
            break;
        }
        enum dalcs_status status = dalcs_micro_steps(r, part, ldexp(h, -DALCS_FAR_SHORTER));
        if (status > DALCS_OK) { /* too short for a certificate: the last ones have to do */
            DALCS_TRY(dalcs_micro_steps(r, part, h));
            moves = dalcs_micro_extrapolate(part, part->work.after, &noticeable, &closer);
            break;
        }
        DALCS_TRY(status);
        h = ldexp(h, -DALCS_FAR_SHORTER);
        moves = dalcs_micro_extrapolate(part, part->work.after, &noticeable, &closer);
    }
    *moves_little = moves;
    return DALCS_OK;
}

/* After micro-steps of length *h in which a transient as fast as they are may have hidden a jump, or the
 * mode that it is in: shorter ones, or, where these have no certificate, the same again. */
static enum dalcs_status look_closer(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     double closer, double *h, bool *jumps, bool *noticeable) {
    enum dalcs_status status = dalcs_micro_steps(r, part, closer * *h);
    if (status == DALCS_OK) {
        *h *= closer;
    } else if (status > DALCS_OK) {
        status = dalcs_micro_steps(r, part, *h);
    }
    DALCS_TRY(status);
    *jumps = dalcs_micro_extrapolate(part, part->work.after, noticeable, &closer);
    return DALCS_OK;
}

enum dalcs_status dalcs_radau_restart(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                      int longer, bool mode_only, bool *is_off) {
    const struct dalcs_system *s = part->component->system;
    enum dalcs_status status = DALCS_NOT_CONVERGED;
    if (is_off != NULL) {
        *is_off = false;
    }
    double h = 0.0;
    bool leaps = part->guards.leaps && part->component->positions.n > 0;
    part->guards.slides = part->guards.leaps = false;
    if (leaps) {
        memcpy(part->work.mode_before, part->component->osnsp.mode,
               (size_t)part->component->osnsp.n_words * sizeof(uint64_t));
    }
    for (int k = 0; k < DALCS_LONGER_TRIES && status > DALCS_OK; k++) {
        h = dalcs_radau_micro_length(r, part, longer + k);
        status = dalcs_micro_steps(r, part, h);
    }
    DALCS_TRY(status);
    if (s->n_x == 0 || mode_only || part->guards.slides) {
        return DALCS_OK; /* between two sides of a switch nothing that moves is a jump */
    }
    bool noticeable;
    double closer;
    bool jumps = dalcs_micro_extrapolate(part, part->work.after, &noticeable, &closer);
    if (closer < 1.0 && !noticeable && closer * h >= dalcs_length_shortest(r)) {
        DALCS_TRY(look_closer(r, part, closer, &h, &jumps, &noticeable));
    }
    if (leaps && noticeable) {
        DALCS_TRY(dalcs_micro_leap(r, part, h, part->work.mode_before));
        jumps = dalcs_micro_extrapolate(part, part->work.after, &noticeable, &closer);
    }
    bool moves_little = jumps && !noticeable;
    if (noticeable) {
        DALCS_TRY(settle_jump(r, part, h, &moves_little));
    }
    if (is_off != NULL && (part->segment.rounding == 1.0 || s->n_pairs <= DALCS_MANY_PAIRS)) {
        *is_off = moves_little;
    } else if (moves_little) {
        dalcs_radau_go_after(r, part);
    }
    return DALCS_OK;
}

/* search.c - the answers to a step that is not accurate. */
#include "search_internal.h"

#include "blocks.h"
#include "doubt.h"
#include "magnitudes.h"
#include "micro_steps.h"
#include "power_of_step.h"
#include "present.h"
#include "projection.h"
#include "restart.h"
#include "step_length.h"

#include <math.h>

enum {
    STUCK = 3,         /* smaller steps without a smaller error */
    LEVERED_STUCK = 2, /* of levered voltages alone */
    MOST_REFINED = 4,
    FALL_BACK_LEAST = 5,
    FALL_BACK = 14, /* steps of implicit Euler start this many rungs below */
    RIPPLE = 12     /* and are this many below the longest one where a switch goes to and fro */
};

enum dalcs_status dalcs_search_project(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       struct dalcs_search *search, bool *moved) {
    enum dalcs_projection told;
    search->projected = true;
    enum dalcs_status status =
        dalcs_projection_try(r, part, search->limit, search->fixed, false, &told);
    *moved = told == DALCS_PROJECTION_MOVED;
    search->jumps = told == DALCS_PROJECTION_JUMPS;
    return status;
}

void dalcs_search_start_over(struct dalcs_radau_part *part, struct dalcs_search *search,
                             int level) {
    if (!search->fixed) {
        part->length.level = level;
    }
    search->errors.stuck = 0;
    search->errors.spared = false;
    search->errors.before = INFINITY;
}

enum dalcs_status dalcs_search_go_on_from_answer(struct dalcs_radau *r,
                                                 struct dalcs_radau_part *part,
                                                 struct dalcs_search *search, bool is_off) {
    search->projected = false;
    if (is_off) {
        /* Micro-steps may see a transient that is as fast as they are; a projecting step is far
         * shorter. */
        bool moved;
        DALCS_TRY(dalcs_search_project(r, part, search, &moved));
    }
    dalcs_search_start_over(part, search, search->asked_level);
    return DALCS_OK;
}

enum dalcs_status dalcs_search_ask(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                   struct dalcs_search *search, bool mode_only) {
    bool is_off;
    DALCS_TRY(dalcs_radau_restart(r, part, search->restarts++, mode_only, &is_off));
    return dalcs_search_go_on_from_answer(r, part, search, is_off);
}

/* s: a step between two sides of a switch, with ripple in proportion. */
static double ripple_length(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    double fixed = r->options.fixed_step;
    return ldexp(fixed > 0.0 ? fixed : part->length.longest, -RIPPLE);
}

enum dalcs_status dalcs_search_fall_back(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                         double limit, int level, double most) {
    double fixed = r->options.fixed_step;
    double whole = fixed > 0.0 ? fixed : dalcs_radau_ladder(part, level);
    part->length.level = level;
    double h = ldexp(whole, part->length.tries - FALL_BACK);
    h = fmin(h, fmin(most, ldexp(whole, -FALL_BACK_LEAST)));
    h = fmax(h, dalcs_length_shortest(r));
    if (part->length.tries > 0 && fixed == 0.0) { /* however short the ladder's step has become */
        h = fmax(h, fmin(2.0 * part->length.fell_back, ldexp(part->length.longest, -FALL_BACK)));
    }
    if (part->guards.slides) {
        h = fmin(h, ripple_length(r, part));
    }
    part->length.tries++;
    most = fmin(most, limit - part->segment.t);
    part->length.fell_back = fmin(h, most);
    enum dalcs_status status = dalcs_radau_euler_step(r, part, part->length.fell_back);
    /* So short a step may have no certificate, as its states are rounded, and a longer one has. Of smooth functions it is that
     * nothing leads on. */
    for (int k = 1; k <= DALCS_LONGER_TRIES && status == DALCS_NOT_CONVERGED &&
                    part->smooth == NULL && part->length.fell_back < most;
         k++) {
        part->length.fell_back = fmin(ldexp(h, 5 * k), most);
        status = dalcs_radau_euler_step(r, part, part->length.fell_back);
    }
    /* An ordinary step that is no longer than that would not end these: rounding over so short a length may be all that is wrong. */
    while (fixed == 0.0 &&
           dalcs_radau_ladder(part, part->length.level) <= 4.0 * part->length.fell_back) {
        part->length.level--;
    }
    return status;
}

/* Of errors over what is allowed: may interpolation leave so much? More is a jump. */
static bool may_be_left(double ratio) {
    return dalcs_small * ratio < 1.0;
}

/* Where dalcs_search_project() cannot decide. */
static bool settle(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                   struct dalcs_search *search, const double *unit) {
    const bool is_last = search->settling == DALCS_SETTLES_WITHIN_UNIT;
    if (!dalcs_projection_settle(r, part, unit, is_last)) {
        search->settling = is_last ? DALCS_SETTLES_WITHIN_UNIT : DALCS_SETTLES_LATER;
        return false;
    }
    search->settling = DALCS_SETTLED;
    dalcs_search_start_over(part, search, search->errors.level);
    return true;
}

/* Of the first step of a mode, with an error so many times what is allowed: may it be that the state has to
 * jump, or only that the step is too long? A shorter one is tried first: it may show a transient that a
 * micro-step passes over, with the events in it, and costs less. Where the mode constrains no state none jumps, nor
 * where only slopes of sources do: a state that the mode allowed just before it allows. */
static bool is_worth_asking(const struct dalcs_radau_part *part, const struct dalcs_search *search,
                            double ratio) {
    bool has_free_states =
        part->segment.rounding == 1.0 && search->states_free && part->component->system->n_x > 0;
    bool stays = has_free_states || (part->guards.bends && search->flips == 0);
    bool may_jump = stays ? isinf(ratio) : !may_be_left(ratio);
    return search->fixed || search->errors.stuck > 0 || may_jump;
}

/* So short that a shorter one is not tried, unless that has just held. */
static bool is_shortest(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    bool has_grown = !part->guards.fresh && part->length.held_level > part->length.level;
    return dalcs_radau_ladder(part, part->length.level) < dalcs_length_shortest(r) && !has_grown;
}

/* Will steps do that are half or a quarter as long, though it is that short? They are no less exact for it: the last digit of the
 * time at which one begins moves only sources. */
static bool is_nearly_right(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                            const struct dalcs_step_quality *quality) {
    return may_be_left(quality->own) &&
           dalcs_radau_ladder(part, part->length.level) >= 8.0 * r->resolution;
}

/* Are states where they should be, and only voltages off that errors of theirs are levered up to, of a coil that is cut off?
 * Maps know where that is. Then nothing is wrong with mode and state. */
static bool is_levered(const struct dalcs_radau_part *part,
                       const struct dalcs_step_quality *quality) {
    return part->segment.rounding > 1.0 && quality->own <= 1.0;
}

/* An error that shrinks no faster than the step, be it halved or shorter, is what the state is off by, or what dies away at
 * once: errors of a method go with a higher power of the step. A smaller one would not mend it. */
static void count_stuck(const struct dalcs_radau_part *part, struct dalcs_search *search,
                        const struct dalcs_step_quality *quality) {
    bool is_stuck = dalcs_power_of_step(search->errors.before, quality->ratio) <= 1.0;
    search->errors.stuck = is_stuck ? search->errors.stuck + 1 : 0;
    search->errors.before = quality->ratio;
    if (search->errors.stuck == 0) {
        search->errors.level = part->length.level;
    }
}

/* No shorter step is tried. */
static bool is_hopeless(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                        const struct dalcs_search *search,
                        const struct dalcs_step_quality *quality) {
    bool wrong_flip = search->flips > 0 && !may_be_left(quality->own);
    return search->fixed || wrong_flip ||
           (is_shortest(r, part) && !is_nearly_right(r, part, quality));
}

/* What may be wrong but for the length of the step: a guess, or the state. *answered: there is another try. */
static enum dalcs_status doubt_mode(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                    struct dalcs_search *search,
                                    const struct dalcs_step_quality *quality, bool *answered) {
    *answered = true;
    if (search->guessed) {
        return dalcs_search_refuse(part, search);
    }
    if (search->opened) {
        return dalcs_search_tie_again(part, search);
    }
    if (part->guards.fresh && search->restarts == 0 &&
        is_worth_asking(part, search, quality->own)) {
        bool is_judged = isfinite(quality->own);
        return dalcs_search_ask_from(r, part, search,
                                     is_judged ? dalcs_blocks_first_wrong(part, quality->unit) : 0);
    }
    bool asked = search->restarts > 0 || !part->guards.fresh;
    bool may_project = !search->fixed && !search->projected && !search->states_free && asked;
    *answered = false;
    if (!(may_be_left(quality->own) && may_project && dalcs_projection_sees(part, false))) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_search_project(r, part, search, answered));
    if (search->jumps) {
        *answered = true;
        return DALCS_OK;
    }
    if (*answered && search->errors.stuck > 0) { /* steps are short for what the state was off by */
        dalcs_search_start_over(part, search, search->errors.level);
    }
    return DALCS_OK;
}

/* Do shorter steps see the same in voltages that states are levered up to? Then errors of states alone count from now on. */
static bool spares_levered(const struct dalcs_radau_part *part, struct dalcs_search *search,
                           const struct dalcs_step_quality *quality) {
    if (search->errors.stuck < LEVERED_STUCK || !is_levered(part, quality)) {
        return false;
    }
    search->errors.spared = true; /* shorter steps see it as well */
    search->errors.stuck = 0;     /* another error is compared from now on */
    search->errors.before = INFINITY;
    return true;
}

/* Is the next step too short? In it time would stand still, or a transient passes that nobody tells from a jump: the slow part
 * is the limit of such ones (Tikhonov 1952; Kokotovic, Khalil and O'Reilly 1986, sec. 1.3). */
static bool shows_nothing(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                          const struct dalcs_search *search) {
    const double h = dalcs_radau_ladder(part, part->length.level);
    return part->segment.t + h <= part->segment.t ||
           (search->settling == DALCS_SETTLES_LATER && h < dalcs_length_shortest(r));
}

/* No shorter step mends the error, so it is no transient, which a short enough step follows: the state is off by it. Where
 * that is more than its own scale allows it may settle now. */
static enum dalcs_status give_up(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                 struct dalcs_search *search, bool *done) {
    if (search->settling == DALCS_SETTLES_LATER && !search->fixed) {
        search->settling = DALCS_SETTLES_WITHIN_UNIT;
        dalcs_search_start_over(part, search, search->errors.level);
        return DALCS_OK;
    }
    *done = true;
    /* What begins as a broken power of the time, as a root does, has no polynomial that is right to so much of itself, on
     * any length: the first step is to be nothing beside what follows, in steps that are shorter than the time since. */
    const double most =
        part->smooth != NULL ? ldexp(dalcs_length_shortest(r), DALCS_FAR_SHORTER) : INFINITY;
    return dalcs_search_fall_back(r, part, search->limit, search->first_level, most);
}

enum dalcs_status dalcs_search_recover(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       struct dalcs_search *search,
                                       const struct dalcs_step_quality *quality, bool *done) {
    if (!is_levered(part, quality)) {
        bool answered;
        DALCS_TRY(doubt_mode(r, part, search, quality, &answered));
        if (answered) {
            return DALCS_OK;
        }
    }
    r->rejected++;
    count_stuck(part, search, quality);
    if (spares_levered(part, search, quality)) {
        part->length.level = search->errors.level;
        return DALCS_OK;
    }
    bool may_be_off = search->errors.stuck >= STUCK && search->settling != DALCS_SETTLES_LATER &&
                      search->settling != DALCS_SETTLED && !search->states_free && !search->fixed;
    if (may_be_off && settle(r, part, search, quality->unit)) {
        return DALCS_OK;
    }
    if (is_hopeless(r, part, search, quality)) {
        return give_up(r, part, search, done);
    }
    dalcs_length_shorten(part, quality->ratio, search->errors.stuck);
    return shows_nothing(r, part, search) ? give_up(r, part, search, done) : DALCS_OK;
}

bool dalcs_search_may_refine(const struct dalcs_search *search) {
    return !search->fixed && search->refined < MOST_REFINED;
}

enum dalcs_status dalcs_search_refine(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                      struct dalcs_search *search) {
    search->refined++;
    r->rejected++;
    part->length.level++;
    return DALCS_OK;
}

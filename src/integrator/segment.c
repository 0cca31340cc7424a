/* segment.c - from a state and a guess of the mode to a segment that holds.
 *
 * A step is solved in the present mode. If it is accurate and nothing in it is negative from the start,
 * the mode is right: for a passive circuit the solution is unique where complementarity is strict, so a
 * guess that passes needs no other proof. If not, the circuit is asked: by micro-steps what the mode is
 * and whether the state jumps, by a projection whether the state is only off by what interpolation left
 * of it, by shorter steps whether the error was the step's. Where all fail, as where events accumulate
 * in finite time, implicit Euler goes on by itself for a while, certified and a little at a time. */
#include "segment.h"

#include "accept.h"
#include "extremes.h"
#include "first_level.h"
#include "front.h"
#include "guards.h"
#include "magnitudes.h"
#include "micro_steps.h"
#include "present.h"
#include "projection.h"
#include "recurrence.h"
#include "restart.h"
#include "slide.h"
#include "sliding.h"
#include "smooth_step.h"
#include "step_length.h"
#include "tied.h"
#include "transition.h"

#include <math.h>

enum { FLURRY = 4096, MOST_FRONTS_REFUSED = 16 };

/* Are all signals before nothing beside these? A coil's current may have no path in this mode. In a step that short it makes
 * signals so large that any error is small beside them. */
static bool is_outsized(const struct dalcs_radau_part *part,
                        const struct dalcs_step_quality *quality) {
    bool is = false;
    for (int unit = 0; unit < 2; unit++) {
        double before = part->scales.unit[unit];
        is = is || (before > 0.0 && dalcs_nothing * quality->here[unit] > before);
    }
    return is;
}

/* Something happened that is no crossing, a command or the start of the run, in a part on dense maps. */
static bool is_at_command(const struct dalcs_radau_part *part) {
    return part->guards.fresh && part->guards.n_crossed == 0 && part->segment.rounding == 1.0;
}

/* A command has moved a switch: what it carried goes elsewhere, through pairs that have not crossed anything. On
 * dense maps a one-step problem costs less than a step in a wrong mode. */
static bool is_commutation(const struct dalcs_radau_part *part) {
    return part->guards.flipped && is_at_command(part);
}

/* An argument has crossed, and its jump is between its sides. A step that holds there is no proof: where outputs act on arguments
 * there may be other answers, and which one it is depends on where they stood. */
static bool is_between_sides(const struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    bool is = false;
    for (int k = 0; k < part->guards.n_crossed && !is; k++) {
        const int pair = part->guards.crossed[k];
        for (int d = pair - 1; d <= pair && pair < p->system->n_pairs && !is; d++) {
            is = d >= 0 && p->system->pair[d].is_jump && dalcs_osnsp_is_on(p, d) &&
                 !dalcs_osnsp_is_on(p, d + 1);
        }
    }
    return is;
}

/* At the start of a run: are several jumps between their sides? At an operating point they may be where no delay leaves them. */
static bool starts_between_sides(const struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    int n = 0;
    for (int d = 0; d + 1 < p->system->n_pairs && !(part->segment.t > 0.0); d++) {
        n += p->system->pair[d].is_jump && dalcs_osnsp_is_on(p, d) && !dalcs_osnsp_is_on(p, d + 1)
                 ? 1
                 : 0;
    }
    return n > 1;
}

static double step_to_try(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                          double limit) {
    if (part->component->circuit->control.n_delayed >
        0) { /* nothing is known of their sources beyond */
        return dalcs_smaller(dalcs_radau_ladder(part, part->length.level), limit - part->segment.t);
    }
    return is_at_command(part) && limit < r->options.stop
               ? dalcs_length_fitted(part, limit)
               : dalcs_radau_ladder(part, part->length.level);
}

/* Where the step's polynomials end to count, in steps. */
static double end_of(const struct dalcs_radau_part *part, const struct dalcs_search *search) {
    return dalcs_smaller(1.0, (search->limit - part->segment.t) / part->segment.h);
}

/* The errors of the step from its start to `end`, in steps; INFINITY where it means nothing. trial->holds: they are no more
 * than allowed. */
static void judge(struct dalcs_radau *r, struct dalcs_radau_part *part,
                  const struct dalcs_search *search, double end, struct dalcs_trial *trial) {
    struct dalcs_step_quality *q = &trial->quality;
    dalcs_step_judge(r, part, trial->entry, end, q);
    if (part->smooth != NULL && q->ratio > 1.0) { /* is it what Newton's method has left? */
        if (dalcs_smooth_step_refine(part, &trial->entry) == DALCS_OK) {
            dalcs_step_judge(r, part, trial->entry, end, q);
        } else {
            q->ratio = q->own = INFINITY;
        }
    }
    q->ratio = search->errors.spared ? q->own : q->ratio;
    if (q->ratio != q->ratio || dalcs_step_clashes(part, trial->entry, end, q->unit)) {
        q->ratio = q->own = INFINITY;
    }
    bool is_first = part->guards.fresh && search->restarts == 0;
    bool controlled = !search->fixed || is_first;
    trial->holds = controlled ? q->ratio <= 1.0 : q->ratio < INFINITY;
}

/* One step in the present mode, with its errors. Where it does not hold, the next try is another one, or implicit Euler has
 * taken its place. */
static enum dalcs_status solve_accurately(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                          struct dalcs_search *search, struct dalcs_trial *trial) {
    struct dalcs_step_quality *q = &trial->quality;
    part->segment.h = search->fixed ? r->options.fixed_step : step_to_try(r, part, search->limit);
    enum dalcs_status status = dalcs_segment_solve(part, &trial->entry);
    if (status < DALCS_OK) {
        return status;
    }
    struct dalcs_stage_entry *entry = trial->entry;
    search->states_free = status == DALCS_OK && dalcs_stage_frees_states(entry);
    bool is_first = part->guards.fresh && search->restarts == 0;
    if (status == DALCS_OK && dalcs_stage_residual(entry) <= dalcs_nothing) {
        judge(r, part, search, end_of(part, search), trial);
        if (is_first && !search->fixed && !part->guards.bends && is_outsized(part, q)) {
            q->ratio = q->own = INFINITY;
            trial->holds = false;
        }
    } else {
        q->ratio = INFINITY;
    }
    return trial->holds ? DALCS_OK : dalcs_search_recover(r, part, search, q, &trial->done);
}

/* What lies beyond an event says nothing of how large signals are: there the output of a comparator runs away, which
 * turns at its rail. So a step that an event cuts is judged once more, up to there. Mode and state have been found right:
 * only its length is in question. */
static void judge_what_is_left(struct dalcs_radau *r, struct dalcs_radau_part *part,
                               const struct dalcs_search *search, struct dalcs_trial *trial) {
    if (search->fixed || !(trial->next < end_of(part, search))) {
        return;
    }
    judge(r, part, search, trial->next, trial);
    part->segment.ratio = dalcs_smaller(1.0, trial->quality.ratio);
    if (!trial->holds && part->segment.h >= 2.0 * dalcs_length_shortest(r)) {
        r->rejected++;
        dalcs_length_shorten(part, trial->quality.ratio, 0);
    } else {
        trial->holds = true;
    }
}

/* May the state be off by what interpolation left of it? */
static bool is_worth_projecting(struct dalcs_radau_part *part, const struct dalcs_search *search,
                                const struct dalcs_step_quality *q) {
    return part->guards.fresh && !search->projected && !search->states_free &&
           q->drift > (search->fixed ? 0.0 : dalcs_slight) &&
           dalcs_projection_sees(part, search->fixed);
}

/* On factors the second time where what has no memory agrees with the states: what conducts next does so from these, and
 * what is clear of 0 is so by these. */
static double find_first_fall(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                              double end, const struct dalcs_trial *trial, bool *at_once) {
    const double *unit = trial->quality.unit;
    const double theta = dalcs_guards_first_fall(r, part, end, unit, at_once);
    if (!(theta > 0.0 && theta <= end) || dalcs_stage_has_map(trial->entry)) {
        return theta;
    }
    dalcs_stages_settle(&part->stages, trial->entry, part->segment.out);
    if (part->guards.fresh) {
        dalcs_guards_arm(part, false, unit);
    }
    return dalcs_guards_first_fall(r, part, end, unit, at_once);
}

/* The signs of an accurate step. trial->holds: the mode is right up to trial->next, where something crosses or the
 * step ends. Else what is found is answered in this order: a guess that went wrong, a wrong mode, a tie, a polynomial that
 * is not to be believed. */
static inline enum dalcs_status look_at_signs(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                              struct dalcs_search *search,
                                              struct dalcs_trial *trial) {
    const struct dalcs_step_quality *q = &trial->quality;
    trial->holds = false;
    double end = end_of(part, search);
    if (part->guards.fresh) {
        dalcs_guards_arm(part, false, q->unit);
    }
    bool at_once;
    double theta = find_first_fall(r, part, end, trial, &at_once);
    const double next = trial->next = dalcs_smaller(theta, end);
    bool is_remembered = search->guessed && !search->front;
    if (is_remembered && (part->guards.slips || dalcs_guards_overreach(part, q->unit))) {
        return dalcs_search_refuse(part, search);
    }
    /* A guard falls where the step begins. */
    if (at_once && part->guards.fresh) {
        return dalcs_search_change_mode(r, part, search, q->unit, &trial->done);
    }
    if (dalcs_search_moves_states(part, search, q->unit)) {
        return dalcs_search_tie_again(part, search);
    }
    /* Of the tied pairs that are closed to try, some have no current. */
    if (search->opened && dalcs_tied_open_idle(part, part->work.mode_tied, next, q->unit)) {
        return dalcs_search_go_on_trying(part, search);
    }
    /* A comparison rests at equality: it has in the next try the side that is written for it, unless that one falls at
     * once, so that something else decides. What it commands may turn, and micro-steps, which answer that, see rounding. */
    if (part->guards.fresh && search->rested <= search->restarts &&
        dalcs_guards_rest(part, q->unit)) {
        search->rested = search->restarts + 1;
        return DALCS_OK;
    }
    /* A guard is below 0 from the start on and does not come back, as an error of the state would. Micro-steps that go beyond
     * the next event would not tell. */
    if (part->guards.fresh && search->restarts == 0 &&
        4.0 * dalcs_radau_micro_length(r, part, 0) < next * part->segment.h &&
        dalcs_guards_stay_negative(part, next, q->unit)) {
        return search->guessed ? dalcs_search_refuse(part, search)
                               : dalcs_search_ask(r, part, search, true);
    }
    /* Diodes have neither current nor voltage, and nobody has looked yet on which side they are. */
    if (part->guards.fresh && !search->guessed && search->ties != DALCS_TIES_SHARED &&
        dalcs_tied_stay(part, dalcs_stage_n_clashes(part->segment.entry) == 0, q->unit)) {
        return dalcs_search_untie(r, part, search, next, q);
    }
    /* What dies away within the step may have swung below 0, or not: a shorter step decides. */
    bool may_dip = part->guards.fresh && part->guards.may_dip;
    if (dalcs_search_may_refine(search) && (may_dip || dalcs_guards_swing(part))) {
        return dalcs_search_refine(r, part, search);
    }
    trial->holds = true;
    return DALCS_OK;
}

/* A formula that has no value somewhere in a step that holds has none there: the run ends. */
static enum dalcs_status check_poles(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     double theta) {
    if (!dalcs_smooth_step_meets_pole(part, &theta)) {
        return DALCS_OK;
    }
    enum dalcs_status status =
        dalcs_micro_fail(r, part, 1.0 / part->segment.h, part->work.u, DALCS_NOT_CONVERGED);
    r->base->failure.time += theta * part->segment.h;
    return status;
}

/* One try. *done: there is a segment. */
static enum dalcs_status try_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                  struct dalcs_search *search, bool *done) {
    struct dalcs_trial trial = {.quality = {.ratio = NAN, .own = INFINITY}};
    if (part->guards.slides || search->jumps) {
        *done = true;
        return dalcs_search_fall_back(r, part, search->limit, search->first_level, INFINITY);
    }
    DALCS_TRY(solve_accurately(r, part, search, &trial));
    if (trial.holds && is_worth_projecting(part, search, &trial.quality)) {
        bool moved;
        DALCS_TRY(dalcs_search_project(r, part, search, &moved));
        if (moved || search->jumps) {
            return DALCS_OK;
        }
        DALCS_TRY(dalcs_stages_get(&part->stages, part->component->osnsp.mode, part->segment.h,
                                   &trial.entry));
    }
    if (trial.holds) {
        part->segment.entry = trial.entry;
        part->segment.ratio = dalcs_smaller(1.0, trial.quality.ratio);
        DALCS_TRY(look_at_signs(r, part, search, &trial));
    }
    if (trial.holds) {
        judge_what_is_left(r, part, search, &trial);
    }
    if (trial.holds) {
        part->segment.open = part->guards.fresh && (search->ties != DALCS_TIES_STAND ||
                                                    dalcs_stage_n_clashes(trial.entry) > 0);
        DALCS_TRY(check_poles(r, part, trial.next));
        DALCS_TRY(dalcs_trial_accept(r, part, search, &trial));
        trial.done = true;
    }
    *done = trial.done;
    return DALCS_OK;
}

/* guessed: the mode is what followed the last time. */
static enum dalcs_status look_for_segment(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                          double limit, bool guessed) {
    struct dalcs_search search = {.limit = limit,
                                  .first_level = part->length.level,
                                  .asked_level = part->length.level,
                                  .fixed = r->options.fixed_step > 0.0,
                                  .guessed = guessed,
                                  .errors.before = INFINITY};
    bool asks = (is_commutation(part) || is_between_sides(part) || starts_between_sides(part)) &&
                !guessed && !search.fixed;
    if (part->guards.fresh && part->guards.flipped && !guessed && !asks &&
        part->memory.fronts_refused < MOST_FRONTS_REFUSED) {
        DALCS_TRY(dalcs_front_close(part, &search.front));
        search.guessed = search.front;
    }
    if (part->guards.fresh && part->guards.flipped && !guessed && !search.fixed) {
        part->length.level = search.first_level = search.asked_level = dalcs_first_level(part);
    }
    if (asks) { /* what the caller demands is no guess: the mode before does not replace it */
        DALCS_TRY(dalcs_search_ask(r, part, &search, false));
    }
    bool done = false;
    while (!done) {
        DALCS_TRY(try_step(r, part, &search, &done));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_segment_begin(struct dalcs_radau *r, struct dalcs_radau_part *part) {
    double limit = dalcs_radau_limit(r, part);
    bool slides = false;
    dalcs_segment_renew(part);
    if (dalcs_sliding_leave(&part->component->positions)) {
        DALCS_TRY(dalcs_slide_step(r, part, limit, false, &slides));
    }
    if (slides) {
        return DALCS_OK;
    }
    if (part->memory.flurry > FLURRY) {
        part->guards.fresh = true;
        return dalcs_search_fall_back(r, part, limit, part->length.level, INFINITY);
    }
    bool guessed = part->guards.fresh && part->guards.flipped && dalcs_transition_guess(part);
    bool holds = false;
    if (guessed && r->options.fixed_step == 0.0 && part->smooth == NULL) {
        DALCS_TRY(dalcs_recurrence_try(r, part, limit, &holds));
    }
    if (holds) {
        return DALCS_OK;
    }
    dalcs_recurrence_complete_before(part);
    return look_for_segment(r, part, limit, guessed);
}

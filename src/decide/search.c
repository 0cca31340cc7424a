/* search.c - the answers to a step that does not hold. */
#include "search.h"

#include "blocks.h"
#include "doubt.h"
#include "guard_scale.h"
#include "guards.h"
#include "present.h"
#include "projection.h"
#include "restart.h"
#include "slide.h"
#include "step_length.h"
#include "tied.h"
#include "transition.h"

#include <math.h>
#include <string.h>

/* Defects of a state, over what is allowed, that interpolation may leave; more is a jump. */
static const double most_projected = 1e4;

/* And errors that one or two steps half as long mend. */
static const double nearly = 1e3;

/* A mode may be over after so little of a step. */
static const double briefly = 1.0 / 64.0;

enum {
    STUCK = 3,         /* smaller steps without a smaller error */
    LEVERED_STUCK = 2, /* of levered voltages alone */
    MOST_RESTARTS = 4,
    TIED_RESTARTS = 3, /* longer each time: at the event itself everything may be tied */
    MOST_FLIPS = 12,
    MOST_JUMPS = 64, /* at one instant, as switches turn */
    MOST_FLIPS_CLOSER = 2,
    MOST_REFINED = 4,
    FALL_BACK_LEAST = 5,
    FALL_BACK = 14, /* steps of implicit Euler start this many rungs below */
    SLIDING = 12    /* and are this many below the longest one where a switch slides */
};

enum dalcs_status dalcs_search_project(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       struct dalcs_search *search, bool *moved) {
    search->projected = true;
    return dalcs_projection_try(r, part, search->limit, search->fixed, moved);
}

/* What was seen of errors in another mode, or from another state, does not count. */
static void start_over(struct dalcs_radau_part *part, struct dalcs_search *search, int level) {
    if (!search->fixed) {
        part->length.level = level;
    }
    search->stuck = 0;
    search->spared = false;
    search->ratio_before = INFINITY;
}

/* After micro-steps, in the mode that is to be tried. is_off: see dalcs_radau_restart(). */
static enum dalcs_status go_on_from_answer(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                           struct dalcs_search *search, bool is_off) {
    search->projected = false;
    if (is_off) {
        /* Micro-steps may see a transient that is as fast as they are; a projecting step is far
         * shorter. */
        bool moved;
        DALCS_TRY(dalcs_search_project(r, part, search, &moved));
    }
    start_over(part, search, search->asked_level);
    return DALCS_OK;
}

enum dalcs_status dalcs_search_ask(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                   struct dalcs_search *search, bool mode_only) {
    bool is_off;
    DALCS_TRY(dalcs_radau_restart(r, part, search->restarts++, mode_only, &is_off));
    return go_on_from_answer(r, part, search, is_off);
}

/* s: a step along a threshold, or between two sides of a switch with ripple in proportion. */
static double slide_length(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    double fixed = r->options.fixed_step;
    return ldexp(fixed > 0.0 ? fixed : part->length.longest, -SLIDING);
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
    if (part->guards.slides) { /* between two sides of a switch */
        h = fmin(h, slide_length(r, part));
        part->guards.slides = false;
    }
    part->length.tries++;
    part->length.fell_back = fmin(h, limit - part->segment.t);
    return dalcs_radau_euler_step(r, part, part->length.fell_back);
}

enum dalcs_status dalcs_search_slide_on(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                        double limit, bool *slides) {
    double h = fmax(slide_length(r, part), dalcs_length_shortest(r));
    return dalcs_slide_step(r, part, fmin(h, limit - part->segment.t), slides);
}

static void keep_mode(struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    memcpy(part->work.mode_tied, p->mode, (size_t)p->n_words * sizeof(uint64_t));
}

static void put_mode_back(struct dalcs_radau_part *part) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    memcpy(p->mode, part->work.mode_tied, (size_t)p->n_words * sizeof(uint64_t));
}

static bool is_mode_kept(const struct dalcs_radau_part *part) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    return dalcs_mode_is(p->mode, part->work.mode_tied, p->n_words);
}

enum dalcs_status dalcs_search_tie_again(struct dalcs_radau_part *part,
                                         struct dalcs_search *search) {
    search->opened = false;
    put_mode_back(part);
    return DALCS_OK;
}

enum dalcs_status dalcs_search_go_on_trying(struct dalcs_radau_part *part,
                                            struct dalcs_search *search) {
    search->opened = !is_mode_kept(part);
    return DALCS_OK;
}

/* Those that have crossed cannot: they go back to the side they were on, and the others are tried without them. */
static enum dalcs_status tie_crossed(struct dalcs_radau_part *part, struct dalcs_search *search) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    bool found = false;
    for (int k = 0; k < part->guards.n_crossed; k++) {
        int d = part->guards.crossed[k];
        bool was_on = d < p->system->n_pairs && dalcs_mode_has(part->work.mode_tied, d);
        if (d < p->system->n_pairs && was_on != dalcs_osnsp_is_on(p, d)) {
            dalcs_osnsp_command(p, d, was_on);
            found = true;
        }
    }
    if (!found) {
        return dalcs_search_tie_again(part, search);
    }
    return dalcs_search_go_on_trying(part, search);
}

enum dalcs_status dalcs_search_refuse(struct dalcs_radau_part *part, struct dalcs_search *search) {
    bool stands = dalcs_transition_refuse(part);
    search->first_level = search->asked_level = part->length.level;
    if (stands) {
        return DALCS_OK;
    }
    search->guessed = false;
    part->memory.fronts_refused += search->front ? 1 : 0;
    search->front = false;
    return DALCS_OK;
}

/* Where dalcs_search_project() cannot tell. */
static bool settle(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                   struct dalcs_search *search, const double *unit) {
    if (!dalcs_projection_settle(r, part, unit)) {
        return false;
    }
    search->settled = true;
    start_over(part, search, search->level_before_stuck);
    return true;
}

/* Asks the circuit. Blocks before this one hold, and keep their mode: nothing in it acts on them. */
static enum dalcs_status ask_from(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                  struct dalcs_search *search, int block) {
    keep_mode(part);
    DALCS_TRY(dalcs_search_ask(r, part, search, false));
    dalcs_blocks_put_back(part, block, part->work.mode_tied);
    return DALCS_OK;
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
    bool may_jump = stays ? isinf(ratio) : !(ratio < most_projected);
    return search->fixed || search->stuck > 0 || may_jump;
}

/* So short that a shorter one is not tried, unless that has just held. */
static bool is_shortest(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    bool has_grown = !part->guards.fresh && part->length.held_level > part->length.level;
    return dalcs_radau_ladder(part, part->length.level) < dalcs_length_shortest(r) && !has_grown;
}

/* Will steps do that are not much shorter, though it is that short? They are no less exact for it: the last digit of the
 * time at which one begins moves only sources. */
static bool is_nearly_right(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                            const struct dalcs_step_quality *quality) {
    return quality->own < nearly &&
           dalcs_radau_ladder(part, part->length.level) >= 8.0 * r->resolution;
}

/* Are states where they should be, and only voltages off that errors of theirs are levered up to, of a coil that is cut off?
 * Maps know where that is. Then nothing is wrong with mode and state. */
static bool is_levered(const struct dalcs_radau_part *part,
                       const struct dalcs_step_quality *quality) {
    return part->segment.rounding > 1.0 && quality->own <= 1.0;
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
        return ask_from(r, part, search,
                        is_judged ? dalcs_blocks_first_wrong(part, quality->unit) : 0);
    }
    bool asked = search->restarts > 0 || !part->guards.fresh;
    bool may_project = !search->fixed && !search->projected && !search->states_free && asked;
    *answered = false;
    return quality->own < most_projected && may_project && dalcs_projection_sees(part, false)
               ? dalcs_search_project(r, part, search, answered)
               : DALCS_OK;
}

/* No shorter step mends the error, and it is rounding's: is it let pass from now on? */
static bool lets_pass(const struct dalcs_radau_part *part, struct dalcs_search *search,
                      const struct dalcs_step_quality *quality) {
    bool is_rounding = search->stuck >= STUCK && quality->of_unit < dalcs_doubt_noise(part);
    if (is_rounding && isfinite(quality->ratio) && search->tolerated == 1.0) {
        search->tolerated = 4.0 * quality->ratio;
        return true;
    }
    if (search->stuck < LEVERED_STUCK || !is_levered(part, quality)) {
        return false;
    }
    search->spared = true; /* shorter steps see it as well */
    search->stuck = 0;     /* another error is compared from now on */
    search->ratio_before = INFINITY;
    return true;
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
    /* An error that does not shrink with the step is what the state is off by: a smaller step would
     * not mend it, and rounding is all it is. */
    search->stuck = quality->ratio > 0.3 * search->ratio_before ? search->stuck + 1 : 0;
    search->ratio_before = quality->ratio;
    if (search->stuck == 0) {
        search->level_before_stuck = part->length.level;
    }
    if (lets_pass(part, search, quality)) {
        part->length.level = search->level_before_stuck;
        return DALCS_OK;
    }
    bool may_be_off =
        search->stuck >= STUCK && !search->settled && !search->states_free && !search->fixed;
    if (may_be_off && settle(r, part, search, quality->unit)) {
        return DALCS_OK;
    }
    bool wrong_flip = search->flips > 0 && !(quality->own < most_projected);
    if (search->fixed || wrong_flip ||
        (is_shortest(r, part) && !is_nearly_right(r, part, quality))) {
        *done = true;
        return dalcs_search_fall_back(r, part, search->limit, search->first_level, INFINITY);
    }
    dalcs_length_shorten(part, quality->ratio, search->stuck);
    if (part->segment.t + dalcs_radau_ladder(part, part->length.level) <=
        part->segment.t) { /* time would stand still */
        *done = true;
        return dalcs_search_fall_back(r, part, search->limit, search->first_level, INFINITY);
    }
    return DALCS_OK;
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

/* Not if it has jumped and only micro-steps know how far. */
static bool is_state_known(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    return !part->segment.jumped || r->base->jump.is_known;
}

/* May what is wrong from the start be over so soon that micro-steps saw what comes after it? Where a
 * source begins to fall there may be a current that it has to take down first. Behind a jump that only
 * they know it is rather the state, which they left a little off. */
static bool may_be_brief(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                         const struct dalcs_search *search) {
    bool asked = search->restarts > 0 && search->flips == 0 && !search->closer;
    return asked && is_state_known(r, part) && !search->fixed;
}

/* Asks the circuit by micro-steps that are shorter still, for a segment about as long as that. */
static enum dalcs_status ask_closer(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                    struct dalcs_search *search, double recovery) {
    search->closer = true;
    search->projected = false;
    search->asked_level = part->length.level - 2 - ilogb(recovery);
    start_over(part, search, search->asked_level);
    return dalcs_radau_restart(r, part, search->restarts++, false, NULL);
}

/* Have switches turned to where they stood, from the same state, so that they would for ever? Brent's way: modes are
 * compared with one of them, which is a later one each time that their number has doubled. */
static bool comes_round(const struct dalcs_radau_part *part, struct dalcs_search *search) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    if (search->turns > 0 && dalcs_mode_is(p->mode, part->work.mode_turned, p->n_words)) {
        return true;
    }
    if ((search->turns & (search->turns - 1)) == 0) {
        memcpy(part->work.mode_turned, p->mode, (size_t)p->n_words * sizeof(uint64_t));
    }
    return false;
}

/* A switch that remembers stands as it was commanded until a voltage says otherwise, and at one instant that is the one
 * behind the last jump: in an accurate step of the mode it has led to. Past the other threshold there, it turns back,
 * and the circuit is asked what that does: a finite sequence of turns and jumps. One that comes round to the same mode
 * without a jump would not end, nor would one with a jump each time: the switches slide. */
static enum dalcs_status turn_switches(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       struct dalcs_search *search) {
    if (comes_round(part, search) || search->jumps > MOST_JUMPS) {
        part->guards.slides = true;
        part->component->delayed_commands++;
        return DALCS_OK;
    }
    bool has_jumped = part->segment.jumped;
    search->turns++;
    search->turned = true;
    dalcs_guards_flip(part);
    search->restarts = search->flips = 0;
    part->segment.jumped = false;
    DALCS_TRY(dalcs_search_ask(r, part, search, false));
    if (part->segment.jumped) {
        search->turns = 0;
        search->jumps++;
    }
    part->segment.jumped = part->segment.jumped || has_jumped;
    return DALCS_OK;
}

static bool is_switch_that_remembers(const struct dalcs_radau_part *part, int guard) {
    const struct dalcs_system *s = part->component->system;
    return guard >= s->n_pairs && dalcs_pair_remembers(&s->pair[dalcs_guard_pair(part, guard)]);
}

/* Is all that has crossed such switches? What the one-step problem has said of diodes it has said with the switches where
 * they stand, so once it was asked these come first, and what else has crossed is left out. */
static bool leave_switches_that_remember(struct dalcs_radau_part *part, bool asked) {
    struct dalcs_part_guards *g = &part->guards;
    int n = 0;
    for (int k = 0; k < g->n_crossed; k++) {
        n += is_switch_that_remembers(part, g->crossed[k]) ? 1 : 0;
    }
    if (n == 0 || (n < g->n_crossed && !asked)) {
        return false;
    }
    n = 0;
    for (int k = 0; k < g->n_crossed; k++) {
        g->crossed[n] = g->crossed[k];
        n += is_switch_that_remembers(part, g->crossed[k]) ? 1 : 0;
    }
    g->n_crossed = n;
    return true;
}

enum dalcs_status dalcs_search_change_mode(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                           struct dalcs_search *search, const double *unit,
                                           bool *done) {
    bool is_remembered = search->guessed && !search->front;
    if (!is_remembered && dalcs_search_may_refine(search) && dalcs_guards_recover(part, unit)) {
        return dalcs_search_refine(r, part, search);
    }
    if (search->guessed) {
        return dalcs_search_refuse(part, search);
    }
    if (search->opened) {
        return tie_crossed(part, search);
    }
    if (leave_switches_that_remember(part, search->restarts > 0)) {
        return turn_switches(r, part, search);
    }
    double recovery = may_be_brief(r, part, search) ? dalcs_guards_recovery(part) : INFINITY;
    bool is_resolved =
        recovery * part->segment.h >= dalcs_length_shortest(r); /* else no micro-step sees it */
    if (recovery > 0.0 && recovery < briefly && is_resolved) {
        return ask_closer(r, part, search, recovery);
    }
    if (search->closer && search->flips_closer++ < MOST_FLIPS_CLOSER) {
        dalcs_guards_flip(part);
        return DALCS_OK;
    }
    if (search->restarts < MOST_RESTARTS && search->flips == 0) {
        return ask_from(r, part, search, dalcs_blocks_first_crossed(part));
    }
    if (search->flips == 2 && dalcs_search_may_refine(search)) {
        search->flips = 0; /* on neither side: a shorter step may tell which */
        return dalcs_search_refine(r, part, search);
    }
    if (search->flips++ < MOST_FLIPS) {
        dalcs_guards_flip(part);
        return DALCS_OK;
    }
    *done = true;
    return dalcs_search_fall_back(r, part, search->limit, search->first_level, part->segment.h);
}

/* The present mode holds but for ties, of which micro-steps tell more than this; of a diode that crossed just
 * now, less. So of others their mode is not taken, nor is the state put on it: what rounding makes of large
 * capacitors in steps so short may be more current than there is, and where it goes another mode. */
static enum dalcs_status ask_of_tied(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     struct dalcs_search *search, const double *unit) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    keep_mode(part);
    for (int d = 0; d < p->system->n_pairs; d++) {
        part->guards.tied[d] = dalcs_tied_is(part, d, unit);
    }
    bool mode_only = search->restarts > 0;
    bool is_off;
    DALCS_TRY(dalcs_radau_restart(r, part, search->restarts++, mode_only, &is_off));
    for (int d = 0; d < p->system->n_pairs; d++) {
        if (!part->guards.tied[d] && p->is_diode[d]) {
            dalcs_osnsp_command(p, d, dalcs_mode_has(part->work.mode_tied, d));
        }
    }
    return go_on_from_answer(r, part, search, is_off);
}

enum dalcs_status dalcs_search_untie(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     struct dalcs_search *search, double next,
                                     const struct dalcs_step_quality *quality) {
    double micro = dalcs_radau_micro_length(r, part, search->restarts);
    if (search->restarts < TIED_RESTARTS && 4.0 * micro < next * part->segment.h) {
        return ask_of_tied(r, part, search, quality->unit);
    }
    search->untied = true;
    keep_mode(part);
    search->opened = dalcs_tied_turn(part, quality->unit);
    return DALCS_OK;
}

/* segment.c - from a state and a guess of the mode to a segment that holds.
 *
 * A step is solved in the present mode. If it is accurate and nothing in it is negative from the start,
 * the mode is right: for a passive circuit the solution is unique where complementarity is strict, so a
 * guess that passes needs no other proof. If not, the circuit is asked: by micro-steps what the mode is
 * and whether the state jumps, by a projection whether the state is only off by what interpolation left
 * of it, by shorter steps whether the error was the step's. Where all fail, as where events accumulate
 * in finite time, implicit Euler goes on by itself for a while, certified and a little at a time. */
#include "energy.h"
#include "extremes.h"
#include "front.h"
#include "guards.h"
#include "projection.h"
#include "radau_internal.h"
#include "recurrence.h"
#include "step_length.h"
#include "twins.h"

#include <math.h>
#include <string.h>

/* Defects of a state, over what is allowed, that interpolation may leave; more is a jump. */
static const double most_projected = 1e4;

/* A remembered first step gets longer the next time if its error, over the signal, is below this: for
 * a row more at each event waveforms would be worse than they need. */
static const double fine = 3e-11;

/* Errors over their unit that no smaller step mends are rounding's up to this. */
static const double most_tolerated = 2e-13;

/* A mode may be over after so little of a step. */
static const double briefly = 1.0 / 64.0;

/* See is_outsized(). */
static const double outsized = 1e6;

enum {
    MOST_PREFERRED = 2, /* rungs of the ladder, for the sake of factors */
    STUCK = 3,          /* smaller steps without a smaller error */
    LEVERED_STUCK = 2,  /* of levered voltages alone */
    VERY_STUCK = 8,
    MOST_RESTARTS = 4,
    TIED_RESTARTS = 3, /* longer each time: at the event itself everything may be tied */
    MOST_FLIPS = 12,
    MOST_FLIPS_CLOSER = 2,
    MOST_REFINED = 2,
    FALL_BACK_LEAST = 5,
    FALL_BACK = 14, /* steps of implicit Euler start this many rungs below */
    SLIDING = 12,   /* and are this many below the longest one where a switch slides */
    CROWD = 40,
    FLURRY = 4096,
    MOST_FRONTS_REFUSED = 16,
    MOST_REOPENED = 8
};

double dalcs_radau_limit(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    return dalcs_smaller(dalcs_smaller(part->excitation.next_edge, part->commands.next),
                         r->options.stop);
}

void dalcs_segment_inputs(struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    memcpy(part->in, part->x, (size_t)s->n_x * sizeof(double));
    part->in[s->n_x] = 1.0;
    dalcs_excitation_coefficients(&part->excitation, part->t, part->h, part->in + s->n_x + 1);
}

enum dalcs_status dalcs_segment_solve(struct dalcs_radau_part *part,
                                      struct dalcs_stage_entry **entry) {
    dalcs_segment_inputs(part);
    DALCS_TRY(dalcs_stages_step(&part->stages, part->component->osnsp.mode, part->h, part->in,
                                part->out, entry));
    part->rounding = dalcs_stage_rounding(*entry);
    return DALCS_OK;
}

/* The search for a segment from one point. */
struct search {
    double limit;    /* s: edge, command or stop */
    int first_level; /* where the ladder stood */
    int asked_level; /* where a search begins anew after the circuit was asked: there, or `closer` */
    bool fixed;      /* the step is given: no error control */
    int restarts, flips;
    bool guessed; /* the mode is one remembered from the last time, or that of a front */
    bool front;   /* the latter */
    int reopened; /* times that diodes of a front were opened again */
    int refined;  /* times that a step was shortened for the signs at its start */
    bool closer;  /* micro-steps have looked for a mode that lasts for a small part of the step */
    int flips_closer;
    bool untied; /* tied diodes have been looked at */
    bool opened; /* and are on their other sides now, to try */
    bool projected;
    bool settled;     /* the state has been moved by what no shorter step mended */
    bool states_free; /* in the mode of the last step, which has nothing to project on */
    int stuck;
    double ratio_before;
    int level_before_stuck;
    double tolerated; /* the ratio that is let pass */
    bool spared;      /* errors of states alone count */
};

/* See projection.h. */
static enum dalcs_status project(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                 struct search *search, bool *moved) {
    search->projected = true;
    return dalcs_projection_try(r, part, search->limit, search->fixed, moved);
}

/* What was seen of errors in another mode, or from another state, does not count. */
static void start_over(struct dalcs_radau_part *part, struct search *search, int level) {
    if (!search->fixed) {
        part->level = level;
    }
    search->stuck = 0;
    search->spared = false;
    search->ratio_before = INFINITY;
}

static enum dalcs_status restart(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                 struct search *search, bool mode_only) {
    bool is_off;
    DALCS_TRY(dalcs_radau_restart(r, part, search->restarts++, mode_only, &is_off));
    search->projected = false;
    if (is_off) {
        /* Micro-steps may see a transient that is as fast as they are; a projecting step is far
         * shorter. */
        bool moved;
        DALCS_TRY(project(r, part, search, &moved));
    }
    start_over(part, search, search->asked_level);
    return DALCS_OK;
}

/* Implicit Euler instead, for `most` at first: where a step has been accurate, it is as short. It is certified and
 * takes every event and jump that the step covers. In a row its steps double, up to a part of the ladder's: sliding
 * and accumulating events pass in few. */
static enum dalcs_status fall_back(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                   double limit, int level, double most) {
    double fixed = r->options.fixed_step;
    double whole = fixed > 0.0 ? fixed : dalcs_radau_ladder(part, level);
    part->level = level;
    double h = ldexp(whole, part->tries - FALL_BACK);
    h = fmin(h, fmin(most, ldexp(whole, -FALL_BACK_LEAST)));
    h = fmax(h, 64.0 * r->resolution);
    if (part->tries > 0 && fixed == 0.0) { /* however short the ladder's step has become */
        h = fmax(h, fmin(2.0 * part->fell_back, ldexp(part->longest, -FALL_BACK)));
    }
    if (part->slides) { /* between two sides of a switch, with ripple in proportion */
        h = fmin(h, ldexp(fixed > 0.0 ? fixed : part->longest, -SLIDING));
        part->slides = false;
    }
    part->tries++;
    part->fell_back = fmin(h, limit - part->t);
    r->euler_steps++;
    return dalcs_radau_euler_step(r, part, part->fell_back);
}

/* A tied diode that was opened to try, or closed, cannot. */
static enum dalcs_status tie_again(struct dalcs_radau_part *part, struct search *search) {
    search->opened = false;
    memcpy(part->component->osnsp.mode, part->mode_tied,
           (size_t)part->component->osnsp.n_words * sizeof(uint64_t));
    return DALCS_OK;
}

/* With the others, if any is on the other side still. */
static enum dalcs_status go_on_trying(struct dalcs_radau_part *part, struct search *search) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    search->opened = !dalcs_mode_is(p->mode, part->mode_tied, p->n_words);
    return DALCS_OK;
}

/* Those that have crossed cannot: they go back to the side they were on, and the others are tried without them. */
static enum dalcs_status tie_crossed(struct dalcs_radau_part *part, struct search *search) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    bool found = false;
    for (int k = 0; k < part->n_crossed; k++) {
        int d = part->crossed[k];
        bool was_on = d < p->system->n_pairs && dalcs_mode_has(part->mode_tied, d);
        if (d < p->system->n_pairs && was_on != dalcs_osnsp_is_on(p, d)) {
            dalcs_osnsp_command(p, d, was_on);
            found = true;
        }
    }
    if (!found) {
        return tie_again(part, search);
    }
    return go_on_trying(part, search);
}

static enum dalcs_status refuse(struct dalcs_radau_part *part, struct search *search) {
    bool stands = dalcs_transition_refuse(part);
    search->first_level = search->asked_level = part->level;
    if (stands) {
        return DALCS_OK;
    }
    search->guessed = false;
    part->fronts_refused += search->front ? 1 : 0;
    search->front = false;
    return DALCS_OK;
}

/* Where project() cannot tell. */
static bool settle(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                   struct search *search, const double *unit) {
    if (!dalcs_projection_settle(r, part, unit)) {
        return false;
    }
    search->settled = true;
    start_over(part, search, search->level_before_stuck);
    return true;
}

/* Of the first step of a mode, with an error so many times what is allowed: may it be that the state has to
 * jump, or only that the step is too long? A shorter one is tried first: it may show a transient that a
 * micro-step passes over, with the events in it, and costs less. Where every state is what it likes none jumps. */
static bool is_worth_asking(const struct dalcs_radau_part *part, const struct search *search,
                            double ratio) {
    bool has_free_states =
        part->rounding == 1.0 && search->states_free && part->component->system->n_x > 0;
    bool may_jump = has_free_states ? isinf(ratio) : !(ratio < most_projected);
    return search->fixed || search->stuck > 0 || may_jump;
}

/* No shorter step mends the error, and it is small or over in no time: is it let pass from now on? */
static bool lets_pass(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                      struct search *search, const struct dalcs_step_quality *quality) {
    bool is_rounding = search->stuck >= STUCK && quality->of_unit < most_tolerated * part->rounding;
    bool is_small = search->stuck >= VERY_STUCK && quality->of_unit < r->inner_tolerance;
    if ((is_rounding || is_small) && isfinite(quality->ratio) && search->tolerated == 1.0) {
        search->tolerated = 4.0 * quality->ratio;
        return true;
    }
    /* What allowed errors of states are levered up to, and shorter steps see as well, is that of a coil that is cut
     * off. Maps know where that is. */
    bool is_levered = part->rounding > 1.0 && search->stuck >= LEVERED_STUCK && quality->own <= 1.0;
    search->spared = search->spared || is_levered;
    return is_levered;
}

/* After a step that is not accurate: changes the mode, the state or the length. *done: the segment is
 * one of implicit Euler. */
static enum dalcs_status recover(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                 struct search *search, const struct dalcs_step_quality *quality,
                                 bool *done) {
    /* The step that suits a front is not remembered: it may have to be shorter. */
    bool may_shorten =
        search->front && !search->fixed && search->stuck == 0 && quality->own < most_projected;
    if (search->guessed && !may_shorten) {
        return refuse(part, search);
    }
    if (search->opened) {
        return tie_again(part, search);
    }
    if (part->fresh && search->restarts == 0 && is_worth_asking(part, search, quality->own)) {
        return restart(r, part, search, false);
    }
    bool asked = search->restarts > 0 || !part->fresh;
    bool may_project = !search->fixed && !search->projected && !search->states_free && asked;
    if (quality->own < most_projected && may_project && dalcs_projection_sees(part, false)) {
        bool moved;
        DALCS_TRY(project(r, part, search, &moved));
        if (moved) {
            return DALCS_OK;
        }
    }
    r->rejected++;
    /* An error that does not shrink with the step is what the state is off by: a smaller step would
     * not mend it, and rounding is all it is, or small beside the largest signal of its unit. */
    search->stuck = quality->ratio > 0.3 * search->ratio_before ? search->stuck + 1 : 0;
    search->ratio_before = quality->ratio;
    if (search->stuck == 0) {
        search->level_before_stuck = part->level;
    }
    if (lets_pass(r, part, search, quality)) {
        part->level = search->level_before_stuck;
        return DALCS_OK;
    }
    bool may_be_off =
        search->stuck >= STUCK && !search->settled && !search->states_free && !search->fixed;
    if (may_be_off && settle(r, part, search, quality->unit)) {
        return DALCS_OK;
    }
    bool wrong_flip = search->flips > 0 && !(quality->own < most_projected);
    if (search->fixed || wrong_flip ||
        dalcs_radau_ladder(part, part->level) < 64.0 * r->resolution) {
        *done = true;
        return fall_back(r, part, search->limit, search->first_level, INFINITY);
    }
    dalcs_length_shorten(part, quality->ratio, search->stuck);
    return DALCS_OK;
}

/* A shorter step, for signs that may be those of the polynomial alone. */
static bool may_refine(const struct search *search) {
    return !search->fixed && search->refined < MOST_REFINED;
}

static enum dalcs_status refine(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                struct search *search) {
    search->refined++;
    r->rejected++;
    part->level++;
    return DALCS_OK;
}

/* May what is wrong from the start be over so soon that micro-steps saw what comes after it? Where a
 * source begins to fall there may be a current that it has to take down first. Behind a jump that only
 * they know it is rather the state, which they left a little off. */
static bool may_be_brief(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                         const struct search *search) {
    bool asked = search->restarts > 0 && search->flips == 0 && !search->closer;
    bool is_exact = !part->jumped || r->base->jump.is_known;
    return asked && is_exact && !search->fixed;
}

/* Asks the circuit by micro-steps that are shorter still, for a segment about as long as that. */
static enum dalcs_status ask_closer(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                    struct search *search, double recovery, bool mode_only) {
    search->closer = true;
    search->projected = false;
    search->asked_level = part->level - 2 - ilogb(recovery);
    start_over(part, search, search->asked_level);
    return dalcs_radau_restart(r, part, search->restarts++, mode_only, NULL);
}

/* The mode is wrong from the start: asks the circuit, then tries the other sides. Unless it may be the
 * polynomial that is wrong there, as a shorter step will tell. */
static enum dalcs_status change_mode(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     struct search *search, const double *unit, bool *done) {
    bool is_remembered = search->guessed && !search->front;
    if (!is_remembered && may_refine(search) && dalcs_guards_recover(r, part, unit)) {
        return refine(r, part, search);
    }
    if (search->guessed) {
        return refuse(part, search);
    }
    if (search->opened) {
        return tie_crossed(part, search);
    }
    double recovery = may_be_brief(r, part, search) ? dalcs_guards_recovery(part) : INFINITY;
    bool is_resolved = recovery * part->h >= 64.0 * r->resolution; /* else no micro-step sees it */
    if (recovery > 0.0 && recovery < briefly && is_resolved) {
        return ask_closer(r, part, search, recovery, false);
    }
    if (search->closer && search->flips_closer++ < MOST_FLIPS_CLOSER) {
        dalcs_guards_flip(part);
        return DALCS_OK;
    }
    if (search->restarts < MOST_RESTARTS && search->flips == 0) {
        return restart(r, part, search, false);
    }
    if (search->flips++ < MOST_FLIPS) {
        dalcs_guards_flip(part);
        return DALCS_OK;
    }
    *done = true;
    return fall_back(r, part, search->limit, search->first_level, part->h);
}

/* The present mode holds but for ties, of which micro-steps tell more than this; of a diode that crossed just
 * now, less. */
static enum dalcs_status ask_of_tied(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     struct search *search, const double *unit) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    memcpy(part->mode_tied, p->mode, (size_t)p->n_words * sizeof(uint64_t));
    for (int d = 0; d < p->system->n_pairs; d++) {
        part->tied[d] = dalcs_guards_is_tied(part, d, unit);
    }
    DALCS_TRY(restart(r, part, search, search->restarts > 0));
    for (int d = 0; d < p->system->n_pairs; d++) {
        if (!part->tied[d] && p->is_diode[d]) {
            dalcs_osnsp_command(p, d, dalcs_mode_has(part->mode_tied, d));
        }
    }
    return DALCS_OK;
}

/* A diode without current and voltage: the circuit is asked which of its sides is of least norm, and
 * where it does not know yet, as at the event itself, whether it can turn. Not beyond the next event, in
 * steps. */
static enum dalcs_status untie(struct dalcs_radau *r, struct dalcs_radau_part *part,
                               struct search *search, double next,
                               const struct dalcs_step_quality *quality) {
    double micro = dalcs_radau_micro_length(r, part, search->restarts);
    if (search->restarts < TIED_RESTARTS && 4.0 * micro < next * part->h) {
        return ask_of_tied(r, part, search, quality->unit);
    }
    search->untied = true;
    memcpy(part->mode_tied, part->component->osnsp.mode,
           (size_t)part->component->osnsp.n_words * sizeof(uint64_t));
    search->opened = dalcs_guards_turn_tied(part, quality->unit);
    return DALCS_OK;
}

void dalcs_segment_accept(struct dalcs_radau *r, struct dalcs_radau_part *part, double theta,
                          double residual) {
    part->end = theta;
    part->by_euler = false;
    if (theta * part->h > 4.0 * part->fell_back) {
        part->tries = 0;
    }
    r->steps++;
    if (residual > r->worst_residual) {
        r->worst_residual = residual;
        r->worst_time = part->t;
    }
    if (part->fresh) {
        dalcs_transition_hold(part);
        part->fresh = false;
        part->flipped = false;
    }
}

/* At the start of a run the state is exact. A diode that is on the wrong side of 0 there, if only for picoseconds, is
 * on the other one until then, and its change is an event. *holds: none is; micro-steps that end before say so where
 * it may be the polynomial, which is least exact at its start. */
static enum dalcs_status look_at_start(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       struct search *search, const double *unit, bool *holds) {
    struct dalcs_osnsp *p = &part->component->osnsp;
    *holds = true;
    bool is_exact = !part->jumped || r->base->jump.is_known;
    if (!is_exact || search->closer || search->fixed) {
        return DALCS_OK;
    }
    bool is_sure;
    double least = 64.0 * r->resolution / part->h;
    double most = dalcs_smaller(briefly, part->seen / part->h);
    double rise = dalcs_guards_rise(r, part, least, most, unit, &is_sure);
    if (!(rise < most)) {
        return DALCS_OK;
    }
    int level = part->level;
    memcpy(part->mode_tied, p->mode, (size_t)p->n_words * sizeof(uint64_t));
    enum dalcs_status status = ask_closer(r, part, search, rise, true);
    if (status < DALCS_OK) {
        return status;
    }
    bool differs = status == DALCS_OK && !dalcs_mode_is(p->mode, part->mode_tied, p->n_words);
    if (!differs) {
        memcpy(p->mode, part->mode_tied, (size_t)p->n_words * sizeof(uint64_t));
    }
    *holds = !differs && !is_sure;
    search->opened = search->opened && *holds;
    part->level = *holds ? level : part->level;
    return DALCS_OK;
}

/* All of a step of the ladder: a longer one may be as good. */
static bool is_whole(const struct dalcs_radau_part *part, double theta) {
    return theta == 1.0 && part->h == dalcs_radau_ladder(part, part->level);
}

/* What began after pairs changed sides. */
static void learn(struct dalcs_radau *r, struct dalcs_radau_part *part, const struct search *search,
                  double theta, double error) {
    double ratio = error * fmax(1.0, r->inner_tolerance / fine);
    bool longer = !search->fixed && is_whole(part, theta) && part->n_crossed == 0 &&
                  dalcs_length_rungs_promised(r, part, ratio) > 1.0 &&
                  dalcs_radau_ladder(part, part->level - 1) <=
                      dalcs_smaller(part->longest, part->longest_needed);
    int spare = longer ? 1 : 0; /* rungs that the first step may have more the next time */
    if (!search->guessed) {
        double promised =
            dalcs_smaller(dalcs_length_rungs_promised(r, part, error), DALCS_LENGTH_MOST_RUNGS);
        int by_analogy = search->first_level - part->level_before;
        dalcs_transition_began(part, search->first_level, (int)promised);
        spare = (int)dalcs_larger(spare, dalcs_smaller(promised, by_analogy));
        dalcs_transition_learn(part, part->level - spare, by_analogy - spare);
    } else if (!search->front) {
        dalcs_transition_pass(part, spare);
    } else if (spare > 0) {
        dalcs_transition_learn(part, part->level - spare, 0);
    }
    if (!search->fixed) {
        dalcs_recurrence_note(part);
    }
}

static void accept(struct dalcs_radau *r, struct dalcs_radau_part *part,
                   const struct search *search, double theta,
                   const struct dalcs_step_quality *quality, double residual) {
    double t_end = part->t + theta * part->h;
    part->why = part->n_crossed > 0 ? DALCS_END_AT_EVENT : DALCS_END_OF_STEP;
    if (part->n_crossed == 0 && t_end >= search->limit - r->resolution) {
        t_end = search->limit;
        part->why = DALCS_END_AT_EDGE;
    }
    if (search->fixed && part->why == DALCS_END_OF_STEP) {
        double whole = rint(t_end / part->h) * part->h; /* counted, not accumulated */
        t_end = fabs(t_end - whole) <= 4.0 * r->resolution ? whole : t_end;
    }
    part->t_end = dalcs_smaller(t_end, search->limit);
    dalcs_step_remember(part, theta, quality->unit);
    if (theta == 1.0) {
        dalcs_guards_arm(r, part, true, quality->unit);
    }
    double wrong_sign = dalcs_guards_wrong_sign(r, part, theta, quality->unit);
    if (wrong_sign > r->wrong_sign) {
        r->wrong_sign = wrong_sign;
        r->wrong_time = part->t;
    }
    if (part->fresh && part->flipped) {
        learn(r, part, search, theta, quality->ratio);
    }
    dalcs_segment_accept(r, part, theta, residual);
    if (!search->fixed && is_whole(part, theta)) {
        dalcs_length_lengthen(r, part, quality->ratio);
    }
}

/* Signals so many times as large as any before: it may be that a coil's current has nowhere to go in this
 * mode, and a step that short makes of it what vouches for any error. */
static bool is_outsized(const struct dalcs_radau_part *part,
                        const struct dalcs_step_quality *quality) {
    bool is = false;
    for (int unit = 0; unit < 2; unit++) {
        double before = part->unit_scale[unit];
        is = is || (before > 0.0 && quality->here[unit] > outsized * before);
    }
    return is;
}

/* Something happened that is no crossing, a command or the start of the run, in a part on dense maps. */
static bool is_at_command(const struct dalcs_radau_part *part) {
    return part->fresh && part->n_crossed == 0 && part->rounding == 1.0;
}

/* A command has moved a switch: what it carried goes elsewhere, through pairs that have not crossed anything. On
 * dense maps to ask the circuit of them costs less than a step in a mode that is wrong. */
static bool is_commutation(const struct dalcs_radau_part *part) {
    return part->flipped && is_at_command(part);
}

static double step_to_try(const struct dalcs_radau *r, struct dalcs_radau_part *part,
                          double limit) {
    return is_at_command(part) && limit < r->options.stop ? dalcs_length_fitted(part, limit)
                                                          : dalcs_radau_ladder(part, part->level);
}

/* One try. *done: there is a segment. */
static enum dalcs_status try_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                  struct search *search, bool *done) {
    struct dalcs_stage_entry *entry = NULL;
    struct dalcs_step_quality quality = {.ratio = NAN, .own = INFINITY};
    if (part->slides) {
        *done = true;
        return fall_back(r, part, search->limit, search->first_level, INFINITY);
    }
    part->h = search->fixed ? r->options.fixed_step : step_to_try(r, part, search->limit);
    enum dalcs_status status = dalcs_segment_solve(part, &entry);
    if (status < DALCS_OK) {
        return status;
    }
    search->states_free = status == DALCS_OK && dalcs_stage_frees_states(entry);
    double end = dalcs_smaller(1.0, (search->limit - part->t) / part->h);
    if (status == DALCS_OK && !(dalcs_stage_residual(entry) <= dalcs_largest_residual)) {
        if (part->fresh && search->restarts == 0) {
            return restart(r, part, search, false);
        }
        if (search->opened) {
            return tie_again(part, search);
        }
        *done = true; /* no length mends it */
        return fall_back(r, part, search->limit, search->first_level, INFINITY);
    }
    bool means_something =
        status == DALCS_OK && !(search->front && dalcs_stage_n_clashes(entry) > 0);
    if (means_something) {
        dalcs_step_judge(r, part, entry, end, &quality);
        quality.ratio = search->spared ? quality.own : quality.ratio;
        means_something =
            quality.ratio == quality.ratio && !dalcs_step_clashes(part, entry, end, quality.unit);
        if (part->fresh && search->restarts == 0 && !search->fixed && is_outsized(part, &quality)) {
            quality.ratio = quality.own = INFINITY;
        }
    }
    bool controlled = !search->fixed || (part->fresh && search->restarts == 0);
    if (!means_something || (controlled && !(quality.ratio <= search->tolerated))) {
        quality.ratio = means_something ? quality.ratio : INFINITY;
        quality.own = means_something ? quality.own : INFINITY;
        return recover(r, part, search, &quality, done);
    }
    if (search->front && search->reopened++ < MOST_REOPENED && dalcs_front_reopen(part)) {
        return DALCS_OK;
    }
    if (part->fresh && !search->projected && !search->states_free &&
        quality.drift > (search->fixed ? 0.0 : dalcs_worth_projecting) &&
        dalcs_projection_sees(part, search->fixed)) {
        bool moved;
        DALCS_TRY(project(r, part, search, &moved));
        if (moved) {
            return DALCS_OK;
        }
        DALCS_TRY(dalcs_stages_get(&part->stages, part->component->osnsp.mode, part->h, &entry));
    }
    part->entry = entry;
    part->ratio = dalcs_smaller(1.0, quality.ratio);
    if (part->fresh) {
        dalcs_guards_arm(r, part, false, quality.unit);
    }
    bool at_once;
    double theta = dalcs_guards_first_fall(r, part, end, quality.unit, &at_once);
    if (at_once && end < 1.0) { /* wrong, or only small beside what the segment ends with? */
        dalcs_step_reach(part, end, quality.unit);
        theta = dalcs_guards_first_fall(r, part, end, quality.unit, &at_once);
    }
    if (part->slips && search->guessed && !search->front) {
        return refuse(part, search);
    }
    if (at_once && part->fresh) {
        return change_mode(r, part, search, quality.unit, done);
    }
    double next = dalcs_smaller(theta, end);
    if (search->opened && dalcs_guards_open_idle(part, part->mode_tied, next, quality.unit)) {
        return go_on_trying(part, search);
    }
    if (search->opened && dalcs_guards_turn_back(part, next, quality.unit)) {
        return tie_crossed(part, search);
    }
    if (part->fresh && dalcs_twins_close(part, quality.unit)) {
        return DALCS_OK;
    }
    if (part->fresh && search->restarts == 0 &&
        dalcs_guards_stay_negative(r, part, next, quality.unit)) {
        return search->guessed ? refuse(part, search) : restart(r, part, search, true);
    }
    if (part->fresh && !search->guessed && !search->untied &&
        dalcs_guards_stay_tied(part, dalcs_stage_n_clashes(entry) == 0, quality.unit)) {
        return untie(r, part, search, next, &quality);
    }
    bool may_dip = part->fresh && part->may_dip;
    if (may_refine(search) && (may_dip || dalcs_guards_swing(part))) {
        return refine(r, part, search);
    }
    bool holds = true;
    if (part->t == 0.0) {
        DALCS_TRY(look_at_start(r, part, search, quality.unit, &holds));
    }
    if (!holds) {
        return DALCS_OK;
    }
    part->open = part->fresh && (search->untied || dalcs_stage_n_clashes(entry) > 0);
    accept(r, part, search, next, &quality, dalcs_stage_residual(entry));
    *done = true;
    return DALCS_OK;
}

/* A mode that has been before, though not after this one, may have the map of a longer step that suited it then,
 * or the factors of a shorter one: it costs less to begin with that. */
static int cheapest_level(struct dalcs_radau_part *part) {
    int level = part->rounding == 1.0 ? dalcs_transition_longest_level(part) : part->level;
    for (int k = 0; k <= MOST_PREFERRED; k++) {
        double h = dalcs_radau_ladder(part, level + k);
        if (dalcs_stages_have(&part->stages, part->component->osnsp.mode, h)) {
            return level + k;
        }
    }
    return level;
}

/* guessed: the mode is what followed the last time. */
static enum dalcs_status look_for_segment(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                          double limit, bool guessed) {
    struct search search = {.limit = limit,
                            .first_level = part->level,
                            .asked_level = part->level,
                            .fixed = r->options.fixed_step > 0.0,
                            .guessed = guessed,
                            .ratio_before = INFINITY,
                            .tolerated = 1.0};
    if (part->fresh && part->flipped && !guessed && part->fronts_refused < MOST_FRONTS_REFUSED) {
        DALCS_TRY(dalcs_front_close(part, &search.front));
        search.guessed = search.front;
    }
    if (part->fresh && part->flipped && !guessed && !search.fixed) {
        part->level = search.first_level = search.asked_level = cheapest_level(part);
    }
    if (is_commutation(part) && !guessed && !search.fixed) {
        DALCS_TRY(restart(r, part, &search, false));
    }
    bool done = false;
    while (!done) {
        DALCS_TRY(try_step(r, part, &search, &done));
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_segment_begin(struct dalcs_radau *r, struct dalcs_radau_part *part) {
    double limit = dalcs_radau_limit(r, part);
    if (part->crowd > CROWD + 4 * part->component->system->n_pairs || part->flurry > FLURRY) {
        part->fresh = true;
        return fall_back(r, part, limit, part->level, INFINITY);
    }
    bool guessed = part->fresh && part->flipped && dalcs_transition_guess(part);
    bool holds = false;
    if (guessed && r->options.fixed_step == 0.0) {
        DALCS_TRY(dalcs_recurrence_try(r, part, limit, &holds));
    }
    if (holds) {
        return DALCS_OK;
    }
    dalcs_recurrence_complete_before(part);
    return look_for_segment(r, part, limit, guessed);
}

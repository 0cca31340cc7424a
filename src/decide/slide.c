/* slide.c - a segment along the threshold of a switch that opens what closes it and closes what opens it: how long it is,
 * where it begins and where it ends. */
#include "slide.h"

#include "formula_scale.h"
#include "guard_scale.h"
#include "power_of_step.h"
#include "present.h"
#include "restart.h"
#include "rounding.h"
#include "slide_try.h"
#include "sliding.h"
#include "step_error.h"
#include "step_length.h"

#include <math.h>

/* The first segment of a run that slides is so many powers of 2 shorter than the longest. */
enum { FIRST = 12 };

/* No slide has so many segments: patience need not grow beyond. */
enum { MOST_KEPT = 1 << 20 };

/* At a threshold that a switch slides along the state is as exact as digits are. A jump's argument is known as well on either side
 * of it, whichever of its pairs conducts there. */
static void prepare_positions(struct dalcs_radau_part *part) {
    struct dalcs_positions *p = &part->component->positions;
    int n_pairs = part->component->system->n_pairs;
    p->keeps = false;
    for (int i = 0; i < p->n; i++) {
        p->slack[i] = dalcs_guard_most_rounding(part, n_pairs + i, part->scales.unit);
    }
    for (int k = 0; k < p->n_jumps; k++) {
        p->slack[p->n + k] = dalcs_formula_argument_noise(part, p->jump[k], part->scales.unit);
    }
}

static void accept(struct dalcs_radau *r, struct dalcs_radau_part *part,
                   const struct dalcs_slide_try *of) {
    part->component->commands.n_slid++;
    dalcs_sliding_join(&part->component->positions, part->work.mode_first);
    dalcs_step_take_in(part);
    dalcs_radau_accept_euler(r, part, of->h);
    part->segment.is_coarse = of->is_coarse;
    r->steps++;
}

/* s: up to `limit`, and up to where it is known not to slide any more. What is left behind it is not shorter: the shorter a
 * segment, the more of a mean is rounding. */
static double length_to_try(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                            double limit) {
    const struct dalcs_part_length *l = &part->length;
    const double fixed = r->options.fixed_step;
    const double h = fmin(l->slide > 0.0 ? l->slide : ldexp(l->longest, -FIRST), l->longest);
    const double left = fmin(limit, l->slide_until) - part->segment.t;
    if (fixed > 0.0) {
        return fmin(fmin(fixed, l->longest), left);
    }
    return left > h && left < 2.0 * h ? 0.5 * left : fmin(h, left);
}

/* The error of an event is not along the threshold: the first step would go that way so much the faster, the shorter it is.
 * The state goes to where micro-steps along it begin. *slides: they do. */
static enum dalcs_status put_on_threshold(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                          double most, bool *slides) {
    *slides = false;
    for (int longer = 0; !*slides; longer++) {
        const double h = dalcs_radau_micro_length(r, part, longer);
        if (h > most) {
            return DALCS_OK;
        }
        DALCS_TRY(dalcs_slide_find_leading(r, part, h));
        DALCS_TRY(dalcs_slide_micro_steps(r, part, h, slides));
    }
    for (int x = 0; x < part->component->system->n_x; x++) {
        part->work.after[x] = 2.0 * part->work.y1[x] - part->work.y2[x];
    }
    dalcs_radau_go_after(r, part);
    return DALCS_OK;
}

/* Of the errors of pairs, twice what rounding is known to make, for it is not the same each time. */
static bool are_rounding(const struct dalcs_radau_part *part, const struct dalcs_slide_try *of) {
    return of->bare <= 2.0 * part->length.slide_rounding;
}

/* A try with an error of pairs, behind a longer one with bare_before: rounding makes it where it does not shrink with the
 * step, and is no more than sums over the sequences make of the rounding of one mean. Noise is the more the shorter a step is: an
 * error beside it says nothing of whether it shrinks. */
static void find_rounding(struct dalcs_radau_part *part, const struct dalcs_slide_try *of,
                          double bare_before) {
    const double noise = of->noise / part->inner_tolerance;
    const double most = of->rounding / dalcs_sum_rounded * noise / (1.0 + noise);
    if (of->slides && of->bare > 0.5 * bare_before && of->pairs <= most) {
        part->length.slide_rounding = of->bare;
    }
}

/* Is a segment twice as long worth a try? The estimate is of the order of what is extrapolated less one, over a segment. Where
 * it is rounding it says nothing of longer ones, so that these are tried all the same: each refusal doubles how many segments
 * are kept before the next try, so that tries cost no more than the segments themselves. */
static bool is_longer_worth_trying(struct dalcs_part_length *l, double error) {
    const bool is = ldexp(error, DALCS_SLIDE_ORDER) < 1.0 || l->slides_kept >= l->slides_patient;
    l->slides_kept = is ? 0 : l->slides_kept + 1;
    return is;
}

/* Behind a refusal the next shorter ones are of the same try. Where a length does not hold that did before, something else is on
 * its way, as a diode that turns: what longer ones were refused for is over with it. */
static void note_refusal(struct dalcs_part_length *l) {
    const bool was_longer = l->slides_kept == 0;
    if (!was_longer) {
        l->slides_patient = 1;
    } else if (l->slides_patient < MOST_KEPT) {
        l->slides_patient *= 2;
    }
    l->slides_kept = 1;
}

/* s: of the lengths that halve from the last one, so that step sizes come again, the longest up to half of that of a try: an
 * error that shrinks with the step is then less than half. */
static double shorter(const struct dalcs_part_length *l, double h) {
    double length = l->slide > 0.0 ? l->slide : h;
    while (length > 0.5 * h) {
        length *= 0.5;
    }
    return length;
}

/* What is known of lengths behind a try. What rounding makes is less in a longer one. */
static void note(struct dalcs_radau_part *part, const struct dalcs_slide_try *of) {
    struct dalcs_part_length *l = &part->length;
    const double error = are_rounding(part, of) ? of->states : fmax(of->states, of->pairs);
    if (!of->slides) {
        l->slide_until = part->segment.t + of->fails;
    } else if (error > 1.0) {
        l->slide = shorter(l, of->h);
        note_refusal(l);
    } else if (of->h >= l->slide) {
        l->slide = is_longer_worth_trying(l, error) ? 2.0 * of->h : of->h;
    }
}

/* Is the try exact enough? Currents that jump where a diode turns, or are rounded, do not even shrink as the step does. */
static bool is_exact(const struct dalcs_radau_part *part, const struct dalcs_slide_try *of,
                     double bare_before) {
    return of->slides && of->states <= 1.0 &&
           (of->pairs <= 1.0 || of->bare > 0.5 * bare_before || are_rounding(part, of));
}

/* Where a slide ends the flow of one side is along the threshold, and what is left of it is so short that its square is
 * not worth a word: a step on that side. Where another switch begins or ends to slide meanwhile it is one through that. */
static enum dalcs_status finish(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                struct dalcs_slide_try *of, bool *done) {
    const double h = of->h;
    prepare_positions(part);
    DALCS_TRY(dalcs_radau_implicit_step(r, part, h, h, part->x, part->work.y1));
    *done = part->component->positions.settled;
    part->guards.slides = false;
    if (*done) {
        part->component->commands.n_slid++;
        dalcs_radau_accept_implicit(r, part, h);
        return DALCS_OK;
    }
    of->may_change = true;
    DALCS_TRY(dalcs_slide_attempt(r, part, of));
    of->may_change = false;
    of->is_coarse = true;
    *done = of->slides;
    if (*done) {
        part->length.slide_until = INFINITY;
        accept(r, part, of);
    }
    return DALCS_OK;
}

/* Behind a try whose states are off by as much as in one twice as long: are they as far off in a vanishing one? Then they jump
 * in each step, as where a switch charges a capacitor at once: no mean of such sides is a flow, and nothing slides. Else the
 * try was too long for what moves. */
static enum dalcs_status find_jumping(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                      const struct dalcs_slide_try *of, bool *jumps) {
    struct dalcs_slide_try vanishing = *of;
    vanishing.h = fmin(of->h, dalcs_radau_micro_length(r, part, 0));
    DALCS_TRY(dalcs_slide_attempt(r, part, &vanishing));
    *jumps = vanishing.slides && dalcs_power_of_step(of->states, vanishing.states) <= 0.0;
    return DALCS_OK;
}

/* Is it worth to ask that of a refused try? A slide that goes on has had states that do not jump. */
static bool may_jump(const struct dalcs_slide_try *of, bool starts, double states_before) {
    return starts && of->slides && of->states > 1.0 &&
           dalcs_power_of_step(states_before, of->states) <= 0.0;
}

/* s: shorter behind an error. Where a mean ends within the try, one up to there: the end is known to a step of the first
 * sequence, and not only to half of the try. What is left is no shorter than the step that ends a slide. */
static double next_length(const struct dalcs_radau_part *part, const struct dalcs_slide_try *of,
                          double least_end) {
    return of->slides ? shorter(&part->length, of->h)
                      : fmin(fmax(of->held, 0.5 * of->fails), of->fails - least_end);
}

/* Shorter and shorter ones. Where a diode turns, a state is off by no more than the step. One that starts and is found at no
 * length has no end to finish, and says nothing of how long the next one is. */
static enum dalcs_status find_length(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     struct dalcs_slide_try *of, bool starts, bool *slides) {
    const double shortest = dalcs_length_shortest(r);
    const double before = part->length.slide > 0.0 ? part->length.slide : of->h;
    const double least = fmax(shortest, part->inner_tolerance * before);
    const double least_end = fmax(shortest, sqrt(part->inner_tolerance) * before);
    const double left = part->length.slide_until - part->segment.t;
    double bare_before = INFINITY;
    double states_before = INFINITY;
    bool jumps = false;
    if (left < 2.0 * least_end) {
        of->h = left;
        return finish(r, part, of, slides);
    }
    for (;;) {
        DALCS_TRY(dalcs_slide_attempt(r, part, of));
        const double next = next_length(part, of, least_end);
        bool is_last = r->options.fixed_step > 0.0 ||
                       (of->slides ? next < least : of->fails < 2.0 * least_end);
        find_rounding(part, of, bare_before);
        *slides = of->slides && (is_last || is_exact(part, of, bare_before));
        note(part, of);
        if (*slides) {
            bool is_of_length = of->pairs <= 1.0 || are_rounding(part, of);
            part->length.slide = is_last || !is_of_length ? before : part->length.slide;
            if (left - of->h < least_end) {
                part->length.slide_until = INFINITY; /* it goes on beyond */
            }
            accept(r, part, of);
            return DALCS_OK;
        }
        if (!is_last && may_jump(of, starts, states_before)) {
            DALCS_TRY(find_jumping(r, part, of, &jumps));
        }
        if (is_last || jumps) {
            part->length.slide = before;
            of->h = of->slides ? of->h : of->fails;
            return starts ? DALCS_OK : finish(r, part, of, slides);
        }
        states_before = of->slides ? of->states : INFINITY;
        bare_before = of->slides ? of->bare : INFINITY;
        of->h = next;
    }
}

/* Nothing is known of a slide that starts but how long the segments of the last one were. At its end they may have been shorter
 * than the micro-steps that find this one. */
static void begin(const struct dalcs_radau *r, struct dalcs_radau_part *part) {
    struct dalcs_part_length *l = &part->length;
    if (l->slide > 0.0) {
        l->slide = fmax(l->slide, dalcs_radau_micro_length(r, part, 0));
    }
    l->slide_until = INFINITY;
    l->slide_rounding = 0.0;
    l->slides_kept = 0;
    l->slides_patient = 1;
}

enum dalcs_status dalcs_slide_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                   double limit, bool starts, bool *slides) {
    if (starts) {
        begin(r, part);
    }
    prepare_positions(part);
    struct dalcs_slide_try of =
        dalcs_slide_try_of(part->stages.method, length_to_try(r, part, limit));
    of.follows =
        !starts && part->segment.end_before == 1.0 && !part->guards.leaps && !part->guards.flipped;
    *slides = true;
    if (starts) {
        DALCS_TRY(put_on_threshold(r, part, of.h, slides));
    }
    return *slides ? find_length(r, part, &of, starts, slides) : DALCS_OK;
}

/* quick.c - a stretch that repeats the one before: the same mode, step and map. Nearly all do where a largest step cuts
 * them, and what the engine takes for one is two to six thousand instructions. */
#include "image_sum.h"

#include "wide_vectors.h"

/* Instructions of all this, about, beside the inputs. */
static const double repeat_work = 150.0, input_work = 12.0;

/* What the stretch that was passed over has left, for those that repeat it. Sources in signs and in integrals are asked
 * elsewhere. */
void audit_repeat_from(struct dalcs_audit *audit, struct audit_part *part,
                       const struct dalcs_audit_stretch *stretch) {
    struct audit_watch *watch = part->watch;
    const struct dalcs_audit_polynomials *p = stretch->stored;
    struct audit_screen *screen = watch->screens.latest;
    if (p == NULL || p->input == NULL || stretch->is_cut || screen == NULL ||
        screen->key != p->key || screen->rests > 0 || screen->n_terms[AUDIT_TERM_SIGN] > 0 ||
        screen->n_terms[AUDIT_TERM_FLOW] > 0) {
        return;
    }
    struct audit_image *image = &screen->image[screen->image_at];
    if (image->step != p->step || !audit_is_same_end(image->end, p->end)) {
        return;
    }
    const double near =
        part->tolerance * (stretch->to - stretch->from) + 4.0 * audit->options.resolution;
    const struct audit_window *window = &screen->window[screen->window_at];
    const bool has_guards = screen->n_guards > 0;
    const double past =
        has_guards ? audit_window_past(window, stretch->from + near, stretch->to - near) : 0.0;
    if (isnan(past)) {
        return;
    }
    watch->repeat =
        (struct audit_repeat){.screen = screen,
                              .at = image->at,
                              .n_times = audit_n_times_before(watch, p->end),
                              .n_columns = dalcs_quads_of(p->n_columns),
                              .length = p->end * p->step,
                              .near = near,
                              .from = has_guards ? window->from + past - near : -INFINITY,
                              .to = has_guards ? window->to + past + near : INFINITY,
                              .work = repeat_work + input_work * p->n_inputs};
    for (int m = 0; m < AUDIT_SCREEN_TIMES; m++) {
        watch->repeat.node[m] = audit_node_of(p, m) * p->stride;
    }
}

/* Where the inputs are too far from those at which they were asked. */
static __attribute__((noinline)) double ask_signs(const struct audit_screen *screen,
                                                  const struct dalcs_audit_polynomials *p,
                                                  struct audit_image_at *at, double *place) {
    return audit_image_signs(screen, p, at, place);
}

static __attribute__((noinline)) double stimuli_at(struct dalcs_audit *audit,
                                                   const struct audit_screen *screen, double t) {
    const struct audit_term *term = screen->term[AUDIT_TERM_LAW];
    double sum = 0.0;
    for (int k = 0; k < screen->n_terms[AUDIT_TERM_LAW]; k++) {
        sum += term[k].factor * audit_stimulus_at(audit, term[k].index, t);
    }
    return sum;
}

/* Are laws, signs and states those of a stretch that need not be looked at? *states: at its end. */
DALCS_TWICE(bool, holds,
            (struct dalcs_audit * audit, const struct audit_watch *watch, int m,
             const struct dalcs_audit_stretch *stretch, double *states),
            (audit, watch, m, stretch, states)) {
    const struct dalcs_audit_polynomials *p = stretch->stored;
    const struct audit_screen *screen = watch->repeat.screen;
    struct audit_image_at *at = &watch->repeat.at[m];
    const double past = watch->theta[m] * p->step;
    dalcs_quad sum;
    double far;
    audit_image_laws(screen->constant, screen->n_places, p->input, p->n_inputs, at, &sum, &far);
    double laws = sum[AUDIT_PLACE_LAWS] + screen->rate * past;
    if (screen->n_terms[AUDIT_TERM_LAW] > 0) {
        laws += stimuli_at(audit, screen, stretch->from + past);
    }
    laws = fabs(laws);
    if (p->value != NULL) {
        const int n = watch->repeat.n_columns;
        laws += fabs(sum[AUDIT_PLACE_NODE] - audit_product(n, screen->row + AUDIT_ROW_NOW * n,
                                                           p->value + watch->repeat.node[m]));
    }
    const double jump = fabs(sum[AUDIT_PLACE_START] - watch->states);
    *states = sum[AUDIT_PLACE_END];
    return laws <= screen->limit && (jump <= screen->limit || !watch->knows_states) &&
           (far <= at->slack || -ask_signs(screen, p, at, watch->place) <= screen->limit);
}

bool dalcs_audit_repeats(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch,
                         double work) {
    struct audit_part *part = &audit->part[stretch->part];
    struct audit_watch *watch = part->watch;
    const struct audit_repeat *repeat = &watch->repeat;
    if (repeat->screen == NULL) {
        return false;
    }
    const int m = (int)(repeat->n_times * audit_draw(audit));
    const double length = stretch->to - stretch->from;
    const double credit =
        audit->budget.credit + audit_earned(audit, work, audit->budget.spent + repeat->work);
    double states;
    if (repeat->at[m].place == NULL || credit >= audit->budget.threshold ||
        fabs(length - repeat->length) > repeat->near || stretch->from < repeat->from ||
        stretch->to > repeat->to || !audit_can_tell_times(part, length, stretch->to) ||
        !holds(audit, watch, m, stretch, &states)) {
        return false;
    }
    audit->count.stretches++;
    audit->count.screened++;
    audit->budget.credit = credit;
    audit->budget.spent = 0.0;
    part->at.past = part->at.length;
    part->at.length = length;
    part->at.past_coarse = false;
    watch->states = states;
    return true;
}

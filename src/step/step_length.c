/* step_length.c - rungs of the ladder: how long a step may be, and the next one after an error.
 *
 * Steps are powers of 2 of one length, so that few lengths occur and each keeps its factors. */
#include "step_length.h"

#include "extremes.h"
#include "pi.h"
#include "present.h"
#include "rounding.h"

/* The error estimate may be this much smaller than what is allowed before the step is doubled. */
static const double safety = 0.8;

/* Rungs of a long move. */
enum { LONG_MOVE = 3 };

/* Steps until a longer one is tried to see, at most. */
enum { MOST_PATIENCE = 4096 };

/* A PULSE that begins so many periods late is not looked at. */
enum { MOST_DELAY = 4 };

/* The longest step over the shortest period of a source, by stages: fewer nodes see less. */
static double most_periods(int stages) {
    return stages >= 9 ? 0.75 : stages >= 7 ? 0.6 : stages >= 5 ? 0.45 : 0.25;
}

double dalcs_length_longest(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    double longest = r->options.stop;
    if (r->options.max_step > 0.0) {
        longest = fmin(longest, r->options.max_step);
    }
    return fmin(longest, most_periods(part->stages.method->s) * part->excitation.shortest_period);
}

/* Between two edges of it, or two crossings of a threshold; INFINITY if it does not come back, or only begins to
 * after many periods. */
static double longest_span(const struct dalcs_stimulus *s) {
    if (s->kind != DALCS_STIMULUS_PULSE || s->u.pulse.n_periods > 0.0 ||
        !(s->u.pulse.delay < MOST_DELAY * s->u.pulse.period)) {
        return INFINITY;
    }
    double ramps = s->u.pulse.rise + s->u.pulse.fall;
    double low = s->u.pulse.period - s->u.pulse.width - ramps;
    return dalcs_larger(s->u.pulse.width, low) + ramps;
}

double dalcs_length_of_spans(const struct dalcs_radau_part *part) {
    const struct dalcs_component *c = part->component;
    const struct dalcs_csr *control = &c->system->direct_control;
    double shortest = INFINITY;
    for (int k = 0; k < part->excitation.n_waves; k++) {
        const struct dalcs_stimulus *stimulus = part->excitation.wave[k].stimulus;
        shortest = stimulus != NULL ? dalcs_smaller(shortest, longest_span(stimulus)) : shortest;
    }
    for (int i = 0; i < part->commands.n; i++) {
        int d = part->commands.command[i].pair;
        for (int k = control->p[d]; k < control->p[d + 1]; k++) {
            int stimulus = c->system->stimulus[control->j[k]];
            if (stimulus >= 0) {
                shortest = dalcs_smaller(shortest, longest_span(&c->circuit->stimulus[stimulus]));
            }
        }
    }
    return shortest;
}

/* The first of equal spans is the one: it comes earliest, when times have most digits, and later ones, rounded up and
 * down, are that one exactly. */
double dalcs_length_known_span(const struct dalcs_radau_part *part, double from, double to) {
    for (int k = 0; k < part->length.n_spans; k++) {
        if (dalcs_length_is_same(part->length.span[k], from, to)) {
            return part->length.span[k];
        }
    }
    return 0.0;
}

/* Of a single switch; where several are commanded, events cut most spans, and maps of their length serve nothing
 * else. */
double dalcs_length_fitted(struct dalcs_radau_part *part, double limit) {
    double h = dalcs_radau_ladder(part, part->length.level);
    double span = limit - part->segment.t;
    if (!(part->commands.n == 1 && part->length.longest_needed < INFINITY && span <= h &&
          2.0 * span > h)) {
        return h;
    }
    double known = dalcs_length_known_span(part, part->segment.t, limit);
    if (known == 0.0 && part->length.n_spans < DALCS_SPANS) {
        known = part->length.span[part->length.n_spans++] = span;
    }
    return known > 0.0 ? known : h;
}

double dalcs_length_promising(const struct dalcs_radau_part *part) {
    const struct dalcs_collocation *m = part->stages.method;
    if (isinf(part->excitation.shortest_period)) {
        return INFINITY;
    }
    double factorial = 1.0;
    for (int k = 2; k <= m->s + 1; k++) {
        factorial *= k;
    }
    double size = m->worst.size * m->worst.factor * m->lambda / factorial;
    double angle = pow(part->inner_tolerance / size, 1.0 / (m->s + 1));
    return angle * part->excitation.shortest_period / dalcs_two_pi;
}

/* Long moves end on every n-th rung, so that searches up and down the ladder meet on the same step
 * lengths, which have their factors already. Towards the shorter step. */
static int shared_rung(int level, int n) {
    int beyond = ((level % n) + n) % n;
    return beyond > 0 ? level + n - beyond : level;
}

void dalcs_length_shorten(struct dalcs_radau_part *part, double ratio, int stuck) {
    double rungs = log2(ratio) / (double)(part->stages.method->s + 1);
    int down = rungs < DALCS_LENGTH_MOST_RUNGS ? (int)ceil(rungs) : DALCS_LENGTH_MOST_RUNGS;
    part->length.level += down > 1 ? down : 1;
    if (stuck > 0) { /* something much faster than the step has to die away */
        int far = stuck == 1 ? 2 : 5;
        part->length.level =
            shared_rung(part->length.level + (far > down ? far - down : 0), LONG_MOVE);
    }
    int patience = part->length.grew ? 2 * part->length.patience : part->length.patience;
    part->length.patience = patience < MOST_PATIENCE ? patience : MOST_PATIENCE;
    part->length.waited = 0;
    part->length.grew = false;
}

double dalcs_length_rungs_promised(const struct dalcs_radau_part *part, double ratio) {
    double rungs = log2(safety / ratio) / (double)(part->stages.method->s + 1);
    /* where the error is rounding of the signal the true one may be far smaller */
    return ratio * part->inner_tolerance < dalcs_rounded ? dalcs_larger(rungs, LONG_MOVE) : rungs;
}

void dalcs_length_lengthen(struct dalcs_radau_part *part, double ratio) {
    double rungs = dalcs_length_rungs_promised(part, ratio);
    bool promising = rungs > 1.0;
    int up = rungs > DALCS_LENGTH_MOST_RUNGS ? DALCS_LENGTH_MOST_RUNGS : promising ? (int)rungs : 1;
    while (up > 0 && dalcs_radau_ladder(part, part->length.level - up) > part->length.longest) {
        up--;
    }
    bool is_held_back = up == 0 && promising;
    while (up > 0 &&
           dalcs_radau_ladder(part, part->length.level - up) > part->length.longest_needed) {
        up--;
    }
    part->length.waited++;
    part->length.grew = false;
    if (up == 0) {
        part->length.held_back += is_held_back ? 1 : 0;
        return;
    }
    int level = up < 2 ? part->length.level - 1
                       : shared_rung(part->length.level - up, up < LONG_MOVE ? 2 : LONG_MOVE);
    bool is_far = level < part->length.level - 1;
    if (!is_far &&
        !(promising ? part->length.waited > 1 : part->length.waited > part->length.patience)) {
        return;
    }
    part->length.level = is_far ? level : part->length.level - 1;
    part->length.waited = 0;
    part->length.grew = !promising;
}

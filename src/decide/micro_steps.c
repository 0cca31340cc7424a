/* micro_steps.c - pairs of micro-steps of implicit Euler, and the states that follow from them. */
#include "micro_steps.h"
#include "doubt.h"
#include "guard_scale.h"
#include "magnitudes.h"
#include "present.h"
#include "restart.h"
#include "rounding.h"
#include "step_error.h"

#include <math.h>
#include <string.h>

/* A micro-step over the step of the ladder: 2^-MICRO. */
enum { MICRO = 20 };

enum dalcs_status dalcs_micro_fail(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                   double sigma, const double *u, enum dalcs_status status) {
    struct dalcs_euler *e = r->base;
    part->component->failure.sigma = sigma;
    part->component->failure.u = u;
    part->component->failure.restless.pair = -1;
    e->failure.system = part->index;
    e->failure.time = part->segment.t;
    e->failure.h = 1.0 / sigma;
    return status;
}

/* What the control of a watched switch may be off by: its guard, but for what only a step tells. */
static double slack_of(const struct dalcs_radau_part *part, int guard) {
    return dalcs_beyond * part->inner_tolerance *
               dalcs_guard_control_scale(part, guard, part->scales.unit) +
           dalcs_guard_most_rounding(part, guard, part->scales.unit);
}

/* Switches whose control reads the circuit. all: those with hysteresis move, too; in micro-steps they stand as they
 * are, see dalcs_search_change_mode(). */
void dalcs_micro_positions(struct dalcs_radau_part *part, bool all) {
    struct dalcs_positions *p = &part->component->positions;
    int n_pairs = part->component->system->n_pairs;
    p->keeps = !all;
    for (int i = 0; i < p->n; i++) {
        p->slack[i] = part->segment.t > 0.0 ? slack_of(part, n_pairs + i) : 0.0;
    }
}

enum dalcs_status dalcs_radau_implicit_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                            double h, double tau, const double *state, double *y) {
    struct dalcs_component *c = part->component;
    const struct dalcs_system *s = c->system;
    double sigma = s->n_x > 0 ? 1.0 / h : 0.0;
    memmove(part->work.u, state, (size_t)s->n_x * sizeof(double));
    dalcs_excitation_inputs(&part->excitation, part->segment.t, tau, part->work.u + s->n_x);
    enum dalcs_status status = dalcs_positions_solve(&c->positions, sigma, part->work.u, y);
    if (status != DALCS_OK) {
        return dalcs_micro_fail(r, part, sigma, part->work.u, status);
    }
    DALCS_TRY(dalcs_positions_part_led(&c->positions, sigma, part->work.u, y));
    part->guards.slides = part->guards.slides || !c->positions.settled;
    if (c->osnsp.certificate.worst > r->base->worst.certificate.worst) {
        r->base->worst.certificate = c->osnsp.certificate;
        r->base->worst.time = part->segment.t;
        r->base->worst.system = part->index;
    }
    return DALCS_OK;
}

/* V, A: the largest so far, and of the states. */
void dalcs_micro_largest(const struct dalcs_radau_part *part, double *largest) {
    const struct dalcs_system *s = part->component->system;
    largest[0] = part->scales.unit[0];
    largest[1] = part->scales.unit[1];
    for (int x = 0; x < s->n_x; x++) {
        int of = s->column_is_current[x];
        largest[of] = fmax(largest[of], fabs(part->x[x]));
    }
}

/* V, A: and of what sources and thresholds drive, in the inputs of the last micro-step. */
void dalcs_micro_raise_to_drives(const struct dalcs_radau_part *part, double *largest) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    for (int k = 0; k < p->lists.n_drives; k++) {
        const struct dalcs_drive *d = &p->lists.drive[k];
        double *of = &largest[d->is_current];
        *of = fmax(*of, d->coefficient * fabs(part->work.u[d->input]));
    }
}

/* V or A: a state that changes by less has not: rounding of the largest of its unit, or what rounding of the other unit
 * drives. */
double dalcs_micro_rounding(const struct dalcs_radau_part *part, int of, const double *largest) {
    return fmax(dalcs_sum_rounded * largest[of], dalcs_step_crossed(part, of, largest));
}

/* V, A: no less than |y[0..n-1]|. */
void dalcs_micro_raise(const struct dalcs_system *s, const double *y, int n, double *largest) {
    for (int c = 0; c < n; c++) {
        double *of = &largest[s->column_is_current[c]];
        *of = fmax(*of, fabs(y[c]));
    }
}

double dalcs_micro_noticeable(const struct dalcs_radau_part *part) {
    return fmax(1.0 / dalcs_small * part->inner_tolerance,
                dalcs_alike); /* what an event's state may be off by */
}

/* The states just after part->segment.t from the micro-steps y1 and y2. Does any jump, and by more than the
 * error that the state of an event has? A fast transient moves in both micro-steps and is left to be
 * stepped through. It may hide a jump, or the mode that it is in: *closer is how short micro-steps that
 * show it are, over these. */
bool dalcs_micro_extrapolate(const struct dalcs_radau_part *part, double *after, bool *noticeable,
                             double *closer) {
    const struct dalcs_system *s = part->component->system;
    double largest[2];
    dalcs_micro_largest(part, largest);
    dalcs_micro_raise(s, part->work.y1, s->n_x, largest);
    /* What the second one has of voltages and currents: the first one's hold the impulses of a jump over h, or what
     * reads them. */
    dalcs_micro_raise(s, part->work.y2, dalcs_system_n_equations(s), largest);
    double smallest = dalcs_micro_noticeable(part);
    double driven[2] = {largest[0], largest[1]};
    dalcs_micro_raise_to_drives(part, driven);
    const double nothing[2] = {dalcs_micro_rounding(part, 0, driven),
                               dalcs_micro_rounding(part, 1, driven)};
    bool jumps = false;
    *noticeable = false;
    *closer = 1.0;
    for (int x = 0; x < s->n_x; x++) {
        double first = fabs(part->work.y1[x] - part->x[x]);
        double second = fabs(part->work.y2[x] - part->work.y1[x]);
        double scale = largest[s->column_is_current[x]];
        bool moved = first > dalcs_beyond * second && first > nothing[s->column_is_current[x]];
        jumps = jumps || moved;
        *noticeable = *noticeable || (moved && first > smallest * scale);
        bool dies_away = !moved && second < (1.0 - dalcs_slight) * first;
        if (dies_away && first > smallest * scale) {
            *closer = ldexp(1.0, -DALCS_FAR_SHORTER);
        } else if (dies_away && first > dalcs_beyond * part->inner_tolerance * scale) {
            /* in a much shorter one an event's error would weigh more than what the circuit does */
            *closer = fmin(*closer, dalcs_slight);
        }
        after[x] = 2.0 * part->work.y1[x] - part->work.y2[x];
    }
    return jumps;
}

/* A regular current changes little in a micro-step, an impulse, which may be negative in a switch, goes. */
static bool goes(double change, double first) {
    return change * first > 0.5 * first * first;
}

/* The impulses of the micro-steps y1 and y2 of length h. */
void dalcs_micro_impulses(struct dalcs_radau *r, const struct dalcs_radau_part *part, double h) {
    struct dalcs_euler *e = r->base;
    const struct dalcs_system *s = part->component->system;
    int n_equations = dalcs_system_n_equations(s);
    for (int d = 0; d < s->n_pairs; d++) {
        double charge = h * (part->work.y1[n_equations + d] - part->work.y2[n_equations + d]);
        double flux = h * (part->work.w1[d] - part->component->osnsp.w[d]);
        e->charge[d] = goes(charge, h * part->work.y1[n_equations + d]) ? charge : 0.0;
        e->flux[d] = goes(flux, h * part->work.w1[d]) ? flux : 0.0;
    }
    memcpy(e->after, part->work.after, (size_t)s->n_x * sizeof(double));
}

double dalcs_radau_micro_length(const struct dalcs_radau *r, const struct dalcs_radau_part *part,
                                int longer) {
    double h = r->options.fixed_step > 0.0
                   ? ldexp(r->options.fixed_step, -MICRO)
                   : dalcs_radau_ladder(part, (part->length.level & ~3) + MICRO);
    h = ldexp(h, 5 * longer);
    /* clear of the next edge: on the flank of a fast source more may happen than at t */
    double room = dalcs_radau_limit(r, part) - part->segment.t;
    double most = fmin(0.25, ldexp(1.0, 5 * longer - DALCS_FAR_SHORTER)) * room;
    for (int k = 0; k < 8 && h > most; k++) {
        h *= 0.0625;
    }
    return h;
}

/* y1 and y2 by two micro-steps of length h, in each of which sources go on by tau. */
enum dalcs_status dalcs_micro_pair(struct dalcs_radau *r, struct dalcs_radau_part *part, double h,
                                   double tau) {
    struct dalcs_component *c = part->component;
    r->restarts++;
    dalcs_micro_positions(part, false);
    DALCS_TRY(dalcs_radau_implicit_step(r, part, h, tau, part->x, part->work.y1));
    memcpy(part->work.w1, c->osnsp.w, (size_t)c->system->n_pairs * sizeof(double));
    memcpy(part->work.mode_first, c->osnsp.mode, (size_t)c->osnsp.n_words * sizeof(uint64_t));
    DALCS_TRY(dalcs_radau_implicit_step(r, part, h, 2.0 * tau, part->work.y1, part->work.y2));
    /* What jumps at the instant has jumped in y2: increments of the next step over it are small, and their rounding is. */
    dalcs_stages_stay_near(&part->stages, c->osnsp.mode, part->work.y2);
    return DALCS_OK;
}

enum dalcs_status dalcs_micro_steps(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                    double h) {
    return dalcs_micro_pair(r, part, h, h);
}

/* Where a source jumps, as on a steep flank: a switch that remembers and opens on it does so before a state has jumped
 * through it. */
enum dalcs_status dalcs_micro_leap(struct dalcs_radau *r, struct dalcs_radau_part *part, double h,
                                   const uint64_t *before) {
    struct dalcs_component *c = part->component;
    const size_t bytes = (size_t)c->osnsp.n_words * sizeof(uint64_t);
    memcpy(c->osnsp.mode, before, bytes);
    dalcs_micro_positions(part, true);
    enum dalcs_status status = dalcs_radau_implicit_step(r, part, h, h, part->x, part->work.y1);
    if (status < DALCS_OK) {
        return status;
    }
    if (status != DALCS_OK || !c->positions.settled) { /* they turn behind the jump */
        part->guards.slides = false;
        memcpy(c->osnsp.mode, before, bytes);
    }
    return dalcs_micro_steps(r, part, h);
}

/* restart.c - micro-steps of implicit Euler where a mode is not known or a state may jump.
 *
 * A first micro-step takes a state that the mode does not allow to one that it does (a jump, or the
 * interpolation error of an event); from there a second one sees how the circuit goes on. The jump is
 * the limit of vanishing steps, which for passive circuits is the projection in the energy norm
 * (Heemels, Schumacher and Weiland 1999; Brogliato 2022, sec. 4). */
#include "restart.h"
#include "doubt.h"
#include "guard_scale.h"
#include "present.h"
#include "recurrence.h"
#include "slide.h"
#include "step_error.h"

#include <math.h>
#include <string.h>

/* A micro-step over the step of the ladder: 2^-MICRO. */
enum { MICRO = 20, LONGER_TRIES = 4 };

/* States that move in the first micro-step by more than this many times the second have jumped. */
static const double jump_ratio = 4.0;

/* States that move in the second by less than this part of the first, and more than jump_ratio says, may
 * have jumped by what a fast transient hides. */
static const double steady = 0.99;

/* A micro-step over a longer one that it is compared with, and how much farther a state goes in it that
 * has no limit. */
static const double shorter = 1.0 / 1024.0, runaway = 4.0;

/* The same where a small transient may hide its mode: in a much shorter one an event's error would weigh
 * more than what the circuit does. So many inner tolerances are no such error. */
static const double a_little_shorter = 1.0 / 32.0, beyond_error = 10.0;

/* States that move by less, over the largest of their unit, have not jumped; by still less, not at all. */
static const double smallest_jump = 1e-9, rounding = 1e-15;

/* A state this small after a jump, over the largest of its unit before, is 0. */
static const double remainder_of_jump = 1e-12;

static enum dalcs_status fail(struct dalcs_radau *r, struct dalcs_radau_part *part, double sigma,
                              const double *u, enum dalcs_status status) {
    struct dalcs_euler *e = r->base;
    part->component->failed_sigma = sigma;
    part->component->failed_u = u;
    e->failed_system = part->index;
    e->failed_time = part->segment.t;
    e->failed_h = 1.0 / sigma;
    return status;
}

/* What the control of a watched switch may be off by: its guard, but for what only a step tells. */
static double slack_of(const struct dalcs_radau_part *part, int guard) {
    return dalcs_doubts_over_tolerance * part->inner_tolerance *
               dalcs_guard_control_scale(part, guard, part->scales.unit) +
           dalcs_guard_most_rounding(part, guard, part->scales.unit);
}

/* Switches whose control reads the circuit. all: those with hysteresis move, too; in micro-steps they stand as they
 * are, see dalcs_search_change_mode(). */
static void prepare_positions(struct dalcs_radau_part *part, bool all) {
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
        return fail(r, part, sigma, part->work.u, status);
    }
    part->guards.slides = part->guards.slides || !c->positions.settled;
    if (c->osnsp.certificate.worst > r->base->worst.worst) {
        r->base->worst = c->osnsp.certificate;
        r->base->worst_time = part->segment.t;
        r->base->worst_system = part->index;
    }
    return DALCS_OK;
}

/* V, A: the largest so far, and of the states. */
static void find_largest(const struct dalcs_radau_part *part, double *largest) {
    const struct dalcs_system *s = part->component->system;
    largest[0] = part->scales.unit[0];
    largest[1] = part->scales.unit[1];
    for (int x = 0; x < s->n_x; x++) {
        int of = s->column_is_current[x];
        largest[of] = fmax(largest[of], fabs(part->x[x]));
    }
}

/* V, A: and of what sources and thresholds drive, in the inputs of the last micro-step. */
static void raise_to_drives(const struct dalcs_radau_part *part, double *largest) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    for (int k = 0; k < p->n_drives; k++) {
        const struct dalcs_drive *d = &p->drive[k];
        double *of = &largest[d->is_current];
        *of = fmax(*of, d->coefficient * fabs(part->work.u[d->input]));
    }
}

/* V or A: a state that changes by less has not: rounding of the largest of its unit, or what rounding of the other unit
 * drives. */
static double rounding_of(const struct dalcs_radau_part *part, int of, const double *largest) {
    return fmax(rounding * largest[of], dalcs_step_crossed(part, of, largest));
}

/* V, A: no less than |y[0..n-1]|. */
static void raise_largest(const struct dalcs_system *s, const double *y, int n, double *largest) {
    for (int c = 0; c < n; c++) {
        double *of = &largest[s->column_is_current[c]];
        *of = fmax(*of, fabs(y[c]));
    }
}

/* The states just after part->segment.t from the micro-steps y1 and y2. Does any jump, and by more than the
 * error that the state of an event has? A fast transient moves in both micro-steps and is left to be
 * stepped through. It may hide a jump, or the mode that it is in: *closer is how short micro-steps that
 * show it are, over these. */
static bool extrapolate(const struct dalcs_radau_part *part, double *after, bool *noticeable,
                        double *closer) {
    const struct dalcs_system *s = part->component->system;
    double largest[2];
    find_largest(part, largest);
    raise_largest(s, part->work.y1, s->n_x, largest);
    /* What the second one has of voltages and currents: the first one's hold the impulses of a jump over h, or what
     * reads them. */
    raise_largest(s, part->work.y2, dalcs_system_n_equations(s), largest);
    double smallest = fmax(1e3 * part->inner_tolerance, smallest_jump);
    double driven[2] = {largest[0], largest[1]};
    raise_to_drives(part, driven);
    const double nothing[2] = {rounding_of(part, 0, driven), rounding_of(part, 1, driven)};
    bool jumps = false;
    *noticeable = false;
    *closer = 1.0;
    for (int x = 0; x < s->n_x; x++) {
        double first = fabs(part->work.y1[x] - part->x[x]);
        double second = fabs(part->work.y2[x] - part->work.y1[x]);
        double scale = largest[s->column_is_current[x]];
        bool moved = first > jump_ratio * second && first > nothing[s->column_is_current[x]];
        jumps = jumps || moved;
        *noticeable = *noticeable || (moved && first > smallest * scale);
        bool dies_away = !moved && second < steady * first;
        if (dies_away && first > smallest * scale) {
            *closer = shorter;
        } else if (dies_away && first > beyond_error * part->inner_tolerance * scale) {
            *closer = fmin(*closer, a_little_shorter);
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
static void extrapolate_impulses(struct dalcs_radau *r, const struct dalcs_radau_part *part,
                                 double h) {
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
    double most = fmin(0.25, ldexp(shorter, 5 * longer)) * room;
    for (int k = 0; k < 8 && h > most; k++) {
        h *= 0.0625;
    }
    return h;
}

/* y1 and y2 by two micro-steps of length h, in each of which sources go on by tau. */
static enum dalcs_status pair_of_steps(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                       double h, double tau) {
    struct dalcs_component *c = part->component;
    r->restarts++;
    prepare_positions(part, false);
    DALCS_TRY(dalcs_radau_implicit_step(r, part, h, tau, part->x, part->work.y1));
    memcpy(part->work.w1, c->osnsp.w, (size_t)c->system->n_pairs * sizeof(double));
    long pivots = c->osnsp.counters.pivots;
    DALCS_TRY(dalcs_radau_implicit_step(r, part, h, 2.0 * tau, part->work.y1, part->work.y2));
    part->guards.seen = c->osnsp.counters.pivots == pivots ? h : INFINITY;
    return DALCS_OK;
}

static enum dalcs_status micro_steps(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     double h) {
    return pair_of_steps(r, part, h, h);
}

/* Where a component is not passive, a state may jump although another one runs away, the farther the
 * shorter the micro-step: the derivative of an impulse. */
static enum dalcs_status check_limit(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     double h) {
    const struct dalcs_system *s = part->component->system;
    double *longer = r->base->after;
    double largest[2];
    bool jumps = false;
    bool runs_away = false;
    memcpy(longer, part->work.y1, (size_t)s->n_x * sizeof(double));
    DALCS_TRY(micro_steps(r, part, shorter * h));
    find_largest(part, largest);
    raise_largest(s, longer, s->n_x, largest);
    for (int x = 0; x < s->n_x; x++) {
        double before = fabs(longer[x] - part->x[x]);
        double now = fabs(part->work.y1[x] - part->x[x]);
        bool stays = fabs(part->work.y1[x] - longer[x]) < 0.5 * now;
        bool moves = now > smallest_jump * largest[s->column_is_current[x]];
        jumps = jumps || (moves && stays);
        runs_away = runs_away || (moves && now > runaway * before);
    }
    if (jumps && runs_away) {
        dalcs_osnsp_blame_states(&part->component->osnsp, part->x, longer, part->work.y1);
        memcpy(part->work.u, part->x, (size_t)s->n_x * sizeof(double));
        dalcs_excitation_inputs(&part->excitation, part->segment.t, 0.0, part->work.u + s->n_x);
        return fail(r, part, 1.0 / h, part->work.u, DALCS_INFEASIBLE);
    }
    return micro_steps(r, part, h);
}

/* Does the exact jump move a state by more than the error that the state of an event has? */
static bool is_noticeable(const struct dalcs_radau *r, const struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    const double *after = r->base->jump.after;
    double smallest = fmax(1e3 * part->inner_tolerance, smallest_jump);
    bool noticeable = false;
    for (int x = 0; x < s->n_x && !noticeable; x++) {
        double scale = fmax(part->scales.unit[s->column_is_current[x]],
                            fmax(fabs(part->x[x]), fabs(after[x])));
        noticeable = fabs(after[x] - part->x[x]) > smallest * scale;
    }
    return noticeable;
}

static enum dalcs_status find_jump(struct dalcs_radau *r, struct dalcs_radau_part *part, double h) {
    const struct dalcs_system *s = part->component->system;
    extrapolate_impulses(r, part, h);
    memcpy(part->work.u, part->x, (size_t)s->n_x * sizeof(double));
    dalcs_excitation_inputs(&part->excitation, part->segment.t, 0.0, part->work.u + s->n_x);
    return dalcs_euler_find_jump(r->base, part->index, part->work.u);
}

/* What is left of a state that falls to 0, or of one that stays there, is as small as a certificate
 * allows: it is 0, for where nothing else is it would be a signal. */
static void drop_remainders(const struct dalcs_radau_part *part, double *after) {
    const struct dalcs_system *s = part->component->system;
    double largest[2];
    find_largest(part, largest);
    for (int x = 0; x < s->n_x; x++) {
        bool is_moved = fabs(after[x] - part->x[x]) > 0.5 * fabs(after[x]);
        if (is_moved && fabs(after[x]) < remainder_of_jump * largest[s->column_is_current[x]]) {
            after[x] = 0.0;
        }
    }
}

/* The change of each state that is not worth a word: what is left of it where it falls to 0, over its own scale, or
 * rounding. */
static void find_noise(const struct dalcs_radau_part *part, const double *after, double *noise) {
    const struct dalcs_system *s = part->component->system;
    double largest[2];
    find_largest(part, largest);
    raise_to_drives(part, largest);
    for (int x = 0; x < s->n_x; x++) {
        double own = fmax(dalcs_step_scale(part, x, part->scales.unit),
                          fmax(fabs(part->x[x]), fabs(after[x])));
        noise[x] =
            fmax(remainder_of_jump * own, rounding_of(part, s->column_is_current[x], largest));
    }
}

/* All columns at the end of the segment that ended at part->segment.t, into part->work.y2; NULL at the start. */
static const double *columns_before(struct dalcs_radau_part *part) {
    if (!(part->segment.t > 0.0)) {
        return NULL;
    }
    dalcs_recurrence_complete_before(part);
    dalcs_radau_swap_out(part, &part->segment.out_before);
    dalcs_step_values(part, part->segment.end_before, part->work.y2);
    dalcs_radau_swap_out(part, &part->segment.out_before);
    return part->work.y2;
}

static enum dalcs_status take_jump(struct dalcs_radau *r, struct dalcs_radau_part *part) {
    struct dalcs_euler *e = r->base;
    e->t = part->segment.t;
    drop_remainders(part, e->jump.after);
    find_noise(part, e->jump.after, e->noise);
    DALCS_TRY(dalcs_euler_report_jump(e, part->index, part->segment.t, part->x,
                                      columns_before(part), part->work.y1));
    memcpy(part->x, e->jump.after, (size_t)part->component->system->n_x * sizeof(double));
    part->segment.jumped = true;
    return DALCS_OK;
}

/* A jump that no problem without time tells is what micro-steps of length h see of it with the sources as they are just
 * behind it: where they fall at once, the state would follow them for a while only. */
static enum dalcs_status take_seen_jump(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                        double h) {
    bool noticeable;
    double closer;
    enum dalcs_status status = pair_of_steps(r, part, h, 0.0);
    if (status == DALCS_OK && extrapolate(part, part->work.after, &noticeable, &closer)) {
        DALCS_TRY(find_jump(r, part, h));
    }
    DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
    DALCS_TRY(micro_steps(r, part, h)); /* for the mode */
    return take_jump(r, part);
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
    if (!dalcs_osnsp_is_monotone(&part->component->osnsp)) {
        DALCS_TRY(check_limit(r, part, h));
    }
    while (moves && noticeable) {
        DALCS_TRY(find_jump(r, part, h));
        if (!e->jump.is_covered) {
            return take_seen_jump(r, part, h);
        }
        bool is_last = shorter * h < 64.0 * r->resolution;
        bool is_whole = e->jump.is_known ? dalcs_jumps_agree(s, part->x, part->work.after,
                                                             part->work.y1, e->jump.after)
                                         : is_last;
        if (is_whole || (e->jump.is_known && is_noticeable(r, part))) {
            DALCS_TRY(take_jump(r, part));
        }
        if (is_whole) {
            return DALCS_OK;
        }
        if (is_last) {
            break;
        }
        enum dalcs_status status = micro_steps(r, part, shorter * h);
        if (status > DALCS_OK) { /* too short for a certificate: the last ones have to do */
            DALCS_TRY(micro_steps(r, part, h));
            moves = extrapolate(part, part->work.after, &noticeable, &closer);
            break;
        }
        DALCS_TRY(status);
        h *= shorter;
        moves = extrapolate(part, part->work.after, &noticeable, &closer);
    }
    bool is_over = moves && noticeable && !e->jump.is_known;
    *moves_little = moves && !is_over;
    if (is_over) {
        dalcs_radau_go_after(r, part);
    }
    return DALCS_OK;
}

/* After micro-steps of length *h in which a transient as fast as they are may have hidden a jump, or the
 * mode that it is in: shorter ones, or, where these have no certificate, the same again. */
static enum dalcs_status look_closer(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                     double closer, double *h, bool *jumps, bool *noticeable) {
    enum dalcs_status status = micro_steps(r, part, closer * *h);
    if (status == DALCS_OK) {
        *h *= closer;
    } else if (status > DALCS_OK) {
        status = micro_steps(r, part, *h);
    }
    DALCS_TRY(status);
    *jumps = extrapolate(part, part->work.after, noticeable, &closer);
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
    part->guards.slides = false;
    for (int k = 0; k < LONGER_TRIES && status > DALCS_OK; k++) {
        h = dalcs_radau_micro_length(r, part, longer + k);
        status = micro_steps(r, part, h);
    }
    DALCS_TRY(status);
    if (s->n_x == 0 || mode_only || part->guards.slides) {
        return DALCS_OK; /* between two sides of a switch nothing that moves is a jump */
    }
    bool noticeable;
    double closer;
    bool jumps = extrapolate(part, part->work.after, &noticeable, &closer);
    if (closer < 1.0 && !noticeable && closer * h >= 64.0 * r->resolution) {
        DALCS_TRY(look_closer(r, part, closer, &h, &jumps, &noticeable));
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

static void fill_out(struct dalcs_radau_part *part, const double *before) {
    const struct dalcs_osnsp *p = &part->component->osnsp;
    const struct dalcs_stage_layout *l = &part->stages.layout;
    int n_columns = dalcs_system_n_columns(p->system);
    int n_equations = dalcs_system_n_equations(p->system);
    double *end = part->segment.out + (l->n_nodes - 1) * l->stride;
    memcpy(end, part->work.y1, (size_t)n_columns * sizeof(double));
    for (int d = 0; d < p->system->n_pairs; d++) {
        end[n_equations + d] += dalcs_osnsp_is_on(p, d) ? 0.0 : p->w[d];
    }
    for (int k = 0; k < l->n_nodes; k++) {
        double *out = part->segment.out + k * l->stride;
        double at = part->stages.method->node[k];
        for (int c = 0; c < n_columns; c++) {
            double start = c < p->system->n_x ? part->x[c] : before != NULL ? before[c] : end[c];
            out[c] = k + 1 < l->n_nodes ? start + at * (end[c] - start) : end[c];
        }
        for (int i = 0; i < part->stages.n_watched; i++) {
            out[n_columns + i] = 0.0;
        }
    }
}

void dalcs_radau_accept_euler(const struct dalcs_radau *r, struct dalcs_radau_part *part, double h,
                              const double *before) {
    double limit = dalcs_radau_limit(r, part);
    fill_out(part, before);
    part->segment.by_euler = true;
    part->segment.h = h;
    part->segment.end = 1.0;
    part->segment.t_end = fmin(part->segment.t + h, limit);
    part->segment.why = part->segment.t_end >= limit ? DALCS_END_AT_EDGE : DALCS_END_OF_STEP;
    part->guards.n_crossed = 0;
    part->guards.fresh = true;
}

enum dalcs_status dalcs_radau_euler_step(struct dalcs_radau *r, struct dalcs_radau_part *part,
                                         double h) {
    struct dalcs_component *c = part->component;
    prepare_positions(part, true);
    DALCS_TRY(dalcs_radau_implicit_step(r, part, h, h, part->x, part->work.y1));
    if (c->positions.alternates) {
        bool slides;
        DALCS_TRY(dalcs_slide_step(r, part, h, &slides));
        if (slides) {
            return DALCS_OK;
        }
        prepare_positions(part, true);
        DALCS_TRY(dalcs_radau_implicit_step(r, part, h, h, part->x, part->work.y1));
    }
    c->delayed_commands += c->positions.settled ? 0 : 1; /* the present command stands */
    const struct dalcs_observer *observer = r->base->observer;
    if (observer != NULL) {
        observer->scale(observer->user, part->index, &c->osnsp.certificate);
        observer->step(observer->user, part->index, part->x, part->work.y1,
                       part->work.u + c->system->n_x, h);
    }
    dalcs_radau_accept_euler(r, part, h, NULL);
    r->euler_steps++;
    return DALCS_OK;
}

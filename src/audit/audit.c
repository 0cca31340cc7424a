/* audit.c - what is looked at, and when. */
#include "audit_crossing.h"
#include "audit_formula.h"
#include "audit_positions.h"

#include "screen.h"

#include <stdlib.h>

static const uint64_t first_seed = 0x9e3779b97f4a7c15u;

enum dalcs_status dalcs_audit_create(struct dalcs_audit **audit,
                                     const struct dalcs_circuit *circuit,
                                     const struct dalcs_audit_options *options,
                                     const struct dalcs_audit_reader *reader) {
    struct dalcs_audit *a = *audit = dalcs_alloc(1, sizeof(*a));
    if (a == NULL) {
        return DALCS_E_NOMEM;
    }
    *a = (struct dalcs_audit){
        .circuit = circuit, .options = *options, .reader = *reader, .seed = first_seed};
    enum dalcs_status status = options->n_parts > 0 ? audit_set_up(a) : DALCS_OK;
    for (int k = 0; k < options->n_parts && status == DALCS_OK; k++) {
        a->part[k].cost = audit_instant_work(&a->part[k]) + options->read_work[k];
        a->budget.credit -=
            AUDIT_LOOK_INSTANTS * a->part[k].cost; /* of its end, which is looked at in any case */
    }
    if (status != DALCS_OK) {
        dalcs_audit_destroy(a);
        *audit = NULL;
    }
    return status;
}

void dalcs_audit_destroy(struct dalcs_audit *audit) {
    if (audit != NULL) {
        for (int k = 0; audit->part != NULL && k < audit->options.n_parts; k++) {
            audit_screen_finish(&audit->part[k]);
        }
        free(audit->net.reads.of);
        dalcs_arena_finish(&audit->arena);
        free(audit);
    }
}

/* ---- What is looked at --------------------------------------------------------------------------- */

/* What the largest values so far are, at the beginning of each look at a stretch. */
static void raise_scales(struct dalcs_audit *audit, int index) {
    audit->reader.raise(audit->reader.user, index, audit->scale.v, audit->scale.i,
                        audit->scale.lambda);
}

static void look(struct dalcs_audit *audit, int index, struct dalcs_audit_state *s) {
    struct audit_part *part = &audit->part[index];
    audit->reader.read(audit->reader.user, index, s);
    audit_note_scales(audit, part, s);
    audit_check_instant(audit, part, s);
    audit->budget.credit -= part->cost;
}

/* Instants in a stretch with --audit full, beside its ends, and pieces that integrals are taken over. */
enum { FULL_INSTANTS = 3, FULL_PIECES = 2, INTERVAL_INSTANTS = 7 };

static bool can_look_inside(const struct dalcs_audit *audit,
                            const struct dalcs_audit_stretch *stretch) {
    return stretch->rule == DALCS_AUDIT_SMOOTH &&
           audit_can_tell_times(&audit->part[stretch->part], stretch->to - stretch->from,
                                stretch->to);
}

/* Where a screen asks for a look, at that time. */
static void look_inside(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    const double asked = audit->part[stretch->part].watch->asked;
    if (asked >= 0.0) {
        audit->state.now.side = DALCS_RIGHT;
        audit->state.now.t = asked;
        look(audit, stretch->part, &audit->state.now);
        audit_check_interval(audit, &audit->part[stretch->part], stretch->from, asked);
        audit->part[stretch->part].was_integrated = true;
        return;
    }
    const int n = audit->options.mode == DALCS_AUDIT_FULL ? FULL_INSTANTS : 1;
    for (int k = 0; k < n; k++) {
        audit->state.now.side = DALCS_RIGHT;
        audit->state.now.t = stretch->from + audit_draw(audit) * (stretch->to - stretch->from);
        look(audit, stretch->part, &audit->state.now);
    }
}

static void integrate(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    struct audit_part *part = &audit->part[stretch->part];
    const double length = stretch->to - stretch->from;
    if (audit->options.mode == DALCS_AUDIT_FULL) {
        for (int k = 0; k < FULL_PIECES; k++) {
            audit_check_interval(audit, part, stretch->from + k * length / FULL_PIECES,
                                 stretch->from + (k + 1) * length / FULL_PIECES);
        }
        return;
    }
    /* of the looks of a sample as many as make intervals take what instants do */
    if (!(INTERVAL_INSTANTS * audit_draw(audit) < AUDIT_LOOK_INSTANTS ||
          (stretch->is_last && part->was_integrated))) {
        return;
    }
    part->was_integrated = true;
    const double from = stretch->from + 0.5 * audit_draw(audit) * length;
    const double to = stretch->to - 0.5 * audit_draw(audit) * length;
    if (from < to) {
        audit_check_interval(audit, part, from, to);
        audit->budget.credit -= INTERVAL_INSTANTS * part->cost;
    }
}

/* The derivative of a polynomial of degree s on an interval of length h is at most 2 s^2/h times its largest value
 * (A. and V. Markov): what rounding of charges makes of currents, and of fluxes of voltages. */
static void take_up(struct audit_part *part, const struct dalcs_audit_stretch *stretch) {
    const double s = stretch->degree;
    part->at.is_coarse = stretch->rule == DALCS_AUDIT_COARSE;
    part->at.step = stretch->step;
    part->at.span = stretch->to - stretch->from;
    part->at.slope = stretch->step > 0.0 ? 2.0 * s * s / stretch->step : 0.0;
}

/* The next stretch begins where that ended, and nobody has looked at it. */
static void leave_behind(struct audit_part *part) {
    part->is_open = false;
    part->watch->saw_beginning = false;
    part->watch->is_put_off = false;
}

/* No screen knows means of two positions. */
static void look_at_means(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    take_up(&audit->part[stretch->part], stretch);
    raise_scales(audit, stretch->part);
    audit->state.now.side = DALCS_RIGHT;
    audit->state.now.t = stretch->from + audit_draw(audit) * (stretch->to - stretch->from);
    look(audit, stretch->part, &audit->state.now);
}

/* A screen is linear: it knows no smooth function. A polynomial may miss one anywhere in a stretch, and all else as before:
 * formulas that read it, and what it puts out. It ends where a formula bends, by what is then known of that. */
static void look_at_formulas(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    const double length = stretch->to - stretch->from;
    take_up(&audit->part[stretch->part], stretch);
    raise_scales(audit, stretch->part);
    audit_look_at_formulas(audit, stretch->part, stretch->from + audit_draw(audit) * length,
                           DALCS_RIGHT);
    audit_look_at_formulas(audit, stretch->part, stretch->to, DALCS_LEFT);
}

/* A stretch that no lane passes. */
static bool asks_otherwise(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    const bool can_look = can_look_inside(audit, stretch);
    if (can_look && stretch->stored == NULL) {
        look_at_means(audit, stretch);
    } else if (can_look && audit->part[stretch->part].has.smooth) {
        look_at_formulas(audit, stretch);
    }
    return audit_watch_asks(audit, stretch);
}

bool dalcs_audit_passes_over(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch,
                             double work) {
    struct audit_part *part = &audit->part[stretch->part];
    audit->count.stretches++;
    part->watch->batch.gathered.is_on = false;
    part->at.past = part->at.length;
    part->at.length = stretch->to - stretch->from;
    part->at.past_coarse = part->at.was_coarse;
    part->at.was_coarse = stretch->rule == DALCS_AUDIT_COARSE;
    part->at.past_undecided = part->at.was_undecided;
    part->at.was_undecided = stretch->is_undecided;
    part->watch->asked = -1.0;
    part->watch->drawn = -1;
    part->at.against = part->at.was_coarse ? part->at.against : 0;
    part->at.is_drawn = audit->options.mode == DALCS_AUDIT_FULL || part->at.against > 0 ||
                        (part->at.was_undecided && part->at.past_undecided) ||
                        (part->at.was_coarse && part->has.formula);
    if (part->at.is_drawn) {
        return false;
    }
    const bool asks = !audit_lane_passes(audit, part, stretch) && asks_otherwise(audit, stretch);
    const uint64_t key = stretch->stored != NULL ? stretch->stored->key : 0;
    part->watch->has_turned =
        part->latches.n > 0 && audit_latches_turn(audit, part, key) && !part->watch->saw_beginning;
    dalcs_audit_earn(audit, work);
    part->at.is_drawn = audit->budget.credit >= audit->budget.threshold;
    const bool passes = !asks && !part->at.is_drawn && !part->watch->has_turned;
    if (passes) {
        leave_behind(part);
        audit_batch_from(audit, part, stretch);
    } else {
        part->watch->batch.image = NULL;
    }
    return passes;
}

void dalcs_audit_put_off(struct dalcs_audit *audit, int index) {
    audit->part[index].watch->is_put_off = true;
    audit->part[index].watch->batch.gathered.is_on = false;
}

/* past: s, the length of the stretch before. */
static void look_at_beginning(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch,
                              double past) {
    struct audit_part *part = &audit->part[stretch->part];
    audit->state.now.t = stretch->from;
    audit->state.now.side = DALCS_RIGHT;
    /* An event is early or late by what changes no value by more than the tolerance: that share of the stretch that it
     * ended, over which values change by their scales at most. A diode may have its signs that much later, and a switch
     * its control. Where a run starts nothing came before, and what acts there does so within what is promised of times. */
    const double least =
        past > 0.0 ? part->tolerance * past : AUDIT_PROMISED * audit->options.resolution;
    part->at.lateness = fmin(least, stretch->to - stretch->from);
    look(audit, stretch->part, &audit->state.now);
    if (part->is_open) {
        audit_check_crossing(audit, part, &audit->state.before, &audit->state.now);
        audit->budget.credit -= part->cost;
    }
    if (!part->has_entered && stretch->from == 0.0) {
        audit_check_start(audit, part, &audit->state.now, stretch->stored);
    }
    part->at.lateness = 0.0;
    part->watch->saw_beginning = true;
    part->has_entered = true;
    part->is_open = false;
}

/* It was passed over, and what came before. */
static void look_back(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    struct audit_part *part = &audit->part[stretch->part];
    if (!part->watch->is_put_off && part->at.past > 0.0) {
        audit->reader.read_before(audit->reader.user, stretch->part, 0.0, &audit->state.before);
        part->is_open = true;
    }
    part->at.from_coarse = part->at.past_coarse;
    look_at_beginning(audit, stretch, part->at.past);
    audit_screen_rescale(audit, part);
}

/* The switches that have changed over where it begins. */
static void look_at_turn(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    struct audit_part *part = &audit->part[stretch->part];
    part->at.from_coarse = part->at.past_coarse;
    audit_check_turns(audit, part, stretch->from);
    audit->budget.spent += part->cost;
}

/* A mode that is new is looked at by the screen that is made of it. */
static bool is_settled(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    const struct audit_part *part = &audit->part[stretch->part];
    return !audit_watch_begins(audit, stretch) && !part->at.is_drawn && !stretch->is_last;
}

/* How it begins is all that is to be looked at. */
static bool has_only_jumped(const struct audit_part *part,
                            const struct dalcs_audit_stretch *stretch) {
    const struct audit_watch *watch = part->watch;
    return watch->asked >= 0.0 && watch->has_jumped && !part->at.is_drawn && !stretch->is_last;
}

void dalcs_audit_leave(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    struct audit_part *part = &audit->part[stretch->part];
    take_up(part, stretch);
    audit->budget.credit -= stretch->first_look;
    raise_scales(audit, stretch->part);
    if (part->watch->has_turned) {
        look_at_turn(audit, stretch);
    }
    const bool is_seen = part->watch->has_turned && !part->watch->makes;
    if ((is_seen && part->watch->asked < 0.0 && !part->at.is_drawn && !stretch->is_last) ||
        (part->watch->makes && is_settled(audit, stretch))) {
        leave_behind(part);
        return;
    }
    if (has_only_jumped(part, stretch)) {
        audit->count.audited++;
        if (!part->watch->saw_beginning) {
            look_back(audit, stretch);
        }
        leave_behind(part);
        return;
    }
    audit->budget.threshold =
        2.0 * (AUDIT_LOOK_INSTANTS * part->cost + stretch->first_look) * audit_draw(audit);
    audit->count.audited++;
    if (part->watch->asked >= 0.0 && !part->watch->saw_beginning) {
        look_back(audit, stretch);
    }
    /* the last one of all is looked at for the scales that the run ends with */
    const bool is_inside = can_look_inside(audit, stretch) &&
                           (part->at.is_drawn || part->watch->asked >= 0.0 || part->was_integrated);
    if (is_inside) {
        look_inside(audit, stretch);
    }
    struct dalcs_audit_state *end = &audit->state.before;
    end->t = stretch->to;
    end->side = DALCS_LEFT;
    look(audit, stretch->part, end);
    if (part->at.is_coarse) {
        audit_check_commutators(audit, part, end);
    }
    if (part->at.is_coarse && part->at.past_coarse && part->at.past > 0.0) {
        audit_check_obeyed(audit, part, end);
    }
    leave_behind(part);
    part->is_open = true;
    if (is_inside) {
        integrate(audit, stretch);
        audit_watch_learn(audit, stretch);
    }
}

void audit_look_again(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    struct audit_part *part = &audit->part[stretch->part];
    if (!dalcs_audit_passes_over(audit, stretch, 0.0)) {
        dalcs_audit_leave(audit, stretch);
        leave_behind(part);
    }
}

void dalcs_audit_enter(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    const int index = stretch->part;
    struct audit_part *part = &audit->part[index];
    if (stretch->rule == DALCS_AUDIT_COARSE) {
        part->is_open = false;
        return;
    }
    take_up(part, stretch);
    raise_scales(audit, index);
    part->at.from_coarse = part->at.was_coarse;
    look_at_beginning(audit, stretch, part->at.length);
}

void dalcs_audit_instant(struct dalcs_audit *audit, int part, double t, enum dalcs_side side,
                         double work) {
    dalcs_audit_earn(audit, work);
    const bool is_first = !audit->part[part].has_entered;
    audit->part[part].has_entered = true;
    if (is_first || audit_is_drawn(audit, audit->part[part].cost)) {
        audit->state.now.t = t;
        audit->state.now.side = side;
        look(audit, part, &audit->state.now);
    }
}

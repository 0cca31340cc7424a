/* changes.c - switches that change over: what their controls say of it.
 *
 * A switch changes over where its control reaches the threshold on that side. What it does then may take the control far
 * beyond, so only the side before the event tells, unless something else happened at that time that may have moved the
 * control: a source has an edge, or another switch or a diode was where it changes over, too. A step of implicit Euler ends
 * before what it ends at. */
#include "audit_formula.h"
#include "audit_positions.h"
#include "watch.h"

/* By how much a control is short of the threshold behind which a switch closes, or opens. */
static double short_of(const struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                       int device, bool closes) {
    double half_width;
    const double control = audit_control(audit, s, device, &half_width);
    return half_width + (closes ? -control : control);
}

/* The same where it changes over. One whose valve is at the end of its current opens above the lower threshold, but not
 * above the upper one, where its gate holds it. */
static double short_of_change(const struct dalcs_audit *audit, const struct audit_part *part,
                              const struct dalcs_audit_state *before, int device, bool closes) {
    const int valve = audit->circuit->device[device].valve;
    double scale[2];
    if (closes || valve < 0) {
        return short_of(audit, before, device, closes);
    }
    audit_diode_scale(audit, part, valve, scale);
    if (fabs(before->i[valve]) > part->tolerance * scale[1]) {
        return short_of(audit, before, device, closes);
    }
    double half_width;
    const double control = audit_control(audit, before, device, &half_width);
    return control - half_width;
}

/* ---- Causes -------------------------------------------------------------------------------------- */

static bool sources_bend(const struct dalcs_audit *audit, double t) {
    const struct dalcs_circuit *c = audit->circuit;
    const double near = 4.0 * audit->options.resolution;
    bool bend = false;
    for (int k = 0; k < c->n_stimuli && !bend; k++) {
        const struct dalcs_stimulus *s = &c->stimulus[k];
        bend = s->kind != DALCS_STIMULUS_DC && dalcs_stimulus_next_edge(s, t - near) <= t + near;
    }
    return bend;
}

/* Is a diode where it changes over? It carries next to nothing, and stands next to its knee. */
static bool is_at_corner(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *s, int device) {
    const struct dalcs_device *d = &audit->circuit->device[device];
    const struct dalcs_diode_model *m = &audit->circuit->models.of_diode[d->model];
    double scale[2];
    audit_diode_scale(audit, part, device, scale);
    const double v = audit_voltage(s, d);
    const double own = s->i[device] - (isfinite(m->roff) ? v / m->roff : 0.0);
    const bool is_at_knee = fabs(v - m->vfwd) <= part->tolerance * scale[0] ||
                            (isfinite(m->vrev) && fabs(v + m->vrev) <= part->tolerance * scale[0]);
    return is_at_knee && fabs(own) <= part->tolerance * scale[1];
}

/* Is a switch where it changes over? Its control is known to what it moves by within the resolution of time. */
static bool is_at_threshold(struct dalcs_audit *audit, const struct audit_part *part,
                            const struct dalcs_audit_state *before,
                            const struct dalcs_audit_state *after, int device) {
    const double off = short_of(audit, before, device, !before->is_closed[device]);
    const double allowed = part->tolerance * audit_control_scale(audit, part, device);
    return off <= allowed || off <= allowed + audit_control_slack(audit, part, after, device);
}

/* Has something else happened that may have moved what controls a switch? */
static bool has_other_cause(struct dalcs_audit *audit, const struct audit_part *part,
                            const struct dalcs_audit_state *before,
                            const struct dalcs_audit_state *after, int but) {
    bool has = sources_bend(audit, before->t);
    for (int k = 0; k < part->n_devices && !has; k++) {
        const int device = part->device[k];
        const struct dalcs_device *d = &audit->circuit->device[device];
        if (d->behaviour != NULL) {
            has = d->behaviour->n_pairs > 0 && d->behaviour->smooth == NULL &&
                  audit_behaviour_may_turn(audit, part, before, device);
        } else if (d->kind == DALCS_DIODE) {
            has = is_at_corner(audit, part, before, device);
        } else if (d->kind == DALCS_SWITCH && device != but) {
            has = is_at_threshold(audit, part, before, after, device);
        }
    }
    return has;
}

bool dalcs_audit_has_cause(struct dalcs_audit *audit, int index, double t, bool begins) {
    struct dalcs_audit_state *before = &audit->state.later, *after = &audit->state.now;
    before->t = after->t = t;
    before->side = DALCS_LEFT;
    after->side = DALCS_RIGHT;
    if (begins) {
        audit->reader.read_before(audit->reader.user, index, 0.0, before);
    } else {
        audit->reader.read(audit->reader.user, index, before);
    }
    audit->reader.read(audit->reader.user, index, after);
    return has_other_cause(audit, &audit->part[index], before, after, -1);
}

/* ---- Changes ------------------------------------------------------------------------------------- */

/* How far a control moved just before an event, or moves just behind it, while times cannot be told apart: with 0.1 ohm and
 * 1 fF by 0.3 of its scale in 2^-50 of 1 ms. */
static double slack_at_change(struct dalcs_audit *audit, const struct audit_part *part,
                              const struct dalcs_audit_state *before,
                              const struct dalcs_audit_state *after, int device) {
    double half_width;
    double moved = 0.0;
    if (!part->at.from_coarse) {
        audit->reader.read_before(audit->reader.user, (int)(part - audit->part),
                                  audit->options.resolution, &audit->state.shifted);
        moved = fabs(audit_control(audit, &audit->state.shifted, device, &half_width) -
                     audit_control(audit, before, device, &half_width));
    }
    return moved + audit_control_slack(audit, part, after, device);
}

/* Not where the control may have been beyond it in between: what it jumps to while others change sides one after the
 * other, a latch keeps. Thyristors open so: the diode blocks, then the voltage opens the latch, which takes it back. */
void audit_check_changes(struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *before,
                         const struct dalcs_audit_state *after) {
    for (int k = 0; k < part->n_devices && !part->has.formula; k++) {
        const int device = part->device[k];
        if (audit->circuit->device[device].kind != DALCS_SWITCH ||
            before->is_closed[device] == after->is_closed[device]) {
            continue;
        }
        const bool closes = after->is_closed[device];
        double off = short_of_change(audit, part, before, device, closes);
        const double scale = audit_control_scale(audit, part, device);
        if (off > part->tolerance * scale &&
            (part->at.from_coarse || has_other_cause(audit, part, before, after, device))) {
            off = audit_remembers(audit->circuit, device) && !audit_is_commanded(audit, device)
                      ? 0.0
                      : fmin(off, short_of(audit, after, device, closes));
        }
        off -= off > 0.0 ? slack_at_change(audit, part, before, after, device) : 0.0;
        audit_find(audit, part, DALCS_AUDIT_POSITION, device, off, scale, after->t);
        audit->count.positions++;
    }
}

/* Beyond the threshold on whose other side the switch stands. */
static double contradicts(struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *s, int device) {
    double half_width;
    const double control = audit_control(audit, s, device, &half_width);
    const double wrong = s->is_closed[device] ? -half_width - control : control - half_width;
    return wrong > 0.0 ? wrong - audit_control_slack(audit, part, s, device) : wrong;
}

/* How far a switch stood against its control over the whole step, but for what the control moved in it: so much may a step
 * of implicit Euler be off. */
static double stays_against(struct dalcs_audit *audit, const struct audit_part *part,
                            const struct dalcs_audit_state *begin,
                            const struct dalcs_audit_state *end, int device) {
    const bool stays = audit->circuit->device[device].kind == DALCS_SWITCH &&
                       !begin->is_mean[device] && !end->is_mean[device] &&
                       begin->is_closed[device] == end->is_closed[device];
    if (!stays) {
        return 0.0;
    }
    double half_width;
    const double moved = fabs(audit_control(audit, end, device, &half_width) -
                              audit_control(audit, begin, device, &half_width));
    return fmin(contradicts(audit, part, begin, device), contradicts(audit, part, end, device)) -
           moved;
}

/* A switch is wrong by so much, at `end` of a step. */
static void find_against(struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *end, int device, double off) {
    struct audit_worst *worst = &audit->worst_of[DALCS_AUDIT_POSITION][device];
    const double before = worst->defect;
    audit_find(audit, part, DALCS_AUDIT_POSITION, device, off,
               audit_control_scale(audit, part, device), end->t);
    worst->stays = worst->stays || worst->defect > before;
}

/* Behind a step in which no position suits some switch another one: a switch that is late by a step is not any more. */
static void check_undecided(struct dalcs_audit *audit, const struct audit_part *part,
                            const struct dalcs_audit_state *end) {
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        if (audit->circuit->device[device].kind == DALCS_SWITCH && !end->is_mean[device]) {
            find_against(audit, part, end, device,
                         fmax(0.0, contradicts(audit, part, end, device)));
        }
    }
}

void audit_check_obeyed(struct dalcs_audit *audit, struct audit_part *part,
                        const struct dalcs_audit_state *end) {
    const struct dalcs_audit_state *begin = &audit->state.shifted;
    const int before = part->at.against - 1;
    double most = part->tolerance;
    audit->reader.read_before(audit->reader.user, (int)(part - audit->part), 0.0,
                              &audit->state.shifted);
    part->at.is_coarse = false;
    part->at.against = 0;
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        const double off = stays_against(audit, part, begin, end, device);
        if (device == before) {
            find_against(audit, part, end, device, off);
        }
        const double ratio =
            off > 0.0 ? audit_ratio(off, audit_control_scale(audit, part, device)) : 0.0;
        if (ratio > most) {
            most = ratio;
            part->at.against = device + 1;
        }
    }
    if (part->at.was_undecided && part->at.past_undecided) {
        check_undecided(audit, part, end);
    }
    part->at.is_coarse = true;
}

void audit_check_commutators(struct dalcs_audit *audit, struct audit_part *part,
                             const struct dalcs_audit_state *end) {
    part->at.is_coarse = false;
    for (int k = 0; k < part->n_devices; k++) {
        const int device = part->device[k];
        if (dalcs_element_is_commutator(audit->circuit->device[device].name) &&
            !end->is_mean[device]) {
            audit_find(audit, part, DALCS_AUDIT_POSITION, device,
                       fmax(0.0, contradicts(audit, part, end, device)),
                       audit_control_scale(audit, part, device), end->t);
        }
    }
    part->at.is_coarse = true;
}

/* Most have reached their thresholds before: then nothing else is read. */
void audit_check_turns(struct dalcs_audit *audit, const struct audit_part *part, double t) {
    const int index = (int)(part - audit->part);
    const struct dalcs_audit_reader *r = &audit->reader;
    bool reach = true;
    r->read_before(r->user, index, 0.0, &audit->state.before);
    for (int k = 0; k < part->latches.n && reach; k++) {
        const int device = part->latches.device[k];
        if (part->latches.has_turned[k]) {
            const bool closes = r->is_on(r->user, index, device, 0);
            reach = short_of(audit, &audit->state.before, device, closes) <=
                    AUDIT_ROUNDING * audit_control_scale(audit, part, device);
            audit->count.positions += reach ? 1 : 0;
        }
    }
    if (!reach) {
        audit->state.now.t = t;
        audit->state.now.side = DALCS_RIGHT;
        r->read(r->user, index, &audit->state.now);
        audit_check_changes(audit, part, &audit->state.before, &audit->state.now);
    }
}

/* One that sources alone move is asked while the run can afford it: guards.c asks for the thresholds behind it. */
static bool is_asked(const struct dalcs_audit *audit, int device) {
    return !audit_is_commanded(audit, device) || audit->budget.credit >= 0.0;
}

bool audit_latches_turn(struct dalcs_audit *audit, struct audit_part *part, uint64_t key) {
    struct audit_watch *watch = part->watch;
    bool turn = false;
    if (key != 0 && key == watch->before.key) {
        return false;
    }
    watch->before.key = key;
    for (int k = 0; k < part->latches.n; k++) {
        const int device = part->latches.device[k];
        const bool now =
            audit->reader.is_on(audit->reader.user, (int)(part - audit->part), device, 0);
        part->latches.has_turned[k] = now != part->latches.was_closed[k] && is_asked(audit, device);
        turn = turn || part->latches.has_turned[k];
        part->latches.was_closed[k] = now;
    }
    turn = turn && watch->before.knows_sides && !watch->is_put_off && !part->has.formula;
    watch->before.knows_sides = part->latches.n > 0;
    return turn;
}

/* watch.c - each stretch is asked by a screen, and looked at where that asks for it. */
#include "screen.h"

/* Stretches that a screen rests after an alarm that was false and stays: twice as many each time, up to 2 to this power. */
enum { MOST_DOUBLINGS = 16 };

/* So many alarms of a screen are looked at whatever they cost, and a jump of states that leads into its mode and is more
 * than twice as large as those that were looked at. What was found would have ended the run; more, which are false, and
 * states that jump in each period, are looked at while the run can afford it. */
enum { FEW_ALARMS = 4 };

/* At one of the watch's times, by an image of such steps where there is one. The values have to reach from one end of the
 * stretch to the other. Times are known to their resolution, and events to what changes no value by more than the
 * tolerance: so near an end is as good as there. */
static void ask(struct dalcs_audit *audit, struct audit_screen *screen,
                const struct dalcs_audit_stretch *stretch, struct audit_answer *answer) {
    const struct dalcs_audit_polynomials *p = stretch->stored;
    const struct audit_part *part = &audit->part[stretch->part];
    struct audit_watch *watch = part->watch;
    const double length = stretch->to - stretch->from;
    struct audit_question q = {.stretch = stretch,
                               .near = part->tolerance * length + 4.0 * audit->options.resolution,
                               .m = audit_watch_draw(audit, watch, p)};
    if (!watch->times.is_weighed[q.m]) {
        audit_screen_weigh(watch, p, q.m);
    }
    if (watch->times.theta[0] <= p->end) {
        q.image = audit_image_again(screen, p, q.m);
        q.image = q.image == NULL ? audit_image_of(audit, part, screen, p, q.m) : q.image;
    }
    watch->image = q.image;
    if (q.image != NULL) {
        *audit_lane_of(watch, p) = (struct audit_lane){p->key, p->step, screen, q.image};
    }
    if (q.image == NULL && p->value == NULL) {
        audit->reader.complete(audit->reader.user, stretch->part);
    }
    audit_screen_ask(audit, watch, screen, &q, answer);
    const double over = length - p->end * p->step;
    if (!audit_can_tell_times(part, length, stretch->to)) {
        answer->worst = 0.0; /* no law is known in it, but states are at both ends */
    } else if (over > q.near || (!stretch->is_cut && -over > q.near)) {
        answer->worst = INFINITY;
    }
    /* and about one instruction for each number, as four are taken at once */
    audit->budget.spent += AUDIT_SCREEN_WORK + (q.image != NULL ? p->n_inputs * screen->n_places
                                                                : p->n_nodes * p->n_columns);
}

/* Is the stretch to be looked at, for what the screen says, or because states are not what they were at the end of the one
 * before? Then only how it begins is. */
static bool alarms(struct dalcs_audit *audit, struct audit_watch *watch,
                   struct audit_screen *screen, const struct audit_answer *answer) {
    const double jump = watch->before.knows_states && !watch->is_put_off
                            ? fabs(answer->start - watch->before.states)
                            : 0.0;
    watch->before.states = answer->end;
    watch->before.knows_states = true;
    audit->count.screened++;
    const bool holds = answer->worst <= screen->limit;
    const bool is_known = holds ? jump <= 2.0 * screen->jumped : screen->alarms >= FEW_ALARMS;
    if ((holds && jump <= screen->limit) || (is_known && audit->budget.credit < 0.0)) {
        return false;
    }
    screen->alarms += holds ? 0 : 1;
    screen->jumped = holds ? fmax(screen->jumped, jump) : screen->jumped;
    watch->has_jumped = holds;
    watch->asked = answer->t;
    return true;
}

bool audit_watch_asks(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    struct audit_part *part = &audit->part[stretch->part];
    struct audit_watch *watch = part->watch;
    watch->asked = -1.0;
    watch->image = NULL;
    const bool can_ask = stretch->rule == DALCS_AUDIT_SMOOTH && stretch->stored != NULL;
    struct audit_screen *screen = can_ask ? audit_screen_of(part, stretch->stored) : NULL;
    watch->makes = can_ask && screen == NULL;
    if (screen != NULL && screen->rests > 0) {
        screen->rests--;
        screen = NULL;
    }
    if (screen == NULL) {
        watch->before.knows_states = watch->before.knows_states && watch->makes;
        return watch->makes;
    }
    struct audit_answer answer;
    ask(audit, screen, stretch, &answer);
    return alarms(audit, watch, screen, &answer);
}

/* What the look has found counts. What the screen makes of such a stretch, which holds or ends the run, asks for none. */
static void allow(const struct dalcs_audit *audit, const struct audit_part *part,
                  struct audit_screen *screen, double worst) {
    const double most = fmax(1.0, audit->options.failure / part->tolerance);
    if (2.0 * worst <= most) {
        screen->limit = fmax(screen->limit, 2.0 * worst);
    } else {
        screen->rests = 1L << (screen->alarms < MOST_DOUBLINGS ? screen->alarms : MOST_DOUBLINGS);
    }
}

/* The screen of the present stretch, and what it says of that; NULL: there is none. */
static struct audit_screen *make(struct dalcs_audit *audit,
                                 const struct dalcs_audit_stretch *stretch,
                                 const struct dalcs_audit_state *s, double t,
                                 struct audit_answer *answer) {
    struct audit_part *part = &audit->part[stretch->part];
    if (stretch->stored == NULL) {
        return NULL;
    }
    audit->reader.complete(audit->reader.user, stretch->part);
    struct audit_screen *screen = audit_screen_make(audit, part, stretch->stored, s, t);
    if (screen != NULL) {
        ask(audit, screen, stretch, answer);
    }
    return screen;
}

bool audit_watch_begins(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    struct audit_watch *watch = audit->part[stretch->part].watch;
    struct audit_answer answer;
    const double t = stretch->from + audit_draw(audit) * (stretch->to - stretch->from);
    struct audit_screen *screen = make(audit, stretch, NULL, t, &answer);
    watch->before.knows_states = watch->before.knows_states && screen != NULL;
    return screen == NULL || alarms(audit, watch, screen, &answer);
}

void audit_watch_learn(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    struct audit_part *part = &audit->part[stretch->part];
    struct audit_answer answer;
    if (part->watch->asked < 0.0) {
        return;
    }
    audit_pieces_forget(part->watch);
    struct audit_screen *screen =
        make(audit, stretch, &audit->state.now, audit->state.now.t, &answer);
    part->watch->before.knows_states = screen != NULL;
    if (screen != NULL) {
        part->watch->before.states = answer.end;
    }
    if (screen != NULL && !(answer.worst <= screen->limit)) {
        allow(audit, part, screen, answer.worst);
    }
}

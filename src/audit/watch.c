/* watch.c - each stretch is asked by a screen, and looked at where that asks for it. */
#include "screen.h"

/* Stretches that a screen rests after an alarm that was false and stays: twice as many each time, up to 2 to this power. */
enum { MOST_DOUBLINGS = 16 };

/* So many alarms of a screen are looked at whatever they cost. What was found would have ended the run; more, which are
 * false, such as of states that jump in each period, are looked at while the run can afford it. */
enum { FEW_ALARMS = 4 };

/* One instant, and a screen of about the same work. */
static bool is_affordable(const struct audit_part *part, const struct dalcs_audit *audit) {
    return audit->credit - 2.0 * part->cost > -audit->reserve;
}

static bool store(const struct dalcs_audit *audit, int index, bool wants_values,
                  struct dalcs_audit_polynomials *p) {
    return audit->reader.store != NULL &&
           audit->reader.store(audit->reader.user, index, wants_values, p);
}

/* Where nobody needed values until now, and no image will do. */
static bool wants_values(const struct audit_screen *screen,
                         const struct dalcs_audit_polynomials *p) {
    return p->value == NULL && (screen == NULL || !audit_screen_has_image(screen, p));
}

/* Do the values reach from one end of the stretch to the other? Times are known to their resolution, and events to what
 * changes no value by more than the tolerance. */
static bool spans(const struct dalcs_audit *audit, const struct audit_part *part,
                  const struct dalcs_audit_polynomials *p,
                  const struct dalcs_audit_stretch *stretch) {
    const double length = stretch->to - stretch->from;
    return length - p->end * p->step <= part->tolerance * length + 4.0 * audit->options.resolution;
}

bool audit_watch_asks(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch,
                      bool can_look) {
    struct audit_part *part = &audit->part[stretch->part];
    struct audit_watch *watch = part->watch;
    const bool knew = watch->knows_states && !watch->is_put_off;
    struct dalcs_audit_polynomials p;
    watch->asked = -1.0;
    watch->knows_states = watch->makes = false;
    if (!can_look || !store(audit, stretch->part, false, &p)) {
        return false;
    }
    struct audit_screen *screen = audit_screen_of(part, &p);
    if (screen == NULL) {
        watch->makes = is_affordable(part, audit);
        return watch->makes;
    }
    if (screen->rests > 0) {
        screen->rests--;
        return false;
    }
    audit_screen_see_step(audit, part, screen, &p);
    if (wants_values(screen, &p)) {
        (void)store(audit, stretch->part, true, &p);
    }
    struct audit_answer answer;
    audit_screen_ask(audit, part, screen, &p, stretch, &answer);
    if (!spans(audit, part, &p, stretch)) {
        answer.worst = INFINITY;
    }
    const double jump = knew ? fabs(answer.start - watch->states) : 0.0;
    watch->states = answer.end;
    watch->knows_states = true;
    audit->count.screened++;
    if (answer.worst <= screen->limit && jump <= screen->limit) {
        return false;
    }
    if (screen->alarms >= FEW_ALARMS && !is_affordable(part, audit)) {
        return false;
    }
    screen->alarms++;
    watch->asked = answer.t;
    return true;
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

void audit_watch_learn(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch) {
    struct audit_part *part = &audit->part[stretch->part];
    struct audit_watch *watch = part->watch;
    struct dalcs_audit_polynomials p;
    if (!(watch->makes || watch->asked >= 0.0) || !store(audit, stretch->part, true, &p)) {
        return;
    }
    struct audit_screen *screen = audit_screen_make(audit, part, &p, &audit->now);
    audit->credit -= part->cost;
    watch->knows_states = screen != NULL;
    if (screen == NULL) {
        return;
    }
    struct audit_answer answer;
    audit_screen_ask(audit, part, screen, &p, stretch, &answer);
    watch->states = answer.end;
    if (!(answer.worst <= screen->limit)) {
        allow(audit, part, screen, answer.worst);
    }
}

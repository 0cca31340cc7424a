/* audit_measures_asked.c - values of measured formulas at times of the auditor's own. */
#include "audit_measures_asked.h"

#include "audit_reader.h"
#include "claims.h"

#include <float.h>
#include <math.h>

/* Instructions, about, of a value of a formula from the stretch. */
static const double stretch_work = 300.0;

/* What the rounding of a time makes of a value: two ways to it have the time of a node to one rounding only, and in a
 * stretch of a few roundings that is all of it. */
static double doubt_of_time(const struct audit_asked *q, double at, double value) {
    const struct dalcs_stretch *s = &q->m->stretch;
    const double off = DBL_EPSILON * fabs(at);
    const double before = fabs(dalcs_stretch_value_near(s, q->formula, at, -off) - value);
    const double after = fabs(dalcs_stretch_value_near(s, q->formula, at, off) - value);
    return fmax(before, after); /* of a side that has no value the other one */
}

double audit_asked_value(void *user, double t, double *doubt) {
    const struct audit_asked *q = user;
    const struct dalcs_stretch *s = &q->m->stretch;
    const double at = fmin(fmax(t, s->from), s->to);
    double value;
    if (q->reads) {
        value = dalcs_audit_formula(q->a->run->audit, q->formula, at,
                                    at > s->from ? DALCS_LEFT : DALCS_RIGHT, s->result, doubt);
    } else {
        value = dalcs_stretch_value(s, q->formula, at);
        if (doubt != NULL) { /* of Clenshaw's sum of as many terms */
            *doubt = 16.0 * DALCS_STRETCH_NODES * DBL_EPSILON * fmax(q->scale, fabs(value));
        }
    }
    if (doubt != NULL) {
        *doubt += doubt_of_time(q, at, dalcs_stretch_value(s, q->formula, at));
    }
    q->a->credit -= q->reads ? AUDIT_STATE_WORK : stretch_work;
    if (q->omega != 0.0) {
        const double angle = q->omega * (at - q->since);
        value *= q->is_sine ? sin(angle) : cos(angle);
    }
    return value;
}

bool audit_measures_reads_all(const struct dalcs_audit_run *run,
                              const struct dalcs_signal_formula *formula) {
    bool reads = true;
    for (int k = 0; k < formula->n && reads; k++) {
        if (formula->step[k].push == DALCS_PUT_SIGNAL) {
            const int part = dalcs_audit_part_of(
                run->audit, run->run->s->circuit.results.measured[formula->step[k].index]);
            reads = part >= 0 && run->radau->part[part].kind == DALCS_PART_STEPPED;
        }
    }
    return reads;
}

struct audit_asked audit_measures_ask(struct dalcs_audit_measures *a,
                                      const struct dalcs_measuring *m,
                                      const struct dalcs_signal_formula *formula, bool reads,
                                      double scale) {
    const struct dalcs_stretch *s = &m->stretch;
    const bool is_long =
        (s->to - s->from) * dalcs_audit_most_allowed(a->run) > 4.0 * DBL_EPSILON * s->to;
    return (struct audit_asked){.a = a,
                                .m = m,
                                .formula = formula,
                                .reads = reads && s->result == NULL && is_long,
                                .scale = scale};
}

struct dalcs_audit_number audit_measures_number(int k, double scale) {
    return (struct dalcs_audit_number){DALCS_AUDIT_MEASURE, k, scale};
}

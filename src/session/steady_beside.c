/* steady_beside.c - what is told of runs beside an unstable orbit, and of those that no orbit of one period was found for. */
#include "steady_step.h"

#include "quantity.h"

#include <math.h>

/* Messages about a run that fails beside an orbit do not concern the orbit. */
static struct dalcs_diag keep_silent(struct dalcs_steady *st) {
    const struct dalcs_diag diag = st->run->s->diag;
    st->run->s->diag = (struct dalcs_diag){0};
    return diag;
}

static void speak_again(struct dalcs_steady *st, struct dalcs_diag diag) {
    dalcs_diag_finish(&st->run->s->diag);
    st->run->s->diag = diag;
}

/* A run beside an orbit may come to where gates do not settle. It tells nothing then, and the orbit is what it is. */
static enum dalcs_status without_gates(enum dalcs_status looked) {
    return looked == DALCS_E_NETLIST ? DALCS_OK : looked;
}

/* From st->at, which is on the orbit of the report. */
static enum dalcs_status look(struct dalcs_steady *st) {
    struct dalcs_report *report = &st->run->s->results.report;
    const struct dalcs_floquet *m = report->steady.multiplier;
    const double one = st->period;
    struct dalcs_steady_attractor a;
    struct dalcs_orbit_point orbit;
    if (!dalcs_steady_make_point(st, &orbit)) {
        return DALCS_E_NOMEM;
    }
    dalcs_steady_copy_point(st, &orbit, &st->at);
    if (m[0].im == 0.0 && m[0].re < 0.0) {
        DALCS_TRY(dalcs_steady_look_for_double(st));
    }
    const bool is_one_of_many =
        st->run->step != NULL && st->run->step->n_steps > 1; /* takes long */
    if (report->steady.doubled.stable || is_one_of_many) {
        return DALCS_OK;
    }
    st->period = one;
    dalcs_steady_copy_point(st, &st->at, &orbit);
    dalcs_steady_step_aside(st);
    DALCS_TRY(dalcs_steady_find_attractor(st, hypot(m[0].re, m[0].im), &a));
    return a.kind == DALCS_STEADY_UNKNOWN || a.kind == DALCS_STEADY_SETTLING
               ? DALCS_OK
               : dalcs_steady_report_attractor(st, one, &a);
}

enum dalcs_status dalcs_steady_look_beside(struct dalcs_steady *st) {
    const double one = st->period;
    const struct dalcs_steady_count count = st->n;
    const bool is_exact = st->pass.is_exact;
    struct dalcs_orbit_point orbit;
    if (!dalcs_steady_make_point(st, &orbit)) {
        return DALCS_E_NOMEM;
    }
    dalcs_steady_copy_point(st, &orbit, &st->at);
    const struct dalcs_diag diag = keep_silent(st);
    const enum dalcs_status status = look(st);
    speak_again(st, diag);
    DALCS_TRY(without_gates(status));
    DALCS_TRY(dalcs_steady_go_back(st, &orbit, one));
    st->n = count;
    st->pass.is_exact = is_exact;
    return DALCS_OK;
}

enum dalcs_status dalcs_steady_look_ahead(struct dalcs_steady *st, bool *found,
                                          struct dalcs_steady_attractor *a) {
    const double one = st->period;
    char all[DALCS_QUANTITY_SIZE];
    char of_one[DALCS_QUANTITY_SIZE];
    const struct dalcs_diag diag = keep_silent(st);
    const enum dalcs_status looked = dalcs_steady_find_attractor(st, 0.0, a);
    speak_again(st, diag);
    DALCS_TRY(without_gates(looked));
    a->kind = looked == DALCS_OK ? a->kind : DALCS_STEADY_UNKNOWN;
    *found = a->kind == DALCS_STEADY_ORBIT;
    if (!*found) { /* what is told of the last period is of one of the run */
        const enum dalcs_status status = dalcs_steady_pass(st, 1, DALCS_STEADY_PLAIN);
        return status < DALCS_OK ? status : DALCS_OK;
    }
    if (a->n > 1) {
        dalcs_diag_add(
            &st->run->s->diag, DALCS_NOTE, NULL, NULL,
            "no orbit of %s was found; a run repeats after %d times that: the period is %s",
            dalcs_quantity_write(of_one, one, "s", 9), a->n,
            dalcs_quantity_write(all, a->n * one, "s", 9));
    }
    return DALCS_OK;
}

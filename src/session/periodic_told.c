/* periodic_told.c - diodes for which the response around an orbit is not that of any small signal. */
#include "periodic_ac.h"

#include <math.h>

/* A diode that a small signal opens and closes by its own sign. */
static void tell_resting(struct dalcs_periodic_ac *a) {
    struct dalcs_session *s = a->run->s;
    const char *element = a->by_current.response.resting;
    for (int k = 0; k < a->n_parts; k++) {
        element = a->part[k].response.resting != NULL ? a->part[k].response.resting : element;
    }
    if (element != NULL) {
        s->results.report.response.exact = false;
        dalcs_diag_add(&s->diag, DALCS_WARNING, &s->circuit.analyses.ac.where,
                       "give it a path of leakage, which decides its side; or inject a small sine "
                       "in .tran",
                       "there is no linear response: '%s' has neither voltage nor current for a "
                       "while, and conducts one half of a small sine alone; the rows take it as "
                       "it stands",
                       element);
    }
}

/* A diode that only comes near to its other side, and that a small signal takes there. */
static void tell_near(struct dalcs_periodic_ac *a) {
    struct dalcs_session *s = a->run->s;
    const struct dalcs_periodic_response *of = &a->by_current.response;
    for (int k = 0; k < a->n_parts; k++) {
        const struct dalcs_periodic_response *r = &a->part[k].response;
        const bool is_nearer =
            r->near.low != NULL && (of->near.low == NULL || r->near.reach < of->near.reach);
        of = is_nearer ? r : of;
    }
    if (of->near.low == NULL) {
        return;
    }
    const struct dalcs_orbit_low *low = of->near.low;
    const struct dalcs_pair *pair = &of->flow->system->pair[low->pair];
    s->results.report.response.exact = false;
    if (low->gap > 0.0) {
        dalcs_diag_add(
            &s->diag, DALCS_WARNING, &s->circuit.analyses.ac.where,
            "inject a sine of the size that counts in .tran",
            "only signals below %.2g of the AC values have this response: at %.9g s '%s' "
            "%s, %.2g s before a switch or an edge acts on it, and a larger one takes "
            "that behind; the rows take it as it stands",
            of->near.reach, low->t, pair->element,
            pair->is_formula ? "comes to its kink or jump"
            : low->on        ? "ceases to conduct"
                             : "begins to conduct",
            low->gap);
        return;
    }
    dalcs_diag_add(&s->diag, DALCS_WARNING, &s->circuit.analyses.ac.where,
                   "add the loss that keeps it away from there, as of a resistor across a ring "
                   "or a diode; or inject a sine of the size that counts in .tran",
                   "only signals below %.2g of the AC values have this response: at %.9g s '%s' "
                   "is %.2g %s away from %s, and a larger one takes it there; the rows take it "
                   "as it stands",
                   of->near.reach, low->t, pair->element, low->value, low->on ? "A" : "V",
                   pair->is_formula ? "its kink or jump"
                   : low->on        ? "blocking"
                                    : "conducting");
}

void dalcs_periodic_ac_tell(struct dalcs_periodic_ac *a) {
    tell_resting(a);
    tell_near(a);
}

/* envelope_asked.c - a run that is asked for an envelope: the netlist's .tran, if it has one, becomes an .env. */
#include "envelope.h"

#include <string.h>

static enum dalcs_status refuse(struct dalcs_run *r, const char *hint, const char *text) {
    dalcs_diag_add(&r->s->diag, DALCS_ERROR, dalcs_envelope_place(r), hint, "%s", text);
    return DALCS_E_OPTION;
}

const struct dalcs_location *dalcs_envelope_place(const struct dalcs_run *r) {
    const struct dalcs_location *where = &r->s->circuit.analyses.transient.where;
    return where->line > 0 ? where : NULL; /* else the netlist has no such card */
}

/* Of all periods, which an envelope leaves most of out: what another run of the netlist measures. */
static void leave_out(struct dalcs_run *r) {
    struct dalcs_circuit *c = &r->s->circuit;
    const bool losses = c->results.losses != NULL && c->results.losses->present;
    int n = 0;
    for (int k = 0; k < c->results.n_measures; k++) {
        n += c->results.measure[k].analysis == DALCS_MEASURED_TRAN ? 1 : 0;
    }
    if ((n > 0 || c->results.n_fouriers > 0 || losses) && (r->step == NULL || r->step->step == 0)) {
        dalcs_diag_add(&r->s->diag, DALCS_NOTE, NULL, "'dalcs run' measures a run of all periods",
                       "%s: left out, since an envelope computes few of the periods",
                       n > 0                       ? ".meas"
                       : c->results.n_fouriers > 0 ? ".four"
                                                   : ".losses");
    }
    c->results.n_measures = c->results.n_fouriers = 0;
    if (losses) {
        c->results.losses->present = false;
    }
}

/* Those of the card, if none are given. */
static enum dalcs_status take_times(struct dalcs_run *r) {
    const struct dalcs_run_options *o = r->options;
    struct dalcs_envelope_card *card = &r->s->circuit.analyses.envelope;
    const double stop = r->s->circuit.analyses.transient.stop;
    if (o->n_envelope_at > 0) {
        card->at = dalcs_arena_alloc(&r->s->circuit.arena, o->n_envelope_at, sizeof(double));
        if (card->at == NULL) {
            return DALCS_E_NOMEM;
        }
        memcpy(card->at, o->envelope_at, o->n_envelope_at * sizeof(double));
        card->n_at = (int)o->n_envelope_at;
    }
    for (int k = 0; k < card->n_at; k++) {
        if (!(card->at[k] >= 0.0 && card->at[k] < stop)) {
            dalcs_diag_add(&r->s->diag, DALCS_ERROR, NULL, NULL,
                           "there is no period at %g s: the run ends at %g s", card->at[k], stop);
            return DALCS_E_OPTION;
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_envelope_ask(struct dalcs_run *r) {
    struct dalcs_circuit *c = &r->s->circuit;
    struct dalcs_transient *t = &c->analyses.transient;
    if (r->options->envelope_stop > 0.0) {
        t->stop = r->options->envelope_stop;
        t->present = true;
    }
    if (!t->present) {
        return refuse(r, "say when: dalcs envelope FILE --stop 10m, or a card .env 10m",
                      "an envelope needs an end, and the netlist has neither .env nor .tran");
    }
    if (t->starts_steady) {
        return refuse(r, "leave uic=steady out, or run .tran",
                      "an envelope computes a start, and uic=steady begins on the orbit itself");
    }
    t->start = t->step = t->first_step = 0.0;
    t->use_initial_conditions =
        t->use_initial_conditions || c->analyses.periodic.use_initial_conditions;
    c->analyses.envelope.present = true;
    leave_out(r);
    return take_times(r);
}

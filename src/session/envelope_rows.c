/* envelope_rows.c - rows of one period after the other are one waveform. */
#include "envelope.h"

/* Default number of rows in a period that is written. */
static const double rows_in_a_period = 100.0;

static enum dalcs_status begin(void *user, const struct dalcs_plot *plot) {
    struct dalcs_envelope *e = user;
    const bool is_first = !e->rows.has_begun;
    e->rows.has_begun = true;
    return is_first ? e->rows.to->begin(e->rows.to->user, plot) : DALCS_OK;
}

static enum dalcs_status row(void *user, double time, const double *value) {
    struct dalcs_envelope *e = user;
    return e->rows.to->row(e->rows.to->user, e->rows.offset + time, value);
}

static enum dalcs_status end(void *user) {
    (void)user;
    return DALCS_OK;
}

static enum dalcs_status progress(void *user, double time, double stop) {
    struct dalcs_envelope *e = user;
    (void)stop;
    return e->rows.to->progress(e->rows.to->user, e->rows.offset + time, e->rows.stop);
}

enum dalcs_status dalcs_envelope_write(struct dalcs_envelope *e, double duration, bool all,
                                       const struct dalcs_orbit_point *from) {
    static const double beginning[] = {0.0};
    struct dalcs_run *r = e->run;
    const struct dalcs_run_options *options = r->options;
    const struct dalcs_sink *sink = r->sink;
    struct dalcs_run_options own = *options;
    const struct dalcs_envelope_card *card = &r->s->circuit.analyses.envelope;
    const double period = e->st.period;
    own.at = all ? NULL : beginning;
    own.n_at = all ? 0 : 1;
    own.energy = own.record = false; /* of a period: that of all is not known */
    r->s->circuit.analyses.transient.stop = duration;
    r->s->circuit.analyses.transient.step =
        card->step > 0.0 ? card->step : period / rows_in_a_period;
    r->options = &own;
    r->sink = &e->rows.sink;
    r->orbit = from;
    r->orbit_end = from == NULL ? &e->st.at : NULL;
    r->leaves_orbit = true;
    struct dalcs_losses_card *losses = r->s->circuit.results.losses;
    const bool is_asked = losses != NULL && losses->present; /* of a .pss beside it */
    if (losses != NULL) {
        losses->present = false;
    }
    const enum dalcs_status status = dalcs_transient_run_thinned(r);
    if (losses != NULL) {
        losses->present = is_asked;
    }
    r->orbit = NULL;
    r->orbit_end = NULL;
    r->leaves_orbit = false;
    r->options = options;
    r->sink = sink;
    return status;
}

void dalcs_envelope_rows_setup(struct dalcs_envelope *e) {
    e->rows.to = e->run->sink;
    e->rows.sink = (struct dalcs_sink){
        .user = e, .begin = begin, .row = row, .end = end, .progress = progress};
}

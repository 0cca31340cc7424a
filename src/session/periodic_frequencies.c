/* periodic_frequencies.c - which frequencies .ac around an orbit has: the netlist's, or others that are asked for. */
#include "periodic_ac.h"

#include <math.h>

/* Default frequencies, over that of the orbit: half of it, without the point itself, is as far as
 * a controller sees. */
static const double usual_from = 1e-4, usual_to = 0.5;

enum { USUAL_POINTS = 20 };

/* Frequencies one by one. */
static enum dalcs_status take_list(struct dalcs_periodic_ac *a, const double *at, size_t n) {
    struct dalcs_diag *diag = &a->run->s->diag;
    for (size_t k = 0; k < n; k++) {
        if (!(at[k] > (k > 0 ? at[k - 1] : 0.0)) || !isfinite(at[k])) {
            dalcs_diag_add(diag, DALCS_ERROR, NULL, "give frequencies in Hz, each above the last",
                           "frequency %zu is %.9g Hz: it has to be above %.9g Hz", k + 1, at[k],
                           k > 0 ? at[k - 1] : 0.0);
            return DALCS_E_OPTION;
        }
    }
    if (n > DALCS_SWEEP_MOST) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "%zu frequencies are too many: at most %d", n,
                       (int)DALCS_SWEEP_MOST);
        return DALCS_E_OPTION;
    }
    a->own_sweep = (struct dalcs_sweep){.name = "frequency", .label = "frequency", .device = -1};
    a->own_sweep.where = a->sweep->where;
    a->own_sweep.spacing = DALCS_LISTED;
    a->own_sweep.list = at;
    a->own_sweep.n = (int)n;
    a->sweep = &a->own_sweep;
    return DALCS_OK;
}

enum dalcs_status dalcs_periodic_frequencies_choose(struct dalcs_periodic_ac *a) {
    const struct dalcs_run_options *o = a->run->options;
    struct dalcs_sweep *f = &a->own_sweep;
    a->sweep = &a->run->s->circuit.analyses.ac;
    if (o->n_bode_at > 0) {
        return take_list(a, o->bode_at, o->n_bode_at);
    }
    if (a->sweep->n > 0 && o->bode_from == 0.0 && o->bode_to == 0.0 && o->bode_points == 0) {
        return DALCS_OK;
    }
    const bool has = a->sweep->n > 0;
    *f = (struct dalcs_sweep){.name = "frequency", .label = "frequency", .device = -1};
    f->where = a->sweep->where;
    f->spacing = DALCS_DECADES;
    f->start = o->bode_from > 0.0 ? o->bode_from
               : has              ? a->sweep->start
                                  : usual_from / a->st->period;
    f->stop = o->bode_to > 0.0 ? o->bode_to : has ? a->sweep->stop : usual_to / a->st->period;
    f->step = o->bode_points > 0                          ? o->bode_points
              : has && a->sweep->spacing == DALCS_DECADES ? a->sweep->step
                                                          : USUAL_POINTS;
    f->n = f->start > 0.0 && f->stop >= f->start
               ? dalcs_sweep_count(f->spacing, f->start, f->stop, f->step)
               : 0;
    a->sweep = f;
    if (f->n <= 0) {
        dalcs_diag_add(&a->run->s->diag, DALCS_ERROR, NULL, NULL,
                       "from %.9g Hz to %.9g Hz there are no frequencies", f->start, f->stop);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

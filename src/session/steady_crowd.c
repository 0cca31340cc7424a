/* steady_crowd.c - when a search gives up where events crowd.
 *
 * A switch that undoes at once what makes it switch goes to and fro without end, or slides: implicit Euler goes over that, or
 * means of both positions do. Phi is then what these steps make of it, off by their error, and M is nothing: Newton's method
 * does not come to 1e-11, and each period takes thousands of one-step problems. */
#include "steady.h"

/* A search without crowds is at worst two runs of 8192 periods (steady.c), in which each pair changes its side and comes
 * back, each time with a problem at the event and one a micro-step behind it: four one-step problems. One whose steps of
 * Euler, or that slide, take more is none that ends. Both are weighed by unknowns. With a tenth, or ten times as much,
 * tests/steady/crowded.py has the same answers. */
static const double most_problems_of_a_pair = 2.0 * 8192.0 * 4.0;

void dalcs_steady_limit_crowd(struct dalcs_steady *st, bool is_limited) {
    const struct dalcs_network *network = &st->run->s->network;
    st->crowd.is_limited = is_limited;
    st->crowd.most = 0.0;
    for (int k = 0; k < network->n_systems; k++) {
        const struct dalcs_system *s = &network->system[k];
        st->crowd.most += most_problems_of_a_pair * s->n_pairs * (s->n_x + s->n_z);
    }
}

/* One-step problems times unknowns, of that part of the steps. */
static double work_of(const struct dalcs_radau *radau) {
    double work = 0.0;
    for (int k = 0; k < radau->n_parts; k++) {
        const struct dalcs_component *c = radau->part[k].component;
        const long inexact = radau->euler_steps + c->commands.n_slid;
        const double part = inexact < radau->steps ? (double)inexact / (double)radau->steps : 1.0;
        const double solved = (double)c->osnsp.counters.solved * (c->system->n_x + c->system->n_z);
        work += inexact > 0 ? part * solved : 0.0;
    }
    return work;
}

bool dalcs_steady_is_crowded(const struct dalcs_steady *st, const struct dalcs_radau *radau) {
    const double now = radau != NULL ? work_of(radau) : 0.0;
    return st->crowd.is_limited && st->crowd.work + now > st->crowd.most;
}

void dalcs_steady_count_crowd(struct dalcs_steady *st, const struct dalcs_radau *radau) {
    st->crowd.work += work_of(radau);
}

enum dalcs_status dalcs_steady_tell_crowd(struct dalcs_steady *st) {
    dalcs_diag_add(&st->run->s->diag, DALCS_ERROR, NULL,
                   "a hysteresis, Vh=, or a delay keeps a switch from undoing at once what makes "
                   "it switch; look at it with .tran",
                   "no periodic steady state was found in %ld periods: events crowd, or a switch "
                   "slides along its threshold, where no step is exact",
                   st->n.periods);
    return DALCS_NOT_CONVERGED;
}

/* steady_step.c - a point of the search, and a step of it from one to the next. */
#include "steady_step.h"

#include <math.h>
#include <string.h>

bool dalcs_steady_switches_return(const struct dalcs_steady *st) {
    bool do_ = true;
    for (int k = st->layout.n_switches; k < st->layout.n_pairs; k++) {
        do_ = do_ && st->at.closed[k] == st->then.closed[k];
    }
    for (int k = 0; k < st->layout.n_systems; k++) {
        const struct dalcs_system *s = &st->run->s->network.system[k];
        for (int d = 0; d < s->n_pairs; d++) {
            int i = st->layout.first_pair[k] + d;
            do_ = do_ &&
                  !(s->pair[d].kind == DALCS_PAIR_SWITCH && dalcs_pair_remembers(&s->pair[d]) &&
                    st->at.closed[i] != st->then.closed[i]);
        }
    }
    return do_;
}

void dalcs_steady_go_by(struct dalcs_steady *st, const double *from, const double *step,
                        double factor) {
    for (int x = 0; x < st->layout.n_x; x++) {
        st->at.x[x] = from[x] + factor * step[x];
    }
    memcpy(st->at.closed, st->then.closed, (size_t)st->layout.n_pairs * sizeof(bool));
}

bool dalcs_steady_comes_back(const struct dalcs_steady *st, double distance) {
    const double off = fmax(distance, dalcs_steady_good);
    bool does = true;
    for (int k = 0; k < st->layout.n_systems; k++) {
        const int first = st->layout.first[k];
        const int n = st->layout.first[k + 1] - first;
        const double *M = st->pass.M + st->layout.first_of_M[k];
        for (int x = 0; x < n; x++) {
            const double *scale = st->scale + first;
            double most = off * scale[x]; /* M - 1 of what the states are off by */
            for (int i = 0; i < n; i++) {
                most += off * fabs(M[i * n + x]) * scale[i];
            }
            most += st->own.is_free ? off * st->period * fabs(st->pass.last[first + x]) : 0.0;
            does = does && fabs(st->then.x[first + x] - st->at.x[first + x]) <= most;
        }
    }
    return does;
}

enum dalcs_status dalcs_steady_next_step(struct dalcs_steady *st) {
    st->own.longer = 0.0;
    return st->own.is_free ? dalcs_steady_newton_free(st, &st->own.longer)
                           : dalcs_steady_newton(st);
}

void dalcs_steady_take_step(struct dalcs_steady *st) {
    dalcs_steady_go_by(st, st->at.x, st->step, 1.0);
    st->period += st->own.longer;
    st->n.newton++;
}

void dalcs_steady_copy_point(const struct dalcs_steady *st, struct dalcs_orbit_point *to,
                             const struct dalcs_orbit_point *from) {
    memcpy(to->x, from->x, (size_t)st->layout.n_x * sizeof(double));
    memcpy(to->closed, from->closed, (size_t)st->layout.n_pairs * sizeof(bool));
}

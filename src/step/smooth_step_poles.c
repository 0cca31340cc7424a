/* smooth_step_poles.c - what smooth sources have no value at in a step, and between two. */
#include "extremes.h"
#include "magnitudes.h"
#include "smooth_poles.h"
#include "smooth_step_internal.h"

#include <float.h>
#include <math.h>
#include <string.h>

void dalcs_smooth_step_arguments(const struct dalcs_radau_part *part, double theta,
                                 double (*x)[2]) {
    const struct dalcs_smooth_newton *n = &part->smooth->newton;
    const int n_smooth = n->system->n_smooth;
    double weight[DALCS_MAX_NODES];
    dalcs_collocation_weights(part->stages.method, theta, weight);
    for (int k = 0; k < n_smooth; k++) {
        x[k][0] = x[k][1] = 0.0;
        for (int node = 0; node < n->n_points; node++) {
            x[k][0] += weight[node] * n->x[node * n_smooth + k][0];
            x[k][1] += weight[node] * n->x[node * n_smooth + k][1];
        }
    }
}

/* Where argument j of source k makes a pole between two thetas at which its signs differ; at[n_smooth][2] is all arguments
 * there. */
static double find_turn(const struct dalcs_radau_part *part, int k, int j, double from, double to,
                        double (*at)[2]) {
    const struct dalcs_smooth_input *of = &part->smooth->newton.system->smooth[k];
    dalcs_smooth_step_arguments(part, to, at);
    const bool is_above = dalcs_smooth_zero(of, j, at[k]) > 0.0;
    for (int halved = 0; halved < DBL_MANT_DIG; halved++) {
        const double middle = 0.5 * (from + to);
        dalcs_smooth_step_arguments(part, middle, at);
        if ((dalcs_smooth_zero(of, j, at[k]) > 0.0) == is_above) {
            to = middle;
        } else {
            from = middle;
        }
    }
    return to;
}

static void raise_most(const struct dalcs_smooth_step *p, const double (*x)[2]) {
    for (int k = 0; k < p->newton.system->n_smooth; k++) {
        p->most[k][0] = dalcs_larger(p->most[k][0], fabs(x[k][0]));
        p->most[k][1] = dalcs_larger(p->most[k][1], fabs(x[k][1]));
    }
}

/* The source with the first pole between two thetas, -1: none. *theta is where. */
static int find_pole(const struct dalcs_radau_part *part, struct dalcs_smooth_places *p,
                     double from, double to, double *theta) {
    const struct dalcs_system *s = part->smooth->newton.system;
    int found = -1;
    *theta = to;
    for (int q = 0; q < 2 * s->n_smooth; q++) {
        const int k = q / 2;
        const int j = q % 2;
        if (!dalcs_smooth_turns(&s->smooth[k], j, p->before[k], p->after[k])) {
            continue;
        }
        const double turn = find_turn(part, k, j, from, to, part->smooth->dx);
        p->at = (const double(*)[2])part->smooth->dx;
        const int pole = dalcs_smooth_pole(s, k, j, p);
        if (pole >= 0 && (found < 0 || turn < *theta)) {
            found = pole;
            *theta = turn;
        }
    }
    return found;
}

/* The same between the end of a segment and what begins behind it, at an event or by a step of implicit Euler: what is
 * there on both sides is 0 but for nothing. */
static int find_pole_beside(struct dalcs_smooth_places *p, const struct dalcs_system *s) {
    int found = -1;
    p->at = p->after;
    for (int q = 0; q < 2 * s->n_smooth && found < 0; q++) {
        const int k = q / 2;
        const int j = q % 2;
        const struct dalcs_smooth_input *of = &s->smooth[k];
        const double size = of->kind == DALCS_SMOOTH_TAN ? 1.0 : p->most[k][j];
        const bool is_near = dalcs_smooth_turns(of, j, p->before[k], p->after[k]) &&
                             fabs(dalcs_smooth_zero(of, j, p->before[k])) <= dalcs_nothing * size &&
                             fabs(dalcs_smooth_zero(of, j, p->after[k])) <= dalcs_nothing * size;
        found = is_near ? dalcs_smooth_pole(s, k, j, p) : -1;
    }
    return found;
}

static bool blame(const struct dalcs_radau_part *part, int pole,
                  const struct dalcs_smooth_places *p) {
    if (pole >= 0) {
        dalcs_smooth_newton_blame_pole(part->component->osnsp.smooth.newton, pole, p->at[pole]);
    }
    return pole >= 0;
}

static struct dalcs_smooth_places places_of(const struct dalcs_radau_part *part) {
    const struct dalcs_smooth_step *p = part->smooth;
    return (struct dalcs_smooth_places){
        .before = (const double(*)[2])p->last,
        .most = (const double(*)[2])p->most,
        .tolerance = dalcs_larger(dalcs_alike, dalcs_beyond * part->inner_tolerance)};
}

bool dalcs_smooth_step_meets_pole(const struct dalcs_radau_part *part, double *theta) {
    const struct dalcs_smooth_step *p = part->smooth;
    const double end = *theta;
    if (p == NULL || !p->may_have_poles) {
        return false;
    }
    const struct dalcs_smooth_newton *n = &p->newton;
    const int n_smooth = n->system->n_smooth;
    const double(*node)[2] = (const double(*)[2])n->x;
    struct dalcs_smooth_places places = places_of(part);
    places.after = node;
    double from = *theta = 0.0;
    int found = part->segment.t > 0.0 ? find_pole_beside(&places, n->system) : -1;
    for (int i = 1; i < n->n_points && found < 0 && from < end; i++) {
        const double to = dalcs_smaller(part->stages.method->node[i], end);
        double(*last)[2] = p->dx + n_smooth;
        dalcs_smooth_step_arguments(part, to, last);
        raise_most(p, node + (i - 1) * n_smooth);
        places.before = node + (i - 1) * n_smooth;
        places.after = (const double(*)[2])last;
        found = find_pole(part, &places, from, to, theta);
        from = to;
    }
    if (found >= 0 && *theta > 0.0) {
        dalcs_smooth_step_arguments(part, *theta, p->dx);
    }
    return blame(part, found, &places);
}

bool dalcs_smooth_euler_meets_pole(const struct dalcs_radau_part *part) {
    const struct dalcs_smooth_step *p = part->smooth;
    if (p == NULL || !p->may_have_poles || !(part->segment.t > 0.0)) {
        return false;
    }
    const struct dalcs_smooth_newton *now = part->component->osnsp.smooth.newton;
    struct dalcs_smooth_places places = places_of(part);
    places.after = (const double(*)[2])now->x;
    return blame(part, find_pole_beside(&places, now->system), &places);
}

void dalcs_smooth_euler_note(const struct dalcs_radau_part *part) {
    const struct dalcs_smooth_newton *now = part->component->osnsp.smooth.newton;
    double *largest = part->component->osnsp.smooth.largest;
    largest[0] = dalcs_larger(largest[0], part->scales.unit[0]);
    largest[1] = dalcs_larger(largest[1], part->scales.unit[1]);
    raise_most(part->smooth, (const double(*)[2])now->x);
    memcpy(part->smooth->last, now->x, (size_t)now->n * sizeof(*now->x));
}

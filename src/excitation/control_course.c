/* control_course.c - sums of sources, and going along them by bounds of their second derivatives. */
#include "control_course.h"

#include "extremes.h"

#include <float.h>
#include <math.h>

/* Times looked at in one search; a control that never crosses must not cost its whole future. */
enum { LOOKS_AT_A_TIME = 256 };

/* A sum of sources is right to so many roundings of its largest term, and a time to those that an edge may be off by
 * (stimulus.h). */
static const double sum_rounded = 16.0 * DBL_EPSILON, time_rounded = 4.0 * DBL_EPSILON;

int dalcs_control_most_terms(const struct dalcs_control *control) {
    const struct dalcs_csr *a = &control->system->direct_control;
    int most = 1;
    for (int k = 0; k < a->p[a->n_rows]; k++) {
        const struct dalcs_stimulus *s = dalcs_control_stimulus(control, a->j[k]);
        int n = s != NULL ? dalcs_stimulus_n_terms(s) : 0;
        most = n > most ? n : most;
    }
    return most;
}

double dalcs_control_value(const struct dalcs_control *control, int pair, double t,
                           enum dalcs_side side) {
    const struct dalcs_csr *a = &control->system->direct_control;
    double sum = 0.0;
    for (int k = a->p[pair]; k < a->p[pair + 1]; k++) {
        const struct dalcs_stimulus *s = dalcs_control_stimulus(control, a->j[k]);
        sum += a->x[k] * (s != NULL ? dalcs_stimulus_value(s, t, side) : 1.0);
    }
    return sum;
}

double dalcs_control_next_edge(const struct dalcs_control *control, int pair, double t) {
    const struct dalcs_csr *a = &control->system->direct_control;
    double edge = INFINITY;
    for (int k = a->p[pair]; k < a->p[pair + 1]; k++) {
        const struct dalcs_stimulus *s = dalcs_control_stimulus(control, a->j[k]);
        edge = s != NULL ? fmin(edge, dalcs_stimulus_next_edge(s, t)) : edge;
    }
    return edge;
}

/* From t on, tau later and before the next edge: |value + slope tau - control| <= bend tau^2 / 2, up to `reach`. */
struct course {
    double value, slope, bend;
    double straight, rise; /* the straight part of value and slope */
    double swing;          /* |control - straight - rise tau| up to `reach` */
    double reach;          /* s */
    double size, rate;     /* what all terms are at most by now, and their slopes */
};

static void add_term(const struct dalcs_stimulus_term *term, double factor, struct course *c) {
    double size = fabs(factor) * hypot(term->cosine, term->sine);
    double speed = hypot(term->decay, term->omega);
    c->value += factor * term->cosine;
    c->slope += factor * (term->omega * term->sine - term->decay * term->cosine);
    c->size += size;
    c->rate += speed * size;
    if (term->decay < 0.0) { /* it grows by a factor of e up to there */
        c->reach = fmin(c->reach, -1.0 / term->decay);
        size *= 2.718281828459045;
    }
    c->swing += size;
    c->bend += speed * speed * size;
}

static void look(const struct dalcs_control *control, int pair, double t, struct course *c) {
    const struct dalcs_csr *a = &control->system->direct_control;
    *c = (struct course){.reach = INFINITY};
    for (int k = a->p[pair]; k < a->p[pair + 1]; k++) {
        const struct dalcs_stimulus *s = dalcs_control_stimulus(control, a->j[k]);
        struct dalcs_stimulus_piece piece = {.level = 1.0, .term = control->term};
        if (s != NULL) {
            dalcs_stimulus_piece_at(s, t, &piece);
        }
        c->straight += a->x[k] * piece.level;
        c->rise += a->x[k] * piece.slope;
        c->size += fabs(a->x[k] * piece.level);
        c->rate += fabs(a->x[k] * piece.slope);
        for (int i = 0; i < piece.n_terms; i++) {
            add_term(&piece.term[i], a->x[k], c);
        }
    }
    c->value += c->straight;
    c->slope += c->rise;
}

bool dalcs_control_is_straight(const struct dalcs_control *control, int pair, double t) {
    const struct dalcs_csr *a = &control->system->direct_control;
    bool straight = true;
    for (int k = a->p[pair]; k < a->p[pair + 1] && straight; k++) {
        const struct dalcs_stimulus *s = dalcs_control_stimulus(control, a->j[k]);
        straight = s == NULL || dalcs_stimulus_n_terms(s) == 0;
    }
    struct course c = {.swing = 0.0};
    if (!straight) {
        look(control, pair, t, &c);
    }
    return c.swing == 0.0;
}

/* s; before that it is not below 0: a parabola that bends down as much as anything of it may. */
static double earliest_fall(double value, double slope, double bend) {
    double root = sqrt(slope * slope + 2.0 * bend * value);
    if (slope < 0.0) {
        return 2.0 * value / (root - slope);
    }
    return bend > 0.0 ? (slope + root) / bend : INFINITY;
}

bool dalcs_control_follow(const struct dalcs_control *control, int pair, double sign,
                          double threshold, double edge, double *t) {
    double start = *t;
    for (int k = 0; k < LOOKS_AT_A_TIME && *t < edge; k++) {
        struct course c;
        look(control, pair, *t, &c);
        double rounding = sum_rounded * (c.size + fabs(threshold)) + time_rounded * *t * c.rate;
        double above = sign * (c.value - threshold);
        if (above < -0.5 * rounding) {
            double slope = sign * c.slope;
            *t = slope < 0.0 ? fmax(start, *t - above / slope) : *t;
            return true;
        }
        double line = sign * (c.straight - threshold);
        double last = isfinite(edge) ? line + sign * c.rise * (edge - *t)
                                     : (c.rise == 0.0 ? line : -INFINITY);
        bool stays = c.reach == INFINITY && dalcs_smaller(line, last) > c.swing;
        double tau = earliest_fall(fmax(above, 0.0) + rounding, sign * c.slope, c.bend);
        *t = stays ? edge : fmin(edge, *t + fmin(tau, c.reach));
    }
    return false;
}

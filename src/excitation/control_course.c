/* control_course.c - sums of sources, and going along them by bounds of their second derivatives. */
#include "control_course.h"

#include "course.h"
#include "rounding.h"

#include <math.h>

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

/* Up to `reach` the control is value + slope tau within bend tau^2 / 2; what all terms are at most by now, and their
 * slopes. */
struct course {
    struct dalcs_course of;
    double size, rate;
};

static void add_term(const struct dalcs_stimulus_term *term, double factor, struct course *c) {
    double size = fabs(factor) * hypot(term->cosine, term->sine);
    double speed = term->decay == 0.0 ? fabs(term->omega) : hypot(term->decay, term->omega);
    c->of.value += factor * term->cosine;
    c->of.derivative[0] += factor * (term->omega * term->sine - term->decay * term->cosine);
    c->size += size;
    c->rate += speed * size;
    if (term->decay < 0.0) { /* it grows by a factor of e up to there */
        c->of.reach = fmin(c->of.reach, -1.0 / term->decay);
        size *= 2.718281828459045;
    }
    c->of.swing += size;
    c->of.bend += speed * speed * size;
}

static void look(const struct dalcs_control *control, int pair, double t, struct course *c) {
    const struct dalcs_csr *a = &control->system->direct_control;
    *c = (struct course){.of.reach = INFINITY};
    for (int k = a->p[pair]; k < a->p[pair + 1]; k++) {
        const struct dalcs_stimulus *s = dalcs_control_stimulus(control, a->j[k]);
        struct dalcs_stimulus_piece piece = {.level = 1.0, .term = control->term};
        if (s != NULL) {
            dalcs_stimulus_piece_at(s, t, &piece);
        }
        c->of.straight += a->x[k] * piece.level;
        c->of.rise += a->x[k] * piece.slope;
        c->size += fabs(a->x[k] * piece.level);
        c->rate += fabs(a->x[k] * piece.slope);
        for (int i = 0; i < piece.n_terms; i++) {
            add_term(&piece.term[i], a->x[k], c);
        }
    }
    c->of.value += c->of.straight;
    c->of.derivative[0] += c->of.rise;
}

bool dalcs_control_is_straight(const struct dalcs_control *control, int pair, double t) {
    const struct dalcs_csr *a = &control->system->direct_control;
    struct course c = {.of.swing = 0.0};
    for (int k = a->p[pair]; k < a->p[pair + 1]; k++) {
        const struct dalcs_stimulus *s = dalcs_control_stimulus(control, a->j[k]);
        if (s == NULL || dalcs_stimulus_n_terms(s) == 0) {
            continue;
        }
        struct dalcs_stimulus_piece piece = {.term = control->term};
        dalcs_stimulus_piece_at(s, t, &piece);
        for (int i = 0; i < piece.n_terms; i++) {
            add_term(&piece.term[i], a->x[k], &c);
        }
    }
    return c.of.swing == 0.0;
}

bool dalcs_control_follow(const struct dalcs_control *control, int pair, double sign,
                          double threshold, double edge, double *t) {
    double start = *t;
    for (int k = 0; k < DALCS_COURSE_LOOKS && *t < edge; k++) {
        struct course c;
        look(control, pair, *t, &c);
        double rounding =
            dalcs_sum_rounded * (c.size + fabs(threshold)) + dalcs_rounded * *t * c.rate;
        if (dalcs_course_advance(&c.of, sign, threshold, rounding, start, edge, t)) {
            return true;
        }
    }
    return false;
}

/* course.c - derivatives of a sum of stimuli, and going along it by a bound of the second. */
#include "course.h"

#include "rounding.h"

#include <math.h>

/* Just before a time means so many roundings of it earlier: none of the edges at it. */
static const double just_before = 64.0 * DBL_EPSILON;

double dalcs_sum_value(const struct dalcs_stimulus_sum *sum, double t, enum dalcs_side side) {
    double value = sum->constant;
    for (int k = 0; k < sum->n; k++) {
        value += sum->part[k].factor * dalcs_stimulus_value(sum->part[k].of, t, side);
    }
    return value;
}

double dalcs_sum_next_edge(const struct dalcs_stimulus_sum *sum, double t) {
    double edge = INFINITY;
    for (int k = 0; k < sum->n; k++) {
        edge = fmin(edge, dalcs_stimulus_next_edge(sum->part[k].of, t));
    }
    return edge;
}

/* The sizes of the value and of its derivatives: those of all terms together. */
struct sizes {
    double of[DALCS_COURSE_ORDERS + 2];
};

static void add_term(const struct dalcs_stimulus_term *term, struct dalcs_course *c,
                     struct sizes *sizes) {
    double cosine = term->cosine;
    double sine = term->sine;
    double size = hypot(cosine, sine);
    if (size == 0.0) {
        return;
    }
    const double speed = term->decay == 0.0 ? fabs(term->omega) : hypot(term->decay, term->omega);
    double grown = size;
    c->value += cosine;
    if (term->decay < 0.0) { /* it grows by a factor of e up to there */
        c->reach = fmin(c->reach, -1.0 / term->decay);
        grown *= 2.718281828459045;
    }
    c->swing += grown;
    c->bend += speed * speed * grown;
    for (int k = 0; k < DALCS_COURSE_ORDERS; k++) {
        sizes->of[k] += size;
        size *= speed;
        const double next = term->omega * sine - term->decay * cosine;
        sine = -term->omega * cosine - term->decay * sine;
        cosine = next;
        c->derivative[k] += cosine;
    }
    sizes->of[DALCS_COURSE_ORDERS] += size;
    sizes->of[DALCS_COURSE_ORDERS + 1] += size * speed;
}

static void add_part(const struct dalcs_stimulus_summand *part, double t,
                     struct dalcs_stimulus_piece *piece, struct dalcs_course *c,
                     struct sizes *sizes) {
    dalcs_stimulus_course_at(part->of, t, piece);
    c->straight += part->factor * piece->level;
    c->rise += part->factor * piece->slope;
    sizes->of[0] += fabs(part->factor * piece->level);
    sizes->of[1] += fabs(part->factor * piece->slope);
    for (int i = 0; i < piece->n_terms; i++) {
        piece->term[i].cosine *= part->factor;
        piece->term[i].sine *= part->factor;
        add_term(&piece->term[i], c, sizes);
    }
}

void dalcs_course_look(const struct dalcs_stimulus_sum *sum, double t, enum dalcs_side side,
                       struct dalcs_stimulus_term *term, struct dalcs_course *c) {
    struct sizes sizes = {{fabs(sum->constant)}};
    const bool before = side == DALCS_LEFT;
    *c = (struct dalcs_course){.straight = sum->constant, .reach = INFINITY, .before = before};
    const double at = before ? t - just_before * t : t;
    for (int k = 0; k < sum->n && (!before || t > 0.0); k++) {
        struct dalcs_stimulus_piece piece = {.term = term};
        add_part(&sum->part[k], at, &piece, c, &sizes);
        term += piece.n_terms;
    }
    c->derivative[0] += c->rise;
    c->value = before ? dalcs_sum_value(sum, t, side) : c->value + c->straight;
    c->rounding =
        dalcs_sum_rounded * (sizes.of[0] + fabs(c->value)) + dalcs_rounded * t * sizes.of[1];
    for (int k = 0; k < DALCS_COURSE_ORDERS; k++) {
        c->rounded[k] = dalcs_sum_rounded * sizes.of[k + 1] + just_before * t * sizes.of[k + 2];
    }
}

int dalcs_course_side(const struct dalcs_course *c, double threshold) {
    const double above = c->value - threshold;
    if (fabs(above) > c->rounding + dalcs_sum_rounded * fabs(threshold)) {
        return above > 0.0 ? 1 : -1;
    }
    int way = 1;
    for (int k = 0; k < DALCS_COURSE_ORDERS; k++) {
        way = c->before ? -way : way;
        if (fabs(c->derivative[k]) > c->rounded[k]) {
            return c->derivative[k] > 0.0 ? way : -way;
        }
    }
    return 0;
}

/* s; before that it is not below 0: a parabola that bends down as much as anything of it may. */
static double earliest_fall(double value, double slope, double bend) {
    const double root = sqrt(slope * slope + 2.0 * bend * value);
    if (slope < 0.0) {
        return 2.0 * value / (root - slope);
    }
    return bend > 0.0 ? (slope + root) / bend : INFINITY;
}

bool dalcs_course_advance(const struct dalcs_course *c, double sign, double threshold,
                          double rounding, double start, double edge, double *t) {
    const double above = sign * (c->value - threshold);
    const double slope = sign * c->derivative[0];
    if (above < -0.5 * rounding) {
        *t = slope < 0.0 ? fmax(start, *t - above / slope) : *t;
        return true;
    }
    const double line = sign * (c->straight - threshold);
    const double last =
        isfinite(edge) ? line + sign * c->rise * (edge - *t) : (c->rise == 0.0 ? line : -INFINITY);
    const bool stays = c->reach == INFINITY && fmin(line, last) > c->swing;
    const double tau = earliest_fall(fmax(above, 0.0) + rounding, slope, c->bend);
    *t = stays ? edge : fmin(edge, *t + fmin(tau, c->reach));
    return false;
}

/* Counted from the edge, which is the same from wherever one looks, so that the crossing is, too. */
static bool passes_on_line(const struct dalcs_stimulus_sum *sum, double sign, double threshold,
                           double edge, double *t) {
    const double last = isfinite(edge) ? dalcs_sum_value(sum, edge, DALCS_LEFT) : threshold;
    const double above = sign * (last - threshold);
    const double from = *t;
    *t = edge;
    if (!(above < 0.0)) {
        return false;
    }
    const double first = dalcs_sum_value(sum, from, DALCS_RIGHT);
    const double fall = fmax(sign * (first - last), -above);
    *t = fmax(from, edge - (edge - from) * (-above / fall));
    /* far before the edge, the last digit of that is more than the last one of t: once more from there */
    if (*t < 0.5 * edge) {
        const double rest = sign * (dalcs_sum_value(sum, *t, DALCS_RIGHT) - threshold);
        *t = fmax(from, *t + (edge - from) * (rest / fall));
    }
    return true;
}

bool dalcs_course_passes(const struct dalcs_stimulus_sum *sum, int sign, double threshold,
                         double edge, double *t) {
    struct dalcs_stimulus_term term[DALCS_STIMULUS_MOST_TERMS];
    const double start = *t;
    for (int k = 0; k < DALCS_COURSE_LOOKS && *t < edge; k++) {
        struct dalcs_course c;
        dalcs_course_look(sum, *t, DALCS_RIGHT, term, &c);
        if (c.swing == 0.0) {
            return passes_on_line(sum, sign, threshold, edge, t);
        }
        const double rounding = c.rounding + dalcs_sum_rounded * fabs(threshold);
        if (dalcs_course_advance(&c, sign, threshold, rounding, start, edge, t)) {
            return true;
        }
    }
    return false;
}

/* algebraic_poles.c - poles of a part without memory: nothing in it changes sides, so between two edges of its sources it
 * is analytic but where a function has no value. */
#include "algebraic_poles.h"

#include "magnitudes.h"
#include "smooth_newton.h"
#include "smooth_poles.h"

#include <math.h>
#include <string.h>

/* Between two times. */
struct span {
    const struct dalcs_radau *r;
    struct dalcs_component *c;
    struct dalcs_smooth_newton *newton;
    double (*before)[2], (*after)[2],
        (*most)[2]; /* [n_smooth] arguments, and the largest of both */
    double from, to;
};

static struct span make(const struct dalcs_radau *r, struct dalcs_radau_part *part) {
    struct dalcs_smooth_newton *newton = part->component->osnsp.smooth.newton;
    const int n = newton->system->n_smooth;
    return (struct span){.r = r,
                         .c = part->component,
                         .newton = newton,
                         .before = newton->other,
                         .after = newton->other + n,
                         .most = newton->other + 2 * n};
}

static void keep(const struct span *span, double (*x)[2]) {
    memcpy(x, span->newton->x, (size_t)span->newton->n * sizeof(*x));
}

bool dalcs_algebraic_poles_expect(const struct dalcs_radau_part *part, double t) {
    const struct dalcs_smooth_newton *newton = part->component->osnsp.smooth.newton;
    const bool may = newton != NULL && part->is_answered && t > part->answered_at &&
                     dalcs_smooth_may_have_poles(newton->system);
    if (may) {
        memcpy(newton->other, newton->x, (size_t)newton->n * sizeof(*newton->x));
    }
    return may;
}

static enum dalcs_status solve(struct dalcs_component *c, double t, enum dalcs_side side) {
    dalcs_component_look_ahead(c, t, side, c->u);
    return dalcs_component_solve(c, 0.0, c->u, c->y);
}

static bool turns(const struct span *span, int k, int j, const double (*after)[2]) {
    return dalcs_smooth_turns(&span->newton->system->smooth[k], j, span->before[k], after[k]);
}

static bool any_turns(const struct span *span, const double (*after)[2]) {
    bool any = false;
    for (int q = 0; q < 2 * span->newton->n && !any; q++) {
        any = turns(span, q / 2, q % 2, after);
    }
    return any;
}

/* When argument j of source k makes a pole or jumps over it; newton->x is of that time. *fails: nothing has a value there. */
static double find_turn(const struct span *span, int k, int j, bool *fails) {
    const struct dalcs_smooth_input *of = &span->newton->system->smooth[k];
    const bool is_above = dalcs_smooth_zero(of, j, span->after[k]) > 0.0;
    double from = span->from;
    double to = span->to;
    *fails = false;
    while (!*fails && to - from > span->r->resolution) {
        const double middle = from + 0.5 * (to - from);
        *fails = solve(span->c, middle, DALCS_LEFT) != DALCS_OK;
        if (*fails || (dalcs_smooth_zero(of, j, span->newton->x[k]) > 0.0) == is_above) {
            to = middle;
        } else {
            from = middle;
        }
    }
    return to;
}

/* Has the source a pole where argument j of source k has turned, at newton->x? -1: none. What jumps over 0 is not near it. */
static int pole_at(const struct span *span, int k, int j, bool fails) {
    const struct dalcs_smooth_input *of = &span->newton->system->smooth[k];
    const double size = of->kind == DALCS_SMOOTH_TAN ? 1.0 : span->most[k][j];
    const struct dalcs_smooth_places places = {.before = (const double(*)[2])span->before,
                                               .after = (const double(*)[2])span->after,
                                               .at = (const double(*)[2])span->newton->x,
                                               .most = (const double(*)[2])span->most,
                                               .tolerance = dalcs_alike};
    return fails || fabs(dalcs_smooth_zero(of, j, span->newton->x[k])) <= dalcs_alike * size
               ? dalcs_smooth_pole(span->newton->system, k, j, &places)
               : -1;
}

/* The source with the first pole between two edges, at *t; -1: none. */
static int find_pole(const struct span *span, double *t) {
    int found = -1;
    double x[2] = {0.0, 0.0};
    for (int q = 0; q < 2 * span->newton->n; q++) {
        if (!turns(span, q / 2, q % 2, (const double(*)[2])span->after)) {
            continue;
        }
        bool fails;
        const double turn = find_turn(span, q / 2, q % 2, &fails);
        const int pole = pole_at(span, q / 2, q % 2, fails);
        if (pole >= 0 && (found < 0 || turn < *t)) {
            found = pole;
            *t = turn;
            memcpy(x, span->newton->x[pole], sizeof x);
        }
    }
    if (found >= 0) {
        dalcs_smooth_newton_blame_pole(span->newton, found, x);
    }
    return found;
}

/* From edge to edge. */
static enum dalcs_status look_in(struct span *span, double from, double *t) {
    const double to = *t;
    enum dalcs_status status = DALCS_OK;
    for (double since = from; since < to && status == DALCS_OK; since = span->to) {
        span->from = *t = since;
        span->to = fmin(to, dalcs_component_next_edge(span->c, since));
        DALCS_TRY(solve(span->c, since, DALCS_RIGHT));
        keep(span, span->before);
        *t = span->to;
        DALCS_TRY(solve(span->c, span->to, DALCS_LEFT));
        keep(span, span->after);
        for (int q = 0; q < 2 * span->newton->n; q++) {
            span->most[q / 2][q % 2] =
                fmax(fabs(span->before[q / 2][q % 2]), fabs(span->after[q / 2][q % 2]));
        }
        status = find_pole(span, t) >= 0 ? DALCS_NOT_CONVERGED : DALCS_OK;
    }
    return status;
}

enum dalcs_status dalcs_algebraic_poles_check(const struct dalcs_radau *r,
                                              struct dalcs_radau_part *part, double from, double *t,
                                              enum dalcs_side side) {
    struct span span = make(r, part);
    if (!(dalcs_component_next_edge(span.c, from) < *t) &&
        !any_turns(&span, (const double(*)[2])span.newton->x)) {
        return DALCS_OK;
    }
    const double asked = *t;
    DALCS_TRY(look_in(&span, from, t));
    *t = asked;
    return solve(span.c, asked, side);
}

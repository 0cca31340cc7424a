/* slide_memory.c - formulas that jump and hold each other: a hysteresis made of comparators.
 *
 * With switches and diodes where they are, the argument of each jump is a sum of what the outputs of jumps add to it: D is
 * what each output adds to each argument. An output that adds to its own argument, or two that add to each other's, may be on
 * either side. Then -D has a principal minor below 0. Such formulas have no place between their sides, as a switch with
 * hysteresis has none. Beside smooth functions an argument is no such sum, and more jumps than D has rows are not looked at. */
#include "several_parts.h"

#include "rounding.h"

#include <math.h>
#include <string.h>

struct loop {
    int n;
    int of[DALCS_MOST_SEVERAL]; /* jumps that turn */
    double adds[DALCS_MOST_SEVERAL]
               [DALCS_MOST_SEVERAL]; /* to the argument of the first, by the second */
};

/* What the output of the k-th adds to each argument, from y and w, the answer here. An argument that the output has no part in
 * differs by the rounding of both answers, either way: that adds nothing. */
static enum dalcs_status find_added(struct dalcs_positions *p, const double *u, const double *y,
                                    const double *w, int k, struct loop *of) {
    const int j = of->of[k];
    const bool is_on = dalcs_osnsp_is_on(p->osnsp, dalcs_turning_pair(p, j));
    dalcs_turning_put(p, j, !is_on);
    enum dalcs_status status = dalcs_osnsp_answer(p->osnsp, u, p->sides.y);
    memcpy(p->osnsp->mode, p->present, (size_t)p->osnsp->n_words * sizeof(*p->present));
    for (int i = 0; i < of->n; i++) {
        const double now = dalcs_turning_beyond(p, of->of[i], p->sides.y, p->osnsp->w);
        const double added = now - dalcs_turning_beyond(p, of->of[i], y, w);
        const bool adds = status == DALCS_OK && fabs(added) > 2.0 * p->slack[of->of[i]];
        of->adds[i][k] = !adds ? 0.0 : is_on ? -added : added;
    }
    return status < DALCS_OK ? status : DALCS_OK;
}

/* The minor of -adds with these rows and columns, as bits; *size: the sum of the sizes of its terms. */
static double find_minor(const struct loop *of, unsigned rows, unsigned columns, double *size) {
    double minor = 0.0;
    double sign = 1.0;
    *size = 0.0;
    if (rows == 0) {
        *size = 1.0;
        return 1.0;
    }
    const int row = __builtin_ctz(rows);
    for (int k = 0; k < of->n; k++) {
        if ((columns >> k & 1) != 0) {
            double rest;
            const double of_rest = find_minor(of, rows & ~(1u << row), columns & ~(1u << k), &rest);
            minor -= sign * of->adds[row][k] * of_rest;
            *size += fabs(of->adds[row][k]) * rest;
            sign = -sign;
        }
    }
    return minor;
}

static bool holds_itself(const struct loop *of) {
    bool does = false;
    for (unsigned some = 1; some < 1u << of->n && !does; some++) {
        double size;
        const double minor = find_minor(of, some, some, &size);
        does = minor < -dalcs_answer_rounded * size;
    }
    return does;
}

enum dalcs_status dalcs_turning_find_memory(struct dalcs_positions *p, const double *u,
                                            const double *y, bool *remembers) {
    const size_t bytes = (size_t)p->osnsp->system->n_pairs * sizeof(double);
    struct loop of = {0};
    *remembers = false;
    for (int i = p->n; i < dalcs_turning_n(p) && p->osnsp->smooth.newton == NULL; i++) {
        if (dalcs_turning_turns(p, i)) {
            if (of.n == DALCS_MOST_SEVERAL) {
                return DALCS_OK;
            }
            of.of[of.n++] = i;
        }
    }
    memcpy(p->present, p->osnsp->mode, (size_t)p->osnsp->n_words * sizeof(*p->present));
    memcpy(p->sides.w_of_y, p->osnsp->w, bytes);
    enum dalcs_status status = DALCS_OK;
    for (int k = 0; k < of.n && status == DALCS_OK; k++) {
        status = find_added(p, u, y, p->sides.w_of_y, k, &of);
    }
    memcpy(p->osnsp->w, p->sides.w_of_y, bytes);
    *remembers = status == DALCS_OK && holds_itself(&of);
    return status;
}

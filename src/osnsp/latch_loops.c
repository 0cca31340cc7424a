/* latch_loops.c - which jumps of formulas hold each other on their sides, of those that an answer has between them.
 *
 * With the rest of the mode as it is, the argument of each is a sum of what the outputs add to it: D is what each output adds to
 * each argument. An output that adds to its own argument, or two that add to each other's, may be on either side. Then -D has a
 * principal minor below 0, and the point between both sides is none where the circuit stays: outputs that follow with a delay
 * leave it, whatever is nearer. Such a minor lies within jumps each of which acts on each, on the way of others. */
#include "latches.h"

#include "rounding.h"

#include <math.h>

/* The argument of the jump whose first pair is d, in y and p->w. */
double dalcs_latch_argument(const struct dalcs_osnsp *p, const double *y, int d) {
    return y[dalcs_system_n_equations(p->system) + d + 1] - p->w[d];
}

void dalcs_latch_put(struct dalcs_osnsp *p, int d, bool is_above) {
    dalcs_osnsp_command(p, d, is_above);
    dalcs_osnsp_command(p, d + 1, is_above);
}

/* One beyond what rounding of two answers makes of it. */
static double find_added(const struct dalcs_osnsp *p, double above, double below) {
    const double of_both = fabs(above) + fabs(below);
    const double rounding = dalcs_latch_noise(p) + p->options.certificate_tolerance * of_both;
    return fabs(above - below) > rounding ? above - below : 0.0;
}

enum dalcs_status dalcs_latch_find_additions(struct dalcs_osnsp *p, double sigma, const double *u,
                                             struct dalcs_latch_loops *of) {
    double *y = p->latches.y;
    double below[DALCS_MOST_LATCHES];
    for (int k = 0; k < of->n; k++) {
        dalcs_latch_put(p, of->of[k], false);
    }
    DALCS_TRY(dalcs_osnsp_answer_given(p, sigma, u, y));
    for (int i = 0; i < of->n; i++) {
        below[i] = dalcs_latch_argument(p, y, of->of[i]);
    }
    for (int k = 0; k < of->n; k++) {
        dalcs_latch_put(p, of->of[k], true);
        DALCS_TRY(dalcs_osnsp_answer_given(p, sigma, u, y));
        dalcs_latch_put(p, of->of[k], false);
        for (int i = 0; i < of->n; i++) {
            of->adds[i][k] = find_added(p, dalcs_latch_argument(p, y, of->of[i]), below[i]);
        }
    }
    return DALCS_OK;
}

/* Which ones each acts on, as bits, on whatever way (Warshall). */
static void find_reach(const struct dalcs_latch_loops *of, uint32_t *reach) {
    for (int k = 0; k < of->n; k++) {
        reach[k] = 0;
        for (int i = 0; i < of->n; i++) {
            reach[k] |= of->adds[i][k] != 0.0 ? 1u << i : 0u;
        }
    }
    for (int way = 0; way < of->n; way++) {
        for (int k = 0; k < of->n; k++) {
            reach[k] |= (reach[k] >> way & 1) != 0 ? reach[way] : 0u;
        }
    }
}

/* The sign of the principal minor of -adds of `some`, as bits: 0 where rounding may be all of it. By elimination with pivots of
 * columns; a pivot is rounding beside what it was made of. */
static int minor_sign(const struct dalcs_latch_loops *of, uint32_t some) {
    double a[DALCS_MOST_IN_LOOP][DALCS_MOST_IN_LOOP];
    double size[DALCS_MOST_IN_LOOP][DALCS_MOST_IN_LOOP];
    int number[DALCS_MOST_IN_LOOP];
    int n = 0;
    for (int k = 0; k < of->n; k++) {
        if ((some >> k & 1) != 0) {
            number[n++] = k;
        }
    }
    for (int i = 0; i < n * n; i++) {
        a[i / n][i % n] = -of->adds[number[i / n]][number[i % n]];
        size[i / n][i % n] = fabs(a[i / n][i % n]);
    }
    int sign = 1;
    for (int k = 0; k < n && sign != 0; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++) {
            pivot = fabs(a[i][k]) > fabs(a[pivot][k]) ? i : pivot;
        }
        const bool is_rounding = fabs(a[pivot][k]) <= dalcs_answer_rounded * size[pivot][k];
        sign = is_rounding ? 0 : (a[pivot][k] < 0.0) != (pivot != k) ? -sign : sign;
        for (int c = 0; c < n; c++) {
            const double swap[2] = {a[k][c], size[k][c]};
            a[k][c] = a[pivot][c];
            size[k][c] = size[pivot][c];
            a[pivot][c] = swap[0];
            size[pivot][c] = swap[1];
        }
        for (int i = k + 1; i < n && sign != 0; i++) {
            const double by = a[i][k] / a[k][k];
            for (int c = k + 1; c < n; c++) {
                a[i][c] -= by * a[k][c];
                size[i][c] += fabs(by) * size[k][c];
            }
        }
    }
    return sign;
}

/* The least sets of those in `loop` whose minor is below 0; the union of them. */
static uint32_t find_holding(const struct dalcs_latch_loops *of, uint32_t loop) {
    uint32_t least[1u << DALCS_MOST_IN_LOOP];
    int n = 0;
    uint32_t holding = 0;
    /* A set comes behind those that it has in it. */
    for (uint32_t some = loop & -loop; some != 0; some = (some - loop) & loop) {
        bool is_least = true;
        for (int k = 0; k < n && is_least; k++) {
            is_least = (least[k] & some) != least[k];
        }
        if (is_least && minor_sign(of, some) < 0) {
            least[n++] = some;
            holding |= some;
        }
    }
    return holding;
}

enum dalcs_status dalcs_latch_loops_find(struct dalcs_osnsp *p, double sigma, const double *u,
                                         struct dalcs_latch_loops *of, uint32_t *holding) {
    uint32_t reach[DALCS_MOST_LATCHES];
    *holding = 0;
    DALCS_TRY(dalcs_latch_find_additions(p, sigma, u, of));
    find_reach(of, reach);
    for (int k = 0; k < of->n; k++) {
        uint32_t loop = 0;
        for (int i = 0; i < of->n; i++) {
            loop |= (reach[k] >> i & 1) != 0 && (reach[i] >> k & 1) != 0 ? 1u << i : 0u;
        }
        const bool is_first = loop != 0 && __builtin_ctz(loop) == k;
        if (is_first && __builtin_popcount(loop) <= DALCS_MOST_IN_LOOP) {
            *holding |= find_holding(of, loop);
        }
    }
    return DALCS_OK;
}

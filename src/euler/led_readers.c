/* led_readers.c - what reads the output of a jump that is between its sides.
 *
 * Such a jump stands for one that goes from side to side without end: each signal has the mean of what it is on both sides, by the
 * parts of the time (sliding.h). What is linear in the output has the same mean where the output is between its sides. What stands
 * on sides of its own, as a comparator, a diode or a switch, or is curved, does not: 0.7 of the time beyond a threshold is not 0.7
 * beyond it all the time. So the answers on both sides are asked. A pair counts if the output moves what tells its side, though it
 * may stand on one side in both at present: sources go on, and what it does between them tells nothing of when it turns in one of
 * them. What is curved counts if the answers, mixed by the parts that the output tells, are not the answer between them. What goes
 * on through the event is a little off in a step, so what vanishes with the step does not count.
 */
#include "several_parts.h"

#include "extremes.h"
#include "power_of_step.h"

#include <math.h>
#include <string.h>

/* Of the jumps that lead: each is above for a part of the time. */
struct parts {
    int n;
    int of[DALCS_MOST_SEVERAL]; /* of p->latches */
    double above[DALCS_MOST_SEVERAL];
};

/* Returns whether they are few enough to ask on all sides. */
static bool find_parts(const struct dalcs_osnsp *p, const double *y, struct parts *of) {
    const double *lambda = y + dalcs_system_n_equations(p->system);
    of->n = 0;
    for (int k = 0; k < p->latches.n; k++) {
        if (dalcs_latch_leads(p->latches.role[k])) {
            if (of->n == DALCS_MOST_SEVERAL) {
                return false;
            }
            const int d = p->latches.jump[k];
            of->above[of->n] = lambda[d] / (lambda[d] + p->w[d + 1]);
            of->of[of->n++] = k;
        }
    }
    return true;
}

static double weight_of(const struct parts *of, int corner) {
    double weight = 1.0;
    for (int g = 0; g < of->n; g++) {
        weight *= (corner >> g & 1) != 0 ? of->above[g] : 1.0 - of->above[g];
    }
    return weight;
}

/* The answer with those that lead on the sides of a corner, and switches that agree. */
static enum dalcs_status answer(struct dalcs_positions *p, const struct parts *of, double sigma,
                                const double *u, int corner, bool *found) {
    struct dalcs_osnsp *o = p->osnsp;
    memcpy(o->mode, p->present, (size_t)o->n_words * sizeof(*o->mode));
    for (int g = 0; g < of->n; g++) {
        const int d = o->latches.jump[of->of[g]];
        dalcs_osnsp_command(o, d, (corner >> g & 1) != 0);
        dalcs_osnsp_command(o, d + 1, (corner >> g & 1) != 0);
    }
    *found = false;
    for (int round = 0; round <= p->n; round++) {
        DALCS_TRY(dalcs_osnsp_answer_led(o, sigma, u, dalcs_corner_y(p, corner), found));
        if (!*found || !dalcs_positions_move_all_once(p, dalcs_corner_y(p, corner))) {
            break;
        }
        *found = false;
    }
    memcpy(dalcs_corner_mode(p, corner), o->mode, (size_t)o->n_words * sizeof(*o->mode));
    memcpy(dalcs_corner_w(p, corner), o->w, (size_t)o->system->n_pairs * sizeof(double));
    return DALCS_OK;
}

/* How far what the mean of the corners has in a column is from y, the answer between them; 0: rounding may be all of it. */
static double difference(const struct dalcs_positions *p, const struct parts *of, const double *y,
                         int column, const double rounding[2]) {
    const double one = y[column];
    double mean = 0.0;
    double size = fabs(one);
    for (int corner = 0; corner < 1 << of->n; corner++) {
        const double at = weight_of(of, corner) * dalcs_corner_y(p, corner)[column];
        mean += at;
        size += fabs(at);
    }
    const double most = rounding[p->osnsp->system->column_is_current[column]] +
                        p->osnsp->options.certificate_tolerance * size;
    return fabs(mean - one) > most ? mean - one : 0.0;
}

static bool is_of_leading(const struct dalcs_positions *p, const struct parts *of, int column) {
    const int pair = column - dalcs_system_n_equations(p->osnsp->system);
    bool is = false;
    for (int g = 0; g < of->n; g++) {
        const int d = p->osnsp->latches.jump[of->of[g]];
        is = is || pair == d || pair == d + 1;
    }
    return is;
}

/* What tells on which side a pair stands, in a corner: the control of a switch that reads the circuit, else what is not 0 of its two. */
static double standing(const struct dalcs_positions *p, int pair, int corner) {
    const struct dalcs_system *s = p->osnsp->system;
    const double *y = dalcs_corner_y(p, corner);
    const bool is_switch = s->pair[pair].kind == DALCS_PAIR_SWITCH;
    return is_switch ? dalcs_csr_row_dot(&s->control, pair, y)
                     : y[dalcs_system_n_equations(s) + pair] - dalcs_corner_w(p, corner)[pair];
}

/* By how much an output moves that. */
static double find_moved(const struct dalcs_positions *p, const struct parts *of, int pair,
                         double rounding) {
    double moved = 0.0;
    for (int g = 0; g < of->n; g++) {
        const double above = standing(p, pair, 1 << g);
        const double below = standing(p, pair, 0);
        const double most =
            rounding + p->osnsp->options.certificate_tolerance * (fabs(above) + fabs(below));
        const double by = fabs(above - below);
        moved = by > most ? dalcs_larger(moved, by) : moved;
    }
    return moved;
}

/* Into off[n_columns + n_pairs], of a step with the answer y between the corners. *found: there is an answer in all of these. */
static enum dalcs_status find_differences(struct dalcs_positions *p, double sigma, const double *u,
                                          const double *y, double *off, bool *found) {
    const struct dalcs_osnsp *o = p->osnsp;
    const struct dalcs_system *s = o->system;
    const int n_columns = dalcs_system_n_columns(s);
    struct parts of;
    double rounding[2] = {o->certificate.volt, o->certificate.ampere};
    *found = find_parts(o, y, &of);
    for (int corner = 0; corner < 1 << of.n && *found; corner++) {
        DALCS_TRY(answer(p, &of, sigma, u, corner, found));
        rounding[0] = dalcs_larger(rounding[0], o->certificate.volt);
        rounding[1] = dalcs_larger(rounding[1], o->certificate.ampere);
    }
    rounding[0] *= o->options.certificate_tolerance;
    rounding[1] *= o->options.certificate_tolerance;
    for (int c = 0; c < n_columns && *found; c++) {
        const bool counts = c >= s->n_x && !is_of_leading(p, &of, c);
        off[c] = counts ? difference(p, &of, y, c, rounding) : 0.0;
    }
    for (int d = 0; d < s->n_pairs && *found; d++) {
        const bool counts = !is_of_leading(p, &of, dalcs_system_n_equations(s) + d);
        const double most = dalcs_larger(rounding[0], rounding[1]);
        off[n_columns + d] = counts ? find_moved(p, &of, d, most) : 0.0;
    }
    return DALCS_OK;
}

static int n_compared(const struct dalcs_system *s) {
    return dalcs_system_n_columns(s) + s->n_pairs;
}

static bool has_any(const struct dalcs_system *s, const double *off) {
    bool has = false;
    for (int c = 0; c < n_compared(s) && !has; c++) {
        has = off[c] != 0.0;
    }
    return has;
}

/* In half of the step, which begins in the same mode. What is there as well, and does not vanish with the step, is at once. */
static enum dalcs_status compare_half(struct dalcs_positions *p, double sigma, const double *u,
                                      const double *whole, bool *differs) {
    struct dalcs_osnsp *o = p->osnsp;
    const struct dalcs_system *s = o->system;
    double *y = p->other_y;
    double *half = p->sides.off + n_compared(s);
    bool found;
    memcpy(o->mode, p->present, (size_t)o->n_words * sizeof(*o->mode));
    const enum dalcs_status status = dalcs_osnsp_solve(o, 2.0 * sigma, u, y);
    if (status != DALCS_OK) {
        return status < DALCS_OK ? status : DALCS_OK;
    }
    DALCS_TRY(find_differences(p, 2.0 * sigma, u, y, half, &found));
    for (int c = 0; c < n_compared(s) && found && !*differs; c++) {
        *differs =
            half[c] != 0.0 && whole[c] != 0.0 && dalcs_power_of_step(whole[c], half[c]) <= 0.0;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_positions_compare_readers(struct dalcs_positions *p, double sigma,
                                                  const double *u, double *y) {
    struct dalcs_osnsp *o = p->osnsp;
    bool found;
    bool differs = false;
    memcpy(p->present, o->mode, (size_t)o->n_words * sizeof(*o->mode));
    DALCS_TRY(find_differences(p, sigma, u, y, p->sides.off, &found));
    if (found && has_any(o->system, p->sides.off)) {
        DALCS_TRY(compare_half(p, sigma, u, p->sides.off, &differs));
    }
    memcpy(o->mode, p->present, (size_t)o->n_words * sizeof(*o->mode));
    const enum dalcs_status status = dalcs_osnsp_solve(o, sigma, u, y);
    o->latches.are_read = differs;
    o->latches.are_compared = true;
    return status;
}

enum dalcs_status dalcs_positions_find_held(struct dalcs_positions *p, double sigma,
                                            const double *u, double *y, const char **held) {
    const struct dalcs_osnsp *o = p->osnsp;
    *held = NULL;
    if (!p->settled || !dalcs_osnsp_has_leading(o)) {
        return DALCS_OK;
    }
    if (!dalcs_osnsp_has_led(o) && !o->latches.are_compared) {
        DALCS_TRY(dalcs_positions_compare_readers(p, sigma, u, y));
    }
    for (int k = 0; k < o->latches.n && dalcs_osnsp_has_led(o) && *held == NULL; k++) {
        *held = dalcs_latch_leads(o->latches.role[k]) ? o->system->pair[o->latches.jump[k]].element
                                                      : NULL;
    }
    return DALCS_OK;
}

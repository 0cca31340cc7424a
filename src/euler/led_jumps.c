/* led_jumps.c - between the sides of a comparator that others follow (latch_led.c).
 *
 * A one-step problem has an answer with all of them at their thresholds. With a small delay they leave it, and go from side to side
 * together. So the answers on both sides are what switches have that alternate: a mean of them is for sliding.c to find. As
 * there, a jump that leads is in the mode of each where its argument asks for it, and its output is that of the other one. */
#include "positions.h"

#include <string.h>

static double argument(const struct dalcs_osnsp *p, int d, const double *y) {
    return y[dalcs_system_n_equations(p->system) + d + 1] - p->w[d];
}

/* In the answer y: do all that lead ask for this side? Those that follow stand where they are. */
static bool all_ask_for(const struct dalcs_osnsp *p, const double *y, bool is_above) {
    bool all = true;
    for (int k = 0; k < p->latches.n; k++) {
        const enum dalcs_latch_role role = p->latches.role[k];
        const bool is_asked = argument(p, p->latches.jump[k], y) > 0.0;
        all = all &&
              (!dalcs_latch_leads(role) || is_asked == (is_above == (role == DALCS_LATCH_LEADS)));
    }
    return all;
}

static void put_leading(struct dalcs_osnsp *p, bool is_above) {
    for (int k = 0; k < p->latches.n; k++) {
        const enum dalcs_latch_role role = p->latches.role[k];
        if (dalcs_latch_leads(role)) {
            const bool is_on = is_above == (role == DALCS_LATCH_LEADS);
            dalcs_osnsp_command(p, p->latches.jump[k], is_on);
            dalcs_osnsp_command(p, p->latches.jump[k] + 1, is_on);
        }
    }
}

/* The answer where those that lead are on a side, with switches that agree. */
static enum dalcs_status answer(struct dalcs_positions *p, double sigma, const double *u,
                                bool is_above, double *y, bool *found) {
    put_leading(p->osnsp, is_above);
    for (int round = 0; round <= p->n; round++) {
        DALCS_TRY(dalcs_osnsp_answer_led(p->osnsp, sigma, u, y, found));
        if (!*found || !dalcs_positions_move_all_once(p, y)) {
            return DALCS_OK;
        }
        *found = false;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_positions_part_led(struct dalcs_positions *p, double sigma, const double *u,
                                           double *y) {
    struct dalcs_osnsp *o = p->osnsp;
    const size_t bytes = (size_t)o->n_words * sizeof(*o->mode);
    bool found;
    if (!p->settled || !dalcs_osnsp_has_leading(o)) {
        return DALCS_OK;
    }
    if (!dalcs_osnsp_has_led(o)) {
        DALCS_TRY(dalcs_positions_compare_readers(p, sigma, u, y));
        if (!dalcs_osnsp_has_led(o)) {
            return DALCS_OK;
        }
    }
    memcpy(p->present, o->mode, bytes);
    DALCS_TRY(answer(p, sigma, u, false, p->other_y, &found));
    const bool stays_below = found && all_ask_for(o, p->other_y, false);
    if (stays_below) {
        memcpy(y, p->other_y, (size_t)dalcs_system_n_columns(o->system) * sizeof(*y));
        return DALCS_OK;
    }
    const bool leaves_below = found && all_ask_for(o, p->other_y, true);
    put_leading(o, true);
    memcpy(p->other, o->mode, bytes);
    memcpy(p->other_w, o->w, (size_t)o->system->n_pairs * sizeof(double));
    memcpy(o->mode, p->present, bytes);
    DALCS_TRY(answer(p, sigma, u, true, y, &found));
    if (found && all_ask_for(o, y, true)) {
        return DALCS_OK;
    }
    if (found && leaves_below && all_ask_for(o, y, false)) {
        put_leading(o, false);
        p->settled = false;
        p->alternates = p->are_led = true;
        return DALCS_OK;
    }
    memcpy(o->mode, p->present, bytes);
    return dalcs_osnsp_solve(o, sigma, u, y);
}

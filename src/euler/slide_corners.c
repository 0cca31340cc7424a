/* slide_corners.c - the answers on all sides of several that slide: a corner has a bit for each group, which is on its other
 * side. */
#include "sliding_internal.h"

#include <string.h>

/* Those that slide stand as in a corner, and the rest of those that lead on their side. */
static bool is_on_other(const struct dalcs_positions *p, int i, int corner) {
    const int g = p->sides.group[i];
    return g >= 0 ? (corner >> g & 1) != 0 : p->sides.is_other[p->sides.kin[i]];
}

static void put_leading(struct dalcs_positions *p, int corner) {
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        if (p->sides.kin[i] >= 0) {
            dalcs_turning_put(p, i, dalcs_turning_is_on_at(p, i, is_on_other(p, i, corner)));
        }
    }
}

/* All diodes whose sign is wrong change sides, or the last of them alone (Murty; osnsp.h). Returns whether there are any. */
static bool flip_diodes(struct dalcs_positions *p, bool all, bool are_jumps_whole) {
    const struct dalcs_osnsp *o = p->osnsp;
    bool any = false;
    for (int k = o->signs.n_violating - 1; k >= 0 && (all || !any); k--) {
        const int pair = o->signs.violating[k];
        if (!dalcs_turning_is_of_jump(p, pair, !are_jumps_whole)) {
            dalcs_osnsp_command(p->osnsp, pair, !dalcs_osnsp_is_on(o, pair));
            any = true;
        }
    }
    return any;
}

/* Switches go where the answer y has them. The answers on the way to a corner are none of the circuit: a switch with
 * hysteresis remembers p->present, not these. Returns whether something changed. */
static bool put_switches(struct dalcs_positions *p, const double *y) {
    bool any = false;
    for (int i = 0; i < p->n; i++) {
        if (p->sides.kin[i] < 0 && dalcs_positions_moves_from(p, i, p->present, y)) {
            dalcs_turning_put(p, i, !dalcs_osnsp_is_on(p->osnsp, p->pair[i]));
            any = true;
        }
    }
    return any;
}

/* All but what leads goes where the answers have it, diodes first. A jump whose output commands switches alone has no answer
 * between its sides: where one is met, jumps go from side to side as a whole. */
static enum dalcs_status find_corner_by(struct dalcs_positions *p, const double *u, int corner,
                                        bool are_jumps_whole, bool *is_complete) {
    struct dalcs_osnsp *o = p->osnsp;
    const int n_pairs = o->system->n_pairs;
    double *y = dalcs_corner_y(p, corner);
    memcpy(o->mode, p->present, (size_t)o->n_words * sizeof(*o->mode));
    put_leading(p, corner);
    *is_complete = false;
    for (int round = 0; round <= 2 * n_pairs && !*is_complete; round++) {
        enum dalcs_status status = dalcs_osnsp_answer(o, u, y);
        if (status != DALCS_OK) {
            return status < DALCS_OK ? status : DALCS_OK;
        }
        *is_complete = !flip_diodes(p, round < n_pairs, are_jumps_whole) &&
                       !(are_jumps_whole && dalcs_turning_put_followers(p, y)) &&
                       !put_switches(p, y);
    }
    return DALCS_OK;
}

/* The same by the whole one-step problem, where turning diodes one by one does not come to their mode. It has jumps where
 * their arguments are: for those that lead there is none. */
static enum dalcs_status solve_corner(struct dalcs_positions *p, const double *u, int corner,
                                      bool *is_complete) {
    struct dalcs_osnsp *o = p->osnsp;
    double *y = dalcs_corner_y(p, corner);
    memcpy(o->mode, p->present, (size_t)o->n_words * sizeof(*o->mode));
    put_leading(p, corner);
    for (int round = 0; round <= 2 * p->n && !*is_complete; round++) {
        enum dalcs_status status = dalcs_osnsp_solve(o, p->sides.sigma, u, y);
        if (status != DALCS_OK) {
            return status < DALCS_OK ? status : DALCS_OK;
        }
        *is_complete = !put_switches(p, y);
    }
    return DALCS_OK;
}

/* The same where comparators follow those that lead (led_jumps.c). */
static enum dalcs_status solve_led_corner(struct dalcs_positions *p, const double *u, int corner,
                                          bool *is_complete) {
    struct dalcs_osnsp *o = p->osnsp;
    double *y = dalcs_corner_y(p, corner);
    memcpy(o->mode, p->present, (size_t)o->n_words * sizeof(*o->mode));
    put_leading(p, corner);
    for (int round = 0; round <= 2 * p->n && !*is_complete; round++) {
        DALCS_TRY(dalcs_osnsp_answer_led(o, p->sides.sigma, u, y, is_complete));
        if (!*is_complete) {
            return DALCS_OK;
        }
        *is_complete = !put_switches(p, y);
    }
    return DALCS_OK;
}

static enum dalcs_status find_corner(struct dalcs_positions *p, const double *u, int corner,
                                     bool *is_complete) {
    const struct dalcs_osnsp *o = p->osnsp;
    *is_complete = false;
    if (p->are_led) {
        DALCS_TRY(solve_led_corner(p, u, corner, is_complete));
    } else {
        DALCS_TRY(find_corner_by(p, u, corner, false, is_complete));
    }
    if (!*is_complete && p->n_jumps > 0) {
        DALCS_TRY(find_corner_by(p, u, corner, true, is_complete));
    }
    if (!*is_complete && p->n_jumps == 0) {
        DALCS_TRY(solve_corner(p, u, corner, is_complete));
    }
    memcpy(dalcs_corner_w(p, corner), o->w, (size_t)o->system->n_pairs * sizeof(double));
    memcpy(dalcs_corner_mode(p, corner), o->mode, (size_t)o->n_words * sizeof(*o->mode));
    return DALCS_OK;
}

/* On one side of all, and on the other side of all, the answers are known: y with p->sides.w_of_y, and p->other_y. Where jumps
 * lead their modes are not those of the answers (sliding.c). */
static bool is_known(struct dalcs_positions *p, const double *y, int corner) {
    const struct dalcs_system *s = p->osnsp->system;
    bool is[2] = {p->n_jumps == 0, p->n_jumps == 0};
    for (int i = 0; i < p->n; i++) {
        if (p->sides.kin[i] >= 0) {
            is[is_on_other(p, i, corner) ? 0 : 1] = false;
        }
    }
    if (is[0] || is[1]) {
        memcpy(dalcs_corner_y(p, corner), is[1] ? p->other_y : y,
               (size_t)dalcs_system_n_columns(s) * sizeof(double));
        memcpy(dalcs_corner_w(p, corner), is[1] ? p->other_w : p->sides.w_of_y,
               (size_t)s->n_pairs * sizeof(double));
        memcpy(dalcs_corner_mode(p, corner), is[1] ? p->other : p->present,
               (size_t)p->osnsp->n_words * sizeof(uint64_t));
    }
    return is[0] || is[1];
}

enum dalcs_status dalcs_corners_find(struct dalcs_positions *p, const double *u, const double *y,
                                     int n_groups, bool *are_complete) {
    const size_t mode_bytes = (size_t)p->osnsp->n_words * sizeof(uint64_t);
    memcpy(p->present, p->osnsp->mode, mode_bytes);
    enum dalcs_status status = DALCS_OK;
    *are_complete = true;
    for (int corner = 0; corner < 1 << n_groups && status == DALCS_OK && *are_complete; corner++) {
        if (!is_known(p, y, corner)) {
            status = find_corner(p, u, corner, are_complete);
        }
    }
    memcpy(p->osnsp->mode, p->present, mode_bytes);
    return status;
}

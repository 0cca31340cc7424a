/* slide_corners.c - the answers on all sides of several that slide: a corner has a bit for each group, which is on its other
 * side. */
#include "sliding_internal.h"

#include <string.h>

/* Those that lead stand as in a corner. */
static void put_leading(struct dalcs_positions *p, int corner) {
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        const int g = p->sides.group[i];
        if (g >= 0) {
            dalcs_turning_put(p, i, dalcs_turning_is_on_at(p, i, (corner >> g & 1) != 0));
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
        if (p->sides.group[i] < 0 && dalcs_positions_moves_from(p, i, p->present, y)) {
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

static enum dalcs_status find_corner(struct dalcs_positions *p, const double *u, int corner,
                                     bool *is_complete) {
    const struct dalcs_osnsp *o = p->osnsp;
    DALCS_TRY(find_corner_by(p, u, corner, false, is_complete));
    if (!*is_complete && p->n_jumps > 0) {
        DALCS_TRY(find_corner_by(p, u, corner, true, is_complete));
    }
    memcpy(dalcs_corner_w(p, corner), o->w, (size_t)o->system->n_pairs * sizeof(double));
    memcpy(dalcs_corner_mode(p, corner), o->mode, (size_t)o->n_words * sizeof(*o->mode));
    return DALCS_OK;
}

enum dalcs_status dalcs_corners_find(struct dalcs_positions *p, const double *u, const double *y,
                                     int n_groups, bool *are_complete) {
    const struct dalcs_system *s = p->osnsp->system;
    const size_t y_bytes = (size_t)dalcs_system_n_columns(s) * sizeof(double);
    const size_t w_bytes = (size_t)s->n_pairs * sizeof(double);
    const size_t mode_bytes = (size_t)p->osnsp->n_words * sizeof(uint64_t);
    const int last = (1 << n_groups) - 1;
    memcpy(p->present, p->osnsp->mode, mode_bytes);
    memcpy(dalcs_corner_y(p, 0), y, y_bytes);
    memcpy(dalcs_corner_w(p, 0), p->osnsp->w, w_bytes);
    memcpy(dalcs_corner_y(p, last), p->other_y, y_bytes);
    memcpy(dalcs_corner_w(p, last), p->other_w, w_bytes);
    memcpy(dalcs_corner_mode(p, 0), p->present, mode_bytes);
    memcpy(dalcs_corner_mode(p, last), p->other, mode_bytes);
    enum dalcs_status status = DALCS_OK;
    *are_complete = true;
    const int known = p->n_jumps > 0 ? 0 : 1;
    for (int corner = known; corner <= last - known && status == DALCS_OK && *are_complete;
         corner++) {
        status = find_corner(p, u, corner, are_complete);
    }
    memcpy(p->osnsp->mode, p->present, mode_bytes);
    return status;
}

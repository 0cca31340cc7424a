/* slide_leaders.c - which of what turns decides where a slide is, and which only follows. */
#include "sliding_internal.h"

#include "power_of_step.h"

#include <math.h>
#include <string.h>

void dalcs_sliding_begin(struct dalcs_positions *p) {
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        p->gap[i] = 0.0;
        p->follows[i] = p->is_compared[i] = false;
    }
    p->sides.remember = false;
}

void dalcs_sliding_note_gaps(struct dalcs_positions *p, const double *y) {
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        p->gap[i] = dalcs_turning_turns(p, i)
                        ? fabs(dalcs_turning_there(p, i) - dalcs_turning_here(p, i, y))
                        : 0.0;
    }
}

/* A gap halves with the step where what is read goes on through the event, and stays where that jumps with it. */
static void compare_gap(struct dalcs_positions *p, int i, const double *y) {
    p->is_compared[i] = dalcs_turning_turns(p, i);
    p->follows[i] = dalcs_turning_turns(p, i) &&
                    dalcs_power_of_step(dalcs_turning_there(p, i) - dalcs_turning_here(p, i, y),
                                        p->gap[i]) <= 0.0;
}

void dalcs_sliding_compare_gaps(struct dalcs_positions *p, const double *y) {
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        compare_gap(p, i, y);
    }
}

/* Does the last answer, with a jump's output on its other side and all else as it is, take the i-th nearer to where that
 * is on the other side than to where it is here, in the answer y and w? */
static bool moves(const struct dalcs_positions *p, int i, const double *y, const double *w) {
    const double now = dalcs_turning_beyond(p, i, p->sides.y, p->osnsp->w);
    return fabs(now - dalcs_turning_there(p, i)) < fabs(now - dalcs_turning_beyond(p, i, y, w));
}

/* Into p->leads: it moves another one; into p->sides.group, 1: another jump moves it. */
static enum dalcs_status find_moves(struct dalcs_positions *p, const double *u, const double *y,
                                    const double *w) {
    for (int j = p->n; j < dalcs_turning_n(p); j++) {
        if (!dalcs_turning_turns(p, j)) {
            continue;
        }
        const bool is_on = dalcs_osnsp_is_on(p->osnsp, dalcs_turning_pair(p, j));
        dalcs_turning_put(p, j, !is_on);
        enum dalcs_status status = dalcs_osnsp_answer(p->osnsp, u, p->sides.y);
        memcpy(p->osnsp->mode, p->present, (size_t)p->osnsp->n_words * sizeof(*p->present));
        DALCS_TRY(status < DALCS_OK ? status : DALCS_OK);
        for (int i = 0; i < dalcs_turning_n(p) && status == DALCS_OK; i++) {
            if (i != j && dalcs_turning_turns(p, i) && moves(p, i, y, w)) {
                p->leads[j] = true;
                p->sides.group[i] = 1;
            }
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_sliding_find_commanding(struct dalcs_positions *p, const double *u,
                                                const double *y) {
    const size_t bytes = (size_t)p->osnsp->system->n_pairs * sizeof(double);
    bool any = false;
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        any = any || (dalcs_turning_turns(p, i) && !p->follows[i]);
        p->leads[i] = false;
        p->sides.group[i] = 0;
    }
    if (any) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_turning_find_memory(p, u, y, &p->sides.remember));
    if (p->sides.remember) {
        return DALCS_OK;
    }
    memcpy(p->present, p->osnsp->mode, (size_t)p->osnsp->n_words * sizeof(*p->present));
    memcpy(p->sides.w, p->osnsp->w, bytes);
    enum dalcs_status status = find_moves(p, u, y, p->sides.w);
    memcpy(p->osnsp->w, p->sides.w, bytes);
    for (int i = p->n; i < dalcs_turning_n(p) && status == DALCS_OK; i++) {
        p->follows[i] = p->follows[i] && !(p->leads[i] && p->sides.group[i] == 0);
    }
    return status;
}

/* Into p->gap of those that turn and are not compared: what it is in the answers to a step half as long, in p->sides. */
static void note_new_gaps(struct dalcs_positions *p) {
    const struct dalcs_system *s = p->osnsp->system;
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        if (dalcs_turning_turns(p, i) && !p->is_compared[i]) {
            p->gap[i] = fabs(dalcs_turning_beyond(p, i, p->sides.y + dalcs_system_n_columns(s),
                                                  p->sides.w + s->n_pairs) -
                             dalcs_turning_beyond(p, i, p->sides.y, p->sides.w));
        }
    }
}

/* The answer in `mode` of switches, into the k-th of p->sides. */
static enum dalcs_status answer_side(struct dalcs_positions *p, const uint64_t *mode, double sigma,
                                     const double *u, int k) {
    const struct dalcs_system *s = p->osnsp->system;
    memcpy(p->osnsp->mode, mode, (size_t)p->osnsp->n_words * sizeof(*mode));
    enum dalcs_status status = dalcs_osnsp_solve(
        p->osnsp, sigma, u, p->sides.y + (ptrdiff_t)k * dalcs_system_n_columns(s));
    memcpy(p->sides.w + (ptrdiff_t)k * s->n_pairs, p->osnsp->w,
           (size_t)s->n_pairs * sizeof(double));
    return status;
}

/* Both sides in a step half as long, and then the step's own problem again, so that it is the last one. */
static enum dalcs_status find_new_gaps(struct dalcs_positions *p, double sigma, const double *u) {
    enum dalcs_status status = answer_side(p, p->present, 2.0 * sigma, u, 0);
    if (status == DALCS_OK) {
        status = answer_side(p, p->other, 2.0 * sigma, u, 1);
    }
    const bool has_both = status == DALCS_OK;
    if (status >= DALCS_OK) {
        status = answer_side(p, p->present, sigma, u, 3);
    }
    memcpy(p->osnsp->mode, p->present, (size_t)p->osnsp->n_words * sizeof(*p->present));
    if (has_both) {
        note_new_gaps(p);
    }
    return status < DALCS_OK ? status : DALCS_OK;
}

/* Where comparators go from side to side together it is known which of them lead (led_jumps.c). */
static void note_led(struct dalcs_positions *p) {
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        if (dalcs_turning_turns(p, i) && !p->is_compared[i]) {
            const enum dalcs_latch_role *role = p->osnsp->latches.role;
            p->follows[i] = i < p->n || !dalcs_latch_leads(role[i - p->n]);
            p->is_compared[i] = true;
        }
    }
}

enum dalcs_status dalcs_turning_compare_new(struct dalcs_positions *p, double sigma,
                                            const double *u, const double *y) {
    const size_t n_pairs = (size_t)p->osnsp->system->n_pairs;
    const bool may_be = p->n_jumps > 0 && p->osnsp->system->n_x > 0;
    bool any = false;
    if (p->are_led) {
        note_led(p);
    }
    for (int i = 0; i < dalcs_turning_n(p) && may_be; i++) {
        any = any || (dalcs_turning_turns(p, i) && !p->is_compared[i]);
    }
    if (!any) {
        return DALCS_OK;
    }
    double *w = p->sides.w + 2 * n_pairs;
    memcpy(p->present, p->osnsp->mode, (size_t)p->osnsp->n_words * sizeof(*p->present));
    memcpy(w, p->osnsp->w, n_pairs * sizeof(*w));
    enum dalcs_status status = find_new_gaps(p, sigma, u);
    memcpy(p->osnsp->w, w, n_pairs * sizeof(*w));
    any = false;
    for (int i = 0; i < dalcs_turning_n(p) && status == DALCS_OK; i++) {
        if (dalcs_turning_turns(p, i) && !p->is_compared[i] && p->gap[i] > 0.0) {
            compare_gap(p, i, y);
        }
        any = any || (dalcs_turning_turns(p, i) && !p->is_compared[i]);
        p->leads[i] = false;
        p->sides.group[i] = 0;
    }
    if (any) {
        status = find_moves(p, u, y, w);
        memcpy(p->osnsp->w, w, n_pairs * sizeof(*w));
    }
    for (int i = 0; i < dalcs_turning_n(p) && any && status == DALCS_OK; i++) {
        p->follows[i] = p->is_compared[i] ? p->follows[i] : p->sides.group[i] != 0;
    }
    return status;
}

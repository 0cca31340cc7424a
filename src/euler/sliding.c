/* sliding.c - between the two sides of a switch that opens what closes it and closes what opens it. */
#include "sliding_internal.h"

#include <math.h>
#include <string.h>

double dalcs_turning_beyond(const struct dalcs_positions *p, int i, const double *y,
                            const double *w) {
    const struct dalcs_system *s = p->osnsp->system;
    const int d = dalcs_turning_pair(p, i);
    return i < p->n ? dalcs_csr_row_dot(&s->control, d, y) - s->pair[d].turn_on
                    : y[dalcs_system_n_equations(s) + d + 1] - w[d];
}

/* Does another one decide that it turns? Where each follows another, in a loop without a state, and no formula moves
 * switches, these do for themselves. */
static bool is_decided_by_another(const struct dalcs_positions *p, int i) {
    bool any_leads = false;
    for (int k = 0; k < dalcs_turning_n(p) && !any_leads; k++) {
        any_leads = dalcs_turning_turns(p, k) && !p->follows[k];
    }
    return any_leads ? p->follows[i] : i >= p->n;
}

bool dalcs_turning_leads(const struct dalcs_positions *p, int i) {
    return dalcs_turning_turns(p, i) && !is_decided_by_another(p, i);
}

void dalcs_turning_put(struct dalcs_positions *p, int i, bool is_on) {
    dalcs_osnsp_command(p->osnsp, dalcs_turning_pair(p, i), is_on);
    if (i >= p->n) {
        dalcs_osnsp_command(p->osnsp, dalcs_turning_pair(p, i) + 1, is_on);
    }
}

bool dalcs_turning_put_followers(struct dalcs_positions *p, const double *y) {
    bool any = false;
    for (int i = p->n; i < dalcs_turning_n(p); i++) {
        const bool is_on = dalcs_osnsp_is_on(p->osnsp, dalcs_turning_pair(p, i));
        if (p->leads[i] || is_on == (dalcs_turning_here(p, i, y) > 0.0)) {
            continue;
        }
        dalcs_turning_put(p, i, !is_on);
        any = true;
    }
    return any;
}

bool dalcs_turning_is_of_jump(const struct dalcs_positions *p, int pair, bool leading_only) {
    bool is = false;
    for (int i = p->n; i < dalcs_turning_n(p) && !is; i++) {
        const int behind = pair - dalcs_turning_pair(p, i);
        is = (p->leads[i] || !leading_only) && (behind == 0 || behind == 1);
    }
    return is;
}

/* Are all signs right but those of leading jumps, and do switches agree with their controls? */
static bool all_agree(const struct dalcs_positions *p, const double *y) {
    const struct dalcs_osnsp *o = p->osnsp;
    for (int k = 0; k < o->signs.n_violating; k++) {
        if (!dalcs_turning_is_of_jump(p, o->signs.violating[k], true)) {
            return false;
        }
    }
    return dalcs_positions_restless(p, y) == NULL;
}

/* The answer in `mode` with leading jumps as in `leading`. */
static enum dalcs_status answer_with(struct dalcs_positions *p, const uint64_t *mode,
                                     const uint64_t *leading, const double *u, double *y,
                                     bool *is_complete) {
    memcpy(p->osnsp->mode, mode, (size_t)p->osnsp->n_words * sizeof(*mode));
    for (int i = p->n; i < dalcs_turning_n(p); i++) {
        if (p->leads[i]) {
            dalcs_turning_put(p, i, dalcs_mode_has(leading, dalcs_turning_pair(p, i)));
        }
    }
    *is_complete = false;
    for (int round = 0; round <= p->n_jumps; round++) {
        enum dalcs_status status = dalcs_osnsp_answer(p->osnsp, u, y);
        if (status != DALCS_OK) {
            return status < DALCS_OK ? status : DALCS_OK;
        }
        if (!dalcs_turning_put_followers(p, y)) {
            *is_complete = all_agree(p, y);
            break;
        }
    }
    return DALCS_OK;
}

/* Behind an answer at the inputs u: where a formula leads, each of both answers has its output on the side that the
 * switches are on, for what they are for a part of the time is what its output is for that part. An implicit step has it
 * on the side that the switches go to. The argument is off by what it moves in the step. *is_complete: both have an
 * answer, in which all that follows agrees. */
static enum dalcs_status complete(struct dalcs_positions *p, const double *u, double *y,
                                  bool *is_complete) {
    const struct dalcs_system *s = p->osnsp->system;
    bool any = false;
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        p->leads[i] = i >= p->n && dalcs_turning_leads(p, i);
        any = any || p->leads[i];
    }
    *is_complete = !any;
    if (!any) {
        return DALCS_OK;
    }
    memcpy(p->present, p->osnsp->mode, (size_t)p->osnsp->n_words * sizeof(*p->present));
    enum dalcs_status status = answer_with(p, p->other, p->present, u, p->other_y, is_complete);
    memcpy(p->other_w, p->osnsp->w, (size_t)s->n_pairs * sizeof(double));
    if (status == DALCS_OK && *is_complete) {
        status = answer_with(p, p->present, p->other, u, y, is_complete);
    }
    memcpy(p->osnsp->mode, p->present, (size_t)p->osnsp->n_words * sizeof(*p->present));
    return status;
}

bool dalcs_sliding_follows_one(const struct dalcs_positions *p) {
    int n_leading = 0;
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        if (dalcs_turning_turns(p, i) && !p->follows[i]) {
            if (i < p->n) {
                return false;
            }
            n_leading++;
        }
    }
    return n_leading == 1;
}

double dalcs_turning_weight(const struct dalcs_positions *p, int i, const double *y,
                            double *noise) {
    const double gap = dalcs_turning_there(p, i) - dalcs_turning_here(p, i, y);
    *noise = p->slack[i] / fabs(gap);
    return -dalcs_turning_here(p, i, y) / gap;
}

bool dalcs_turning_is_at_threshold(const struct dalcs_positions *p, int i, double off,
                                   double largest) {
    return fabs(off) <= p->slack[i] + p->osnsp->options.certificate_tolerance * largest;
}

bool dalcs_turning_fits(const struct dalcs_positions *p, int i, double weight, const double *y) {
    const double turn_on = i < p->n ? p->osnsp->system->pair[p->pair[i]].turn_on : 0.0;
    const double one = dalcs_turning_here(p, i, y);
    const double other = dalcs_turning_there(p, i);
    return dalcs_turning_is_at_threshold(p, i, one + weight * (other - one),
                                         fabs(one + turn_on) + fabs(other + turn_on));
}

static void mix(double *a, const double *b, double weight, int n) {
    for (int k = 0; k < n; k++) {
        a[k] += weight * (b[k] - a[k]);
    }
}

/* The one of all that lead; 0: there is none. */
static double common_weight(const struct dalcs_positions *p, const double *y, double *noise) {
    double weight = 0.0;
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        if (!dalcs_turning_leads(p, i)) {
            continue;
        }
        weight = weight > 0.0 ? weight : dalcs_turning_weight(p, i, y, noise);
        if (!(weight > 0.0 && weight < 1.0 && dalcs_turning_fits(p, i, weight, y))) {
            return 0.0;
        }
    }
    return weight;
}

/* 0: off on all sides, 2: on on all sides, 1: it turns. */
static int find_standing(const struct dalcs_positions *p, int i) {
    const int d = dalcs_turning_pair(p, i);
    const bool stays_on = dalcs_osnsp_is_on(p->osnsp, d) && dalcs_mode_has(p->other, d);
    return stays_on ? 2 : dalcs_mode_has(p->sides.conducted, d) ? 1 : 0;
}

/* One weight is of all that lead; of several, those that slide are in groups. Where what follows comparators begins or ends to
 * turn, its mean jumps, and no polynomial goes through that. */
static void note_leading(struct dalcs_positions *p, bool has_one_weight) {
    p->sides.have_changed = false;
    for (int i = 0; i < dalcs_turning_n(p); i++) {
        const bool leads = has_one_weight ? dalcs_turning_leads(p, i) : p->sides.group[i] >= 0;
        p->sides.have_changed = p->sides.have_changed || leads != p->sides.leading[i];
        p->sides.leading[i] = leads;
        const int standing = find_standing(p, i);
        const bool has_turned = p->are_led && !leads && standing != p->sides.standing[i];
        p->sides.have_changed = p->sides.have_changed || has_turned;
        p->sides.standing[i] = standing;
    }
}

/* In the mean the argument of a leading jump is 0, and so is each of its parts above and below: what either side has of them
 * vanishes with the step, and is not of the flow. */
static void put_on_threshold(struct dalcs_positions *p, double *y) {
    const int first = dalcs_system_n_equations(p->osnsp->system);
    for (int i = p->n; i < dalcs_turning_n(p); i++) {
        if (p->sides.leading[i]) {
            y[first + dalcs_turning_pair(p, i) + 1] = 0.0;
            p->osnsp->w[dalcs_turning_pair(p, i)] = 0.0;
        }
    }
}

enum dalcs_status dalcs_sliding_mean(struct dalcs_positions *p, double sigma, const double *u,
                                     double *y, struct dalcs_observed_sides *sides, double *noise) {
    const struct dalcs_system *s = p->osnsp->system;
    const int n_columns = dalcs_system_n_columns(s);
    bool may_slide;
    sides->n = 0;
    p->sides.sigma = sigma;
    if (p->sides.remember) {
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_turning_compare_new(p, sigma, u, y));
    DALCS_TRY(complete(p, u, y, &may_slide));
    for (int i = 0; i < p->n && may_slide; i++) {
        may_slide = !dalcs_turning_leads(p, i) || !dalcs_pair_remembers(&s->pair[p->pair[i]]);
    }
    if (!may_slide) {
        return DALCS_OK;
    }
    const double weight = common_weight(p, y, noise);
    if (!(weight > 0.0)) {
        DALCS_TRY(dalcs_sliding_mean_of_several(p, u, y, sides, noise));
    } else {
        memcpy(p->sides.y, y, (size_t)n_columns * sizeof(double));
        *sides = (struct dalcs_observed_sides){
            .n = 2, .y = {p->sides.y, p->other_y}, .weight = {1.0 - weight, weight}};
        mix(y, p->other_y, weight, n_columns);
        mix(p->osnsp->w, p->other_w, weight, s->n_pairs);
        for (int k = 0; k < p->osnsp->n_words; k++) {
            p->sides.conducted[k] = p->osnsp->mode[k] | p->other[k];
        }
    }
    if (sides->n > 0) {
        note_leading(p, weight > 0.0);
        put_on_threshold(p, y);
    }
    return DALCS_OK;
}

void dalcs_sliding_join(struct dalcs_positions *p, const uint64_t *conducted) {
    for (int k = 0; k < p->osnsp->n_words; k++) {
        p->mark[k] = p->osnsp->mode[k];
        p->osnsp->mode[k] |= conducted[k];
    }
    p->joined = true;
}

bool dalcs_sliding_leave(struct dalcs_positions *p) {
    if (!p->joined) {
        return false;
    }
    const struct dalcs_system *s = p->osnsp->system;
    for (int d = 0; d < s->n_pairs; d++) {
        if (!s->pair[d].is_direct) { /* what sources command stands: it may just have moved */
            dalcs_osnsp_command(p->osnsp, d, dalcs_mode_has(p->mark, d));
        }
    }
    p->joined = false;
    return true;
}

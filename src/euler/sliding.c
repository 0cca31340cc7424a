/* sliding.c - between the two sides of a switch that opens what closes it and closes what opens it. */
#include "sliding.h"

#include <math.h>
#include <string.h>

/* Behind the switches, the jumps of formulas. */
static int n_turning(const struct dalcs_positions *p) {
    return p->n + p->n_jumps;
}

static int pair_of(const struct dalcs_positions *p, int i) {
    return i < p->n ? p->pair[i] : p->jump[i - p->n];
}

/* Does the i-th stand differently on both sides? */
static bool turns(const struct dalcs_positions *p, int i) {
    const int d = pair_of(p, i);
    return dalcs_osnsp_is_on(p->osnsp, d) != dalcs_mode_has(p->other, d);
}

/* How far beyond its threshold the control of a switch is, or the argument of a jump. */
static double beyond_threshold(const struct dalcs_positions *p, int i, const double *y,
                               const double *w) {
    const struct dalcs_system *s = p->osnsp->system;
    const int d = pair_of(p, i);
    return i < p->n ? dalcs_csr_row_dot(&s->control, d, y) - s->pair[d].turn_on
                    : y[dalcs_system_n_equations(s) + d + 1] - w[d];
}

static double here(const struct dalcs_positions *p, int i, const double *y) {
    return beyond_threshold(p, i, y, p->osnsp->w);
}

static double there(const struct dalcs_positions *p, int i) {
    return beyond_threshold(p, i, p->other_y, p->other_w);
}

void dalcs_sliding_begin(struct dalcs_positions *p) {
    for (int i = 0; i < n_turning(p); i++) {
        p->gap[i] = 0.0;
        p->follows[i] = false;
    }
}

void dalcs_sliding_note_gaps(struct dalcs_positions *p, const double *y) {
    for (int i = 0; i < n_turning(p); i++) {
        p->gap[i] = turns(p, i) ? fabs(there(p, i) - here(p, i, y)) : 0.0;
    }
}

/* A gap halves with the step where what is read goes on through the event, and nearly stays where that jumps with it. */
static const double staying = 0.75;

void dalcs_sliding_compare_gaps(struct dalcs_positions *p, const double *y) {
    for (int i = 0; i < n_turning(p); i++) {
        p->follows[i] = turns(p, i) && p->gap[i] > staying * fabs(there(p, i) - here(p, i, y));
    }
}

/* Does another one decide that it turns? Where each follows another, in a loop without a state, switches do for
 * themselves. */
static bool is_decided_by_another(const struct dalcs_positions *p, int i) {
    bool any_leads = false;
    for (int k = 0; k < n_turning(p) && !any_leads; k++) {
        any_leads = turns(p, k) && !p->follows[k];
    }
    return any_leads ? p->follows[i] : i >= p->n;
}

static bool is_leading_jump(const struct dalcs_positions *p, int i) {
    return i >= p->n && turns(p, i) && !is_decided_by_another(p, i);
}

static void put_jump(struct dalcs_positions *p, int i, bool is_on) {
    dalcs_osnsp_command(p->osnsp, pair_of(p, i), is_on);
    dalcs_osnsp_command(p->osnsp, pair_of(p, i) + 1, is_on);
}

/* Jumps that read a leading one take the side of their argument. Returns whether one changed. */
static bool put_followers(struct dalcs_positions *p, const double *y) {
    bool any = false;
    for (int i = p->n; i < n_turning(p); i++) {
        const bool is_on = dalcs_osnsp_is_on(p->osnsp, pair_of(p, i));
        if (p->leads[i] || is_on == (here(p, i, y) > 0.0)) {
            continue;
        }
        put_jump(p, i, !is_on);
        any = true;
    }
    return any;
}

/* Are all signs right but those of leading jumps, and do switches agree with their controls? */
static bool all_agree(const struct dalcs_positions *p, const double *y) {
    const struct dalcs_osnsp *o = p->osnsp;
    for (int k = 0; k < o->signs.n_violating; k++) {
        bool is_leading = false;
        for (int i = p->n; i < n_turning(p) && !is_leading; i++) {
            const int behind = o->signs.violating[k] - pair_of(p, i);
            is_leading = p->leads[i] && (behind == 0 || behind == 1);
        }
        if (!is_leading) {
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
    for (int i = p->n; i < n_turning(p); i++) {
        if (p->leads[i]) {
            put_jump(p, i, dalcs_mode_has(leading, pair_of(p, i)));
        }
    }
    *is_complete = false;
    for (int round = 0; round <= p->n_jumps; round++) {
        enum dalcs_status status = dalcs_osnsp_answer(p->osnsp, u, y);
        if (status != DALCS_OK) {
            return status < DALCS_OK ? status : DALCS_OK;
        }
        if (!put_followers(p, y)) {
            *is_complete = all_agree(p, y);
            break;
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_sliding_complete(struct dalcs_positions *p, const double *u, double *y,
                                         bool *is_complete) {
    const struct dalcs_system *s = p->osnsp->system;
    bool any = false;
    for (int i = 0; i < n_turning(p); i++) {
        p->leads[i] = is_leading_jump(p, i);
        any = any || p->leads[i];
    }
    *is_complete = !any || s->n_smooth == 0;
    if (!any || s->n_smooth > 0) {
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
    for (int i = 0; i < n_turning(p); i++) {
        if (turns(p, i) && !p->follows[i]) {
            if (i < p->n) {
                return false;
            }
            n_leading++;
        }
    }
    return n_leading == 1;
}

/* The weight of the other side with which the i-th is at its threshold, and what rounding may make of it. */
static double weight_of(const struct dalcs_positions *p, int i, const double *y, double *noise) {
    const double gap = there(p, i) - here(p, i, y);
    *noise = p->slack[i] / fabs(gap);
    return -here(p, i, y) / gap;
}

/* Is a mean with this weight no farther from the threshold of the i-th than moves it, or than digits tell? */
static bool is_at_threshold(const struct dalcs_positions *p, int i, double weight,
                            const double *y) {
    const double turn_on = i < p->n ? p->osnsp->system->pair[p->pair[i]].turn_on : 0.0;
    const double one = here(p, i, y);
    const double other = there(p, i);
    const double off = one + weight * (other - one);
    const double digits =
        p->osnsp->options.certificate_tolerance * (fabs(one + turn_on) + fabs(other + turn_on));
    return fabs(off) <= p->slack[i] + digits;
}

static void mix(double *a, const double *b, double weight, int n) {
    for (int k = 0; k < n; k++) {
        a[k] += weight * (b[k] - a[k]);
    }
}

double dalcs_sliding_mean(struct dalcs_positions *p, double *y, double *noise) {
    const struct dalcs_system *s = p->osnsp->system;
    double weight = 0.0;
    for (int i = 0; i < n_turning(p); i++) {
        if (!turns(p, i) || is_decided_by_another(p, i)) {
            continue;
        }
        weight = weight > 0.0 ? weight : weight_of(p, i, y, noise);
        bool fits = !dalcs_pair_remembers(&s->pair[pair_of(p, i)]) && weight > 0.0 &&
                    weight < 1.0 && is_at_threshold(p, i, weight, y);
        if (!fits) {
            return 0.0;
        }
    }
    mix(y, p->other_y, weight, dalcs_system_n_columns(s));
    mix(p->osnsp->w, p->other_w, weight, s->n_pairs);
    return weight;
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

/* sliding.c - between the two sides of a switch that opens what closes it and closes what opens it. */
#include "sliding.h"

#include <math.h>
#include <string.h>

/* Does the i-th switch stand differently on both sides? */
static bool turns(const struct dalcs_positions *p, int i) {
    return dalcs_osnsp_is_on(p->osnsp, p->pair[i]) != dalcs_mode_has(p->other, p->pair[i]);
}

/* The weight of the other side with which the control of the i-th switch is its threshold, and what rounding may make of
 * it. */
static double weight_of(const struct dalcs_positions *p, int i, const double *y, double *noise) {
    const struct dalcs_system *s = p->osnsp->system;
    double here = dalcs_csr_row_dot(&s->control, p->pair[i], y);
    double there = dalcs_csr_row_dot(&s->control, p->pair[i], p->other_y);
    *noise = p->slack[i] / fabs(there - here);
    return (s->pair[p->pair[i]].turn_on - here) / (there - here);
}

/* Is a mean with this weight no farther from the threshold of the i-th switch than moves it, or than digits tell? */
static bool is_at_threshold(const struct dalcs_positions *p, int i, double weight,
                            const double *y) {
    const struct dalcs_system *s = p->osnsp->system;
    double here = dalcs_csr_row_dot(&s->control, p->pair[i], y);
    double there = dalcs_csr_row_dot(&s->control, p->pair[i], p->other_y);
    double off = here + weight * (there - here) - s->pair[p->pair[i]].turn_on;
    double digits = p->osnsp->options.certificate_tolerance * (fabs(here) + fabs(there));
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
    for (int i = 0; i < p->n; i++) {
        if (!turns(p, i)) {
            continue;
        }
        weight = weight > 0.0 ? weight : weight_of(p, i, y, noise);
        bool fits = !dalcs_pair_remembers(&s->pair[p->pair[i]]) && weight > 0.0 && weight < 1.0 &&
                    is_at_threshold(p, i, weight, y);
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

/* impulse_formula.c - what a formula makes of impulses of its signals.
 *
 * An impulse is the limit of ever higher and shorter pulses. Of a formula that grows in proportion to such a pulse, the same
 * to either side and with the values of its other signals before and behind, the area is known whatever the shape of the pulse. */
#include "stretch.h"

#include "magnitudes.h"

#include <math.h>

/* A pulse so many times as high as its area: what a formula adds to it is below its rounding, and three factors do not
 * overflow. */
static const double height = 0x1p300;

/* Signals of a stretch at its start, with their impulses that many times. */
struct pulse {
    const struct dalcs_stretch *stretch;
    bool is_left, is_alone; /* with the values before; with none */
    double times;
};

static double signal_of(const struct dalcs_signal_formula_point *point, int index,
                        enum dalcs_signal_part part) {
    const struct pulse *p = point->user;
    const struct dalcs_stretch *s = p->stretch;
    const bool is_nothing = p->is_alone || s->impulse[index] != 0.0; /* beside the pulse */
    const double value = is_nothing   ? 0.0
                         : p->is_left ? s->left[index]
                                      : dalcs_stretch_at(s->coefficient[index], -1.0);
    const double all = value + p->times * s->impulse[index];
    return part == DALCS_PART_PLAIN ? all : dalcs_signal_part_of(part, all, 0.0);
}

static double area(const struct pulse *p, const struct dalcs_signal_formula *formula) {
    const struct dalcs_signal_formula_point point = {
        .time = p->stretch->from, .user = p, .signal = signal_of, .result = p->stretch->result};
    return dalcs_signal_formula_value(formula, &point) / p->times;
}

static double area_of_bent(const struct dalcs_stretch *s,
                           const struct dalcs_signal_formula *formula) {
    static const double times[3] = {1.0, 2.0, -1.0};
    double least = INFINITY;
    double most = -INFINITY;
    for (int i = 0; i < 6; i++) {
        const struct pulse p = {s, i < 3, false, times[i % 3] * height};
        const double one = area(&p, formula);
        if (!isfinite(one)) {
            return NAN;
        }
        least = fmin(least, one);
        most = fmax(most, one);
    }
    const double size = fmax(fabs(least), fabs(most));
    return most - least <= dalcs_alike * size ? 0.5 * (least + most) : (double)NAN;
}

double dalcs_stretch_impulse(const struct dalcs_stretch *s,
                             const struct dalcs_signal_formula *formula) {
    double largest = 0.0;
    bool is_known = true;
    for (int k = 0; k < formula->n && s->impulse != NULL; k++) {
        const struct dalcs_signal_formula_step *step = &formula->step[k];
        if (step->push == DALCS_PUT_SIGNAL) {
            is_known = is_known && !isnan(s->impulse[step->index]);
            largest = fmax(largest, fabs(s->impulse[step->index]));
        }
    }
    if (!is_known || largest == 0.0) {
        return is_known ? 0.0 : (double)NAN;
    }
    const struct pulse alone = {s, false, true, height};
    return formula->is_affine ? area(&alone, formula) : area_of_bent(s, formula);
}

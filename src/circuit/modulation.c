/* modulation.c - AM and SFFM as sums of tones.
 *
 * AM is three: A (o + sin m) sin c = A o sin c + A/2 (cos(c - m) - cos(c + m)).
 * SFFM is infinitely many (Jacobi and Anger; Abramowitz and Stegun 9.1.42-45),
 *     sin(c + i sin m) = sum over all n of J_n(i) sin(c + n m),
 * but beyond |n| = i the J_n vanish faster than any power: those left out are below 1e-17 each. */

#include "element_cards.h"

#include <math.h>

enum { MOST_SIDEBANDS = (DALCS_STIMULUS_MOST_TERMS - 1) / 2 };

static bool set_tones(struct dalcs_builder *builder, struct dalcs_stimulus *s,
                      const struct dalcs_tone *tone, int n) {
    struct dalcs_tone *copy = dalcs_arena_alloc(&builder->circuit->arena, (size_t)n, sizeof *copy);
    if (copy == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    for (int k = 0; k < n; k++) {
        copy[k] = tone[k];
    }
    s->kind = DALCS_STIMULUS_TONES;
    s->u.tones.tone = copy;
    s->u.tones.n = n;
    return true;
}

bool dalcs_modulation_set_am(struct dalcs_builder *builder, const double *value,
                             struct dalcs_stimulus *s) {
    const double amplitude = value[0];
    const double modulating = value[2];
    const double carrier = value[3];
    const double m = value[5] / 360;
    const double c = value[6] / 360;
    const struct dalcs_tone tone[3] = {
        {amplitude * value[1], carrier, c},
        {amplitude / 2, carrier - modulating, 0.25 + c - m},
        {-amplitude / 2, carrier + modulating, 0.25 + c + m},
    };
    s->u.tones.offset = 0;
    s->u.tones.delay = value[4];
    return set_tones(builder, s, tone, 3);
}

/* The sidebands on each side that are above rounding. */
static int count_sidebands(double index) {
    int n = (int)fmin(index, MOST_SIDEBANDS + 1);
    while (n <= MOST_SIDEBANDS && fabs(jn(n + 1, index)) > 1e-17) {
        n++;
    }
    return n;
}

bool dalcs_modulation_set_fm(struct dalcs_builder *builder, const struct dalcs_token *place,
                             const double *value, struct dalcs_stimulus *s) {
    struct dalcs_tone tone[DALCS_STIMULUS_MOST_TERMS];
    const double index = fabs(value[3]);
    const int n = count_sidebands(index);
    if (n > MOST_SIDEBANDS) {
        dalcs_builder_error(builder, place, NULL,
                            "a modulation index of %g has more than %d sidebands on each side",
                            value[3], MOST_SIDEBANDS);
        return false;
    }
    for (int k = -n; k <= n; k++) {
        /* J of negative order or argument: the sign of an odd one changes. */
        const bool is_odd = k % 2 != 0;
        const bool is_minus = is_odd && (k < 0) != (value[3] < 0);
        const double j = jn(k < 0 ? -k : k, index);
        tone[k + n] = (struct dalcs_tone){value[1] * (is_minus ? -j : j), value[2] + k * value[4],
                                          (value[5] + k * value[6]) / 360};
    }
    s->u.tones.offset = value[0];
    s->u.tones.delay = 0;
    return set_tones(builder, s, tone, 2 * n + 1);
}

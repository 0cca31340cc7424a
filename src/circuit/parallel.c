/* parallel.c - so many elements in parallel, by m= of the subcircuit calls around them.
 *
 * With the same voltages all currents are m times as large: R/m, L/m, C m, I m, G m, a switch's Ron/m. A V and
 * an E of voltages stay what they are. What reads a current of the inside would read m of them: it is
 * refused. */

#include "element_cards.h"

#include <string.h>

double dalcs_parallel_of(const struct dalcs_card *card) {
    return card->parallel > 0 ? card->parallel : 1;
}

static bool scale_points(struct dalcs_builder *builder, struct dalcs_stimulus *s, double m) {
    double *v = dalcs_arena_alloc(&builder->circuit->arena, (size_t)s->u.pwl.n, sizeof *v);
    for (int k = 0; v != NULL && k < s->u.pwl.n; k++) {
        v[k] = m * s->u.pwl.v[k];
    }
    s->u.pwl.v = v;
    return v != NULL;
}

static bool scale_tones(struct dalcs_builder *builder, struct dalcs_stimulus *s, double m) {
    const size_t n = (size_t)s->u.tones.n;
    struct dalcs_tone *tone = dalcs_arena_alloc(&builder->circuit->arena, n, sizeof *tone);
    for (size_t k = 0; tone != NULL && k < n; k++) {
        tone[k] = s->u.tones.tone[k];
        tone[k].amplitude *= m;
    }
    s->u.tones.tone = tone;
    s->u.tones.offset *= m;
    return tone != NULL;
}

void dalcs_parallel_scale(struct dalcs_builder *builder, struct dalcs_stimulus *s, double m) {
    bool ok = true;
    s->dc *= m;
    s->ac_real *= m;
    s->ac_imaginary *= m;
    switch (s->kind) {
    case DALCS_STIMULUS_SIN:
        s->u.sine.offset *= m;
        s->u.sine.amplitude *= m;
        break;
    case DALCS_STIMULUS_PULSE:
        s->u.pulse.low *= m;
        s->u.pulse.high *= m;
        break;
    case DALCS_STIMULUS_EXP:
        s->u.exponential.low *= m;
        s->u.exponential.high *= m;
        break;
    case DALCS_STIMULUS_PWL:
        ok = scale_points(builder, s, m);
        break;
    case DALCS_STIMULUS_TONES:
        ok = scale_tones(builder, s, m);
        break;
    default:
        break;
    }
    builder->out_of_memory = builder->out_of_memory || !ok;
}

/* Does a formula hold a current? */
static bool reads_current(const struct dalcs_formula *formula) {
    bool reads = formula->kind == DALCS_FORMULA_CURRENT;
    for (int k = 0; k < formula->n && !reads; k++) {
        reads = reads_current(formula->argument[k]);
    }
    return reads;
}

bool dalcs_parallel_is_refused(struct dalcs_builder *builder, const struct dalcs_card *card) {
    bool reads = strchr("fhw", card->letter) != NULL;
    bool makes = false; /* a current by a formula */
    for (int k = 1; k < card->n; k++) {
        const struct dalcs_token *token = &card->token[k];
        const bool is_formula = token->kind == DALCS_TOKEN_FORMULA;
        reads = reads || (is_formula && reads_current(token->formula));
        makes =
            makes || (is_formula && (card->letter == 'g' || (card->letter == 'b' && k >= 2 &&
                                                             strcmp(token[-2].text, "i") == 0)));
        makes = makes || (card->letter == 'g' && token->kind == DALCS_TOKEN_WORD &&
                          (strcmp(token->text, "poly") == 0 || strcmp(token->text, "table") == 0));
    }
    if (dalcs_parallel_of(card) == 1 || (!reads && !makes)) {
        return false;
    }
    dalcs_builder_error(builder, card->token, "write as many calls, with the same nodes",
                        "m= of the subcircuit call multiplies currents, and '%s' %s",
                        card->token->text, reads ? "reads a current" : "makes one by a formula");
    return true;
}

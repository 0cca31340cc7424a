/* measuring_sides.c - what a slide leaves of a measurement: means over its sides, or of signals alone. */
#include "measuring_sides.h"

enum dalcs_status dalcs_measuring_ask_sides(struct dalcs_measuring *m,
                                            struct dalcs_side_means *sides) {
    m->sides = sides;
    for (int k = 0; k < m->n; k++) {
        struct dalcs_measured *item = &m->item[k];
        const struct dalcs_measure_card *card = item->card;
        const bool is_square = card->kind == DALCS_MEASURE_RMS;
        if (card->analysis == m->analysis && card->kind <= DALCS_MEASURE_MAX_AT && !card->is_late &&
            (is_square || !card->formula.is_affine)) {
            const struct dalcs_side_mean mean = {.formula = &card->formula, .is_square = is_square};
            DALCS_TRY(dalcs_side_means_add(sides, &mean, &item->mean));
        }
    }
    for (int k = 0; k < m->n_harmonics; k++) {
        const struct dalcs_side_mean mean = {.formula = &m->harmonics[k].card->formula};
        if (!mean.formula->is_affine) {
            DALCS_TRY(dalcs_side_means_add(sides, &mean, &m->harmonics[k].mean));
        }
    }
    return DALCS_OK;
}

bool dalcs_measuring_adds_sides(const struct dalcs_measuring *m,
                                const struct dalcs_measured *item) {
    return m->sides != NULL && dalcs_side_means_slides(m->sides, item->mean);
}

bool dalcs_measuring_is_bent(const struct dalcs_measuring *m,
                             const struct dalcs_signal_formula *formula) {
    return formula->n > 0 && !formula->is_affine &&
           (m->sides != NULL ? dalcs_side_means_formula_slides(m->sides, formula)
                             : m->stretch.slides);
}

bool dalcs_measuring_adds_means(const struct dalcs_measuring *m,
                                const struct dalcs_measured *item) {
    const struct dalcs_measure_card *card = item->card;
    const bool is_square = card->kind == DALCS_MEASURE_RMS;
    if (dalcs_measuring_is_bent(m, &card->instant[0].difference) ||
        dalcs_measuring_is_bent(m, &card->instant[1].difference)) {
        return true;
    }
    if (is_square && item->mean < 0) {
        return m->sides != NULL ? dalcs_side_means_formula_slides(m->sides, &card->formula)
                                : m->stretch.slides;
    }
    return item->mean < 0 && dalcs_measuring_is_bent(m, &card->formula);
}

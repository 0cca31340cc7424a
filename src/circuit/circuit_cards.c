/* circuit_cards.c - the reader of each card, and the pass that it is read in. */
#include "analysis_cards.h"
#include "card_table.h"
#include "element_cards.h"
#include "later.h"
#include "model_cards.h"
#include "oscillator.h"
#include "result_cards.h"

/* XSPICE's, by the model that the last word names; NULL: it is none of them. */
static const struct dalcs_block *block_of(const struct dalcs_builder *builder,
                                          const struct dalcs_card *card) {
    const int index = dalcs_names_find(&builder->models.names, card->token[card->n - 1].text);
    return index >= 0 ? builder->models.model[index].block : NULL;
}

static void read_block(struct dalcs_builder *builder, const struct dalcs_card *card) {
    if (dalcs_card_is_logic(card)) {
        dalcs_logic_parse(builder, card);
    } else if (block_of(builder, card) != NULL) {
        dalcs_block_parse(builder, card, block_of(builder, card));
    } else if (dalcs_thyristor_is(builder, card)) {
        dalcs_thyristor_parse(builder, card);
    } else {
        dalcs_diode_parse_block(builder, card);
    }
}

static void read_element(struct dalcs_builder *builder, const struct dalcs_card *card) {
    static const struct {
        char letter;
        enum dalcs_device_kind kind; /* for readers that serve several */
        void (*of_kind)(struct dalcs_builder *builder, const struct dalcs_card *card,
                        enum dalcs_device_kind kind);
        void (*parse)(struct dalcs_builder *builder, const struct dalcs_card *card);
    } readers[] = {{'r', DALCS_RESISTOR, dalcs_passive_parse, NULL},
                   {'l', DALCS_INDUCTOR, dalcs_passive_parse, NULL},
                   {'c', DALCS_CAPACITOR, dalcs_passive_parse, NULL},
                   {'v', DALCS_VSOURCE, dalcs_source_parse, NULL},
                   {'i', DALCS_ISOURCE, dalcs_source_parse, NULL},
                   {'e', DALCS_VCVS, dalcs_controlled_parse, NULL},
                   {'f', DALCS_CCCS, dalcs_controlled_parse, NULL},
                   {'g', DALCS_VCCS, dalcs_controlled_parse, NULL},
                   {'h', DALCS_CCVS, dalcs_controlled_parse, NULL},
                   {'d', 0, NULL, dalcs_diode_parse},
                   {'a', 0, NULL, read_block},
                   {'m', 0, NULL, dalcs_transistor_parse},
                   {'z', 0, NULL, dalcs_transistor_parse},
                   {'q', 0, NULL, dalcs_transistor_parse},
                   {'b', 0, NULL, dalcs_behavioural_parse},
                   {'t', 0, NULL, dalcs_line_parse}};

    if (card->parallel > 0 && dalcs_parallel_is_refused(builder, card)) {
        return;
    }
    if (dalcs_behavioural_has_own_table(card)) {
        dalcs_behavioural_parse_own_table(builder, card);
        return;
    }
    for (size_t k = 0; k < sizeof readers / sizeof readers[0]; k++) {
        if (readers[k].letter == card->letter) {
            if (readers[k].of_kind != NULL) {
                readers[k].of_kind(builder, card, readers[k].kind);
            } else {
                readers[k].parse(builder, card);
            }
            return;
        }
    }
    dalcs_switch_parse(builder, card);
}

enum pass { OPTIONS, MODELS, ELEMENTS, REFERENCES, MEASURES, NEVER };

/* The readers of cards, and their passes. */
static const struct {
    enum pass pass;
    void (*parse)(struct dalcs_builder *builder, const struct dalcs_card *card);
} READ[DALCS_N_CARD_CLASSES] = {
    [DALCS_CARD_NONE] = {NEVER, NULL},
    [DALCS_CARD_OPTIONS] = {OPTIONS, dalcs_options_parse},
    [DALCS_CARD_TEMPERATURE] = {OPTIONS, dalcs_temperature_parse},
    [DALCS_CARD_MODEL] = {MODELS, dalcs_model_parse},
    [DALCS_CARD_TRAN] = {MODELS, dalcs_analysis_parse_tran},
    [DALCS_CARD_PSS] = {MODELS, dalcs_analysis_parse_pss},
    [DALCS_CARD_ENV] = {MODELS, dalcs_analysis_parse_env},
    [DALCS_CARD_OP] = {MODELS, dalcs_analysis_parse_op},
    [DALCS_CARD_ELEMENT] = {ELEMENTS, read_element},
    [DALCS_CARD_COUPLING] = {REFERENCES, dalcs_coupling_parse},
    [DALCS_CARD_IC] = {REFERENCES, dalcs_initial_parse},
    [DALCS_CARD_SIGNALS] = {REFERENCES, dalcs_signals_parse},
    [DALCS_CARD_NODESET] = {REFERENCES, dalcs_initial_parse_nodeset},
    [DALCS_CARD_DC] = {REFERENCES, dalcs_sweep_parse_dc},
    [DALCS_CARD_AC] = {REFERENCES, dalcs_sweep_parse_ac},
    [DALCS_CARD_SENS] = {REFERENCES, dalcs_sensitivity_parse},
    [DALCS_CARD_TRANSFER] = {REFERENCES, dalcs_transfer_card_parse},
    [DALCS_CARD_STEP] = {REFERENCES, dalcs_sweep_parse_step},
    [DALCS_CARD_MC] = {REFERENCES, dalcs_monte_carlo_parse},
    [DALCS_CARD_WORST_CASE] = {REFERENCES, dalcs_worst_case_parse},
    [DALCS_CARD_MEASURE] = {MEASURES, dalcs_measure_parse},
    [DALCS_CARD_FOURIER] = {MEASURES, dalcs_fourier_parse},
    [DALCS_CARD_LOSSES] = {MEASURES, dalcs_losses_parse},
    [DALCS_CARD_SWITCHLOSS] = {MEASURES, dalcs_switchloss_count},
};

enum dalcs_status dalcs_card_table_read(struct dalcs_builder *builder,
                                        const unsigned char *class_of) {
    for (enum pass pass = OPTIONS; pass <= MEASURES; pass++) {
        for (size_t k = 0; k < builder->deck->n_cards; k++) {
            if (READ[class_of[k]].pass == pass) {
                READ[class_of[k]].parse(builder, &builder->deck->card[k]);
            }
            if (builder->out_of_memory) {
                return DALCS_E_NOMEM;
            }
        }
        if (pass == OPTIONS) {
            dalcs_temperature_settle(builder);
        }
        if (pass == ELEMENTS) {
            dalcs_oscillator_put_all(builder);
        }
    }
    return DALCS_OK;
}

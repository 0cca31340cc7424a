/* transconductor.c - LTspice's OTA: a current of the difference of two voltages, with limits.
 *
 *     Aname minus plus [plus2 minus2] 0 0 out com OTA [G=1 Ref=0 Iout=10u Isink= Vhigh=2 Vlow=0 Rout= Cout= linear]
 *
 * It puts out Iout tanh(G (v - Ref)/Iout), or with `linear` G (v - Ref), where v is v(plus,minus), times v(plus2,minus2)
 * if pins 3 and 4 are wired. Rout and Cout lie across the output. An ideal diode each keeps that between Vlow and Vhigh. */
#include "block_parts.h"
#include "element_cards.h"
#include "logic_parts.h"
#include "model_cards.h"
#include "reader.h"

#include <math.h>

enum { N_PINS = 8, PIN_OUTPUT = 6, PIN_COMMON };

enum {
    GAIN,
    REF,
    IOUT,
    ISOURCE,
    ISRC,
    ISINK,
    HIGH,
    LOW,
    LINEAR,
    ASYM, /* as Isink= says */
    ROUT,
    COUT,
    RCLAMP,
    N_PARAMETERS
};

static const char USAGE[] =
    "an OTA is: Aname minus plus 0 0 0 0 out com OTA [G=1 Ref=0 Iout=10u Isink= Vhigh=2 Vlow=0 "
    "Rout= Cout= linear]";

struct ota {
    struct dalcs_block_card card;
    int node[N_PINS];
    struct dalcs_parameter p[N_PARAMETERS];
};

/* Two more names of Iout; false: an error was reported. */
static bool read_parameters(struct dalcs_reader *reader, struct ota *ota) {
    struct dalcs_parameter *p = ota->p;
    if (!dalcs_logic_read_parameters(
            reader, &(struct dalcs_logic_parameters){"an OTA", p, N_PARAMETERS, true})) {
        return false;
    }
    for (int k = ISOURCE; k <= ISRC; k++) {
        if (p[k].place != NULL) {
            p[IOUT].value = p[k].value;
        }
    }
    return true;
}

static bool is_linear(const struct ota *ota) {
    return ota->p[LINEAR].value != 0;
}

static bool check(struct ota *ota) {
    struct dalcs_builder *builder = ota->card.builder;
    const struct dalcs_token *name = ota->card.card->token;
    struct dalcs_parameter *p = ota->p;
    p[ISINK].value = fabs(p[ISINK].place != NULL ? p[ISINK].value : p[IOUT].value);
    for (int pin = 4; pin < PIN_OUTPUT; pin++) {
        if (ota->node[pin] != ota->node[PIN_COMMON]) {
            dalcs_builder_error(builder, &name[1 + pin], "tie it to pin 8",
                                "this function does not use pin %d of '%s'", pin + 1, name->text);
            return false;
        }
    }
    for (int k = ROUT; k < N_PARAMETERS; k++) {
        if (p[k].value < 0) {
            dalcs_builder_error(builder, p[k].place, USAGE, "'%s' cannot be negative", p[k].name);
            return false;
        }
    }
    if (!(p[HIGH].value > p[LOW].value)) {
        dalcs_builder_error(builder, name, NULL, "Vhigh must be above Vlow");
        return false;
    }
    if (!is_linear(ota) && !(p[IOUT].value > 0 && p[ISINK].value > 0)) {
        dalcs_builder_error(builder, name, "linear has no limit of the current",
                            "Iout and Isink of '%s' are not 0", name->text);
        return false;
    }
    return true;
}

/* limit tanh(what/limit) */
static const struct dalcs_formula *soften(struct dalcs_formula_writer *w,
                                          const struct dalcs_formula *what, double limit) {
    const struct dalcs_formula *share =
        dalcs_formula_operation(w, DALCS_MULTIPLY, dalcs_formula_number(w, 1 / limit), what);
    return dalcs_formula_operation(w, DALCS_MULTIPLY, dalcs_formula_number(w, limit),
                                   dalcs_formula_call(w, "tanh", 1, &share));
}

/* The current out of pin 7, from the one without limits. */
static const struct dalcs_formula *limited(struct dalcs_formula_writer *w, const struct ota *ota,
                                           const struct dalcs_formula *what) {
    const double up = ota->p[IOUT].value;
    const double down = ota->p[ISINK].value;
    if (is_linear(ota)) {
        return what;
    }
    if (up == down) {
        return soften(w, what, up);
    }
    const struct dalcs_formula *back =
        dalcs_formula_operation(w, DALCS_MULTIPLY, dalcs_formula_number(w, -1), what);
    return dalcs_formula_operation(w, DALCS_SUBTRACT,
                                   soften(w, dalcs_formula_call(w, "uramp", 1, &what), up),
                                   soften(w, dalcs_formula_call(w, "uramp", 1, &back), down));
}

/* Into pin 7, as the current of an element is. */
static const struct dalcs_formula *current_of(struct dalcs_formula_writer *w,
                                              const struct ota *ota) {
    const struct dalcs_token *pin = ota->card.card->token + 1;
    const struct dalcs_formula *v =
        dalcs_formula_signal(w, DALCS_FORMULA_VOLTAGE, &pin[1], &pin[0]);
    if (ota->node[2] != ota->node[3]) {
        v = dalcs_formula_operation(
            w, DALCS_MULTIPLY, v, dalcs_formula_signal(w, DALCS_FORMULA_VOLTAGE, &pin[2], &pin[3]));
    }
    v = dalcs_formula_operation(w, DALCS_SUBTRACT, v, dalcs_formula_number(w, ota->p[REF].value));
    v = dalcs_formula_operation(w, DALCS_MULTIPLY, dalcs_formula_number(w, ota->p[GAIN].value), v);
    return dalcs_formula_operation(w, DALCS_MULTIPLY, dalcs_formula_number(w, -1),
                                   limited(w, ota, v));
}

static bool add_clamp(const struct ota *ota, bool is_upper) {
    const struct dalcs_block_clamp clamp = {is_upper, ota->p[is_upper ? HIGH : LOW].value,
                                            ota->p[RCLAMP].value};
    return dalcs_block_add_clamp(&ota->card, &ota->node[PIN_OUTPUT], &clamp);
}

void dalcs_transconductor_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct ota ota = {.card = {.builder = builder, .card = card},
                      .p = {[GAIN] = {"g", DALCS_PLAIN, false, 1, NULL},
                            [REF] = {"ref", DALCS_VOLTAGE, false, 0, NULL},
                            [IOUT] = {"iout", DALCS_CURRENT, false, 10e-6, NULL},
                            [ISOURCE] = {"isource", DALCS_CURRENT, false, 0, NULL},
                            [ISRC] = {"isrc", DALCS_CURRENT, false, 0, NULL},
                            [ISINK] = {"isink", DALCS_CURRENT, false, 0, NULL},
                            [HIGH] = {"vhigh", DALCS_VOLTAGE, false, 2, NULL},
                            [LOW] = {"vlow", DALCS_VOLTAGE, false, 0, NULL},
                            [LINEAR] = {"linear", DALCS_PLAIN, false, 0, NULL},
                            [ASYM] = {"asym", DALCS_PLAIN, false, 0, NULL},
                            [ROUT] = {"rout", DALCS_OHM, true, 0, NULL},
                            [COUT] = {"cout", DALCS_FARAD, false, 0, NULL},
                            [RCLAMP] = {"rclamp", DALCS_OHM, false, 0, NULL}}};
    struct dalcs_formula_writer w;
    const int *output = &ota.node[PIN_OUTPUT];
    if (!dalcs_reader_nodes(&reader, N_PINS, ota.node)) {
        return;
    }
    reader.at++; /* the function */
    if (!read_parameters(&reader, &ota) || !check(&ota)) {
        return;
    }
    if (ota.node[PIN_OUTPUT] == ota.node[PIN_COMMON]) {
        return; /* a source of noise alone */
    }
    struct dalcs_device *g =
        dalcs_block_add(&ota.card, DALCS_VCCS, NULL, ota.node[PIN_OUTPUT], ota.node[PIN_COMMON]);
    if (g == NULL || !dalcs_formula_writer_start(&w, builder, card->token)) {
        return;
    }
    dalcs_behavioural_add_formula(builder, g, dalcs_formula_token(&w, current_of(&w, &ota)));
    (void)(dalcs_block_add_across(&ota.card, output, DALCS_RESISTOR, &ota.p[ROUT]) &&
           dalcs_block_add_across(&ota.card, output, DALCS_CAPACITOR, &ota.p[COUT]) &&
           add_clamp(&ota, true) && add_clamp(&ota, false));
}

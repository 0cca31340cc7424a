/* phase_detector.c - LTspice's PHASEDET: a phase and frequency detector with a charge pump.
 *
 *     Aname a b 0 0 0 0 out com PHASEDET [Iout=10u Vhigh=1 Vlow=0 Ref=middle Td=0 Rout= Cout=]
 *
 * Two flip-flops, `up` and `down`, are set where a and b rise, and both are cleared where both are set. Iout flows out of
 * pin 7 while `up` is set, into it while `down` is, and nothing else does. An ideal diode each keeps the output between
 * Vlow and Vhigh. */
#include "block_parts.h"
#include "element_cards.h"
#include "logic_parts.h"
#include "model_cards.h"
#include "reader.h"

enum { N_PINS = 8, PIN_OUTPUT = 6, PIN_COMMON };

enum { IOUT, HIGH, LOW, REF, TD, ROUT, COUT, N_PARAMETERS };

static const char USAGE[] = "a phase detector is: Aname a b 0 0 0 0 out com PHASEDET [Iout=amperes "
                            "Vhigh=volts Vlow=volts Ref=volts Td=seconds Rout=ohms Cout=farads], "
                            "pins that are not used tied to com";

struct detector {
    struct dalcs_block_card card;
    int node[N_PINS];
    struct dalcs_parameter p[N_PARAMETERS];
    int clear; /* the node that both flip-flops are cleared by */
};

/* ---- The card ------------------------------------------------------------------------------------------------ */

static bool check(const struct detector *of) {
    struct dalcs_builder *builder = of->card.builder;
    const struct dalcs_token *name = of->card.card->token;
    for (int pin = 0; pin < PIN_COMMON; pin++) {
        const bool means = pin < 2 || pin == PIN_OUTPUT;
        const bool is_wired = of->node[pin] != of->node[PIN_COMMON];
        if (means && !is_wired) {
            dalcs_builder_error(builder, &name[1 + pin], USAGE, "pin %d of '%s' is not wired",
                                pin + 1, name->text);
            return false;
        }
        if (!means && is_wired) {
            dalcs_builder_warn(builder, &name[1 + pin], "tie it to com",
                               "pin %d of '%s' means nothing for this function and is ignored",
                               pin + 1, name->text);
        }
    }
    if (!(of->p[HIGH].value > of->p[LOW].value)) {
        dalcs_builder_error(builder, name, NULL, "Vhigh must be above Vlow");
        return false;
    }
    return true;
}

/* ---- What it consists of ------------------------------------------------------------------------------------- */

/* A gate of the detector's, from half a volt below the threshold of its inputs to half a volt above. */
static struct dalcs_logic_card *start(const struct detector *of, const char *what, int node,
                                      enum dalcs_logic_kind kind, int n_inputs) {
    struct dalcs_builder *builder = of->card.builder;
    struct dalcs_token *name = dalcs_arena_alloc(&builder->scratch, 1, sizeof *name);
    if (name == NULL) {
        builder->out_of_memory = true;
        return NULL;
    }
    *name = *of->card.card->token;
    name->text = dalcs_builder_hint(builder, "%s(%s)", what, name->text);
    struct dalcs_logic_card *gate =
        name->text != NULL && node >= 0 ? dalcs_logic_start(builder, name, n_inputs) : NULL;
    if (gate != NULL) {
        gate->is_element = false;
        gate->common = of->node[PIN_COMMON];
        gate->node[0] = node;
        gate->on = gate->off = of->p[REF].value;
        gate->gate->kind = kind;
        gate->gate->low = of->p[REF].value - 0.5;
        gate->gate->high = of->p[REF].value + 0.5;
    }
    return gate;
}

static struct dalcs_logic_pin pin_at(const struct detector *of, int node) {
    return (struct dalcs_logic_pin){
        .is_wired = true, .node = node, .reference = of->node[PIN_COMMON]};
}

/* Set where a clock rises: its data, an open input, is 1. */
static bool add_flip_flop(const struct detector *of, const char *what, int node, int clock) {
    struct dalcs_logic_card *gate = start(of, what, node, DALCS_GATE_FLIP_FLOP, DALCS_GATE_PINS);
    if (gate == NULL) {
        return false;
    }
    gate->gate->input[DALCS_GATE_DATA].is_inverted = true;
    gate->pin[DALCS_GATE_CLOCK] = pin_at(of, clock);
    gate->pin[DALCS_GATE_CLEAR] = pin_at(of, of->clear);
    for (int k = 0; k < 2; k++) {
        gate->gate->delay[k] = gate->gate->forced_delay[k] = of->p[TD].value;
    }
    dalcs_logic_add(of->card.builder, gate);
    return true;
}

static bool add_gates(struct detector *of, int *node) {
    static const char *const names[] = {"up", "down"};
    of->clear = dalcs_builder_inner_node(of->card.builder, "clear", of->card.card->token);
    struct dalcs_logic_card *both = start(of, "clear", of->clear, DALCS_GATE_AND, 2);
    if (both == NULL) {
        return false;
    }
    for (int k = 0; k < 2; k++) {
        node[k] = dalcs_builder_inner_node(of->card.builder, names[k], of->card.card->token);
        both->pin[k] = pin_at(of, node[k]);
    }
    dalcs_logic_add(of->card.builder, both);
    return add_flip_flop(of, names[0], node[0], of->node[0]) &&
           add_flip_flop(of, names[1], node[1], of->node[1]);
}

static bool add_clamp(const struct detector *of, bool is_upper) {
    const struct dalcs_block_clamp clamp = {is_upper, of->p[is_upper ? HIGH : LOW].value, 0};
    return dalcs_block_add_clamp(&of->card, &of->node[PIN_OUTPUT], &clamp);
}

void dalcs_phase_detector_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct detector of = {.card = {.builder = builder, .card = card},
                          .p = {[IOUT] = {"iout", DALCS_CURRENT, false, 10e-6, NULL},
                                [HIGH] = {"vhigh", DALCS_VOLTAGE, false, 1, NULL},
                                [LOW] = {"vlow", DALCS_VOLTAGE, false, 0, NULL},
                                [REF] = {"ref", DALCS_VOLTAGE, false, 0, NULL},
                                [TD] = {"td", DALCS_SECOND, false, 0, NULL},
                                [ROUT] = {"rout", DALCS_OHM, true, 0, NULL},
                                [COUT] = {"cout", DALCS_FARAD, false, 0, NULL}}};
    const int *output = &of.node[PIN_OUTPUT]; /* and com */
    int node[2];
    if (!dalcs_reader_nodes(&reader, N_PINS, of.node)) {
        return;
    }
    reader.at++; /* the function */
    const struct dalcs_logic_parameters parameters = {"a phase detector", of.p, N_PARAMETERS,
                                                      false};
    if (!dalcs_logic_read_parameters(&reader, &parameters) ||
        !dalcs_logic_check_signs(&reader, &parameters) || !check(&of)) {
        builder->hidden |= DALCS_HIDDEN_ELEMENTS;
        return;
    }
    if (of.p[REF].place == NULL) {
        of.p[REF].value = 0.5 * of.p[LOW].value + 0.5 * of.p[HIGH].value;
    }
    struct dalcs_device *g =
        add_gates(&of, node)
            ? dalcs_block_add(&of.card, DALCS_VCCS, NULL, of.node[PIN_OUTPUT], of.node[PIN_COMMON])
            : NULL;
    if (g == NULL) {
        return;
    }
    g->node[2] = node[1]; /* what flows from pin 7 to com inside */
    g->node[3] = node[0];
    g->value = of.p[IOUT].value;
    (void)(dalcs_block_add_across(&of.card, output, DALCS_RESISTOR, &of.p[ROUT]) &&
           dalcs_block_add_across(&of.card, output, DALCS_CAPACITOR, &of.p[COUT]) &&
           add_clamp(&of, true) && add_clamp(&of, false));
}

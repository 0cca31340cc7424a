/* passive.c - R, L and C: two nodes, a value, an initial condition.
 *
 * R = 0 is a short. An inductor of 0 H is one too and becomes a resistor of 0 ohm; a capacitor of
 * 0 F is open and becomes a current source of 0 A: neither has a state. */
#include "passive.h"

#include "core.h"
#include "element_cards.h"
#include "model_cards.h"
#include "reader.h"

#include <string.h>

/* Ohms that LTspice puts in series with a coil where no Rser= is written and no K card names it. */
static const double LTSPICE_RSER = 1e-3;

static const struct dalcs_passive_family *family_of(enum dalcs_device_kind kind) {
    static const struct dalcs_passive_family resistor = {"a resistor is: Rname node node ohms",
                                                         "a resistance",
                                                         {"r", "resistance", NULL},
                                                         NULL,
                                                         DALCS_OHM};
    static const struct dalcs_passive_family inductor = {
        "an inductor is: Lname node node henries [IC=amperes]",
        "an inductance",
        {"l", "inductance", "ind"},
        "flux",
        DALCS_HENRY};
    static const struct dalcs_passive_family capacitor = {
        "a capacitor is: Cname node node farads [IC=volts]",
        "a capacitance",
        {"c", "capacitance", "cap"},
        "q",
        DALCS_FARAD};
    return kind == DALCS_RESISTOR ? &resistor : kind == DALCS_INDUCTOR ? &inductor : &capacitor;
}

/* Replaces a device without a state by one that does the same. */
static void replace_zero(struct dalcs_builder *builder, struct dalcs_device *device,
                         const struct dalcs_token *value) {
    struct dalcs_circuit *circuit = builder->circuit;
    const bool is_inductor = device->kind == DALCS_INDUCTOR;
    dalcs_builder_note(builder, value, NULL, "%s of 0 is %s",
                       is_inductor ? "an inductance" : "a capacitance",
                       is_inductor ? "a short" : "open");
    device->has_initial = false;
    if (is_inductor) {
        device->kind = DALCS_RESISTOR;
        return;
    }
    device->kind = DALCS_ISOURCE;
    device->stimulus = circuit->n_stimuli++;
    circuit->stimulus[device->stimulus] =
        (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC, .has_dc = true};
}

/* m of it in parallel. */
static void multiply(struct dalcs_device *device, struct dalcs_parasitics *parasitics, double m) {
    device->value *= device->kind == DALCS_CAPACITOR ? m : 1 / m;
    device->initial *= device->kind == DALCS_INDUCTOR ? m : 1;
    dalcs_parasitic_multiply(parasitics, m);
}

/* One that is no straight line. */
static void expand_storage(struct dalcs_builder *builder, const struct dalcs_card *card,
                           struct dalcs_device *device, struct dalcs_passive_values *values) {
    const double m = values->multiplier > 0 ? values->multiplier : 1;
    const bool has_core = values->core.first != NULL;
    struct dalcs_core_stop stop;
    if (!has_core && dalcs_storage_follow(builder, card, device, &values->law, m)) {
        return;
    }
    if (has_core && !dalcs_core_make(builder, card, &values->core, m, &values->law, &stop)) {
        return;
    }
    if (dalcs_storage_expand(builder, card, device, &values->law, m) && has_core) {
        dalcs_core_add_stop(builder, card->token, device->node, &stop);
    }
}

static bool is_parameter_next(const struct dalcs_reader *reader) {
    const struct dalcs_token *equal = dalcs_reader_peek(reader, 1);
    return equal != NULL && equal->kind == DALCS_TOKEN_EQUAL;
}

/* The value of the model where the card has none, as KiCad writes each part with a temperature. */
static bool takes_model_value(const struct dalcs_reader *reader, const struct dalcs_model *model,
                              struct dalcs_passive_values *values, struct dalcs_device *device) {
    const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
    if (model == NULL || !model->has_value ||
        (next != NULL && !is_parameter_next(reader)) /* a value of its own */) {
        return false;
    }
    device->value = model->value;
    values->is_of_model = true;
    return true;
}

/* Beside a value on the card ngspice leaves that of a model out, and PSpice multiplies by it. */
static bool is_of_model_alone(struct dalcs_reader *reader, const struct dalcs_model *model,
                              struct dalcs_passive_values *values) {
    if (values->is_of_model && !values->has_value) {
        values->has_value = true;
        return true;
    }
    if (model != NULL && model->has_value && model->value != 1.0) {
        int k = reader->card->n - 1;
        while (k > 0 && strcmp(reader->card->token[k].text, model->name->text) != 0) {
            k--;
        }
        dalcs_builder_error(reader->builder, &reader->card->token[k],
                            "write the value on the card and leave out the model",
                            "'%s' and its model '%s' both have a value: ngspice takes the first, "
                            "PSpice their product",
                            reader->card->token->text, model->name->text);
        return false;
    }
    return true;
}

/* The value at the temperature of the circuit. */
static void warm(struct dalcs_builder *builder, const struct dalcs_card *card,
                 struct dalcs_device *device, const struct dalcs_passive_values *values,
                 const struct dalcs_model *model) {
    const double factor = dalcs_coefficients_factor(builder, &values->coefficients,
                                                    model != NULL ? &model->coefficients : NULL);
    if (factor != 1 && (values->law.formula != NULL || values->core.first != NULL)) {
        dalcs_builder_warn(builder, card->token, "write the formula with temp",
                           "coefficients of temperature change no formula and no core");
        return;
    }
    device->value *= factor;
}

/* The value, the model and the parameters behind the nodes; *value: the last token of the value. */
static bool read_values(struct dalcs_reader *reader, const struct dalcs_passive_family *family,
                        struct dalcs_device *device, struct dalcs_passive_values *values,
                        const struct dalcs_model **model, const struct dalcs_token **value) {
    const char letter = family->names[0][0];
    if (!dalcs_model_take_passive(reader, letter, model)) {
        return false;
    }
    (void)dalcs_reader_take_word(reader, "noiseless");
    if (!takes_model_value(reader, *model, values, device) && !is_parameter_next(reader) &&
        !dalcs_passive_take_law(reader, values, true)) {
        if (!dalcs_reader_number(reader, family->quantity, family->value, &device->value)) {
            return false;
        }
        values->has_value = true;
    }
    *value = dalcs_reader_previous(reader);
    if (!dalcs_model_take_passive(reader, letter, model) ||
        !dalcs_passive_read_rest(reader, family, device, values, value) ||
        !is_of_model_alone(reader, *model, values)) {
        return false;
    }
    if (!values->has_value) {
        dalcs_reader_missing(reader, family->value);
        return false;
    }
    return true;
}

void dalcs_passive_parse(struct dalcs_builder *builder, const struct dalcs_card *card,
                         enum dalcs_device_kind kind) {
    const struct dalcs_passive_family *family = family_of(kind);
    if (kind == DALCS_RESISTOR && dalcs_behavioural_is_resistance(card)) {
        dalcs_behavioural_parse_resistance(builder, card);
        return;
    }
    struct dalcs_reader reader = dalcs_reader_start(builder, card, family->usage);
    struct dalcs_device *device = dalcs_builder_add_device(builder, kind, card->token);
    if (device == NULL || !dalcs_reader_nodes(&reader, 2, device->node)) {
        return;
    }
    struct dalcs_passive_values values = {.has_value = false};
    const struct dalcs_model *model = NULL;
    const struct dalcs_token *value;
    if (!read_values(&reader, family, device, &values, &model, &value)) {
        return;
    }
    warm(builder, card, device, &values, model);
    if (device->value < 0 && kind != DALCS_RESISTOR) {
        dalcs_builder_error(builder, value, NULL, "%s cannot be negative", family->value);
        return;
    }
    if (card->parallel > 0) {
        values.multiplier = (values.multiplier > 0 ? values.multiplier : 1) * card->parallel;
    }
    if (builder->elements.default_rser != NULL && kind == DALCS_INDUCTOR &&
        values.law.formula == NULL && values.core.first == NULL &&
        !dalcs_parasitic_has_rser(&values.parasitics)) {
        builder->elements.default_rser[device - builder->circuit->device] =
            LTSPICE_RSER / (values.multiplier > 0 ? values.multiplier : 1);
    }
    if (values.multiplier > 0) {
        multiply(device, &values.parasitics, values.multiplier);
    }
    dalcs_parasitic_expand(builder, card->token, device, &values.parasitics);
    if (values.law.formula != NULL || values.core.first != NULL) {
        expand_storage(builder, card, device, &values);
        return;
    }
    if (device->value == 0 && kind != DALCS_RESISTOR) {
        replace_zero(builder, device, value);
    }
}

void dalcs_passive_add_default_rser(struct dalcs_builder *builder) {
    const struct dalcs_circuit *circuit = builder->circuit;
    const int n_devices = circuit->n_devices;
    int n = 0;
    const struct dalcs_token *first = NULL;
    if (builder->elements.default_rser == NULL) {
        return;
    }
    for (int k = 0; k < circuit->n_couplings; k++) {
        builder->elements.default_rser[circuit->coupling[k].inductor[0]] = 0;
        builder->elements.default_rser[circuit->coupling[k].inductor[1]] = 0;
    }
    for (int k = 0; k < n_devices && !builder->out_of_memory; k++) {
        struct dalcs_device *device = &builder->circuit->device[k];
        if (builder->elements.default_rser[k] > 0 && device->kind == DALCS_INDUCTOR) {
            first = n++ == 0 ? builder->elements.device_token[k] : first;
            dalcs_parasitic_add_rser(builder, builder->elements.device_token[k], device,
                                     builder->elements.default_rser[k]);
        }
    }
    if (n > 0) {
        dalcs_builder_note(builder, first, "write Rser=0 for none",
                           "%d coil%s without Rser= %s the 1 mohm that LTspice puts in series", n,
                           n == 1 ? "" : "s", n == 1 ? "has" : "have");
    }
}

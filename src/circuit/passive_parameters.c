/* passive_parameters.c - what stands on the card of R, L or C behind its nodes. */
#include "passive.h"

#include "core.h"
#include "element_cards.h"
#include "model_cards.h"
#include "number.h"
#include "reader.h"

#include <string.h>

static bool is_value_name(const struct dalcs_passive_family *family, const char *name) {
    for (int k = 0; k < 3 && family->names[k] != NULL; k++) {
        if (strcmp(name, family->names[k]) == 0) {
            return true;
        }
    }
    return false;
}

bool dalcs_passive_take_law(struct dalcs_reader *reader, struct dalcs_passive_values *values,
                            bool is_slope) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    if (token == NULL || token->kind != DALCS_TOKEN_FORMULA) {
        return false;
    }
    reader->at++;
    values->has_value = true;
    values->law.formula = token;
    values->law.is_slope = is_slope;
    return true;
}

/* An inductor has no Lser, a resistor nothing. */
static bool may_have(enum dalcs_device_kind kind, const char *parasitic) {
    return dalcs_parasitic_is_name(parasitic) &&
           (kind == DALCS_CAPACITOR || (kind == DALCS_INDUCTOR && strchr(parasitic, 'l') == NULL));
}

static bool is_multiplier(struct dalcs_reader *reader, double m) {
    if (m <= 0) {
        dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), NULL,
                            "a multiplier must be positive");
    }
    return m > 0;
}

bool dalcs_passive_read_multiplier(struct dalcs_reader *reader, double *multiplier) {
    if (!dalcs_reader_number(reader, DALCS_PLAIN, "a number", multiplier)) {
        return false;
    }
    return is_multiplier(reader, *multiplier);
}

/* `ac 1k` behind a resistance, without an equal sign. */
static bool is_resistance_of_ac(const struct dalcs_reader *reader) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    const struct dalcs_token *next = dalcs_reader_peek(reader, 1);
    return token != NULL && token->kind == DALCS_TOKEN_WORD && strcmp(token->text, "ac") == 0 &&
           next != NULL && dalcs_reader_is_number(next);
}

/* `noiseless`, `noiseless=True` and `x2`, which LTspice writes behind a value: two in parallel. *taken: was it one? */
static bool read_word(struct dalcs_reader *reader, double *multiplier, bool *taken) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    struct dalcs_number number;
    *taken = dalcs_reader_take_word(reader, "noiseless");
    if (*taken && dalcs_reader_take(reader, DALCS_TOKEN_EQUAL)) {
        return dalcs_reader_skip_value(reader);
    }
    if (*taken || token == NULL || token->kind != DALCS_TOKEN_WORD || token->text[0] != 'x' ||
        dalcs_number_parse(token->text + 1, &number) != DALCS_NUMBER_OK) {
        return true;
    }
    *taken = true;
    reader->at++;
    *multiplier = number.value;
    return is_multiplier(reader, number.value);
}

static bool read_value(struct dalcs_reader *reader, const struct dalcs_passive_family *family,
                       const struct dalcs_token *name, struct dalcs_device *device,
                       struct dalcs_passive_values *values) {
    struct dalcs_builder *builder = reader->builder;
    const bool is_law = family->law != NULL && strcmp(name->text, family->law) == 0;
    if (values->has_value) {
        dalcs_builder_error(builder, name, NULL, "%s is given twice", family->value);
        return false;
    }
    if (dalcs_passive_take_law(reader, values, !is_law)) {
        return true;
    }
    if (is_law) {
        dalcs_reader_missing(reader, "a formula of x");
        return false;
    }
    values->has_value = true;
    return dalcs_reader_number(reader, family->quantity, family->value, &device->value);
}

static bool read_initial(struct dalcs_reader *reader, const struct dalcs_token *name,
                         struct dalcs_device *device) {
    struct dalcs_builder *builder = reader->builder;
    if (device->has_initial) {
        dalcs_builder_error(builder, name, NULL, "an initial condition is given twice");
        return false;
    }
    const bool is_inductor = device->kind == DALCS_INDUCTOR;
    device->has_initial = true;
    builder->analyses.initial_state =
        builder->analyses.initial_state != NULL ? builder->analyses.initial_state : name;
    return dalcs_reader_number(reader, is_inductor ? DALCS_CURRENT : DALCS_VOLTAGE,
                               is_inductor ? "a current" : "a voltage", &device->initial);
}

/* Nothing has noise here. */
static bool skip_noise(struct dalcs_reader *reader, const struct dalcs_token *name) {
    double ignored;
    struct dalcs_builder *builder = reader->builder;
    dalcs_builder_note(builder, name, NULL, "'%s' has no meaning here and is ignored", name->text);
    while (dalcs_reader_peek(reader, 0) != NULL &&
           dalcs_reader_is_number(dalcs_reader_peek(reader, 0))) {
        if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "a number", &ignored)) {
            return false;
        }
    }
    return true;
}

/* The value of a parameter after the card's value. False ends the card. */
static bool read_parameter(struct dalcs_reader *reader, const struct dalcs_passive_family *family,
                           const struct dalcs_token *name, struct dalcs_device *device,
                           struct dalcs_passive_values *values) {
    static const char *const noise[] = {"noisy", "noise"};
    struct dalcs_builder *builder = reader->builder;
    double ignored;
    const bool is_law = family->law != NULL && strcmp(name->text, family->law) == 0;
    if (is_law || is_value_name(family, name->text)) {
        return read_value(reader, family, name, device, values);
    }
    if (strcmp(name->text, "ic") == 0 && device->kind != DALCS_RESISTOR) {
        return read_initial(reader, name, device);
    }
    if (dalcs_coefficient_is_name(name->text)) {
        return dalcs_coefficient_read(reader, name, &values->coefficients);
    }
    if (dalcs_builder_is_one_of(name->text, noise, sizeof noise / sizeof noise[0])) {
        return skip_noise(reader, name);
    }
    if (device->kind == DALCS_INDUCTOR && dalcs_core_is_name(name->text)) {
        if (values->has_value && values->core.first == NULL) {
            dalcs_builder_error(builder, name, NULL, "a core beside %s", family->value);
            return false;
        }
        values->has_value = true;
        return dalcs_core_read(reader, name, &values->core);
    }
    if (strcmp(name->text, "ac") == 0 && device->kind == DALCS_RESISTOR) {
        dalcs_builder_warn(
            builder, name, "write a second netlist for .ac with this value",
            "a resistance of .ac alone is ignored: '%s' has the other one there, too",
            reader->card->token->text);
        return dalcs_reader_number(reader, DALCS_OHM, "a resistance", &ignored);
    }
    if (may_have(device->kind, name->text)) {
        return dalcs_parasitic_read(reader, name, &values->parasitics);
    }
    if (strcmp(name->text, "m") == 0) {
        return dalcs_passive_read_multiplier(reader, &values->multiplier);
    }
    if (dalcs_builder_is_label(name->text)) {
        return dalcs_reader_skip_value(reader);
    }
    dalcs_builder_error(builder, name, family->usage, "%s has no parameter '%s'",
                        dalcs_builder_kind_text(device->kind), name->text);
    return false;
}

bool dalcs_passive_read_rest(struct dalcs_reader *reader, const struct dalcs_passive_family *family,
                             struct dalcs_device *device, struct dalcs_passive_values *values,
                             const struct dalcs_token **value) {
    while (!dalcs_reader_at_end(reader)) {
        const bool had_value = values->has_value;
        bool taken;
        if (!read_word(reader, &values->multiplier, &taken)) {
            return false;
        }
        if (taken) {
            continue;
        }
        const struct dalcs_token *name = dalcs_reader_take_parameter(reader);
        if (name == NULL && device->kind == DALCS_RESISTOR && is_resistance_of_ac(reader)) {
            name = dalcs_reader_peek(reader, 0);
            reader->at++;
        }
        if (name == NULL) {
            return dalcs_reader_end(reader);
        }
        if (!read_parameter(reader, family, name, device, values)) {
            return false;
        }
        *value = values->has_value && !had_value ? dalcs_reader_previous(reader) : *value;
    }
    return true;
}

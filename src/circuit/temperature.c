/* temperature.c - .temp, .options temp= and tnom=, and the coefficients of R, L and C.
 *
 * As in SPICE, a value is given for 27 degrees Celsius, or for tnom. A resistor, coil or capacitor with
 * coefficients has another one at the circuit's temperature, or at its own (temp=, dtemp=). Diodes,
 * switches and transistors are ideal elements and stay as they are. */
#include "temperature.h"

#include "builder.h"
#include "reader.h"

#include <math.h>
#include <string.h>

static const double NOMINAL = 27; /* degrees Celsius */

/* ---- Coefficients ---------------------------------------------------------------------------- */

static const char *const NAMES[] = {"tc",    "tc1",  "tc2",        "tce",   "temp",        "dtemp",
                                    "trise", "tnom", "t_measured", "t_abs", "t_rel_global"};

bool dalcs_coefficient_is_name(const char *name) {
    return dalcs_builder_is_one_of(name, NAMES, sizeof NAMES / sizeof NAMES[0]);
}

void dalcs_coefficient_set(struct dalcs_coefficients *c, const char *name, double value) {
    if (strcmp(name, "tce") == 0) {
        c->has_exponential = true;
        c->tce = value;
    } else if (strcmp(name, "tc2") == 0) {
        c->has_linear = true;
        c->tc2 = value;
    } else if (strcmp(name, "tc") == 0 || strcmp(name, "tc1") == 0) {
        c->has_linear = true;
        c->tc1 = value;
    } else if (strcmp(name, "temp") == 0 || strcmp(name, "t_abs") == 0) {
        c->has_temperature = true;
        c->temperature = value;
    } else if (strcmp(name, "tnom") == 0 || strcmp(name, "t_measured") == 0) {
        c->has_nominal = true;
        c->nominal = value;
    } else { /* dtemp, trise, t_rel_global */
        c->has_difference = true;
        c->difference = value;
    }
}

bool dalcs_coefficient_read(struct dalcs_reader *reader, const struct dalcs_token *name,
                            struct dalcs_coefficients *c) {
    double value;
    if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "a number", &value)) {
        return false;
    }
    dalcs_coefficient_set(c, name->text, value);
    const struct dalcs_token *next;
    for (int k = 0; (next = dalcs_reader_peek(reader, 0)) != NULL && dalcs_reader_is_number(next);
         k++) {
        if (strcmp(name->text, "tc") != 0 || k > 0) {
            dalcs_reader_unexpected(reader);
            return false;
        }
        if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "a number", &c->tc2)) {
            return false;
        }
    }
    return true;
}

double dalcs_coefficients_factor(const struct dalcs_builder *builder,
                                 const struct dalcs_coefficients *card,
                                 const struct dalcs_coefficients *model) {
    static const struct dalcs_coefficients none = {.has_linear = false};
    const struct dalcs_temperatures *circuit = &builder->temperatures;
    const struct dalcs_coefficients *m = model != NULL ? model : &none;
    const bool is_of_card = card->has_linear || card->has_exponential;
    const struct dalcs_coefficients *c = is_of_card ? card : m;
    const struct dalcs_coefficients *at = card->has_temperature ? card : m;
    const struct dalcs_coefficients *above = card->has_difference ? card : m;
    const double change =
        at->has_temperature ? at->temperature - NOMINAL : circuit->change + above->difference;
    const double nominal = m->has_nominal ? m->nominal - NOMINAL : circuit->nominal_change;
    const double by = change - nominal;
    return c->has_exponential ? pow(1.01, c->tce * by) : 1 + by * (c->tc1 + by * c->tc2);
}

/* ---- The temperature of the circuit ------------------------------------------------------------- */

void dalcs_temperature_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, ".temp degrees");
    double value;
    (void)dalcs_reader_take(&reader, DALCS_TOKEN_EQUAL);
    if (!dalcs_reader_list_number(&reader, DALCS_PLAIN, "a temperature", &value)) {
        return;
    }
    builder->temperatures.place = card->token;
    builder->temperatures.change = value - NOMINAL;
    if (!dalcs_reader_at_end(&reader)) {
        dalcs_builder_warn(builder, dalcs_reader_peek(&reader, 0),
                           "a run for each: .step temp list ...",
                           "the run is at the first temperature of this card alone");
    }
}

bool dalcs_temperature_read_option(struct dalcs_reader *reader, const struct dalcs_token *name) {
    struct dalcs_temperatures *t = &reader->builder->temperatures;
    double value;
    if (!dalcs_reader_number(reader, DALCS_PLAIN, "a temperature", &value)) {
        return false;
    }
    if (strcmp(name->text, "tnom") == 0) {
        t->nominal_change = value - NOMINAL;
    } else {
        t->place = name;
        t->change = value - NOMINAL;
    }
    return true;
}

void dalcs_temperature_settle(struct dalcs_builder *builder) {
    struct dalcs_temperatures *t = &builder->temperatures;
    double value;
    if (dalcs_deck_temperature(builder->deck, &value)) {
        t->change = value - NOMINAL;
    }
    if (t->change == t->nominal_change || t->place == NULL) {
        return;
    }
    for (size_t k = 0; k < builder->deck->n_cards; k++) {
        const struct dalcs_card *card = &builder->deck->card[k];
        if (strchr("dmqz", card->letter) != NULL && card->letter != '\0') {
            dalcs_builder_warn(builder, t->place, NULL,
                               "diodes and transistors keep their values of 27 degrees: R, L and C "
                               "with tc1= or tc2=, and formulas with temp, follow the temperature");
            return;
        }
    }
}

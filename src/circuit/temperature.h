/* temperature.h - what R, L and C are at the temperature of the circuit. */
#ifndef DALCS_TEMPERATURE_H
#define DALCS_TEMPERATURE_H

#include <stdbool.h>

struct dalcs_builder;
struct dalcs_card;
struct dalcs_reader;
struct dalcs_token;

/* In degrees Celsius; the netlist's, or 27 each, as in SPICE. */
struct dalcs_temperatures {
    const struct dalcs_token *place; /* where the netlist says it, or NULL */
    double change;                   /* K, of the circuit from 27 degrees */
    double nominal_change;           /* K, of that which values are given for */
};

/* The coefficients of one R, L or C, or of its model: value * (1 + tc1 dT + tc2 dT^2), or, for a resistor with tce,
 * value * 1.01^(tce dT). */
struct dalcs_coefficients {
    double tc1, tc2, tce;
    double temperature, nominal, difference; /* C, C, K */
    bool has_linear, has_exponential;
    bool has_temperature, has_nominal, has_difference;
};

/* Is it tc, tc1, tc2, tce, temp, dtemp, tnom, ...? */
bool dalcs_coefficient_is_name(const char *name);
void dalcs_coefficient_set(struct dalcs_coefficients *c, const char *name, double value);

/* The value or values behind the equal sign; false after an error. */
bool dalcs_coefficient_read(struct dalcs_reader *reader, const struct dalcs_token *name,
                            struct dalcs_coefficients *c);

/* What the value is multiplied by; exactly 1 at the temperature that it is given for. */
double dalcs_coefficients_factor(const struct dalcs_builder *builder,
                                 const struct dalcs_coefficients *card,
                                 const struct dalcs_coefficients *model);

/* .temp T, and temp=T and tnom=T of .options. */
void dalcs_temperature_parse(struct dalcs_builder *builder, const struct dalcs_card *card);
bool dalcs_temperature_read_option(struct dalcs_reader *reader, const struct dalcs_token *name);

/* A .step of the temperature comes last; and what does not follow it is said. */
void dalcs_temperature_settle(struct dalcs_builder *builder);

#endif

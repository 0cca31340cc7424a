/* passive.h - the values on the card of R, L or C. Private to this folder. */
#ifndef DALCS_PASSIVE_H
#define DALCS_PASSIVE_H

#include "core.h"
#include "element_cards.h"
#include "model_cards.h"
#include "number.h"
#include "reader.h"
#include "temperature.h"

/* What belongs to one of the three letters. */
struct dalcs_passive_family {
    const char *usage;
    const char *value;    /* what the value is called when it is missing */
    const char *names[3]; /* of the value when written as a parameter */
    const char *law;      /* the parameter whose formula is its flux or charge, or NULL */
    enum dalcs_quantity quantity;
};

/* The values of a card. */
struct dalcs_passive_values {
    bool has_value;
    bool is_of_model;  /* unless the card has another */
    double multiplier; /* 0: none */
    struct dalcs_parasitics parasitics;
    struct dalcs_storage_law law;
    struct dalcs_core core;
    struct dalcs_coefficients coefficients;
};

/* What follows the value, or has it. *value: its token. */
bool dalcs_passive_read_rest(struct dalcs_reader *reader, const struct dalcs_passive_family *family,
                             struct dalcs_device *device, struct dalcs_passive_values *values,
                             const struct dalcs_token **value);

/* A formula in the place of a value, or behind Flux= or Q=; false: there is none. */
bool dalcs_passive_take_law(struct dalcs_reader *reader, struct dalcs_passive_values *values,
                            bool is_slope);

/* m=, how many of it are in parallel; false after a message. */
bool dalcs_passive_read_multiplier(struct dalcs_reader *reader, double *multiplier);

#endif

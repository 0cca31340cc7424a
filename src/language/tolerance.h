/* tolerance.h - DEV and LOT as PSpice writes them, and the cards that have them. Private to this folder. */
#ifndef DALCS_TOLERANCE_H
#define DALCS_TOLERANCE_H

#include "card_value.h"

/* DEV[/n][/uniform|/gauss] = size[%] */
struct dalcs_tolerance {
    const struct dalcs_token *token; /* NULL: there is none */
    double size;
    bool is_relative; /* size is of the value, else in its unit */
    bool is_gauss;
    char generator; /* '0' to '9': those with the same one go together; '\0': none is named */
};

/* Those of one value. */
struct dalcs_tolerances {
    struct dalcs_tolerance dev, lot;
    const char *name; /* of the parameter that they follow, else NULL */
    int at;           /* its value, or the word before them, on the card that is left */
};

/* A .model card with tolerances. */
struct dalcs_tolerant_model {
    size_t card; /* of the deck */
    struct dalcs_tolerances *value;
    int n;
    const char *lot; /* what its LOT is shared by: "rb", "power/rb" in a subcircuit */
    bool is_used;    /* by an element: a library has many more */
};

struct dalcs_tolerant {
    struct dalcs_language *language;
    struct dalcs_names models; /* flat name -> index of model */
    struct dalcs_tolerant_model *model;
    size_t n_models, capacity;
    struct dalcs_names listed; /* for .wcase */
    size_t n_functions; /* values that random functions have a part in, the first of the deck's */
    const struct dalcs_token *first;
};

/* What is drawn for a DEV of a device's value, in units of it: `field` of its model, else "". .wcase lists it as `name`. */
double dalcs_tolerance_draw_dev(struct dalcs_tolerant *all, const struct dalcs_tolerance *t,
                                const char *device, const char *field, const char *name);

/* The same for a LOT of a model's field, else NULL. */
double dalcs_tolerance_draw_lot(struct dalcs_tolerant *all, const struct dalcs_tolerance *t,
                                const char *lot, const char *field);

/* "power/rb" of x1.rb: what all instances of the subcircuit share. */
const char *dalcs_tolerance_lot_of_model(struct dalcs_language *language, const char *flat);

/* A value with a tolerance: the values of random functions are not used then. */
void dalcs_tolerance_keep(struct dalcs_tolerant *all, const char *name, double value);

/* Takes all tolerances off a card: *found lists them in the order of the values that they follow, in the language's
 * arena. Those of an element have one entry at most. False when an error was reported. */
bool dalcs_tolerances_take(struct dalcs_language *language, struct dalcs_card *card,
                           struct dalcs_tolerances **found, int *n_found);

/* ---- tolerance_models.c ------------------------------------------------------------------------ */

/* Of a model of these: R, RES, C, CAP, L, IND; else 0. */
char dalcs_tolerance_passive_type(const struct dalcs_card *card);

/* In the unit of the value, whose nominal one this is. */
double dalcs_tolerance_size(const struct dalcs_tolerance *t, double nominal);

/* Keeps what card k of the deck, a .model, has of tolerances; false when an error was reported. */
bool dalcs_tolerance_take_model(struct dalcs_tolerant *all, size_t k);

/* The number at token `at`; false after a message. */
bool dalcs_tolerance_nominal(struct dalcs_language *language, const struct dalcs_card *card, int at,
                             const struct dalcs_token *tolerance, double *value);

/* The model's values as a device has them: `device` NULL: without DEV, which others draw. */
enum dalcs_status dalcs_tolerance_set_model(struct dalcs_tolerant *all,
                                            const struct dalcs_tolerant_model *m,
                                            const char *device, struct dalcs_card *card);

/* Has one of its values a DEV? */
bool dalcs_tolerance_model_has_dev(const struct dalcs_tolerant_model *m);

#endif

/* card_value.h - values on flat cards. Private to this folder. */
#ifndef DALCS_CARD_VALUE_H
#define DALCS_CARD_VALUE_H

#include "language.h"

/* Is it a number, or a word that begins like one? */
bool dalcs_token_is_number(const struct dalcs_token *token);

/* Where `name =` stands on a card from token `from` on, or on a model `name` and a number: the token of its
 * value; 0: nowhere. */
int dalcs_card_find_assigned(const struct dalcs_card *card, int from, const char *name);

/* The token of an element's value; *is_there: false when it has to be put in there. */
int dalcs_card_find_value(const struct dalcs_card *card, bool *is_there);

/* A copy of the card with `value` at token `at`, before it `name =` where a name is given; the tokens
 * from `at` on come after that, without the first when it is replaced. */
enum dalcs_status dalcs_card_edit(struct dalcs_language *language, struct dalcs_card *card, int at,
                                  bool replaces, const char *name, double value);

/* A copy of the card with this value at token `at`. */
enum dalcs_status dalcs_card_set(struct dalcs_language *language, struct dalcs_card *card, int at,
                                 double value) DALCS_MUST_CHECK;

/* A copy of the card with this function behind all the rest, and no other; or with an AC value there, which counts before
 * those in front of it. */
enum dalcs_status dalcs_card_edit_waveform(struct dalcs_language *language, struct dalcs_card *card,
                                           const struct dalcs_override *override);

#endif

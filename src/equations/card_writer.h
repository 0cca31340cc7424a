/* card_writer.h - cards of a system file, as text or as lists of JSON. */
#ifndef DALCS_CARD_WRITER_H
#define DALCS_CARD_WRITER_H

#include "equations.h"

struct dalcs_card_writer {
    enum dalcs_machine_format format;
    const struct dalcs_equations_files *files;
    FILE *out;
    bool first; /* JSON: nothing yet in the present list */
    bool in_card;
    int n_matrices;
    enum dalcs_status status;
};

/* Within a word. */
void dalcs_card_text(struct dalcs_card_writer *w, const char *text);

void dalcs_card_begin(struct dalcs_card_writer *w, const char *word);
void dalcs_card_between(struct dalcs_card_writer *w);
void dalcs_card_word(struct dalcs_card_writer *w, const char *word);
void dalcs_card_name(struct dalcs_card_writer *w, const char *name);
void dalcs_card_number(struct dalcs_card_writer *w, double value);
void dalcs_card_parameter(struct dalcs_card_writer *w, const char *name, double value);
void dalcs_card_unit(struct dalcs_card_writer *w, bool is_current);
void dalcs_card_end(struct dalcs_card_writer *w);

/* All blocks of a system, each a card, or a file of its own with a card that names it. */
void dalcs_card_matrices(struct dalcs_card_writer *w, const struct dalcs_system *s);

#endif

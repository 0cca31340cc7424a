/* later.h - sources that put out what a voltage was some time ago (history.h). */
#ifndef DALCS_LATER_H
#define DALCS_LATER_H

#include "builder.h"

struct dalcs_later {
    const struct dalcs_token *name;
    const char *what; /* "line1": of its devices, what("name") */
    int input;        /* node whose voltage against ground it is */
    int output[2];    /* nodes */
    double seconds;   /* above 0 */
    double initial;   /* V, with uic until t = 0 */
};

/* Made when all formulas are compiled. */
void dalcs_later_add(struct dalcs_builder *builder, const struct dalcs_later *later);

/* How many there are; each takes a stimulus. */
size_t dalcs_later_pending(const struct dalcs_builder *builder);

void dalcs_later_resolve(struct dalcs_builder *builder);

/* Tname a b c d Z0=ohms TD=seconds: a lossless line (line.c). */
void dalcs_line_parse(struct dalcs_builder *builder, const struct dalcs_card *card);

enum {
    DALCS_LINE_DEVICES = 5,
    DALCS_LATER_DEVICES = 2
}; /* besides its own: of a line; of a delayed source */

#endif

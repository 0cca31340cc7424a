/* output_resistance.h - the outputs of LTspice's A devices that are ideal as long as they can be.
 * Private to this folder. */
#ifndef DALCS_OUTPUT_RESISTANCE_H
#define DALCS_OUTPUT_RESISTANCE_H

#include "builder.h"

/* A source whose first node is the pin of an output. */
struct dalcs_output {
    const struct dalcs_output *before;
    const struct dalcs_token *element;
    int device;
};

void dalcs_output_add(struct dalcs_builder *builder, const struct dalcs_token *element,
                      const struct dalcs_device *source);

/* Gives LTspice's resistance to those that others hold, when all elements are known. */
void dalcs_output_resolve(struct dalcs_builder *builder);

#endif

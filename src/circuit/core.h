/* core.h - Chan's magnetic core, as LTspice has it on a coil's card. Private to this folder. */
#ifndef DALCS_CORE_H
#define DALCS_CORE_H

#include "reader.h"
#include "storage.h"

enum { DALCS_CORE_PARAMETERS = 8 };

/* The parameters of a card; zero-initialise. */
struct dalcs_core {
    double value[DALCS_CORE_PARAMETERS];
    const struct dalcs_token *place[DALCS_CORE_PARAMETERS];
    const struct dalcs_token *first; /* NULL: the card has no core */
};

bool dalcs_core_is_name(const char *name);

/* The value behind `name =`; false when an error was reported. */
bool dalcs_core_read(struct dalcs_reader *reader, const struct dalcs_token *name,
                     struct dalcs_core *core);

/* The curve without hysteresis, of m coils in parallel, into *law, and what goes beside it into *stop: a coil whose
 * current is limited. False when an error was reported. */
struct dalcs_core_stop {
    double henry, ampere;
};

bool dalcs_core_make(struct dalcs_builder *builder, const struct dalcs_card *card,
                     const struct dalcs_core *core, double m, struct dalcs_storage_law *law,
                     struct dalcs_core_stop *stop);

/* The coil of the hysteresis, from node[0] to node[1]. */
void dalcs_core_add_stop(struct dalcs_builder *builder, const struct dalcs_token *element,
                         const int *node, const struct dalcs_core_stop *stop);

/* The number of devices of the core of a card, and half as many stimuli; 0: no core. */
size_t dalcs_core_count(const struct dalcs_card *card);

#endif

/* description.h - a DALCS given by its matrices and source functions, as text: a system file.
 *
 * A file becomes what a netlist becomes, a circuit (of no devices: analyses, options, stimuli) and a
 * network (systems, outputs, states), so that later stages are the same for both. The format
 * is in doc/system-file.md. */
#ifndef DALCS_DESCRIPTION_H
#define DALCS_DESCRIPTION_H

#include "jumps.h"
#include "netlist.h"

struct dalcs_description {
    struct dalcs_circuit circuit; /* no devices; its signals are those of the network */
    struct dalcs_network network; /* borrows names from the circuit */
};

/* Is this the text of a system file, or of its JSON form? */
bool dalcs_description_is_text(const char *text, size_t length);

/* Reads *description from text[0..length-1], which messages call `name`; files that it names lie
 * relative to the folder of `name`. What is wrong goes to diag with DALCS_E_NETLIST, and
 * *description is zeroed. */
enum dalcs_status dalcs_description_read_text(struct dalcs_description *description,
                                              const char *name, const char *text, size_t length,
                                              struct dalcs_diag *diag) DALCS_MUST_CHECK;

void dalcs_description_finish(struct dalcs_description *description);

#endif

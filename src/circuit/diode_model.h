/* diode_model.h - the parameters of a diode on its .model card. Private to this folder. */
#ifndef DALCS_DIODE_MODEL_H
#define DALCS_DIODE_MODEL_H

#include "diode_parts.h"
#include "model_cards.h"
#include "reader.h"

enum {
    DALCS_DIODE_RON,
    DALCS_DIODE_ROFF,
    DALCS_DIODE_VFWD,
    DALCS_DIODE_VREV,
    DALCS_DIODE_RREV,
    DALCS_DIODE_ILIMIT,
    DALCS_DIODE_REVILIMIT,
    DALCS_DIODE_EPSILON,
    DALCS_DIODE_REVEPSILON,
    DALCS_DIODE_IS,
    DALCS_DIODE_JS,
    DALCS_DIODE_N,
    DALCS_DIODE_RS,
    DALCS_DIODE_BV,
    DALCS_DIODE_IBV,
    DALCS_DIODE_NBV,
    DALCS_DIODE_VB,  /* other names: of BV in PSpice and Xyce, */
    DALCS_DIODE_VRB, /* in HSPICE, */
    DALCS_DIODE_IB,  /* and of IBV there */
    DALCS_DIODE_N_PARAMETERS
};

enum { DALCS_DIODE_FIRST_BERKELEY = DALCS_DIODE_IS };

/* Is it a parameter of the exponential diode without a counterpart here? */
bool dalcs_diode_is_ignored(const char *name);

/* A model without any parameter is ideal, which is not the diode of SPICE. */
void dalcs_diode_note_bare(struct dalcs_builder *builder, const struct dalcs_token *place);

/* What a note says of parameters that are ignored; "": there are none. */
const char *dalcs_diode_ignored_text(struct dalcs_builder *builder, const struct dalcs_card *card,
                                     const struct dalcs_parameter *p, bool with_berkeley);

/* The three lines of an exponential diode; false after a message. */
bool dalcs_diode_set_berkeley(struct dalcs_reader *reader, const struct dalcs_token *place,
                              struct dalcs_parameter *p, struct dalcs_diode_card *card,
                              struct dalcs_diode_model *model);

#endif

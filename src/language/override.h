/* override.h - other values for what a netlist says, without changing its text: what .step, .dc and
 * alter do. They come in while cards are expanded, so everything that depends on them follows. */
#ifndef DALCS_OVERRIDE_H
#define DALCS_OVERRIDE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum dalcs_override_kind {
    DALCS_OVERRIDE_PARAMETER, /* of .param, outside of subcircuits */
    DALCS_OVERRIDE_ELEMENT,   /* the value of R, L, C, V, I (DC) or the gain of E, F, G, H */
    DALCS_OVERRIDE_MODEL,     /* a parameter of a .model */
    DALCS_OVERRIDE_WAVEFORM,  /* the function of a V or I */
    DALCS_OVERRIDE_RUN, /* the number of the run, from 1: random values are those of it; 0: in the middle */
    DALCS_OVERRIDE_CORNER /* where tolerances are: -1 and 1 are their ends; those not named are in the middle */
};

struct dalcs_override {
    enum dalcs_override_kind kind;
    const char *name;  /* flat, lower case: "x1.r1" */
    const char *field; /* of a model: "vfwd"; of a waveform: "pulse"; else NULL */
    double value;
    bool is_step;       /* of a run: one of .step or .mc */
    const double *list; /* [n_list] of a waveform, of a corner */
    size_t n_list;
    const uint64_t *key; /* [n_list] of a corner: of which tolerance (struct dalcs_draw) */
};

#endif

/* logic_parts.h - a gate on its nodes, whatever dialect its card is of, until the outputs of all are known. */
#ifndef DALCS_LOGIC_PARTS_H
#define DALCS_LOGIC_PARTS_H

#include "model_cards.h"
#include "reader.h"

struct dalcs_logic_card {
    const struct dalcs_logic_card *before;
    const struct dalcs_token *name; /* of the element; of one that is several its own */
    bool is_element; /* its source has that name: what the element's current is asked of */
    struct dalcs_logic_gate *gate;

    struct dalcs_logic_pin {
        bool is_wired, is_inverted;
        int node, reference;
    } * pin; /* [gate->n_inputs] */

    int node[2], common; /* of q and its complement, -1: not wired */
    double ohms[2];      /* in series with an output that is low, high */
    bool may_resist;     /* one of LTspice, whose card has no resistance */
    double farad;        /* behind those, to the common node */
    double on, off;      /* V: where an input rises and falls */

    struct dalcs_logic_sampled {
        int node, reference;
    } sampled; /* of a sample; of a pulse, whose length it is; else both are ground */
};

/* What an element of this function may have behind it. */
struct dalcs_logic_parameters {
    const char *what;          /* in messages: "a gate" */
    struct dalcs_parameter *p; /* a name that is NULL is not of this function */
    int n;
    bool has_noise; /* as an OTA has: named, and without a meaning here */
};

/* False: an error was reported. */
bool dalcs_logic_read_parameters(struct dalcs_reader *reader,
                                 const struct dalcs_logic_parameters *of);
/* Vt or Vh, if it is given, of what compares with Ref. */
void dalcs_logic_ignore_threshold(const struct dalcs_reader *reader,
                                  const struct dalcs_parameter *p, const char *function);
/* Voltages alone may be negative; false: an error was reported. */
bool dalcs_logic_check_signs(const struct dalcs_reader *reader,
                             const struct dalcs_logic_parameters *of);

/* A gate with so many inputs, none of which is wired; NULL: out of memory. */
struct dalcs_logic_card *dalcs_logic_start(struct dalcs_builder *builder,
                                           const struct dalcs_token *name, int n_inputs);

/* Its sources, once all of it is known; then it is one of the circuit's. */
void dalcs_logic_add(struct dalcs_builder *builder, struct dalcs_logic_card *of);

#endif

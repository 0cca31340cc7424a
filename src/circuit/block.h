/* block.h - XSPICE's code models: an A card of ports and a model whose type says what it does. */
#ifndef DALCS_BLOCK_H
#define DALCS_BLOCK_H

#include "reader.h"

/* The contents of a .model card: names and lists of numbers. Their meaning depends on the type. */
struct dalcs_block {
    const struct dalcs_token *name, *type;
    int n;

    struct dalcs_block_value {
        const struct dalcs_token *name;
        int n;
        const double *number;
    } * value; /* [n] */
};

/* A list of nodes, or one. */
struct dalcs_block_port {
    bool is_list;
    int n;

    struct dalcs_block_end {
        const struct dalcs_token *token;
        bool is_null, is_inverted;
        int node, reference;
    } * end; /* [n] */
};

enum { DALCS_BLOCK_PORTS = 8 };

struct dalcs_block_card {
    struct dalcs_builder *builder;
    const struct dalcs_card *card;
    const struct dalcs_block *block;
    int n_ports;
    struct dalcs_block_port port[DALCS_BLOCK_PORTS];
};

/* A type that XSPICE has, though it may be refused. */
bool dalcs_block_is_type(const char *type);

/* Is it refused? Then with a message about the element of the card. */
bool dalcs_block_is_refused(struct dalcs_builder *builder, const struct dalcs_card *card,
                            const struct dalcs_block *block);

/* What follows the type on a .model card; NULL when an error was reported. */
const struct dalcs_block *dalcs_block_parse_model(struct dalcs_reader *reader,
                                                  const struct dalcs_token *name,
                                                  const struct dalcs_token *type);

/* An A card whose model is one. */
void dalcs_block_parse(struct dalcs_builder *builder, const struct dalcs_card *card,
                       const struct dalcs_block *block);

/* A parameter of the model, a number; its default where the card does not have it. */
double dalcs_block_number(const struct dalcs_block *block, const char *name, double otherwise);
/* Number k of a list; beyond its end, or without it, its default. */
double dalcs_block_element(const struct dalcs_block *block, const char *name, int k,
                           double otherwise);
const struct dalcs_block_value *dalcs_block_find(const struct dalcs_block *block, const char *name);

/* Reports parameters that are none of list[n]; false where there are any. */
bool dalcs_block_has_only(const struct dalcs_block_card *c, const char *const *list, size_t n);
/* Reports another number of ports than that; optional ones may be left out. */
bool dalcs_block_has_ports(const struct dalcs_block_card *c, int n, int n_optional,
                           const char *usage);
/* Reports a port that is null or inverted: one of a voltage must be a node. */
bool dalcs_block_has_nodes(const struct dalcs_block_card *c, const char *usage);

/* An A card whose model is a transformer. */
void dalcs_transformer_parse(struct dalcs_builder *builder, const struct dalcs_card *card,
                             const struct dalcs_block *block);

/* Gates, flip-flops, bridges: false where the type is none of them. */
bool dalcs_block_parse_logic(struct dalcs_block_card *c);
void dalcs_block_parse_one_shot(const struct dalcs_block_card *c);
/* gain, summer, limit, int, d_dt, slew, pwl, hyst, aswitch: likewise. */
bool dalcs_block_parse_analog(struct dalcs_block_card *c);
/* mult, divide, climit, s_xfer: likewise. */
bool dalcs_block_parse_formula(struct dalcs_block_card *c);
/* triangle, square, sine, d_osc: likewise. */
bool dalcs_block_parse_oscillator(const struct dalcs_block_card *c);

#endif

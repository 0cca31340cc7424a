/* drawn_tree.h - what is drawn as a tree of operations on columns. Private to this folder. */
#ifndef DALCS_DRAWN_TREE_H
#define DALCS_DRAWN_TREE_H

#include "drawn_signal.h"

enum { DALCS_DRAWN_DEPTH = 100, DALCS_DRAWN_NAMES = 12, DALCS_DRAWN_LENGTH = 4000 };

enum dalcs_drawn_operation {
    DALCS_DRAWN_NUMBER,
    DALCS_DRAWN_COLUMN,
    DALCS_DRAWN_NEGATE,
    DALCS_DRAWN_ADD,
    DALCS_DRAWN_SUBTRACT,
    DALCS_DRAWN_MULTIPLY,
    DALCS_DRAWN_DIVIDE,
    DALCS_DRAWN_ABS,
    DALCS_DRAWN_SQRT,
    DALCS_DRAWN_DB
};

struct dalcs_signal_node {
    enum dalcs_drawn_operation operation;
    size_t column;
    double number;
    struct dalcs_dimension dimension;
    const struct dalcs_signal_node *left, *right;
};

struct dalcs_drawn_parser {
    const struct dalcs_waveforms *waveforms;
    struct dalcs_arena *arena;
    struct dalcs_diag *diag;
    const char *text; /* without blanks */
    const char *at;
    int depth;
};

/* One more part; NULL: out of memory. */
enum dalcs_status dalcs_drawn_make(struct dalcs_drawn_parser *parser,
                                   const struct dalcs_signal_node *value,
                                   const struct dalcs_signal_node **node);

/* An operation on one or two parts; NULL after a message. */
enum dalcs_status dalcs_drawn_combine(struct dalcs_drawn_parser *parser,
                                      enum dalcs_drawn_operation operation,
                                      const struct dalcs_signal_node *left,
                                      const struct dalcs_signal_node *right,
                                      const struct dalcs_signal_node **node);

/* A column of the file. */
enum dalcs_status dalcs_drawn_column(struct dalcs_drawn_parser *parser, size_t column,
                                     const struct dalcs_signal_node **node);

/* v(a), i(x) or a column by its name; NULL after a message. */
enum dalcs_status dalcs_drawn_name(struct dalcs_drawn_parser *parser, char *name,
                                   const struct dalcs_signal_node **node);

#endif

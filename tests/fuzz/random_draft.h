#ifndef TESTS_FUZZ_RANDOM_DRAFT_H
#define TESTS_FUZZ_RANDOM_DRAFT_H
/* random_draft.h - a netlist while it is written from bytes: what random_netlist.c, random_elements.c and random_blocks.c share. */
#include "random_netlist.h"

#include <stdbool.h>

enum { MOST_NODES = 6, MOST_ELEMENTS = 12 };

struct draft {
    const uint8_t *data;
    size_t size, at;
    char *text;
    size_t length;
    int n_nodes;              /* ground counted */
    int n_elements;           /* so far */
    char kind[MOST_ELEMENTS]; /* of each */
    int n_sources, n_coils;   /* V sources and inductors so far: v1, v2, ... and l1, l2, ... */
    int n_diodes, n_switches; /* models are written for */
    int n_of[128];            /* of each letter */
    bool parameter;           /* {p} is used */
    bool has_blocks;          /* kinds of random_blocks.c, too */
};

void put(struct draft *d, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* 0 .. n-1. */
int pick(struct draft *d, int n);
const char *word(struct draft *d, const char *const *list, int n);

#define WORD(d, ...)                                                                               \
    word(d, (const char *const[]){__VA_ARGS__},                                                    \
         (int)(sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *)))

const char *node(struct draft *d);

/* Any node but ground. */
const char *live(struct draft *d);

const char *volts(struct draft *d);

/* A voltage, or the current of a source; the time is of others. */
void signal_of(struct draft *d);

/* Of signals, of a depth. */
void formula(struct draft *d, int depth);

const char *gain(struct draft *d);

/* The value of a source. */
void stimulus(struct draft *d);

/* ---- random_elements.c ------------------------------------------------------------------------- */

/* One element between two nodes. */
void element(struct draft *d, const char *a, const char *b);

/* Each coil is in one pair at most: three that are coupled at will may give energy. */
void couplings(struct draft *d);

/* ---- random_blocks.c --------------------------------------------------------------------------- */

/* One of the code models of XSPICE or of LTspice's A devices, with its model, between a node and ground or others. */
void block(struct draft *d, int n, const char *a, const char *b);

/* Subcircuits in one another, with parameters and coupled coils, functions, and the temperature. */
void subcircuits(struct draft *d);

/* Cards of other analyses around it: .env, .pss with .ac, measurements of these. */
void other_analyses(struct draft *d);

#endif

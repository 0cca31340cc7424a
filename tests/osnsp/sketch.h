/* sketch.h - random circuits, small enough that every mode can be tried. */
#ifndef DALCS_SKETCH_H
#define DALCS_SKETCH_H

#include <stdbool.h>
#include <stdint.h>

/* splitmix64 (Steele, Lea and Flood 2014): the same numbers on every machine. */
struct splitmix {
    uint64_t state;
};

uint64_t splitmix_next(struct splitmix *r);

/* 0..n-1 */
int splitmix_below(struct splitmix *r, int n);

enum sketch_family {
    SKETCH_INTEGER,    /* ohms, volts, amperes, farads and henries are small integers */
    SKETCH_SPREAD,     /* 1e-9 to 1e9 ohm, C/h and L/h 1e-6 to 1e6 */
    SKETCH_SWITCHES,   /* the first, with ideal switches in commanded states */
    SKETCH_CONTROLLED, /* the first, with controlled sources: not passive */
    SKETCH_N_FAMILIES
};

enum {
    SKETCH_MAX_ELEMENTS = 40,
    SKETCH_MAX_DIODES = 9,
    SKETCH_MAX_NODES = 8,
    SKETCH_TEXT_SIZE = 8192
};

struct sketch_element {
    char kind;      /* r l c v i d s e f g h k: also the first letter of its name */
    int node[4];    /* k: the two coils; f, h: the controlling v in node[2] */
    double value;   /* V, A, ohm, F, H, gain or k */
    double initial; /* IC= of c and l */
    int model;  /* of d: ideal, with Ron and Vfwd, with Roff, with Vrev; of s: ideal, with Ron */
    bool on;    /* s: commanded state */
    bool saved; /* its current is asked for */
};

struct sketch {
    int n_nodes; /* ground included */
    int n;
    struct sketch_element element[SKETCH_MAX_ELEMENTS];
};

struct sketch sketch_random(enum sketch_family family, uint64_t seed);

/* The same circuit with R, L and C all 1: it has a solution iff the first has one, see oracle.h. */
struct sketch sketch_unit_values(const struct sketch *sketch);

/* The circuit's netlist. */
void sketch_write(const struct sketch *sketch, char text[SKETCH_TEXT_SIZE]);

/* The number of the element of this name, -1 if there is none. */
int sketch_find(const struct sketch *sketch, const char *name);

/* What is controlled becomes a source of this value. */
struct sketch sketch_with_sources(const struct sketch *sketch, double value);

/* What is left when elements not kept are taken out (open), or replaced by wires. Numbers and names
 * of elements stay. */
struct sketch sketch_without(const struct sketch *sketch, const bool *keep);
struct sketch sketch_wired(const struct sketch *sketch, const bool *keep);

#endif

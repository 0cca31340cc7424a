/* diode_parts.h - diodes by the names that people write: 1N4148, MUR460, BZX84C15. */
#ifndef DALCS_DIODE_PARTS_H
#define DALCS_DIODE_PARTS_H

#include <stdbool.h>

enum dalcs_junction {
    DALCS_JUNCTION_SILICON,
    DALCS_JUNCTION_SCHOTTKY,
    DALCS_JUNCTION_GERMANIUM,
    DALCS_JUNCTION_LED,
    DALCS_JUNCTION_ZENER
};

/* Two points of the forward curve, and one in breakdown. */
struct dalcs_diode_part {
    enum dalcs_junction junction;
    double i[2], v[2];    /* A, V; i[0] < i[1] */
    double breakdown, at; /* V, A */
};

/* The part of a name in lower case, with whatever prefix or suffix people put to it; false: unknown. */
bool dalcs_diode_part_find(const char *name, struct dalcs_diode_part *part);

/* The kind of junction in words, and its emission coefficient. */
const char *dalcs_junction_text(enum dalcs_junction junction);
double dalcs_junction_emission(enum dalcs_junction junction);

#endif

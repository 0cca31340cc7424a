/* pair_laws.h - what gives the current of a closed pair, and so what rounding makes of it. */
#ifndef DALCS_PAIR_LAWS_H
#define DALCS_PAIR_LAWS_H

#include "radau.h"

enum { DALCS_PAIR_LAWS = 3 };

/* The KCL of a node where nothing but capacitors, resistors and coils takes the current, or the pair's own
 * resistance. */
struct dalcs_pair_law {
    bool holds;
    double capacitance, conductance; /* F, S */
};

/* Fills part->pair_law[n_pairs][DALCS_PAIR_LAWS]; part->pair_row is known. */
void dalcs_pair_laws_find(struct dalcs_radau_part *part);

/* A of the current of a closed pair per V by which voltages are rounded, in the present step: by the law
 * that makes the least of them. */
double dalcs_pair_charge_rate(const struct dalcs_radau_part *part, int pair);

/* F at a node, H of a coil; 0 of an algebraic row. */
double dalcs_pair_storage(const struct dalcs_system *system, int row);

#endif

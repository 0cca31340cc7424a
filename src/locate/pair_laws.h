/* pair_laws.h - what gives the current of a closed pair, what is stored next to one, and so what rounding makes
 * of it. */
#ifndef DALCS_PAIR_LAWS_H
#define DALCS_PAIR_LAWS_H

#include "radau_state.h"

enum { DALCS_PAIR_LAWS = 3 };

/* The KCL of a node where nothing but capacitors, resistors, coils and other pairs takes the current, or the
 * pair's own resistance. */
struct dalcs_pair_law {
    bool holds;
    double capacitance, conductance; /* F, S */
    double inductance;               /* H, of the largest coil at the node */
};

/* A per V, by which voltages are rounded, of the currents of closed pairs; INFINITY: it follows from no law. */
struct dalcs_pair_rate {
    uint64_t *mode; /* for which they are known */
    double h;       /* likewise; 0: they are not */
    double *of;     /* [n_pairs] */
};

/* NULL: out of memory. */
struct dalcs_pair_rate *dalcs_pair_rate_create(struct dalcs_arena *arena, int n_pairs, int n_words);

/* Fills the part's data of its pairs: pair_row, held_charge, held_flux, pair_law. */
enum dalcs_status dalcs_pair_laws_find(struct dalcs_radau_part *part) DALCS_MUST_CHECK;

/* A of the current of a closed pair per V by which voltages are rounded, in the present step: by the law
 * that makes the least of them. */
double dalcs_pair_charge_rate(const struct dalcs_radau_part *part, int pair);

/* Wb: the largest coil at a node of a pair times the largest current there in the present step, of which rounding
 * is a part. A coil of 0.4 H that carries 0.2 A is not rounded by the 250 A of another one elsewhere. */
double dalcs_pair_flux(const struct dalcs_radau_part *part, int pair);

#endif

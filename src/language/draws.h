/* draws.h - random values that depend on a seed, the number of the run and the place, and on nothing else.
 *
 * A counter-based generator (Salmon, Moraes, Dror & Shaw, Parallel random numbers: as easy as 1, 2, 3, SC 2011):
 * there is no state that threads share or that a run leaves to the next one. The place is a name, not a line:
 * another card in the netlist changes no value of those that were there. */
#ifndef DALCS_DRAWS_H
#define DALCS_DRAWS_H

#include <stdbool.h>
#include <stdint.h>

/* Seeds are whole numbers that a double holds exactly. */
#define DALCS_MOST_SEED 9007199254740992.0

/* Philox4x32-10: ten rounds of a bijection of 128 bits under a key of 64. */
void dalcs_philox(const uint32_t counter[4], const uint32_t key[2], uint32_t out[4]);

/* A hash of a text, after those that `hash` is of; texts "ab", "c" and "a", "bc" differ. */
uint64_t dalcs_draw_hash(uint64_t hash, const char *text);
extern const uint64_t dalcs_draw_hash_start;

/* Value k of a place in a run: in (0, 1), an odd multiple of 2^-53. */
double dalcs_draw_uniform(uint64_t seed, uint32_t run, uint64_t place, uint32_t k);

/* LTspice's rand(x) at a whole x, in (0, 1): the same in every run. */
double dalcs_draw_at(double whole);

/* The quantile of the standard normal distribution, 0 < p < 1: relative error near 1e-16 (Wichura, algorithm AS 241,
 * Applied Statistics 37, 1988). */
double dalcs_normal_quantile(double p);

/* What a function of the netlist makes of its arguments x[n] and a value in (0, 1). */
typedef double dalcs_draw(const double *x, int n, double u);

/* One of these functions called with n arguments, or NULL; `is_known`: there is one, with another number. */
dalcs_draw *dalcs_draw_find(const char *name, int n, bool *is_known);

/* How it is written, for a message; NULL: there is none of that name. */
const char *dalcs_draw_usage(const char *name);

#endif

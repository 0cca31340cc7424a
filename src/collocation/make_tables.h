/* make_tables.h - the table of a method, in more digits than it has. Private to make_collocation. */
#ifndef DALCS_MAKE_TABLES_H
#define DALCS_MAKE_TABLES_H

#include "collocation.h"

#include <float.h>

enum { MAX = DALCS_MAX_NODES, SCAN = 2000 };

/* More digits than the table has: of an eigenvector as many are lost as those of A and of its transpose
 * are at right angles to each other, six for s = 9. */
#if LDBL_MANT_DIG >= 113
typedef long double real;
typedef long double complex complex_real;
#else
typedef __float128 real;
typedef _Complex float complex_real __attribute__((mode(TC)));
#endif

enum nodes { GAUSS, RADAU, LOBATTO };

/* All of a method, from its nodes and its A. */
void dalcs_make_tables(struct dalcs_collocation *c, enum dalcs_family family, int n_stages);

real dalcs_size_of(real x);

real dalcs_larger_real(real a, real b);

real dalcs_real_power(real x, int n);

/* Whose roots are sought in (-1, 1): Legendre for Gauss, the difference for Radau, (1 - t^2) P'_n-1 but for a
 * factor for Lobatto. */
real dalcs_node_polynomial(int n, enum nodes nodes, real t);

/* Roots in (0, 1), ascending: each sign change of a scan, bisected. Returns their number. */
int dalcs_roots_in_unit_interval(int n, enum nodes nodes, real *root);

/* Lagrange's polynomials on node[n], at x. */
void dalcs_lagrange(int n, const real *node, real x, real *value);

/* Gauss' rule for integrals over (0, 1). */
void dalcs_gauss_rule(int n, real *node, real *weight);

#endif

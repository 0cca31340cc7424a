/* magnitudes.h - the orders of magnitude that rules of the engine tell apart.
 *
 * Most rules ask whether a quantity is much smaller than another, is nothing beside it, or is the same. The cases lie far
 * apart, so that an order of magnitude answers, and these are the ones. A rule that needs a number of its own says where
 * that comes from. What rounding alone makes of a value is in rounding.h. */
#ifndef DALCS_MAGNITUDES_H
#define DALCS_MAGNITUDES_H

/* What an estimate of an error or of rounding may be short by: what is beyond so many times it is none. An estimate that
 * is one digit is one (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, section IV.8). */
static const double dalcs_beyond = 10.0;

/* A part of what is allowed that may be spent besides and is not seen in it, and two values that agree: two digits. It is
 * also kappa of Hairer and Wanner, section IV.8. */
static const double dalcs_slight = 1e-2;

/* Much smaller: what is beside it changes none of its leading digits, and has three of its own before rounding of a
 * default tolerance of 1e-6 is reached. */
static const double dalcs_small = 1e-3;

/* Nothing beside another of its kind: nobody who asks for six digits, which is the default, sees it. */
static const double dalcs_nothing = 1e-6;

/* Answers nearer to each other, over the largest of their unit, are one: a one-step problem is right to this, with seven
 * digits of it lost to conductances that far apart. */
static const double dalcs_alike = 1e-9;

#endif

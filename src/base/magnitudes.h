/* magnitudes.h - the orders of magnitude by which rules of the engine decide.
 *
 * Most rules decide whether a quantity is much smaller than another, is nothing beside it, or is the same. These cases lie
 * far apart, so that an order of magnitude separates them. Each decision has one number here. A rule that needs a number
 * of its own says where that comes from. What rounding alone makes of a value is in rounding.h. */
#ifndef DALCS_MAGNITUDES_H
#define DALCS_MAGNITUDES_H

/* Beyond an estimate of an error or of rounding: no estimate that is made here is short by more (E. Hairer, G. Wanner,
 * Solving Ordinary Differential Equations II, section IV.8, have no more of theirs). */
static const double dalcs_beyond = 10.0;

/* A slight part of what is allowed, which may be spent besides and is not seen in it: kappa of Hairer and Wanner, section
 * IV.8. So two values agree that share two digits. */
static const double dalcs_slight = 1e-2;

/* Much smaller: it changes no more than the fourth digit of what is beside it. */
static const double dalcs_small = 1e-3;

/* Nothing beside another of its kind: who asks for six digits, which is the default, does not see it. */
static const double dalcs_nothing = 1e-6;

/* Alike: the difference, over the largest of the unit, is what a one-step problem may be off by. Any value from 1e-10 to
 * 1e-8 is right: of sixteen digits, conductances that are seven orders of magnitude apart cost seven. */
static const double dalcs_alike = 1e-9;

#endif

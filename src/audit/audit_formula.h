/* audit_formula.h - what formulas put out, and what that is held to. Private to src/audit. */
#ifndef DALCS_AUDIT_FORMULA_H
#define DALCS_AUDIT_FORMULA_H

#include "audit_internal.h"

/* How far the argument of a jump of a formula is from its knot, over its scale: of the nearest. INFINITY: it has none. */
double audit_jump_beside(const struct dalcs_audit *audit, const struct audit_part *part,
                         const struct dalcs_audit_state *s, int device);

/* formula_reads.c: what formulas read of the circuit itself, by way of their parts, and what that is held to. */
enum dalcs_status audit_find_reads(struct dalcs_audit *audit) DALCS_MUST_CHECK;
double audit_read_scale(const struct dalcs_audit *audit, const struct audit_part *part,
                        const struct dalcs_audit_state *s, struct audit_read of);

/* formula_value.c: what a formula is of that, and what it is held to. */
struct audit_number audit_formula_value(const struct dalcs_audit *audit,
                                        const struct audit_part *part,
                                        const struct dalcs_audit_state *s, int device);
double audit_formula_size(const struct dalcs_audit *audit, const struct audit_part *part,
                          const struct dalcs_audit_state *s, int device);

/* formulas.c: of the sums that a formula without smooth functions is made of, the terms of the largest one, added up. */
double audit_formula_terms(const struct dalcs_audit *audit, const struct audit_part *part,
                           const struct dalcs_audit_state *s, int device);

/* ... the levels that it adds up: numbers, jumps and saturations. */
double audit_formula_levels(const struct dalcs_audit *audit, const struct dalcs_audit_state *s,
                            int device);

/* ... what rounding of its parts leaves in what it puts out. */
double audit_formula_rounding(const struct dalcs_audit *audit, const struct audit_part *part,
                              const struct dalcs_audit_state *s, int device);

/* Its law at a state. */
void audit_check_formula(struct dalcs_audit *audit, struct audit_part *part,
                         const struct dalcs_audit_state *s, int device);
/* ... of all formulas of a part. */
void audit_check_formulas(struct dalcs_audit *audit, struct audit_part *part,
                          const struct dalcs_audit_state *s);
/* ... is a pair of a formula where it may change sides? */
bool audit_behaviour_may_turn(const struct dalcs_audit *audit, const struct audit_part *part,
                              const struct dalcs_audit_state *s, int device);

/* At a time of the stretch that is taken up: no more than formulas. */
void audit_look_at_formulas(struct dalcs_audit *audit, int part, double t, enum dalcs_side side);

#endif

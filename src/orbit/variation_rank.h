/* variation_rank.h - V through a segment that changes few of its directions. Private to variation.c. */
#ifndef DALCS_VARIATION_RANK_H
#define DALCS_VARIATION_RANK_H

#include "variation.h"

enum dalcs_status dalcs_variation_rank_setup(struct dalcs_variation_part *v,
                                             struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* As dalcs_variation_pass_columns, where columns can go together. false: the segment changes too many directions, V is as
 * before. */
bool dalcs_variation_pass_rank(struct dalcs_variation_part *v,
                               const struct dalcs_stage_entry *entry, const double *weight, int row,
                               bool is_new);

#endif

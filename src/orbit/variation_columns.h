/* variation_columns.h - columns of V through a segment, four at once. Private to variation.c. */
#ifndef DALCS_VARIATION_COLUMNS_H
#define DALCS_VARIATION_COLUMNS_H

#include "variation.h"

enum dalcs_status dalcs_variation_columns_setup(struct dalcs_variation_part *v,
                                                struct dalcs_arena *arena) DALCS_MUST_CHECK;

/* Can columns go through a step of the entry together? */
bool dalcs_variation_shares(const struct dalcs_variation_part *v,
                            const struct dalcs_stage_entry *entry);

/* V and v->guard where the segment ends, weights of nodes being those of there. is_new: so is the mode. */
void dalcs_variation_pass_columns(struct dalcs_variation_part *v,
                                  const struct dalcs_stage_entry *entry, const double *weight,
                                  int row, bool is_new);

/* V where the polynomial through the stages of a step in the entry's mode begins. */
void dalcs_variation_project_columns(struct dalcs_variation_part *v,
                                     const struct dalcs_stage_entry *entry);

#endif

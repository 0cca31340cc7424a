/* stage_update.h - a mode that differs by a few pairs from one that is factored, on its factors. */
#ifndef DALCS_STAGE_UPDATE_H
#define DALCS_STAGE_UPDATE_H

#include "stage_change.h"

enum { DALCS_STAGE_MOST_CHANGES = DALCS_LU_SPARE, DALCS_STAGE_FIRST_TRUST = 8 };

/* The mode of an entry as changes of its base. */
struct dalcs_stage_update {
    struct dalcs_stage_entry *base; /* held until the update is destroyed */
    int n_closed, n_changes;
    struct dalcs_stage_change *change[DALCS_STAGE_MOST_CHANGES]; /* those that close first */
    long double
        *inverse[DALCS_STAGE_SYSTEMS]; /* [n_changes][n_changes] of S, then its imaginary part */
};

/* Has it factors that other entries may use? */
bool dalcs_stage_update_can_be_base(const struct dalcs_stage_entry *entry);

bool dalcs_stage_is_update(const struct dalcs_stage_entry *entry);

/* Does a step of length h from in[n_in], which gave out, satisfy its equations as well as one of the
 * base? If not the entry is doubtful. */
void dalcs_stage_update_check(struct dalcs_stages *stages, struct dalcs_stage_entry *entry,
                              const double *in, const double *out);
bool dalcs_stage_update_is_doubtful(const struct dalcs_stages *stages,
                                    const struct dalcs_stage_entry *entry);

/* One more step on this entry; had it better have factors of its own, as a doubtful one or one that has
 * cost so much? */
bool dalcs_stage_update_is_spent(const struct dalcs_stages *stages,
                                 struct dalcs_stage_entry *entry);

/* entry->factors as an update of a base that is near, if there is one and it has enough digits to serve as
 * well as factors of the entry's own would; else they stay NULL. */
enum dalcs_status dalcs_stage_update_build(struct dalcs_stages *stages,
                                           struct dalcs_stage_entry *entry) DALCS_MUST_CHECK;

/* lu[system].work, loaded with a share of the waves, becomes the solution. */
void dalcs_stage_update_solve(const struct dalcs_stage_plan *plan,
                              const struct dalcs_stage_factors *f, int system, int share);

/* Bytes of the factors of an update, without its base. */
size_t dalcs_stage_update_bytes(const struct dalcs_stage_factors *f);

/* Frees the memory of an update and releases its base. */
void dalcs_stage_update_destroy(struct dalcs_stages *stages, struct dalcs_stage_factors *f);

#endif

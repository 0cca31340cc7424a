/* stages_internal.h - what the files behind stages.h share. */
#ifndef DALCS_STAGES_INTERNAL_H
#define DALCS_STAGES_INTERNAL_H

#include "lu.h"
#include "stages.h"

#define HASH_NONFATAL_OOM 1
#include <uthash.h>

struct dalcs_stage_factors;

struct dalcs_stage_entry {
    UT_hash_handle hh;
    struct dalcs_stage_entry *newer, *older;
    uint64_t *key; /* mode words, then the bits of h */
    const uint64_t *mode;
    double h;
    int n; /* unknowns: x, z, lambda of closed pairs */
    int n_on;
    int *on; /* [n_on] ascending */
    int n_clashes;
    bool gives_rows_up; /* which no sources contradict, but only what they read (stage_choice.c) */
    bool frees_states;
    double *natural; /* [2 n_equations] */
    double residual;
    int rows;    /* of map, padded to 8 */
    double *map; /* [rows][n_in] by columns; NULL: factors */

    struct { /* behind map */
        int current_rows;
        double *current; /* [current_rows][n_in] the drift of currents */
        double *shift;   /* [n_x][n_in] how far the mode moves states at once */
    } maps;

    int note;
    struct dalcs_stage_factors *factors;

    struct { /* of one with factors of its own, which others may be low-rank changes of */
        struct dalcs_stage_entry *newer, *older;
        int n_holders; /* the store and the entries that are updates of this one */
    } as_base;

    int spent; /* changes worked in so far, of an update */
    size_t bytes;
};

static inline bool dalcs_stage_is_on(const struct dalcs_stage_entry *e, int pair) {
    return dalcs_mode_has(e->mode, pair);
}

/* stage_map.c: the dense matrix of an entry. */
enum dalcs_status dalcs_stage_map_build(struct dalcs_stages *stages,
                                        struct dalcs_stage_entry *entry) DALCS_MUST_CHECK;
void dalcs_stage_map_apply(const struct dalcs_stages *stages, const struct dalcs_stage_entry *entry,
                           const double *in, double *out);

/* Columns of a map, and in[] without what maps lack of it. */
int dalcs_stage_map_columns(const struct dalcs_stages *stages);
const double *dalcs_stage_map_input(const struct dalcs_stages *stages, const double *in);

void dalcs_stage_map_currents(const struct dalcs_stages *stages,
                              const struct dalcs_stage_entry *entry, const double *in,
                              double *drift);

/* stage_build.c: sparse factors of an entry, of its own or those of another entry as well, with a few
 * changes. */
enum dalcs_status dalcs_stage_factors_build(struct dalcs_stages *stages,
                                            struct dalcs_stage_entry *entry,
                                            bool of_its_own) DALCS_MUST_CHECK;
void dalcs_stage_factors_destroy(struct dalcs_stages *stages, struct dalcs_stage_factors *factors);

/* stage_factors.c */
enum dalcs_status dalcs_stage_factors_apply(struct dalcs_stages *stages,
                                            const struct dalcs_stage_entry *entry, const double *in,
                                            double *out) DALCS_MUST_CHECK;
void dalcs_stage_factors_currents(const struct dalcs_stages *stages,
                                  const struct dalcs_stage_entry *entry, double *drift);
void dalcs_stage_factors_settle(const struct dalcs_stages *stages,
                                const struct dalcs_stage_entry *entry, double *out);

#endif

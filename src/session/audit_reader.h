/* audit_reader.h - what the files of the audit of a run share. */
#ifndef DALCS_AUDIT_READER_H
#define DALCS_AUDIT_READER_H

#include "audit_run.h"

/* Who belongs to a part, and where its columns are. */
struct audit_members {
    int n_nodes, n_devices, n_lambdas;
    int *node, *node_column;
    int *device; /* [n_devices] with currents of their own; the auditor computes the others */
    int *lambda, *lambda_pair;
    bool was_left;                         /* its segment ended at the present time */
    struct dalcs_audit_polynomials stored; /* the present segment */
    struct dalcs_audit_stretch stretch;    /* likewise */
    bool has_maps;
    double work, brief_work;             /* of a segment, in instructions; of one that recurs */
    double elements;                     /* of its maps, likewise */
    const struct dalcs_stage_entry *map; /* that gave it; NULL: none */
    /* Of the segment that ended last, where it did. */
    double *last_out;
    double last_end, last_time; /* in steps; s */
    double last_step;           /* s */
    uint64_t *last_mode;
};

/* Instructions of a segment beside its maps, at least, of one that recurs and has no rows. */
static const double dalcs_audit_segment_work = 1200.0;

/* The largest defect that ends no run. */
double dalcs_audit_most_allowed(const struct dalcs_audit_run *a);

/* audit_leaps.c: the segment that a leap was tried to has begun, or another one has instead. */
void dalcs_audit_leaps_compare(struct dalcs_audit_run *a);

/* a->part. */
enum dalcs_status dalcs_audit_members_make(struct dalcs_audit_run *a) DALCS_MUST_CHECK;

struct dalcs_audit_reader dalcs_audit_reader_of(struct dalcs_audit_run *a);

/* The present segment of a part, up to a time. */
struct dalcs_audit_stretch *dalcs_audit_reader_stretch(struct dalcs_audit_run *a, int index,
                                                       double to);

/* Is the present segment of the mode, the step, the end and the map that the one before was of? Then its stretch is ready. */
bool dalcs_audit_reader_repeats(const struct dalcs_radau_part *part, struct audit_members *m);

/* The present segment of a part ends: its end can be read until the next one has. */
void dalcs_audit_reader_keep(const struct dalcs_audit_run *a, int index);

#endif

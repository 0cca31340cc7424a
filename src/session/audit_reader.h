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
    int *
        bystander; /* [n_columns] which of the bystanders it is, whom sources alone decide; -1: none */
    bool was_left;                         /* its segment ended at the present time */
    struct dalcs_audit_polynomials stored; /* the present segment */
    struct dalcs_audit_stretch stretch;    /* likewise */
    bool has_maps;

    struct {                   /* in instructions */
        double segment, brief; /* of a segment; of one that recurs */
        double elements;       /* of its maps */
    } work;
    struct dalcs_stage_entry *map;  /* that gave it; NULL: none */
    struct dalcs_stage_entry *held; /* that of segments that the auditor gathers; NULL: of none */

    struct { /* the segment that ended last, where it did */
        double *out;
        double end, time; /* in steps; s */
        double step;      /* s */
        uint64_t *mode;
    } last;
    struct audit_present *present;
    struct dalcs_audit_batch *batch;
};

/* Instructions of a segment beside its maps, at least, of one that recurs and has no rows. */
static const double dalcs_audit_segment_work = 1200.0;

/* audit_revisit.c: the present segment, while one that has gone by is in its place. */
struct audit_present;
enum dalcs_status dalcs_audit_present_make(struct dalcs_audit_run *a, int part) DALCS_MUST_CHECK;
struct dalcs_audit_stretch *dalcs_audit_revisit(void *user, int part,
                                                const struct dalcs_audit_kept *before,
                                                const struct dalcs_audit_kept *present);
void dalcs_audit_go_back(void *user, int part);

/* What the auditor has gathered of a part is asked. */
void dalcs_audit_run_settle(struct dalcs_audit_run *a, int part);

/* The share of a run that a sample may cost: with the counts above the netlists of the repository stay below 5 %. */
static const double dalcs_audit_share = 0.03;

/* Instructions, about, of a state of a part. */
double dalcs_audit_state_work(const struct dalcs_audit_run *a, int part);

/* audit_rows.c: what rows have taken since it was asked last is work of the run. */
void dalcs_audit_earn_rows(struct dalcs_audit_run *a);

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

/* Does the segment begin with its input? One of those kept of a period has another start. */
static inline bool dalcs_audit_begins_with_input(const struct dalcs_radau_part *part) {
    const int n_x = part->component->system->n_x;
    const double *in = part->segment.in;
    const double *out = part->segment.out;
    bool is = true;
    for (int x = 0; x < n_x; x++) {
        is &= in[x] == out[x];
    }
    return is;
}

static inline struct dalcs_stage_entry *
dalcs_audit_entry_of(const struct dalcs_part_segment *segment) {
    return segment->late != NULL    ? segment->late
           : segment->brief != NULL ? segment->brief->entry
                                    : segment->entry;
}

/* Is the present segment of the mode, the step, the end and the map that the one before was of? */
static inline bool dalcs_audit_reader_repeats(const struct dalcs_radau_part *part,
                                              const struct audit_members *m) {
    const struct dalcs_osnsp *osnsp = &part->component->osnsp;
    const struct dalcs_part_segment *s = &part->segment;
    bool is_same = m->map != NULL && dalcs_audit_entry_of(s) == m->map && s->h == m->last.step &&
                   s->end == m->last.end && !s->by_euler && !part->component->positions.joined;
    for (int k = 0; is_same && k < osnsp->n_words; k++) {
        is_same = osnsp->mode[k] == m->last.mode[k];
    }
    return is_same && (s->late != NULL || dalcs_audit_begins_with_input(part));
}

/* The present segment of a part ends: its end can be read until the next one has. */
void dalcs_audit_reader_keep(const struct dalcs_audit_run *a, int index);

#endif

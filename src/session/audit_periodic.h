/* audit_periodic.h - frequencies of .ac around a periodic orbit, under the laws of the elements (response.h).
 *
 * What small signals make of the orbit is looked at in each piece of a period at one time that is drawn, at all its events, and
 * from its end to its beginning; what is written of a frequency, as integrals over these pieces. */
#ifndef DALCS_AUDIT_PERIODIC_H
#define DALCS_AUDIT_PERIODIC_H

#include "audit_response.h"
#include "periodic_response.h"

/* One side of what happens in no time: the orbit, and small signals over exp(j w t). */
struct dalcs_periodic_side {
    struct dalcs_response_values is, at;
    const struct dalcs_orbit_segment *segment; /* of the orbit; NULL: at is not there */
    double *y;                                 /* [columns] of the orbit */
};

/* A weighted sum of columns jumps where a piece ends, and what of. */
struct dalcs_periodic_jump {
    double value, size;
};

/* The integral over a piece of this map, of the weighted sum of columns, by what the piece begins with. */
struct dalcs_mean {
    UT_hash_handle hh;
    const struct dalcs_flow_map *map;
    long look;             /* of which it is */
    double complex *value; /* [flow->n_columns + 1] the last of sources at the phase 0 */
};

struct dalcs_audit_periodic {
    struct dalcs_run *run;
    const struct dalcs_orbit_log *log;
    const struct dalcs_readout *readout; /* NULL: nothing is asked */
    struct dalcs_response_audit laws;
    struct dalcs_audit_response rows; /* what is written */

    struct { /* [n_devices] */
        bool *are_there, *are_restless;
        signed char *change;
        int *state; /* the column of a capacitor; -1: it is none */
        int n_fed,
            *fed; /* [n_fed] sources that decide voltages that other parts have, in this order */
    } of;

    double complex *source; /* [n_stimuli] */
    struct dalcs_stimulus_term *term;

    struct dalcs_periodic_look { /* at one frequency of one part */
        int part;
        long number; /* of looks */
        const struct dalcs_periodic_response *response;
        double w, other;                     /* rad/s, of the sources, and of what is written */
        long n;                              /* pieces so far */
        int event;                           /* the last piece */
        const struct dalcs_flow_piece *last; /* of which a->end is known; NULL: of none */
        enum dalcs_status status;
        double complex late; /* s, at the end of the last one */
        double complex mean; /* of a sum of columns with random weights, times the period */
        double size, doubt;  /* of what the mean adds up */
    } look;

    struct dalcs_mean *means; /* of maps, by the map */

    struct { /* [n_parts] */
        long looks;
        struct dalcs_periodic_jump *jump; /* [pieces] */
    } * seen;

    struct dalcs_periodic_side first, end,
        start; /* of the period; of the last piece; of the present one */

    struct {
        size_t n_columns;              /* the most of a part */
        double complex *column, *rate; /* [n_columns] values and derivatives */
        double complex *kept;          /* [rows that are kept] */
        double *weight;                /* [n_columns] random */
        bool *is_known;                /* [n_nodes] */
    } work;

    int n, next; /* frequencies; which is looked at next */
    uint64_t seed;
    struct dalcs_arena arena;
};

struct dalcs_audit_periodic_asked {
    struct dalcs_run *run;
    const struct dalcs_euler *euler;
    const struct dalcs_orbit_log *log; /* of a period, closed */
    double orbit_tolerance;            /* of the run that it is of */
    struct dalcs_response_columns *of; /* [n_systems] where answers are */
    int n;                             /* frequencies */
};

/* Nothing is asked with --audit off, and of a system file. */
bool dalcs_audit_periodic_is_asked(const struct dalcs_run *r);

/* Does nothing where nothing is asked, or where the log is not exact. */
enum dalcs_status
dalcs_audit_periodic_start(struct dalcs_audit_periodic *a,
                           const struct dalcs_audit_periodic_asked *asked) DALCS_MUST_CHECK;
void dalcs_audit_periodic_finish(struct dalcs_audit_periodic *a);

/* Is the k-th frequency looked at? */
bool dalcs_audit_periodic_asks(struct dalcs_audit_periodic *a, int k);

/* Before and behind the answer of a part. DALCS_REFUTED, with a message, where a law is broken. */
void dalcs_audit_periodic_begin(struct dalcs_audit_periodic *a, int part,
                                struct dalcs_periodic_response *response, double w, int sideband);
enum dalcs_status dalcs_audit_periodic_end(struct dalcs_audit_periodic *a,
                                           struct dalcs_periodic_response *response,
                                           double frequency) DALCS_MUST_CHECK;

/* What is written of a frequency that was looked at. */
enum dalcs_status dalcs_audit_periodic_row(struct dalcs_audit_periodic *a, double frequency,
                                           const double *row) DALCS_MUST_CHECK;

/* ---- audit_periodic_members.c -------------------------------------------------------------------- */

/* Who is in the part of the look. */
void dalcs_periodic_values_choose(struct dalcs_audit_periodic *a);

/* ---- audit_periodic_values.c --------------------------------------------------------------------- */

enum dalcs_status dalcs_periodic_values_make(struct dalcs_audit_periodic *a) DALCS_MUST_CHECK;

/* to->at, to->y and to->segment: the orbit at a time. */
void dalcs_periodic_values_orbit(struct dalcs_audit_periodic *a, double t, enum dalcs_side side,
                                 struct dalcs_periodic_side *to);

/* Small signals over exp(j w t) at a node of a piece; has_rates: with their derivatives. */
void dalcs_periodic_values_small(struct dalcs_audit_periodic *a,
                                 const struct dalcs_piece_passed *passed, int node, bool has_rates,
                                 struct dalcs_response_values *is);

/* In the place of an open pair's current is its w. */
bool dalcs_periodic_values_is_open(const struct dalcs_periodic_flow *flow,
                                   const struct dalcs_flow_map *map, int column);

/* ---- audit_periodic_means.c ---------------------------------------------------------------------- */

/* To a->look.mean: the integral over a piece, and the impulse of what jumps at an event that is late. */
enum dalcs_status
dalcs_periodic_means_add_piece(struct dalcs_audit_periodic *a,
                               const struct dalcs_piece_passed *passed) DALCS_MUST_CHECK;
void dalcs_periodic_means_add_impulse(struct dalcs_audit_periodic *a, int event,
                                      double complex late, double t);

/* What jumps between a->end and what is behind it. */
void dalcs_periodic_means_note_jump(struct dalcs_audit_periodic *a,
                                    const struct dalcs_periodic_side *behind);

/* Is what is written of the frequency what they add up to? */
enum dalcs_status dalcs_periodic_means_check(struct dalcs_audit_periodic *a,
                                             double frequency) DALCS_MUST_CHECK;

#endif

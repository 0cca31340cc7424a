/* orbit_log.h - a period of a run as what small signals around it need: the modes that follow each other, and what the
 * events between them do to a perturbation.
 *
 * An event whose time moves by dt moves the states behind it by (f- - f+) dt, with the derivatives of the states on
 * both sides, and gives each signal that jumps there an impulse of (y- - y+) dt. That of the circuit's own, a guard's,
 * moves by dt = -dg / g'; a command's, where it comes along a ramp of sources, by the same of a small signal on these. */
#ifndef DALCS_ORBIT_LOG_H
#define DALCS_ORBIT_LOG_H

#include "orbit_gates.h"
#include "orbit_record.h"

#include <complex.h>

/* One mode, from one change of it to the next. */
struct dalcs_orbit_span {
    double from, to; /* s */
    uint64_t *mode;  /* [n_words] */
    uint64_t *
        jump; /* [n_words] of the impulses of a jump that it begins with; NULL: none, or the same */
    double *behind; /* [n_x] f+, where an event moves that jump; NULL: none does */
    int row;        /* of the guard in an answer that ends it; -1: none does */
    double rate;    /* of it, by time */
    double moved
        [2]; /* s, re and im: how a command that ends it moves with the small signals of its sources */
    double h;              /* s, of the step that it is, where there are smooth sources */
    double (*argument)[2]; /* [n_nodes][n_smooth] what they read at its nodes */
    double *df;            /* [n_x] f- - f+; NULL: nothing moves where it ends */
    double *dy;            /* [n_columns] y- - y+ */
    const uint64_t *
        resting; /* [n_words] diodes with neither lambda nor w, all the time (orbit_rest.h); NULL: none */
    struct dalcs_orbit_instant *gates; /* NULL: they do nothing where it ends */
};

/* Part of a span, in which no source has an edge. */
struct dalcs_orbit_stretch {
    double from, to; /* s */
    const uint64_t *mode;
    long n;            /* segments */
    double *largest;   /* [n_pairs] V or A: lambda or w of diodes */
    double *moved;     /* [n_pairs] Vs or C: at most the same over the time */
    uint64_t *resting; /* as of a span */
};

/* A diode that comes near to 0 and stays on its side, or goes to the other one just before a command (orbit_near.h). */
struct dalcs_orbit_low {
    int pair;
    bool on;
    bool is_first; /* since it has this side */
    double t;      /* s */
    double value;  /* V or A: w or lambda there */
    double
        gap; /* s: it goes to its other side, but this little before a command acts on it; else 0 */
    double above
        [2]; /* the largest of it since the low before, or since it has this side; and until the next */
};

struct dalcs_orbit_part {
    struct dalcs_orbit_log *log;
    struct dalcs_orbit_rates rates;
    int n;
    size_t capacity;
    struct dalcs_orbit_span *span; /* [n] */
    bool pending;                  /* what lies behind the last one is not known yet */

    struct dalcs_orbit_rest {
        int n;
        size_t capacity;
        struct dalcs_orbit_stretch *stretch; /* [n] */
        double *now;                         /* [n_pairs] work */
        bool is_over;                        /* the last one */
        bool any;                            /* of them has a diode that rests */
    } rest;

    struct dalcs_orbit_near {
        int n;
        size_t capacity;
        struct dalcs_orbit_low *low;  /* [n] */
        struct dalcs_near_pair *pair; /* [n_pairs] work */
        uint64_t *mode, *first;       /* [n_words] of the last segment, and of the first one */
        bool has_crossed;             /* any, at the end of the last segment */
    } near;

    struct dalcs_orbit_record record; /* for the audit; empty if none is asked for */

    bool jumped;         /* behind the last one, in jump_mode */
    uint64_t *jump_mode; /* [n_words] */
    double *f, *y;       /* [n_x], [n_columns] where the period begins; y NULL: nothing was told */
    double *work_f, *work_y;
};

struct dalcs_orbit_log {
    struct dalcs_radau *radau;
    enum dalcs_status status; /* of what could not be told while the run went on */
    bool
        is_exact; /* no step of implicit Euler, no event that only touches, no two commands that move apart */
    bool is_recorded; /* segments are kept */
    int n_parts;
    struct dalcs_orbit_part *part; /* [n_parts] */

    struct dalcs_orbit_sources { /* what their small signals are, by stimulus */
        const void *user;
        double complex (*of)(const void *user, int stimulus);
    } sources;

    struct dalcs_orbit_gates *gates; /* of the one part; NULL: there are none */
    struct dalcs_arena arena;
};

enum dalcs_status dalcs_orbit_log_setup(struct dalcs_orbit_log *log, struct dalcs_radau *radau,
                                        const struct dalcs_orbit_sources *sources) DALCS_MUST_CHECK;
void dalcs_orbit_log_finish(struct dalcs_orbit_log *log);

/* Before the run starts: what its gates do, if there are any. */
enum dalcs_status dalcs_orbit_log_watch(struct dalcs_orbit_log *log, struct dalcs_logic_run *logic,
                                        const struct dalcs_logic_memory *memory) DALCS_MUST_CHECK;

/* For radau->base->listener.observer. */
struct dalcs_observer dalcs_orbit_log_observer(struct dalcs_orbit_log *log);

/* After the run of a period of length T: what happens at its end. */
enum dalcs_status dalcs_orbit_log_close(struct dalcs_orbit_log *log, double T) DALCS_MUST_CHECK;

#endif

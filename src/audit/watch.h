/* watch.h - how all stretches of a part are looked at by screens (screen.h). */
#ifndef DALCS_AUDIT_WATCH_H
#define DALCS_AUDIT_WATCH_H

#include "audit_internal.h"

/* Nodes of a step, at most. */
enum { AUDIT_MOST_NODES = 12 };

/* Instructions of a screen, about, of what is handed over and asked; together with others fewer. */
#define AUDIT_SCREEN_WORK 600.0

/* Times in a step that it is asked at, one of them each time. */
enum { AUDIT_SCREEN_TIMES = 4 };

/* Screens and images that are at hand: a converter has a few modes and lengths of steps in turn. */
enum { AUDIT_LOG2_LANES = 6 };

struct audit_watch {
    struct audit_screens {
        int n, log2_slots;
        struct audit_screen **slot;  /* [2^log2_slots] by key; NULL: none */
        struct audit_screen *latest; /* that was found; NULL: none */
        size_t numbers;              /* in all of them */
    } screens;

    struct audit_sums_of_laws {
        struct dalcs_audit_row row[5]; /* by audit_screen_row, and a sign */
        double *node_weight;           /* [2][n_nodes] of Kirchhoff's laws now and over time */
        double *sign, *guard;          /* constants */
        int n_signs, n_guards;
        size_t sign_room, guard_room;

        struct audit_list {
            struct audit_term *term;
            int n;
            size_t room;
        } list[5]; /* by audit_term_kind */

        bool complete; /* there was room for all */
    } fill;            /* while a screen is made */

    struct audit_all_pieces {       /* what screens are sums of (screen_pieces.c) */
        struct audit_pieces *first; /* NULL: none are made */
        int n;
        struct audit_piece **used; /* work: of the present mode */
        double *is_read;           /* [n_columns] likewise */
    } pieces;

    double
        *state_factor; /* [n_devices of the part] of a state, in their sum; NULL: not drawn yet */

    struct audit_times { /* that a step is asked at, one in each fourth, and weights of its nodes */
        double barycentric[AUDIT_MOST_NODES];
        double theta[AUDIT_SCREEN_TIMES];    /* in steps */
        bool is_weighed[AUDIT_SCREEN_TIMES]; /* their weights are there: of values and integrals */
        double now[AUDIT_SCREEN_TIMES][AUDIT_MOST_NODES];
        double flow[AUDIT_SCREEN_TIMES][AUDIT_MOST_NODES];
    } times;

    struct audit_image *image; /* that the present one was asked by; NULL: by its values, or not */
    int drawn; /* of the times, that the present one is asked at; < 0: none is drawn yet */

    struct audit_lane { /* of steps of a mode and a length (lane.c) */
        uint64_t key;
        double step;                 /* s */
        struct audit_screen *screen; /* NULL: none */
        struct audit_image *image; /* of that screen; of such steps while its own step is theirs */
    } lane[1 << AUDIT_LOG2_LANES];

    struct audit_batch { /* of stretches that repeat one another (batch.c) */
        struct dalcs_audit_batch gathered;
        struct audit_screen *screen;    /* that asks them */
        struct audit_image *image;      /* that passed the stretch before over; NULL: none */
        int n_times;                    /* of the watch's times, those before its end */
        int n_columns, n_nodes, stride; /* of polynomials, columns in whole quads */
        const double *place;            /* of the image at the time that was drawn */
        double past;                    /* s: that time */
        double end;                     /* of the stretch before, in steps */
        int node;                       /* where values beside it are */
        double length, near;            /* s */
        size_t room;
        bool is_busy; /* some are looked at once more */
    } batch;

    double *column; /* [2][n_columns in whole quads] work */
    double *place;  /* work */
    size_t place_room;

    struct audit_stretch_before {
        double states; /* the sum of states where it ended */
        bool knows_states;
        uint64_t key;     /* 0: it had none */
        bool knows_sides; /* that switches with hysteresis had in it */
    } before;

    bool is_put_off;    /* the present one does not begin there */
    bool saw_beginning; /* its beginning was looked at */
    bool makes;         /* a screen is to be made of the present stretch */
    bool has_turned;    /* a switch with hysteresis is on the other side now */
    double asked;       /* s: a time in it that asks for a look; < 0: none does */
    bool has_jumped; /* ... where all laws hold, but not all states are what they were before it */
};

enum dalcs_status audit_make_parts(struct dalcs_audit *audit);

/* A current that a formula reads is an unknown, with Kirchhoff's law at both ends, also that of a short. */
void audit_merge_shorts(struct dalcs_audit *audit);

/* ... the resistors whose current is one of the state. */
void audit_find_told(struct dalcs_audit *audit);

#endif

/* screen.h - all linear laws of a mode as one number, and each sign: a look at every stretch that costs little.
 *
 * Whether A y = b is asked by one random row: r A y = r b (R. Freivalds, Probabilistic machines can use less running
 * time, IFIP 1977). The laws of a mode, Kirchhoff's, of branches, and of charges and fluxes from the start of the stretch
 * to a time in it, are added up, each divided by what is allowed of it and times a random factor between 1/2 and 1 with
 * a random sign. So no wrong column can cancel but by chance, of measure 0, and the sum is above 1 where a law is broken
 * by several times what is allowed. It is the same sum for all stretches of a mode, made once; of a stretch that is a
 * linear image of few numbers, its state above all, it is a product with these.
 *
 * Which side a diode is on is taken from a state that was looked at. The law of that side and its sign, together, are the
 * diode's, so a wrong guess can only ask for a look that was not needed. */
#ifndef DALCS_AUDIT_SCREEN_H
#define DALCS_AUDIT_SCREEN_H

#include "audit_internal.h"

/* Rows over the columns: at one time; at the start, which is subtracted; to be integrated; states, of which none jumps. */
enum audit_screen_row {
    AUDIT_ROW_NOW,
    AUDIT_ROW_START,
    AUDIT_ROW_FLOW,
    AUDIT_ROW_STATES,
    AUDIT_N_ROWS
};

/* Places of what the rows give: the sum of laws, states at the start and the end, then each sign at three times. */
enum audit_screen_place {
    AUDIT_PLACE_LAWS,
    AUDIT_PLACE_START,
    AUDIT_PLACE_END,
    AUDIT_PLACE_NODE, /* the sum of laws at a node, which is to be that of its values */
    AUDIT_PLACE_SIGNS
};

enum { AUDIT_SIGN_TIMES = 3 }; /* in the stretch, at its start and at its end */

struct audit_term {
    int index;
    double factor;
};

/* constant + terms >= -1. */
struct audit_sign {
    double constant;
    int first, n;  /* of columns */
    int n_stimuli; /* after these */
};

struct audit_screen {
    uint64_t key;
    bool is_made;
    double limit;           /* that a sum or a sign may be beyond */
    int alarms;             /* that were false */
    long rests;             /* stretches that it is not asked of after one */
    double *row;            /* [AUDIT_N_ROWS][n_columns in whole quads] */
    double constant, rate;  /* of the laws; 1/s, of what is integrated */
    int n_stimuli, n_flows; /* that stand in the laws, in what is integrated */
    int n_signs;
    struct audit_sign *sign;
    int first, n_terms; /* first: of those of the laws */
    size_t term_room, sign_room, row_room, image_room;
    struct audit_term *term;      /* [n_terms] of signs, then stimuli and flows of the laws */
    double step, end;             /* s, in steps: of the stretch that was asked last */
    int n_inputs;                 /* of the image; 0: there is none */
    double image_step, image_end; /* of the stretches whose image it is */
    int n_times;                  /* of the watch's, that are in these */
    int n_places;                 /* in whole quads */
    double *image;                /* [AUDIT_SCREEN_TIMES][n_inputs][n_places] */
};

/* The screen of these polynomials; NULL: there is none yet. */
struct audit_screen *audit_screen_of(const struct audit_part *part,
                                     const struct dalcs_audit_polynomials *p);

/* Makes it, from a state of the stretch that was looked at; NULL: no room. */
struct audit_screen *audit_screen_make(struct dalcs_audit *audit, struct audit_part *part,
                                       const struct dalcs_audit_polynomials *p,
                                       const struct dalcs_audit_state *s);

/* States are held to the scales of now, where these have grown much: then no screen is left. */
void audit_screen_rescale(const struct dalcs_audit *audit, struct audit_part *part);

void audit_screen_finish(struct audit_part *part);

/* watch.c: a stretch is complete; is it to be looked at? can_look: times in it can be told apart. */
bool audit_watch_asks(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch,
                      bool can_look);

/* It was, and audit->now is a state in it. */
void audit_watch_learn(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch);

/* screen_rows.c: the laws and signs of a mode, into the rows and lists of a screen. */
bool audit_screen_fill(struct dalcs_audit *audit, struct audit_part *part,
                       struct audit_screen *screen, double step, const struct dalcs_audit_state *s);

/* The sums so far become rows of n columns of a screen with room for them. */
void audit_screen_put_rows(struct audit_watch *watch, struct audit_screen *screen, int n);

/* A random factor and sign, for a sum. */
double audit_screen_weight(struct dalcs_audit *audit);

struct audit_answer {
    double worst;      /* how far beyond what is allowed the worst is, 1 where it just is not */
    double t;          /* s, of a time that was asked at */
    double start, end; /* sums of states */
};

/* screen_sum.c */
void audit_screen_ask(struct dalcs_audit *audit, const struct audit_part *part,
                      const struct audit_screen *screen, const struct dalcs_audit_polynomials *p,
                      const struct dalcs_audit_stretch *stretch, struct audit_answer *answer);

/* Ends of stretches are a rounding of t apart, which is as much more in steps as these are shorter than t. */
static inline bool audit_is_same_end(double a, double b) {
    return fabs(a - b) <= 0x1p-32;
}

/* Will the image do? Of steps whose values are there, one of these is held to it, too. */
static inline bool audit_screen_has_image(const struct audit_screen *screen,
                                          const struct dalcs_audit_polynomials *p) {
    return screen->n_inputs > 0 && p->n_inputs == screen->n_inputs &&
           p->step == screen->image_step && audit_is_same_end(p->end, screen->image_end);
}

/* A step as long as the one before: an image is worth it. */
void audit_screen_see_step(const struct dalcs_audit *audit, const struct audit_part *part,
                           struct audit_screen *screen, const struct dalcs_audit_polynomials *p);

/* The times that stretches are asked at. */
void audit_screen_draw_times(struct dalcs_audit *audit, struct audit_watch *watch,
                             const struct dalcs_audit_polynomials *p);

/* The images of a screen, whose rows are there. */
void audit_screen_compose(const struct dalcs_audit *audit, const struct audit_part *part,
                          struct audit_screen *screen, const struct dalcs_audit_polynomials *p);

#endif

/* screen.h - all linear laws of a mode as one number, and each sign: a look at every stretch that costs little.
 *
 * Whether A y = b is asked by one random row: r A y = r b (R. Freivalds, Probabilistic machines can use less running
 * time, IFIP 1977). The laws of a mode, Kirchhoff's, of branches, and of charges and fluxes from the start of the stretch
 * to a time in it, are added up, each divided by what is allowed of it and times a random factor between 1/2 and 1 with
 * a random sign. So no wrong column can cancel but by chance, of measure 0, and the sum is above 1 where a law is broken
 * by several times what is allowed. It is the same sum for all stretches of a mode, made once; of a stretch that is a
 * linear image of few numbers, its state above all, it is a product with these.
 *
 * Which side a diode is on is taken from the run. The law of that side and its sign, together, are the diode's, so a wrong
 * guess can only ask for a look that was not needed. */
#ifndef DALCS_AUDIT_SCREEN_H
#define DALCS_AUDIT_SCREEN_H

#include "watch.h"

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

/* `factor` times a column goes to a place, and at its other two times to the next ones; likewise a stimulus. */
struct audit_term {
    int place, index;
    double factor;
};

/* What the terms of a screen are of: columns in signs; stimuli in signs that read columns, too, and in guards, which read
 * none, with the number of the guard for a place; in laws at one time, and in what is integrated. */
enum audit_term_kind {
    AUDIT_TERM_COLUMN,
    AUDIT_TERM_SIGN,
    AUDIT_TERM_GUARD,
    AUDIT_TERM_LAW,
    AUDIT_TERM_FLOW,
    AUDIT_N_TERM_KINDS
};

/* What the rows make of steps of one length, by what these are a linear image of. Signs change by no more than the inputs do
 * times what they reach: near an input at which they were asked they need not be asked again. What is at the end of a
 * stretch is a polynomial in that time: of its values at the nodes. */
struct audit_image {
    double step;  /* s */
    double end;   /* of the stretch that was asked last, in steps */
    long n_asked; /* by their values */
    double *
        at_node; /* [n_inputs][n_nodes][n_ends] of states and signs where they may end; NULL: not made yet */
    int n_ends; /* in whole quads */

    struct audit_image_at { /* a time */
        double *place;      /* [n_inputs][n_places]; NULL: not made yet */
        double *reach;      /* [n_inputs] most that one of the signs changes by */
        double *input;      /* [n_inputs] at which signs were asked */
        double slack;       /* that the least of them had there, above -1 */
        double end;         /* in steps, of stretches with these states and signs at their ends */
    } at[AUDIT_SCREEN_TIMES];
};

/* Numbers that the screens of a part may have in all: 8 MB of them. */
enum { AUDIT_MOST_NUMBERS = 1 << 20 };

/* Commands cut the steps of a mode to a few lengths. */
enum { AUDIT_IMAGES = 4 };

/* Between edges of sources that command switches: a mode comes back in a few places of their period. */
enum { AUDIT_WINDOWS = 4 };

struct audit_window {
    double from, to; /* s: no guard is below 0 in between; from is INFINITY: there is none */
    double period;   /* s: nor so much later; 0: that is not known */
};

/* Sines in a sum, of a few frequencies. */
enum { AUDIT_MOST_WAVES = 4 };

struct audit_waves {
    int n;
    double offset;

    struct audit_wave {
        double frequency, origin; /* Hz, s */
        double sine, cosine;      /* at the origin, and a fourth of a period later */
        double amplitude, phase;  /* phase: in cycles, at the origin */
    } wave[AUDIT_MOST_WAVES];
};

struct audit_screen {
    uint64_t key;
    int class;     /* of the length, screen.c */
    double length; /* s, of the step that it was made of */
    bool is_made;
    double limit;  /* that a sum or a sign may be beyond */
    int alarms;    /* that were false */
    double jumped; /* the largest jump of states that led into it, of those that were looked at */
    long rests;    /* stretches that it is not asked of after one */
    double *row;   /* [AUDIT_N_ROWS][n_columns in whole quads], constants behind them */
    double *constant; /* [n_places], and of guards */
    double rate;      /* 1/s, of what is integrated */
    int n_places;     /* in whole quads */
    int n_guards;
    struct audit_window window[AUDIT_WINDOWS];
    int window_at; /* the one that was found last */
    int n_terms[AUDIT_N_TERM_KINDS];
    struct audit_term *term[AUDIT_N_TERM_KINDS]; /* one behind the other */
    struct audit_waves waves;                    /* of sines that go on, in the sum of laws */
    struct audit_course course;                  /* of what other sources add to it */

    struct {
        double step, end; /* of the stretch before that had no image */
        int at;           /* the one that was of use last */
        struct audit_image of[AUDIT_IMAGES];
    } images;
};

/* The screen of these polynomials; NULL: there is none yet. */
struct audit_screen *audit_screen_of(const struct audit_part *part,
                                     const struct dalcs_audit_polynomials *p);

/* Makes it, from a state of the stretch that was looked at, or NULL: that at a time t is read where it takes one. NULL: no
 * room. */
struct audit_screen *audit_screen_make(struct dalcs_audit *audit, struct audit_part *part,
                                       const struct dalcs_audit_polynomials *p,
                                       const struct dalcs_audit_state *s, double t);

/* What screens are sums of is made again. */
void audit_pieces_forget(struct audit_watch *watch);

/* States are held to the scales of now, where these have grown: then no screen is left. */
void audit_screen_rescale(struct dalcs_audit *audit, struct audit_part *part);

void audit_screen_finish(struct audit_part *part);

/* watch.c: a stretch is complete; is it to be looked at? Where times in it cannot be told apart, its states alone are asked. */
bool audit_watch_asks(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch);

/* Its mode is new: a screen is made. Is it to be looked at? */
bool audit_watch_begins(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch);

/* It was looked at since it was asked for, and audit->now is a state in it. */
void audit_watch_learn(struct dalcs_audit *audit, const struct dalcs_audit_stretch *stretch);

/* A random factor and sign, for a sum. */
double audit_screen_weight(struct dalcs_audit *audit);

/* courses.c: what sources add to its sum of laws where the course of that is not known. */
double audit_laws_begin(struct dalcs_audit *audit, struct audit_screen *screen, double t);

double audit_waves_value(const struct audit_waves *all, double t);

static inline bool audit_laws_have_stimuli(const struct audit_screen *screen) {
    return screen->n_terms[AUDIT_TERM_LAW] > 0 || screen->waves.n > 0;
}

static inline double audit_laws_stimuli(struct dalcs_audit *audit, struct audit_screen *screen,
                                        double t) {
    const struct audit_course *c = &screen->course;
    double sum = 0.0;
    if (screen->n_terms[AUDIT_TERM_LAW] > 0) {
        sum = c->from <= t && t <= c->to ? audit_course_value(c, t)
                                         : audit_laws_begin(audit, screen, t);
    }
    return screen->waves.n > 0 ? sum + audit_waves_value(&screen->waves, t) : sum;
}

struct audit_question {
    const struct dalcs_audit_stretch *stretch;
    double near;               /* s, from its ends, where sources have no edge */
    int m;                     /* of the watch's times */
    struct audit_image *image; /* NULL: values are asked */
};

struct audit_answer {
    double worst;      /* how far beyond what is allowed the worst is, 1 where it just is not */
    double t;          /* s, of a time that was asked at */
    double start, end; /* sums of states */
};

/* screen_sum.c */
void audit_screen_ask(struct dalcs_audit *audit, const struct audit_watch *watch,
                      struct audit_screen *screen, const struct audit_question *q,
                      struct audit_answer *answer);

/* lane.c: where screens and images of such steps are at hand. */
struct audit_lane *audit_lane_of(struct audit_watch *watch,
                                 const struct dalcs_audit_polynomials *p);

/* Is the stretch asked by what is at hand, and all holds? */
bool audit_lane_passes(struct dalcs_audit *audit, const struct audit_part *part,
                       const struct dalcs_audit_stretch *stretch);

/* screen_sum.c: into watch->place what an image makes of its input at the m-th time; the least sign. *off: how far values at
 * a node, where there are any, are from the image. */
double audit_screen_by_image(const struct audit_watch *watch, const struct audit_screen *screen,
                             const struct dalcs_audit_polynomials *p, int m,
                             struct audit_image *image, double *off);

/* batch.c: the stretch has been passed over; so may be those that repeat it. */
void audit_batch_from(struct dalcs_audit *audit, struct audit_part *part,
                      const struct dalcs_audit_stretch *stretch);

/* A node beside each of the times, as they are drawn at the same chance. */
static inline int audit_node_at(int n_nodes, int m) {
    return 1 + m * (n_nodes - 1) / AUDIT_SCREEN_TIMES;
}

/* What the rows make of n_nodes values of each column, without constants and stimuli, at the m-th time. */
void audit_screen_place(const struct audit_watch *watch, const struct audit_screen *screen,
                        const struct dalcs_audit_polynomials *p, int m, const double *value,
                        double *place);

/* ... and of what may be at their ends, n_ends numbers for each node. */
void audit_screen_ends(const struct audit_screen *screen, const struct dalcs_audit_polynomials *p,
                       const double *value, int n_ends, double *at_node);

/* w[n_nodes] of values at the nodes in one at a time, in steps. */
void audit_screen_weights(const struct audit_watch *watch, const struct dalcs_audit_polynomials *p,
                          double theta, double *w);

/* The weights of the m-th of the times that stretches are asked at. */
void audit_screen_weigh(struct audit_watch *watch, const struct dalcs_audit_polynomials *p, int m);

/* Of these times, those before an end, in steps. */
static inline int audit_n_times_before(const struct audit_watch *watch, double end) {
    int n = 0;
    while (n < AUDIT_SCREEN_TIMES && watch->times.theta[n] <= end) {
        n++;
    }
    return n;
}

/* The one of them that the present stretch is asked at; 0 where there are none. */
static inline int audit_watch_draw(struct dalcs_audit *audit, struct audit_watch *watch,
                                   const struct dalcs_audit_polynomials *p) {
    if (watch->drawn < 0) {
        const int n = p->end >= 1.0 ? AUDIT_SCREEN_TIMES : audit_n_times_before(watch, p->end);
        watch->drawn = (int)(n * audit_draw(audit));
    }
    return watch->drawn;
}

/* How much later than in the window two times are that it has, s; no number: it has them not. */
static inline double audit_window_past(const struct audit_window *w, double from, double to) {
    const double past =
        w->period > 0.0 && from >= w->from ? floor((from - w->from) / w->period) * w->period : 0.0;
    return w->from + past <= from && to <= w->to + past ? past : NAN;
}

/* Is it known that no guard is below 0 between two times? Then screen->window_at is where. */
static inline bool audit_is_guarded(struct audit_screen *screen, double from, double to) {
    bool is = false;
    for (int k = 0; k < AUDIT_WINDOWS && !is; k++) {
        const int at = (screen->window_at + k) % AUDIT_WINDOWS;
        is = !isnan(audit_window_past(&screen->window[at], from, to));
        screen->window_at = is ? at : screen->window_at;
    }
    return is;
}

/* guards.c: how far below 0 the worst guard is at three times. */
double audit_worst_guard_between(struct dalcs_audit *audit, struct audit_screen *screen,
                                 double from, double to, double t);

static inline double audit_worst_guard(struct dalcs_audit *audit, struct audit_screen *screen,
                                       const struct audit_question *q, double t) {
    const double from = q->stretch->from + q->near;
    const double to = q->stretch->to - q->near;
    return audit_is_guarded(screen, from, to)
               ? 0.0
               : audit_worst_guard_between(audit, screen, from, to, t);
}

/* Ends of stretches are a rounding of t apart, which is as much more in steps as these are shorter than t. */
static inline bool audit_is_same_end(double a, double b) {
    return fabs(a - b) <= 0x1p-32;
}

/* images.c: the image of such steps, which is made at the m-th time; NULL: there is none, or none yet. */
struct audit_image *audit_image_of(const struct dalcs_audit *audit, const struct audit_part *part,
                                   struct audit_screen *screen,
                                   const struct dalcs_audit_polynomials *p, int m);

/* Likewise where it is that of the stretch asked last, with that end. */
static inline struct audit_image *
audit_image_again(struct audit_screen *screen, const struct dalcs_audit_polynomials *p, int m) {
    struct audit_image *image = &screen->images.of[screen->images.at];
    return image->step == p->step && image->at[m].place != NULL && p->input != NULL &&
                   audit_is_same_end(image->end, p->end) &&
                   audit_is_same_end(image->at[m].end, p->end)
               ? image
               : NULL;
}

/* The rows of the screen are new. */
void audit_images_forget(struct audit_screen *screen);

#endif

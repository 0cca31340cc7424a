/* periodic_flow.h - one part of a circuit around its periodic orbit, as what takes a small perturbation through a period.
 *
 * In a mode a perturbation obeys the stage equations that the states obey (stages.h), driven by the small signals of
 * sources instead of the sources themselves. A span of one mode is cut into pieces that are short enough for the
 * polynomials of a step to carry what starts from any state at the beginning of the period, and the answer to the
 * fastest of the signals: their last Legendre coefficients tell. So a small signal of any lower frequency goes through
 * a piece as one real map of the states and of the s + 1 Legendre polynomials of the sources. */
#ifndef DALCS_PERIODIC_FLOW_H
#define DALCS_PERIODIC_FLOW_H

#include "orbit_log.h"

#include <complex.h>

#define HASH_NONFATAL_OOM 1
#include <uthash.h>

struct dalcs_flow_smooth;

/* A step of length h in one mode; where there are smooth sources, from one time on. Of its answers it has the rows that
 * something reads, node after node. */
struct dalcs_flow_map {
    UT_hash_handle hh;
    double key[2]; /* h, and where there are smooth sources the time at which it begins */
    struct dalcs_flow_map *alike; /* another one of this key, in another mode */
    const uint64_t *mode;         /* NULL: not filled */
    double h;
    double *state; /* [n_columns][size] of unit states, and of outputs of gates off by 1 V */
    double *drive; /* [n_turns][n_nodes][size] of the sources along a Legendre polynomial each */
    /* [n_columns + 1], the last of the sources: what rounding leaves in the states, in the units of energies, as the
     * equations tell; and through their derivatives, of the sources and outputs of gates */
    double *noise, *rounding;
    /* at one frequency, periodic_response.c: */
    long stamp;
    double complex *driven; /* [size] by the sources as they go, from 0 */
    double complex *mean;   /* [n_columns + 1][n_read] */
};

/* dalcs_periodic_flow_drive's. */
enum { DALCS_MOST_DRIVES = 2 * DALCS_MAX_NODES };

/* What a new mode makes of states as it begins: x+ = P x- + by_source. */
struct dalcs_flow_start {
    const uint64_t *mode;
    double *P;                 /* [n_columns][n_x] column after column */
    double complex *by_source; /* [n_x] */
    bool changes_nothing;
    struct dalcs_flow_start *next;
};

struct dalcs_flow_piece {
    struct dalcs_flow_map *map;
    double t;                             /* s, where it begins */
    const struct dalcs_flow_start *jump;  /* with that of these impulses; NULL: none, or the same */
    const double *behind;                 /* [n_x] as of the span */
    const struct dalcs_flow_start *start; /* NULL: the mode was there before */
    const uint64_t *resting;              /* [n_words] as of the span */
    const struct dalcs_orbit_span
        *end; /* that ends with it, and something moves there; else NULL */
};

struct dalcs_periodic_flow_asked {
    const double complex *source;           /* [n_inputs] of the small signals */
    bool is_still;                          /* they are not those of the log: no command moves */
    const bool *is_read;                    /* [n_columns] what of the circuit is asked for */
    bool keeps_all;                         /* and of maps all of it, for the audit */
    double fastest;                         /* rad/s, of them */
    double period;                          /* s */
    enum dalcs_status (*go_on)(void *user); /* asked for each span of a mode; else its status */
    void *user;
};

struct dalcs_periodic_flow {
    const struct dalcs_orbit_part *orbit;
    const struct dalcs_system *system;
    struct dalcs_periodic_flow_asked asked;
    double fastest;     /* rad/s */
    double period;      /* s */
    int n_x, n_columns; /* states; and outputs of gates behind them */
    const double *unit; /* [n_x] */
    double legendre[DALCS_MAX_NODES][DALCS_MAX_NODES]; /* coefficient k of the values at nodes */
    struct dalcs_excitation excitation;
    struct dalcs_stages stages;

    struct {                    /* by small signals */
        double complex *source; /* [n_inputs] AC values */
        int n_turns;            /* 1 if all of them have one phase, turn[0]; else turn is 1 and j */
        double complex turn[2];
        int n;    /* their excitation functions */
        int *pin; /* [n_columns - n_x] that of each output behind them; -1: none */
    } drive;

    struct dalcs_flow_smooth *smooth; /* NULL: no smooth sources */

    struct {                 /* rows of answers, states first */
        int n, *row, *place; /* [n]; where a row is, or -1 */
        int n_asked;         /* those behind are for the audit alone */
    } kept;

    struct {
        struct dalcs_flow_map *map;     /* those of pieces, by key */
        struct dalcs_flow_map *spare;   /* the last one of no piece; NULL: none */
        struct dalcs_flow_start *start; /* likewise */
    } made;

    struct {
        int n;
        size_t capacity;
        struct dalcs_flow_piece *piece; /* [n] */
    } pieces;

    double *M;    /* [n_x][n_x] of the period, column after column */
    double worst; /* last coefficients that were let through, over the size of what they are of */

    struct {
        double *in, *out, *rows;
    } work;

    struct dalcs_arena arena;
};

enum dalcs_status
dalcs_periodic_flow_setup(struct dalcs_periodic_flow *flow, const struct dalcs_orbit_part *orbit,
                          const struct dalcs_periodic_flow_asked *asked) DALCS_MUST_CHECK;
void dalcs_periodic_flow_finish(struct dalcs_periodic_flow *flow);

/* Which rows of answers are kept. */
enum dalcs_status dalcs_periodic_flow_rows(struct dalcs_periodic_flow *flow) DALCS_MUST_CHECK;

/* Elements of an answer that are kept: rows at the start, and at each stage, which with LOBATTO_IIIC are one more than nodes. */
static inline size_t dalcs_periodic_flow_size(const struct dalcs_periodic_flow *flow) {
    return (size_t)(flow->stages.method->n_stages + 1) * (size_t)flow->kept.n;
}

/* Where among them a row at a node is. */
static inline size_t dalcs_periodic_flow_at(const struct dalcs_periodic_flow *flow, int node,
                                            int row) {
    return (size_t)node * (size_t)flow->kept.n + (size_t)flow->kept.place[row];
}

/* The map of the span's mode and h, from t on, made now if it is new; valid until the next one is, unless a piece keeps
 * it. */
enum dalcs_status dalcs_periodic_flow_map(struct dalcs_periodic_flow *flow,
                                          const struct dalcs_orbit_span *span, double t, double h,
                                          struct dalcs_flow_map **map) DALCS_MUST_CHECK;

/* For a piece: the map stays. */
enum dalcs_status dalcs_periodic_flow_keep(struct dalcs_periodic_flow *flow,
                                           struct dalcs_flow_map *map) DALCS_MUST_CHECK;

/* s: how the command that ends a span moves with the small signals, at the phase 0. */
static inline double complex dalcs_periodic_flow_moved(const struct dalcs_periodic_flow *flow,
                                                       const struct dalcs_orbit_span *span) {
    return flow->asked.is_still ? 0.0 : span->moved[0] + I * span->moved[1];
}

/* How the mode of a span begins; NULL: with the states as they are. */
enum dalcs_status dalcs_periodic_flow_start(struct dalcs_periodic_flow *flow,
                                            const struct dalcs_orbit_span *span,
                                            const struct dalcs_flow_start **start) DALCS_MUST_CHECK;

/* flow->pieces.piece and flow->M. DALCS_NOT_CONVERGED: polynomials do not carry what starts in one of the modes. */
enum dalcs_status dalcs_periodic_pieces_make(struct dalcs_periodic_flow *flow) DALCS_MUST_CHECK;

/* coefficient[n_turns][n_nodes] of exp(j kappa theta), as the values at the nodes have them, times turn[]. */
void dalcs_periodic_flow_drive(const struct dalcs_periodic_flow *flow, double kappa,
                               double complex *coefficient);

#endif

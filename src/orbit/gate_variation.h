/* gate_variation.h - how a run with gates depends on what it starts from: what they add to V (variation.h).
 *
 * An instant at which gates decide comes dt late with the event that brings it about, of the circuit now or of gates a
 * delay before. The outputs that change then are late by as much, and so is what they do to the circuit; a sample takes
 * the change of what it reads and the slope of that times dt. A clock is never late. */
#ifndef DALCS_GATE_VARIATION_H
#define DALCS_GATE_VARIATION_H

#include "logic_watch.h"
#include "orbit_rates.h"

struct dalcs_gate_variation {
    const struct dalcs_logic_memory *memory;
    const struct dalcs_network *network;
    struct dalcs_radau_part *part; /* all of the circuit */
    struct dalcs_logic_run *logic;
    struct dalcs_logic_watch watch;
    int n_x, n_columns; /* states; these and numbers */
    int *function;      /* [n_pins] the place of its level in what a step takes; -1: none */
    double *pin;        /* [n_pins][n_columns] V, what outputs are off by */
    double *taken;      /* [n_taken][n_columns] V, of what samples read just before now */
    double *rate;       /* [n_taken] V/s, its slope */

    struct dalcs_gate_ends { /* of the run */
        bool begun;
        double *rate;         /* [n_taken] at the beginning */
        double *first, *last; /* [n_pins] V/s, slopes of outputs at both */
    } ends;

    double ended;      /* s, the last segment did */
    double resolution; /* s */
    size_t capacity;
    double **late;      /* by number: [n_columns] s, how late an instant is; NULL: it is not */
    double *due, *work; /* [n_columns] of the instant at hand */

    struct dalcs_gate_event { /* at the end of the last segment, of the variation */
        double *dt;           /* [n_columns] s */
        bool *pending, *is_exact;
        const struct dalcs_orbit_rates *rates;
    } event;

    struct dalcs_stimulus_term *term;
    struct dalcs_arena *arena;
};

static inline double *dalcs_gate_row(double *rows, const struct dalcs_gate_variation *g, int k) {
    return rows + (size_t)k * (size_t)g->n_columns;
}

/* Of the watch; user is the variation. */
enum dalcs_status
dalcs_gate_variation_seen(void *user, const struct dalcs_logic_instant *instant) DALCS_MUST_CHECK;

/* Columns are unit vectors of states and numbers. */
enum dalcs_status
dalcs_gate_variation_setup(struct dalcs_gate_variation *g, struct dalcs_arena *arena,
                           struct dalcs_radau *radau, struct dalcs_logic_run *logic,
                           const struct dalcs_logic_memory *memory) DALCS_MUST_CHECK;
void dalcs_gate_variation_finish(struct dalcs_gate_variation *g);

/* As a segment begins. Outputs that rest at a level are off by nothing. */
void dalcs_gate_variation_begin(struct dalcs_gate_variation *g);

/* What outputs do in a step, of one column. */
void dalcs_gate_variation_drive(const struct dalcs_gate_variation *g, int column, double *in);

/* Where the segment ends: of one column, whose answer is out; then of all. *moves: a command that comes then is late,
 * by g->event. */
void dalcs_gate_variation_read(struct dalcs_gate_variation *g, int column, const double *weight,
                               const double *out);
void dalcs_gate_variation_end(struct dalcs_gate_variation *g, bool *moves);

/* Rows of M, and of the derivatives by time at the beginning and the end. */
void dalcs_gate_variation_put(const struct dalcs_gate_variation *g, double *M, double *first,
                              double *last);

#endif

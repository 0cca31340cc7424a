/* freedom.h - what the elements of one component leave open at one instant. */
#ifndef DALCS_FREEDOM_H
#define DALCS_FREEDOM_H

#include "undetermined.h"

/* An element, or one of the two branches of a diode with breakdown, from first to second terminal. */
struct dalcs_freedom {
    const char *name;
    int device; /* -1: a voltage that .ic holds */
    int node[2];
    bool is_diode, is_coil;
    bool is_source; /* of current: it neither conducts nor blocks */

    enum dalcs_voltage_freedom {
        DALCS_VOLTAGE_FIXED, /* in all answers the same */
        DALCS_VOLTAGE_BELOW, /* v(first) - v(second) may rise by `slack`, and fall */
        DALCS_VOLTAGE_ANY
    } voltage;

    bool is_tied;   /* with DALCS_VOLTAGE_BELOW: and there is no current */
    double slack;   /* V */
    bool may_carry; /* more current than it does */
    double back;    /* A: how far that may fall; INFINITY: to any value */
};

/* One component at one instant. */
struct dalcs_view {
    struct dalcs_undetermined *u;
    const struct dalcs_open_instant *at;
    const struct dalcs_network *network;
    const struct dalcs_system *system;
    const double *y;   /* [n_columns] the answer */
    double largest[2]; /* V, A; of the answer, and so far */
    int n;
    struct dalcs_freedom *freedom; /* [n] */
    int n_vertices;
    int *node;                /* [n_vertices] of the circuit; ground first */
    int *link, *degree;       /* [n_vertices] work, 0 */
    struct dalcs_arena *work; /* until the analysis is done */
    bool has_told,
        has_narrow; /* a signal that may go somewhere; one that could, but not just now */
};

enum dalcs_status dalcs_view_setup(struct dalcs_view *view, struct dalcs_undetermined *u,
                                   const struct dalcs_open_instant *at,
                                   struct dalcs_arena *work) DALCS_MUST_CHECK;

/* Clears what it left in u's work arrays. */
void dalcs_view_finish(struct dalcs_view *view);

/* The device of the signal if it is a current of this component that was not reported yet, else -1. */
int dalcs_view_current_of(const struct dalcs_view *view, int output);

/* The present value of an output. */
double dalcs_view_value(const struct dalcs_view *view, int output);

/* Counts an element as part of what is found: the first diode, or else the first, is its place. */
void dalcs_view_place(const struct dalcs_freedom *freedom, struct dalcs_finding *finding);

/* Fills the bounds from how far a signal may fall and rise; a bound that only rounding tells from 0 is
 * 0. */
void dalcs_view_bound(const struct dalcs_view *view, bool is_current, double fall, double rise,
                      struct dalcs_open_signal *signal);

/* Is that interval more than rounding? */
bool dalcs_view_is_open(struct dalcs_view *view, bool is_current, double lower, double upper);

/* Sorts outputs by part[n_outputs] (-1: of none): signal[start[k]..start[k + 1] - 1] are those of part k,
 * with their present values. */
enum dalcs_status dalcs_view_sort_signals(struct dalcs_view *view, int n_parts, const int *part,
                                          int **start,
                                          struct dalcs_open_signal **signal) DALCS_MUST_CHECK;

/* Reports the finding, unless it has no signals. */
enum dalcs_status dalcs_view_tell(struct dalcs_view *view,
                                  struct dalcs_finding *finding) DALCS_MUST_CHECK;

/* ---- loops.c, islands.c ---------------------------------------------------------------------- */

enum dalcs_status dalcs_loops_find(struct dalcs_view *view) DALCS_MUST_CHECK;
enum dalcs_status dalcs_islands_find(struct dalcs_view *view) DALCS_MUST_CHECK;

/* ---- words.c --------------------------------------------------------------------------------- */

/* "d1 parallel to d2", "loop d1-d2-d3" for the branches part[n] of the view; NULL without memory. */
const char *dalcs_words_for_loop(const struct dalcs_view *view, int n, const int *part);

/* Are they all between the same two nodes? */
bool dalcs_view_are_parallel(const struct dalcs_view *view, int n, const int *part);

/* "stack d1-d2 blocks" where the elements border[n] are all that is between the nodes node[n_nodes] and
 * the rest; vertices of one island have the same number island_of, those of ground's 0. *brief: the same
 * in fewer words; unchanged where there are none. */
const char *dalcs_words_for_island(const struct dalcs_view *view, const int *island_of, int n_nodes,
                                   const int *node, int n, const int *border, const char **brief);

/* ---- coils.c --------------------------------------------------------------------------------- */

/* Why there may be no intervals, for a message. */
const char *dalcs_coils_hint(void);

/* The intervals of the currents of signal[n], through branches `part` of which some are coils that
 * perfect coupling ties: by linear programs over all of them. *is_solved: false without GLPK. */
enum dalcs_status dalcs_coils_intervals(const struct dalcs_view *view, int n_part, const int *part,
                                        int n, struct dalcs_open_signal *signal,
                                        bool *is_solved) DALCS_MUST_CHECK;

/* moves[n_part]: of branches `part`, coils that may carry more or less than they do; false for what is no coil. Without
 * GLPK all coils. */
enum dalcs_status dalcs_coils_moving(const struct dalcs_view *view, int n_part, const int *part,
                                     bool *moves) DALCS_MUST_CHECK;

#endif

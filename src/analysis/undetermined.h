/* undetermined.h - what a circuit does not determine: which signals, why, and how far they may go.
 *
 * Two answers of a passive circuit at one instant differ by something that dissipates nothing (G. J.
 * Minty, Proc. Roy. Soc. A 257, 1960): currents around loops of sources, shorts and diodes, and
 * voltages between parts that nothing conducts between. The answers are all pairs of a set of currents
 * and a set of voltages, and complementarity with any one answer bounds both (Cottle, Pang and Stone
 * 1992, thm 3.1.7). So both are read off the circuit's graph, by names and signs; resistances, however
 * small or large, take no part. What one current may be is a greatest flow, what one voltage may be a
 * shortest way: linear programs, of sums of what the answer has. Only ideal transformers add numbers of
 * their own, and there GLPK solves it. */
#ifndef DALCS_UNDETERMINED_H
#define DALCS_UNDETERMINED_H

#include "euler.h"
#include "topology.h"

/* One thing that is open, and the signals that it opens. Borrowed until the callback returns. */
struct dalcs_finding {
    double time; /* s */
    bool at_operating_point;
    const char *hint;    /* for a message; or NULL */
    const char *because; /* "d1 parallel to d2", "stack d1-d2 blocks" */
    const char *brief;   /* the same in fewer words, or NULL */

    enum dalcs_finding_kind {
        DALCS_OPEN_CURRENTS,    /* no device says how they are shared: worth a warning */
        DALCS_OPEN_VOLTAGES,    /* of what blocking elements leave alone */
        DALCS_SHUNTED_SWITCHES, /* currents of a switch and of a diode across it, as in each MOSFET */
        DALCS_FINDING_KINDS
    } kind;

    int device;         /* one of them, for its place in the netlist; -1: none */
    bool has_diodes;    /* the least-norm choice is taken; else any */
    bool has_intervals; /* false: built without GLPK, or GLPK gave none */
    int n_answers;      /* of a circuit that is not passive: that many and none between; else 0 */
    int n_signals;

    struct dalcs_open_signal {
        int output; /* of the network */
        double lower, upper, value;
    } * signal; /* [n_signals] */
};

/* Modes already looked at. */
enum { DALCS_SEEN_SLOTS = 256 };

struct dalcs_undetermined {
    const struct dalcs_circuit *circuit;
    void *user;
    enum dalcs_status (*on_finding)(void *user, const struct dalcs_finding *finding);

    const struct dalcs_network *clamped; /* the one whose .ic are held; NULL: none yet */
    bool is_ready;                       /* what follows is made when first needed */
    struct dalcs_topology topology;
    int *device_start,
        *device;           /* of component k: device[device_start[k]..device_start[k + 1] - 1] */
    int n_shorts, *shorts; /* those whose current is no signal */
    int *first_pair;       /* [n_devices] */
    int *vertex_of;        /* [n_nodes] work, -1 */
    int *branch_of;        /* [2 n_devices] work, -1 */

    struct dalcs_told { /* a voltage between two components may be open on either side */
        bool is_told;
        int system;        /* that opened it */
        double time;       /* s */
        double fall, rise; /* V, A */
    } * told;              /* [n_signals] */

    struct dalcs_seen {
        uint64_t name; /* 0: free */
        bool is_done;
        unsigned n_asked; /* without a result: all intervals vanished */
    } seen[DALCS_SEEN_SLOTS];
};

void dalcs_undetermined_init(struct dalcs_undetermined *u, const struct dalcs_circuit *circuit,
                             void *user,
                             enum dalcs_status (*on_finding)(void *user,
                                                             const struct dalcs_finding *finding));

void dalcs_undetermined_finish(struct dalcs_undetermined *u);

/* Where components of e are not passive and have few diodes: have they several solutions? Asked of the
 * operating point when stop is 0, else of the start of a transient that ends at `stop`. */
enum dalcs_status dalcs_undetermined_several(struct dalcs_undetermined *u, struct dalcs_euler *e,
                                             double stop) DALCS_MUST_CHECK;

/* Makes the tables, if they are not there yet. */
enum dalcs_status dalcs_undetermined_prepare(struct dalcs_undetermined *u) DALCS_MUST_CHECK;

/* dalcs_euler's on_open: finds what is open at this instant, and reports each signal once. Nothing is
 * known of a component that is not passive. *vanishes: something is open, but no signal may go
 * anywhere, as where a current to be shared is 0 just now. */
enum dalcs_status dalcs_undetermined_at(void *user, const struct dalcs_open_instant *instant,
                                        bool *vanishes) DALCS_MUST_CHECK;

#endif

/* excitation.h - the sources of one system as a combination of few functions of time.
 *
 * Between two edges each source is a level, a ramp and decaying oscillations (stimulus.h). Over a
 * step from t of length h, with theta = 0..1 in between, these are fixed functions of theta times
 * coefficients that change with t, so that all samples of a step are linear in the coefficients. */
#ifndef DALCS_EXCITATION_H
#define DALCS_EXCITATION_H

#include "bystanders.h"
#include "circuit.h"
#include "collocation.h"

/* One function of theta that multiplies one input. */
struct dalcs_excitation_function {
    int input;

    enum dalcs_excitation_shape {
        DALCS_EXCITATION_LEVEL,  /* 1 */
        DALCS_EXCITATION_RAMP,   /* theta */
        DALCS_EXCITATION_COSINE, /* exp(-decay h theta) cos(omega h theta) */
        DALCS_EXCITATION_SINE,
        DALCS_EXCITATION_NODE, /* the polynomial that is 1 at node `node` of the method, 0 at the others */
        DALCS_EXCITATION_BETWEEN, /* 0 at all nodes, 1 where polynomials are tested */
        DALCS_EXCITATION_LEGENDRE /* P_degree(2 theta - 1), of a small signal (periodic_flow.h) */
    } shape;

    double decay, omega; /* 1/s */
    int degree;          /* at most that of a step's polynomials */
    int node;
    const struct dalcs_collocation *method;
};

struct dalcs_excitation_wave {
    int input; /* of the system */
    const struct dalcs_stimulus *stimulus;
    int first; /* function */
    int n_functions;
    bool is_curved;           /* has oscillations: asked anew for every step */
    bool has_level, has_ramp; /* at any time */
    double from;              /* s, where `piece` was taken */
    struct dalcs_stimulus_piece piece;
    bool is_delayed; /* known at the nodes of a step */
    int smooth;      /* of the system's smooth sources; -1: it is a stimulus */
};

struct dalcs_excitation {
    const struct dalcs_system *system;
    struct dalcs_bystanders bystanders;
    int n_waves;
    struct dalcs_excitation_wave *wave; /* sources that vary and act on the system */
    int n_functions;
    struct dalcs_excitation_function *function;
    int n_terms;
    struct dalcs_stimulus_term *term;    /* of the waves' pieces */
    struct dalcs_stimulus_term *scratch; /* of one wave, at another time */
    double *constant;                    /* [n_inputs] the inputs that never change; 0 for waves */
    int first_smooth;                    /* function of these: */
    double *
        smooth; /* [n_smooth][s + 2] what smooth sources are in the present step: at its nodes, and what the
                       polynomial through these misses where it is tested */
    bool is_curved;           /* any wave is */
    double shortest_period;   /* s, of the oscillations; INFINITY without */
    double next_edge;         /* s, of the waves */
    bool jumps;               /* the value of any did, at the edge that was entered last */
    struct dalcs_arena arena; /* all arrays */
};

/* Inputs that only command switches are left out, for commands have their own schedule; and those that only
 * bystanders see. method: of the steps; NULL where the system has neither smooth nor delayed sources. */
enum dalcs_status dalcs_excitation_setup(struct dalcs_excitation *excitation,
                                         const struct dalcs_circuit *circuit,
                                         const struct dalcs_system *system,
                                         const struct dalcs_collocation *method) DALCS_MUST_CHECK;

void dalcs_excitation_finish(struct dalcs_excitation *excitation);

/* Looks at the sources at t from the right: at the start and at edges. */
void dalcs_excitation_enter(struct dalcs_excitation *excitation, double t);

/* coefficient[n_functions] of a step from t of length h. */
void dalcs_excitation_coefficients(const struct dalcs_excitation *excitation, double t, double h,
                                   double *coefficient);

double dalcs_excitation_function_at(const struct dalcs_excitation_function *f, double h,
                                    double theta);

/* What the polynomial through value[s + 1] of f at the nodes misses of it at the test node. What cannot
 * be told from rounding, which a short step makes large, is estimated from the next derivative. */
double dalcs_excitation_missed(const struct dalcs_excitation_function *f,
                               const struct dalcs_collocation *method, double h,
                               const double *value);

/* inputs[n_inputs] at t + tau, continuing the present pieces, over edges if need be. */
void dalcs_excitation_inputs(const struct dalcs_excitation *excitation, double t, double tau,
                             double *inputs);

#endif

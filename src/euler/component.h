/* component.h - one system on its way through time: its OSNSP, inputs, commands and state. */
#ifndef DALCS_COMPONENT_H
#define DALCS_COMPONENT_H

#include "network.h"
#include "restless.h"

struct dalcs_component {
    const struct dalcs_system *system;
    const struct dalcs_circuit *circuit;
    struct dalcs_osnsp osnsp;
    struct dalcs_positions positions; /* of switches whose control reads the circuit */
    double *u;        /* [n_x + n_inputs] x_k and the inputs of the step being made */
    double *y;        /* [n_columns] the present answer */
    double *y_before; /* [n_columns] the answer at the beginning of the last step */
    double *scratch;  /* [n_columns] */
    double *probe_u;  /* [n_x + n_inputs] */
    double *probe_y;  /* [n_columns] */
    double *largest;  /* [n_x] magnitudes of states so far, of steps of implicit Euler */
    double scale[2];  /* V, A: the physical scales of their answers */
    uint64_t *saved_mode;

    struct { /* inputs that are not constant in time */
        int n, *input;

        struct dalcs_input_piece {
            bool is_linear;     /* PULSE and PWL between two edges */
            double from, to;    /* s */
            double first, last; /* right limit at from, left limit at to; equal when constant */
        } * piece;              /* [n] where each is */
    } varying;

    struct {
        int n, *pair;
    } switches;

    struct {                  /* of switches */
        bool moved;           /* in the last solve */
        long n_delayed;       /* whose control did not settle within a step */
        const char *restless; /* the first of them at an operating point or in a step of Euler */
        long n_slid;          /* steps in which one slides (sliding.h) */
        const char *
            held; /* a formula that slides where others should with it, and do not: in steps of Euler */
        long n_held; /* such steps */
    } commands;

    struct { /* for messages */
        double sigma;
        const double *u;                /* the problem of the last failed solve, for the dump */
        int overgrown;                  /* the state that has become too large for numbers; -1 */
        struct dalcs_restless restless; /* what no position suits */
    } failure;

    bool is_static;           /* nothing depends on time or history */
    bool was_open;            /* the last step's answer may be one of several */
    struct dalcs_arena arena; /* what has the same size during the run */
};

enum dalcs_status dalcs_component_setup(struct dalcs_component *c,
                                        const struct dalcs_circuit *circuit,
                                        const struct dalcs_system *system,
                                        const struct dalcs_osnsp_options *options) DALCS_MUST_CHECK;

void dalcs_component_finish(struct dalcs_component *c);

/* Puts the inputs at time t into u[n_x + n_inputs]. */
void dalcs_component_sample(struct dalcs_component *c, double t, enum dalcs_side side, double *u);

/* The same at a time t that the next samples may lie before. */
void dalcs_component_look_ahead(const struct dalcs_component *c, double t, enum dalcs_side side,
                                double *u);

/* The first edge of an input after a time, s; INFINITY: none. */
double dalcs_component_next_edge(const struct dalcs_component *c, double since);

/* Its sources are others from t on. */
void dalcs_component_disturb(struct dalcs_component *c, double t);

/* Does a source jump at t = 0? An operating point lies before that. */
bool dalcs_component_jumps_at_start(const struct dalcs_component *c);

/* The inputs for an operating point. */
void dalcs_component_sample_operating(const struct dalcs_component *c, bool transient_follows,
                                      double *u);

/* Commands the switches that sources alone control as they stand just behind t. Nothing is solved. */
void dalcs_component_command_behind(struct dalcs_component *c, double t);

/* Commands the switches and solves at sigma; y gets the answer. Switches that sources control are
 * set first, the others agree with the answer (positions.h). */
enum dalcs_status dalcs_component_solve(struct dalcs_component *c, double sigma, const double *u,
                                        double *y) DALCS_MUST_CHECK;

/* Are the states x[n_x] too large to be reckoned with? Then c->failure.overgrown is one that is. */
bool dalcs_component_overgrows(struct dalcs_component *c, const double *x);

#endif

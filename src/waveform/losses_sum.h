/* losses_sum.h - what each device takes over a window of the run: integrals over its stretches, exact on
 * what was computed, and energies at the instants between them.
 *
 * An instant belongs to the window from <= t < to, so that windows side by side count it once. */
#ifndef DALCS_LOSSES_SUM_H
#define DALCS_LOSSES_SUM_H

#include "circuit.h"
#include "impulses.h"
#include "side_means.h"
#include "stretch.h"

/* Of one device. */
struct dalcs_loss {
    double v, v_square, i, i_square, energy; /* integrals: V s, V^2 s, A s, A^2 s, J taken */
    double begin[2], end[2];                 /* V, A at the ends of the window */
    double last[2], now[2]; /* V, A at the end of the last stretch, at the start of this one */
    double first;           /* V or A before a jump at the start, NAN: there was none */
    double jump;            /* J taken in jumps */
    double switching;       /* J, by tables */
    int n_on, n_off, n_clamped;
    bool is_on;

    struct dalcs_loss_area { /* of the impulses of its voltage and of its current */
        int n;
        double sum, size; /* V s, A s, and of their magnitudes; NAN: not known */
    } area[2];

    double frequency;  /* Hz, of a source with a period; 0: none */
    double c[2], s[2]; /* integrals of v and i times cos and sin of its fundamental */
    int mean[3];       /* of v^2, i^2, v i over the sides of a slide; -1: as products */
};

/* A jump of one part, between two stretches. */
struct dalcs_loss_jump {
    double time, energy_lost;
    bool is_in_steps; /* of euler: the step across it has all but what is lost */
    int n, capacity;

    struct dalcs_loss_impulse {
        int device;
        double charge, flux;  /* C from node[0] to node[1] inside it, Wb from there to there */
        double in_thresholds; /* J */
    } * impulse;
};

struct dalcs_losses_sum {
    const struct dalcs_circuit *circuit;
    double from, to, near; /* s; times closer than the last are the same */
    bool has_last, has_begun, knows_sides, is_euler;
    struct dalcs_loss *device; /* [n_devices] */
    int n_jumps, jump_capacity;
    struct dalcs_loss_jump *jump;    /* since the last stretch */
    struct dalcs_impulses *impulses; /* borrowed */
    double loops;                    /* J lost in jumps where no switch or diode carries them */
    const struct dalcs_side_means *sides; /* borrowed; NULL: nothing slides */
};

/* For a run up to `stop`; `near`: s. */
enum dalcs_status dalcs_losses_sum_setup(struct dalcs_losses_sum *sum,
                                         const struct dalcs_circuit *circuit, double stop,
                                         double near) DALCS_MUST_CHECK;
void dalcs_losses_sum_finish(struct dalcs_losses_sum *sum);

/* What slides is asked of these means from then on. */
enum dalcs_status dalcs_losses_sum_ask_sides(struct dalcs_losses_sum *sum,
                                             struct dalcs_side_means *sides) DALCS_MUST_CHECK;

/* Is the device part of a slide at present? */
bool dalcs_losses_sum_slides(const struct dalcs_losses_sum *sum, int device);

/* The values before the first stretch: value[n_measured]. */
void dalcs_losses_sum_before_start(struct dalcs_losses_sum *sum, const double *value);

/* Room for one more jump with n impulses; NULL: out of memory. */
struct dalcs_loss_jump *dalcs_losses_sum_jump(struct dalcs_losses_sum *sum, double time, int n);

/* Stretches follow each other; on[n_devices]: conducts, or is closed, in this one. */
void dalcs_losses_sum_stretch(struct dalcs_losses_sum *sum, const struct dalcs_stretch *stretch,
                              const bool *on);

/* ---- losses_jump.c ----------------------------------------------------------------------------- */

/* The jumps at an instant of the window, with device[].last and now on both sides of it. */
void dalcs_losses_sum_take_jumps(struct dalcs_losses_sum *sum);

#endif

/* impulses.h - the charge that passes each element and the flux that builds up across it where states jump.
 *
 * No row shows them: they have an area and no height. So what is an integral of a waveform counts them besides, from here:
 * means and integrals, Fourier's coefficients, losses. A square of one has no integral.
 *
 * Charges of capacitors and fluxes of coils are those of their states, those of switches and diodes are the jump's. The others
 * follow by Kirchhoff's laws, and from what sources read. */
#ifndef DALCS_IMPULSES_H
#define DALCS_IMPULSES_H

#include "device_map.h"
#include "euler.h"

/* At one instant. Zero-initialise; without a setup there are none. */
struct dalcs_impulses {
    const struct dalcs_circuit *circuit;
    const struct dalcs_network *network;
    struct dalcs_device_map devices;
    double near; /* s; times closer than this are the same */
    bool is_noted, is_solved;
    double time; /* s, of those that are noted */
    double *
        change; /* [n_devices] of a capacitor's voltage, V, of a coil's current, A; NAN: not known */
    double *level;  /* [n_devices] their sizes on both sides */
    double *charge; /* [n_devices] C from node[0] to node[1] inside; NAN: not known */
    double *
        across; /* [n_devices] Wb from node[0] to node[1], of what is no resistor; NAN: not known */
    double *node;       /* [n_nodes] Wb against ground; NAN: not known */
    double *moved;      /* [n_nodes] V that a node moves by; NAN: not known */
    int *held;          /* [n_nodes] union_find.h: sources say what is between them */
    double *sum, *size; /* [n_nodes] work: charges that leave, their sizes */
    int *n_open;        /* [n_nodes] work */
    double *pair;       /* [most pairs of a source] work */
};

enum dalcs_status dalcs_impulses_setup(struct dalcs_impulses *impulses,
                                       const struct dalcs_circuit *circuit,
                                       const struct dalcs_network *network,
                                       double near) DALCS_MUST_CHECK;
void dalcs_impulses_finish(struct dalcs_impulses *impulses);

/* A jump of one part, with those of the others at the same time. */
void dalcs_impulses_note(struct dalcs_impulses *impulses, const struct dalcs_euler_jump *jump);

/* Are there any at this time? Then all are known, as far as the circuit tells them. */
bool dalcs_impulses_at(struct dalcs_impulses *impulses, double time);

/* Do sources say what a device's voltage is, whatever jumps? Of one that reads only where they say what it reads. */
bool dalcs_impulses_is_held(const struct dalcs_impulses *impulses, int device);

/* V s or A s of a signal at that instant; NAN: not known. */
double dalcs_impulses_of(const struct dalcs_impulses *impulses, const struct dalcs_signal *signal);

/* V by which a signal changes at once at that instant; NAN: not known, as of currents. */
double dalcs_impulses_change(const struct dalcs_impulses *impulses,
                             const struct dalcs_signal *signal);

/* ---- impulse_laws.c ------------------------------------------------------------------------------ */

/* All from those that are noted. Private to this folder. */
void dalcs_impulses_solve(struct dalcs_impulses *impulses);

/* Does it hold its voltage, so that any charge may pass? And its current? */
bool dalcs_holds_voltage(const struct dalcs_device *device);
bool dalcs_holds_current(const struct dalcs_device *device);

#endif

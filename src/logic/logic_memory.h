/* logic_memory.h - the memory of gates, as numbers and bits behind the states and the switches of a circuit.
 *
 * Numbers are what moves with a small change: the voltage of each output, what each sample may take just now, how long a
 * pulse still lasts, and when the changes that are on their way are seen. All else is bits. */
#ifndef DALCS_LOGIC_MEMORY_H
#define DALCS_LOGIC_MEMORY_H

#include "logic_run.h"

struct dalcs_logic_memory {
    const struct dalcs_circuit *circuit;
    int n_pins;

    struct dalcs_logic_pin {
        int gate, which, stimulus;
        bool holds; /* what a sample took, at any voltage */
    } * pin;        /* [n_pins] outputs */

    int n_taken, *taken;  /* [n_taken] gates that sample */
    int n_pulses, *pulse; /* [n_pulses] monostables */
    int n_due;            /* changes on their way, at most */
    int n_numbers, n_bits;
};

enum dalcs_logic_number {
    DALCS_NUMBER_PIN,
    DALCS_NUMBER_TAKEN,
    DALCS_NUMBER_PULSE,
    DALCS_NUMBER_DUE
};

/* Of what a number is, and the gate (-1: of any). */
enum dalcs_logic_number dalcs_logic_number_kind(const struct dalcs_logic_memory *memory, int number,
                                                int *gate);

/* The output that writes a stimulus; -1: none. */
int dalcs_logic_pin_of(const struct dalcs_logic_memory *memory, int stimulus);

/* What the k-th of taken reads. */
static inline const struct dalcs_output *
dalcs_logic_read_by(const struct dalcs_logic_memory *memory, const struct dalcs_network *network,
                    int k) {
    const struct dalcs_circuit *c = memory->circuit;
    return &network->output[c->results.measured[c->control.gate[memory->taken[k]].sampled]];
}

/* period: s, over which changes come back. */
enum dalcs_status dalcs_logic_memory_setup(struct dalcs_logic_memory *memory,
                                           struct dalcs_arena *arena,
                                           const struct dalcs_circuit *circuit,
                                           double period) DALCS_MUST_CHECK;

/* At t, before anything happens there; what samples may take has been read. DALCS_NOT_CONVERGED: more changes are on
 * their way than there is room for. */
enum dalcs_status dalcs_logic_memory_save(const struct dalcs_logic_memory *memory,
                                          const struct dalcs_logic_run *l, double t, double *number,
                                          bool *bit) DALCS_MUST_CHECK;

/* Into a run that begins at 0. Number k of a pulse or a change has -1 - k for what it comes of. */
enum dalcs_status dalcs_logic_memory_restore(const struct dalcs_logic_memory *memory,
                                             struct dalcs_logic_run *l, const double *number,
                                             const bool *bit) DALCS_MUST_CHECK;

#endif

/* file_audit.h - is a table of waveforms one of this circuit?
 *
 * The same laws as audit.h asks of a waveform that can be read anywhere, here of one that is known at rows
 * only, with so many digits and maybe without all signals. */
#ifndef DALCS_FILE_AUDIT_H
#define DALCS_FILE_AUDIT_H

#include "circuit.h"

#include "dalcs.h"

/* What the table promises of each signal. */
struct dalcs_file_promise {
    double tolerance;         /* over its largest value */
    double vntol, abstol;     /* V, A; besides */
    bool are_shorts_measured; /* its currents of shorts are those of the elements behind them */
    bool are_gates_restless;  /* they do not settle, as a warning has said */
    bool
        remembers; /* rows before the first one have left switches with hysteresis where they are */
    bool
        has_own_lines; /* of exponential diodes: those of the circuit, not of the table's currents */
};

/* The answer's texts are in `arena`. DALCS_E_OPTION comes with a message. */
enum dalcs_status dalcs_file_audit(const struct dalcs_circuit *circuit,
                                   const struct dalcs_wave_table *table,
                                   const struct dalcs_file_promise *promise,
                                   struct dalcs_arena *arena, struct dalcs_diag *diag,
                                   struct dalcs_table_audit *result) DALCS_MUST_CHECK;

#endif

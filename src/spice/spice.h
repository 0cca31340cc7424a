/* spice.h - a circuit as a netlist that ngspice can take.
 *
 * ngspice has no ideal devices: each is replaced by a near-ideal one. What it cannot express of a
 * current is measured by a source of 0 V in series. */
#ifndef DALCS_SPICE_H
#define DALCS_SPICE_H

#include "circuit.h"

/* What the circuit's nodes and devices are called in the netlist. */
struct dalcs_spice_names {
    const struct dalcs_circuit *circuit; /* borrowed */
    int *node_of;                        /* [n_nodes] nodes that shorts make one have one name */
    const char **node;                   /* [n_nodes] "out"; "x1_out__7" for "x1.out" */
    const char **device;                 /* [n_devices] */
    bool *is_sensed;                     /* [n_devices] a source of 0 V measures its current */
    const char *(*column)[2]; /* [n_signals] of the raw file: the first minus the second; NULL: 0 */
    struct dalcs_arena arena; /* owns all of it */
};

enum dalcs_status dalcs_spice_names_build(struct dalcs_spice_names *names,
                                          const struct dalcs_circuit *circuit) DALCS_MUST_CHECK;

/* Accepts a zeroed one. */
void dalcs_spice_names_finish(struct dalcs_spice_names *names);

/* Writes the netlist. What ngspice cannot be told goes to diag: DALCS_E_NETLIST. */
enum dalcs_status dalcs_spice_write(const struct dalcs_spice_names *names,
                                    const struct dalcs_spice_options *options, FILE *stream,
                                    struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* ---- For the files of this folder ------------------------------------------------------------ */

/* The shortest text that reads back as `value`, in the C locale. */
void dalcs_spice_write_number(FILE *stream, double value);

/* Is there no card for this source, so that an expression must say it? */
bool dalcs_spice_needs_expression(const struct dalcs_stimulus *stimulus);

/* What follows the nodes of a V or I card: "PULSE(...)", or of a B card: an expression. NULL, or why
 * ngspice cannot express. Values after `stop` are not used. */
const char *dalcs_spice_write_source(FILE *stream, const struct dalcs_stimulus *stimulus,
                                     double edge, double stop);
void dalcs_spice_write_expression(FILE *stream, const struct dalcs_stimulus *stimulus);

/* The B source of device i, which has a behaviour, and those of its lambdas. */
void dalcs_spice_write_formula(const struct dalcs_spice_names *names,
                               const struct dalcs_spice_options *options, FILE *stream, int i,
                               const char *first_node);

/* Does the formula of device i read stimulus k? No two formulas share one. The source that gives it:
 * NULL, or why ngspice cannot be told. */
bool dalcs_spice_takes_stimulus(const struct dalcs_circuit *circuit, int i, int k);
const char *dalcs_spice_write_stimulus(const struct dalcs_circuit *circuit, FILE *stream, int k,
                                       double edge);

/* " ron=", and a number. */
void dalcs_spice_write_value(FILE *stream, const char *before, double value);

/* Model k of the circuit. */
void dalcs_spice_write_diode_model(FILE *stream, const struct dalcs_circuit *circuit,
                                   const struct dalcs_spice_options *o, int k);
void dalcs_spice_write_switch_model(FILE *stream, const struct dalcs_circuit *circuit,
                                    const struct dalcs_spice_options *o, int k);

#endif

/* spice.h - the circuit in ngspice's language. Part of dalcs.h, which includes it. */
#ifndef LIBDALCS_SPICE_H
#define LIBDALCS_SPICE_H

#ifndef DALCS_H
#error "include dalcs.h"
#endif

/* What stands for a diode. */
enum dalcs_spice_diode {
    DALCS_SPICE_STOCK,       /* ngspice's own default, whatever the netlist says of lines */
    DALCS_SPICE_EXPONENTIAL, /* a steep exponential between the lines of the netlist */
    DALCS_SPICE_LINES        /* XSPICE's sidiode, the lines themselves */
};

/* How near to ideal, and how hard ngspice is to try. */
struct dalcs_spice_options {
    enum dalcs_spice_diode diode;
    double emission;           /* N of the exponential, > 0 */
    double series;             /* ohm; of an exponential where the netlist's diode has none */
    double on, off;            /* ohm; of switches that are a wire and a cut, and of sidiodes */
    double edge;               /* s; the longest ramp that an edge of no width may become, > 0 */
    double max_step;           /* s; tmax and tstep of .tran, 0: the netlist's */
    double reltol;             /* 0: ngspice's own */
    const char *method;        /* "trap" or "gear" */
    const char *extra_options; /* more of .options; NULL: none */
};

/* Writes the circuit as a netlist for ngspice: flat, parameters resolved, ideal devices replaced. An
 * edge of no width becomes a ramp centred on it, a short one node. Errors of the stream stay there.
 * What ngspice cannot express: DALCS_E_NETLIST and a message with its place. */
enum dalcs_status dalcs_session_write_spice(struct dalcs_session *session,
                                            const struct dalcs_spice_options *options,
                                            FILE *stream) DALCS_MUST_CHECK;

/* The signal of that name in ngspice's raw file is its column `plus` minus its column `minus`; either
 * may be NULL: 0. They belong to the session. DALCS_E_OPTION: the netlist has no such signal. */
enum dalcs_status dalcs_session_spice_columns(struct dalcs_session *session, const char *signal,
                                              const char **plus,
                                              const char **minus) DALCS_MUST_CHECK;

#endif

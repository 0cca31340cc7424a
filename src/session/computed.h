/* computed.h - columns of results that are computed from the signals of each row. */
#ifndef DALCS_SESSION_COMPUTED_H
#define DALCS_SESSION_COMPUTED_H

#include "session_internal.h"

/* A sink in front of another one. */
struct dalcs_computing {
    struct dalcs_sink sink; /* of the run */
    const struct dalcs_sink *to;
    struct dalcs_session *session;
    size_t n_in, n_out; /* signals of a row as it comes, and as it goes */
    size_t n_before;    /* those in front of the circuit's: what an outer .dc sweeps */
    bool is_complex;
    bool passes; /* rows go through as they are */
    double *row; /* as it goes */
};

/* Rows have the circuit's signals; the other sink gets its named ones and the computed columns, in the order of the
 * cards. */
void dalcs_computing_init(struct dalcs_computing *computing, struct dalcs_session *session,
                          const struct dalcs_sink *to);

#endif

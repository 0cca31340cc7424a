/* status.h - propagate a status; the codes themselves are public, in dalcs.h. */
#ifndef DALCS_STATUS_H
#define DALCS_STATUS_H

#include "dalcs.h"

/* Return early with the status of a call that owns nothing yet. Functions that own things use one
 * `done:` exit instead; never both in one function. */
#define DALCS_TRY(call)                                                                            \
    do {                                                                                           \
        enum dalcs_status try_status_ = (call);                                                    \
        if (try_status_ != DALCS_OK) {                                                             \
            return try_status_;                                                                    \
        }                                                                                          \
    } while (0)

#endif

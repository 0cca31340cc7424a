/* sized_options.c - a run's options from programs that were built with another dalcs.h.
 *
 * A later header adds fields at the end of the struct, of which 0 means what is done without them. So the size
 * tells all: an older program leaves the fields that it does not know as they are by default, and a newer one
 * may set none that are not known here. */
#include "session_internal.h"

#include "rounding.h"

#include <string.h>

void dalcs_run_options_init(struct dalcs_run_options *options, size_t size) {
    const struct dalcs_run_options usual = {.size = size,
                                            .certificate_tolerance = dalcs_answer_rounded,
                                            .proximal_weight = 1e-8,
                                            .rcond_min = 1e-14,
                                            .max_outer = 40,
                                            .max_pivots = 200,
                                            .cache_bytes = (size_t)256 << 20,
                                            .dense_limit = 64,
                                            .max_events = 1000000};
    memset(options, 0, size);
    memcpy(options, &usual, size < sizeof usual ? size : sizeof usual);
}

/* Is a byte set that is behind the last field known here? */
static bool has_more(const struct dalcs_run_options *given) {
    const char *byte = (const char *)given;
    size_t k = sizeof *given;
    while (k < given->size && byte[k] == 0) {
        k++;
    }
    return k < given->size;
}

enum dalcs_status dalcs_run_options_take(struct dalcs_session *session,
                                         const struct dalcs_run_options *given,
                                         struct dalcs_run_options *own) {
    if (given->size < sizeof given->size) {
        dalcs_diag_add(&session->diag, DALCS_ERROR, NULL,
                       "begin with dalcs_run_options_default(), then set what is to be another",
                       "the options of the run have no size");
        return DALCS_E_OPTION;
    }
    if (has_more(given)) {
        dalcs_diag_add(
            &session->diag, DALCS_ERROR, NULL,
            "install the library that the program was built with, or leave them as "
            "dalcs_run_options_default() has them",
            "the program sets options of a run that this library, version %s, does not have",
            dalcs_version());
        return DALCS_E_OPTION;
    }
    dalcs_run_options_init(own, sizeof *own);
    memcpy(own, given, given->size < sizeof *own ? given->size : sizeof *own);
    own->size = sizeof *own;
    return DALCS_OK;
}

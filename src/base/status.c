/* status.c - the text of a status code and the library's version.
 *
 * Codes and texts come from one list in dalcs.h, so they cannot drift apart. */
#include "status.h"

const char *dalcs_status_text(enum dalcs_status status) {
    switch (status) {
#define STATUS_TEXT(name, value, text)                                                             \
    case name:                                                                                     \
        return text;
        DALCS_STATUS_LIST(STATUS_TEXT)
#undef STATUS_TEXT
    }
    return "unknown status";
}

const char *dalcs_version(void) {
    return DALCS_VERSION;
}

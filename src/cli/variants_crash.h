/* variants_crash.h - a variant that crashes becomes a row with an error. The program starts itself again and
 * continues. */
#ifndef DALCS_VARIANTS_CRASH_H
#define DALCS_VARIANTS_CRASH_H

#include "cli.h"

#include <stddef.h>

/* Variants that have crashed before. */
struct dalcs_crashes {
    char *path; /* of the file that names them, beside the table; heap */
    size_t n, capacity;

    struct dalcs_crash {
        size_t step;
        int signal;
    } * crash; /* [n] heap */
};

/* Was this program started by itself after a crash? */
bool dalcs_crashes_go_on(void);

/* Reads those of the partial table `partial` where it is gone on with, and forgets them where not; from now on crashes of
 * this process are noted there, if the system can start it again. */
enum dalcs_status dalcs_crashes_watch(struct dalcs_crashes *crashes, const char *partial,
                                      bool goes_on) DALCS_MUST_CHECK;

/* Each thread: before its first step and behind its last; and around each step. */
void dalcs_crashes_enter_thread(void);
void dalcs_crashes_leave_thread(void);
void dalcs_crashes_begin(size_t step);
void dalcs_crashes_end(void);

/* The signal that the step has crashed with; 0: it has not. */
int dalcs_crashes_find(const struct dalcs_crashes *crashes, size_t step);

/* `is_complete`: the note of crashes is not needed any more. */
void dalcs_crashes_finish(struct dalcs_crashes *crashes, bool is_complete);

#endif

/* talk.h - lines for the program that uses the library.
 *
 * Whole lines, each behind "stdout " or "stderr ". Programs look for words in them: a line of stderr means that
 * something failed, and so does "error" in one of stdout. */
#ifndef DALCS_NG_TALK_H
#define DALCS_NG_TALK_H

#include "dalcs.h"
#include "memory.h"
#include "ngspice_abi.h"

#include <stdio.h>

/* Zero-initialise, set the first three. */
struct ng_talk {
    ng_send_char *_Atomic send_char; /* NULL: no callback; read once for a call */
    int id;
    void *user;
    FILE *out;  /* of print and echo */
    char *line; /* what came without its newline yet; heap */
    size_t n, capacity;
};

enum dalcs_status ng_talk_open(struct ng_talk *talk) DALCS_MUST_CHECK;
void ng_talk_close(struct ng_talk *talk);

void ng_talk_say(struct ng_talk *talk, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* "stderr Error: ..." */
void ng_talk_fail(struct ng_talk *talk, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* "stderr Warning: ..." */
void ng_talk_warn(struct ng_talk *talk, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* The session's messages from number *n_told on, which is raised; returns how many were errors. */
size_t ng_talk_messages(struct ng_talk *talk, const struct dalcs_session *session, size_t *n_told);

#endif

/* circuit.h - a circuit that was sent: its text, its session, and what was said to it since. */
#ifndef DALCS_NG_CIRCUIT_H
#define DALCS_NG_CIRCUIT_H

#include "dalcs.h"
#include "memory.h"

/* Lines that are collected. Zero-initialise. */
struct ng_lines {
    char *text; /* each ends with a newline; heap; NULL: none */
    size_t n, capacity;
};

enum dalcs_status ng_lines_add(struct ng_lines *lines, const char *line) DALCS_MUST_CHECK;
void ng_lines_finish(struct ng_lines *lines);

struct ng_circuit {
    struct dalcs_session *session;
    bool is_none;           /* it stands for none, so that there is something to compute with */
    char *name;             /* as messages call it; files that it includes lie beside it */
    struct ng_lines source; /* as it was sent */
    struct ng_lines cards;  /* the same up to .end, without .control blocks */
    bool is_asked[DALCS_N_ANALYSES]; /* by its cards */
    size_t n_control;                /* lines of its .control blocks */
    struct ng_lines settings;        /* commands since: alter, option, save, reset */
    struct ng_lines
        run[DALCS_N_ANALYSES]; /* to repeat the last run of a kind: the settings of then, and the
                                              analysis itself as the last line */
    struct ng_lines made;      /* let since the last run */
    size_t n_told;             /* messages of the session that were told */
};

/* Is there any element in the text? KiCad sends an empty circuit before the first one. */
bool ng_circuit_is_empty(const char *text);

/* A circuit of this text, NULL: that stands for none. DALCS_E_NETLIST: it has errors; they are in its session.
 * *circuit is NULL or the caller's to destroy, whatever the status. */
enum dalcs_status ng_circuit_read(struct ng_circuit **circuit, const char *name,
                                  const char *text) DALCS_MUST_CHECK;
void ng_circuit_destroy(struct ng_circuit *circuit);

/* Takes note of a command of the language of .control, before it is executed. */
enum dalcs_status ng_circuit_hear(struct ng_circuit *circuit, const char *word,
                                  const char *rest) DALCS_MUST_CHECK;

/* A netlist that repeats the last run of this kind and measures. NULL: there was none, or no memory; heap. */
char *ng_circuit_repetition(const struct ng_circuit *circuit, enum dalcs_analysis analysis,
                            const char *measurement);

#endif

/* system_file.h - a DALCS as text, with one of its one-step problems: what a failed run leaves behind
 * and tools/replay solves again. The format is in doc/system-file.md. */
#ifndef DALCS_SYSTEM_FILE_H
#define DALCS_SYSTEM_FILE_H

#include "diag.h"
#include "system.h"

#include <stdint.h>

/* The problem at sigma from u = (x_k, s), where the search began or ended in `mode`. */
struct dalcs_system_step {
    double sigma;         /* 1/s; 0: operating point */
    const double *u;      /* [n_x + n_inputs] */
    const uint64_t *mode; /* [(n_pairs + 63) / 64] */
    const char *about;    /* where it comes from, for a person: one line of text */
};

/* Writes beside `path` and renames, so that no half a file ever has that name. DALCS_E_IO when that
 * cannot be done (errno says why); nothing is left then. */
enum dalcs_status dalcs_system_file_write(const char *path, const struct dalcs_system *system,
                                          const struct dalcs_system_step *step) DALCS_MUST_CHECK;

/* A system read back; finish with dalcs_system_file_finish. */
struct dalcs_system_file {
    struct dalcs_system system;
    double sigma;
    double *u;
    uint64_t *mode;
    const char *about;
    struct dalcs_arena arena; /* names */
};

/* DALCS_E_IO when there is no such file, DALCS_E_NETLIST when it is not one: diag then says which
 * line is wrong. What is accepted is a system that the engine can rely on: indices in range, finite
 * numbers, `dual` a permutation. *file is zeroed on failure. */
enum dalcs_status dalcs_system_file_read(struct dalcs_system_file *file, const char *path,
                                         struct dalcs_diag *diag) DALCS_MUST_CHECK;

/* The same from text[0..length-1], which messages call `name`. */
enum dalcs_status dalcs_system_file_read_text(struct dalcs_system_file *file, const char *name,
                                              const char *text, size_t length,
                                              struct dalcs_diag *diag) DALCS_MUST_CHECK;

void dalcs_system_file_finish(struct dalcs_system_file *file);

#endif

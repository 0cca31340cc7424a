/* system_file.h - a DALCS as text, with one of its one-step problems: what a failed run leaves behind
 * and tools/bench/replay solves again. The format is in doc/system-file.md. */
#ifndef DALCS_SYSTEM_FILE_H
#define DALCS_SYSTEM_FILE_H

#include "system.h"

#include <stdint.h>

/* The problem at sigma from u = (x_k, s), where the search began or ended in `mode`. */
struct dalcs_system_step {
    double sigma;
    const double *u;      /* [n_x + n_inputs] */
    const uint64_t *mode; /* [(n_pairs + 63) / 64] */
};

/* DALCS_E_IO when the file cannot be written. */
enum dalcs_status dalcs_system_file_write(const char *path, const struct dalcs_system *system,
                                          const struct dalcs_system_step *step) DALCS_MUST_CHECK;

/* A system read back; finish with dalcs_system_file_finish. */
struct dalcs_system_file {
    struct dalcs_system system;
    double sigma;
    double *u;
    uint64_t *mode;
    struct dalcs_arena arena; /* names */
};

/* DALCS_E_IO when there is no such file, DALCS_E_NETLIST when it is not one. *file is zeroed on
 * failure. */
enum dalcs_status dalcs_system_file_read(struct dalcs_system_file *file,
                                         const char *path) DALCS_MUST_CHECK;

void dalcs_system_file_finish(struct dalcs_system_file *file);

#endif

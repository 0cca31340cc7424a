/* ngspice_raw.h - the waveforms that ngspice wrote. */
#ifndef DALCS_NGSPICE_RAW_H
#define DALCS_NGSPICE_RAW_H

#include "dalcs.h"

struct dalcs_ngspice_raw {
    size_t n_columns, n_points;
    char **name;   /* [n_columns] the first is time */
    double *value; /* [n_points * n_columns] */
};

/* The first plot of a binary file with real values; a run that stopped early leaves fewer points than
 * its header says. DALCS_E_IO: not such a file, or none. */
enum dalcs_status dalcs_ngspice_raw_read(struct dalcs_ngspice_raw *raw,
                                         const char *path) DALCS_MUST_CHECK;

/* n_columns when there is no column of that name. */
size_t dalcs_ngspice_raw_find(const struct dalcs_ngspice_raw *raw, const char *name);

/* Accepts a zeroed one. */
void dalcs_ngspice_raw_finish(struct dalcs_ngspice_raw *raw);

#endif

/* row_volume.h - how much the files of a run will hold, before it begins. */
#ifndef DALCS_ROW_VOLUME_H
#define DALCS_ROW_VOLUME_H

#include "outputs.h"

/* Rows of .tran in each step at least; 0: not known. */
double dalcs_row_volume_count(const struct dalcs_arguments *arguments,
                              const struct dalcs_request *request, size_t n_at);

/* For the first step of .tran: a note where files will be large, and DALCS_E_IO with a message where a disk has less
 * room than one of them takes. */
enum dalcs_status dalcs_row_volume_tell(const struct dalcs_cli *cli,
                                        const struct dalcs_outputs *outputs,
                                        const struct dalcs_plot *plot, double n_rows,
                                        bool quiet) DALCS_MUST_CHECK;

#endif

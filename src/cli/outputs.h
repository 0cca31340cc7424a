/* outputs.h - everything that one run writes: tables, figure, report file, measurements. */
#ifndef DALCS_OUTPUTS_H
#define DALCS_OUTPUTS_H

#include "arguments.h"
#include "figure.h"
#include "measure.h"
#include "step_lines.h"
#include "table.h"
#include "table_audit.h"

struct dalcs_outputs {
    struct dalcs_table *table; /* [n_tables] */
    size_t n_tables;
    struct dalcs_figure *figure;    /* heap; NULL: none */
    const struct dalcs_plot *drawn; /* in the figure: the first transient; NULL: not yet */
    const char *report_path;        /* NULL: none */
    struct dalcs_atomic_file report;
    bool has_summary; /* that shows what rows are measured for */
    struct dalcs_measure measure[DALCS_N_ANALYSES];
    struct dalcs_step_lines steps; /* of .step */
    bool is_audited;
    size_t n_plots;
    struct dalcs_table_audit_sums audit; /* of the last plot */
    enum dalcs_analysis analysis;        /* of the plot being received */
    size_t n_rows;
};

/* Touches no file. Times of the transient plot run from start to stop; main: the main analysis;
 * ascii: the netlist has the option that makes raw files text. */
enum dalcs_status dalcs_outputs_init(struct dalcs_outputs *outputs,
                                     const struct dalcs_arguments *arguments, bool ascii,
                                     enum dalcs_analysis main, double start,
                                     double stop) DALCS_MUST_CHECK;

/* The callbacks of struct dalcs_sink. Begin opens all files, so that a path which cannot be
 * written ends the run before it starts. */
enum dalcs_status dalcs_outputs_begin(struct dalcs_outputs *outputs, const struct dalcs_plot *plot);
enum dalcs_status dalcs_outputs_rows(struct dalcs_outputs *outputs, size_t n, const double *time,
                                     const double *value);
enum dalcs_status dalcs_outputs_end(struct dalcs_outputs *outputs);

/* Of the last plot: what the summary will say, against what its rows were. */
enum dalcs_status dalcs_outputs_audit(const struct dalcs_outputs *outputs,
                                      const struct dalcs_cli *cli) DALCS_MUST_CHECK;

/* Ends every file: under its name when `complete`, else under one that says it is partial. The
 * report keeps its name in both cases; `report` may be NULL. Names what was written on `out` (NULL:
 * nowhere) and what is partial or failed on cli->err. Returns DALCS_E_IO when a file failed. */
enum dalcs_status dalcs_outputs_close(struct dalcs_outputs *outputs, const struct dalcs_cli *cli,
                                      FILE *out, const struct dalcs_report *report,
                                      enum dalcs_status run, bool complete) DALCS_MUST_CHECK;

/* Accepts a zeroed one. Files that were not closed are removed. */
void dalcs_outputs_finish(struct dalcs_outputs *outputs);

#endif

/* arguments.h - the command line of `dalcs run`. */
#ifndef DALCS_ARGUMENTS_H
#define DALCS_ARGUMENTS_H

#include "cli.h"

/* Strings are borrowed from argv but for the defaults, which are owned. What is 0 or NULL is the netlist's. */
struct dalcs_arguments {
    const char *netlist;
    const char *dialect; /* NULL: what the netlist shows */
    const char **set;    /* [n_set] "NAME=VALUE"; owned array */
    size_t n_set;
    enum dalcs_audit_mode audit;
    bool quiet, energy;
    bool help; /* asked for: nothing else is set */

    struct dalcs_file_arguments {
        const char **output; /* [n_outputs], at least one; owned array */
        size_t n_outputs;
        bool no_waveforms; /* -o none */
        bool ascii;        /* raw files as text */
        bool split_steps;  /* of .step into several plots of a raw file */
        bool all_signals;
        const char *report, *plot, *measures;
        const char *dump;
        char *default_output, *default_dump; /* NULL: not needed */
    } files;

    struct dalcs_method_arguments {
        const char *name;
        double tolerance;
        int stages;
        double step; /* s */
    } method;

    struct dalcs_row_arguments {
        double compress;
        double fill; /* INFINITY: none */
        const char *curve;
        const char *at; /* a file of times, or NULL */
        double *times;  /* [n_times] s, in any order; owned array */
        size_t n_times; /* that --at lists */
    } rows;

    struct dalcs_tran_arguments {
        const char *card; /* what .tran says */
        const char *stop; /* when it ends */
    } tran;

    struct dalcs_variant_arguments { /* of .step and .mc */
        size_t shard, n_shards;      /* this part of so many, from 1 on; 0 of 0: all */
        bool resume;                 /* go on with the table of a run that was ended */
        size_t jobs; /* steps that run at a time; 0: as many as there are processors */
        double seed; /* of random values; NAN: the netlist's */
        size_t only; /* this step alone, from 1 on; 0: all */
    } variants;

    struct dalcs_loss_arguments {
        bool is_asked;
        const char *plot; /* NULL: none */
        double from, to;  /* s; the first NAN: the netlist's window */
    } losses;

    struct dalcs_batch_arguments { /* as ngspice -b: outputs are raw files whatever their names, */
        bool is_asked;             /* tables are printed when there is none */
        const char **variable; /* [n_variables] what is set before a .control block; owned array */
        size_t n_variables;
        const char *log; /* where what is printed goes, or NULL */
    } batch;

    struct dalcs_steady_arguments {
        bool is_asked;                              /* the verb is `steady` */
        double period;                              /* s; 0: it follows from the sources */
        const char *multipliers_plot, *bifurcation; /* NULL: none */
        size_t samples, settle; /* periods, of a run looked at once in each; 0: none is */
        bool sensitivity;       /* as if there were a .sens */
    } steady;

    struct dalcs_envelope_arguments {
        bool is_asked; /* the verb is `envelope` */
        double stop;   /* s */
        double *show;  /* [n_show] s, whose periods it writes with all rows; owned array */
        size_t n_show;
    } envelope;

    struct dalcs_bode_arguments {
        bool is_asked;       /* the verb is `bode` */
        double from, to;     /* Hz; 0: the netlist's, else those that the orbit has */
        size_t points;       /* in a decade; 0: likewise */
        const char *loop;    /* NULL: the netlist's, else none */
        bool loop_is_loaded; /* by a voltage and a current */
        double sideband;
    } bode;
};

/* DALCS_E_OPTION when the command line makes no sense. Messages go to cli->err. */
enum dalcs_status dalcs_arguments_parse(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli, int argc,
                                        char **argv) DALCS_MUST_CHECK;

/* Are there times of rows, in a file or listed? */
static inline bool dalcs_arguments_have_times(const struct dalcs_arguments *arguments) {
    return arguments->rows.at != NULL || arguments->rows.n_times > 0;
}

void dalcs_arguments_finish(struct dalcs_arguments *arguments);

#endif

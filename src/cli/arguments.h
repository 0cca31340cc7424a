/* arguments.h - the command line of `dalcs run`. */
#ifndef DALCS_ARGUMENTS_H
#define DALCS_ARGUMENTS_H

#include "cli.h"

/* Strings are borrowed from argv but for the defaults, which are owned. */
struct dalcs_arguments {
    const char *netlist;
    const char **output; /* [n_outputs], at least one; owned array */
    size_t n_outputs;
    const char **set; /* [n_set] "NAME=VALUE"; owned array */
    size_t n_set;
    const char *dialect; /* NULL: what the netlist shows */
    const char *method;  /* NULL: the netlist's */
    double tolerance;    /* 0: the netlist's; so with the next three */
    int stages;
    double step; /* s */
    double compress;
    double fill;           /* INFINITY: none */
    const char *curve;     /* NULL: the netlist's */
    const char *at;        /* a file of times, or NULL */
    double *times;         /* [n_times] s, in any order; owned array */
    size_t n_times;        /* that --at lists */
    const char *transient; /* what .tran says; NULL: the netlist's */
    const char *tstop;     /* when it ends; NULL: likewise */
    const char *report, *plot, *measures;
    bool no_waveforms; /* -o none */
    size_t shard,
        n_shards; /* of the steps of .step: this part of so many, from 1 on; 0 of 0: all */
    bool resume;  /* go on with the table of a run that was ended */
    size_t jobs;  /* steps that run at a time; 0: as many as there are processors */
    double seed;  /* of random values; NAN: the netlist's */
    size_t only;  /* this step of .step alone, from 1 on; 0: all */
    const char *dump;
    char *default_output, *default_dump; /* NULL: not needed */
    bool quiet, all_signals, energy;
    bool losses;
    const char *losses_plot;       /* NULL: none */
    const char *multipliers_plot;  /* likewise */
    const char *bifurcation;       /* likewise */
    size_t samples, settle;        /* periods, of a run looked at once in each; 0: none is */
    double losses_from, losses_to; /* s; the first NAN: the netlist's window */
    enum dalcs_audit_mode audit;
    bool ascii; /* raw files as text */
    bool batch; /* as ngspice -b: outputs are raw files whatever their names, tables are printed
                        when there is none */
    const char *
        *variable; /* [n_variables] of -b: what is set before a .control block; owned array */
    size_t n_variables;
    const char *log; /* of -b: where what is printed goes, or NULL */
    bool steady;     /* the verb is `steady` */
    double period;   /* s, of it; 0: it follows from the sources */
    bool envelope;   /* the verb is `envelope` */
    double stop;     /* s, of it; 0: the netlist's */
    double *show;    /* [n_show] s, whose periods it writes with all rows; owned array */
    size_t n_show;
    bool bode;                 /* the verb is `bode` */
    double bode_from, bode_to; /* Hz; 0: the netlist's, else those that the orbit has */
    size_t bode_points;        /* in a decade; 0: likewise */
    const char *loop;          /* NULL: the netlist's, else none */
    bool sensitivity;          /* of dalcs steady: as if there were a .sens */
    bool loop_is_loaded;       /* by a voltage and a current */
    double sideband;           /* 0: likewise */
    bool split_steps;          /* of .step into several plots of a raw file */
    bool help;                 /* asked for: nothing else is set */
};

/* DALCS_E_OPTION when the command line makes no sense. Messages go to cli->err. */
enum dalcs_status dalcs_arguments_parse(struct dalcs_arguments *arguments,
                                        const struct dalcs_cli *cli, int argc,
                                        char **argv) DALCS_MUST_CHECK;

/* Are there times of rows, in a file or listed? */
static inline bool dalcs_arguments_have_times(const struct dalcs_arguments *arguments) {
    return arguments->at != NULL || arguments->n_times > 0;
}

void dalcs_arguments_finish(struct dalcs_arguments *arguments);

#endif

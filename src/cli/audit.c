/* audit.c - `dalcs audit`: check a file of waveforms against the laws of a netlist. */
#include "cli.h"

#include "audit_columns.h"
#include "audit_text.h"
#include "verb.h"
#include "waveforms.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const char help[] =
    "usage: dalcs audit NETLIST FILE [options]\n"
    "\n"
    "Checks whether the waveforms in FILE, a .raw or .csv file of dalcs, ngspice, LTspice or "
    "another\n"
    "program, are those of the netlist, without running it: Kirchhoff's current law at each node,\n"
    "the law of each element, diodes exactly ideal, each switch's position against its control.\n"
    "Prints which law is broken where and by how much, and which ones FILE has no signals for.\n"
    "\n"
    "      --tol T         the largest error allowed, over a signal's largest value (default:\n"
    "                      1e-3, the reltol of SPICE); digits of FILE and lines between its rows\n"
    "                      are allowed for besides\n"
    "      --plot N        which plot of a .raw file with several (default: the last with a time)\n"
    "      --run N         which run of .step, where the time starts again (default: 1)\n"
    "      --all           every law and every signal that is missing\n"
    "      --dialect ngspice|ltspice|xyce\n"
    "                      for which simulator the netlist was written (default: what it shows)\n"
    "      --json          all of it as JSON, by doc/audit.schema.json\n"
    "  -h, --help          this text\n"
    "\n"
    "examples:\n"
    "  dalcs audit buck.cir buck.raw\n"
    "  dalcs audit buck.cir buck.raw --tol 1e-6 --all\n"
    "  dalcs audit buck.cir buck.csv --json\n"
    "\n"
    "exit status: 0 ok, all laws hold, 1 one is broken, 2 usage or no such signals, 3 error in "
    "the\n"
    "netlist, 4 input/output\n";

enum { TOL = 256, PLOT, RUN, ALL, DIALECT, JSON };

static const struct option option[] = {
    {"tol", required_argument, NULL, TOL},
    {"plot", required_argument, NULL, PLOT},
    {"run", required_argument, NULL, RUN},
    {"all", no_argument, NULL, ALL},
    {"dialect", required_argument, NULL, DIALECT},
    {"json", no_argument, NULL, JSON},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

struct arguments {
    const char *netlist, *file, *dialect;
    double tolerance;
    size_t plot, run; /* 0: not given */
    bool all, json, help;
};

static enum dalcs_status take_files(struct arguments *arguments, const struct dalcs_cli *cli,
                                    int argc, char **argv) {
    if (argc - optind != 2) {
        dalcs_cli_error(cli, argc - optind < 2
                                 ? "a netlist and a file of waveforms are needed; see "
                                   "'dalcs audit --help'"
                                 : "one netlist and one file of waveforms at a time; "
                                   "see 'dalcs audit --help'");
        return DALCS_E_OPTION;
    }
    arguments->netlist = argv[optind];
    arguments->file = argv[optind + 1];
    return DALCS_OK;
}

static enum dalcs_status parse(struct arguments *arguments, const struct dalcs_cli *cli, int argc,
                               char **argv) {
    *arguments = (struct arguments){0};
    optind = 0; /* glibc: start afresh */
    opterr = 0;
    for (int code; (code = getopt_long(argc, argv, ":h", option, NULL)) != -1;) {
        switch (code) {
        case TOL:
            DALCS_TRY(dalcs_verb_take_positive(cli, "--tol", optarg, &arguments->tolerance));
            break;
        case PLOT:
            DALCS_TRY(dalcs_verb_take_count(cli, "--plot", optarg, &arguments->plot));
            break;
        case RUN:
            DALCS_TRY(dalcs_verb_take_count(cli, "--run", optarg, &arguments->run));
            break;
        case ALL:
            arguments->all = true;
            break;
        case DIALECT:
            DALCS_TRY(dalcs_verb_take_dialect(cli, optarg, &arguments->dialect));
            break;
        case JSON:
            arguments->json = true;
            break;
        case 'h':
            arguments->help = true;
            return DALCS_OK;
        default:
            return dalcs_verb_refuse(cli, "audit", option, code, argv);
        }
    }
    return take_files(arguments, cli, argc, argv);
}

/* ---- The file ------------------------------------------------------------------------------------ */

static bool is_rest(const struct dalcs_waveforms *w) {
    return strncasecmp(w->plot_name, "Operati", strlen("Operati")) ==
           0; /* ng- and LTspice's words */
}

static bool is_over_time(const struct dalcs_waveforms *w) {
    return !w->complex_values && (w->dimension[0].second == 1 || is_rest(w));
}

/* An operating point has no axis in a .raw file: it gets one at time 0. */
static enum dalcs_status add_time(struct dalcs_waveforms *w) {
    const size_t n = w->n_columns + 1;
    const struct dalcs_waveforms old = *w;
    double *value = dalcs_alloc(w->n_rows, n * sizeof *value);
    if (value == NULL || dalcs_waveforms_set_columns(w, n) != DALCS_OK) {
        free(value);
        return DALCS_E_NOMEM;
    }
    w->name[0] = "time";
    w->dimension[0] = (struct dalcs_dimension){.second = 1};
    for (size_t c = 1; c < n; c++) {
        w->name[c] = old.name[c - 1];
        w->dimension[c] = old.dimension[c - 1];
        w->precision[c] = old.precision[c - 1];
    }
    for (size_t k = 0; k < w->n_rows; k++) {
        memcpy(value + k * n + 1, w->value + k * (n - 1), (n - 1) * sizeof *value);
    }
    free(w->value);
    w->value = value;
    return DALCS_OK;
}

/* Tables of .step have what it changes before the time. */
static void put_time_first(struct dalcs_waveforms *w) {
    size_t c = 0;
    while (c + 1 < w->n_columns && w->dimension[c].second != 1) {
        c++;
    }
    if (c == 0 || w->dimension[c].second != 1) {
        return;
    }
    const char *name = w->name[0];
    const struct dalcs_dimension dimension = w->dimension[0];
    const struct dalcs_precision precision = w->precision[0];
    w->name[0] = w->name[c];
    w->dimension[0] = w->dimension[c];
    w->precision[0] = w->precision[c];
    w->name[c] = name;
    w->dimension[c] = dimension;
    w->precision[c] = precision;
    for (size_t k = 0; k < w->n_rows; k++) {
        double *row = w->value + k * w->n_columns;
        const double first = row[0];
        row[0] = row[c];
        row[c] = first;
    }
}

/* Reads it, with the time as its axis if it has one. */
static enum dalcs_status read_one(const struct arguments *arguments,
                                  struct dalcs_waveforms *waveforms, size_t plot,
                                  struct dalcs_diag *diag) {
    DALCS_TRY(dalcs_waveforms_read_file(waveforms, arguments->file, plot, diag));
    DALCS_TRY(dalcs_audit_take_units(waveforms));
    put_time_first(waveforms);
    return DALCS_OK;
}

/* The plot that was asked for, else the last one over time. */
static enum dalcs_status read_plot(const struct arguments *arguments,
                                   struct dalcs_waveforms *waveforms, struct dalcs_diag *diag) {
    size_t plot = arguments->plot;
    DALCS_TRY(read_one(arguments, waveforms, plot, diag));
    const size_t n_plots = waveforms->n_plots;
    for (plot = n_plots; plot > 0 && arguments->plot == 0 && !is_over_time(waveforms); plot--) {
        dalcs_waveforms_finish(waveforms);
        DALCS_TRY(read_one(arguments, waveforms, plot, diag));
    }
    if (!is_over_time(waveforms)) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL,
                       "'%s': the laws apply to waveforms over time, and the axis is '%s'",
                       arguments->file, waveforms->name[0]);
        return DALCS_E_OPTION;
    }
    return waveforms->dimension[0].second == 1 ? DALCS_OK : add_time(waveforms);
}

static enum dalcs_status read_file(const struct arguments *arguments,
                                   struct dalcs_waveforms *waveforms, struct dalcs_diag *diag) {
    DALCS_TRY(read_plot(arguments, waveforms, diag));
    size_t first = 0, end = 0, run = arguments->run > 0 ? arguments->run : 1;
    const size_t n = dalcs_waveforms_find_run(waveforms, run, &first, &end);
    if (waveforms->n_rows > 0 && run > n) {
        dalcs_diag_add(diag, DALCS_ERROR, NULL, NULL, "'%s' has %zu run%s: there is no run %zu",
                       arguments->file, n, n == 1 ? "" : "s", run);
        return DALCS_E_OPTION;
    }
    if (arguments->run == 0) {
        DALCS_TRY(dalcs_audit_check_order(waveforms, arguments->file, first, end, diag));
    }
    if (n > 1 && arguments->run == 0) {
        dalcs_diag_add(diag, DALCS_NOTE, NULL, NULL,
                       "time starts again: this is the first of %zu runs; --run N takes another",
                       n);
    }
    dalcs_waveforms_keep_rows(waveforms, first, end);
    dalcs_audit_note_gaps(waveforms, diag);
    return DALCS_OK;
}

/* ---- The audit ----------------------------------------------------------------------------------- */

static enum dalcs_status audit_table(const struct dalcs_cli *cli, const struct arguments *arguments,
                                     struct dalcs_session *session, const struct dalcs_waveforms *w,
                                     enum dalcs_exit *verdict) {
    double *precision = dalcs_alloc(2 * w->n_columns, sizeof *precision);
    for (size_t c = 0; c < w->n_columns && precision != NULL; c++) {
        precision[c] = w->precision[c].relative;
        precision[w->n_columns + c] = w->precision[c].absolute;
    }
    const struct dalcs_wave_table table = {w->n_columns, w->n_rows, w->name,
                                           w->value,     precision, precision + w->n_columns};
    const struct dalcs_table_audit_options options = {
        .tolerance = arguments->tolerance, .run = arguments->run > 0 ? arguments->run - 1 : 0};
    const struct dalcs_table_audit *audit = NULL;
    const enum dalcs_status status =
        precision != NULL ? dalcs_session_audit_table(session, &table, &options, &audit)
                          : DALCS_E_NOMEM;
    free(precision);
    if (status == DALCS_OK && arguments->json) {
        dalcs_audit_write_json(cli->out, audit, arguments->file);
    } else if (status == DALCS_OK) {
        dalcs_audit_write_text(cli->out, audit, arguments->file, arguments->all);
    }
    if (status == DALCS_OK) {
        *verdict = audit->n_broken > 0 ? DALCS_EXIT_RUN
                   : audit->n_laws > 0 ? DALCS_EXIT_OK
                                       : DALCS_EXIT_USAGE;
    }
    return status;
}

static void write_diag(const struct dalcs_cli *cli, const struct dalcs_diag *diag) {
    for (size_t k = 0; k < diag->n; k++) {
        fprintf(cli->err, "dalcs: %s\n", diag->item[k].text);
    }
}

static enum dalcs_status audit_file(const struct dalcs_cli *cli, const struct arguments *arguments,
                                    struct dalcs_session *session, enum dalcs_exit *verdict) {
    struct dalcs_diag diag = {0};
    struct dalcs_waveforms waveforms = {0};
    enum dalcs_status status = dalcs_verb_read(session, arguments->netlist, arguments->dialect);
    if (status == DALCS_OK) {
        status = read_file(arguments, &waveforms, &diag);
        write_diag(cli, &diag);
    }
    if (status == DALCS_OK) {
        status = audit_table(cli, arguments, session, &waveforms, verdict);
    }
    size_t n_written = 0;
    dalcs_cli_write_messages(cli, session, &n_written, true);
    if (status != DALCS_OK && n_written == 0 && diag.n == 0) {
        dalcs_cli_error(cli, "%s: %s", arguments->netlist, dalcs_status_text(status));
    }
    dalcs_waveforms_finish(&waveforms);
    dalcs_diag_finish(&diag);
    return status;
}

enum dalcs_exit dalcs_cli_audit(const struct dalcs_cli *cli, int argc, char **argv) {
    struct arguments arguments;
    enum dalcs_exit verdict = DALCS_EXIT_OK;
    enum dalcs_status status = parse(&arguments, cli, argc, argv);
    if (status == DALCS_OK && arguments.help) {
        fputs(help, cli->out);
    } else if (status == DALCS_OK) {
        struct dalcs_session *session = NULL;
        status = dalcs_session_create(&session);
        if (status == DALCS_OK) {
            status = audit_file(cli, &arguments, session, &verdict);
        } else {
            dalcs_cli_error(cli, "%s", dalcs_status_text(status));
        }
        dalcs_session_destroy(session);
    }
    return status == DALCS_OK ? verdict : dalcs_cli_exit(status);
}

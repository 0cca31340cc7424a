/* batch.c - `dalcs -b`: the command line of ngspice in batch mode, for scripts that have one.
 *
 *     dalcs -b -r out.raw -o log circuit.cir
 *     ngspice circuit.cir                         where the program is called so
 *
 * The order does not matter. Options for ngspice's shell have no meaning here. */
#include "batch.h"

#include "arguments.h"
#include "memory.h"
#include "paths.h"
#include "run.h"
#include "start_variables.h"
#include "verb.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: dalcs -b [-r FILE] [-o LOG] NETLIST\n"
    "\n"
    "Runs a netlist as ngspice does in batch mode, the options in any order.\n"
    "\n"
    "  -b, --batch         do this\n"
    "  -r, --rawfile FILE  write the waveforms as a raw file; without it the signals of .print "
    "and\n"
    "                      .plot are printed as tables\n"
    "  -o, --output LOG    write there what would be printed\n"
    "      --ascii         write the raw file as text; so does -D filetype=ascii\n"
    "  -D VARIABLE=VALUE   as `set` in a .control block, before it\n"
    "      --dialect ngspice|ltspice|xyce\n"
    "                      for which simulator the netlist was written (default: what it shows)\n"
    "  -n, --no-spiceinit  do not read .spiceinit\n"
    "  -a, -i, -p, -q, -s, -t TERMINAL\n"
    "                      are ngspice's and have no meaning here\n"
    "  -h, --help          this text\n"
    "\n"
    "Called by the name ngspice, the program needs no -b, -v prints what others look for, and the\n"
    "variables are set that ./.spiceinit or ~/.spiceinit sets. -p and -s are refused: they would\n"
    "read commands. Programs that send commands load libngspice.so.0, see dalcs as-ngspice "
    "--help.\n"
    "\n"
    "exit status: 0 ok, 1 the run failed, 2 usage, 3 error in the netlist, 4 input/output\n";

enum { ASCII = 256, DIALECT };

static const struct option option[] = {
    {"batch", no_argument, NULL, 'b'},          {"rawfile", required_argument, NULL, 'r'},
    {"output", required_argument, NULL, 'o'},   {"ascii", no_argument, NULL, ASCII},
    {"autorun", no_argument, NULL, 'a'},        {"no-spiceinit", no_argument, NULL, 'n'},
    {"interactive", no_argument, NULL, 'i'},    {"pipe", no_argument, NULL, 'p'},
    {"quiet", no_argument, NULL, 'q'},          {"server", no_argument, NULL, 's'},
    {"terminal", required_argument, NULL, 't'}, {"version", no_argument, NULL, 'v'},
    {"define", required_argument, NULL, 'D'},   {"dialect", required_argument, NULL, DIALECT},
    {"help", no_argument, NULL, 'h'},           {NULL, 0, NULL, 0},
};

struct batch {
    struct dalcs_arguments arguments;
    const char *log;
    bool help, version;
    bool is_ngspice; /* the program is called so */
    bool no_start_file;
    struct dalcs_start_variables variables;
};

bool dalcs_cli_is_batch(int argc, char **argv) {
    bool found = false;
    for (int i = 1; i < argc; i++) {
        found = found || strcmp(argv[i], "-b") == 0 || strcmp(argv[i], "--batch") == 0;
    }
    return found;
}

static const char *help_of(const struct batch *b) {
    return b->is_ngspice ? "ngspice --help" : "dalcs -b --help";
}

/* An option of ngspice's shell, which reads commands. */
static enum dalcs_status take_shell(const struct batch *b, const struct dalcs_cli *cli, int code) {
    if (b->is_ngspice && code != 'i') {
        dalcs_cli_error(
            cli,
            "-%c: dalcs in ngspice's place takes no commands from a pipe; a program that "
            "sends them can load libngspice.so.0 (dalcs as-ngspice)",
            code);
        return DALCS_E_OPTION;
    }
    fprintf(cli->err, "dalcs: note: -%c is for ngspice's shell and has no meaning here\n", code);
    return DALCS_OK;
}

static enum dalcs_status take(struct batch *b, const struct dalcs_cli *cli, int code,
                              const char *word) {
    switch (code) {
    case 'r':
        b->arguments.files.output[0] = optarg;
        b->arguments.files.n_outputs = 1;
        return DALCS_OK;
    case 'o':
        b->log = optarg;
        return DALCS_OK;
    case ASCII:
        b->arguments.files.ascii = true;
        return DALCS_OK;
    case DIALECT:
        return dalcs_verb_take_dialect(cli, optarg, &b->arguments.dialect);
    case 'h':
        b->help = true;
        return DALCS_OK;
    case 'b':
    case 'a': /* a batch run runs by itself */
    case 'q':
    case 't':
        return DALCS_OK;
    case 'n':
        b->no_start_file = true;
        return DALCS_OK;
    case 'i':
    case 'p':
    case 's':
        return take_shell(b, cli, code);
    case 'v':
        b->version = true;
        return DALCS_OK;
    case 'D':
        return dalcs_start_variables_take(&b->variables, optarg);
    case ':':
        dalcs_cli_error(cli, "option '%s' needs a value; see '%s'", word, help_of(b));
        return DALCS_E_OPTION;
    default:
        dalcs_cli_error(cli, "unknown option '%s'; see '%s'", word, help_of(b));
        return DALCS_E_OPTION;
    }
}

/* Up to -h or -v, which need no netlist. */
static enum dalcs_status parse(struct batch *b, const struct dalcs_cli *cli, int argc,
                               char **argv) {
    optind = 0; /* glibc: start afresh */
    opterr = 0;
    for (int code; (code = getopt_long(argc, argv, ":br:o:anipqst:vD:h", option, NULL)) != -1;) {
        DALCS_TRY(take(b, cli, code, argv[optind - 1]));
        if (b->help || b->version) {
            return DALCS_OK;
        }
    }
    if (optind == argc) {
        dalcs_cli_error(cli, "no netlist given%s; see '%s'",
                        b->is_ngspice ? ", and dalcs has no shell that waits for commands" : "",
                        help_of(b));
        return DALCS_E_OPTION;
    }
    if (optind != argc - 1) {
        dalcs_verb_one_too_many(cli, "-b", argv[argc - 1]);
        return DALCS_E_OPTION;
    }
    b->arguments.netlist = argv[optind];
    return DALCS_OK;
}

static enum dalcs_status run(const struct dalcs_cli *cli, struct batch *b) {
    b->variables.cli = cli;
    if (b->is_ngspice && !b->no_start_file) {
        DALCS_TRY(dalcs_start_variables_read(&b->variables));
    }
    return dalcs_cli_run_arguments(cli, &b->arguments);
}

/* The run, with what it prints in the log. */
static enum dalcs_status run_into_log(const struct dalcs_cli *cli, struct batch *b) {
    struct dalcs_cli logged = *cli;
    FILE *log = fopen(b->log, "w");
    if (log == NULL) {
        dalcs_cli_error(cli, "cannot write '%s': %s", b->log, strerror(errno));
        return DALCS_E_IO;
    }
    logged.out = log;
    logged.err = log;
    logged.err_is_terminal = false;
    enum dalcs_status status = run(&logged, b);
    bool failed = ferror(log) != 0;
    if (fclose(log) != 0 || failed) {
        dalcs_cli_error(cli, "cannot write '%s': %s", b->log, strerror(errno));
        return status == DALCS_OK ? DALCS_E_IO : status;
    }
    return status;
}

static enum dalcs_exit evaluate(const struct dalcs_cli *cli, int argc, char **argv,
                                bool is_ngspice) {
    struct batch b = {.arguments = {.batch.is_asked = true, .variants.seed = NAN},
                      .is_ngspice = is_ngspice};
    b.arguments.files.output = dalcs_alloc(1, sizeof *b.arguments.files.output);
    if (!b.arguments.files.output) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(DALCS_E_NOMEM));
        return DALCS_EXIT_RUN;
    }
    b.variables = (struct dalcs_start_variables){.cli = cli, .arguments = &b.arguments};
    enum dalcs_status status = parse(&b, cli, argc, argv);
    if (status == DALCS_OK && b.help) {
        fputs(help, cli->out);
    } else if (status == DALCS_OK && b.version) {
        fprintf(cli->out,
                "******\n** ngspice-39, for programs that look for it: this is dalcs %s\n******\n",
                dalcs_version());
    } else if (status == DALCS_OK) {
        b.arguments.batch.log = b.log;
        status = dalcs_paths_check(cli, &b.arguments);
        if (status == DALCS_OK) {
            status = b.log ? run_into_log(cli, &b) : run(cli, &b);
        }
    }
    dalcs_arguments_finish(&b.arguments);
    dalcs_start_variables_finish(&b.variables);
    return dalcs_cli_exit(status);
}

enum dalcs_exit dalcs_cli_batch(const struct dalcs_cli *cli, int argc, char **argv) {
    return evaluate(cli, argc, argv, false);
}

enum dalcs_exit dalcs_cli_ngspice(const struct dalcs_cli *cli, int argc, char **argv) {
    return evaluate(cli, argc, argv, true);
}

/* cli.c - finds the verb; help and version. */
#include "cli.h"

#include "batch.h"
#include "names.h"

#include <errno.h>
#include <stdarg.h>
#include <string.h>
#include <unistd.h>

static const struct verb {
    const char *name, *purpose;
    enum dalcs_exit (*function)(const struct dalcs_cli *cli, int argc, char **argv);
} verb[] = {
    {"run", "simulate a netlist and write its waveforms", dalcs_cli_run},
    {"steady", "the periodic steady state of a netlist and its stability", dalcs_cli_run},
    {"bode", "the frequency response around it, loop gain and margins", dalcs_cli_run},
    {"envelope", "a slow start over up to millions of periods, most of them left out",
     dalcs_cli_run},
    {"equations", "write the complementarity system of a netlist", dalcs_cli_equations},
    {"check", "what theory says of a netlist before it runs", dalcs_cli_check},
    {"audit", "check a file of waveforms against the laws of a netlist", dalcs_cli_audit},
    {"plot", "draw the waveforms of a file", dalcs_cli_plot},
    {"compare", "run a netlist here and in ngspice: errors, times, waveforms", dalcs_cli_compare},
    {"converge", "errors and orders of fixed steps", dalcs_cli_converge},
    {"as-ngspice", "run a program with dalcs in the place of ngspice", dalcs_cli_as_ngspice},
};

enum { N_VERBS = sizeof verb / sizeof verb[0] };

enum dalcs_exit dalcs_cli_exit(enum dalcs_status status) {
    switch (status) {
    case DALCS_OK:
        return DALCS_EXIT_OK;
    case DALCS_E_NETLIST:
        return DALCS_EXIT_NETLIST;
    case DALCS_E_OPTION:
        return DALCS_EXIT_USAGE;
    case DALCS_E_IO:
        return DALCS_EXIT_IO;
    default:
        return DALCS_EXIT_RUN;
    }
}

void dalcs_cli_error(const struct dalcs_cli *cli, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fputs("dalcs: error: ", cli->err);
    vfprintf(cli->err, format, arguments);
    fputc('\n', cli->err);
    va_end(arguments);
}

static void write_help(FILE *stream) {
    fputs("dalcs simulates circuits with ideal diodes and switches.\n"
          "\n"
          "usage: dalcs VERB [options], or dalcs FILE [options], which is dalcs run FILE\n"
          "\n",
          stream);
    for (int i = 0; i < N_VERBS; i++) {
        fprintf(stream, "  %-10s  %s\n", verb[i].name, verb[i].purpose);
    }
    fputs("\n"
          "  -h, --help     this text; 'dalcs help VERB' has the options and examples of a verb\n"
          "  -v, --version  the version\n"
          "  -b             as ngspice is called: dalcs -b --help\n"
          "\n"
          "examples:\n"
          "  dalcs run bridge.cir\n"
          "  dalcs help run\n"
          "  dalcs -b -r out.raw -o log bridge.cir\n"
          "\n"
          "exit status: 0 ok, 1 the run failed, 2 usage, 3 error in the netlist, 4 input/output\n",
          stream);
}

/* The verb that does what others call so; NULL: no such word. */
static const char *verb_for(const char *word) {
    static const char *const meant[][2] = {{"simulate", "run"},
                                           {"sim", "run"},
                                           {"tran", "run"},
                                           {"pss", "steady"},
                                           {"draw", "plot"},
                                           {"show", "plot"},
                                           {"view", "plot"},
                                           {"lcp", "equations"},
                                           {"matrix", "equations"},
                                           {"verify", "audit"},
                                           {"validate", "audit"},
                                           {"ngspice", "compare"},
                                           {"losses", "run --losses"},
                                           {"efficiency", "run --losses"},
                                           {"version", "--version"}};
    for (size_t k = 0; k < sizeof meant / sizeof meant[0]; k++) {
        if (strcmp(meant[k][0], word) == 0) {
            return meant[k][1];
        }
    }
    return NULL;
}

static enum dalcs_exit refuse_verb(const struct dalcs_cli *cli, const char *word) {
    const char *name[N_VERBS];
    for (int i = 0; i < N_VERBS; i++) {
        name[i] = verb[i].name;
    }
    if (word[0] == '-') {
        static const char *const option[] = {"--help", "--version"};
        const char *nearest = dalcs_names_nearest_of(option, 2, word);
        dalcs_cli_error(cli, "unknown option '%s'%s%s%s", word, nearest ? "; did you mean '" : "",
                        nearest ? nearest : "", nearest ? "'?" : "");
    } else {
        const char *nearest = verb_for(word);
        if (nearest == NULL && strpbrk(word, "./") != NULL) {
            dalcs_cli_error(cli, "cannot read '%s': %s", word, strerror(ENOENT));
            return DALCS_EXIT_IO;
        }
        nearest = nearest != NULL ? nearest : dalcs_names_nearest_of(name, N_VERBS, word);
        dalcs_cli_error(cli, "unknown verb '%s'%s%s%s", word, nearest ? "; did you mean '" : "",
                        nearest ? nearest : "", nearest ? "'?" : "; see 'dalcs --help'");
    }
    return DALCS_EXIT_USAGE;
}

static const struct verb *find_verb(const char *word) {
    for (int i = 0; i < N_VERBS; i++) {
        if (strcmp(word, verb[i].name) == 0) {
            return &verb[i];
        }
    }
    return NULL;
}

/* argv[0] is the verb. */
static enum dalcs_exit start_verb(const struct dalcs_cli *cli, int argc, char **argv) {
    const struct verb *found = find_verb(argv[0]);
    return found != NULL ? found->function(cli, argc, argv) : refuse_verb(cli, argv[0]);
}

/* Is that the name by which the program was called? */
static bool is_called(const char *name, const char *path) {
    const char *slash = strrchr(path, '/');
    return strcmp(slash != NULL ? slash + 1 : path, name) == 0;
}

enum dalcs_exit dalcs_cli_eval(const struct dalcs_cli *cli, int argc, char **argv) {
    if (argc > 0 && is_called("ngspice", argv[0])) {
        return dalcs_cli_ngspice(cli, argc, argv);
    }
    if (argc < 2) {
        write_help(cli->err);
        return DALCS_EXIT_USAGE;
    }
    const bool is_help = strcmp(argv[1], "help") == 0;
    if (is_help && argc > 2) {
        char help[] = "--help";
        char *asked[] = {argv[2], help, NULL};
        return start_verb(cli, 2, asked);
    }
    if (is_help || strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        write_help(cli->out);
        return DALCS_EXIT_OK;
    }
    if (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-v") == 0) { /* as of ngspice */
        fprintf(cli->out, "dalcs %s\n", dalcs_version());
        return DALCS_EXIT_OK;
    }
    if (find_verb(argv[1]) == NULL && dalcs_cli_is_batch(argc, argv)) {
        return dalcs_cli_batch(cli, argc, argv);
    }
    if (find_verb(argv[1]) == NULL &&
        (strcmp(argv[1], "-") == 0 || (argv[1][0] != '-' && access(argv[1], F_OK) == 0))) {
        return dalcs_cli_run(cli, argc, argv);
    }
    return start_verb(cli, argc - 1, argv + 1);
}

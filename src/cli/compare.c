/* compare.c - `dalcs compare`: the same netlist here and in ngspice. */
#include "cli.h"

#include "comparison.h"
#include "verb.h"

#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: dalcs compare FILE [options]\n"
    "\n"
    "Runs the .tran of a netlist here and in ngspice, with devices from ngspice's stock ones to\n"
    "nearly ideal ones, several tolerances and steps, and says how far each is off and how long "
    "it\n"
    "took. Errors are measured against radau with a tight tolerance, confirmed by another number "
    "of\n"
    "stages. Takes from seconds to some minutes.\n"
    "\n"
    "      --with NAME       ngspice, or the path of one (default: ngspice)\n"
    "      --methods LIST    of dalcs, separated by commas: auto, radau, euler (default: "
    "auto,euler);\n"
    "                        the first is the one that is compared signal by signal\n"
    "      --dialect ngspice|ltspice|xyce\n"
    "                        for which simulator the netlist was written (default: what it shows)\n"
    "  -o, --output FILE     write a page with tables, figures and both netlists: .html; the "
    "figures\n"
    "                        need gnuplot\n"
    "      --limit S         give up on a run of ngspice after that many seconds of CPU time\n"
    "                        (default: 2, or 100 times what dalcs takes)\n"
    "      --within X        fail (status 1) unless a setting of ngspice comes as near as that to "
    "the\n"
    "                        reference, and dalcs as well\n"
    "  -q, --quiet           print nothing but warnings and errors\n"
    "  -h, --help            this text\n"
    "\n"
    "examples:\n"
    "  dalcs compare buck.cir\n"
    "  dalcs compare buck.cir --methods auto,radau,euler -o buck.html\n"
    "  dalcs compare buck.cir --quiet --within 1e-2\n"
    "\n"
    "exit status: 0 ok, 1 the run failed, 2 usage, 3 error in the netlist, 4 input/output, no "
    "ngspice\n";

enum { WITH = 256, METHODS, DIALECT, LIMIT_OPTION, WITHIN };

static const struct option option[] = {
    {"with", required_argument, NULL, WITH},
    {"methods", required_argument, NULL, METHODS},
    {"dialect", required_argument, NULL, DIALECT},
    {"output", required_argument, NULL, 'o'},
    {"limit", required_argument, NULL, LIMIT_OPTION},
    {"within", required_argument, NULL, WITHIN},
    {"quiet", no_argument, NULL, 'q'},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

struct arguments {
    const char *netlist, *dialect, *with, *output;
    const char *method[DALCS_MAX_METHODS];
    size_t n_methods;
    double limit, within; /* s, and over a signal's scale; 0: not asked */
    bool quiet, help;
};

static enum dalcs_status take_methods(struct arguments *a, const struct dalcs_cli *cli,
                                      char *list) {
    bool fine = dalcs_verb_split(list, a->method, DALCS_MAX_METHODS, &a->n_methods) == DALCS_OK;
    for (size_t i = 0; i < a->n_methods && fine; i++) {
        bool known = false;
        for (size_t k = 0; dalcs_method_name(k); k++) {
            known = known || strcmp(dalcs_method_name(k), a->method[i]) == 0;
        }
        fine = known;
        for (size_t k = 0; k < i; k++) {
            fine = fine && strcmp(a->method[k], a->method[i]) != 0;
        }
    }
    if (!fine) {
        dalcs_cli_error(cli, "--methods: write auto, radau, euler or several of them, each once, "
                             "separated by commas");
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status take_with(struct arguments *a, const struct dalcs_cli *cli,
                                   const char *text) {
    if (strcmp(text, "ngspice") != 0 && !strchr(text, '/')) {
        dalcs_cli_error(cli, "--with: '%s' is neither ngspice nor the path of one", text);
        return DALCS_E_OPTION;
    }
    a->with = text;
    return DALCS_OK;
}

static enum dalcs_status take(struct arguments *a, const struct dalcs_cli *cli, int code,
                              char **argv) {
    switch (code) {
    case WITH:
        return take_with(a, cli, optarg);
    case METHODS:
        return take_methods(a, cli, optarg);
    case DIALECT:
        return dalcs_verb_take_dialect(cli, optarg, &a->dialect);
    case LIMIT_OPTION:
        return dalcs_verb_take_positive(cli, "--limit", optarg, &a->limit);
    case WITHIN:
        return dalcs_verb_take_positive(cli, "--within", optarg, &a->within);
    case 'o':
        a->output = optarg;
        return DALCS_OK;
    case 'q':
        a->quiet = true;
        return DALCS_OK;
    case 'h':
        a->help = true;
        return DALCS_OK;
    default:
        return dalcs_verb_refuse(cli, "compare", option, code, argv);
    }
}

static enum dalcs_status parse(struct arguments *a, const struct dalcs_cli *cli, int argc,
                               char **argv) {
    static const char *const ending[] = {".html", NULL};
    *a = (struct arguments){.with = "ngspice", .method = {"auto", "euler"}, .n_methods = 2};
    enum dalcs_status status = DALCS_OK;
    optind = 0; /* glibc: start afresh */
    opterr = 0;
    for (int code; status == DALCS_OK && !a->help &&
                   (code = getopt_long(argc, argv, ":o:qh", option, NULL)) != -1;) {
        status = take(a, cli, code, argv);
    }
    if (status == DALCS_OK && !a->help) {
        status = dalcs_verb_take_netlist(cli, "compare", argc, argv, &a->netlist);
    }
    if (status == DALCS_OK && !a->help && a->output) {
        status = dalcs_verb_check_output(cli, a->output, ending, a->netlist);
    }
    return status;
}

/* ---- The comparison -------------------------------------------------------------------------- */

static void show_trial(void *user, int n) {
    const struct dalcs_cli *cli = user;
    fprintf(cli->err, "\rngspice, setting %d\033[K", n);
    fflush(cli->err);
}

static enum dalcs_status judge(const struct dalcs_cli *cli, const struct arguments *a,
                               const struct dalcs_comparison *c) {
    double theirs = c->search.best >= 0 ? c->search.trial[c->search.best].deviation.worst_rms : 0.0;
    if (a->within > 0.0 &&
        (c->search.best < 0 || theirs > a->within || c->row[0].deviation.worst_rms > a->within)) {
        dalcs_cli_error(cli, "not within %g: dalcs is off by %.2e, ngspice %s%.2e", a->within,
                        c->row[0].deviation.worst_rms,
                        c->search.best < 0 ? "never gets to the end; " : "by ", theirs);
        return DALCS_NOT_CONVERGED;
    }
    return DALCS_OK;
}

static enum dalcs_status write_results(const struct dalcs_cli *cli, const struct arguments *a,
                                       const struct dalcs_comparison *c, FILE *page) {
    char message[256] = "";
    if (!a->quiet) {
        dalcs_comparison_write_text(cli->out, c);
    }
    if (a->output && dalcs_comparison_write_page(page, c, message) != DALCS_OK) {
        fprintf(cli->err, "dalcs: warning: '%s' has no figures: %s\n", a->output, message);
    }
    return judge(cli, a, c);
}

static enum dalcs_status compare(const struct dalcs_cli *cli, const struct arguments *a,
                                 struct dalcs_comparison *c, size_t n_messages) {
    struct dalcs_atomic_file file;
    enum dalcs_status status = dalcs_verb_begin_output(cli, &file, a->output);
    if (status != DALCS_OK) {
        return status;
    }
    c->search.user = (void *)cli;
    c->search.on_trial = cli->err_is_terminal ? show_trial : NULL;
    status = dalcs_comparison_make(c, a->method, (int)a->n_methods);
    fputs(cli->err_is_terminal ? "\r\033[K" : "", cli->err);
    enum dalcs_status agreed = DALCS_OK;
    if (status == DALCS_OK) {
        agreed = write_results(cli, a, c, file.stream);
    } else {
        dalcs_verb_explain(cli, c->session, n_messages, status);
    }
    status = dalcs_verb_end_output(cli, &file, a->output, status);
    return status == DALCS_OK ? agreed : status;
}

static enum dalcs_status open_and_compare(const struct dalcs_cli *cli, const struct arguments *a) {
    char message[DALCS_NGSPICE_TEXT_SIZE] = "";
    size_t n_messages = 0;
    struct dalcs_comparison *c = calloc(1, sizeof *c);
    struct dalcs_session *session = NULL;
    if (!c) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(DALCS_E_NOMEM));
        return DALCS_E_NOMEM;
    }
    enum dalcs_status status = dalcs_verb_open(cli, a->netlist, a->dialect, &session, &n_messages);
    if (status == DALCS_OK) {
        c->path = a->netlist;
        c->session = session;
        c->interrupted = cli->interrupted;
        status = dalcs_ngspice_open(&c->ngspice, a->with, a->limit, cli->interrupted, message);
        if (status == DALCS_OK) {
            status = compare(cli, a, c, n_messages);
        } else {
            dalcs_cli_error(cli, "%s", message[0] ? message : dalcs_status_text(status));
        }
    }
    dalcs_comparison_finish(c);
    free(c);
    dalcs_session_destroy(session);
    return status;
}

enum dalcs_exit dalcs_cli_compare(const struct dalcs_cli *cli, int argc, char **argv) {
    struct arguments arguments;
    enum dalcs_status status = parse(&arguments, cli, argc, argv);
    if (status == DALCS_OK && arguments.help) {
        fputs(help, cli->out);
    } else if (status == DALCS_OK) {
        status = open_and_compare(cli, &arguments);
    }
    return dalcs_cli_exit(status);
}

/* converge.c - `dalcs converge`: errors and orders of fixed steps. */
#include "cli.h"

#include "convergence.h"
#include "verb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define MAX_STEPS 2e7  /* of one run */
#define WHOLE     1e-6 /* how far a ratio of steps may be from a whole number, over itself */

enum { MOST_STEPS = 40, MOST_STEPPINGS = 8 };

static const char help[] =
    "usage: dalcs converge FILE --steps LIST [options]\n"
    "\n"
    "Runs the .tran of a netlist with fixed steps and prints errors and the orders that they "
    "show,\n"
    "against radau with a tight tolerance, confirmed by another number of stages. Errors are taken "
    "at\n"
    "ends of steps that all runs have, away from where diodes and switches change.\n"
    "\n"
    "      --steps LIST      in s: 1m..1u for each half of the one before, or 1m,100u,10u, each a\n"
    "                        whole part of the largest\n"
    "      --methods LIST    euler, radau (with 3, 5 and 7 stages), radau1, radau3, radau5, "
    "radau7,\n"
    "                        radau9, separated by commas (default: euler,radau)\n"
    "      --dialect ngspice|ltspice|xyce\n"
    "                        for which simulator the netlist was written (default: what it shows)\n"
    "  -o, --output FILE     write a page with a figure, drawn by gnuplot, .html, or the table, "
    ".csv\n"
    "  -q, --quiet           print nothing but warnings and errors\n"
    "  -h, --help            this text\n"
    "\n"
    "examples:\n"
    "  dalcs converge bridge.cir --steps 100u..1u\n"
    "  dalcs converge bridge.cir --steps 100u,50u,10u --methods euler -o bridge.html\n"
    "\n"
    "exit status: 0 ok, 1 the run failed, 2 usage, 3 error in the netlist, 4 input/output\n";

enum { STEPS = 256, METHODS, DIALECT };

static const struct option option[] = {
    {"steps", required_argument, NULL, STEPS},
    {"methods", required_argument, NULL, METHODS},
    {"output", required_argument, NULL, 'o'},
    {"quiet", no_argument, NULL, 'q'},
    {"dialect", required_argument, NULL, DIALECT},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

struct arguments {
    const char *netlist, *dialect, *output;
    double step[MOST_STEPS]; /* s, falling */
    size_t n_steps;
    struct dalcs_stepping stepping[MOST_STEPPINGS];
    size_t n_steppings;
    bool quiet, help;
};

/* ---- The command line ------------------------------------------------------------------------ */

static enum dalcs_status add_step(struct arguments *a, const struct dalcs_cli *cli,
                                  const char *text) {
    double step = 0.0;
    if (dalcs_parse_number(text, &step) != DALCS_OK || !(step > 0.0)) {
        dalcs_cli_error(cli, "--steps: '%s' is not a number greater than 0", text);
        return DALCS_E_OPTION;
    }
    a->step[a->n_steps++] = step;
    return DALCS_OK;
}

/* "1m..1u": halves, the last one not below the second. */
static enum dalcs_status take_range(struct arguments *a, const struct dalcs_cli *cli, char *from,
                                    char *dots) {
    *dots = '\0';
    enum dalcs_status status = add_step(a, cli, from);
    if (status == DALCS_OK) {
        status = add_step(a, cli, dots + 2);
    }
    if (status != DALCS_OK) {
        return status;
    }
    double last = a->step[1];
    if (last >= a->step[0]) {
        dalcs_cli_error(cli, "--steps: %s..%s must fall from the largest step to the smallest",
                        from, dots + 2);
        return DALCS_E_OPTION;
    }
    a->n_steps = 1;
    for (double step = 0.5 * a->step[0]; step >= last * (1.0 - WHOLE); step *= 0.5) {
        if (a->n_steps == MOST_STEPS) {
            dalcs_cli_error(cli, "--steps: more than %d steps", MOST_STEPS);
            return DALCS_E_OPTION;
        }
        a->step[a->n_steps++] = step;
    }
    return DALCS_OK;
}

static int fall(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

static enum dalcs_status take_list(struct arguments *a, const struct dalcs_cli *cli, char *list) {
    const char *part[MOST_STEPS];
    size_t n = 0;
    if (dalcs_verb_split(list, part, MOST_STEPS, &n) != DALCS_OK) {
        dalcs_cli_error(cli, "--steps: write 1m..1u or up to %d steps separated by commas",
                        MOST_STEPS);
        return DALCS_E_OPTION;
    }
    for (size_t i = 0; i < n; i++) {
        enum dalcs_status status = add_step(a, cli, part[i]);
        if (status != DALCS_OK) {
            return status;
        }
    }
    qsort(a->step, a->n_steps, sizeof *a->step, fall);
    for (size_t i = 1; i < n; i++) {
        double ratio = a->step[0] / a->step[i];
        if (a->step[i] == a->step[i - 1]) {
            dalcs_cli_error(cli, "--steps: %g s is given twice", a->step[i]);
            return DALCS_E_OPTION;
        }
        if (fabs(ratio - round(ratio)) > WHOLE * ratio) {
            dalcs_cli_error(
                cli, "--steps: %g s does not divide %g s: the steps would not end at common times",
                a->step[i], a->step[0]);
            return DALCS_E_OPTION;
        }
    }
    return DALCS_OK;
}

static enum dalcs_status take_steps(struct arguments *a, const struct dalcs_cli *cli, char *text) {
    char *dots = strstr(text, "..");
    a->n_steps = 0;
    return dots ? take_range(a, cli, text, dots) : take_list(a, cli, text);
}

static bool add_stepping(struct arguments *a, const char *method, int stages) {
    bool fits = a->n_steppings < MOST_STEPPINGS;
    for (size_t i = 0; i < a->n_steppings; i++) {
        fits = fits &&
               !(strcmp(a->stepping[i].method, method) == 0 && a->stepping[i].stages == stages);
    }
    if (fits) {
        a->stepping[a->n_steppings++] = (struct dalcs_stepping){method, stages};
    }
    return fits;
}

static bool add_method(struct arguments *a, const char *word) {
    if (strcmp(word, "euler") == 0) {
        return add_stepping(a, "euler", 0);
    }
    if (strcmp(word, "radau") == 0) {
        return add_stepping(a, "radau", 3) && add_stepping(a, "radau", 5) &&
               add_stepping(a, "radau", 7);
    }
    int stages = strlen(word) == 6 && strncmp(word, "radau", 5) == 0 ? word[5] - '0' : 0;
    return DALCS_HAS_STAGES(stages) && add_stepping(a, "radau", stages);
}

static enum dalcs_status take_methods(struct arguments *a, const struct dalcs_cli *cli,
                                      char *list) {
    const char *part[MOST_STEPPINGS];
    size_t n = 0;
    bool fine = dalcs_verb_split(list, part, MOST_STEPPINGS, &n) == DALCS_OK;
    a->n_steppings = 0;
    for (size_t i = 0; i < n && fine; i++) {
        fine = add_method(a, part[i]);
    }
    if (!fine) {
        dalcs_cli_error(cli,
                        "--methods: write euler, radau, radau1, radau3, radau5, radau7, radau9 or "
                        "several of them, each once, separated by commas");
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status take(struct arguments *a, const struct dalcs_cli *cli, int code,
                              char **argv) {
    switch (code) {
    case STEPS:
        return take_steps(a, cli, optarg);
    case METHODS:
        return take_methods(a, cli, optarg);
    case DIALECT:
        return dalcs_verb_take_dialect(cli, optarg, &a->dialect);
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
        return dalcs_verb_refuse(cli, "converge", option, code, argv);
    }
}

static enum dalcs_status parse(struct arguments *a, const struct dalcs_cli *cli, int argc,
                               char **argv) {
    static const char *const ending[] = {".html", ".csv", NULL};
    *a = (struct arguments){.stepping = {{"euler", 0}, {"radau", 3}, {"radau", 5}, {"radau", 7}},
                            .n_steppings = 4};
    enum dalcs_status status = DALCS_OK;
    optind = 0; /* glibc: start afresh */
    opterr = 0;
    for (int code; status == DALCS_OK && !a->help &&
                   (code = getopt_long(argc, argv, ":o:qh", option, NULL)) != -1;) {
        status = take(a, cli, code, argv);
    }
    if (status != DALCS_OK || a->help) {
        return status;
    }
    status = dalcs_verb_take_netlist(cli, "converge", argc, argv, &a->netlist);
    if (status == DALCS_OK && a->n_steps == 0) {
        dalcs_cli_error(cli, "no steps given: --steps 10u..100n");
        status = DALCS_E_OPTION;
    }
    if (status == DALCS_OK && a->output) {
        status = dalcs_verb_check_output(cli, a->output, ending, a->netlist);
    }
    return status;
}

/* ---- The study ------------------------------------------------------------------------------- */

static enum dalcs_status check_steps(const struct dalcs_cli *cli, const struct arguments *a,
                                     const struct dalcs_request *request) {
    double least = a->step[a->n_steps - 1];
    if (a->step[0] > 0.5 * request->stop) {
        dalcs_cli_error(cli, "--steps: %g s is more than half of the run, %g s", a->step[0],
                        request->stop);
        return DALCS_E_OPTION;
    }
    if (request->stop / least > MAX_STEPS) {
        dalcs_cli_error(cli, "--steps: %g s would take %.0e steps; the most is %.0e", least,
                        request->stop / least, MAX_STEPS);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static void write_output(const struct dalcs_cli *cli, const struct arguments *a,
                         const struct dalcs_convergence *c, FILE *stream) {
    char message[256] = "";
    if (strcasecmp(strrchr(a->output, '.'), ".csv") == 0) {
        dalcs_convergence_write_csv(stream, c);
    } else if (dalcs_convergence_write_page(stream, c, message) != DALCS_OK) {
        fprintf(cli->err, "dalcs: warning: '%s' has no figure: %s\n", a->output, message);
    }
}

static enum dalcs_status study(const struct dalcs_cli *cli, const struct arguments *a,
                               struct dalcs_convergence *c, size_t n_messages) {
    struct dalcs_atomic_file file;
    enum dalcs_status status = dalcs_verb_begin_output(cli, &file, a->output);
    if (status != DALCS_OK) {
        return status;
    }
    status = dalcs_convergence_make(c, a->step, a->n_steps, a->stepping, a->n_steppings);
    if (status == DALCS_OK && !a->quiet) {
        dalcs_convergence_write_text(cli->out, c);
    }
    if (status == DALCS_OK && a->output) {
        write_output(cli, a, c, file.stream);
    } else if (status == DALCS_E_OPTION) {
        dalcs_cli_error(cli,
                        "--steps: no multiple of %g s is far enough from the times where diodes or "
                        "switches change: begin with a smaller step",
                        a->step[0]);
    } else if (status != DALCS_OK) {
        dalcs_verb_explain(cli, c->session, n_messages, status);
    }
    return dalcs_verb_end_output(cli, &file, a->output, status);
}

enum dalcs_exit dalcs_cli_converge(const struct dalcs_cli *cli, int argc, char **argv) {
    struct arguments arguments;
    enum dalcs_status status = parse(&arguments, cli, argc, argv);
    if (status != DALCS_OK || arguments.help) {
        fputs(status == DALCS_OK ? help : "", cli->out);
        return dalcs_cli_exit(status);
    }
    struct dalcs_session *session = NULL;
    size_t n_messages = 0;
    status = dalcs_verb_open(cli, arguments.netlist, arguments.dialect, &session, &n_messages);
    if (status == DALCS_OK) {
        const struct dalcs_request request = dalcs_session_request(session);
        status = check_steps(cli, &arguments, &request);
    }
    if (status == DALCS_OK) {
        struct dalcs_convergence c = {
            .path = arguments.netlist, .session = session, .interrupted = cli->interrupted};
        status = study(cli, &arguments, &c, n_messages);
        dalcs_convergence_finish(&c);
    }
    dalcs_session_destroy(session);
    return dalcs_cli_exit(status);
}

/* check.c - `dalcs check`: what theory says of a netlist before it runs. */
#include "cli.h"

#include "check_json.h"
#include "check_text.h"
#include "memory.h"
#include "verb.h"

static const char help[] =
    "usage: dalcs check FILE [options]\n"
    "\n"
    "Prints what theory says of a netlist before it runs: whether a trajectory exists and is the\n"
    "only one, which source can make it jump, for which steps implicit Euler is solvable and\n"
    "whether it converges, whether the circuit is stable and passive, and if not, which elements\n"
    "supply the energy. Each claim has its theorem and numbers that prove it.\n"
    "\n"
    "      --step H    the step in s for the conditions on one step (default: .options\n"
    "                  step, else that of .tran, else 1u)\n"
    "      --all       every condition with its numbers and witnesses\n"
    "      --dialect ngspice|ltspice|xyce\n"
    "                  for which simulator the netlist was written (default: what it shows)\n"
    "      --json      all of it as JSON, by doc/check.schema.json\n"
    "  -h, --help      this text\n"
    "\n"
    "examples:\n"
    "  dalcs check bridge.cir\n"
    "  dalcs check bridge.cir --all\n"
    "  dalcs check bridge.cir --json\n"
    "\n"
    "exit status: 0 ok, whatever the answers, 1 the check failed, 2 usage, 3 error in the netlist, "
    "4\n"
    "input/output\n";

enum { STEP = 256, ALL, DIALECT, JSON };

static const struct option option[] = {
    {"step", required_argument, NULL, STEP},
    {"all", no_argument, NULL, ALL},
    {"dialect", required_argument, NULL, DIALECT},
    {"json", no_argument, NULL, JSON},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

struct arguments {
    const char *netlist, *dialect;
    double step;
    bool all, json, help;
};

static enum dalcs_status parse(struct arguments *arguments, const struct dalcs_cli *cli, int argc,
                               char **argv) {
    *arguments = (struct arguments){0};
    optind = 0; /* glibc: start afresh */
    opterr = 0;
    for (int code; (code = getopt_long(argc, argv, ":h", option, NULL)) != -1;) {
        switch (code) {
        case STEP:
            DALCS_TRY(dalcs_verb_take_positive(cli, "--step", optarg, &arguments->step));
            break;
        case DIALECT:
            DALCS_TRY(dalcs_verb_take_dialect(cli, optarg, &arguments->dialect));
            break;
        case ALL:
            arguments->all = true;
            break;
        case JSON:
            arguments->json = true;
            break;
        case 'h':
            arguments->help = true;
            return DALCS_OK;
        default:
            return dalcs_verb_refuse(cli, "check", option, code, argv);
        }
    }
    return dalcs_verb_take_netlist(cli, "check", argc, argv, &arguments->netlist);
}

static enum dalcs_status check_netlist(const struct dalcs_cli *cli,
                                       const struct arguments *arguments,
                                       struct dalcs_session *session) {
    const struct dalcs_check *check = NULL;
    enum dalcs_status status = dalcs_verb_read(session, arguments->netlist, arguments->dialect);
    if (status == DALCS_OK) {
        status = dalcs_session_check(session, arguments->step, &check);
    }
    size_t n_messages = 0;
    dalcs_cli_write_messages(cli, session, &n_messages, true); /* notes are about runs */
    if (status != DALCS_OK) {
        if (n_messages == 0) {
            dalcs_cli_error(cli, "%s: %s", arguments->netlist, dalcs_status_text(status));
        }
        return status;
    }
    if (arguments->json) {
        dalcs_check_write_json(cli->out, check);
    } else {
        dalcs_check_write_text(cli->out, check, arguments->all);
    }
    return DALCS_OK; /* main() sees whether the text could be written */
}

enum dalcs_exit dalcs_cli_check(const struct dalcs_cli *cli, int argc, char **argv) {
    struct arguments arguments;
    enum dalcs_status status = parse(&arguments, cli, argc, argv);
    if (status == DALCS_OK && arguments.help) {
        fputs(help, cli->out);
    } else if (status == DALCS_OK) {
        struct dalcs_session *session = NULL;
        status = dalcs_session_create(&session);
        if (status == DALCS_OK) {
            status = check_netlist(cli, &arguments, session);
        } else {
            dalcs_cli_error(cli, "%s", dalcs_status_text(status));
        }
        dalcs_session_destroy(session);
    }
    return dalcs_cli_exit(status);
}

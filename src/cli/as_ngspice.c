/* as_ngspice.c - `dalcs as-ngspice COMMAND`: for one command, dalcs stands where ngspice is looked for.
 *
 * A folder has the program under ngspice's name and libngspice.so.0; three variables lead there. */
#include "cli.h"

#include "memory.h"

#include <errno.h>
#include <libgen.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char help[] =
    "usage: dalcs as-ngspice COMMAND [ARGUMENT...]\n"
    "       dalcs as-ngspice\n"
    "\n"
    "Runs a command for which dalcs is ngspice: programs that start ngspice or load its library\n"
    "get dalcs in its place, and nothing else on the machine changes. Without a command: prints\n"
    "the settings, for a shell's eval.\n"
    "\n"
    "  PATH, LD_LIBRARY_PATH\n"
    "                      begin with the folder that has the program named ngspice and\n"
    "                      libngspice.so.0\n"
    "  NGSPICE_LIBRARY_PATH\n"
    "                      the library's file, as PySpice wants it\n"
    "  -h, --help          this text\n"
    "\n"
    "examples:\n"
    "  dalcs as-ngspice kicad\n"
    "  dalcs as-ngspice python3 with_pyspice.py\n"
    "  dalcs as-ngspice ngspice -b -r out.raw circuit.cir\n"
    "\n"
    "exit status: that of the command; 2 usage, 4 it cannot be started\n";

/* Where the folder is, seen from the program: where both are installed, and in a folder where they are built. */
static const char *const PLACE[] = {DALCS_NGSPICE_FOLDER, "src/ngspice_library"};

/* The folder with both, or an empty text. */
static void find_folder(char folder[PATH_MAX]) {
    char program[PATH_MAX];
    const ssize_t n = readlink("/proc/self/exe", program, sizeof program - 1);
    folder[0] = '\0';
    if (n <= 0) {
        return;
    }
    program[n] = '\0';
    const char *beside = dirname(program);
    for (size_t k = 0; k < sizeof PLACE / sizeof PLACE[0] && folder[0] == '\0'; k++) {
        char tried[2 * PATH_MAX + 64];
        char file[2 * PATH_MAX + 128];
        const bool is_absolute = PLACE[k][0] == '/';
        snprintf(tried, sizeof tried, "%s%s%s", is_absolute ? "" : beside, is_absolute ? "" : "/",
                 PLACE[k]);
        snprintf(file, sizeof file, "%s/libngspice.so.0", tried);
        if (access(file, R_OK) == 0 && realpath(tried, folder) == NULL) {
            folder[0] = '\0';
        }
    }
}

/* folder:before, in the environment. */
static bool put_first(const char *name, const char *folder) {
    const char *before = getenv(name);
    const bool has = before != NULL && before[0] != '\0';
    const size_t size = strlen(folder) + (has ? strlen(before) : 0) + 2;
    char *value = dalcs_alloc(size, 1);
    if (value == NULL) {
        return false;
    }
    snprintf(value, size, "%s%s%s", folder, has ? ":" : "", has ? before : "");
    const bool is_set = setenv(name, value, 1) == 0;
    free(value);
    return is_set;
}

static bool set_all(const char *folder) {
    char library[PATH_MAX + 32];
    snprintf(library, sizeof library, "%s/libngspice.so.0", folder);
    return put_first("PATH", folder) && put_first("LD_LIBRARY_PATH", folder) &&
           setenv("NGSPICE_LIBRARY_PATH", library, 1) == 0;
}

static void print_settings(FILE *out) {
    static const char *const name[] = {"PATH", "LD_LIBRARY_PATH", "NGSPICE_LIBRARY_PATH"};
    for (size_t k = 0; k < sizeof name / sizeof name[0]; k++) {
        fprintf(out, "export %s='", name[k]);
        for (const char *c = getenv(name[k]); *c != '\0'; c++) {
            fputs(*c == '\'' ? "'\\''" : (char[]){*c, '\0'}, out);
        }
        fputs("'\n", out);
    }
}

enum dalcs_exit dalcs_cli_as_ngspice(const struct dalcs_cli *cli, int argc, char **argv) {
    char folder[PATH_MAX];
    if (argc > 1 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)) {
        fputs(help, cli->out);
        return DALCS_EXIT_OK;
    }
    if (argc > 1 && argv[1][0] == '-') {
        dalcs_cli_error(cli, "unknown option '%s'; see 'dalcs as-ngspice --help'", argv[1]);
        return DALCS_EXIT_USAGE;
    }
    find_folder(folder);
    if (folder[0] == '\0') {
        dalcs_cli_error(cli, "there is no libngspice.so.0 beside this program: it was built with "
                             "-Dngspice_library=disabled");
        return DALCS_EXIT_IO;
    }
    if (!set_all(folder)) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(DALCS_E_NOMEM));
        return DALCS_EXIT_RUN;
    }
    if (argc < 2) {
        print_settings(cli->out);
        return DALCS_EXIT_OK;
    }
    fflush(cli->out);
    signal(SIGPIPE, SIG_DFL); /* what is ignored here would stay so in the command */
    signal(SIGXFSZ, SIG_DFL);
    execvp(argv[1], argv + 1);
    dalcs_cli_error(cli, "cannot run '%s': %s", argv[1], strerror(errno));
    return DALCS_EXIT_IO;
}

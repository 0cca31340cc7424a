/* equations.c - `dalcs equations`: the complementarity system of a netlist, or of a system file, for people
 * and for other programs. */
#include "cli.h"

#include "memory.h"
#include "names.h"
#include "verb.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: dalcs equations FILE [options]\n"
    "\n"
    "Writes the complementarity system of a netlist or of a system file: one semi-explicit DALCS\n"
    "for each part of the circuit, with the names of its elements.\n"
    "\n"
    "  -o, --output FILE   write to FILE instead of standard output\n"
    "      --format NAME   text, latex (a document), system (a system file: 'dalcs run' reads it\n"
    "                      back to the bit, and so the next two), json, or matrix-market (FILE, "
    "and\n"
    "                      a FILE.NAME.mtx for each matrix); default: text\n"
    "      --form NAME     dalcs (x' = ..., 0 = ..., 0 <= lambda _|_ w >= 0), lcs (the algebraic\n"
    "                      unknowns eliminated) or osnsp (the problem that a step of implicit "
    "Euler\n"
    "                      of length --step solves); default: dalcs\n"
    "      --step H        s, of --form osnsp; SPICE suffixes allowed\n"
    "      --dialect ngspice|ltspice|xyce\n"
    "                      for which simulator the netlist was written (default: what it shows)\n"
    "  -h, --help          this text\n"
    "\n"
    "examples:\n"
    "  dalcs equations bridge.cir\n"
    "  dalcs equations bridge.cir --format latex -o bridge.tex\n"
    "  dalcs equations bridge.cir --form osnsp --step 1u\n"
    "  dalcs equations bridge.cir --format system -o bridge.dalcs\n"
    "\n"
    "exit status: 0 ok, 1 it failed, 2 usage, 3 error in the netlist, 4 input/output\n";

struct request {
    const char *netlist, *output, *dialect;
    bool help;
    enum dalcs_equations_format format;
    enum dalcs_equations_form form;
    double step;
};

/* The files, complete before any gets its name. */
struct files {
    const struct dalcs_cli *cli;
    const char *output; /* NULL: standard output */
    struct dalcs_atomic_file *file;
    size_t n, capacity;
};

/* ---- The command line ----------------------------------------------------------------------- */

enum { FORMAT = 256, FORM, STEP, DIALECT };

static const struct option option[] = {
    {"output", required_argument, NULL, 'o'},
    {"format", required_argument, NULL, FORMAT},
    {"form", required_argument, NULL, FORM},
    {"step", required_argument, NULL, STEP},
    {"dialect", required_argument, NULL, DIALECT},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

static const char *const FORMATS[] = {[DALCS_EQUATIONS_TEXT] = "text",
                                      [DALCS_EQUATIONS_LATEX] = "latex",
                                      [DALCS_EQUATIONS_SYSTEM] = "system",
                                      [DALCS_EQUATIONS_JSON] = "json",
                                      [DALCS_EQUATIONS_MATRIX_MARKET] = "matrix-market"};
static const char *const FORMS[] = {
    [DALCS_FORM_DALCS] = "dalcs", [DALCS_FORM_LCS] = "lcs", [DALCS_FORM_ONE_STEP] = "osnsp"};

enum { N_FORMATS = sizeof FORMATS / sizeof *FORMATS, N_FORMS = sizeof FORMS / sizeof *FORMS };

static enum dalcs_status choose(const struct dalcs_cli *cli, const char *name,
                                const char *const *list, size_t n, const char *text, int *index) {
    for (*index = 0; *index < (int)n; ++*index) {
        if (strcmp(list[*index], text) == 0) {
            return DALCS_OK;
        }
    }
    /* One letter apart, an LCP is no LCS: it is what a step solves. */
    const char *nearest =
        strcmp(text, "lcp") == 0 ? "osnsp" : dalcs_names_nearest_of(list, n, text);
    fprintf(cli->err, "dalcs: error: %s: '%s' is none of", name, text);
    for (size_t k = 0; k < n; k++) {
        fprintf(cli->err, " %s", list[k]);
    }
    fprintf(cli->err, nearest == NULL ? "\n" : "; did you mean '%s'?\n", nearest);
    return DALCS_E_OPTION;
}

static enum dalcs_status take(struct request *r, const struct dalcs_cli *cli, int code,
                              char **argv) {
    int index = 0;
    switch (code) {
    case 'o':
        r->output = optarg;
        return DALCS_OK;
    case FORMAT:
        DALCS_TRY(choose(cli, "--format", FORMATS, N_FORMATS, optarg, &index));
        r->format = (enum dalcs_equations_format)index;
        return DALCS_OK;
    case FORM:
        DALCS_TRY(choose(cli, "--form", FORMS, N_FORMS, optarg, &index));
        r->form = (enum dalcs_equations_form)index;
        return DALCS_OK;
    case STEP:
        return dalcs_verb_take_positive(cli, "--step", optarg, &r->step);
    case DIALECT:
        return dalcs_verb_take_dialect(cli, optarg, &r->dialect);
    case 'h':
        r->help = true;
        return DALCS_OK;
    default:
        return dalcs_verb_refuse(cli, "equations", option, code, argv);
    }
}

static enum dalcs_status check(struct request *r, const struct dalcs_cli *cli, int argc,
                               char **argv) {
    DALCS_TRY(dalcs_verb_take_netlist(cli, "equations", argc, argv, &r->netlist));
    if (r->form == DALCS_FORM_ONE_STEP && r->step == 0.0) {
        dalcs_cli_error(cli, "--form osnsp is the problem of one step: give its length, --step H");
        return DALCS_E_OPTION;
    }
    if (r->form != DALCS_FORM_ONE_STEP && r->step > 0.0) {
        dalcs_cli_error(cli, "--step is for --form osnsp");
        return DALCS_E_OPTION;
    }
    if (r->form == DALCS_FORM_ONE_STEP && r->format == DALCS_EQUATIONS_SYSTEM) {
        dalcs_cli_error(cli, "one step is no system: --format text, latex, json or matrix-market");
        return DALCS_E_OPTION;
    }
    if (r->format == DALCS_EQUATIONS_MATRIX_MARKET && r->output == NULL) {
        dalcs_cli_error(cli, "--format matrix-market writes several files: name the first with -o");
        return DALCS_E_OPTION;
    }
    if (r->output != NULL && strcmp(r->output, r->netlist) == 0) {
        dalcs_cli_error(cli, "'%s' is the netlist itself: give another name with -o", r->output);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

static enum dalcs_status parse(struct request *r, const struct dalcs_cli *cli, int argc,
                               char **argv) {
    *r = (struct request){0};
    optind = 0; /* glibc: start afresh */
    opterr = 0;
    for (int code; !r->help && (code = getopt_long(argc, argv, ":o:h", option, NULL)) != -1;) {
        DALCS_TRY(take(r, cli, code, argv));
    }
    return r->help ? DALCS_OK : check(r, cli, argc, argv);
}

/* ---- Files --------------------------------------------------------------------------------- */

static const char *base_of(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

/* The part of a path that matrices share: without the ending. */
static size_t stem_length(const char *path) {
    const char *base = base_of(path);
    const char *dot = strrchr(base, '.');
    return dot != NULL && dot != base ? (size_t)(dot - path) : strlen(path);
}

static enum dalcs_status write_file(struct files *files, const char *path, const char *text,
                                    size_t length) {
    DALCS_TRY(dalcs_grow(&files->file, &files->capacity, files->n + 1, sizeof *files->file));
    struct dalcs_atomic_file *file = &files->file[files->n++];
    *file = (struct dalcs_atomic_file){0};
    enum dalcs_status status = dalcs_atomic_file_open(file, path);
    if (status == DALCS_OK && fwrite(text, 1, length, file->stream) != length) {
        file->error = errno;
        status = DALCS_E_IO;
    }
    if (status == DALCS_E_IO) {
        dalcs_cli_error(files->cli, "cannot write '%s': %s", path, strerror(file->error));
    }
    return status;
}

static enum dalcs_status receive(void *user, const char *suffix, const char *text, size_t length) {
    struct files *files = user;
    if (files->output == NULL) {
        bool written = fwrite(text, 1, length, files->cli->out) == length;
        return written ? DALCS_OK : DALCS_E_IO;
    }
    if (suffix[0] == '\0') {
        return write_file(files, files->output, text, length);
    }
    size_t stem = stem_length(files->output);
    char *path = dalcs_alloc(stem + strlen(suffix) + 1, 1);
    if (path == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(path, files->output, stem);
    strcpy(path + stem, suffix);
    enum dalcs_status status = write_file(files, path, text, length);
    free(path);
    return status;
}

/* All of them, or none. */
static enum dalcs_status close_files(struct files *files, enum dalcs_status status) {
    for (size_t k = 0; k < files->n; k++) {
        struct dalcs_atomic_file *file = &files->file[k];
        if (status == DALCS_OK) {
            status = dalcs_atomic_file_commit(file);
            if (status == DALCS_E_IO) {
                dalcs_cli_error(files->cli, "cannot write '%s': %s", files->output,
                                strerror(file->error));
            }
        }
        dalcs_atomic_file_discard(file);
    }
    free(files->file);
    return status;
}

/* ---- The verb ------------------------------------------------------------------------------ */

static enum dalcs_status write_equations(const struct request *r, const struct dalcs_cli *cli,
                                         struct dalcs_session *session, size_t *n_written) {
    struct files files = {.cli = cli, .output = r->output};
    const char *base = r->output == NULL ? "" : base_of(r->output);
    size_t length = stem_length(base);
    char *stem = dalcs_alloc(length + 1, 1);
    if (stem == NULL) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(DALCS_E_NOMEM));
        return DALCS_E_NOMEM;
    }
    memcpy(stem, base, length);
    const struct dalcs_equations_options options = {.format = r->format,
                                                    .form = r->form,
                                                    .step = r->step,
                                                    .stem = stem,
                                                    .user = &files,
                                                    .file = receive};
    enum dalcs_status status = dalcs_session_equations(session, &options);
    size_t n_before = *n_written;
    dalcs_cli_write_messages(cli, session, n_written, false);
    if (status == DALCS_E_NOMEM ||
        (status != DALCS_OK && status != DALCS_E_IO && *n_written == n_before)) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(status));
    }
    status = close_files(&files, status);
    free(stem);
    return status;
}

enum dalcs_exit dalcs_cli_equations(const struct dalcs_cli *cli, int argc, char **argv) {
    struct request request;
    enum dalcs_status status = parse(&request, cli, argc, argv);
    if (status != DALCS_OK) {
        return dalcs_cli_exit(status);
    }
    if (request.help) {
        fputs(help, cli->out);
        return DALCS_EXIT_OK;
    }
    struct dalcs_session *session = NULL;
    size_t n_written = 0;
    status = dalcs_session_create(&session);
    if (status == DALCS_OK) {
        status = dalcs_verb_read(session, request.netlist, request.dialect);
        dalcs_cli_write_messages(cli, session, &n_written, false);
    }
    if (status == DALCS_E_NOMEM || (status != DALCS_OK && n_written == 0)) {
        dalcs_cli_error(cli, "%s: %s", request.netlist, dalcs_status_text(status));
    }
    if (status == DALCS_OK) {
        status = write_equations(&request, cli, session, &n_written);
    }
    dalcs_session_destroy(session);
    return dalcs_cli_exit(status);
}

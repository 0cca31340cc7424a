/* verb.c - refusals, the netlist, the output file. */
#include "verb.h"

#include "names.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { MOST_OPTIONS = 64 };

enum dalcs_status dalcs_verb_refuse(const struct dalcs_cli *cli, const char *verb,
                                    const struct option *option, int code, char **argv) {
    const char *word = argv[optind - 1];
    bool is_long = strncmp(word, "--", 2) == 0;
    if (code == ':') {
        dalcs_cli_error(cli, "option '%s' needs a value; see 'dalcs %s --help'", word, verb);
    } else if (is_long && strchr(word, '=') && optopt != 0) {
        dalcs_cli_error(cli, "option '%.*s' takes no value", (int)strcspn(word, "="), word);
    } else if (is_long) {
        const char *name[MOST_OPTIONS];
        size_t n = 0;
        for (; n < MOST_OPTIONS && option[n].name; n++) {
            name[n] = option[n].name;
        }
        char typed[64];
        snprintf(typed, sizeof typed, "%.*s", (int)strcspn(word + 2, "="), word + 2);
        const char *nearest = dalcs_names_nearest_of(name, n, typed);
        if (nearest) {
            dalcs_cli_error(cli, "unknown option '--%s'; did you mean '--%s'?", typed, nearest);
        } else {
            dalcs_cli_error(cli, "unknown option '--%s'; see 'dalcs %s --help'", typed, verb);
        }
    } else {
        dalcs_cli_error(cli, "unknown option '-%c'; see 'dalcs %s --help'", optopt, verb);
    }
    return DALCS_E_OPTION;
}

/* The option that a word was probably meant for, else NULL. */
static const char *option_for(const char *word) {
    static const char *const outputs[] = {".csv", ".raw", ".svg", ".png", ".pdf", ".html"};
    const char *dot = strrchr(word, '.');
    for (size_t k = 0; dot != NULL && k < sizeof outputs / sizeof outputs[0]; k++) {
        if (strcasecmp(dot, outputs[k]) == 0) {
            return k < 2 || k == 5 ? "-o " : "--plot ";
        }
    }
    return strchr(word, '=') != NULL                                       ? "--set "
           : word[0] >= '0' && word[0] <= '9' && strchr(word, ':') != NULL ? "--losses="
                                                                           : NULL;
}

void dalcs_verb_one_too_many(const struct dalcs_cli *cli, const char *verb, const char *word) {
    const bool is_plot = strcmp(verb, "plot") == 0;
    const bool is_run = strcmp(verb, "run") == 0 || strcmp(verb, "steady") == 0;
    const char *option = is_run || is_plot ? option_for(word) : NULL;
    if (option != NULL && is_plot) {
        option = "-o "; /* of a file of waveforms */
    }
    dalcs_cli_error(cli, "one %s at a time: '%s' is one too many%s%s%s%s",
                    is_plot ? "file" : "netlist", word, option != NULL ? "; did you mean '" : "",
                    option != NULL ? option : "", option != NULL ? word : "",
                    option != NULL ? "'?" : "");
}

enum dalcs_status dalcs_verb_take_netlist(const struct dalcs_cli *cli, const char *verb, int argc,
                                          char **argv, const char **netlist) {
    if (optind == argc) {
        dalcs_cli_error(cli, "no netlist given; see 'dalcs %s --help'", verb);
        return DALCS_E_OPTION;
    }
    if (optind != argc - 1) {
        dalcs_verb_one_too_many(cli, verb, argv[argc - 1]);
        return DALCS_E_OPTION;
    }
    *netlist = argv[optind];
    return DALCS_OK;
}

enum dalcs_status dalcs_verb_take_positive(const struct dalcs_cli *cli, const char *name,
                                           const char *text, double *value) {
    if (dalcs_parse_number(text, value) != DALCS_OK || !(*value > 0.0)) {
        dalcs_cli_error(cli, "%s: '%s' is not a number greater than 0", name, text);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_verb_take_count(const struct dalcs_cli *cli, const char *name,
                                        const char *text, size_t *count) {
    char *rest = NULL;
    long value = strtol(text, &rest, 10);
    if (rest == text || *rest != '\0' || value < 1) {
        dalcs_cli_error(cli, "%s: '%s' is not a number from 1 on", name, text);
        return DALCS_E_OPTION;
    }
    *count = (size_t)value;
    return DALCS_OK;
}

enum dalcs_status dalcs_verb_take_dialect(const struct dalcs_cli *cli, const char *text,
                                          const char **dialect) {
    for (size_t n = 0; dalcs_dialect_name(n); n++) {
        if (strcmp(dalcs_dialect_name(n), text) == 0) {
            *dialect = text;
            return DALCS_OK;
        }
    }
    fprintf(cli->err, "dalcs: error: --dialect: unknown dialect '%s'; the dialects are:", text);
    for (size_t n = 0; dalcs_dialect_name(n); n++) {
        fprintf(cli->err, " %s", dalcs_dialect_name(n));
    }
    fputc('\n', cli->err);
    return DALCS_E_OPTION;
}

/* Files that it includes are found from the current folder. */
static enum dalcs_status read_standard_input(struct dalcs_session *session) {
    char *text = NULL;
    size_t length = 0, capacity = 0, n = 0;
    enum dalcs_status status = DALCS_OK;
    do {
        length += n;
        status = dalcs_grow(&text, &capacity, length + BUFSIZ, 1);
        n = status == DALCS_OK ? fread(text + length, 1, BUFSIZ, stdin) : 0;
    } while (n > 0);
    if (status == DALCS_OK) {
        status =
            ferror(stdin) ? DALCS_E_IO : dalcs_session_read_text(session, "stdin", text, length);
    }
    free(text);
    return status;
}

enum dalcs_status dalcs_verb_read(struct dalcs_session *session, const char *netlist,
                                  const char *dialect) {
    DALCS_TRY(dalcs_session_set_dialect(session, dialect));
    return strcmp(netlist, "-") == 0 ? read_standard_input(session)
                                     : dalcs_session_read_file(session, netlist);
}

static bool is_same_file(const char *a, const char *b) {
    struct stat first, second;
    return stat(a, &first) == 0 && stat(b, &second) == 0 && first.st_dev == second.st_dev &&
           first.st_ino == second.st_ino;
}

enum dalcs_status dalcs_verb_check_output(const struct dalcs_cli *cli, const char *path,
                                          const char *const *ending, const char *netlist) {
    const char *dot = strrchr(path, '.');
    bool known = false;
    for (size_t i = 0; ending[i]; i++) {
        known = known || (dot && strcasecmp(dot, ending[i]) == 0);
    }
    if (!known) {
        dalcs_cli_error(cli, "unknown format of '%s': name it %s%s%s", path, ending[0],
                        ending[1] ? " or " : "", ending[1] ? ending[1] : "");
        return DALCS_E_OPTION;
    }
    if (is_same_file(path, netlist)) {
        dalcs_cli_error(cli, "'%s' is the netlist: it would be overwritten", path);
        return DALCS_E_OPTION;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_verb_split(char *list, const char **part, size_t most, size_t *n) {
    *n = 0;
    for (char *c = list;;) {
        size_t length = strcspn(c, ",");
        bool is_last = c[length] == '\0';
        if (length == 0 || *n == most) {
            return DALCS_E_OPTION;
        }
        c[length] = '\0';
        part[(*n)++] = c;
        if (is_last) {
            return DALCS_OK;
        }
        c += length + 1;
    }
}

enum dalcs_status dalcs_verb_open(const struct dalcs_cli *cli, const char *netlist,
                                  const char *dialect, struct dalcs_session **session,
                                  size_t *n_messages) {
    enum dalcs_status status = dalcs_session_create(session);
    if (status != DALCS_OK) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(status));
        return status;
    }
    status = dalcs_verb_read(*session, netlist, dialect);
    *n_messages = 0;
    dalcs_cli_write_messages(cli, *session, n_messages, true);
    if (status == DALCS_OK && !dalcs_session_request(*session).transient) {
        dalcs_cli_error(cli, "%s has no .tran: there are no waveforms to compare", netlist);
        status = DALCS_E_NETLIST;
    } else if (status != DALCS_OK && *n_messages == 0) {
        dalcs_cli_error(cli, "%s: %s", netlist, dalcs_status_text(status));
    }
    return status;
}

void dalcs_verb_explain(const struct dalcs_cli *cli, const struct dalcs_session *session,
                        size_t n_messages, enum dalcs_status status) {
    bool said = false;
    for (size_t i = n_messages; i < dalcs_session_n_messages(session); i++) {
        enum dalcs_level level = DALCS_LEVEL_NOTE;
        const char *text = dalcs_session_message(session, i, &level);
        if (level == DALCS_LEVEL_ERROR) {
            dalcs_cli_write_message(cli, text);
            said = true;
        }
    }
    if (status == DALCS_E_CANCELLED) {
        fputs("dalcs: interrupted\n", cli->err);
    } else if (!said) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(status));
    }
}

static enum dalcs_status complain(const struct dalcs_cli *cli, const char *path,
                                  const struct dalcs_atomic_file *file) {
    dalcs_cli_error(cli, "cannot write '%s': %s", path, strerror(file->error));
    return DALCS_E_IO;
}

enum dalcs_status dalcs_verb_begin_output(const struct dalcs_cli *cli,
                                          struct dalcs_atomic_file *file, const char *path) {
    *file = (struct dalcs_atomic_file){0};
    return !path || dalcs_atomic_file_open(file, path) == DALCS_OK ? DALCS_OK
                                                                   : complain(cli, path, file);
}

enum dalcs_status dalcs_verb_end_output(const struct dalcs_cli *cli, struct dalcs_atomic_file *file,
                                        const char *path, enum dalcs_status so_far) {
    if (so_far != DALCS_OK || !path) {
        dalcs_atomic_file_discard(file);
        return so_far;
    }
    return dalcs_atomic_file_commit(file) == DALCS_OK ? DALCS_OK : complain(cli, path, file);
}

/* paths.c - compares files by where they are, not by how they are spelled: "a.csv" is "./a.csv", and
 * a link is what it leads to. */
#include "paths.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { N_INPUTS = 2, N_OTHER_RESULTS = 4 };

/* A file that exists, or a name in a folder. */
struct place {
    bool known;
    dev_t device;
    ino_t inode;
    const char *name; /* "" for a file that exists */
};

static struct place find_place(const char *path) {
    struct stat status;
    struct place place = {.name = ""};
    bool exists = stat(path, &status) == 0;
    if (!exists) {
        const char *slash = strrchr(path, '/');
        char folder[PATH_MAX] = ".";
        size_t length = slash ? (size_t)(slash + 1 - path) : 1;
        if (length >= sizeof folder) {
            return place;
        }
        memcpy(folder, slash ? path : ".", length);
        folder[length] = '\0';
        if (stat(folder, &status) != 0) {
            return place;
        }
        place.name = slash ? slash + 1 : path;
    }
    place.known = true;
    place.device = status.st_dev;
    place.inode = status.st_ino;
    return place;
}

static bool is_same(const char *a, const char *b) {
    struct place p = find_place(a), q = find_place(b);
    return p.known && q.known && p.device == q.device && p.inode == q.inode &&
           strcmp(p.name, q.name) == 0;
}

static enum dalcs_status check_readable(const struct dalcs_cli *cli, const char *path) {
    struct stat status;
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    int error = descriptor < 0 ? errno : 0;
    if (error == 0 && fstat(descriptor, &status) != 0) {
        error = errno;
    } else if (error == 0 && S_ISDIR(status.st_mode)) {
        error = EISDIR;
    }
    if (descriptor >= 0) {
        close(descriptor);
    }
    if (error != 0) {
        dalcs_cli_error(cli, "cannot read '%s': %s", path, strerror(error));
        return DALCS_E_IO;
    }
    return DALCS_OK;
}

static const char *result_path(const struct dalcs_arguments *arguments, size_t i) {
    const char *const other[N_OTHER_RESULTS] = {arguments->report, arguments->plot, arguments->dump,
                                                arguments->log};
    return i < arguments->n_outputs ? arguments->output[i] : other[i - arguments->n_outputs];
}

/* Result i against what is read and against the results before it. */
static enum dalcs_status check_result(const struct dalcs_cli *cli,
                                      const struct dalcs_arguments *arguments, size_t i) {
    const char *path = result_path(arguments, i);
    if (is_same(path, arguments->netlist)) {
        dalcs_cli_error(cli, "'%s' is the netlist itself: give another name with -o", path);
        return DALCS_E_OPTION;
    }
    if (arguments->at && is_same(path, arguments->at)) {
        dalcs_cli_error(cli, "'%s' holds the times of --at: it would be overwritten", path);
        return DALCS_E_OPTION;
    }
    for (size_t j = 0; j < i; j++) {
        const char *other = result_path(arguments, j);
        if (other && is_same(path, other)) {
            dalcs_cli_error(cli, "'%s' is given for two results", path);
            return DALCS_E_OPTION;
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_paths_check(const struct dalcs_cli *cli,
                                    const struct dalcs_arguments *arguments) {
    const char *const input[N_INPUTS] = {arguments->netlist, arguments->at};
    enum dalcs_status status = DALCS_OK;
    for (size_t i = 0; status == DALCS_OK && i < N_INPUTS; i++) {
        status = input[i] ? check_readable(cli, input[i]) : DALCS_OK;
    }
    for (size_t i = 0; status == DALCS_OK && i < arguments->n_outputs + N_OTHER_RESULTS; i++) {
        status = result_path(arguments, i) ? check_result(cli, arguments, i) : DALCS_OK;
    }
    return status;
}

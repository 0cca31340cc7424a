/* paths.c - compares files by where they are, not by how they are spelled: "a.csv" is "./a.csv", and
 * a link is what it leads to. */
#include "paths.h"

#include "memory.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { N_INPUTS = 2, N_OTHER_RESULTS = 5 };

/* A file that exists, or a name in a folder. */
struct place {
    bool known;
    dev_t device;
    ino_t inode;
    const char *name; /* "" for a file that exists */
};

static void take_place(struct place *place, const struct stat *status, const char *name) {
    *place = (struct place){true, status->st_dev, status->st_ino, name};
}

static void find_place(const char *path, struct place *place) {
    struct stat status;
    *place = (struct place){.name = ""};
    if (stat(path, &status) == 0) {
        take_place(place, &status, "");
        return;
    }
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, (size_t)(slash + 1 - path)) : NULL;
    if ((folder || !slash) && stat(folder ? folder : ".", &status) == 0) {
        take_place(place, &status, slash ? slash + 1 : path);
    }
    free(folder);
}

static bool is_same(const struct place *p, const struct place *q) {
    return p->known && q->known && p->device == q->device && p->inode == q->inode &&
           strcmp(p->name, q->name) == 0;
}

static enum dalcs_status check_readable(const struct dalcs_cli *cli, const char *path,
                                        struct place *place) {
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
    take_place(place, &status, "");
    return DALCS_OK;
}

static const char *result_path(const struct dalcs_arguments *arguments, size_t i) {
    const char *const other[N_OTHER_RESULTS] = {arguments->files.report, arguments->files.plot,
                                                arguments->files.dump, arguments->batch.log,
                                                arguments->files.measures};
    return i < arguments->files.n_outputs ? arguments->files.output[i]
                                          : other[i - arguments->files.n_outputs];
}

/* Result i against what is read and against the results before it. */
static enum dalcs_status check_result(const struct dalcs_cli *cli,
                                      const struct dalcs_arguments *arguments,
                                      const struct place *input, struct place *result, size_t i) {
    const char *path = result_path(arguments, i);
    find_place(path, &result[i]);
    if (is_same(&result[i], &input[0])) {
        dalcs_cli_error(cli, "'%s' is the netlist itself: give another name with -o", path);
        return DALCS_E_OPTION;
    }
    if (is_same(&result[i], &input[1])) {
        dalcs_cli_error(cli, "'%s' holds the times of --at: it would be overwritten", path);
        return DALCS_E_OPTION;
    }
    for (size_t j = 0; j < i; j++) {
        if (is_same(&result[i], &result[j])) {
            dalcs_cli_error(cli, "'%s' is given for two results", path);
            return DALCS_E_OPTION;
        }
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_paths_check(const struct dalcs_cli *cli,
                                    const struct dalcs_arguments *arguments) {
    const char *const path[N_INPUTS] = {arguments->netlist, arguments->rows.at};
    const size_t n_results = arguments->files.n_outputs + N_OTHER_RESULTS;
    struct place input[N_INPUTS] = {{.known = false}};
    struct place *result = dalcs_alloc(n_results, sizeof *result);
    enum dalcs_status status = result ? DALCS_OK : DALCS_E_NOMEM;
    if (!result) {
        dalcs_cli_error(cli, "%s", dalcs_status_text(status));
    }
    for (size_t i = 0; status == DALCS_OK && i < N_INPUTS; i++) {
        status = path[i] && strcmp(path[i], "-") != 0 ? check_readable(cli, path[i], &input[i])
                                                      : DALCS_OK;
    }
    for (size_t i = 0; status == DALCS_OK && i < n_results; i++) {
        status =
            result_path(arguments, i) ? check_result(cli, arguments, input, result, i) : DALCS_OK;
    }
    free(result);
    return status;
}

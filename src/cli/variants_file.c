/* variants_file.c - a table that is written row by row and gone on with. */
#include "variants_file.h"

#include "atomic_file.h"
#include "variants_crash.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static enum dalcs_status fail(const struct dalcs_cli *cli, const char *path, int error) {
    dalcs_cli_error(cli, "cannot write '%s': %s", path, strerror(error));
    return DALCS_E_IO;
}

/* The next line, which getline() may move: false where it has no end. */
static bool read_line(FILE *from, char **line, size_t *capacity, ssize_t *length) {
    *length = getline(line, capacity, from);
    return *length > 0 && (*line)[*length - 1] == '\n';
}

/* Is the last cell empty? */
static bool is_good(const char *line, ssize_t length) {
    return length >= 2 && line[length - 2] == ',';
}

static enum dalcs_status refuse_rows(const struct dalcs_cli *cli, const char *path) {
    dalcs_cli_error(
        cli,
        "'%s' is a table of other variants or other measurements: remove it, give another "
        "name, or leave --resume out",
        path);
    return DALCS_E_OPTION;
}

/* The rows of an earlier run, up to the last whole one; behind it the file is cut. */
static enum dalcs_status take_rows(struct dalcs_variants_file *f, const struct dalcs_cli *cli,
                                   const char *header, dalcs_variant_begins *begins, void *user) {
    char *line = NULL;
    size_t capacity = 0;
    off_t end = 0;
    enum dalcs_status status = DALCS_OK;
    ssize_t length;
    if (read_line(f->stream, &line, &capacity, &length)) {
        status = strcmp(line, header) == 0 ? DALCS_OK : refuse_rows(cli, f->partial);
        end = length;
    }
    while (end > 0 && status == DALCS_OK && read_line(f->stream, &line, &capacity, &length)) {
        char *begin = begins(user, f->n_rows);
        if (begin == NULL) {
            status = DALCS_E_NOMEM;
        } else if (strncmp(line, begin, strlen(begin)) != 0 || begin[0] == '\0') {
            status = refuse_rows(cli, f->partial);
        } else {
            f->n_rows++;
            f->n_failed += is_good(line, length) ? 0 : 1;
            end += length;
        }
        free(begin);
    }
    free(line);
    if (status == DALCS_OK &&
        (fseeko(f->stream, end, SEEK_SET) != 0 || ftruncate(fileno(f->stream), end) != 0)) {
        status = fail(cli, f->partial, errno);
    }
    if (status == DALCS_OK && end == 0 && dalcs_variants_file_row(f, header) != DALCS_OK) {
        status = fail(cli, f->partial, errno);
    }
    return status;
}

/* A table of that name, if there is one: of these measurements? */
static enum dalcs_status look_at_table(struct dalcs_variants_file *f, const struct dalcs_cli *cli,
                                       const char *header) {
    FILE *table = fopen(f->path, "r");
    char *line = NULL;
    size_t capacity = 0;
    enum dalcs_status status = DALCS_OK;
    if (table == NULL) {
        return errno == ENOENT ? DALCS_OK : fail(cli, f->path, errno);
    }
    f->is_complete = getline(&line, &capacity, table) > 0 && strcmp(line, header) == 0;
    if (!f->is_complete) {
        status = refuse_rows(cli, f->path);
    }
    free(line);
    fclose(table);
    return status;
}

/* One that could not get its name in the end is refused before the work. */
static int check_target(const char *path) {
    struct stat target;
    if (stat(path, &target) != 0) {
        return errno == ENOENT ? 0 : errno;
    }
    return S_ISDIR(target.st_mode)    ? EISDIR
           : !S_ISREG(target.st_mode) ? EINVAL
           : access(path, W_OK) != 0  ? errno
                                      : 0;
}

enum dalcs_status dalcs_variants_file_open(struct dalcs_variants_file *f,
                                           const struct dalcs_cli *cli, const char *header,
                                           bool resume, dalcs_variant_begins *begins, void *user) {
    const int error = check_target(f->path);
    if (error != 0) {
        return fail(cli, f->path, error);
    }
    if (resume && !dalcs_crashes_go_on()) { /* then a table of that name is one of before */
        const enum dalcs_status status = look_at_table(f, cli, header);
        if (status != DALCS_OK || f->is_complete) {
            return status;
        }
    }
    f->partial = dalcs_partial_name(f->path);
    if (f->partial == NULL) {
        return DALCS_E_NOMEM;
    }
    f->stream = fopen(f->partial, "a+e");
    if (f->stream == NULL) {
        return fail(cli, f->partial, errno);
    }
    if (flock(fileno(f->stream), LOCK_EX | LOCK_NB) != 0) {
        dalcs_cli_error(cli, "another run is writing '%s'", f->partial);
        return DALCS_E_IO;
    }
    if (!resume && ftruncate(fileno(f->stream), 0) != 0) {
        return fail(cli, f->partial, errno);
    }
    rewind(f->stream);
    return take_rows(f, cli, header, begins, user);
}

enum dalcs_status dalcs_variants_file_row(struct dalcs_variants_file *f, const char *row) {
    errno = 0;
    return fputs(row, f->stream) >= 0 && fflush(f->stream) == 0 ? DALCS_OK : DALCS_E_IO;
}

enum dalcs_status dalcs_variants_file_commit(struct dalcs_variants_file *f) {
    return rename(f->partial, f->path) == 0 ? DALCS_OK : DALCS_E_IO;
}

void dalcs_variants_file_finish(struct dalcs_variants_file *f) {
    if (f->stream != NULL) {
        fclose(f->stream);
    }
    free(f->partial);
    *f = (struct dalcs_variants_file){0};
}

/* atomic_file.c - write to a temporary name in the same folder, rename when complete.
 *
 * A run that fails leaves an earlier good file alone; the rows that it had get the name .partial.
 * No fsync: results can be computed again, a power cut is not worth the wait. */
#include "atomic_file.h"

#include "congruential.h"
#include "memory.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define BUFFER_BYTES ((size_t)1 << 16)
#define NAME_TRIES   100

static enum dalcs_status fail(struct dalcs_atomic_file *file, int error) {
    dalcs_atomic_file_discard(file);
    file->error = error;
    return error == ENOMEM ? DALCS_E_NOMEM : DALCS_E_IO;
}

bool dalcs_is_standard_output(const char *path) {
    return path && strcmp(path, "-") == 0;
}

/* The permissions of the file to be replaced, or what the umask grants a new one. */
static int check_target(const char *path, mode_t *mode) {
    struct stat target;
    *mode = 0;
    if (stat(path, &target) != 0) {
        return errno == ENOENT ? 0 : errno;
    }
    if (S_ISDIR(target.st_mode)) {
        return EISDIR;
    }
    if (!S_ISREG(target.st_mode)) {
        return EINVAL;
    }
    if (access(path, W_OK) != 0) {
        return errno;
    }
    *mode = target.st_mode & 07777;
    return 0;
}

static void name_temporary(char *text, size_t size, const char *path, unsigned attempt) {
    static const char letter[] = "abcdefghijklmnopqrstuvwxyz0123456789";
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    uint64_t seed = ((uint64_t)now.tv_nsec << 20) ^ ((uint64_t)getpid() << 4) ^ attempt;
    char suffix[7] = "";
    for (int i = 0; i < 6; i++) {
        suffix[i] = letter[(dalcs_congruential_next(&seed) >> 33) % (sizeof letter - 1)];
    }
    snprintf(text, size, "%s.partial-%s", path, suffix);
}

/* The standard output is written to an unnamed file first, until it is complete. */
static int open_unnamed(void) {
    FILE *unnamed = tmpfile();
    const int descriptor = unnamed ? fcntl(fileno(unnamed), F_DUPFD_CLOEXEC, 3) : -1;
    const int error = errno;
    if (unnamed) {
        fclose(unnamed);
    }
    errno = error;
    return descriptor;
}

static int open_temporary(struct dalcs_atomic_file *file) {
    if (dalcs_is_standard_output(file->path)) {
        return open_unnamed();
    }
    size_t size = strlen(file->path) + sizeof ".partial-XXXXXX";
    file->temporary = dalcs_alloc(size, 1);
    if (!file->temporary) {
        errno = ENOMEM;
        return -1;
    }
    int descriptor = -1;
    for (unsigned attempt = 0; descriptor < 0 && attempt < NAME_TRIES; attempt++) {
        name_temporary(file->temporary, size, file->path, attempt);
        descriptor = open(file->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor < 0 && errno != EEXIST) {
            break;
        }
    }
    if (descriptor < 0) {
        int error = errno;
        free(file->temporary); /* it is not ours to remove */
        file->temporary = NULL;
        errno = error;
    }
    return descriptor;
}

/* The target of a symbolic link; else the path as given, for messages. */
static char *find_target(const char *path) {
    struct stat status;
    bool is_link = lstat(path, &status) == 0 && S_ISLNK(status.st_mode);
    char *target = is_link ? realpath(path, NULL) : NULL;
    return target ? target : strdup(path);
}

enum dalcs_status dalcs_atomic_file_open(struct dalcs_atomic_file *file, const char *path) {
    *file = (struct dalcs_atomic_file){0};
    file->path = find_target(path);
    if (!file->path) {
        return fail(file, ENOMEM);
    }
    mode_t mode = 0;
    int error = dalcs_is_standard_output(file->path) ? 0 : check_target(file->path, &mode);
    if (error != 0) {
        return fail(file, error);
    }
    int descriptor = open_temporary(file);
    if (descriptor < 0) {
        return fail(file, errno);
    }
    file->stream = fdopen(descriptor, "w+b");
    if (!file->stream) {
        error = errno;
        close(descriptor);
        return fail(file, error);
    }
    if (mode != 0 && fchmod(descriptor, mode) != 0) {
        return fail(file, errno);
    }
    file->buffer = malloc(BUFFER_BYTES); /* a nicety: without it stdio has its own */
    if (file->buffer) {
        setvbuf(file->stream, file->buffer, _IOFBF, BUFFER_BYTES);
    }
    return DALCS_OK;
}

/* Every byte is with the system when this returns 0; otherwise an errno. */
static int close_stream(struct dalcs_atomic_file *file) {
    errno = 0;
    bool good = !ferror(file->stream) && fflush(file->stream) == 0;
    int error = good ? 0 : (errno != 0 ? errno : EIO);
    if (fclose(file->stream) != 0 && error == 0) {
        error = errno != 0 ? errno : EIO;
    }
    file->stream = NULL;
    return error;
}

/* An errno, or 0. */
static int copy_to_standard_output(struct dalcs_atomic_file *file) {
    char bytes[BUFSIZ];
    size_t n;
    errno = 0;
    bool good = !ferror(file->stream) && fflush(file->stream) == 0;
    if (good) {
        rewind(file->stream);
    }
    while (good && (n = fread(bytes, 1, sizeof bytes, file->stream)) > 0) {
        good = fwrite(bytes, 1, n, stdout) == n;
    }
    return good ? 0 : errno != 0 ? errno : EIO;
}

static enum dalcs_status move_to(struct dalcs_atomic_file *file, const char *name) {
    if (!file->temporary) {
        const int failed = copy_to_standard_output(file);
        if (failed != 0) {
            return fail(file, failed);
        }
        dalcs_atomic_file_discard(file);
        return DALCS_OK;
    }
    int error = close_stream(file);
    if (error == 0 && rename(file->temporary, name) != 0) {
        error = errno;
    }
    if (error != 0) {
        return fail(file, error);
    }
    free(file->temporary);
    file->temporary = NULL;
    dalcs_atomic_file_discard(file);
    return DALCS_OK;
}

enum dalcs_status dalcs_atomic_file_commit(struct dalcs_atomic_file *file) {
    return move_to(file, file->path);
}

char *dalcs_partial_name(const char *path) {
    static const char word[] = ".partial";
    const char *slash = strrchr(path, '/');
    const char *base = slash ? slash + 1 : path;
    const char *dot = strrchr(base, '.');
    size_t stem = dot && dot != base ? (size_t)(dot - path) : strlen(path);
    char *name = dalcs_alloc(strlen(path) + sizeof word, 1);
    if (name) {
        memcpy(name, path, stem);
        strcpy(name + stem, word);
        strcat(name, path + stem);
    }
    return name;
}

enum dalcs_status dalcs_atomic_file_keep(struct dalcs_atomic_file *file, char **left_at) {
    *left_at = NULL;
    char *name = dalcs_partial_name(file->path);
    if (!name) {
        return fail(file, ENOMEM);
    }
    enum dalcs_status status = move_to(file, name);
    if (status != DALCS_OK) {
        free(name);
        return status;
    }
    *left_at = name;
    return DALCS_OK;
}

/* A stream that failed once is of no use: what it could not write is lost in its buffer. */
enum dalcs_status dalcs_atomic_file_recover(struct dalcs_atomic_file *file, int *descriptor,
                                            off_t *size) {
    struct stat status;
    *descriptor = dup(fileno(file->stream));
    if (*descriptor < 0 || fstat(*descriptor, &status) != 0) {
        int error = errno;
        if (*descriptor >= 0) {
            close(*descriptor);
        }
        return fail(file, error);
    }
    *size = status.st_size;
    fclose(file->stream);
    file->stream = fdopen(*descriptor, "r+b");
    if (!file->stream) {
        int error = errno;
        close(*descriptor);
        return fail(file, error);
    }
    return DALCS_OK;
}

void dalcs_atomic_file_discard(struct dalcs_atomic_file *file) {
    if (file->stream) {
        fclose(file->stream);
    }
    if (file->temporary) {
        unlink(file->temporary);
    }
    free(file->temporary);
    free(file->path);
    free(file->buffer);
    *file = (struct dalcs_atomic_file){.error = file->error};
}

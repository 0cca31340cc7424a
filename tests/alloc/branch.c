/* branch.c - children that share nothing with their parent: neither files nor places in open files.
 *
 * A run with a failing allocation is the same as one without up to there. So the one without is made once, and a child
 * is split off where the allocation fails: that takes a tenth of what a run from its start takes. A child works in a
 * copy of the folder, in which it opens again each regular file that is open: netlist, output and report, and stdout and
 * stderr, which must be files there. Whatever fails here aborts the process; the test sees that.
 */
#define _GNU_SOURCE
#include "branch.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { LONGEST = 4096, FILES = 64 };

struct point {
    int64_t number, way;
};

static struct point point[1 << 16];
static size_t n_points, next_point;
static char branches[LONGEST];
static int ended = -1; /* file descriptor: number, way and status of each child */

static void need(int is_right) {
    if (!is_right) {
        abort();
    }
}

void branch_start(const char *points, const char *folder) {
    char name[LONGEST];
    int file = open(points, O_RDONLY | O_CLOEXEC);
    ssize_t length = file >= 0 ? read(file, point, sizeof point) : -1;
    need(length > 0 && (size_t)length < sizeof point && length % (ssize_t)sizeof *point == 0);
    close(file);
    n_points = (size_t)length / sizeof *point;
    need(strlen(folder) < sizeof branches);
    strcpy(branches, folder);
    need(snprintf(name, sizeof name, "%s/ended", folder) < (int)sizeof name);
    ended = open(name, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    need(ended >= 0);
}

static void copy(int from, int to) {
    for (ssize_t n; (n = sendfile(to, from, NULL, 1 << 30)) != 0;) {
        need(n > 0);
    }
}

/* All files of the current folder, none of which is a folder. */
static void copy_folder(int to) {
    DIR *folder = opendir(".");
    need(folder != NULL);
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) {
            int source = open(entry->d_name, O_RDONLY);
            int target = openat(to, entry->d_name, O_WRONLY | O_CREAT, 0600);
            need(source >= 0 && target >= 0);
            copy(source, target);
            close(source);
            close(target);
        }
    }
    closedir(folder);
}

/* A file that has no name, or another program's folder: a copy without a name. */
static int open_copy(int file, int folder) {
    const off_t place = lseek(file, 0, SEEK_CUR);
    const int again = openat(folder, ".", O_TMPFILE | O_RDWR, 0600);
    need(again >= 0 && lseek(file, 0, SEEK_SET) == 0);
    copy(file, again);
    need(lseek(file, place, SEEK_SET) == place);
    return again;
}

/* An open file again, with a place of its own: in the copy of the folder, or elsewhere to be read. */
static void open_again(int file, const char *old_folder, int folder) {
    char link[64], name[LONGEST];
    struct stat status;
    const size_t length = strlen(old_folder);
    if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode) || file == ended) {
        return;
    }
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    const ssize_t n = readlink(link, name, sizeof name - 1);
    const int flags = fcntl(file, F_GETFL), closes = fcntl(file, F_GETFD);
    need(n > 0);
    name[n] = '\0';
    const int is_here =
        strncmp(name, old_folder, length) == 0 && name[length] == '/' && status.st_nlink > 0;
    const int again = is_here ? openat(folder, name + length + 1, flags & (O_ACCMODE | O_APPEND))
                      : (flags & O_ACCMODE) == O_RDONLY ? open(link, O_RDONLY)
                                                        : open_copy(file, folder);
    need(again >= 0 && lseek(again, lseek(file, 0, SEEK_CUR), SEEK_SET) >= 0);
    need(dup3(again, file, closes & FD_CLOEXEC ? O_CLOEXEC : 0) == file);
    close(again);
}

static void move_out(const struct point *at) {
    char old_folder[LONGEST], name[LONGEST + 64];
    need(getcwd(old_folder, sizeof old_folder) != NULL);
    snprintf(name, sizeof name, "%s/%lld.%lld", branches, (long long)at->number,
             (long long)at->way);
    need(mkdir(name, 0700) == 0);
    const int folder = open(name, O_RDONLY | O_DIRECTORY);
    need(folder >= 0);
    copy_folder(folder);
    for (int file = 0; file < FILES; file++) {
        open_again(file, old_folder, folder);
    }
    need(fchdir(folder) == 0);
    close(folder);
}

enum branch_way branch_at(int64_t number) {
    const int error = errno;
    for (; next_point < n_points && point[next_point].number == number; next_point++) {
        const struct point at = point[next_point];
        const pid_t child = fork();
        need(child >= 0);
        if (child == 0) {
            next_point = n_points;
            move_out(&at);
            errno = error;
            return (enum branch_way)at.way;
        }
        int status;
        need(waitpid(child, &status, 0) == child);
        const int64_t outcome[] = {at.number, at.way,
                                   WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status)};
        need(write(ended, outcome, sizeof outcome) == (ssize_t)sizeof outcome);
    }
    errno = error;
    return BRANCH_GOES_ON;
}

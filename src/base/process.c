/* process.c - posix_spawn and a patient look now and then. */
#include "process.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

extern char **environ;

/* 0 or an errno. */
static int start(const struct dalcs_process *process, pid_t *child) {
    posix_spawn_file_actions_t actions;
    int error = posix_spawn_file_actions_init(&actions);
    if (error != 0) {
        return error;
    }
    if (process->input) {
        error = posix_spawn_file_actions_adddup2(&actions, fileno(process->input), 0);
    } else {
        error = posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    }
    if (error == 0) {
        error = posix_spawn_file_actions_adddup2(&actions, fileno(process->output), 1);
    }
    if (error == 0) {
        error = posix_spawn_file_actions_adddup2(&actions, fileno(process->errors), 2);
    }
    if (error == 0) {
        error = posix_spawnp(
            child, process->argument[0], &actions, NULL, (char *const *)process->argument,
            process->environment != NULL ? (char *const *)process->environment : environ);
    }
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

/* s of CPU time that the child has used; another load on the machine is not its fault. */
static double read_clock(pid_t child) {
    clockid_t clock;
    struct timespec now = {0};
    if (clock_getcpuclockid(child, &clock) == 0) {
        clock_gettime(clock, &now);
    }
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double seconds(const struct timeval *t) {
    return (double)t->tv_sec + 1e-6 * (double)t->tv_usec;
}

enum dalcs_status dalcs_process_run(struct dalcs_process *process) {
    process->is_missing = false;
    process->is_too_slow = false;
    pid_t child = 0;
    int error = start(process, &child);
    if (error != 0) {
        process->is_missing = error == ENOENT;
        errno = error;
        return DALCS_E_IO;
    }
    bool cancelled = false;
    int result = 0;
    struct rusage usage;
    for (;;) {
        pid_t ended = wait4(child, &result, WNOHANG, &usage);
        if (ended == child) {
            break;
        }
        if (ended < 0 && errno != EINTR) {
            return DALCS_E_IO;
        }
        cancelled = cancelled || (process->interrupted && *process->interrupted);
        process->is_too_slow =
            process->is_too_slow || (process->limit > 0.0 && read_clock(child) > process->limit);
        if (cancelled || process->is_too_slow) {
            kill(child, SIGKILL);
        }
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
    process->cpu_s = seconds(&usage.ru_utime) + seconds(&usage.ru_stime);
    process->exit_status = WIFEXITED(result) ? WEXITSTATUS(result) : -1;
    process->is_missing = process->exit_status == 127;
    return cancelled ? DALCS_E_CANCELLED : process->is_missing ? DALCS_E_IO : DALCS_OK;
}

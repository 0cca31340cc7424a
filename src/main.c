/* main.c - the program: options in, status out. The only file that uses stdout, stderr, signals
 * and the exit status; all the rest is told where to print. */
#include "cli.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

/* The signal that stops the run; 0: none yet. */
static volatile sig_atomic_t interrupted;

/* The session at work, which looks for a signal's flag between its rows alone; NULL: none. */
static struct dalcs_session *volatile running;

static void note_signal(int number) {
    interrupted = number;
    if (running != NULL) {
        dalcs_session_cancel(running);
    }
}

/* The first signal ends the run with its results so far in files; a second one ends the program.
 * What nohup or a shell has told us to ignore stays ignored. */
static void catch_signals(void) {
    static const int stopping[] = {SIGINT, SIGTERM, SIGHUP};
    for (size_t i = 0; i < sizeof stopping / sizeof stopping[0]; i++) {
        struct sigaction before;
        struct sigaction action = {.sa_handler = note_signal, .sa_flags = (int)SA_RESETHAND};
        sigemptyset(&action.sa_mask);
        if (sigaction(stopping[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN) {
            sigaction(stopping[i], &action, NULL);
        }
    }
    signal(SIGPIPE, SIG_IGN); /* a reader that left is a write error, */
    signal(SIGXFSZ, SIG_IGN); /* and so is a file that grew too large */
}

/* Where the caller closed a standard stream, the next file would take its number and what is meant
 * for a terminal would end up in a waveform. A stream that cannot be written is opened in its place. */
static bool keep_standard_streams(void) {
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; stream++) {
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDONLY) != stream) {
            return false;
        }
    }
    return true;
}

int main(int argc, char **argv) {
    if (!keep_standard_streams()) {
        return DALCS_EXIT_IO;
    }
    catch_signals();
    const struct dalcs_cli cli = {
        .out = stdout,
        .err = stderr,
        .err_is_terminal = isatty(STDERR_FILENO) == 1,
        .interrupted = &interrupted,
        .running = &running,
    };
    errno = 0;
    int result = dalcs_cli_eval(&cli, argc, argv);
    if (fflush(stdout) != 0 || ferror(stdout)) {
        if (errno != EPIPE) { /* who pipes into head has seen enough */
            dalcs_cli_error(&cli, "cannot write to standard output: %s",
                            strerror(errno != 0 ? errno : EIO));
        }
        result = result == DALCS_EXIT_OK ? DALCS_EXIT_IO : result;
    }
    if (interrupted && result == DALCS_EXIT_RUN) {
        /* Die of the signal, so that a shell running a loop stops as well. */
        signal((int)interrupted, SIG_DFL);
        raise((int)interrupted);
    }
    return result;
}

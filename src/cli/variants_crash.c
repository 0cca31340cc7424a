/* variants_crash.c - notes which step a crash was in and starts the program again.
 *
 * After a crash nothing in the process can be trusted, memory and locks least of all. So the handler does what POSIX
 * allows in one: it writes the number of the step, and becomes the same program anew, which goes on behind the rows that
 * are in the file. State is static here, as a handler has no other. */
#include "variants_crash.h"

#include "memory.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define AGAIN "DALCS_GOES_ON_AFTER_CRASH"

extern char **environ;

static const int crashing[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

enum {
    N_CRASHING = sizeof crashing / sizeof crashing[0],
    STACK = 1 << 16,
    MOST_ARGUMENTS = 1 << 17
};

static struct {
    char **argument, **environment; /* of the program anew; heap, for as long as it runs */
    const char *notes;              /* the file's path; NULL: crashes are not noted */
} again;

static _Thread_local long running = -1; /* step */

bool dalcs_crashes_go_on(void) {
    return getenv(AGAIN) != NULL;
}

/* ---- The handler: nothing but what is safe there ---------------------------------------------- */

static size_t write_digits(char *to, unsigned long value) {
    char digit[24];
    size_t n = 0;
    do {
        digit[n++] = (char)('0' + value % 10);
        value /= 10;
    } while (value > 0);
    for (size_t k = 0; k < n; k++) {
        to[k] = digit[n - 1 - k];
    }
    return n;
}

static void die(int signal_number) {
    signal(signal_number, SIG_DFL);
    raise(signal_number);
}

static void go_on(int signal_number, siginfo_t *info, void *context) {
    static const char said[] = "dalcs: a variant crashed: its row says so, the others go on\n";
    char line[64];
    (void)context;
    if (running < 0 || again.notes == NULL || info->si_code == SI_USER) {
        die(signal_number); /* sent from outside, or in no variant */
        return;
    }
    size_t n = write_digits(line, (unsigned long)running);
    line[n++] = ' ';
    n += write_digits(line + n, (unsigned long)signal_number);
    line[n++] = '\n';
    const int notes = open(again.notes, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (notes < 0 || write(notes, line, n) != (ssize_t)n) {
        die(signal_number);
        return;
    }
    (void)!write(STDERR_FILENO, said, sizeof said - 1);
    execve("/proc/self/exe", again.argument, again.environment);
    die(signal_number);
}

/* ---- Before the run --------------------------------------------------------------------------- */

/* The arguments of this process, from the system; NULL: not available. */
static char **read_arguments(void) {
    char *text = dalcs_alloc(MOST_ARGUMENTS, 1);
    FILE *from = fopen("/proc/self/cmdline", "r");
    const size_t n = text != NULL && from != NULL ? fread(text, 1, MOST_ARGUMENTS, from) : 0;
    size_t n_arguments = 0;
    if (from != NULL) {
        fclose(from);
    }
    if (n == 0 || n == MOST_ARGUMENTS || text[n - 1] != '\0') {
        free(text);
        return NULL;
    }
    for (size_t k = 0; k < n; k++) {
        n_arguments += text[k] == '\0' ? 1 : 0;
    }
    char **argument = dalcs_alloc(n_arguments + 1, sizeof *argument);
    size_t at = 0;
    for (size_t k = 0; argument != NULL && k < n_arguments; k++) {
        argument[k] = text + at;
        at += strlen(text + at) + 1;
    }
    if (argument == NULL) {
        free(text);
    }
    return argument;
}

static char **extend_environment(void) {
    static char variable[] = AGAIN "=1";
    size_t n = 0;
    while (environ[n] != NULL) {
        n++;
    }
    char **all = dalcs_alloc(n + 2, sizeof *all);
    for (size_t k = 0; all != NULL && k < n; k++) {
        all[k] = environ[k];
    }
    if (all != NULL) {
        all[n] = variable;
    }
    return all;
}

static void catch_crashes(const char *path) {
    again.argument = again.argument != NULL ? again.argument : read_arguments();
    again.environment = again.environment != NULL ? again.environment : extend_environment();
    if (again.argument == NULL || again.environment == NULL) {
        return;
    }
    again.notes = path;
    for (int k = 0; k < N_CRASHING; k++) {
        struct sigaction action = {.sa_sigaction = go_on,
                                   .sa_flags = (int)(SA_SIGINFO | SA_ONSTACK | SA_NODEFER)};
        sigemptyset(&action.sa_mask);
        sigaction(crashing[k], &action, NULL);
    }
}

static enum dalcs_status read_notes(struct dalcs_crashes *crashes) {
    FILE *notes = fopen(crashes->path, "r");
    enum dalcs_status status = DALCS_OK;
    size_t step;
    int number;
    while (notes != NULL && status == DALCS_OK && fscanf(notes, "%zu %d", &step, &number) == 2) {
        status =
            dalcs_grow(&crashes->crash, &crashes->capacity, crashes->n + 1, sizeof *crashes->crash);
        if (status == DALCS_OK) {
            crashes->crash[crashes->n++] = (struct dalcs_crash){step, number};
        }
    }
    if (notes != NULL) {
        fclose(notes);
    }
    return status;
}

enum dalcs_status dalcs_crashes_watch(struct dalcs_crashes *crashes, const char *partial,
                                      bool goes_on) {
    static const char ending[] = ".crashed";
    crashes->path = dalcs_alloc(strlen(partial) + sizeof ending, 1);
    if (crashes->path == NULL) {
        return DALCS_E_NOMEM;
    }
    strcpy(crashes->path, partial);
    strcat(crashes->path, ending);
    unsetenv(AGAIN); /* not for what this program starts */
    if (!goes_on) {
        unlink(crashes->path);
    }
    DALCS_TRY(read_notes(crashes));
    catch_crashes(crashes->path);
    return DALCS_OK;
}

/* ---- Threads ---------------------------------------------------------------------------------- */

static _Thread_local stack_t stack_before;

void dalcs_crashes_enter_thread(void) {
    static _Thread_local char room[STACK]; /* that of the thread may be what overflowed */
    const stack_t stack = {.ss_sp = room, .ss_size = sizeof room};
    (void)sigaltstack(&stack, &stack_before);
}

void dalcs_crashes_leave_thread(void) {
    (void)sigaltstack(&stack_before, NULL); /* AddressSanitizer takes back the one that it made */
}

void dalcs_crashes_begin(size_t step) {
    running = (long)step;
}

void dalcs_crashes_end(void) {
    running = -1;
}

int dalcs_crashes_find(const struct dalcs_crashes *crashes, size_t step) {
    for (size_t k = 0; crashes != NULL && k < crashes->n; k++) {
        if (crashes->crash[k].step == step) {
            return crashes->crash[k].signal;
        }
    }
    return 0;
}

void dalcs_crashes_finish(struct dalcs_crashes *crashes, bool is_complete) {
    for (int k = 0; k < N_CRASHING && again.notes != NULL; k++) {
        signal(crashing[k], SIG_DFL);
    }
    again.notes = NULL;
    if (crashes->path != NULL && is_complete) {
        unlink(crashes->path);
    }
    free(crashes->path);
    free(crashes->crash);
    *crashes = (struct dalcs_crashes){0};
}

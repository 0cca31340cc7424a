/* random_runs.c - valid netlists of random bytes, run one after the other in one process.
 *
 *   random_runs SEED COUNT [FIRST [SECONDS]]
 *
 * What libFuzzer does with fuzz_run.c, less its bookkeeping of coverage, which takes longer than a short run: for many
 * runs. Run k of a seed has bytes of its own: `random_runs SEED 1 k` is that run alone. Most netlists are small. A run that
 * ends the process, or takes more than MOST_SECONDS of processor time, is told with its number, and another process goes on
 * behind it. With SECONDS a run that takes longer than that is left, which is no failure: the search for a mode of a
 * singular system may take minutes. With DALCS_TEST_SHORT=1 it makes a quarter of them. */
#include <inttypes.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* The largest netlists of 12 elements take 120 choices or so; most are of a few. */
enum { MOST_BYTES = 160, MOST_SECONDS = 60, RUNS_BETWEEN_LINES = 100000 };

static uint64_t seed;
static long most_seconds = MOST_SECONDS;

/* Of the process that runs, as the one that waits for it sees it. */
static volatile uint64_t *run;

/* Steele, Lea and Flood, OOPSLA 2014: SplitMix64. */
static uint64_t next(uint64_t *state) {
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

static void one(void) {
    uint64_t state = seed * UINT64_C(0x2545f4914f6cdd1d) + *run;
    uint8_t data[MOST_BYTES];
    next(&state);
    const uint64_t length = next(&state);
    size_t size = 8 + (size_t)(length % 56);
    size = length >> 60 == 0 ? MOST_BYTES : size; /* one in 16 is as large as they get */
    for (size_t k = 0; k < size; k += sizeof state) {
        const uint64_t word = next(&state);
        memcpy(data + k, &word, k + sizeof word <= size ? sizeof word : size - k);
    }
    const struct itimerval most = {.it_value = {.tv_sec = most_seconds}};
    setitimer(ITIMER_PROF, &most, NULL);
    LLVMFuzzerTestOneInput(data, size);
}

static void run_all(uint64_t first, uint64_t end, time_t begin) {
    while (*run < end) {
        one();
        ++*run;
        if ((*run - first) % RUNS_BETWEEN_LINES == 0) {
            printf("%" PRIu64 " runs, %ld s\n", *run - first, (long)(time(NULL) - begin));
            fflush(stdout);
        }
    }
}

/* How a process ended before all were run: is that a failure? */
static bool tell(int status, bool may_be_slow) {
    const bool is_slow = WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF;
    fprintf(stderr, "%s %d in run: random_runs %" PRIu64 " 1 %" PRIu64 "\n",
            is_slow               ? "out of time, signal"
            : WIFSIGNALED(status) ? "signal"
                                  : "status",
            WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status), seed, *run);
    return !is_slow || !may_be_slow;
}

int main(int argc, char **argv) {
    if (argc < 3) {
        fputs("usage: random_runs SEED COUNT [FIRST [SECONDS]]\n", stderr);
        return 2;
    }
    seed = strtoull(argv[1], NULL, 10);
    const char *is_short = getenv("DALCS_TEST_SHORT"); /* tools/test without --long */
    const uint64_t asked = strtoull(argv[2], NULL, 10);
    const uint64_t count = asked > 4 && is_short != NULL ? asked / 4 : asked;
    const uint64_t first = argc > 3 ? strtoull(argv[3], NULL, 10) : 0;
    const time_t begin = time(NULL);
    long n_failed = 0, n_left = 0;
    most_seconds = argc > 4 ? strtol(argv[4], NULL, 10) : MOST_SECONDS;
    run = mmap(NULL, sizeof *run, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (run == MAP_FAILED) {
        return 2;
    }
    for (*run = first; *run < first + count; ++*run) {
        int status;
        const pid_t process = fork();
        if (process == 0) {
            run_all(first, first + count, begin);
            exit(0); /* where a sanitizer looks for leaks */
        }
        if (process < 0 || waitpid(process, &status, 0) != process) {
            return 2;
        }
        if (status != 0) {
            const bool fails = tell(status, argc > 4);
            n_failed += fails ? 1 : 0;
            n_left += fails ? 0 : 1;
        }
    }
    printf("seed %" PRIu64 ": %" PRIu64 " runs, %ld s, %ld left, %ld failed\n", seed, count,
           (long)(time(NULL) - begin), n_left, n_failed);
    return n_failed > 0 ? 1 : 0;
}

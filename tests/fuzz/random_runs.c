/* random_runs.c - valid netlists of random bytes, run one after the other in one process.
 *
 *   random_runs SEED COUNT [FIRST]
 *
 * What libFuzzer does with fuzz_run.c, less its bookkeeping of coverage, which takes longer than a short run: for many
 * runs. Run k of a seed has bytes of its own: `random_runs SEED 1 k` is that run alone. Most netlists are small. What
 * ends the process, or a run of more than MOST_SECONDS of processor time, is told with its number.
 * With DALCS_TEST_SHORT=1 it makes a quarter of them. */
#include <inttypes.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* The largest netlists of 12 elements take 120 choices or so; most are of a few. */
enum { MOST_BYTES = 160, MOST_SECONDS = 60, RUNS_BETWEEN_LINES = 100000 };

static volatile sig_atomic_t has_printed;
static uint64_t seed, run;

/* Of a failure: nothing but write() is sure to work. */
static void tell(int signal_number) {
    char line[96];
    if (!has_printed) {
        has_printed = 1;
        const int n =
            snprintf(line, sizeof line, "signal %d in run: random_runs %" PRIu64 " 1 %" PRIu64 "\n",
                     signal_number, seed, run);
        if (write(2, line, (size_t)n) < 0) {
            _exit(2);
        }
    }
    signal(signal_number, SIG_DFL);
    raise(signal_number == SIGPROF ? SIGABRT : signal_number);
}

/* Steele, Lea and Flood, OOPSLA 2014: SplitMix64. */
static uint64_t next(uint64_t *state) {
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

static void one(void) {
    uint64_t state = seed * UINT64_C(0x2545f4914f6cdd1d) + run;
    uint8_t data[MOST_BYTES];
    next(&state);
    const uint64_t length = next(&state);
    size_t size = 8 + (size_t)(length % 56);
    size = length >> 60 == 0 ? MOST_BYTES : size; /* one in 16 is as large as they get */
    for (size_t k = 0; k < size; k += sizeof state) {
        const uint64_t word = next(&state);
        memcpy(data + k, &word, k + sizeof word <= size ? sizeof word : size - k);
    }
    const struct itimerval most = {.it_value = {.tv_sec = MOST_SECONDS}};
    setitimer(ITIMER_PROF, &most, NULL);
    LLVMFuzzerTestOneInput(data, size);
}

int main(int argc, char **argv) {
    if (argc < 3) {
        fputs("usage: random_runs SEED COUNT [FIRST]\n", stderr);
        return 2;
    }
    seed = strtoull(argv[1], NULL, 10);
    const char *is_short = getenv("DALCS_TEST_SHORT"); /* tools/test without --long */
    const uint64_t asked = strtoull(argv[2], NULL, 10);
    const uint64_t count = asked > 4 && is_short != NULL ? asked / 4 : asked;
    const uint64_t first = argc > 3 ? strtoull(argv[3], NULL, 10) : 0;
    static const int failures[] = {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGPROF};
    for (size_t k = 0; k < sizeof failures / sizeof failures[0]; k++) {
        signal(failures[k], tell);
    }
    const time_t begin = time(NULL);
    for (run = first; run < first + count; run++) {
        one();
        if ((run + 1 - first) % RUNS_BETWEEN_LINES == 0) {
            printf("%" PRIu64 " runs, %ld s\n", run + 1 - first, (long)(time(NULL) - begin));
            fflush(stdout);
        }
    }
    printf("seed %" PRIu64 ": %" PRIu64 " runs, %ld s\n", seed, count, (long)(time(NULL) - begin));
    return 0;
}

/* fail_malloc.c - a library to preload that makes one allocation fail and counts them all.
 *
 * DALCS_FAIL_AT=N   the N-th allocation returns NULL (N >= 1)
 * DALCS_FAIL_FROM=N that one and all later ones return NULL
 * DALCS_TALLY=FILE  a file that receives struct tally, up to date at every moment
 * DALCS_POINTS=FILE, DALCS_BRANCHES=FOLDER
 *                   at each of these allocations a child goes on where it fails (branch.h); its tally is FOLDER/N.WAY/tally
 * DALCS_PATHS=FILE  a file that receives 64 bits for each allocation, in order: equal where the innermost calls that led to it are
 * DALCS_DEPTH=N     of how many, this library's three among them; 12 without it
 *
 * Allocations are counted from the first call in main: what the constructors of other libraries do
 * without memory, such as Fortran's, is not the program's to answer for. Programs that this one starts are neither
 * counted nor made to fail. Not for threads.
 */
#define _GNU_SOURCE
#include "branch.h"

#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <malloc.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* glibc's own entry points: they need no dlsym, which may itself allocate. */
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);
void *__libc_memalign(size_t alignment, size_t size);
void __libc_free(void *old);

struct tally {
    int64_t calls;    /* allocations asked for */
    int64_t refused;  /* answered with NULL on purpose */
    int64_t live;     /* bytes in use */
    int64_t peak;     /* the most bytes ever in use */
    int64_t peak_rss; /* kB, the kernel's VmHWM; written at exit */
};

static struct tally here;
static struct tally *tally = &here;
static int64_t fail_at, fail_from;
static int paths = -1; /* file descriptor */
static int depth;
static int counting;

enum { MOST_FRAMES = 12 };

static int64_t number_from(const char *name) {
    const char *text = getenv(name);
    return text != NULL ? strtoll(text, NULL, 10) : 0;
}

/* The first backtrace loads a library and allocates: it is made before anything is counted. */
static void start_paths(const char *path) {
    void *frame;
    const int64_t wanted = number_from("DALCS_DEPTH");
    depth = wanted > 0 && wanted < MOST_FRAMES ? (int)wanted : MOST_FRAMES;
    if (path != NULL) {
        paths = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        backtrace(&frame, 1);
    }
}

/* FNV-1a over the innermost return addresses, each from the start of its program or library: three are of this one, and
 * who is further out sees no more than an error that was passed on. Where code was loaded does not matter. */
static void write_path(void) {
    void *frames[MOST_FRAMES];
    uint64_t hash = 14695981039346656037u;
    int count = backtrace(frames, depth);
    for (int k = 0; k < count; k++) {
        Dl_info place;
        const uintptr_t start = dladdr(frames[k], &place) != 0 ? (uintptr_t)place.dli_fbase : 0;
        hash = (hash ^ (uint64_t)((uintptr_t)frames[k] - start)) * 1099511628211u;
    }
    if (write(paths, &hash, sizeof hash) != (ssize_t)sizeof hash) {
        abort(); /* a path that is missing would shift all others */
    }
}

/* Goes on in a file with what was counted so far. */
static void share_tally(const char *path) {
    int file = open(path, O_RDWR | O_CREAT, 0600);
    if (file >= 0 && ftruncate(file, sizeof *tally) == 0) {
        void *shared = mmap(NULL, sizeof *tally, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
        if (shared != MAP_FAILED) {
            here = *tally; /* what other constructors took before */
            tally = shared;
            *tally = here;
        }
    }
    if (file >= 0) {
        close(file);
    }
}

__attribute__((constructor)) static void start(void) {
    const char *path = getenv("DALCS_TALLY"), *points = getenv("DALCS_POINTS");
    fail_at = number_from("DALCS_FAIL_AT");
    fail_from = number_from("DALCS_FAIL_FROM");
    start_paths(getenv("DALCS_PATHS"));
    if (path != NULL) {
        share_tally(path);
    }
    if (points != NULL) {
        branch_start(points, getenv("DALCS_BRANCHES"));
    }
    unsetenv("DALCS_POINTS");
    unsetenv("DALCS_BRANCHES");
    unsetenv("DALCS_TALLY");
    unsetenv("DALCS_FAIL_AT");
    unsetenv("DALCS_FAIL_FROM");
    unsetenv("DALCS_PATHS");
}

typedef int main_function(int, char **, char **);
typedef int start_function(main_function *, int, char **, void (*)(void), void (*)(void),
                           void (*)(void), void *);

static main_function *program;

static int counted_main(int argc, char **argv, char **environment) {
    counting = 1;
    return program(argc, argv, environment);
}

/* glibc's own, with counted_main between. */
int __libc_start_main(main_function *main, int argc, char **argv, void (*init)(void),
                      void (*finish)(void), void (*unload)(void), void *stack) {
    start_function *next = (start_function *)(uintptr_t)dlsym(RTLD_NEXT, "__libc_start_main");
    program = main;
    return next(counted_main, argc, argv, init, finish, unload, stack);
}

__attribute__((destructor)) static void stop(void) {
    char text[4096];
    int file = open("/proc/self/status", O_RDONLY);
    ssize_t length = file >= 0 ? read(file, text, sizeof text - 1) : -1;
    if (file >= 0) {
        close(file);
    }
    if (length > 0) {
        text[length] = '\0';
        const char *line = strstr(text, "VmHWM:");
        tally->peak_rss = line != NULL ? strtoll(line + 6, NULL, 10) : 0;
    }
}

/* In a child of branch.h: a tally of its own, and what fails. Nothing is counted while the child is made. */
static void take_branch(int64_t call) {
    counting = 0;
    const enum branch_way way = branch_at(call);
    if (way != BRANCH_GOES_ON) {
        share_tally("tally");
        fail_at = way == BRANCH_FAILS_ONCE ? call : 0;
        fail_from = way == BRANCH_FAILS_FROM_HERE ? call : 0;
    }
    counting = 1;
}

/* Counts one allocation and says whether it must fail. */
static int refuse(void) {
    if (!counting) {
        return 0;
    }
    tally->calls++;
    if (paths >= 0) {
        write_path();
    }
    take_branch(tally->calls);
    if (tally->calls != fail_at && (fail_from == 0 || tally->calls < fail_from)) {
        return 0;
    }
    tally->refused++;
    errno = ENOMEM;
    return 1;
}

static void *took(void *block) {
    if (block != NULL) {
        tally->live += (int64_t)malloc_usable_size(block);
        if (tally->live > tally->peak) {
            tally->peak = tally->live;
        }
    }
    return block;
}

static void gave(void *block) {
    if (block != NULL) {
        tally->live -= (int64_t)malloc_usable_size(block);
    }
}

void *malloc(size_t size) {
    return refuse() ? NULL : took(__libc_malloc(size));
}

void *calloc(size_t count, size_t size) {
    return refuse() ? NULL : took(__libc_calloc(count, size));
}

void *realloc(void *old, size_t size) {
    int64_t before = old != NULL ? (int64_t)malloc_usable_size(old) : 0;
    if (refuse()) {
        return NULL;
    }
    void *block = __libc_realloc(old, size);
    if (block != NULL || size == 0) {
        tally->live -= before;
    }
    return took(block);
}

void *memalign(size_t alignment, size_t size) {
    return refuse() ? NULL : took(__libc_memalign(alignment, size));
}

void *aligned_alloc(size_t alignment, size_t size) {
    return memalign(alignment, size);
}

int posix_memalign(void **block, size_t alignment, size_t size) {
    void *made = memalign(alignment, size);
    if (made == NULL) {
        return ENOMEM;
    }
    *block = made;
    return 0;
}

void free(void *block) {
    gave(block);
    __libc_free(block);
}

/* fail_malloc.c - a library to preload that makes one allocation fail and counts them all.
 *
 * DALCS_FAIL_AT=N   the N-th allocation returns NULL (N >= 1)
 * DALCS_FAIL_FROM=N that one and all later ones return NULL
 * DALCS_TALLY=FILE  a file that receives struct tally, up to date at every moment
 * DALCS_PATHS=FILE  a file that receives 64 bits for each allocation, in order: equal where the calls that led to it are
 *
 * Allocations are counted from the first call in main: what the constructors of other libraries do
 * without memory, such as Fortran's, is not the program's to answer for. Programs that this one starts are neither
 * counted nor made to fail. Not for threads.
 */
#define _GNU_SOURCE
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
static int counting;

static int64_t number_from(const char *name) {
    const char *text = getenv(name);
    return text != NULL ? strtoll(text, NULL, 10) : 0;
}

/* The first backtrace loads a library and allocates: it is made before anything is counted. */
static void start_paths(const char *path) {
    void *frame;
    if (path != NULL) {
        paths = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        backtrace(&frame, 1);
    }
}

/* FNV-1a over the innermost return addresses: three are of this library, and who is further out sees no more than an
 * error that was passed on. */
static void write_path(void) {
    void *frames[12];
    uint64_t hash = 14695981039346656037u;
    int count = backtrace(frames, 12);
    for (int k = 0; k < count; k++) {
        hash = (hash ^ (uint64_t)(uintptr_t)frames[k]) * 1099511628211u;
    }
    if (write(paths, &hash, sizeof hash) != (ssize_t)sizeof hash) {
        abort(); /* a path that is missing would shift all others */
    }
}

__attribute__((constructor)) static void start(void) {
    const char *path = getenv("DALCS_TALLY");
    fail_at = number_from("DALCS_FAIL_AT");
    fail_from = number_from("DALCS_FAIL_FROM");
    start_paths(getenv("DALCS_PATHS"));
    if (path != NULL) {
        int file = open(path, O_RDWR | O_CREAT, 0600);
        if (file >= 0 && ftruncate(file, sizeof *tally) == 0) {
            void *shared = mmap(NULL, sizeof *tally, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
            if (shared != MAP_FAILED) {
                tally = shared;
                *tally = here; /* what other constructors took before */
            }
        }
        if (file >= 0) {
            close(file);
        }
    }
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

/* Counts one allocation and says whether it must fail. */
static int refuse(void) {
    if (!counting) {
        return 0;
    }
    tally->calls++;
    if (paths >= 0) {
        write_path();
    }
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

/* fortran_runtime.c - what LAPACK's archive needs of the runtime of Fortran, so that the program does without it.
 *
 * For these two functions the linker would take all of its input and output and its numbers of fourfold
 * precision, which are set up whenever the program starts and make every printf() slower. They are weak: where
 * something else needs the runtime, its own ones count. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void refuse_argument(const char *routine, const int *number, size_t length) __asm__("xerbla_")
    __attribute__((weak));
void concatenate(size_t size, char *text, size_t n_first, const char *first, size_t n_second,
                 const char *second) __asm__("_gfortran_concat_string") __attribute__((weak));

/* LAPACK calls it for an argument that no caller may give, and does not expect to go on. */
void refuse_argument(const char *routine, const int *number, size_t length) {
    fprintf(stderr, "dalcs: internal error: argument %d of %.*s; please report this netlist\n",
            *number, (int)length, routine);
    abort();
}

static size_t smaller(size_t a, size_t b) {
    return a < b ? a : b;
}

/* first // second, with blanks up to `size`. */
void concatenate(size_t size, char *text, size_t n_first, const char *first, size_t n_second,
                 const char *second) {
    n_first = smaller(n_first, size);
    n_second = smaller(n_second, size - n_first);
    memcpy(text, first, n_first);
    memcpy(text + n_first, second, n_second);
    memset(text + n_first + n_second, ' ', size - n_first - n_second);
}

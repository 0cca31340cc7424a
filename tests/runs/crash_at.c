/* crash_at.c - loaded before libm: exp(7.25) reads what is not there, exp(7.5) aborts, exp(7.75) overflows the stack. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>

double exp(double x);

static int overflow(volatile char *before) {
    volatile char here[4096];
    here[0] = before[0];
    return overflow(here) + here[0];
}

double exp(double x) {
    static double (*real)(double);
    char start[1] = {0};
    if (x == 7.25) {
        *(volatile int *)8 = 1;
    } else if (x == 7.5) {
        abort();
    } else if (x == 7.75) {
        return overflow(start);
    }
    if (real == NULL) {
        *(void **)&real = dlsym(RTLD_NEXT, "exp");
    }
    return real(x);
}

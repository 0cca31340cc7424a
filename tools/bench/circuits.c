/* circuits.c - generated netlists. */
#include "circuits.h"

#include <stdio.h>
#include <stdlib.h>

struct text {
    char *data;
    size_t size;
    FILE *f;
};

static FILE *begin(struct text *t, const char *title) {
    t->f = open_memstream(&t->data, &t->size);
    if (t->f == NULL) {
        abort();
    }
    fprintf(t->f, "%s\n.model di d\n", title);
    return t->f;
}

static char *end(struct text *t) {
    fprintf(t->f, ".end\n");
    fclose(t->f);
    return t->data;
}

char *bench_bridge(int copies) {
    struct text t;
    FILE *f = begin(&t, "bridges");
    for (int k = 0; k < copies; k++) {
        double phase = copies > 1 ? 360.0 * k / copies : 0.0;
        fprintf(f, "v%d a%d s%d sin(0 10 50 0 0 %.17g)\nrs%d s%d b%d 0.5\n", k, k, k, phase, k, k,
                k);
        fprintf(f, "da%d a%d p%d di\ndb%d b%d p%d di\ndc%d 0 a%d di\ndd%d 0 b%d di\n", k, k, k, k,
                k, k, k, k, k, k);
        fprintf(f, "r%d p%d 0 200\nc%d p%d 0 470u\n", k, k, k, k);
    }
    fprintf(f, ".tran 20u 100m uic\n");
    return end(&t);
}

char *bench_cockcroft_walton(int n) {
    struct text t;
    FILE *f = begin(&t, "Cockcroft-Walton");
    fprintf(f, "v1 a0 0 sin(0 100 50)\n");
    for (int k = 1; k <= n; k++) {
        fprintf(f, "ca%d a%d a%d 1u\ncb%d b%d b%d 1u\n", k, k - 1, k, k, k - 1, k);
        fprintf(f, "da%d b%d a%d di\ndb%d a%d b%d di\n", k, k - 1, k, k, k, k);
    }
    fprintf(f, "vb b0 0 0\nrl b%d 0 10meg\n.tran 2u 400m uic\n", n);
    return end(&t);
}

char *bench_six_pulse(void) {
    struct text t;
    FILE *f = begin(&t, "six-pulse");
    const char *phase = "abc";
    for (int k = 0; k < 3; k++) {
        char p = phase[k];
        fprintf(f, "v%c n%c 0 sin(0 100 50 0 0 %d)\nl%c n%c a%c 100u\n", p, p, -120 * k, p, p, p);
        fprintf(f, "dp%c a%c p di\ndn%c m a%c di\n", p, p, p, p);
    }
    fprintf(f, "lo p x 10m\nro x m 10\nco x m 100u\n.tran 10u 100m uic\n");
    return end(&t);
}

char *bench_ladder(int n) {
    struct text t;
    FILE *f = begin(&t, "diode ladder");
    fprintf(f, "v1 in 0 sin(0 10 1k)\nrs in n0 10\n");
    for (int k = 1; k <= n; k++) {
        fprintf(f, "d%d n%d m%d di\nr%d m%d n%d 1\nc%d n%d 0 1u\nrl%d n%d 0 10k\n", k, k - 1, k, k,
                k, k, k, k, k, k);
    }
    fprintf(f, ".save v(n%d)\n.tran 1u 2m uic\n", n);
    return end(&t);
}

char *bench_peak_detectors(int n) {
    struct text t;
    FILE *f = begin(&t, "peak detectors");
    fprintf(f, "v1 n0 0 sin(0 10 1k)\n");
    for (int k = 1; k <= n; k++) {
        fprintf(f, "r%d n%d n%d 1\ncn%d n%d 0 %.17g\n", k, k - 1, k, k, k, 1e-6 / n);
        fprintf(f, "d%d n%d p%d di\nc%d p%d 0 %.17g\nrl%d p%d 0 %.17g\n", k, k, k, k, k, 1e-5 / n,
                k, k, 1e4 * n);
    }
    fprintf(f, ".save v(p%d) v(p%d)\n.tran 10u 10m uic\n", n / 2, n);
    return end(&t);
}

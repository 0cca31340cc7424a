/* make_stretch_rule.c - runs during the build: Gauss' rule with 18 points, from long double, and what it makes of values.
 *
 * Each run of a variant would do this again, a tenth of its instructions. */
#include <math.h>
#include <stdio.h>

enum { N = 18, ROOM = 20 };

/* P_0 to P_(N-1) at x. */
static void polynomials(double x, double *p) {
    p[0] = 1.0;
    p[1] = x;
    for (int k = 1; k + 1 < N; k++) {
        p[k + 1] = ((2 * k + 1) * x * p[k] - k * p[k - 1]) / (k + 1);
    }
}

/* Newton's method on P_N from Tricomi's estimate of its zero i. */
static double find_node(int i, double *weight) {
    const double pi = 3.14159265358979323846;
    long double x = -cosl((long double)pi * (i + 0.75L) / (N + 0.5L));
    long double slope = 1.0L;
    for (int round = 0; round < 8; round++) {
        long double before = 1.0L;
        long double p = x;
        for (int k = 1; k < N; k++) {
            long double next = ((2 * k + 1) * x * p - k * before) / (k + 1);
            before = p;
            p = next;
        }
        slope = N * (x * p - before) / (x * x - 1.0L);
        x -= p / slope;
    }
    *weight = (double)(1.0L / ((1.0L - x * x) * slope * slope));
    return (double)x;
}

static void print_row(const double *value, int n) {
    printf("{");
    for (int k = 0; k < n; k++) {
        printf("%s%a", k > 0 ? ", " : "", value[k]);
    }
    printf("}");
}

int main(void) {
    double node[N];
    double weight[N];
    for (int i = 0; i < N; i++) {
        node[i] = find_node(i, &weight[i]);
    }
    printf("const struct dalcs_stretch_rule dalcs_stretch_rule = {\n.node = ");
    print_row(node, N);
    printf(",\n.weight = ");
    print_row(weight, N);
    printf(",\n.expand = {");
    for (int i = 0; i < N; i++) {
        double p[N];
        double expand[ROOM] = {0.0};
        polynomials(node[i], p);
        for (int k = 0; k < N; k++) {
            expand[k] = (2 * k + 1) * weight[i] * p[k];
        }
        print_row(expand, ROOM);
        printf(i + 1 < N ? ",\n" : "}};\n");
    }
    return 0;
}

/* make_collocation.c - runs while dalcs is built: prints the tables of all methods (make_tables.c), which
 * collocation.c includes. */
#include "make_tables.h"

#include <stdio.h>

static void print_reals(const char *name, int n, const double *x) {
    printf("        .%s = {", name);
    for (int i = 0; i < n; i++) {
        printf("%s%.17g", i > 0 ? ", " : "", x[i]);
    }
    printf("},\n");
}

static void print_square(const char *name, int s, const double (*x)[DALCS_MAX_NODES]) {
    printf("        .%s = {\n", name);
    for (int i = 0; i <= s; i++) {
        printf("            {");
        for (int k = 0; k <= s; k++) {
            printf("%s%.17g", k > 0 ? ", " : "", x[i][k]);
        }
        printf("},\n");
    }
    printf("        },\n");
}

static void print_exacts(const char *name, int n, const long double *x) {
    printf("        .%s = {", name);
    for (int i = 0; i < n; i++) {
        printf("%s%.21LgL", i > 0 ? ", " : "", x[i]);
    }
    printf("},\n");
}

static void print_halves(const char *name, const double *x) {
    printf("%s{", name);
    for (int i = 0; i < DALCS_EXTENDED_ROW; i++) {
        printf("%s%.17g", i > 0 ? ", " : "", x[i]);
    }
    printf("}");
}

static void print_rows(const char *name, int n, const struct dalcs_extended_row *row) {
    printf("        .%s = {\n", name);
    for (int k = 0; k < n; k++) {
        print_halves("            {", row[k].high);
        print_halves(", ", row[k].low);
        printf("},\n");
    }
    printf("        },\n");
}

static void print_complexes(int n, const double complex *x) {
    printf("{");
    for (int i = 0; i < n; i++) {
        printf("%sCMPLX(%.17g, %.17g)", i > 0 ? ", " : "", creal(x[i]), cimag(x[i]));
    }
    printf("}");
}

static void print_exact_complexes(int n, const long double complex *x) {
    printf("{");
    for (int i = 0; i < n; i++) {
        printf("%sCMPLXL(%.21LgL, %.21LgL)", i > 0 ? ", " : "", __real__(x[i]), __imag__(x[i]));
    }
    printf("}");
}

static void print_method(const struct dalcs_collocation *c) {
    int s = c->s;
    int pairs = DALCS_MAX_CONJUGATES;
    printf("    {\n        .family = %d,\n        .s = %d,\n", (int)c->family, s);
    printf("        .n_stages = %d,\n        .n_pairs = %d,\n", c->n_stages, c->n_pairs);
    print_reals("node", s + 1, c->node);
    printf("        .lambda = %.17g,\n        .mu = ", c->lambda);
    print_complexes(pairs, c->mu);
    printf(",\n");
    printf("        .exact.lambda = %.21LgL,\n        .exact.mu = ", c->exact.lambda);
    print_exact_complexes(pairs, c->exact.mu);
    printf(",\n");
    print_exacts("exact.back", c->n_stages, c->exact.back);
    print_rows("exact.to", 1 + 2 * c->n_pairs, c->exact.to);
    print_rows("exact.from", c->n_stages, c->exact.from);
    print_reals("bernstein.binomial", s + 1, c->bernstein.binomial);
    print_reals("barycentric", s + 1, c->barycentric);
    printf("        .differences.order = {");
    for (int k = 0; k <= s; k++) {
        printf("%s%d", k > 0 ? ", " : "", c->differences.order[k]);
    }
    printf("},\n");
    print_reals("differences.node", s + 1, c->differences.node);
    print_square("differences.coefficient", s, c->differences.coefficient);
    print_reals("back", c->n_stages, c->back);
    print_reals("weight", c->n_stages, c->weight);
    print_reals("quadrature.node", DALCS_MAX_NODES, c->quadrature.node);
    print_reals("quadrature.weight", DALCS_MAX_NODES, c->quadrature.weight);
    print_reals("worst.value", s + 1, c->worst.value);
    printf("        .worst.size = %.17g,\n", c->worst.size);
    printf("        .worst.node = %.17g,\n        .worst.factor = %.17g,\n", c->worst.node,
           c->worst.factor);
    printf("        .spread = %.17g,\n", c->spread);
    printf("        .bernstein.spread = %.17g,\n", c->bernstein.spread);
    print_square("bernstein.from_nodes", s, c->bernstein.from_nodes);
    printf("    },\n");
}

int main(void) {
    printf("/* made by make_collocation.c */\n");
    for (int s = 1; s <= DALCS_MAX_STAGES; s += 2) {
        struct dalcs_collocation c;
        dalcs_make_tables(&c, DALCS_RADAU_IIA, s);
        print_method(&c);
    }
    for (int s = 3; s <= DALCS_MAX_STAGES; s += 2) {
        struct dalcs_collocation c;
        dalcs_make_tables(&c, DALCS_LOBATTO_IIIC, s);
        print_method(&c);
    }
    return 0;
}

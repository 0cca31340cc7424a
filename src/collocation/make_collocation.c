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
    printf("        .exact_lambda = %.21LgL,\n        .exact_mu = ", c->exact_lambda);
    print_exact_complexes(pairs, c->exact_mu);
    printf(",\n");
    print_exacts("exact_back", c->n_stages, c->exact_back);
    print_rows("exact_to", 1 + 2 * c->n_pairs, c->exact_to);
    print_rows("exact_from", c->n_stages, c->exact_from);
    print_reals("binomial", s + 1, c->binomial);
    print_reals("barycentric", s + 1, c->barycentric);
    printf("        .newton_order = {");
    for (int k = 0; k <= s; k++) {
        printf("%s%d", k > 0 ? ", " : "", c->newton_order[k]);
    }
    printf("},\n");
    print_reals("newton_node", s + 1, c->newton_node);
    print_square("newton", s, c->newton);
    print_reals("back", c->n_stages, c->back);
    print_reals("weight", c->n_stages, c->weight);
    print_reals("gauss", DALCS_MAX_NODES, c->gauss);
    print_reals("gauss_weight", DALCS_MAX_NODES, c->gauss_weight);
    print_reals("test", s + 1, c->test);
    printf("        .test_size = %.17g,\n", c->test_size);
    printf("        .test_node = %.17g,\n        .test_factor = %.17g,\n", c->test_node,
           c->test_factor);
    printf("        .spread = %.17g,\n", c->spread);
    printf("        .bernstein_spread = %.17g,\n", c->bernstein_spread);
    print_square("to_bernstein", s, c->to_bernstein);
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

/* vector_random.c - functions of random values: sunif, sgauss, rnd and exponential, one value for each of the argument. */
#include "vector_formula.h"

#include "congruential.h"

#include <math.h>
#include <string.h>

static double chance(const struct dalcs_vector_formula *f) {
    return dalcs_congruential_chance(f->vectors->random);
}

/* Even between -1 and 1. */
static double even(const struct dalcs_vector_formula *f, double x) {
    (void)x;
    return 2.0 * chance(f) - 1.0;
}

/* Exponential with the mean x. */
static double exponential(const struct dalcs_vector_formula *f, double x) {
    return -x * log1p(-chance(f));
}

/* Normal with the deviation 1 (Box and Muller, Annals of Mathematical Statistics 29, 1958). */
static double normal(const struct dalcs_vector_formula *f, double x) {
    (void)x;
    const double radius = sqrt(exponential(f, 2.0));
    return radius * cos(2.0 * 3.141592653589793 * chance(f));
}

/* One of the whole numbers from 0 on and below x. */
static double whole(const struct dalcs_vector_formula *f, double x) {
    return floor(floor(fabs(x)) * chance(f));
}

static const struct {
    const char *name;
    double (*of)(const struct dalcs_vector_formula *f, double x);
} RANDOM[] = {{"sunif", even}, {"sgauss", normal}, {"rnd", whole}, {"exponential", exponential}};

bool dalcs_vector_is_random(const char *name) {
    bool is = false;
    for (size_t k = 0; k < sizeof RANDOM / sizeof RANDOM[0]; k++) {
        is = is || strcmp(RANDOM[k].name, name) == 0;
    }
    return is;
}

struct dalcs_vector *dalcs_vector_random(struct dalcs_vector_formula *f, const char *name,
                                         const struct dalcs_vector *x) {
    struct dalcs_vector *v = dalcs_vector_make(f, x->n, false);
    for (size_t i = 0; v != NULL && i < sizeof RANDOM / sizeof RANDOM[0]; i++) {
        for (size_t k = 0; k < x->n && strcmp(RANDOM[i].name, name) == 0; k++) {
            v->value[k] = RANDOM[i].of(f, creal(x->value[k]));
        }
    }
    return v;
}

/* draws.c - the generator, and the distributions of the functions in netlists.
 *
 * gauss of one argument is LTspice's, of three ngspice's, HSPICE's and Xyce's. A value is made from one number in
 * (0, 1), by the inverse of its distribution. */
#include "draws.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

/* ---- The generator ----------------------------------------------------------------------------- */

void dalcs_philox(const uint32_t counter[4], const uint32_t key[2], uint32_t out[4]) {
    enum { ROUNDS = 10 };

    static const uint32_t multiplier[] = {0xD2511F53, 0xCD9E8D57};
    static const uint32_t weyl[] = {0x9E3779B9, 0xBB67AE85};
    uint32_t x[] = {counter[0], counter[1], counter[2], counter[3]};
    uint32_t k[] = {key[0], key[1]};
    for (int round = 0; round < ROUNDS; round++) {
        const uint64_t a = (uint64_t)multiplier[0] * x[0];
        const uint64_t b = (uint64_t)multiplier[1] * x[2];
        x[0] = (uint32_t)(b >> 32) ^ x[1] ^ k[0];
        x[1] = (uint32_t)b;
        x[2] = (uint32_t)(a >> 32) ^ x[3] ^ k[1];
        x[3] = (uint32_t)a;
        k[0] += weyl[0];
        k[1] += weyl[1];
    }
    memcpy(out, x, sizeof x);
}

/* FNV-1a of 64 bits, the ending zero of each text included. */
const uint64_t dalcs_draw_hash_start = 0xCBF29CE484222325;

uint64_t dalcs_draw_hash(uint64_t hash, const char *text) {
    for (const char *c = text;; c++) {
        hash = (hash ^ (unsigned char)*c) * 0x100000001B3;
        if (*c == '\0') {
            return hash;
        }
    }
}

double dalcs_draw_uniform(uint64_t seed, uint32_t run, uint64_t place, uint32_t k) {
    const uint32_t counter[] = {k, run, (uint32_t)place, (uint32_t)(place >> 32)};
    const uint32_t key[] = {(uint32_t)seed, (uint32_t)(seed >> 32)};
    uint32_t x[4];
    dalcs_philox(counter, key, x);
    const uint64_t bits = ((uint64_t)x[1] << 32 | x[0]) >> 12; /* 52: the half is exact, too */
    return ldexp((double)bits + 0.5, -52);
}

double dalcs_draw_at(double whole) {
    char text[32];
    snprintf(text, sizeof text, "%.17g", whole);
    return dalcs_draw_uniform(1, 0, dalcs_draw_hash(dalcs_draw_hash_start, text), 0);
}

/* ---- The normal distribution ------------------------------------------------------------------- */

static double polynomial(const double *c, double x) {
    double value = c[7];
    for (int k = 6; k >= 0; k--) {
        value = value * x + c[k];
    }
    return value;
}

static double ratio(const double (*c)[8], double x) {
    return polynomial(c[0], x) / polynomial(c[1], x);
}

double dalcs_normal_quantile(double p) {
    static const double middle[2][8] = {
        {3.3871328727963666080, 1.3314166789178437745e2, 1.9715909503065514427e3,
         1.3731693765509461125e4, 4.5921953931549871457e4, 6.7265770927008700853e4,
         3.3430575583588128105e4, 2.5090809287301226727e3},
        {1.0, 4.2313330701600911252e1, 6.8718700749205790830e2, 5.3941960214247511077e3,
         2.1213794301586595867e4, 3.9307895800092710610e4, 2.8729085735721942674e4,
         5.2264952788528545610e3}};
    static const double near[2][8] = {
        {1.42343711074968357734, 4.63033784615654529590, 5.76949722146069140550,
         3.64784832476320460504, 1.27045825245236838258, 2.41780725177450611770e-1,
         2.27238449892691845833e-2, 7.74545014278341407640e-4},
        {1.0, 2.05319162663775882187, 1.67638483018380384940, 6.89767334985100004550e-1,
         1.48103976427480074590e-1, 1.51986665636164571966e-2, 5.47593808499534494600e-4,
         1.05075007164441684324e-9}};
    static const double far[2][8] = {
        {6.65790464350110377720, 5.46378491116411436990, 1.78482653991729133580,
         2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
         2.71155556874348757815e-5, 2.01033439929228813265e-7},
        {1.0, 5.99832206555887937690e-1, 1.36929880922735805310e-1, 1.48753612908506148525e-2,
         7.86869131145613259100e-4, 1.84631831751005468180e-5, 1.42151175831644588870e-7,
         2.04426310338993978564e-15}};
    const double q = p - 0.5;
    if (fabs(q) <= 0.425) {
        return q * ratio(middle, 0.180625 - q * q);
    }
    const double r = sqrt(-log(q < 0 ? p : 1 - p));
    return copysign(r <= 5 ? ratio(near, r - 1.6) : ratio(far, r - 5), q);
}

/* ---- The functions ----------------------------------------------------------------------------- */

static double spread(double u) {
    return 2 * u - 1;
}

/* 0 and 1, which are never drawn, are the ends of what is tolerated, so many standard deviations away. */
static double normal(double u, double sigmas) {
    return u <= 0 ? -sigmas : u >= 1 ? sigmas : dalcs_normal_quantile(u);
}

static double draw_gauss_alone(const double *x, int n, double u) {
    static const double usual = 3;
    (void)n;
    return x[0] * normal(u, usual);
}

/* The last argument says how many standard deviations the variation is; one without it. */
static double draw_agauss(const double *x, int n, double u) {
    const double sigmas = n > 2 ? x[2] : 1;
    return x[0] + x[1] / sigmas * normal(u, sigmas);
}

static double draw_gauss(const double *x, int n, double u) {
    const double sigmas = n > 2 ? x[2] : 1;
    return x[0] + x[0] * x[1] / sigmas * normal(u, sigmas);
}

static double draw_flat(const double *x, int n, double u) {
    (void)n;
    return x[0] * spread(u);
}

static double draw_aunif(const double *x, int n, double u) {
    (void)n;
    return x[0] + x[1] * spread(u);
}

static double draw_unif(const double *x, int n, double u) {
    (void)n;
    return x[0] + x[0] * x[1] * spread(u);
}

/* Either end of the range; a half is no draw but the middle of them all. */
static double draw_limit(const double *x, int n, double u) {
    (void)n;
    return u == 0.5 ? x[0] : u > 0.5 ? x[0] + x[1] : x[0] - x[1];
}

static double draw_rand(const double *x, int n, double u) {
    (void)x;
    (void)n;
    return u;
}

static const struct {
    const char *name;
    int least, most;
    dalcs_draw *draw;
    const char *usage; /* of the name */
} FUNCTIONS[] = {
    {"gauss", 1, 1, draw_gauss_alone,
     "gauss(sigma) of LTspice, or gauss(nominal, relative, sigmas) of ngspice"},
    {"gauss", 2, 3, draw_gauss,
     "gauss(sigma) of LTspice, or gauss(nominal, relative, sigmas) of ngspice"},
    {"agauss", 2, 3, draw_agauss, "agauss(nominal, absolute, sigmas)"},
    {"flat", 1, 1, draw_flat, "flat(x) is between -x and x"},
    {"mc", 2, 2, draw_unif, "mc(nominal, relative), such as mc(1k, 0.05)"},
    {"unif", 2, 2, draw_unif, "unif(nominal, relative), such as unif(1k, 0.05)"},
    {"aunif", 2, 2, draw_aunif, "aunif(nominal, absolute), such as aunif(1k, 50)"},
    {"limit", 2, 2, draw_limit,
     "limit(nominal, absolute) is one of two ends, limit(x, low, high) keeps x between them"},
    {"rand", 0, 0, draw_rand,
     "rand() is drawn between 0 and 1, rand(x) has a value for each whole x"},
};

enum { N_FUNCTIONS = sizeof FUNCTIONS / sizeof FUNCTIONS[0] };

dalcs_draw *dalcs_draw_find(const char *name, int n, bool *is_known) {
    *is_known = false;
    for (int k = 0; k < N_FUNCTIONS; k++) {
        if (strcmp(FUNCTIONS[k].name, name) != 0) {
            continue;
        }
        *is_known = true;
        if (n >= FUNCTIONS[k].least && n <= FUNCTIONS[k].most) {
            return FUNCTIONS[k].draw;
        }
    }
    return NULL;
}

const char *dalcs_draw_usage(const char *name) {
    for (int k = 0; k < N_FUNCTIONS; k++) {
        if (strcmp(FUNCTIONS[k].name, name) == 0) {
            return FUNCTIONS[k].usage;
        }
    }
    return NULL;
}

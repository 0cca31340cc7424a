/* diode_families.c - diodes whose names say their current and voltage: MBR2060CT, MUR1560, RURG3060, STTH8R06, C3D10060A.
 *
 * What such diodes drop depends on the voltage that they block, far less on the maker. Those are typical figures at a
 * tenth of the rated current and at all of it, read from datasheets of each kind to 0.05 V. */
#include "diode_families.h"

#include <stdlib.h>
#include <string.h>

/* At i/10 and i, of diodes that block up to this voltage. */
struct drop {
    double volts, tenth, rated;
};

enum { MOST_DROPS = 5 };

static const struct drop SCHOTTKY[MOST_DROPS] = {
    {30, 0.27, 0.47}, {45, 0.30, 0.55}, {60, 0.38, 0.65}, {100, 0.45, 0.74}, {300, 0.55, 0.85}};
static const struct drop STANDARD[MOST_DROPS] = {{1000, 0.72, 0.95}};
static const struct drop FAST[MOST_DROPS] = {{200, 0.70, 0.92},
                                             {400, 0.78, 1.15},
                                             {600, 0.85, 1.35},
                                             {1000, 1.00, 1.65},
                                             {1200, 1.10, 2.00}};
static const struct drop HYPERFAST[MOST_DROPS] = {{200, 0.75, 1.00},
                                                  {400, 0.90, 1.40},
                                                  {600, 1.05, 1.80},
                                                  {1000, 1.20, 2.00},
                                                  {1200, 1.40, 2.60}};
static const struct drop CARBIDE[MOST_DROPS] = {
    {650, 0.95, 1.50}, {1200, 0.95, 1.55}, {1700, 1.00, 1.70}};

/* How a name goes on behind its prefix. */
enum form {
    DIGITS,    /* current and voltage in one number: 1560, 20100, 0520 */
    SPLIT,     /* the same with letters between: 20l45, 8r06, 10g65 */
    CODED,     /* a digit and the number of a voltage: 107 */
    LETTERED,  /* a digit and a letter for a voltage: 2d */
    CARBIDE_5, /* two digits and three, the first of which may be 1p7: 10060 */
    SINGLE,    /* a digit and one or two: 24, 310 */
    VOLTS_FIRST /* two or three digits, then two that are tenths of amperes, then letters: 3010bea, 10020elr */
};

static const struct family {
    const char *prefix;
    enum form form;
    double unit; /* V of what stands for the voltage */
    enum dalcs_junction junction;
    const struct drop *drop;
} FAMILIES[] = {
    {"mbrs", DIGITS, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"mbrb", DIGITS, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"mbrf", DIGITS, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"mbrd", DIGITS, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"mbr", DIGITS, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"mbrb", SPLIT, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"mbr", SPLIT, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"mbrm", DIGITS, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"pds", DIGITS, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"dfls", DIGITS, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"cmsh", SPLIT, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"pmeg", VOLTS_FIRST, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"sb", DIGITS, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"sr", DIGITS, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"b", DIGITS, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"stps", DIGITS, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"stps", SPLIT, 1, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"ss", SINGLE, 10, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"sk", SINGLE, 10, DALCS_JUNCTION_SCHOTTKY, SCHOTTKY},
    {"murs", DIGITS, 10, DALCS_JUNCTION_SILICON, FAST},
    {"murd", DIGITS, 10, DALCS_JUNCTION_SILICON, FAST},
    {"murb", DIGITS, 10, DALCS_JUNCTION_SILICON, FAST},
    {"mur", DIGITS, 10, DALCS_JUNCTION_SILICON, FAST},
    {"rurg", DIGITS, 10, DALCS_JUNCTION_SILICON, FAST},
    {"rurp", DIGITS, 10, DALCS_JUNCTION_SILICON, FAST},
    {"rurd", DIGITS, 10, DALCS_JUNCTION_SILICON, FAST},
    {"rhrg", DIGITS, 10, DALCS_JUNCTION_SILICON, HYPERFAST},
    {"rhrp", DIGITS, 10, DALCS_JUNCTION_SILICON, HYPERFAST},
    {"rhrd", DIGITS, 10, DALCS_JUNCTION_SILICON, HYPERFAST},
    {"isl9r", DIGITS, 10, DALCS_JUNCTION_SILICON, HYPERFAST},
    {"stth", SPLIT, 100, DALCS_JUNCTION_SILICON, FAST},
    {"stth", DIGITS, 100, DALCS_JUNCTION_SILICON, FAST},
    {"dsei", SPLIT, 100, DALCS_JUNCTION_SILICON, FAST},
    {"dsep", SPLIT, 100, DALCS_JUNCTION_SILICON, FAST},
    {"her", CODED, 0, DALCS_JUNCTION_SILICON, FAST},
    {"fr", CODED, 0, DALCS_JUNCTION_SILICON, STANDARD},
    {"es", LETTERED, 0, DALCS_JUNCTION_SILICON, FAST},
    {"us", LETTERED, 0, DALCS_JUNCTION_SILICON, FAST},
    {"rs", LETTERED, 0, DALCS_JUNCTION_SILICON, STANDARD},
    {"s", LETTERED, 0, DALCS_JUNCTION_SILICON, STANDARD},
    {"c2d", CARBIDE_5, 10, DALCS_JUNCTION_SCHOTTKY, CARBIDE},
    {"c3d", CARBIDE_5, 10, DALCS_JUNCTION_SCHOTTKY, CARBIDE},
    {"c4d", CARBIDE_5, 10, DALCS_JUNCTION_SCHOTTKY, CARBIDE},
    {"c6d", CARBIDE_5, 10, DALCS_JUNCTION_SCHOTTKY, CARBIDE},
    {"idh", SPLIT, 10, DALCS_JUNCTION_SCHOTTKY, CARBIDE},
    {"idw", SPLIT, 10, DALCS_JUNCTION_SCHOTTKY, CARBIDE},
};

/* ---- Numbers in names -------------------------------------------------------------------------------- */

static size_t count_digits(const char *text, size_t n) {
    size_t k = 0;
    while (k < n && text[k] >= '0' && text[k] <= '9') {
        k++;
    }
    return k;
}

/* The number that n digits are; 05 is 0.5 A where a current is meant, 02 is 20 V. */
static double value_of(const char *text, size_t n) {
    double value = 0;
    for (size_t k = 0; k < n; k++) {
        value = 10 * value + (text[k] - '0');
    }
    return value;
}

static bool set(double amperes, double volts, double *rated) {
    rated[0] = amperes;
    rated[1] = volts;
    return amperes > 0 && volts > 0;
}

/* 3 digits are 1 and 2, 5 are 2 and 3; 4 are 2 and 2, unless the last three are 100 or, of what counts tens, 120. */
static bool read_digits(const char *text, size_t n, double unit, double *rated) {
    if (count_digits(text, n) != n || n < 3 || n > 5) {
        return false;
    }
    const double last = value_of(text + n - 3, 3);
    const bool is_three =
        n == 5 ? unit < 100 : n == 4 && (last == 100 || (unit == 10 && last == 120));
    const size_t n_volts = is_three ? 3 : 2;
    const double amperes = value_of(text, n - n_volts);
    const char *volts = text + n - n_volts;
    const bool is_tens = n_volts == 2 && volts[0] == '0' && unit == 1;
    return set(text[0] == '0' ? amperes / 10 : amperes,
               value_of(volts, n_volts) * (is_tens ? 10 : 1) * unit, rated);
}

/* What is behind the voltage, as in idh10g65c5, does not matter. */
static bool read_split(const char *text, size_t n, double unit, double *rated) {
    const size_t n_amperes = count_digits(text, n);
    size_t at = n_amperes;
    while (at < n && ((text[at] >= 'a' && text[at] <= 'z') || text[at] == '-')) {
        at++;
    }
    const size_t n_volts = count_digits(text + at, n - at);
    return n_amperes > 0 && n_amperes <= 3 && at > n_amperes && at - n_amperes <= 3 &&
           n_volts >= 2 && n_volts <= 3 &&
           set(value_of(text, n_amperes), value_of(text + at, n_volts) * unit, rated);
}

static bool read_coded(const char *text, size_t n, bool has_300, double *rated) {
    static const double volts[2][8] = {{50, 100, 200, 400, 600, 800, 1000, 0},
                                       {50, 100, 200, 300, 400, 600, 800, 1000}};
    const bool is_code =
        n == 3 && count_digits(text, n) == n && text[1] == '0' && text[2] >= '1' && text[2] <= '8';
    return is_code && set(text[0] - '0', volts[has_300][text[2] - '1'], rated);
}

static bool read_lettered(const char *text, size_t n, double *rated) {
    static const char letters[] = "abdgjkm";
    static const double volts[] = {50, 100, 200, 400, 600, 800, 1000};
    const char *letter = n == 2 && text[1] != '\0' ? strchr(letters, text[1]) : NULL;
    return letter != NULL && count_digits(text, n) == 1 &&
           set(text[0] - '0', volts[letter - letters], rated);
}

static bool read_carbide(const char *text, size_t n, double unit, double *rated) {
    const bool has_point = n > 3 && text[1] == 'p' && count_digits(text + 2, n - 2) >= 4;
    const char *volts = text + (has_point ? 3 : 2);
    const size_t left = n - (size_t)(volts - text);
    if (n < 5 || count_digits(volts, left) < 3 || (!has_point && count_digits(text, n) < 5)) {
        return false;
    }
    const double amperes = has_point ? (text[0] - '0') + 0.1 * (text[2] - '0') : value_of(text, 2);
    return left <= 4 && set(amperes, value_of(volts, 3) * unit, rated);
}

static bool read_single(const char *text, size_t n, double unit, double *rated) {
    return count_digits(text, n) == n && (n == 2 || n == 3) &&
           set(text[0] - '0', value_of(text + 1, n - 1) * unit, rated);
}

static bool read_volts_first(const char *text, size_t n, double *rated) {
    const size_t digits = count_digits(text, n);
    return (digits == 4 || digits == 5) && n - digits <= 4 &&
           set(value_of(text + digits - 2, 2) / 10, value_of(text, digits - 2), rated);
}

/* rated: A and V */
static bool read_rating(const struct family *f, const char *text, size_t n, double *rated) {
    switch (f->form) {
    case DIGITS:
        return read_digits(text, n, f->unit, rated);
    case SPLIT:
        return read_split(text, n, f->unit, rated);
    case CODED:
        return read_coded(text, n, f->drop == FAST, rated);
    case LETTERED:
        return read_lettered(text, n, rated);
    case CARBIDE_5:
        return read_carbide(text, n, f->unit, rated);
    case SINGLE:
        return read_single(text, n, f->unit, rated);
    case VOLTS_FIRST:
        return read_volts_first(text, n, rated);
    }
    return false;
}

/* ---- All of them --------------------------------------------------------------------------------------- */

/* A voltage above those of the family is not one of it. */
static const struct drop *find_drop(const struct family *f, double volts) {
    int k = 0;
    while (k < MOST_DROPS && f->drop[k].volts < volts) {
        k++;
    }
    return k < MOST_DROPS ? &f->drop[k] : NULL;
}

bool dalcs_diode_family_find(const char *name, size_t n, struct dalcs_diode_part *part) {
    for (size_t k = 0; k < sizeof FAMILIES / sizeof FAMILIES[0]; k++) {
        const struct family *f = &FAMILIES[k];
        const size_t prefix = strlen(f->prefix);
        double rated[2];
        if (n <= prefix || strncmp(name, f->prefix, prefix) != 0 ||
            !read_rating(f, name + prefix, n - prefix, rated)) {
            continue;
        }
        const struct drop *drop = find_drop(f, rated[1]);
        if (drop != NULL) {
            *part = (struct dalcs_diode_part){
                f->junction, {rated[0] / 10, rated[0]}, {drop->tenth, drop->rated}, rated[1], 1e-4};
            return true;
        }
    }
    return false;
}

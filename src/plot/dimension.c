/* dimension.c - units by their exponents. */
#include "dimension.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { MAX_EXPONENT = 4 };

static const struct {
    struct dalcs_dimension dimension;
    const char *unit, *quantity;
} known[] = {
    {{.volt = 1}, "V", "voltage"},
    {{.ampere = 1}, "A", "current"},
    {{.volt = 1, .ampere = 1}, "W", "power"},
    {{.second = 1}, "s", "time"},
    {{.second = -1}, "Hz", "frequency"},
    {{.volt = 1, .ampere = -1}, "\316\251", "resistance"},
    {{.volt = -1, .ampere = 1}, "S", "conductance"},
    {{.volt = 1, .ampere = 1, .second = 1}, "J", "energy"},
    {{.ampere = 1, .second = 1}, "C", "charge"},
    {{.volt = 1, .second = 1}, "Wb", "flux"},
    {{.degree = true}, "\302\260", "phase"},
    {{.decibel = true}, "dB", "magnitude"},
    {{.volt = 0}, "", "value"},
};

enum { N_KNOWN = sizeof known / sizeof known[0] };

bool dalcs_dimension_equal(struct dalcs_dimension a, struct dalcs_dimension b) {
    return a.volt == b.volt && a.ampere == b.ampere && a.second == b.second &&
           a.degree == b.degree && a.decibel == b.decibel;
}

struct dalcs_dimension dalcs_dimension_multiply(struct dalcs_dimension a, struct dalcs_dimension b,
                                                int sign) {
    const int exponent[3] = {a.volt + sign * b.volt, a.ampere + sign * b.ampere,
                             a.second + sign * b.second};
    for (int i = 0; i < 3; i++) {
        if (exponent[i] > MAX_EXPONENT || exponent[i] < -MAX_EXPONENT) {
            return (struct dalcs_dimension){0};
        }
    }
    return (struct dalcs_dimension){.volt = (signed char)exponent[0],
                                    .ampere = (signed char)exponent[1],
                                    .second = (signed char)exponent[2]};
}

static int find_known(struct dalcs_dimension dimension) {
    for (int i = 0; i < N_KNOWN; i++) {
        if (dalcs_dimension_equal(known[i].dimension, dimension)) {
            return i;
        }
    }
    return -1;
}

const char *dalcs_dimension_unit(char text[DALCS_DIMENSION_TEXT],
                                 struct dalcs_dimension dimension) {
    int k = find_known(dimension);
    if (k >= 0) {
        return known[k].unit;
    }
    const char *const symbol[3] = {"V", "A", "s"};
    const int exponent[3] = {dimension.volt, dimension.ampere, dimension.second};
    char *c = text;
    *c = '\0';
    for (int i = 0; i < 3; i++) {
        if (exponent[i] == 1) {
            c += sprintf(c, "%s%s", c > text ? " " : "", symbol[i]);
        } else if (exponent[i] != 0) {
            c += sprintf(c, "%s%s^%d", c > text ? " " : "", symbol[i], exponent[i]);
        }
    }
    return text;
}

const char *dalcs_dimension_quantity(struct dalcs_dimension dimension) {
    int k = find_known(dimension);
    return k >= 0 ? known[k].quantity : "value";
}

struct dalcs_dimension dalcs_dimension_of_name(const char *name) {
    static const struct {
        const char *word;
        struct dalcs_dimension dimension;
    } of_word[] = {{"time", {.second = 1}}, {"frequency", {.second = -1}}};

    for (size_t i = 0; i < sizeof of_word / sizeof of_word[0]; i++) {
        if (strcasecmp(name, of_word[i].word) == 0) {
            return of_word[i].dimension;
        }
    }
    const struct dalcs_dimension volt = {.volt = 1}, ampere = {.ampere = 1};
    const char *bracket = strchr(name, '[');
    if (strncasecmp(name, "v(", 2) == 0) {
        return volt;
    }
    if (strncasecmp(name, "i(", 2) == 0 || strstr(name, "#branch") ||
        (name[0] == '@' && bracket && strncasecmp(bracket, "[i", 2) == 0)) {
        return ampere;
    }
    return (struct dalcs_dimension){0};
}

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
    {{1, 0, 0, false}, "V", "voltage"},      {{0, 1, 0, false}, "A", "current"},
    {{1, 1, 0, false}, "W", "power"},        {{0, 0, 1, false}, "s", "time"},
    {{0, 0, -1, false}, "Hz", "frequency"},  {{1, -1, 0, false}, "\316\251", "resistance"},
    {{-1, 1, 0, false}, "S", "conductance"}, {{1, 1, 1, false}, "J", "energy"},
    {{0, 1, 1, false}, "C", "charge"},       {{1, 0, 1, false}, "Wb", "flux"},
    {{0, 0, 0, true}, "\302\260", "phase"},  {{0, 0, 0, false}, "", "value"},
};

enum { N_KNOWN = sizeof known / sizeof known[0] };

bool dalcs_dimension_equal(struct dalcs_dimension a, struct dalcs_dimension b) {
    return a.volt == b.volt && a.ampere == b.ampere && a.second == b.second && a.degree == b.degree;
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
    return (struct dalcs_dimension){(signed char)exponent[0], (signed char)exponent[1],
                                    (signed char)exponent[2], false};
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
    } of_word[] = {{"time", {0, 0, 1, false}}, {"frequency", {0, 0, -1, false}}};

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

/* line.c - lossless transmission lines.
 *
 *     Tname a b c d Z0=ohms TD=seconds        or F=hertz [NL=wavelengths, 0.25] in the place of TD
 *
 * With currents into the line at both ports, v1 + Z0 i1 is what comes out at the other port TD later:
 *     v1 = Z0 i1 + (v2 + Z0 i2)(t - TD),      v2 = Z0 i2 + (v1 + Z0 i1)(t - TD)
 * (Branin, Proc. IEEE 55, 1967). So each port is a resistor of Z0 and a delayed source, and what is delayed is the sum of
 * the port's voltage and the resistor's. At rest the two sources read each other: v1 = v2, i1 = -i2. */
#include "later.h"
#include "reader.h"

#include <math.h>
#include <string.h>

static const char USAGE[] = "a transmission line is: Tname a b c d Z0=ohms TD=seconds";

enum { Z0, TD, FREQUENCY, LENGTH, N_PARAMETERS };

struct line {
    double value[N_PARAMETERS];
    const struct dalcs_token *place[N_PARAMETERS]; /* NULL: not on the card */
    double ohms, seconds;
    double initial[4]; /* V, A, V, A */
};

static bool read_parameter(struct dalcs_reader *reader, const struct dalcs_token *name,
                           struct line *line) {
    static const char *const names[] = {"z0", "td", "f", "nl"};

    static const enum dalcs_quantity quantity[] = {DALCS_OHM, DALCS_SECOND, DALCS_HERTZ,
                                                   DALCS_PLAIN};

    if (strcmp(name->text, "ic") == 0) {
        bool ok = true;
        for (int k = 0; k < 4 && ok; k++) {
            ok = dalcs_reader_list_number(reader, k % 2 == 0 ? DALCS_VOLTAGE : DALCS_CURRENT,
                                          "the other one of v1,i1,v2,i2", &line->initial[k]);
        }
        return ok;
    }
    for (int k = 0; k < N_PARAMETERS; k++) {
        if (strcmp(name->text, names[k]) == 0) {
            line->place[k] = name;
            return dalcs_reader_number(reader, quantity[k], "a value", &line->value[k]);
        }
    }
    dalcs_builder_error(reader->builder, name, USAGE, "a transmission line has no parameter '%s'",
                        name->text);
    return false;
}

/* Z0, and TD or else NL/F. */
static bool read_values(struct dalcs_reader *reader, const struct dalcs_token *card,
                        struct line *line) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *name;
    line->value[LENGTH] = 0.25;
    while ((name = dalcs_reader_take_parameter(reader)) != NULL) {
        if (!read_parameter(reader, name, line)) {
            return false;
        }
    }
    if (!dalcs_reader_end(reader)) {
        return false;
    }
    const bool by_frequency = line->place[TD] == NULL && line->place[FREQUENCY] != NULL;
    line->ohms = line->value[Z0];
    line->seconds = by_frequency ? line->value[LENGTH] / line->value[FREQUENCY] : line->value[TD];
    const bool has_ohms = line->ohms > 0 && isfinite(line->ohms);
    const bool has_seconds = line->seconds > 0 && isfinite(line->seconds);
    const struct dalcs_token *place = line->place[!has_ohms ? Z0 : by_frequency ? FREQUENCY : TD];
    if (!has_ohms || !has_seconds) {
        dalcs_builder_error(builder, place != NULL ? place : card, USAGE,
                            "a transmission line has %s",
                            has_ohms ? "a delay above 0 s" : "an impedance Z0 above 0 ohm");
    }
    return has_ohms && has_seconds;
}

/* A sum of two voltages against ground at a new node: v(plus[0], plus[1]) + v(more[0], more[1]); -1: out of memory. */
static int add_sum(struct dalcs_builder *builder, const struct dalcs_token *name, int port,
                   const int *one, const int *other) {
    const char *what[2] = {dalcs_builder_hint(builder, "wave%d", port),
                           dalcs_builder_hint(builder, "half%d", port)};
    int node[3] = {0, 0, 0};
    for (int k = 0; k < 2 && node[k] >= 0; k++) {
        node[k] = what[k] != NULL ? dalcs_builder_inner_node(builder, what[k], name) : -1;
    }
    for (int k = 0; k < 2 && node[0] > 0 && node[1] > 0; k++) {
        struct dalcs_device *e = dalcs_builder_add_inner_device(builder, DALCS_VCVS, what[k], name);
        if (e == NULL) {
            return -1;
        }
        e->node[0] = node[k];
        e->node[1] = node[k + 1];
        e->node[2] = k == 0 ? one[0] : other[0];
        e->node[3] = k == 0 ? one[1] : other[1];
        e->value = 1;
    }
    return node[0] > 0 && node[1] > 0 ? node[0] : -1;
}

void dalcs_line_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct line line = {0};
    struct dalcs_device *r[2] = {
        dalcs_builder_add_device(builder, DALCS_RESISTOR, card->token),
        dalcs_builder_add_inner_device(builder, DALCS_RESISTOR, "other_end", card->token)};
    int node[4];
    if (r[0] == NULL || r[1] == NULL || !dalcs_reader_nodes(&reader, 4, node) ||
        !read_values(&reader, card->token, &line)) {
        builder->hidden |= DALCS_HIDDEN_ELEMENTS;
        return;
    }
    static const char *const what[2] = {"line1", "line2"};
    int inside[2];
    for (int k = 0; k < 2; k++) {
        inside[k] = dalcs_builder_inner_node(builder, k == 0 ? "end1" : "end2", card->token);
        r[k]->node[0] = node[2 * k];
        r[k]->node[1] = inside[k];
        r[k]->value = line.ohms;
    }
    for (int k = 0; k < 2 && inside[0] > 0 && inside[1] > 0; k++) {
        const int far = 1 - k;
        const int input = add_sum(builder, card->token, far + 1, &node[2 * far],
                                  (int[]){node[2 * far], inside[far]});
        const struct dalcs_later later = {.name = card->token,
                                          .what = what[k],
                                          .input = input,
                                          .output = {inside[k], node[2 * k + 1]},
                                          .seconds = line.seconds,
                                          .initial = line.initial[2 * far] +
                                                     line.ohms * line.initial[2 * far + 1]};
        if (input > 0) {
            dalcs_later_add(builder, &later);
        }
    }
}

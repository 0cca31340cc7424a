/* sketch.c - drawing random circuits and writing them as netlists. */
#include "sketch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

uint64_t splitmix_next(struct splitmix *r) {
    r->state += 0x9e3779b97f4a7c15u;
    uint64_t z = r->state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

int splitmix_below(struct splitmix *r, int n) {
    return (int)(splitmix_next(r) % (uint64_t)n);
}

struct draw {
    struct splitmix random;
    enum sketch_family family;
    struct sketch s;
    int first_node; /* 1 when the circuit floats */
    int n_pairs;
};

static bool chance(struct draw *d, int percent) {
    return splitmix_below(&d->random, 100) < percent;
}

static int between(struct draw *d, int low, int high) {
    return low + splitmix_below(&d->random, high - low + 1);
}

static int any_node(struct draw *d) {
    return between(d, d->first_node, d->s.n_nodes - 1);
}

static struct sketch_element *add(struct draw *d, char kind, int a, int b) {
    struct sketch_element *e = &d->s.element[d->s.n++];
    *e = (struct sketch_element){.kind = kind, .node = {a, b}};
    return e;
}

/* Two nodes, nearly always different ones. */
static struct sketch_element *add_anywhere(struct draw *d, char kind) {
    int a = any_node(d);
    int b = any_node(d);
    while (a == b && !chance(d, 3)) {
        b = any_node(d);
    }
    return add(d, kind, a, b);
}

static bool room_for_pairs(const struct draw *d, int n) {
    return d->n_pairs + n <= SKETCH_MAX_DIODES && d->s.n + n <= SKETCH_MAX_ELEMENTS - 16;
}

static void add_diode(struct draw *d, int a, int b) {
    int model = chance(d, 85) ? 0 : between(d, 1, 3);
    int n_pairs = model == 3 ? 2 : 1;
    if (room_for_pairs(d, n_pairs)) {
        add(d, 'd', a, b)->model = model;
        d->n_pairs += n_pairs;
    }
}

/* The patterns that make degenerate problems; random ones would be rare at seven nodes. */
static void add_pattern(struct draw *d) {
    int a = any_node(d);
    int b = any_node(d);
    int c = any_node(d);
    int e = any_node(d);
    switch (splitmix_below(&d->random, 5)) {
    case 0: /* antiparallel */
        add_diode(d, a, b);
        add_diode(d, b, a);
        break;
    case 1: /* parallel */
        add_diode(d, a, b);
        add_diode(d, a, b);
        break;
    case 2: /* ring */
        add_diode(d, a, b);
        add_diode(d, b, c);
        add_diode(d, c, a);
        break;
    case 3: /* stack */
        add_diode(d, a, b);
        add_diode(d, b, c);
        add_diode(d, c, e);
        break;
    default: /* bridge from a, b to c, e */
        add_diode(d, a, c);
        add_diode(d, b, c);
        add_diode(d, e, a);
        add_diode(d, e, b);
        break;
    }
}

static double small(struct draw *d) {
    return between(d, 1, 3);
}

static double decade(struct draw *d, int largest) {
    return pow(10.0, between(d, -largest, largest));
}

static void add_passives(struct draw *d) {
    bool spread = d->family == SKETCH_SPREAD;
    for (int k = between(d, 0, 5); k > 0; k--) {
        struct sketch_element *e = add_anywhere(d, 'r');
        e->value = spread ? decade(d, 9) : small(d);
        if (chance(d, 4)) {
            e->value = 0.0;
            e->saved = chance(d, 50);
        }
    }
    for (int k = between(d, -1, 2); k > 0; k--) {
        struct sketch_element *e = add_anywhere(d, 'c');
        e->value = spread ? decade(d, 6) : small(d);
        e->initial = between(d, -3, 3);
        e->saved = chance(d, 30);
    }
    int coil = d->s.n;
    int n_coils = between(d, -2, 2);
    for (int k = 0; k < n_coils; k++) {
        struct sketch_element *e = add_anywhere(d, 'l');
        e->value = spread ? decade(d, 6) : small(d);
        e->initial = between(d, -3, 3);
    }
    if (n_coils == 2 && chance(d, 40)) {
        bool is_perfect = chance(d, 50);
        add(d, 'k', coil, coil + 1)->value = is_perfect ? 1.0 : 0.5;
        if (is_perfect && spread) { /* the ratio of turns decides what is feasible: 1, 2 or 3 */
            double turns = small(d);
            d->s.element[coil + 1].value = d->s.element[coil].value * turns * turns;
        }
    }
}

static void add_sources(struct draw *d) {
    for (int k = between(d, 0, 2); k > 0; k--) {
        add_anywhere(d, 'v')->value = between(d, -4, 4);
    }
    for (int k = between(d, -1, 2); k > 0; k--) {
        add_anywhere(d, 'i')->value = between(d, -2, 2);
    }
}

static void add_switches(struct draw *d) {
    for (int k = between(d, 1, 3); k > 0; k--) {
        struct sketch_element *e = add_anywhere(d, 's');
        e->node[2] = any_node(d);
        e->node[3] = any_node(d);
        e->on = chance(d, 50);
        e->model = chance(d, 80) ? 0 : 1;
    }
}

static void add_controlled(struct draw *d) {
    int source = -1;
    for (int k = 0; k < d->s.n; k++) {
        source = d->s.element[k].kind == 'v' ? k : source;
    }
    for (int k = between(d, 1, 2); k > 0; k--) {
        char kind = "egfh"[splitmix_below(&d->random, source >= 0 ? 4 : 2)];
        struct sketch_element *e = add_anywhere(d, kind);
        e->value = between(d, 1, 3) * (chance(d, 50) ? 1 : -1);
        bool by_current = kind == 'f' || kind == 'h';
        e->node[2] = by_current ? source : any_node(d);
        e->node[3] = by_current ? 0 : any_node(d);
    }
}

struct sketch sketch_random(enum sketch_family family, uint64_t seed) {
    struct draw d = {.random = {seed}, .family = family};
    d.first_node = chance(&d, 15) ? 1 : 0;
    d.s.n_nodes = between(&d, 2, 7) + d.first_node;
    if (d.first_node == 1 && d.s.n_nodes < 3) {
        d.s.n_nodes = 3;
    }
    add_sources(&d);
    add_passives(&d);
    if (family == SKETCH_SWITCHES) {
        add_switches(&d);
    } else if (family == SKETCH_CONTROLLED) {
        add_controlled(&d);
    }
    int n_diodes = between(&d, 1, SKETCH_MAX_DIODES);
    while (d.n_pairs < n_diodes && room_for_pairs(&d, 1)) {
        if (chance(&d, 25)) {
            add_pattern(&d);
        } else {
            int a = any_node(&d);
            int b = any_node(&d);
            if (a != b || chance(&d, 3)) {
                add_diode(&d, a, b);
            }
        }
    }
    return d.s;
}

struct sketch sketch_unit_values(const struct sketch *sketch) {
    struct sketch unit = *sketch;
    for (int k = 0; k < unit.n; k++) {
        struct sketch_element *e = &unit.element[k];
        if (strchr("rlc", e->kind) != NULL && e->value != 0.0) {
            e->value = 1.0;
        }
    }
    for (int k = 0; k < unit.n; k++) {
        const struct sketch_element *e = &unit.element[k];
        if (e->kind == 'k' && e->value == 1.0) { /* an ideal transformer keeps its ratio */
            const struct sketch_element *coil = sketch->element;
            unit.element[e->node[1]].value = coil[e->node[1]].value / coil[e->node[0]].value;
        }
    }
    return unit;
}

struct sketch sketch_with_sources(const struct sketch *sketch, double value) {
    struct sketch rest = *sketch;
    for (int k = 0; k < rest.n; k++) {
        struct sketch_element *e = &rest.element[k];
        char kind = e->kind;
        e->kind = kind == 'e' || kind == 'h' ? 'v' : kind == 'f' || kind == 'g' ? 'i' : kind;
        e->value = e->kind != kind ? value : e->value;
    }
    return rest;
}

static int write_nodes(char *text, const struct sketch_element *e, int n) {
    int length = 0;
    for (int k = 0; k < n; k++) {
        length += sprintf(text + length, e->node[k] == 0 ? " %d" : " n%d", e->node[k]);
    }
    return length;
}

void sketch_write(const struct sketch *sketch, char text[SKETCH_TEXT_SIZE]) {
    char *out = text;
    out += sprintf(out, "random circuit\n"
                        ".model d0 d\n.model d1 d(ron=1 vfwd=1)\n.model d2 d(roff=2)\n"
                        ".model d3 d(vrev=2)\n.model s0 sw(vt=1)\n.model s1 sw(vt=1 ron=1)\n.op\n");
    for (int k = 0; k < sketch->n; k++) {
        const struct sketch_element *e = &sketch->element[k];
        if (e->kind == 0) {
            continue;
        }
        out += sprintf(out, "%c%d", e->kind, k);
        switch (e->kind) {
        case 'k':
            out += sprintf(out, " l%d l%d %.17g", e->node[0], e->node[1], e->value);
            break;
        case 'd':
            out += write_nodes(out, e, 2);
            out += sprintf(out, " d%d", e->model);
            break;
        case 's':
            out += write_nodes(out, e, 4);
            out += sprintf(out, " s%d", e->model);
            break;
        case 'e':
        case 'g':
            out += write_nodes(out, e, 4);
            out += sprintf(out, " %.17g", e->value);
            break;
        case 'f':
        case 'h':
            out += write_nodes(out, e, 2);
            out += sprintf(out, " v%d %.17g", e->node[2], e->value);
            break;
        default:
            out += write_nodes(out, e, 2);
            out += sprintf(out, " %.17g", e->value);
            if (e->kind == 'c' || e->kind == 'l') {
                out += sprintf(out, " ic=%.17g", e->initial);
            }
            break;
        }
        out += sprintf(out, "\n");
    }
    out += sprintf(out, ".save all");
    for (int k = 0; k < sketch->n; k++) {
        if (sketch->element[k].saved && sketch->element[k].kind != 0) {
            out += sprintf(out, " i(%c%d)", sketch->element[k].kind, k);
        }
    }
    sprintf(out, "\n.end\n");
}

int sketch_find(const struct sketch *sketch, const char *name) {
    int k = atoi(name + 1);
    return k >= 0 && k < sketch->n && sketch->element[k].kind == name[0] ? k : -1;
}

/* Couplings go with their coils. */
static bool stays(const struct sketch *sketch, const bool *keep, int k) {
    const struct sketch_element *e = &sketch->element[k];
    return e->kind == 'k' ? keep[e->node[0]] && keep[e->node[1]] : keep[k];
}

struct sketch sketch_without(const struct sketch *sketch, const bool *keep) {
    struct sketch rest = *sketch;
    for (int k = 0; k < rest.n; k++) {
        if (!stays(sketch, keep, k)) {
            rest.element[k].kind = 0;
        }
    }
    return rest;
}

struct sketch sketch_wired(const struct sketch *sketch, const bool *keep) {
    struct sketch rest = *sketch;
    int merged[SKETCH_MAX_NODES + 1];
    for (int n = 0; n < sketch->n_nodes; n++) {
        merged[n] = n;
    }
    for (int k = 0; k < sketch->n; k++) {
        const struct sketch_element *e = &sketch->element[k];
        if (stays(sketch, keep, k)) {
            continue;
        }
        rest.element[k].kind = 0;
        if (e->kind == 'k' || e->kind == 0) {
            continue;
        }
        int a = merged[e->node[0]];
        int b = merged[e->node[1]];
        for (int n = 0; n < sketch->n_nodes; n++) {
            if (merged[n] == a || merged[n] == b) {
                merged[n] = a < b ? a : b;
            }
        }
    }
    for (int k = 0; k < rest.n; k++) {
        struct sketch_element *e = &rest.element[k];
        bool by_voltage = strchr("seg", e->kind) != NULL;
        for (int i = 0; e->kind != 0 && e->kind != 'k' && i < (by_voltage ? 4 : 2); i++) {
            e->node[i] = merged[e->node[i]];
        }
    }
    return rest;
}

/* random_elements.c - one element of a netlist that bytes make. */
#include "random_draft.h"

#include <string.h>

static const char *ohms(struct draft *d) {
    return WORD(d, "1k", "1", "10", "1m", "1Meg", "0", "47", "1G", "1u", "-100", "2.2k", "100");
}

static void source_with_formula(struct draft *d, int n, const char *a, const char *b) {
    const char *form = WORD(d, "v=", "i=", "value e", "value g");
    switch (form[0] == 'v' && form[1] == 'a' ? form[6] : 'b') {
    case 'e':
        put(d, "e%d %s %s VALUE={", 20 + n, a, b);
        break;
    case 'g':
        put(d, "g%d %s %s VALUE={", 20 + n, a, b);
        break;
    default:
        put(d, "b%d %s %s %s{", n, a, b, form);
        break;
    }
    formula(d, 2);
    put(d, "}");
}

static void passive(struct draft *d, char kind, int n, const char *a, const char *b) {
    const char *value = ohms(d);
    if (kind == 'r' && pick(d, 5) == 1) {
        d->parameter = true;
        value = "{p}";
    } else if (kind != 'r') {
        value = WORD(d, "1u", "10n", "1m", "100p", "1", "47u", "1f");
    }
    put(d, "%c%d %s %s %s", kind, n, a, b, value);
    if (kind != 'r' && pick(d, 3) == 1) {
        put(d, " ic=%s", volts(d));
    }
    if (kind != 'r' && pick(d, 6) == 1) {
        put(d, " Rser=%s", WORD(d, "1m", "1", "10"));
    }
}

/* Semiconductors with a gate. */
static void gated(struct draft *d, int n, const char *a, const char *b) {
    switch (pick(d, 3)) {
    case 0:
        put(d, "m%d %s %s %s %s %s", n, a, live(d), b, b, WORD(d, "mm0", "mm1", "mm2"));
        break;
    case 1:
        put(d, "a%d %s %s %s %s %s", n, a, b, live(d), node(d), WORD(d, "am0", "am1", "am2"));
        break;
    default:
        put(d, "z%d %s %s %s zm0", n, a, live(d), b);
        break;
    }
}

/* A gate or a flip-flop of LTspice whose output, behind a resistance, is a; with inputs where it has any. */
static void logic(struct draft *d, int n, const char *a) {
    static const struct {
        const char *function;
        bool has[5];
    } of[] = {{"AND", {true, true, true, true, true}},
              {"OR", {true, true, true, true, true}},
              {"XOR", {true, true, false, false, false}},
              {"BUF", {true, false, false, false, false}},
              {"SCHMITT", {true, true, false, false, false}},
              {"SRFLOP", {true, true, false, false, false}},
              {"DFLOP", {true, false, true, true, true}},
              {"COUNTER", {true, true, false, false, false}},
              {"SAMPLEHOLD", {true, true, true, true, false}}};

    const int f = pick(d, (int)(sizeof of / sizeof *of));
    put(d, "a%d %s", n, live(d));
    for (int k = 1; k < 5; k++) {
        put(d, " %s", of[f].has[k] && pick(d, 2) == 0 ? live(d) : "0");
    }
    put(d, " 0 %s 0 %s rout=10%s", a, of[f].function,
        f < 7 ? WORD(d, "", " td=1u", " trise=2u vhigh=5", " td=3u") : "");
}

/* Sources with states or with products, as cards have them. */
static void transfer(struct draft *d, int n, const char *a, const char *b) {
    if (pick(d, 2) == 0) {
        put(d, "%s%d %s %s LAPLACE {v(%s)} = {%s}", WORD(d, "e", "g"), 40 + n, a, b, live(d),
            WORD(d, "1/(1+s*10u)", "2/(s*1u+s**2*1n+1)", "1k/s", "s/(1+s*1u)",
                 "(1-s*3u)/(1+s*3u)"));
    } else {
        put(d, "%s%d %s %s POLY(2) %s 0 %s 0 %s %s 0 %s 0.1", WORD(d, "e", "g"), 60 + n, a, b,
            live(d), live(d), volts(d), gain(d), WORD(d, "0.01", "0", "-1", "1m"));
    }
}

/* A coil by its flux, a capacitor by its charge, or a core. */
static void storage(struct draft *d, int n, const char *a, const char *b) {
    switch (pick(d, 3)) {
    case 0:
        put(d, "l%d %s %s flux=%s", 50 + n, a, b,
            WORD(d, "1m*tanh(2*x)", "table(x,-2,-3m,-1,-2m,1,2m,2,3m)", "1m*x+1u*x**3", "2u*x",
                 "limit(1m*x,-2m,2m)"));
        break;
    case 1:
        put(d, "c%d %s %s q=%s", 50 + n, a, b,
            WORD(d, "1u*x", "x*if(x<0,1u,3u)", "1n*asinh(x)", "10n*x+1n*x**3",
                 "limit(1u*x,-5u,5u)"));
        break;
    default:
        put(d, "l%d %s %s hc=16 bs=.44 br=.10 a=0.0000251 lm=0.0198 lg=%s n=%s", 50 + n, a, b,
            WORD(d, "0.0006858", "0"), WORD(d, "1000", "10"));
        break;
    }
    if (pick(d, 4) == 1) {
        put(d, " ic=%s", volts(d));
    }
}

void element(struct draft *d, const char *a, const char *b) {
    static const char kinds[] = "rclvdiegfhbswrcdsdmatn";
    if (d->has_blocks && d->n_elements > 0 && pick(d, 3) == 1) {
        const bool is_newer = strcmp(a, b) > 0;
        block(d, 200 * d->n_elements++, is_newer ? a : b, is_newer ? b : a);
        put(d, "\n");
        return;
    }
    char kind = d->n_elements == 0 ? 'v' : kinds[pick(d, (int)sizeof kinds - 1)];
    const int n = ++d->n_of[(int)kind];
    d->n_elements++;
    switch (kind) {
    case 'r':
    case 'c':
    case 'l':
        passive(d, kind, n, a, b);
        d->n_coils += kind == 'l';
        break;
    case 'v':
    case 'i':
        put(d, "%c%d %s %s", kind, n, a, b);
        stimulus(d);
        d->n_sources += kind == 'v';
        break;
    case 'd':
        put(d, "d%d %s %s", n, a, b);
        put(d, "%s", WORD(d, "", " dm0", " dm1", " dm2", " dm3", " dm4"));
        break;
    case 'e':
    case 'g':
        put(d, "%c%d %s %s %s %s %s", kind, n, a, b, node(d), live(d), gain(d));
        break;
    case 'f':
    case 'h':
        put(d, "%c%d %s %s v%d %s", kind, n, a, b, 1 + pick(d, d->n_sources), gain(d));
        break;
    case 'b':
        source_with_formula(d, n, a, b);
        break;
    case 's':
        put(d, "s%d %s %s %s %s %s%s", n, a, b, node(d), live(d),
            WORD(d, "sm0", "sm1", "sm2", "sm3"), WORD(d, "", " ON", " OFF"));
        break;
    case 'm':
        gated(d, n, a, b);
        break;
    case 'a':
        logic(d, 20 + n, strcmp(a, b) > 0 ? a : b); /* the newer node */
        break;
    case 't':
        transfer(d, n, a, b);
        break;
    case 'n':
        storage(d, n, a, b);
        break;
    default:
        put(d, "w%d %s %s v%d %s", n, a, b, 1 + pick(d, d->n_sources), WORD(d, "wm0", "wm1"));
        break;
    }
    put(d, "\n");
}

void couplings(struct draft *d) {
    for (int k = 1; k + 1 <= d->n_coils; k += 2) {
        if (pick(d, 3) > 0) {
            put(d, "k%d l%d l%d %s\n", k, k, k + 1,
                WORD(d, "0.9", "1", "-1", "0.9999", "0", "0.3"));
        }
    }
}

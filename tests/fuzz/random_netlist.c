/* random_netlist.c - bytes to a valid netlist. Where the bytes end all choices are the first ones. */
#include "random_draft.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void put(struct draft *d, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const size_t room = RANDOM_NETLIST_SIZE - d->length;
    const int n = vsnprintf(d->text + d->length, room, format, arguments);
    va_end(arguments);
    if (n > 0 && (size_t)n < room) {
        d->length += (size_t)n;
    }
}

int pick(struct draft *d, int n) {
    return d->at < d->size ? d->data[d->at++] % n : 0;
}

const char *word(struct draft *d, const char *const *list, int n) {
    return list[pick(d, n)];
}

static const char *const node_name[MOST_NODES] = {"0", "a", "b", "c", "d", "e"};

const char *node(struct draft *d) {
    return node_name[pick(d, d->n_nodes)];
}

const char *live(struct draft *d) {
    return node_name[1 + pick(d, d->n_nodes - 1)];
}

const char *volts(struct draft *d) {
    return WORD(d, "1", "0", "-1", "5", "12", "1m", "400", "-3.3", "1e-9", "1e5", "0.5", "2");
}

const char *gain(struct draft *d) {
    return WORD(d, "1", "-1", "0.5", "10", "1m", "0", "2", "1e6", "-0.1", "1e-6");
}

static const char *seconds(struct draft *d) {
    return WORD(d, "100u", "1u", "10u", "33u", "0.2m", "1n", "0", "0.37m");
}

static const char *positive_seconds(struct draft *d) {
    return WORD(d, "33u", "1u", "10u", "21u", "45u", "1n", "7.1u");
}

/* PULSE with room for its edges and its width in each period. */
static void pulse(struct draft *d) {
    const char *low = volts(d), *high = volts(d), *delay = seconds(d);
    switch (pick(d, 4)) {
    case 0:
        put(d, "PULSE(%s %s %s %s %s 40u 100u)", low, high, delay, WORD(d, "0", "1n", "5u"),
            WORD(d, "0", "1n", "5u"));
        break;
    case 1:
        put(d, "PULSE(%s %s %s 30u 30u 0 60u)", low, high, delay);
        break;
    case 2:
        put(d, "PULSE(%s %s %s)", low, high, delay);
        break;
    default:
        put(d, "PULSE(%s %s %s 0 0 7u 31u %s)", low, high, delay, WORD(d, "1", "3", "5"));
        break;
    }
}

static void pwl(struct draft *d) {
    put(d, "PWL(0 %s", volts(d));
    static const char *const time[] = {"10u", "20u", "20u", "77u", "0.2m", "0.5m"};
    const int n = 1 + pick(d, 6);
    for (int k = 0; k < n; k++) {
        put(d, " %s %s", time[k], volts(d));
    }
    put(d, ")%s", n > 1 && pick(d, 3) == 1 ? " r=0" : "");
}

void stimulus(struct draft *d) {
    switch (pick(d, 9)) {
    case 0:
        put(d, " %s", volts(d));
        break;
    case 1:
        put(d, " SIN(%s %s %s %s %s %s)", volts(d), volts(d), WORD(d, "5k", "1k", "50", "100k"),
            seconds(d), WORD(d, "0", "1k"), WORD(d, "0", "90", "-37"));
        break;
    case 2:
    case 3:
        put(d, " ");
        pulse(d);
        break;
    case 4:
        put(d, " ");
        pwl(d);
        break;
    case 5:
        put(d, " EXP(%s %s %s %s %s %s)", volts(d), volts(d), WORD(d, "0", "10u"), seconds(d),
            WORD(d, "0.2m", "30u"), seconds(d));
        break;
    case 6:
        put(d, " AM(%s %s 1k 20k %s)", volts(d), WORD(d, "1", "0", "2"), seconds(d));
        break;
    case 7:
        put(d, " SFFM(%s %s 20k %s 1k)", volts(d), volts(d), WORD(d, "1", "3", "0.1"));
        break;
    default:
        put(d, " DC %s AC %s ", volts(d), WORD(d, "1", "0"));
        pulse(d);
        break;
    }
}

/* A voltage, or the current of a source; the time is of others. */
void signal_of(struct draft *d) {
    switch (pick(d, 4)) {
    case 0:
    case 1:
        put(d, "v(%s)", live(d));
        break;
    case 2:
        put(d, "v(%s,%s)", node(d), live(d));
        break;
    default:
        put(d, "i(v%d)", 1 + pick(d, d->n_sources));
        break;
    }
}

/* A product or a smooth function of formulas. */
static void smooth(struct draft *d, int depth) {
    static const char *const open[] = {"exp(", "tanh(", "sin(",   "sqrt(", "ln(",
                                       "sqr(", "atan(", "1/(1+(", "cosh(", "asinh("};
    if (pick(d, 2) == 0) {
        put(d, "(");
        formula(d, depth - 1);
        put(d, ")%s(", WORD(d, "*", "/", "*", "**"));
        formula(d, depth - 1);
        put(d, ")");
    } else {
        const char *function = open[pick(d, 10)];
        put(d, "%s", function);
        formula(d, depth - 1);
        put(d, "%s", function[0] == '1' ? ")**2)" : ")");
    }
}

/* Of signals, of a depth: piecewise linear but for smooth(). */
void formula(struct draft *d, int depth) {
    const int kind = depth == 0 ? pick(d, 3) : pick(d, 13);
    static const char *const open[] = {"abs(", "min(1,", "max(-2,", "uramp(", "u2("};
    switch (kind) {
    case 0:
        signal_of(d);
        break;
    case 1:
        put(d, "%s*", gain(d));
        signal_of(d);
        break;
    case 2:
        put(d, "(%s)", volts(d));
        break;
    case 3:
    case 4:
        put(d, "(");
        formula(d, depth - 1);
        put(d, "%s", kind == 3 ? "+" : "-");
        formula(d, depth - 1);
        put(d, ")");
        break;
    case 5:
        put(d, "limit(");
        formula(d, depth - 1);
        put(d, ",-1,%s)", WORD(d, "2", "0", "10"));
        break;
    case 6:
        put(d, "%s*%s(", WORD(d, "5", "1m", "-1"), WORD(d, "sgn", "u", "buf", "inv"));
        formula(d, depth - 1);
        put(d, ")");
        break;
    case 7:
        put(d, "table(");
        formula(d, depth - 1);
        put(d, ",-1,%s,0,0,2,%s)", WORD(d, "-1", "3"), WORD(d, "1", "0", "50"));
        break;
    case 8:
        put(d, "(");
        formula(d, depth - 1);
        put(d, "%s%s?%s:%s)", WORD(d, ">", "<", ">="), WORD(d, "1", "0", "v(a)"), WORD(d, "5", "0"),
            WORD(d, "0", "1", "-2"));
        break;
    case 9:
        put(d, "%s", WORD(d, "2*sin(2*pi*5k*time)", "u(time-0.1m)", "(time>33u?3:0)", "1k*time"));
        break;
    case 10:
        smooth(d, depth);
        break;
    default:
        put(d, "%s", open[pick(d, 5)]);
        formula(d, depth - 1);
        put(d, ")");
        break;
    }
}

/* Those that elements name; the others would only take time to read. */
static void model(struct draft *d, const char *name, const char *format, const char *a,
                  const char *b) {
    if (strstr(d->text, name) != NULL) {
        put(d, ".model%s ", name);
        put(d, format, a, b);
    }
}

static void models(struct draft *d) {
    model(d, " dm0", "D\n%s%s", "", "");
    model(d, " dm1", "D(Ron=%s Vfwd=0.7)%s\n", WORD(d, "10m", "0", "1"), "");
    model(d, " dm2", "D(Ron=1m Roff=1Meg Vrev=%s)%s\n", WORD(d, "10", "0.1", "400"), "");
    model(d, " dm3", "D(IS=1e-14 N=1 RS=1m)%s%s\n", "", "");
    model(d, " dm4", "D(Ron=1 Ilimit=%s)%s\n", WORD(d, "1", "1m"), "");
    model(d, " sm0", "SW(Ron=1m Roff=1Meg Vt=0.5)%s%s\n", "", "");
    model(d, " sm1", "SW(Vt=%s)%s\n", WORD(d, "0.5", "0", "3"), "");
    const char *vt = WORD(d, "1", "0");
    model(d, " sm2", "SW(Ron=1 Roff=10k Vt=%s Vh=%s)\n", vt, WORD(d, "0.2", "1", "1m"));
    model(d, " sm3", "VSWITCH(Ron=1 Roff=1Meg Von=2 Voff=1)%s%s\n", "", "");
    model(d, " wm0", "CSW(Ron=1m Roff=1Meg It=%s)%s\n", WORD(d, "1m", "0", "1"), "");
    model(d, " mm0", "NMOS(Vto=2 Kp=10)%s%s\n", "", "");
    model(d, " mm1", "VDMOS(Vto=%s Rd=10m Rds=1Meg Kp=20)%s\n", WORD(d, "1", "3"), "");
    model(d, " mm2", "PMOS(Vto=-2 Ron=%s)%s\n", WORD(d, "10m", "1"), "");
    model(d, " am0", "thyristor(Ih=%s)%s\n", WORD(d, "0", "10m", "1"), "");
    model(d, " am1", "triac(Ron=%s)%s\n", WORD(d, "10m", "0"), "");
    model(d, " am2", "gto(Vfwd=1 Vgoff=%s)%s\n", WORD(d, "0.5", "2"), "");
    model(d, " zm0", "NIGBT(Vt=1 Vdiode=%s)%s\n", WORD(d, "1", "0"), "");
    model(d, " wm1", "CSW(It=10m Ih=%s)%s\n", WORD(d, "1m", "5m", "0"), "");
}

static void measurement(struct draft *d, int n) {
    put(d, ".meas tran m%d ", n);
    switch (pick(d, 6)) {
    case 0:
        put(d, "%s ", WORD(d, "AVG", "RMS", "INTEG", "MIN", "MAX", "PP", "MIN_AT", "MAX_AT"));
        formula(d, pick(d, 3));
        put(d, "%s", WORD(d, "", " from=20u to=0.1m", " from=0.2m", " to=1u"));
        break;
    case 1:
        put(d, "%s ", WORD(d, "AVG", "MAX", "RMS"));
        signal_of(d);
        put(d, "%s", WORD(d, "*", "/", "-", "+"));
        signal_of(d);
        break;
    case 2:
        put(d, "WHEN ");
        signal_of(d);
        put(d, "=%s %s", volts(d), WORD(d, "", "RISE=1", "FALL=2", "CROSS=3", "CROSS=LAST"));
        break;
    case 3:
        put(d, "%s ", WORD(d, "FIND", "DERIV"));
        signal_of(d);
        put(d, "%s", WORD(d, " AT=20u", " AT=0.1m", " WHEN v(a)=1", " WHEN v(a)=0.5 FALL=1"));
        break;
    case 4:
        put(d, "TRIG ");
        signal_of(d);
        put(d, " VAL=%s RISE=1 TARG v(a) VAL=%s FALL=%s", volts(d), volts(d), WORD(d, "1", "2"));
        break;
    default:
        put(d, "PARAM='%s'", n == 0 ? "1+1" : WORD(d, "m0*2", "1/m0", "sqrt(m0)", "m0-m0"));
        break;
    }
    put(d, "\n");
}

static void analyses(struct draft *d) {
    if (d->has_blocks && pick(d, 3) == 1) {
        other_analyses(d);
        return;
    }
    if (pick(d, 6) == 1) {
        put(d, ".op\n");
    }
    if (pick(d, 8) == 1) {
        put(d, ".dc v1 %s\n", WORD(d, "0 5 1", "-1 1 0.5", "400 0 -100"));
    }
    if (pick(d, 8) == 1) {
        put(d, "iac 0 a AC 1\n.ac dec %s 10 100k\n", WORD(d, "1", "2"));
    }
    if (pick(d, 10) == 1) {
        put(d, ".pss %s\n", WORD(d, "", "100u", "31u", "auto", "100u periods=2"));
    }
    if (pick(d, 10) == 1) {
        put(d, ".losses\n");
    }
    if (pick(d, 8) == 1) {
        put(d, ".step %s\n", d->parameter ? WORD(d, "param p list 1 1k", "v1 0 2 1") : "v1 1 2 1");
    }
    if (pick(d, 3) == 1) {
        put(d, ".ic v(a)=%s\n", volts(d));
    }
    if (pick(d, 4) == 1) {
        put(d, ".options reltol=%s\n", WORD(d, "1e-9", "1e-3", "1e-12", "1e-5"));
    }
    if (pick(d, 6) == 1) {
        put(d, ".options method=%s\n",
            WORD(d, "euler", "radau stages=5", "auto stages=7", "radau stages=3"));
    }
    if (pick(d, 10) == 1) {
        put(d, ".options fill=%s\n", WORD(d, "none", "1e-2", "1e-4"));
    }
    put(d, ".tran %s %s%s%s\n", WORD(d, "20u", "1u", "50u"), positive_seconds(d),
        WORD(d, "", " 0 33u", " 0.5n"), WORD(d, "", " uic"));
    const int n = pick(d, 4);
    for (int k = 0; k < n; k++) {
        measurement(d, k);
    }
    if (pick(d, 10) == 1) {
        put(d, ".four 20k v(a)\n");
    }
}

/* Netlists of one in so many sizes have subcircuits: the others are what they were, and keep their numbers. */
enum { MORE_OF_SIZES = 7 };

void random_netlist(const uint8_t *data, size_t size, char text[RANDOM_NETLIST_SIZE]) {
    struct draft d = {.data = data, .size = size, .text = text, .has_blocks = size % 2 == 0};
    put(&d, "a netlist of %zu bytes\n", size);
    d.n_nodes = 2 + pick(&d, MOST_NODES - 1);
    const int n = d.n_nodes - 1 + pick(&d, MOST_ELEMENTS - MOST_NODES + 2);
    for (int k = 0; k < n; k++) {
        /* The first ones join each node to one before it. */
        const int b = k < d.n_nodes - 1 ? k + 1 : pick(&d, d.n_nodes);
        int a = k < d.n_nodes - 1 ? pick(&d, b) : pick(&d, d.n_nodes);
        a = a == b ? (b + 1) % d.n_nodes : a;
        const bool turned = k > 0 && pick(&d, 2) == 1;
        element(&d, node_name[turned ? a : b], node_name[turned ? b : a]);
    }
    couplings(&d);
    if (size % MORE_OF_SIZES == 3) {
        subcircuits(&d);
    }
    models(&d);
    if (d.parameter) {
        put(&d, ".param p=%s\n", WORD(&d, "1k", "10", "1m"));
    }
    analyses(&d);
    put(&d, ".end\n");
}

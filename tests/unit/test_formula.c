/* test_formula.c - formulas to pairs: random ones against their direct evaluation, numbers of pairs,
 * functions of time, places of errors. */
#include "formula_values.h"

#include <math.h>
#include <stdio.h>

/* ---- Random formulas ------------------------------------------------------------------------------- */

/* Two texts of the same formula: of voltages, and of parameters. */
struct text {
    char formula[4000], direct[4000];
    size_t n, m;
};

static unsigned long long state;

static unsigned draw(unsigned n) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return (unsigned)((state >> 33) % n);
}

static void say(struct text *t, const char *formula, const char *direct) {
    t->n += (size_t)snprintf(t->formula + t->n, sizeof t->formula - t->n, "%s", formula);
    t->m += (size_t)snprintf(t->direct + t->m, sizeof t->direct - t->m, "%s", direct);
    ck_assert_uint_lt(t->n, sizeof t->formula);
    ck_assert_uint_lt(t->m, sizeof t->direct);
}

static void both(struct text *t, const char *text) {
    say(t, text, text);
}

static void number(struct text *t) {
    char text[40];
    snprintf(text, sizeof text, "(%.2f)", ((int)draw(800) - 400) / 100.0 + 0.005);
    both(t, text);
}

static void leaf(struct text *t) {
    switch (draw(5)) {
    case 0:
        say(t, "v(a)", "va");
        break;
    case 1:
        say(t, "v(b)", "vb");
        break;
    case 2:
        say(t, "v(c,a)", "(vc-va)");
        break;
    case 3:
        say(t, "(v(a)-2*v(b)+0.5)", "(va-2*vb+0.5)");
        break;
    default:
        number(t);
        break;
    }
}

static void any(struct text *t, int depth);

/* A condition. */
static void truth(struct text *t, int depth) {
    const unsigned kind = depth > 0 ? draw(6) : draw(2);
    both(t, "(");
    if (kind == 2) {
        both(t, "!");
        truth(t, depth - 1);
    } else if (kind == 3 || kind == 4) {
        truth(t, depth - 1);
        both(t, kind == 3 ? "&&" : "||");
        truth(t, depth - 1);
    } else {
        any(t, depth - 1);
        both(t, kind == 0 ? "+0.0713>" : kind == 1 ? "+0.0713<=" : "+0.0713<");
        any(t, depth - 1);
    }
    both(t, ")");
}

/* A function of v(a) alone, of which anything may be chosen from. */
static void of_one(struct text *t, int depth) {
    static const char *const inner[] = {"abs(", "uramp(", "sgn(", "u2(", "u(", "("};
    switch (depth > 0 ? draw(5) : 0) {
    case 0:
        say(t, "(2*v(a)-1)", "(2*va-1)");
        break;
    case 1:
        both(t, inner[draw(6)]);
        of_one(t, depth - 1);
        both(t, ")");
        break;
    case 2:
        both(t, "(");
        of_one(t, depth - 1);
        both(t, ">");
        of_one(t, depth - 1);
        both(t, "?");
        of_one(t, depth - 1);
        both(t, ":");
        of_one(t, depth - 1);
        both(t, ")");
        break;
    case 3:
        both(t, "min(");
        of_one(t, depth - 1);
        both(t, ",");
        of_one(t, depth - 1);
        both(t, ")");
        break;
    default:
        both(t, "(sgn(");
        of_one(t, depth - 1);
        both(t, ")*");
        of_one(t, 0);
        both(t, ")");
        break;
    }
}

/* Where several quantities meet, what jumps is kept from resting on its jump: there it may be anything
 * between the two sides. */
static void any(struct text *t, int depth) {
    static const char *const one[] = {"abs(",  "uramp(",        "-(",
                                      "0.5*(", "2*sgn(0.1237+", "1.5*u(0.1237+",
                                      "f(",    "buf(0.1237+",   "inv(0.1237+"};
    static const char *const two[] = {"max(", "min("};
    const unsigned kind = depth > 0 ? draw(9) : 8;
    both(t, "(");
    if (kind <= 2) {
        both(t, one[draw(9)]);
        any(t, depth - 1);
        both(t, ")");
    } else if (kind == 3) {
        both(t, two[draw(2)]);
        any(t, depth - 1);
        both(t, ",");
        any(t, depth - 1);
        both(t, ",");
        leaf(t);
        both(t, ")");
    } else if (kind == 4) {
        any(t, depth - 1);
        both(t, draw(2) == 0 ? "+" : "-");
        any(t, depth - 1);
    } else if (kind == 5) {
        both(t, "limit(");
        any(t, depth - 1);
        both(t, ",");
        number(t);
        both(t, ",");
        number(t);
        both(t, ")");
    } else if (kind == 6) {
        both(t, draw(2) == 0 ? "table(" : "pwl(");
        any(t, depth - 1);
        both(t, ",-2,1,-1,0.5,0,0,1.5,2,4,2)");
    } else if (kind == 7) {
        truth(t, depth - 1);
        both(t, "?k:");
        number(t);
    } else if (depth > 0 && draw(2) == 0) {
        of_one(t, depth);
    } else {
        leaf(t);
    }
    both(t, ")");
}

static double direct_value(const struct text *t, const struct point *p) {
    char netlist[20000];
    struct dalcs_circuit circuit;
    snprintf(netlist, sizeof netlist,
             "t\n.param k=3 va=%.17g vb=%.17g vc=%.17g\n.func f(x) {x+abs(x)}\nV1 1 0 {%s}\n"
             "R1 1 0 1\n.op\n",
             p->v[1], p->v[2], p->v[3], t->direct);
    build_good_circuit(&circuit, netlist);
    const double value = circuit.stimulus[device_named(&circuit, "v1")->stimulus].dc;
    dalcs_circuit_finish(&circuit);
    return value;
}

START_TEST(test_random_formulas) {
    int n_with_pairs = 0;
    const int n_formulas = of_cases(1500, 150);
    for (int k = 0; k < n_formulas; k++) {
        struct text t = {0};
        struct dalcs_circuit circuit;
        state = (unsigned long long)k;
        any(&t, 1 + k % 4);
        build_formula(&circuit, t.formula);
        const struct dalcs_behaviour *b = dalcs_device_written(device_named(&circuit, "b1"));
        n_with_pairs += b->n_pairs > 0;
        for (int i = 0; i < 4; i++) {
            struct point p = {0};
            for (int node = 1; node < 4; node++) {
                p.v[node] = ((int)draw(12000) - 6000) / 997.0;
            }
            const double found = output_at(&circuit, b, &p);
            const double wanted = direct_value(&t, &p);
            ck_assert_msg(fabs(found - wanted) <= 1e-11 * (1 + fabs(wanted)),
                          "%s at %.17g %.17g %.17g: %.17g, not %.17g", t.formula, p.v[1], p.v[2],
                          p.v[3], found, wanted);
        }
        dalcs_circuit_finish(&circuit);
    }
    ck_assert_int_gt(n_with_pairs, 3 * n_formulas / 5);
}

END_TEST

/* ---- Pairs ----------------------------------------------------------------------------------------- */

static void check_pairs(const char *formula, int n_pairs) {
    struct dalcs_circuit circuit;
    build_formula(&circuit, formula);
    const struct dalcs_behaviour *b = dalcs_device_written(device_named(&circuit, "b1"));
    ck_assert_msg(b->n_pairs == n_pairs, "%s: %d pairs, not %d", formula, b->n_pairs, n_pairs);
    dalcs_circuit_finish(&circuit);
}

START_TEST(test_number_of_pairs) {
    check_pairs("2*v(a)-v(b)/k", 0);
    check_pairs("max(v(a),v(b))", 1);
    check_pairs("abs(v(a))", 1);
    check_pairs("max(v(a),-v(a))", 1);
    check_pairs("limit(1e6*v(a,b),-10,10)", 2);
    check_pairs("max(-10,min(10,1e6*v(a,b)))", 2);
    check_pairs("sgn(v(a))", 2);
    check_pairs("u(v(a))-0.5", 2);
    check_pairs("sgn(v(a))+u(v(a))", 2);
    check_pairs("sgn(v(a))-2*u(v(a))", 0);
    check_pairs("v(a) > 1 ? 2*v(a)-1 : v(a)", 1);
    check_pairs("v(a) > 2 ? 2 : v(a) < -2 ? -2 : v(a)", 2);
    check_pairs("table(v(a),-2,-1,-1,0,1,0,2,1)", 4); /* a dead zone with rails */
    check_pairs("pwl(v(a),-1,-1,0,0,1,3)", 1);
    check_pairs("v(a)*sgn(v(a))", 1);
    check_pairs("abs(max(v(a),v(b)))", 2);
    check_pairs("max(v(a),v(b)) + abs(max(v(a),v(b)))", 2); /* one of them serves both */
    check_pairs("v(a)>0 && v(b)>0", 5);
}

END_TEST

/* On the rails the value is exact, however steep the slope. */
START_TEST(test_rails_are_exact) {
    static const char *const formulas[] = {"limit(1e6*v(a),-10,10)", "10*sgn(v(a))",
                                           "table(v(a),-1e-9,-10,1e-9,10)",
                                           "min(10,max(-10,1e9*v(a)))"};
    for (size_t k = 0; k < sizeof formulas / sizeof formulas[0]; k++) {
        struct dalcs_circuit circuit;
        build_formula(&circuit, formulas[k]);
        const struct dalcs_behaviour *b = dalcs_device_written(device_named(&circuit, "b1"));
        const struct point high = {.v = {0, 3.3, 0, 0}};
        const struct point low = {.v = {0, -1234.5, 0, 0}};
        ck_assert_double_eq(output_at(&circuit, b, &high), 10);
        ck_assert_double_eq(output_at(&circuit, b, &low), -10);
        dalcs_circuit_finish(&circuit);
    }
}

END_TEST

/* ---- Time ------------------------------------------------------------------------------------------ */

static void check_time(const char *formula, double (*wanted)(double t)) {
    struct dalcs_circuit circuit;
    build_formula(&circuit, formula);
    const struct dalcs_behaviour *b = dalcs_device_written(device_named(&circuit, "b1"));
    ck_assert_int_eq(b->n_pairs, 0);
    for (int k = 0; k < 200; k++) {
        const struct point p = {.t = k * 0.0173};
        ck_assert_double_eq_tol(output_at(&circuit, b, &p), wanted(p.t), 1e-12);
    }
    dalcs_circuit_finish(&circuit);
}

static double ramp(double t) {
    return 2 * t + 1;
}

static double pulse(double t) {
    return t > 1 && t < 2.5 ? 3 : 0;
}

static double clipped(double t) {
    return fmin(fmax(4 * t - 2, -1), 3);
}

static double sines(double t) {
    return 3 * sin(7 * t + 0.3) * cos(20 * t) - 2 * cos(5 * t) * cos(5 * t);
}

static double damped(double t) {
    return exp(-t / 0.7) * (2 + sin(9 * t)) - exp(1 - 3 * t);
}

static double late(double t) {
    return t > 1 ? sin(6 * t) + t : -t;
}

START_TEST(test_functions_of_time) {
    check_time("2*time+1", ramp);
    check_time("3*(u(time-1)-u(time-2.5))", pulse);
    check_time("time > 1 && time < 2.5 ? 3 : 0", pulse);
    check_time("limit(4*time-2,-1,3)", clipped);
    check_time("3*sin(7*time+0.3)*cos(20*time) - 2*cos(5*time)*cos(5*time)", sines);
    check_time("exp(-time/0.7)*(2+sin(9*time)) - exp(1-3*time)", damped);
    check_time("time > 1 ? sin(6*time)+time : -time", late);
}

END_TEST

/* ---- Errors ---------------------------------------------------------------------------------------- */

/* The message about a formula that starts in column 10 of line 9. */
static void check_error(const char *formula, int column, const char *wanted) {
    char netlist[2000];
    struct dalcs_circuit circuit;
    struct dalcs_diag diag;
    snprintf(netlist, sizeof netlist, "%sB1 q 0 V=%s\nRq q 0 1\n", NODES, formula);
    ck_assert_int_eq(build_circuit(&circuit, &diag, netlist), DALCS_E_NETLIST);
    ck_assert_uint_eq(diag.n, 1);
    ck_assert_msg(strstr(diag.item[0].text, wanted) != NULL, "%s: %s", formula, diag.item[0].text);
    ck_assert_int_eq(diag.item[0].line, 9);
    ck_assert_int_eq(diag.item[0].column, column);
    dalcs_diag_finish(&diag);
}

START_TEST(test_refusals_have_a_place) {
    check_error("v(a)==v(b)", 10, "single points");
    check_error("v(a) ? 1 : 0", 10, "exactly 0");
    check_error("floor(i(va))", 10, "steps without end");
    check_error("pwl(v(a),0,0,v(b),1)", 23, "numbers");
    check_error("delay(v(a),-1)", 10, "a delay is a number");
    check_error("v(zz)", 12, "no element is connected");
    check_error("i(zz)", 12, "there is no element");
    check_error("v(a,b,c)", 10, "between two");
}

END_TEST

RUN_TESTS("formula", test_random_formulas, test_number_of_pairs, test_rails_are_exact,
          test_functions_of_time, test_refusals_have_a_place)

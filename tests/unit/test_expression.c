/* test_expression.c - expressions: values, order of operations, places of errors. */
#include "build_circuit.h"

#include <math.h>
#include <stdio.h>

/* The value of an expression in a netlist with a = 3, b = -2 and two functions. */
static double value_of(const char *text) {
    char netlist[2000];
    struct dalcs_circuit circuit;
    snprintf(netlist, sizeof netlist,
             "t\n.param a=3 b=-2\n.func f(x,y) {x*10 + y}\n.func g(x) {f(x, a)}\n"
             "E1 1 0 2 0 {%s}\nR1 1 0 1\nR2 2 0 1\n.op\n",
             text);
    build_good_circuit(&circuit, netlist);
    const double value = device_named(&circuit, "e1")->value;
    dalcs_circuit_finish(&circuit);
    return value;
}

static void check_value(const char *text, double wanted) {
    const double found = value_of(text);
    ck_assert_msg(found == wanted, "%s = %.17g, not %.17g", text, found, wanted);
}

/* The first message about an expression on line 2, from column 9 on. */
static void check_error(const char *text, int column, const char *wanted) {
    char netlist[2000];
    struct dalcs_circuit circuit;
    struct dalcs_diag diag;
    snprintf(netlist, sizeof netlist, "t\nR1 1 0 {%s}\nV1 1 0 1\n.op\n", text);
    ck_assert_int_eq(build_circuit(&circuit, &diag, netlist), DALCS_E_NETLIST);
    ck_assert_uint_ge(diag.n, 1);
    ck_assert_msg(strstr(diag.item[0].text, wanted) != NULL, "%s: %s", text, diag.item[0].text);
    ck_assert_int_eq(diag.item[0].line, 2);
    ck_assert_int_eq(diag.item[0].column, column);
    dalcs_diag_finish(&diag);
}

START_TEST(test_precedence) {
    check_value("1+2*3", 7);
    check_value("(1+2)*3", 9);
    check_value("10-4-3", 3);
    check_value("24/4/3", 2);
    check_value("-2**2", -4);
    check_value("2**-1", 0.5);
    check_value("3*2**2", 12);
    check_value("2 * 3 % 4", 2);
    check_value("7\\2*3", 9);
    check_value("1+2 > 2 && 4 == 2*2", 1);
    check_value("0 || 1 && 0", 0);
    check_value("1 || 1 && 0", 1);
    check_value("!1==0", 1);
    check_value("1<2<3", 1);
    check_value("1 ? 0 ? 4 : 5 : 6", 5);
    check_value("0 ? 1 : 0 ? 2 : 3", 3);
    check_value("1 ? 2 : 3 + 10", 2);
    check_value("--3 - -+2", 5);
    check_value("{2*{3+1}}", 8);
}

END_TEST

START_TEST(test_values) {
    check_value("4.7k", 4700);
    check_value("1e-3", 1e-3);
    check_value("2meg/1k", 2000);
    check_value(".5", 0.5);
    check_value("10\xC2\xB5", 10e-6);
    check_value("a*b", -6);
    check_value("A + B", 1);
    check_value("pi", 3.14159265358979323846);
    check_value("e", exp(1.0));
    check_value("temper", 27);
    check_value("true - false", 1);
}

END_TEST

START_TEST(test_functions) {
    check_value("sin(1)", sin(1.0));
    check_value("atan2(1,-1)", atan2(1.0, -1.0));
    check_value("hypot(3,4)", 5);
    check_value("int(-2.7)", -2);
    check_value("nint(2.5)", 2);
    check_value("round(2.5)", 3);
    check_value("floor(-2.5)", -3);
    check_value("ceil(-2.5)", -2);
    check_value("sgn(-3) + sgn(0)", -1);
    check_value("min(3, 1, 2)", 1);
    check_value("max(1, 3, 2)", 3);
    check_value("max(7)", 7);
    check_value("limit(5, 1, 3) + limit(-5, 3, 1)", 4);
    check_value("pow(-8, 3)", -512);
    check_value("pwr(-8, 3)", 512);
    check_value("pwrs(-8, 3)", -512);
    check_value("(0-2)**2", 4);
    check_value("u(0.1) + u(0) + u(-1)", 1);
    check_value("uramp(2) + uramp(-2)", 2);
    check_value("buf(0.6) + inv(0.6)", 1);
    check_value("table(1.5, 0,0, 1,10, 2,30)", 20);
    check_value("table(-1, 0,5, 1,10) + table(9, 0,5, 1,10)", 15);
    check_value("f(1,2)", 12);
    check_value("f(f(1,2), g(0))", 123);
}

END_TEST

/* What is not chosen is not looked at. */
START_TEST(test_laziness) {
    check_value("1 ? 2 : 1/0", 2);
    check_value("if(0, nobody, 5)", 5);
    check_value("0 && 1/0", 0);
    check_value("7 || 1/0", 1);
    check_value("5 && 7", 1);
    check_value("0 || 7", 1);
}

END_TEST

START_TEST(test_errors) {
    check_error("1+", 11, "a value is missing");
    check_error("(1", 9, "this parenthesis is never closed");
    check_error("1)", 10, "did not expect ')'");
    check_error("2*nobody", 11, "there is no parameter 'nobody'");
    check_error("nothing(1)", 9, "there is no function 'nothing'");
    check_error("sqrt(0-1)", 9, "sqrt(-1) is not a number");
    check_error("1/0", 10, "division by 0");
    check_error("2**3**2", 13, "a power of a power");
    check_error("3*-2**2", 11, "ngspice applies this minus before");
    check_error("(0-2)**3", 14, "a power of -2");
    check_error("1e300*1e300", 14, "larger than any number");
    check_error("4k7", 9, "'4k7' is not a number");
}

END_TEST

RUN_TESTS("expression", test_precedence, test_values, test_functions, test_laziness, test_errors)

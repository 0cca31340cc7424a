/* test_expand.c - cards to flat cards: what is renamed, what counts, where it says it stands. */
#include "expand.h"

#include "run_tests.h"

#include <stdio.h>
#include <string.h>

static struct dalcs_netlist netlist;
static struct dalcs_deck deck;
static struct dalcs_diag diag;

static void expand(const char *text) {
    ck_assert_int_eq(dalcs_netlist_read_text(&netlist, "t.cir", text, strlen(text), &diag),
                     DALCS_OK);
    ck_assert_int_eq(dalcs_deck_expand(&deck, &netlist, &diag), DALCS_OK);
}

static void finish(void) {
    dalcs_deck_finish(&deck);
    dalcs_netlist_finish(&netlist);
    dalcs_diag_finish(&diag);
}

/* All cards, a line each; a number that was an expression is in brackets. */
static const char *cards(void) {
    static char text[4000];
    text[0] = '\0';
    for (size_t k = 0; k < deck.n_cards; k++) {
        for (int j = 0; j < deck.card[k].n; j++) {
            const struct dalcs_token *token = &deck.card[k].token[j];
            const size_t n = strlen(text);
            const char *end = j + 1 < deck.card[k].n ? " " : "\n";
            if (token->kind == DALCS_TOKEN_NUMBER) {
                snprintf(text + n, sizeof text - n, "[%.15g]%s", token->value, end);
            } else {
                snprintf(text + n, sizeof text - n, "%s%s", token->text, end);
            }
        }
    }
    return text;
}

START_TEST(test_flat) {
    expand("t\nR1 a 0 1k\nX9 a 0 r\n.subckt r p q\n.ends\n");
    ck_assert_str_eq(cards(), "r1 a 0 1k\n");
    ck_assert_ptr_eq(deck.card[0].token, netlist.card[0].token); /* nothing is copied */
    finish();
    expand("t\nR1 a 0 1k\n");
    ck_assert_ptr_eq(deck.card, netlist.card);
    ck_assert_ptr_null(deck.language);
    finish();
}

END_TEST

START_TEST(test_renaming) {
    expand("t\n.global vcc\n.subckt s p q\n"
           "R1 p m 1\nR2 (m q) 2\nE1 m 0 p vcc 3\nF1 q gnd V1 4\nV1 q n 0\nL1 m n 1\nL2 n q 1\n"
           "K1 L1 L2 0.5\nD1 p m dm\nD2 q m outer\nS1 p q m 0 sw on\n.model dm d\n.model sw sw\n"
           ".ic v(m)=1 v(p,n)=2 i(l1)=3\n.ends\n.model outer d\nX1 a b s\n");
    ck_assert_str_eq(cards(), ".model outer d\n"
                              "x1.r1 a x1.m 1\nx1.r2 ( x1.m b ) 2\nx1.e1 x1.m 0 a vcc 3\n"
                              "x1.f1 b gnd x1.v1 4\nx1.v1 b x1.n 0\nx1.l1 x1.m x1.n 1\n"
                              "x1.l2 x1.n b 1\nx1.k1 x1.l1 x1.l2 0.5\nx1.d1 a x1.m x1.dm\n"
                              "x1.d2 b x1.m outer\nx1.s1 a b x1.m 0 x1.sw on\n"
                              ".model x1.dm d\n.model x1.sw sw\n"
                              ".ic v ( x1.m ) = 1 v ( a x1.n ) = 2 i ( x1.l1 ) = 3\n");
    ck_assert_int_eq(deck.card[1].letter, 'r');
    ck_assert_str_eq(dalcs_deck_port(&deck, "x1.q"), "b");
    ck_assert_ptr_null(dalcs_deck_port(&deck, "x1.m"));
    ck_assert_ptr_null(dalcs_deck_port(&deck, "x2.q"));
    ck_assert_ptr_null(dalcs_deck_port(&deck, "q"));
    finish();
}

END_TEST

/* Forms that have their names elsewhere. */
START_TEST(test_forms) {
    expand("t\n.subckt s p\nE1 p m poly(2) p 0 (m,n) 0 1 2\nF1 p m POLY(2) V1 V2 0 1 2\n"
           "G1 p m value={v(p)*2}\nA1 %gd(p m) dm\nW1 p m V1 cm on\nK1 L1 L2 L3 0.9\n"
           ".model dm sidiode\n.ends\nX1 a s\n");
    ck_assert_uint_eq(diag.n, 0);
    ck_assert_str_eq(cards(), "x1.e1 a x1.m poly ( 2 ) a 0 ( x1.m x1.n ) 0 1 2\n"
                              "x1.f1 a x1.m poly ( 2 ) x1.v1 x1.v2 0 1 2\n"
                              "x1.g1 a x1.m value = v(p)*2\nx1.a1 %gd ( a x1.m ) x1.dm\n"
                              "x1.w1 a x1.m x1.v1 cm on\nx1.k1 x1.l1 x1.l2 x1.l3 0.9\n"
                              ".model x1.dm sidiode\n");
    finish();
}

END_TEST

START_TEST(test_parameters) {
    expand("t\n.param c={b+1} b='a*2' a=5\nR1 1 0 {c}\nR2 1 0 b\nV1 1 0 sin(0 {a} '1/a')\n"
           "X1 1 s y={a} z=9\n.subckt s p x={y*2} y=1\n.param z=4 w={x+z}\nR1 p 0 {w}\n"
           ".model d d(ron=x vfwd={a})\nD1 p 0 d\n.ends\nX2 1 s x=7\n");
    ck_assert_uint_eq(diag.n, 0);
    ck_assert_str_eq(cards(), "r1 1 0 [11]\nr2 1 0 [10]\nv1 1 0 sin ( 0 [5] [0.2] )\n"
                              "x1.r1 1 0 [19]\n.model x1.d d ( ron = [10] vfwd = [5] )\n"
                              "x1.d1 1 0 x1.d\n"
                              "x2.r1 1 0 [11]\n.model x2.d d ( ron = [7] vfwd = [5] )\n"
                              "x2.d1 1 0 x2.d\n");
    finish();
}

END_TEST

START_TEST(test_conditions) {
    expand("t\n.param n=2\n.subckt s p k=1\n.if (k==n)\n.param r={k*10}\n.subckt in q\nR1 q 0 {r}\n"
           ".ends\n.elseif (k > n)\n.param r=5\n.subckt in q\nR2 q 0 {r}\n.ends\n.else\n"
           ".subckt in q\nR3 q 0 {n}\n.ends\n.endif\nX1 p in\n.ends\nX1 a s\nX2 a s k=2\n"
           "X3 a s k=3\n");
    ck_assert_uint_eq(diag.n, 0);
    ck_assert_str_eq(cards(), "x1.x1.r3 a 0 [2]\nx2.x1.r1 a 0 [20]\nx3.x1.r2 a 0 [5]\n");
    finish();

    /* What a call gives comes before a .param under a condition. */
    expand("t\n.subckt s p r=1\n.if (1)\n.param r=5\n.endif\nR1 p 0 {r}\n.ends\nX1 a s\n"
           "X2 a s r=9\n");
    ck_assert_str_eq(cards(), "x1.r1 a 0 [5]\nx2.r1 a 0 [9]\n");
    finish();
}

END_TEST

/* A copy has its text and the calls that made it. */
START_TEST(test_places) {
    expand("t\n.subckt in p\nR1 p 0 1\n.ends\n.subckt out p\nX2 p in\n.ends\nX1 a out\n");
    const struct dalcs_location where = dalcs_token_location(&deck.card[0].token[1]);
    ck_assert_int_eq(where.line, 3);
    ck_assert_int_eq(where.column, 4);
    ck_assert_str_eq(where.source_line, "R1 p 0 1");
    ck_assert_str_eq(where.instance->instance, "x1.x2");
    ck_assert_int_eq(where.instance->line, 6);
    ck_assert_str_eq(where.instance->outer->instance, "x1");
    ck_assert_int_eq(where.instance->outer->line, 8);
    ck_assert_ptr_null(where.instance->outer->outer);
    finish();
}

END_TEST

/* What is wrong is said once for its place, however many instances there are. */
START_TEST(test_repetition) {
    expand("t\n.subckt s p\nR1 p 0 {nobody}\n.ends\nX1 a s\nX2 a s\nX3 a s\nR2 a 0 {nobody}\n");
    ck_assert(deck.has_errors);
    ck_assert_uint_eq(diag.n, 2);
    ck_assert_ptr_nonnull(strstr(diag.item[0].text, "in x1 (t.cir:5)"));
    finish();
}

END_TEST

START_TEST(test_limits) {
    netlist.most_cards = 100;
    expand("t\n.subckt a p\nR1 p 0 1\nR2 p 0 1\n.ends\n.subckt b p\nX1 p a\nX2 p a\nX3 p a\n.ends\n"
           ".subckt c p\nX1 p b\nX2 p b\nX3 p b\n.ends\nX1 n c\nX2 n c\nX3 n c\nX4 n c\n");
    ck_assert(deck.has_errors);
    ck_assert_uint_eq(diag.n, 1);
    ck_assert_ptr_nonnull(strstr(diag.item[0].text, "more than 100 cards"));
    finish();

    netlist.no_includes = true;
    expand("t\n.include /etc/passwd\n");
    ck_assert_ptr_nonnull(strstr(diag.item[0].text, "no other file can be read"));
    finish();
}

END_TEST

RUN_TESTS("expand", test_flat, test_renaming, test_forms, test_parameters, test_conditions,
          test_places, test_repetition, test_limits)

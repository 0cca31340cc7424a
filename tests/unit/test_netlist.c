/* test_netlist.c - text to cards: what is a token and where it stands. */
#include "netlist.h"

#include "run_tests.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct dalcs_netlist netlist;
static struct dalcs_diag diag;

static void read_bytes(const char *text, size_t length) {
    ck_assert_int_eq(dalcs_netlist_read_text(&netlist, "t.cir", text, length, &diag), DALCS_OK);
}

static void read_text(const char *text) {
    read_bytes(text, strlen(text));
}

static void finish(void) {
    dalcs_netlist_finish(&netlist);
    dalcs_diag_finish(&diag);
}

/* A card as text: kinds other than words are marked, commas shown. */
static const char *card_text(size_t index) {
    static char text[1000];
    ck_assert_uint_lt(index, netlist.n_cards);
    const struct dalcs_card *card = &netlist.card[index];
    text[0] = '\0';
    for (int k = 0; k < card->n; k++) {
        static const char mark[] = {
            [DALCS_TOKEN_WORD] = 'w',  [DALCS_TOKEN_STRING] = 's', [DALCS_TOKEN_EXPRESSION] = 'e',
            [DALCS_TOKEN_EQUAL] = '=', [DALCS_TOKEN_OPEN] = '(',   [DALCS_TOKEN_CLOSE] = ')',
            [DALCS_TOKEN_BAD] = '!'};
        const struct dalcs_token *token = &card->token[k];
        const size_t n = strlen(text);
        const char m = mark[token->kind];
        if (m == 'w') {
            snprintf(text + n, sizeof text - n, "%s%s ", token->after_comma ? "," : "",
                     token->text);
        } else if (m == 's' || m == 'e' || m == '!') {
            snprintf(text + n, sizeof text - n, "%c<%s> ", m, token->text);
        } else {
            snprintf(text + n, sizeof text - n, "%c ", m);
        }
    }
    return text;
}

static void check_place(size_t card, int token, int line, int column, int length) {
    const struct dalcs_location where = dalcs_token_location(&netlist.card[card].token[token]);
    ck_assert_str_eq(where.file, "t.cir");
    ck_assert_int_eq(where.line, line);
    ck_assert_int_eq(where.column, column);
    ck_assert_int_eq(where.length, length);
}

START_TEST(test_tokens) {
    read_text("The Title\n"
              "R1 In OUT 4.7K\n"
              "V1 a,b Pulse(0 1,2)ic = 5\n"
              ".print 'A/B' \"b C\"\n"
              "R2 a 0 {2*R0*{x}} tail\n"
              "Xa /sw Net_D1-K n[3] a$b a#b\n");
    ck_assert_str_eq(netlist.title, "The Title");
    ck_assert_uint_eq(netlist.n_cards, 5);
    ck_assert_str_eq(card_text(0), "r1 in out 4.7k ");
    ck_assert_str_eq(card_text(1), "v1 a ,b pulse ( 0 1 ,2 ) ic = 5 ");
    ck_assert_str_eq(card_text(2), ".print e<a/b> s<b C> ");
    ck_assert_str_eq(card_text(3), "r2 a 0 e<2*r0*{x}> tail ");
    ck_assert_str_eq(card_text(4), "xa /sw net_d1-k n[3] a$b a#b ");
    check_place(0, 3, 2, 11, 4);
    check_place(1, 4, 3, 13, 1);
    check_place(1, 7, 3, 18, 1);
    check_place(2, 1, 4, 8, 5);
    check_place(3, 3, 5, 8, 10);
    ck_assert_str_eq(netlist.card[0].token->line->text, "R1 In OUT 4.7K");
    finish();
}

END_TEST

/* Text is cleaned eight bytes at a time where it is plain: each byte in each place of the eight. */
START_TEST(test_every_byte) {
    enum { PLACES = 16 };

    for (int byte = 1; byte < 0x80; byte++) {
        for (size_t k = 1; k <= PLACES && byte != '\n'; k++) {
            char text[] = "t\nRBBBBBBBBBBBBBBBBBBBBBBB\n";
            char word[] = "rbbbbbbbbbbbbbbbbbbbbbbb";
            text[2 + k] = (char)byte;
            word[k] = (char)(byte >= 'A' && byte <= 'Z' ? byte + 'a' - 'A' : byte);
            if (strchr(" \t\r\v\f,=();", byte) != NULL) {
                word[k] = '\0';
            }
            read_text(text);
            const struct dalcs_token *token = netlist.card[0].token;
            if ((byte < ' ' && strchr("\t\r\v\f", byte) == NULL) || byte == 0x7F) {
                ck_assert_int_eq(token->kind, DALCS_TOKEN_BAD);
                ck_assert_int_eq(token->line->text[k], '?');
            } else {
                ck_assert_int_eq(token->kind, DALCS_TOKEN_WORD);
                ck_assert_str_eq(token->text, word);
            }
            finish();
        }
    }
}

END_TEST

START_TEST(test_comments_and_continuation) {
    read_text("title\n"
              "* a comment\n"
              "   * another\n"
              "R1 a 0 ; the value follows\n"
              "\n"
              "* between\n"
              "  +  1k $ one kilohm\n"
              "+\n"
              "+ ic=$5 $\n"
              "$ only a comment\n"
              ";only a comment\n"
              "R2 a 0 2;k\n"
              "R3 a 0 'a;b' $\n");
    ck_assert_uint_eq(netlist.n_cards, 3);
    ck_assert_str_eq(card_text(0), "r1 a 0 1k ic = $5 ");
    check_place(0, 3, 7, 6, 2);
    check_place(0, 4, 9, 3, 2);
    ck_assert_str_eq(card_text(1), "r2 a 0 2 ");
    ck_assert_str_eq(card_text(2), "r3 a 0 e<a;b> ");
    ck_assert_uint_eq(diag.n, 0);
    finish();
}

END_TEST

START_TEST(test_end) {
    read_text("title\n.ends\n.endc\n.END\nR1 a 0 'unclosed\n");
    ck_assert_uint_eq(netlist.n_cards, 2);
    ck_assert_str_eq(card_text(1), ".endc ");
    ck_assert_uint_eq(diag.n, 0);
    finish();
}

END_TEST

START_TEST(test_title) {
    read_text("  R1 a 0 1k \t\nR2 b 0 1k\n");
    ck_assert_str_eq(netlist.title, "R1 a 0 1k");
    ck_assert_uint_eq(netlist.n_cards, 1);
    finish();
    read_text("first\n.title  Another'Title \nR2 b 0 1k\n");
    ck_assert_str_eq(netlist.title, "Another'Title");
    ck_assert_uint_eq(netlist.n_cards, 1);
    finish();
    read_text("");
    ck_assert_str_eq(netlist.title, "");
    ck_assert_uint_eq(netlist.n_cards, 0);
    finish();
}

END_TEST

START_TEST(test_line_ends_and_encodings) {
    read_text("\xEF\xBB\xBF"
              "CRLF\r\nR1\xC2\xA0"
              "a\t0 1k\r\n+ 5\r\nC\xC2\xB5 a 0 \xCE\xA9z 1");
    ck_assert_str_eq(netlist.title, "CRLF");
    ck_assert_uint_eq(netlist.n_cards, 2);
    ck_assert_str_eq(card_text(0), "r1 a 0 1k 5 ");
    ck_assert_str_eq(card_text(1), "c\xC2\xB5 a 0 \xCE\xA9z 1 ");
    check_place(1, 3, 4, 8, 2);
    check_place(1, 4, 4, 11, 1);
    ck_assert_uint_eq(diag.n, 0);
    finish();
}

END_TEST

START_TEST(test_control_block) {
    read_text("t\n.control\nlet x = 'a {\n+ more\n.tran 1 2\n.endc\nR1 a 0 1k\n");
    ck_assert_uint_eq(netlist.n_cards, 2);
    ck_assert_str_eq(card_text(1), "r1 a 0 1k ");
    ck_assert_uint_eq(diag.n, 0);
    finish();
}

END_TEST

/* Errors of spelling do not end the reading: the rest is there, the token is marked. */
START_TEST(test_errors) {
    static const struct {
        const char *text;
        const char *card; /* the first one, NULL: none */
        int line, column;
    } wanted[] = {
        {"t\nR1 a 0 'x\nR2 b 0 1\n", "r1 a 0 !<x> ", 2, 8},
        {"t\nR1 a 0 {x{y}\nR2 b 0 1\n", "r1 a 0 !<x{y}> ", 2, 8},
        {"t\nR1 a\x01 0\nR2 b 0 1\n", NULL, 2, 4},
        {"t\nR1 a \x81 0\nR2 b 0 1\n", NULL, 2, 6},
        {"t\nR1 a \xC0\x80 0\nR2 b 0 1\n", NULL, 2, 6},
        {"t\nR1 a \xED\xA0\x80 0\nR2 b 0 1\n", NULL, 2, 6},
        {"t\nR1 a \xF4\x90\x80\x80\nR2 b 0 1\n", NULL, 2, 6},
        {"t\nR1 \xE2\x82\nR2 b 0 1\n", NULL, 2, 4},
        {"t\n+ 5\nR2 b 0 1\nR3 c 0 1\n", "r2 b 0 1 ", 2, 1},
    };

    for (size_t k = 0; k < sizeof wanted / sizeof wanted[0]; k++) {
        read_text(wanted[k].text);
        ck_assert_uint_eq(diag.n, 1);
        ck_assert_uint_eq(diag.n_errors, 1);
        ck_assert(netlist.has_errors);
        ck_assert_int_eq(diag.item[0].line, wanted[k].line);
        ck_assert_int_eq(diag.item[0].column, wanted[k].column);
        ck_assert_uint_eq(netlist.n_cards, 2);
        if (wanted[k].card != NULL) {
            ck_assert_str_eq(card_text(0), wanted[k].card);
        }
        finish();
    }
}

END_TEST

START_TEST(test_no_text) {
    read_bytes("t\nR1 a\0b 0 1k\n.op\n", 19);
    ck_assert_uint_eq(diag.n, 1);
    ck_assert_int_eq(diag.item[0].line, 2);
    ck_assert_int_eq(diag.item[0].column, 5);
    ck_assert_uint_eq(netlist.n_cards, 0);
    ck_assert(netlist.has_errors);
    finish();
}

END_TEST

START_TEST(test_file) {
    ck_assert_int_eq(dalcs_netlist_read_file(&netlist, "/nowhere/at all.cir", &diag), DALCS_E_IO);
    ck_assert_uint_eq(diag.n_errors, 1);
    ck_assert_str_eq(diag.item[0].text,
                     "error: cannot read '/nowhere/at all.cir': No such file or directory");
    finish();
    ck_assert_int_eq(dalcs_netlist_read_file(&netlist, "/", &diag), DALCS_E_IO);
    finish();

    /* Larger than one read. */
    char path[] = "/tmp/dalcs-netlist-XXXXXX";
    const int descriptor = mkstemp(path);
    ck_assert_int_ge(descriptor, 0);
    FILE *file = fdopen(descriptor, "w");
    fprintf(file, "a file\n");
    for (int k = 0; k < 20000; k++) {
        fprintf(file, "R%d n%d n%d 1k\n", k, k, k + 1);
    }
    fclose(file);
    ck_assert_int_eq(dalcs_netlist_read_file(&netlist, path, &diag), DALCS_OK);
    remove(path);
    ck_assert_uint_eq(netlist.n_cards, 20000);
    ck_assert_str_eq(card_text(19999), "r19999 n19999 n20000 1k ");
    ck_assert_str_eq(netlist.card[7].token->line->source->name, path);
    ck_assert_int_eq(netlist.card[19999].token->line->number, 20001);
    finish();
}

END_TEST

START_TEST(test_spans) {
    read_text("t\nR1 a 0 1,5\n+ 6\n");
    const struct dalcs_token *token = netlist.card[0].token;
    struct dalcs_location where = dalcs_token_span(&token[3], &token[4]);
    ck_assert_int_eq(where.column, 8);
    ck_assert_int_eq(where.length, 3);
    where = dalcs_token_span(&token[4], &token[5]); /* on two lines: the first only */
    ck_assert_int_eq(where.column, 10);
    ck_assert_int_eq(where.length, 1);
    where = dalcs_token_end(&token[4]);
    ck_assert_int_eq(where.line, 2);
    ck_assert_int_eq(where.column, 11);
    finish();
}

END_TEST

RUN_TESTS("netlist", test_tokens, test_every_byte, test_comments_and_continuation, test_end,
          test_title, test_line_ends_and_encodings, test_control_block, test_errors, test_no_text,
          test_file, test_spans)

/* test_drawn.c - signals that are drawn, their panels, and pictures of text. */
#include "read_waveforms.h"

#include <math.h>

static const char table[] = "time,v(a),v(b),V(Out),i(r1),@d1[id],v1#branch\n"
                            "0,1,2,3,4,5,6\n"
                            "1,10,20,30,40,50,60\n";

static enum dalcs_status add_up(void *user, double at, const double *value) {
    double *sum = user;
    sum[0] += 1.0;
    sum[1] += at;
    sum[2] += value[0];
    return DALCS_OK;
}

static void check_signal(const char *text, double expected, const char *unit) {
    struct dalcs_waveforms w;
    struct dalcs_signal s;
    struct dalcs_arena arena = {0};
    char space[DALCS_DIMENSION_TEXT];
    read_text(&w, table, 0);
    enum dalcs_status status = dalcs_signal_parse(&s, &w, text, &arena, &diag);
    ck_assert_msg(status == DALCS_OK, "%s: %s", text, message());
    ck_assert_double_eq_tol(dalcs_signal_value(&s, w.value), expected, 1e-12);
    ck_assert_str_eq(dalcs_dimension_unit(space, s.dimension), unit);
    dalcs_arena_finish(&arena);
    dalcs_waveforms_finish(&w);
}

START_TEST(test_expressions) {
    check_signal("v(a)", 1.0, "V");
    check_signal("v(out)", 3.0, "V");
    check_signal(" v( a , b ) ", -1.0, "V");
    check_signal("v(b,0)", 2.0, "V");
    check_signal("V(GND,B)", -2.0, "V");
    check_signal("v(out)*i(r1)", 12.0, "W");
    check_signal("v(out)/i(r1)", 0.75, "\316\251");
    check_signal("i(r1)/v(out)", 4.0 / 3.0, "S");
    check_signal("-v(a)+2*v(b)-v(out)/3", 2.0, "V");
    check_signal("v(out)-(v(a)-v(b))", 4.0, "V");
    check_signal("v(a)-v(b)-v(out)", -4.0, "V");
    check_signal("v(out)/v(b)/v(b)", 0.75, "V^-1");
    check_signal("v(a)*v(b)", 2.0, "V^2");
    check_signal("v(a)*i(r1)*time", 0.0, "J");
    check_signal("v(a)+i(r1)", 5.0, "");
    check_signal("v(a)+1.5k", 1501.0, "V");
    check_signal("abs(-v(b))", 2.0, "V");
    check_signal("db(10*v(a))", 20.0, "dB");
    check_signal("sqrt(i(r1))", 2.0, "");
    check_signal("i(d1)", 5.0, "A");
    check_signal("i(v1)", 6.0, "A");
    check_signal("1e-3*v(a)", 1e-3, "V");
}

END_TEST

static void refuse_signal(const char *text, const char *why) {
    struct dalcs_waveforms w;
    struct dalcs_signal s;
    struct dalcs_arena arena = {0};
    read_text(&w, table, 0);
    ck_assert_int_eq(dalcs_signal_parse(&s, &w, text, &arena, &diag), DALCS_E_OPTION);
    ck_assert_msg(strstr(message(), why) != NULL, "%s: %s", text, message());
    dalcs_arena_finish(&arena);
    dalcs_waveforms_finish(&w);
}

START_TEST(test_wrong_expressions) {
    refuse_signal("i(rr1)", "there is no signal 'i(rr1)'; did you mean 'i(r1)'?");
    refuse_signal("v(a,x)", "there is no signal 'v(x)'");
    refuse_signal("i(q9)", "the file has time, v(a), v(b), V(Out), i(r1), @d1[id], v1#branch");
    refuse_signal("", "expected a signal at the end");
    refuse_signal("v(a)*", "expected a signal at the end");
    refuse_signal("v(a", "')' is missing at the end");
    refuse_signal("(v(a)", "')' is missing at the end");
    refuse_signal("v(a))", "expected an operator or a comma at ')'");
    refuse_signal("2..*v(a)", "expected a number at '2..*v(a)'");
    char deep[5000];
    memset(deep, '(', sizeof deep - 1);
    deep[sizeof deep - 1] = '\0';
    refuse_signal(deep, "more than 4000 characters");
    refuse_signal(deep + 2000, "too many parentheses");
}

END_TEST

START_TEST(test_panels) {
    struct dalcs_waveforms w;
    struct dalcs_selection s;
    read_text(&w, table, 0);
    ck_assert_int_eq(dalcs_selection_make(&s, &w, NULL, 0, NAN, NAN, &diag), DALCS_OK);
    ck_assert_int_eq(s.n_panels, 2);
    ck_assert_int_eq(s.panel[0].n, 3);
    ck_assert_str_eq(s.panel[1].unit, "A");
    dalcs_selection_finish(&s);

    const char *const group[] = {"v(a),i(r1),v(a,b),v(b)*i(r1)", "v(out)"};
    ck_assert_int_eq(dalcs_selection_make(&s, &w, group, 2, NAN, NAN, &diag), DALCS_OK);
    ck_assert_int_eq(s.n_panels, 4);
    ck_assert_str_eq(s.panel[0].quantity, "voltage");
    ck_assert_int_eq(s.panel[0].n, 2);
    ck_assert_uint_eq(s.panel[0].signal[1], 2);
    ck_assert_str_eq(s.name[2], "v(a,b)");
    ck_assert_str_eq(s.panel[1].unit, "A");
    ck_assert_str_eq(s.panel[2].unit, "W");
    ck_assert_uint_eq(s.panel[3].signal[0], 4);
    dalcs_selection_finish(&s);

    const char *const many[] = {"v(a),v(a),v(a),v(a),v(a),v(a),v(a),v(a),v(b)"};
    ck_assert_int_eq(dalcs_selection_make(&s, &w, many, 1, NAN, NAN, &diag), DALCS_OK);
    ck_assert_int_eq(s.n_panels, 2);
    ck_assert_uint_eq(s.panel[1].signal[0], 8);
    dalcs_selection_finish(&s);

    const char *const nine[] = {"v(a)", "v(a)", "v(a)", "v(a)", "v(a)",
                                "v(a)", "v(a)", "v(a)", "v(a)"};
    ck_assert_int_eq(dalcs_selection_make(&s, &w, nine, 9, NAN, NAN, &diag), DALCS_E_OPTION);
    ck_assert_ptr_nonnull(strstr(message(), "more than 8 panels"));
    dalcs_waveforms_finish(&w);
}

END_TEST

/* A range that ends between rows ends there; of a discontinuity at its end one side is in it. */
START_TEST(test_ranges) {
    struct dalcs_waveforms w;
    struct dalcs_selection s;
    double sum[3] = {0.0};
    read_text(&w, "time,v(a)\n0,0\n1,0\n1,8\n2,8\n2,2\n4,2\n", 0);
    ck_assert_int_eq(dalcs_selection_make(&s, &w, NULL, 0, 1.0, 3.0, &diag), DALCS_OK);
    ck_assert_int_eq(dalcs_selection_each_row(&s, add_up, sum), DALCS_OK);
    ck_assert_double_eq(sum[0], 4.0);
    ck_assert_double_eq(sum[1], 1.0 + 2.0 + 2.0 + 3.0);
    ck_assert_double_eq(sum[2], 8.0 + 8.0 + 2.0 + 2.0);
    dalcs_selection_finish(&s);
    memset(sum, 0, sizeof sum);
    ck_assert_int_eq(dalcs_selection_make(&s, &w, NULL, 0, 0.5, 2.0, &diag), DALCS_OK);
    ck_assert_int_eq(dalcs_selection_each_row(&s, add_up, sum), DALCS_OK);
    ck_assert_double_eq(sum[0], 4.0);
    ck_assert_double_eq(sum[2], 0.0 + 0.0 + 8.0 + 8.0);
    dalcs_selection_finish(&s);
    ck_assert_int_eq(dalcs_selection_make(&s, &w, NULL, 0, 3.0, 1.0, &diag), DALCS_E_OPTION);
    ck_assert_ptr_nonnull(strstr(message(), "the range is empty: from 3 s to 1 s"));
    ck_assert_int_eq(dalcs_selection_make(&s, &w, NULL, 0, 5.0, NAN, &diag), DALCS_E_OPTION);
    ck_assert_ptr_nonnull(strstr(message(), "the file goes from 0 s to 4 s"));
    dalcs_waveforms_finish(&w);
    read_text(&w, "time,v(a)\n0,0\n", 0);
    ck_assert_int_eq(dalcs_selection_make(&s, &w, NULL, 0, NAN, NAN, &diag), DALCS_E_OPTION);
    ck_assert_ptr_nonnull(strstr(message(), "one row, which is no curve"));
    dalcs_waveforms_finish(&w);
}

END_TEST

START_TEST(test_conduction_by_currents) {
    struct dalcs_waveforms w;
    struct dalcs_selection s;
    struct dalcs_conduction c = {0};
    read_text(&w,
              "time,i(d10),i(x1.D2),i(l1),i(r1),i(dx.l1),i(s1)\n0,0,5,1,1,1,0\n1,0,5,1,1,1,1e-9\n"
              "2,3,0,1,1,1,2\n3,0,0,1,1,1,2\n",
              0);
    ck_assert_int_eq(dalcs_selection_make(&s, &w, NULL, 0, NAN, NAN, &diag), DALCS_OK);
    ck_assert_int_eq(dalcs_conduction_add(&c, "s1", 0.25, true), DALCS_OK); /* known better */
    ck_assert_int_eq(dalcs_selection_add_conduction(&s, &c), DALCS_OK);
    ck_assert_uint_eq(c.n, 3);
    ck_assert_str_eq(c.element[0].name, "d10");
    ck_assert_uint_eq(c.element[0].n, 2);
    ck_assert_double_eq(c.element[0].change[0].time, 1.0);
    ck_assert_double_eq(c.element[0].change[1].time, 3.0);
    ck_assert_str_eq(c.element[1].name, "s1");
    ck_assert_double_eq(c.element[1].change[0].time, 0.25);
    ck_assert_str_eq(c.element[2].name, "x1.d2");
    ck_assert(c.element[2].on_before);
    double fraction[6];
    dalcs_conduction_fractions(&c.element[0], 0.0, 3.0, 6, fraction);
    const double expected[6] = {0.0, 0.0, 1.0, 1.0, 1.0, 1.0};
    for (int i = 0; i < 6; i++) {
        ck_assert_double_eq_tol(fraction[i], expected[i], 1e-12);
    }
    dalcs_conduction_fractions(&c.element[1], 0.1, 0.4, 1, fraction);
    ck_assert_double_eq_tol(fraction[0], 0.5, 1e-12);
    dalcs_conduction_fractions(&c.element[2], 1.5, 2.5, 2, fraction);
    ck_assert_double_eq_tol(fraction[0], 1.0, 1e-12);
    ck_assert_double_eq_tol(fraction[1], 0.0, 1e-12);
    dalcs_conduction_finish(&c);
    dalcs_selection_finish(&s);
    dalcs_waveforms_finish(&w);
}

END_TEST

START_TEST(test_text_plot) {
    const char *const name[] = {"v(a\033[2J)"};
    const struct dalcs_figure_panel panel = {
        .quantity = "voltage", .unit = "V", .n = 1, .signal = {0}};
    const struct dalcs_text_plot_options options = {.width = 53};
    struct dalcs_figure figure;
    struct dalcs_conduction c = {0};
    ck_assert_int_eq(dalcs_conduction_add(&c, "d1", 0.5, true), DALCS_OK);
    dalcs_figure_init(&figure, NULL, 0.0, 1.0);
    figure.conduction = &c;
    figure.bars = true;
    ck_assert_int_eq(dalcs_figure_begin_panels(&figure, "a ramp", name, &panel, 1), DALCS_OK);
    for (int i = 0; i <= 100; i++) {
        double value = -3.0 + 0.12 * i;
        dalcs_figure_row(&figure, 0.01 * i, &value);
    }
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    ck_assert_ptr_nonnull(stream);
    ck_assert_int_eq(dalcs_text_plot_write(stream, &figure, &options), DALCS_OK);
    ck_assert_int_eq(fclose(stream), 0);
    ck_assert_str_eq(text, "a ramp\n"
                           "\n"
                           "            v(a?[2J)\n"
                           "        9 V                                   ...:''\n"
                           "                                       ...:''''     \n"
                           "                                ...:''''            \n"
                           "                        ....:''''                   \n"
                           "                 ....:'''                           \n"
                           "       -3 V ..:'''                                  \n"
                           "         d1                     ####################\n"
                           "            0 s               time               1 s\n");
    free(text);
    dalcs_figure_finish(&figure);
    dalcs_conduction_finish(&c);
}

END_TEST

RUN_SUITE("drawn signals", test_expressions, test_wrong_expressions, test_panels, test_ranges,
          test_conduction_by_currents, test_text_plot)
